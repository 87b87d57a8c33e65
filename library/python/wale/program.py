"""Patch programs."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from wale._abi import Handle, bytes_of, call, described, ffi, lib, made, read, sized
from wale.codes import FateKind
from wale.device import Profile, profile_of
from wale.errors import Error


@dataclass(frozen=True)
class Parameter:
    """A quantity that can be changed while the program runs. Values are in SI units; shown = value / unit_in_si."""

    name: str
    description: str
    unit: str
    si_unit: str
    unit_in_si: float
    value: float
    low: float
    high: float
    soft_low: float
    soft_high: float


@dataclass(frozen=True)
class Percept:
    """A percept of a program."""

    name: str
    carrier: str
    unit: str
    map: str
    source: str
    parameter: str | None
    """The parameter that is its level, if there is one."""
    amplitude: float
    """The carrier's size that the program aims at with its default parameters, in `unit`."""
    level: float
    """The level that this size is felt as, by the map."""
    valid: tuple[float, float]
    """The sizes for which the map was measured."""


@dataclass(frozen=True)
class Fate:
    """What becomes, on the device, of a percept that the text asks for, or of a part of its physics."""

    name: str
    is_percept: bool
    fate: FateKind
    """Of what is saturated the program itself cuts the force, so that no guard of a run counts it."""
    asked: float
    given: float
    """Levels of a percept; `given` is 0 if it is lost; both are 0 for physics."""
    reason: str


class Program(Handle):
    """A verified patch program, ready to run, with the warnings about its text. It never changes."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_program_free)
        details = sized("WaleProgramDetails")
        call(lib.wale_program_details, pointer, details)
        self.material: str = read(details.material)
        self.device: str = read(details.device)
        """The name of the profile that it is built for."""
        self.taken: str = read(details.taken)
        """If the name could have meant another material too: which one was taken; mostly empty."""
        self.size: tuple[float, float, float] = (details.width, details.height, details.rim)
        """m, width, height and rim of a patch whose size nobody gives."""
        self.rate: float = details.rate
        """Hz, ticks per second of its device."""
        self.vibrates: bool = bool(details.vibrates)
        self.has_colour: bool = bool(details.has_colour)
        self._counts = (details.parameters, details.percepts, details.warnings, details.fates)

    @staticmethod
    def load(data: bytes) -> "Program":
        """Reads and verifies the bytes of a .wpp file."""
        return Program(made(lib.wale_program_load, "WaleProgram", *bytes_of(data, "data")))

    def __bytes__(self) -> bytes:
        """The bytes of its .wpp file; equal programs give equal bytes on every machine."""
        length = ffi.new("size_t*")
        call(lib.wale_program_bytes, self._pointer, ffi.NULL, 0, length)
        data = bytearray(length[0])
        call(lib.wale_program_bytes, self._pointer, ffi.from_buffer(data), len(data), length)
        return bytes(data)

    @property
    def parameters(self) -> Sequence[Parameter]:
        def one(index: int) -> Parameter:
            of = sized("WaleParameter")
            call(lib.wale_program_parameter, held, index, of)
            return Parameter(read(of.name), read(of.description), read(of.unit), read(of.si_unit), of.unit_in_si, of.value,
                             of.low, of.high, of.soft_low, of.soft_high)

        held = self._pointer  # whose texts are read
        return [one(i) for i in range(self._counts[0])]

    @property
    def percepts(self) -> Sequence[Percept]:
        names = [each.name for each in self.parameters]

        def one(index: int) -> Percept:
            of = sized("WalePercept")
            call(lib.wale_program_percept, held, index, of)
            parameter = names[of.parameter] if of.parameter >= 0 else None
            return Percept(read(of.name), read(of.carrier), read(of.unit), read(of.map), read(of.source), parameter,
                           of.amplitude, of.level, (of.valid_low, of.valid_high))

        held = self._pointer
        return [one(i) for i in range(self._counts[1])]

    @property
    def fates(self) -> Sequence[Fate]:
        """Of the percepts in the order asked for, then of the physics."""

        def one(index: int) -> Fate:
            of = sized("WaleFate")
            call(lib.wale_program_fate, held, index, of)
            return Fate(read(of.name), bool(of.is_percept), FateKind(of.fate), of.asked, of.given, read(of.reason))

        held = self._pointer
        return [one(i) for i in range(self._counts[3])]

    @property
    def profile(self) -> Profile:
        """The figures of the device that it is built for, also of one that only its text declares."""
        of, held = sized("WaleProfile"), self._pointer  # whose texts are read
        call(lib.wale_program_profile, held, of)
        return profile_of(of)

    @property
    def warnings(self) -> Sequence[Error]:
        """About its text, in the order of their places."""
        held = self._pointer
        return [described(lib.wale_program_warning(held, i)) for i in range(self._counts[2])]
