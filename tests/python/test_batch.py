"""Many hands at once."""

import math

import numpy as np
import pytest
import wale


def test_a_spring_against_its_formula(library: wale.Library) -> None:
    program = library.compile("wale 1\nmaterial m {\n  physical {\n    param k = 30 N/m in 1 N/m .. 100 N/m\n"
                              "    force = -k * hand - 2 N s/m * velocity\n  }\n}\n")
    rate = wale.profile("sandpaper").rate
    random = np.random.default_rng(1995)
    position = np.cumsum(random.normal(0, 1e-4, (500, 40, 2)).astype(np.float32), axis=1)
    velocity = np.zeros_like(position)
    velocity[:, 1:] = np.diff(position, axis=1) * np.float32(rate)
    expected = -30 * position - 2 * velocity
    assert np.abs(wale.batch(program, position) - expected).max() < 1e-4  # N
    still = wale.batch(program, position, velocity=np.zeros_like(position), settings={"k": 10})
    assert np.abs(still + 10 * position).max() < 1e-4


def test_no_force_beyond_the_edge(library: wale.Library) -> None:
    spring = library.compile("wale 1\nmaterial m { physical { force = -100 N/m * hand } }\n")
    position = np.array([[9.9e-3, 0], [10.1e-3, 0], [0, -19e-3], [0, 21e-3], [3e-3, -4e-3]])
    inside = (np.abs(position) <= [0.01, 0.02]).all(axis=1)
    forces = wale.batch(spring, position, size=(0.02, 0.04))
    assert forces == pytest.approx(np.where(inside[:, None], -100 * position, 0), abs=1e-6)
    assert not wale.batch(spring, [[0.2, 0.2]], size=(1000, 1000)).any()  # the workspace is 229 mm wide


def test_hands_are_independent(corduroy: wale.Program) -> None:
    random = np.random.default_rng(7)
    position = random.uniform(-0.01, 0.01, (1000, 12, 2))
    forces = wale.batch(corduroy, position)
    assert forces.shape == position.shape and forces.dtype == np.float32
    shuffled = random.permutation(1000)
    assert wale.batch(corduroy, position[shuffled]).tobytes() == forces[shuffled].tobytes()
    assert wale.batch(corduroy, position[3:4]).tobytes() == forces[3:4].tobytes()
    assert wale.batch(corduroy, position[:, 0]).tobytes() == forces[:, 0].tobytes()


def test_states_go_from_tick_to_tick(library: wale.Library) -> None:
    program = library.compile("wale 1\nmaterial m {\n  physical {\n    state n = 0 in 0 .. 1000\n    n' = 1 Hz\n"
                              "    force = vector(n * 1 N, 0 N)\n  }\n}\n")
    forces = wale.batch(program, np.zeros((5, 30, 2)))
    assert forces[:, :, 0] == pytest.approx(np.tile(np.arange(30) / program.rate, (5, 1)), abs=1e-6)


def test_time_and_button_are_given(library: wale.Library) -> None:
    program = library.compile("wale 1\nmaterial m {\n  physical {\n    active 1 W\n"
                              "    force = vector(time * 0.1 N/s, if button then 0.2 N else 0 N)\n  }\n}\n")
    button = np.array([[False, True, False]] * 4)
    forces = wale.batch(program, np.zeros((4, 3, 2)), time=[1, 2, 3], button=button)
    assert forces[:, :, 0] == pytest.approx(np.tile([0.1, 0.2, 0.3], (4, 1)))
    assert forces[:, :, 1] == pytest.approx(0.2 * button)


def test_wrong_arrays(corduroy: wale.Program) -> None:
    for shape in [(), (3,), (2, 3), (2, 3, 4, 2), (5, 7, 3)]:
        with pytest.raises(ValueError):
            wale.batch(corduroy, np.zeros(shape))
    for size in [(0, 0), (-1, 1)]:
        with pytest.raises(wale.Error, match="positive"):
            wale.batch(corduroy, np.zeros((2, 3, 2)), size=size)
    for size, name in [((0.02, -1), "height"), ((math.nan, 0.02), "width")]:
        with pytest.raises(wale.Error, match=name):
            wale.batch(corduroy, np.zeros((2, 3, 2)), size=size)
    position = np.zeros((2, 3, 2))
    with pytest.raises(ValueError, match="position: expected numbers, found masked"):
        wale.batch(corduroy, np.ma.masked_array(position, mask=position == 0))
    assert (wale.batch(corduroy, np.ma.masked_array(position)) == wale.batch(corduroy, position)).all()
    for wrong in [{"velocity": np.zeros((2, 2, 2))}, {"time": [1, 2]}, {"button": np.zeros((2, 2))}]:
        with pytest.raises(ValueError):
            wale.batch(corduroy, position, **wrong)
    for name in ["velocity", "raw_velocity", "acceleration", "raw_acceleration", "workspace"]:
        with pytest.raises(wale.Error, match=name):
            wale.batch(corduroy, position, **{name: np.full((2, 3, 2), math.nan)})
    for wrong in [{"settings": {"whale": 1}}, {"settings": {"wale": math.nan}}, {"size": (-1, 1)}]:
        with pytest.raises(wale.Error):
            wale.batch(corduroy, position, **wrong)
    with pytest.raises(wale.Error):
        wale.batch(corduroy, np.zeros((0, 3, 2)))
    with pytest.raises(wale.Error):
        wale.batch(corduroy, np.full((2, 3, 2), math.nan))
