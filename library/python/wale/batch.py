"""Many hands at once."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wale._abi import Arguments, call, ffi, held, lib, number
from wale._arrays import numbers, pointer, size_in_full, vectors, yes_or_no
from wale.program import Program


def batch(program: Program, position: ArrayLike, *, velocity: ArrayLike | None = None,
          acceleration: ArrayLike | None = None, raw_velocity: ArrayLike | None = None,
          raw_acceleration: ArrayLike | None = None, workspace: ArrayLike | None = None, time: ArrayLike | None = None,
          button: ArrayLike | None = None, settings: Mapping[str, float] | None = None,
          size: Sequence[float] | None = None) -> NDArray[np.float32]:
    """The forces (N; of a pad amplitude and frequency) of a program on many independent hands, on all cores.

    `position`: hands x ticks x 2, m from the patch's centre; or hands x 2, for one tick. The result has its shape. The
    other motions have it too; what is not given is computed from the positions: differences, times the device's rate, 0
    at the first tick. `time`: s, one for each tick. `button`: hands x ticks. `settings`: parameters by name, SI. `size`:
    m, width, height and rim of the patch, cut to the workspace; beyond its edge there is no force, and states go on.
    """
    at = vectors(position, "position")
    if at.ndim not in (2, 3):
        raise ValueError(f"position: expected hands x ticks x 2 or hands x 2, found the shape {at.shape}")
    ticks = at.shape[1] if at.ndim == 3 else 1
    arguments = Arguments()
    options = arguments.struct("WaleBatchOptions", hands=at.shape[0], ticks=ticks, position=pointer(at, "WaleVector"))
    motions = {"velocity": velocity, "acceleration": acceleration, "raw_velocity": raw_velocity,
               "raw_acceleration": raw_acceleration, "workspace": workspace}
    for name, values in motions.items():
        if values is None:
            continue
        array = vectors(values, name)
        if array.shape != at.shape:
            raise ValueError(f"{name}: expected the shape of position, {at.shape}, found {array.shape}")
        arguments.keep(array)
        setattr(options, name, pointer(array, "WaleVector"))
    if time is not None:
        times = numbers(time, np.float64, "time")
        if times.shape != (ticks,):
            raise ValueError(f"time: expected {ticks} numbers, found the shape {times.shape}")
        arguments.keep(times)
        options.time = pointer(times, "double")
    if button is not None:
        pressed = yes_or_no(button, np.bool_, "button")
        if pressed.shape != at.shape[:-1]:
            raise ValueError(f"button: expected the shape {at.shape[:-1]}, found {pressed.shape}")
        arguments.keep(pressed)
        options.button = pointer(pressed, "uint8_t")
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"settings: expected parameters by name, found {settings!r}")
    if settings:
        given = ffi.new("WaleSetting[]", len(settings))
        for each, (name, value) in zip(given, settings.items()):
            each.name, each.value = arguments.text(name, "settings"), number(value, name)
        options.settings, options.setting_count = given, len(settings)
        arguments.keep(given)
    if size is not None:
        options.width, options.height, options.rim = size_in_full(size)
    forces = np.empty_like(at)
    call(lib.wale_batch, held(program, Program, "program"), options, pointer(forces, "WaleVector"))
    return forces
