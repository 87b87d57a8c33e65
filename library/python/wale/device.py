"""Joysticks and pads, plugged in and simulated."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from wale._abi import Arguments, Handle, call, described, ffi, lib, made, number, pair, read, sized
from wale._arrays import numbers
from wale.codes import DeviceKind
from wale.errors import Error


@dataclass
class Profile:
    """The figures of a device in SI units, as WaleProfile in wale/device.h; 0: not declared.

    A device that pushes needs a `slew` (N/s) above 0: a run or a loop raises `unusable_device` otherwise.
    """

    name: str
    workspace_diameter: float
    position_counts: float
    force: float
    force_counts: float
    rate: float
    speed_limit: float
    slew: float
    continuous_force: float
    heating_seconds: float
    active_power: float
    velocity_window: float
    velocity_noise_counts: float
    patch_width: float
    patch_height: float
    patch_rim: float
    mass: float
    damping: float
    friction: float
    delay_x: float
    delay_y: float
    bandwidth_x: float
    bandwidth_y: float
    vibrates: bool
    has_position: bool

    @property
    def position_step(self) -> float:
        """Metres per encoder count; 0 without a position."""
        return self.workspace_diameter / self.position_counts if self.position_counts > 0 else 0.0


def profile_of(of: Any) -> Profile:
    names = Profile.__dataclass_fields__
    figures = {name: getattr(of, name) for name in names if name not in ("name", "vibrates", "has_position")}
    return Profile(name=read(of.name), vibrates=bool(of.vibrates), has_position=bool(of.has_position), **figures)


def profile(name: str) -> Profile:
    """The figures of a shipped device by the name of its profile."""
    arguments, of = Arguments(), sized("WaleProfile")
    call(lib.wale_profile, arguments.text(name, "name"), of)
    return profile_of(of)


@dataclass(frozen=True)
class DeviceInfo:
    """A device that `open_device` can open, or why it cannot."""

    spelling: str
    """For `open_device`: a port as "1-2", "pointer", "simulated:sandpaper"."""
    kind: DeviceKind
    name: str
    numbers: str
    profile: str
    """The name of the declaration with its figures; empty: none is about it."""
    is_generic: bool
    can: str
    """What a real one can do, in a line; may be empty."""
    held_by: str
    """Other programs that have it open."""
    obstacle: Error | None
    """Why it cannot be used now."""


def devices_of(pointer: Any) -> Sequence[DeviceInfo]:
    listed = ffi.gc(pointer, lib.wale_devices_free)

    def one(index: int) -> DeviceInfo:
        of = sized("WaleDeviceInfo")
        call(lib.wale_devices_info, listed, index, of)
        obstacle = described(of.obstacle) if of.obstacle else None
        return DeviceInfo(read(of.spelling), DeviceKind(of.kind), read(of.name), read(of.numbers), read(of.profile),
                          bool(of.is_generic), read(of.can), read(of.held_by), obstacle)

    return [one(i) for i in range(lib.wale_devices_count(listed))]


def devices() -> Sequence[DeviceInfo]:
    """All that is plugged in, also what cannot be used, then the pointer, then one simulation for each shipped device.

    `Library.devices` knows the owner's declarations too.
    """
    return devices_of(made(lib.wale_devices, "WaleDevices"))


@dataclass(frozen=True)
class Hand:
    """A simulated person's hand and arm: a mass (kg) on a spring (N/m) and a damper (N s/m).

    Spring and damper pull to where the motion aims. A hand with neither is only a mass.
    """

    mass: float
    damping: float = 0.0
    stiffness: float = 0.0


@dataclass(frozen=True)
class Motion:
    """What a simulated person aims for: see `rest`, `lateral`, `circular`, `press` and `trace`."""

    kind: str
    amplitude: float = 0.0
    frequency: float = 0.0
    centre: tuple[float, float] = (0.0, 0.0)
    direction: tuple[float, float] = (1.0, 0.0)
    points: ArrayLike | None = None

    @staticmethod
    def rest(position: tuple[float, float] = (0.0, 0.0)) -> "Motion":
        """A place, m."""
        return Motion("hold", centre=position)

    @staticmethod
    def lateral(amplitude: float, frequency: float, *, centre: tuple[float, float] = (0.0, 0.0),
                direction: tuple[float, float] = (1.0, 0.0)) -> "Motion":
        """A sine of `amplitude` (m to each side) and `frequency` (Hz) along `direction`."""
        return Motion("lateral", amplitude, frequency, centre, direction)

    @staticmethod
    def circular(radius: float, frequency: float, *, centre: tuple[float, float] = (0.0, 0.0)) -> "Motion":
        """A circle, counter-clockwise, of so many turns per second."""
        return Motion("circular", radius, frequency, centre)

    @staticmethod
    def press(depth: float, frequency: float, *, centre: tuple[float, float] = (0.0, 0.0),
              direction: tuple[float, float] = (1.0, 0.0)) -> "Motion":
        """Pushes of `depth` (m) along `direction`, so many per second."""
        return Motion("press", depth, frequency, centre, direction)

    @staticmethod
    def trace(points: ArrayLike) -> "Motion":
        """Rows of time (s), x and y (m); times rise, and between them the hand goes along a cubic."""
        return Motion("trace", points=points)


_kinds = ("rest", "hold", "lateral", "circular", "press", "trace")


class Device(Handle):
    """An opened joystick or pad. A stage that has it keeps it, so it may be closed at any time."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_device_free)

    @property
    def profile(self) -> Profile:
        of, held = sized("WaleProfile"), self._pointer  # whose texts are read
        call(lib.wale_device_profile, held, of)
        return profile_of(of)


