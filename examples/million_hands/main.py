# %% [markdown]
# A million hands feel corduroy at once. How does its amplitude follow its level of roughness and the width of its ribs, and
# how much do hands differ that only begin at another place?

# %%
import sys
import time

import numpy as np
import wale

hands = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
corduroy = wale.Library().find("corduroy")
random = np.random.default_rng(1995)

# %% Each hand somewhere on the patch: the force is a field.
anywhere = random.uniform(-0.015, 0.015, (hands, 2)).astype(np.float32)
begun = time.perf_counter()
force = wale.batch(corduroy, anywhere)[:, 0]
rate = hands / (time.perf_counter() - begun)
print(f"{hands} hands, {rate / 1e6:.1f} million a second")
print(f"99 % of the forces are at most {np.percentile(np.abs(force), 99):.3f} N; "
      f"the program aims at {corduroy.percepts[0].amplitude:.3f} N")

# %% The level of roughness sets the amplitude, the width of the ribs does not.
for settings in ({"roughness": 0.2}, {"roughness": 0.4}, {"roughness": 0.4, "wale": 0.004}):
    force = wale.batch(corduroy, anywhere, settings=settings)[:, 0]
    print(f"{settings}: {np.percentile(np.abs(force), 99):.3f} N")

# %% Strokes of 12 ticks at 0.1 m/s: the impulse that a hand gets depends on where its stroke begins.
profile = wale.profile(corduroy.device)
ticks = np.arange(12) / profile.rate
strokes = np.zeros((hands // 10, len(ticks), 2), dtype=np.float32)
strokes[:, :, 0] = anywhere[: len(strokes), :1] * 0.5 + 0.1 * ticks
impulse = wale.batch(corduroy, strokes)[:, :, 0].sum(axis=1) / profile.rate
print(f"{len(strokes)} strokes: {impulse.mean() * 1e3:+.2f} mN s on average, standard deviation {impulse.std() * 1e3:.2f} mN s")
