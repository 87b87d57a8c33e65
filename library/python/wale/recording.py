"""Recordings of runs."""

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wale._abi import Arguments, Handle, call, ffi, lib, made, read, sized, whole
from wale._arrays import dtype_of, pointer


@dataclass(frozen=True)
class Replay:
    """How a replay compares with its recording."""

    ticks: int
    differing: int
    """Ticks that are not bit for bit as recorded."""
    largest_force: float
    """The largest difference of the commanded force, N or m/s^2."""


class Recording(Handle):
    """A file that a run made (`Stage(record=…)`). It never changes.

    `most_ticks`: only its first ones are read, as those before a damage, which `Recording.intact(path)` counts.
    """

    def __init__(self, path: str | os.PathLike[str], *, most_ticks: int | None = None) -> None:
        arguments, of = Arguments(), sized("WaleRecordingDetails")
        if most_ticks is not None and whole(most_ticks, "most_ticks") < 0:
            raise ValueError(f"most_ticks: expected a number that is not negative, found {most_ticks}")
        super().__init__(made(lib.wale_recording_open_part, "WaleRecording", arguments.text(path, "path"),
                              2**63 if most_ticks is None else min(whole(most_ticks, "most_ticks"), 2**63)),
                         lib.wale_recording_free)
        call(lib.wale_recording_details, self._pointer, of)
        self.device: str = read(of.device)
        self.hand: str = read(of.hand)
        """What moved the handle; empty if that is not known."""
        self.rate: float = of.rate
        """Hz."""
        self.position_step: float = of.position_step
        """m per encoder count."""
        self.max_force: float = of.max_force
        """N, infinite without a limit."""
        self.complete: bool = bool(of.complete)
        self.virtual_time: bool = bool(of.virtual_time)
        self._count: int = of.ticks

    @staticmethod
    def intact(path: str | os.PathLike[str]) -> int:
        """How many ticks of a file can be read: all of a whole one, else those before the place where it is damaged or cut.

        The first 320 KiB hold the conditions and the first events: of a file cut there nothing is left.
        """
        arguments, ticks = Arguments(), ffi.new("uint64_t*")
        call(lib.wale_recording_intact, arguments.text(path, "path"), ticks)
        return int(ticks[0])

    def __len__(self) -> int:
        return self._count

    @property
    def ticks(self) -> NDArray[np.void]:
        """An array with the fields of WaleRecordedTick: counts, velocity, wanted, commanded, force, guards, …

        `patch` is the `Patch.number` of the one that the hand was on, 0xffffffff for none.
        """
        ticks: NDArray[np.void] = np.zeros(self._count, dtype=dtype_of("WaleRecordedTick"))
        call(lib.wale_recording_ticks, self._pointer, 0, len(ticks), ticks.itemsize, pointer(ticks, "WaleRecordedTick"))
        return ticks

    def replay(self) -> Replay:
        """Runs the recorded programs on the recorded counts again and compares bit for bit."""
        of = sized("WaleReplay")
        call(lib.wale_recording_replay, self._pointer, of)
        return Replay(of.ticks, of.differing, of.largest_force)
