"""What runs give: their state, their figures, their record, and what it felt like."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wale._abi import Arguments, Handle, call, described, ffi, held, lib, made, or_none, read, sized
from wale._arrays import dtype_of, pointer
from wale.errors import Error

if TYPE_CHECKING:
    from wale.stage import Patch

Vector = tuple[float, float]


@dataclass(frozen=True)
class Guards:
    """On how many ticks each guard changed the force."""

    not_a_number: int
    device_limit: int
    user_limit: int
    heat: int
    energy: int
    passivity: int
    slew: int
    overrun: int
    stale: int
    lost: int
    restored: int


def guards_of(of: Any) -> Guards:
    return Guards(*(getattr(of, name) for name in Guards.__dataclass_fields__))


@dataclass(frozen=True)
class Now:
    """The state of a run after its latest tick."""

    time: float
    """s since the run began."""
    lateness: float
    """s, how long after its deadline the tick began."""
    ticks_run: int
    ticks_missed: int
    revision: int
    """How often changes had been handed over to the loop."""
    patch: int
    """The `Patch.id` of the one that the hand is on; 0: none."""
    inside: bool
    position: Vector
    """Of the hand, m from the workspace's centre."""
    velocity: Vector
    """m/s."""
    force: Vector
    """N, the actuator's at that tick; of a pad its amplitude (m/s^2) and frequency (Hz).

    Also after the run, when the device exerts none; 0 after a run that failed.
    """
    guards: Guards


def now_of(of: Any) -> Now:
    return Now(of.time, of.lateness, of.ticks_run, of.ticks_missed, of.revision, of.patch, bool(of.inside),
               vector_of(of.position), vector_of(of.velocity), vector_of(of.force), guards_of(of.guards))


def vector_of(of: Any) -> Vector:
    return (of.x, of.y)


@dataclass(frozen=True)
class Times:
    """Statistics of a duration over the ticks of a run, s."""

    p50: float
    p99: float
    maximum: float


class Run(Handle):
    """The figures of a run that is over, and its record. It never changes."""

    def __init__(self, handle: Any) -> None:
        super().__init__(handle, lib.wale_run_free)
        of = sized("WaleRunFigures")
        call(lib.wale_run_figures, handle, of)
        self.ticks_run: int = of.ticks_run
        self.ticks_missed: int = of.ticks_missed
        self.lateness = Times(of.lateness_p50, of.lateness_p99, of.lateness_maximum)
        self.cost = Times(of.cost_p50, of.cost_p99, of.cost_maximum)
        """Of a tick; 0 in virtual time."""
        self.seconds_per_tick: float = of.seconds_per_tick
        self.guards = guards_of(of.guards)
        self.scheduling: str = read(of.scheduling)
        self.problem: Error | None = described(of.problem) if of.problem else None
        """Why the recording ended before the run."""
        self._recorded: int = of.recorded

    @property
    def ticks(self) -> NDArray[np.void]:
        """The record: an array with the fields of WaleTick (time, position, velocity, force, interaction, lateness, …).

        `patch` is the `Patch.id` of the one that the hand was on, 0 for none; `change` another number after each change of
        that patch's program, parameters or size.
        """
        ticks: NDArray[np.void] = np.zeros(self._recorded, dtype=dtype_of("WaleTick"))
        call(lib.wale_run_ticks, self._pointer, 0, len(ticks), ticks.itemsize, pointer(ticks, "WaleTick"))
        return ticks

    def measure(self, patch: "Patch", *, settling: float = 0.0, stuck_seconds: float = 0.0, stuck_counts: float = 0.0,
                least_crossings: int = 0) -> "Felt":
        """Measures what the hand felt of a patch, and reads the percepts of its program back through its maps.

        Only the ticks on this patch count, and of a patch that was changed during the run those after the last change.
        `settling`: s, left out at the beginning. 0 is the default of each option. Errors: `wrong_moment` for a patch of
        another stage, or one that was removed or changed since the run; `not_measured` if the hand was not on it, or the
        run kept no record (that of `Stage.start`).
        """
        options = Arguments().struct("WaleMeasureOptions", settling=settling, stuck_seconds=stuck_seconds,
                                     stuck_counts=stuck_counts, least_crossings=least_crossings)
        from wale.stage import Patch  # which needs this module

        felt = made(lib.wale_felt_measure, "WaleFelt", self._pointer, held(patch, Patch, "patch"), options)
        return _felt_of(ffi.gc(felt, lib.wale_felt_free))


@dataclass(frozen=True)
class ForceSize:
    """The size of a force over some ticks, N (of a pad m/s^2)."""

    p99: float
    maximum: float
    rms: float


@dataclass(frozen=True)
class Level:
    """A percept as what was measured is felt."""

    name: str
    predicted: float
    """The carrier's size that the program aims at, SI."""
    measured: float
    """The carrier's size; 0 if it was not measured."""
    level: float | None
    """1 is the percept's reference stimulus."""
    problem: Error | None
    """Why there is no level."""


@dataclass(frozen=True)
class Felt:
    """What came out of the handle. None: the hand's motion could not show it."""

    ticks: int
    ticks_rubbing: int
    crossings: int
    stuck: float
    force: ForceSize
    rubbing: ForceSize
    interaction: ForceSize | None
    drag: float | None
    viscosity: float | None
    stiffness: float | None
    wall_stiffness: float | None
    wall_damping: float | None
    mass: float | None
    shaking: float | None
    levels: Sequence[Level]


def _felt_of(felt: Any) -> Felt:
    of = sized("WaleFeltFigures")
    call(lib.wale_felt_figures, felt, of)

    def level(index: int) -> Level:
        one = sized("WaleFeltLevel")
        call(lib.wale_felt_level, felt, index, one)
        problem = described(one.problem) if one.problem else None
        return Level(read(one.name), one.predicted, one.measured, or_none(one.level), problem)

    def size(name: str) -> ForceSize:
        return ForceSize(*(getattr(of, f"{name}_{each}") for each in ("p99", "maximum", "rms")))

    interaction = size("interaction") if or_none(of.interaction_p99) is not None else None
    return Felt(of.ticks, of.ticks_rubbing, of.crossings, of.stuck, size("force"), size("rubbing"), interaction,
                or_none(of.drag), or_none(of.viscosity), or_none(of.stiffness), or_none(of.wall_stiffness),
                or_none(of.wall_damping), or_none(of.mass), or_none(of.shaking), [level(i) for i in range(of.levels)])