def device_options(arguments: Arguments, *, built_for: str, transport: str, keeper: str | os.PathLike[str],
                   max_force: float, priority: int, disregard_owner: bool, hand: Hand | None,
                   motion: Motion | None) -> Any:
    """A WaleDeviceOptions."""
    options = arguments.struct("WaleDeviceOptions", built_for=built_for, transport=transport, keeper=keeper,
                               max_force=max_force, priority=priority, disregard_owner=disregard_owner)
    if hand is not None:
        if not isinstance(hand, Hand):
            raise TypeError(f"hand: expected a Hand, found {hand!r}")
        options.hand_mass, options.hand_damping = number(hand.mass, "mass"), number(hand.damping, "damping")
        options.hand_stiffness = number(hand.stiffness, "stiffness")
    if motion is not None:
        if not isinstance(motion, Motion):
            raise TypeError(f"motion: expected a Motion, found {motion!r}")
        if motion.kind not in _kinds:
            raise ValueError(f"motion: expected one of {', '.join(_kinds)}, found {motion.kind!r}")
        options.motion = getattr(lib, "WALE_MOTION_" + motion.kind)
        options.amplitude, options.frequency = number(motion.amplitude, "amplitude"), number(motion.frequency, "frequency")
        options.centre_x, options.centre_y = pair(motion.centre, "centre")
        options.direction_x, options.direction_y = pair(motion.direction, "direction")
        if motion.points is not None:
            rows = numbers(motion.points, np.float64, "points")
            if rows.ndim != 2 or rows.shape[1] != 3:
                raise ValueError("points: expected rows of time, x and y")
            arguments.keep(rows)
            options.points, options.count = ffi.cast("double*", rows.ctypes.data), len(rows)
    return options


def open_device(spelling: str = "auto", *, built_for: str = "", transport: str = "",
                keeper: str | os.PathLike[str] = "", max_force: float = 0.0, priority: int = 0,
                disregard_owner: bool = False, hand: Hand | None = None, motion: Motion | None = None) -> Device:
    """Opens a device as `--device` of the command line spells it, without the declarations of its owner.

    `max_force`: N at the handle, 0: no other limit than its own. `hand` and `motion` are those of a person at a simulated
    one, which nothing holds without a hand; a motion without one is an error. `Library.open_device` knows the owner's
    declarations and brings a hand.
    """
    arguments = Arguments()
    options = device_options(arguments, built_for=built_for, transport=transport, keeper=keeper, max_force=max_force,
                             priority=priority, disregard_owner=disregard_owner, hand=hand, motion=motion)
    return Device(made(lib.wale_device_open, "WaleDevice", arguments.text(spelling, "spelling"), options))
