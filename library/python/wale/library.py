"""Materials and levels by name."""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wale._abi import Arguments, Handle, bytes_of, call, described, ffi, lib, made, number, pair, read, sized
from wale.device import Device, DeviceInfo, Hand, Motion, Profile, device_options, devices_of, profile_of
from wale.errors import Error
from wale.program import Program
from wale.workspace import Workspace


@dataclass(frozen=True)
class FeltDistance:
    """How much two materials differ to the hand, in just noticeable differences at d' = 1."""

    low: float
    """The largest difference that is known."""
    high: float
    """Infinite if nothing bounds it."""
    unknown: tuple[str, ...]
    """The cues or percepts that are not known, and widen it."""
    plainest: str
    """The cue or percept that differs most; empty if none does."""


@dataclass(frozen=True)
class Match:
    """A material that was found; `module:name` is a name for `Library.find`."""

    name: str
    module: str
    file: str
    title: str
    kind: str
    found_by: str
    """Where it has the sought words, "name", "title", "called" and so on; empty if none were sought."""
    found_in: str
    score: float
    """Of its words; 0 if it has all of them as they stand: then the place orders."""
    distance: FeltDistance | None
    """By feel: from what was sought; of `between`, from the first."""
    from_other: FeltDistance | None
    """Of `between`: from the second."""


@dataclass(frozen=True)
class SearchResult:
    """What a search found, the best first, and what the owner of the index should know."""

    matches: tuple[Match, ...]
    warnings: tuple[Error, ...]


class Future(Handle):
    """A program that is being made, or a search. One thread at a time uses it."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_future_free)

    def poll(self) -> bool:
        """Whether it is ready."""
        return bool(lib.wale_future_poll(self._pointer))

    def wait(self, seconds: float = float("inf")) -> bool:
        """Waits until it is ready, for so many seconds at most. Returns whether it is."""
        return bool(lib.wale_future_wait(self._pointer, number(seconds, "seconds")))

    def take(self) -> Program:
        """Waits and gives the program, once."""
        return Program(made(lib.wale_future_take, "WaleProgram", self._pointer))

    def progress(self) -> tuple[int, int]:
        """How many files of the library are read for a search's index, of how many; both 0 if there is nothing to read."""
        done, of = ffi.new("size_t*"), ffi.new("size_t*")
        lib.wale_future_progress(self._pointer, done, of)
        return (done[0], of[0])

    def cancel(self) -> None:
        """Ends that reading. What was read is kept, where an index can be."""
        lib.wale_future_cancel(self._pointer)

    def take_matches(self) -> SearchResult:
        """Waits and gives what a search found, once."""
        return _found(made(lib.wale_future_take_matches, "WaleMatches", self._pointer))


class Library(Handle):
    """Materials and levels by name, compiled for a device. The answers are those of the command line.

    `folders` are searched besides the shipped library. `index` is the one in which `search`, `nearest` and `between` look as
    it stands, a file or the address of a database; by default one in the user's cache. All calls are safe from any thread.
    `device` is the name of a profile; empty: "sandpaper". `material` is one of a text that has several. `devices` is a Wale
    text that declares the application's own devices, each as `export device NAME { … }`: `device` may name one, also for
    shipped materials. `wale.Stage(library.profile(NAME))` with a `wale.Loop` serves it.
    """

    def __init__(self, folders: Iterable[str | os.PathLike[str]] = (), *, unsandboxed_pictures: bool = False,
                 index: str | os.PathLike[str] = "", devices: str = "") -> None:
        if isinstance(folders, (str, bytes, os.PathLike)):
            raise TypeError(f"folders: expected a list of folders, found one: write [{folders!r}]")
        if not isinstance(folders, Iterable):
            raise TypeError(f"folders: expected a list of folders, found {folders!r}")
        arguments = Arguments()
        texts = [arguments.text(each, "folders") for each in folders]
        array = ffi.new("WaleText[]", texts) if texts else ffi.NULL
        options = arguments.struct("WaleLibraryOptions", folders=array, folder_count=len(texts),
                                   unsandboxed_pictures=unsandboxed_pictures, index=index, devices=devices)
        super().__init__(made(lib.wale_library_create, "WaleLibrary", options), lib.wale_library_free)

    def _make(self, function: Any, texts: Mapping[str, str | os.PathLike[str]], kind: str, **options: str) -> Any:
        arguments = Arguments()
        wanted = [arguments.text(each, name) for name, each in texts.items()]
        return made(function, kind, self._pointer, *wanted, arguments.struct("WaleCompileOptions", **options))

    def find(self, name: str, *, device: str = "", material: str = "") -> Program:
        """A material by its name ("corduroy"), title, other name, kind or module ("fabric.denim").

        Materials in the current folder take precedence over the shipped ones, and so do those of the whole project if a
        file `wale.project` lies in that folder or above it, and those of `folders`: `Program.taken` says so.
        """
        return Program(self._make(lib.wale_library_find, {"name": name}, "WaleProgram", device=device, material=material))

    def level(self, percept: str, level: str | float, *, device: str = "") -> Program:
        """A surface with a level of a percept: a named level ("coarse") or a number from 0 to 1."""
        return Program(self._make(lib.wale_library_level, {"percept": percept, "level": _level(level)}, "WaleProgram", device=device))

    def compile(self, text: str, *, device: str = "", material: str = "", name: str = "text") -> Program:
        """The text of a Wale file; errors call it `name`."""
        return Program(self._make(lib.wale_library_compile, {"text": text}, "WaleProgram", device=device, material=material, name=name))

    def open(self, path: str | os.PathLike[str], *, device: str = "", material: str = "") -> Program:
        """A Wale file (.wale) or a patch program (.wpp)."""
        return Program(
            self._make(lib.wale_library_open, {"path": path}, "WaleProgram", device=device, material=material))

    def open_bytes(self, data: bytes, *, device: str = "", material: str = "", name: str = "text") -> Program:
        """The same for the bytes of such a file."""
        arguments = Arguments()
        options = arguments.struct("WaleCompileOptions", device=device, material=material, name=name)
        return Program(made(lib.wale_library_open_bytes, "WaleProgram", self._pointer, *bytes_of(data, "data"), options))

    def _workspace(self, function: Any, text: str | os.PathLike[str], **options: str | int) -> Workspace:
        arguments = Arguments()
        wanted = arguments.text(text)
        return Workspace(made(function, "WaleWorkspace", self._pointer, wanted, arguments.struct("WaleWorkspaceOptions", **options)))

    def workspace(self, text: str, *, device: str = "", workspace: str = "", name: str = "text",
                  legibility: bool = False) -> Workspace:
        """A workspace of the text of a Wale file, by default its first; errors call the text `name`.

        With `legibility` it warns also of what a hand cannot tell, which takes up to a second for each material.
        """
        return self._workspace(lib.wale_library_workspace, text, device=device, workspace=workspace, name=name,
                               legibility=legibility)

    def open_workspace(self, path: str | os.PathLike[str], *, device: str = "", workspace: str = "",
                       legibility: bool = False) -> Workspace:
        """The same of a Wale file (.wale), or a workspace file (.wws)."""
        return self._workspace(lib.wale_library_open_workspace, path, device=device, workspace=workspace,
                               legibility=legibility)

    def find_later(self, name: str, *, device: str = "", material: str = "") -> Future:
        """As `find`, on a thread of the library's own; so the other calls that end in `_later`."""
        return Future(self._make(lib.wale_library_find_later, {"name": name}, "WaleFuture", device=device, material=material))

    def level_later(self, percept: str, level: str | float, *, device: str = "") -> Future:
        return Future(self._make(lib.wale_library_level_later, {"percept": percept, "level": _level(level)}, "WaleFuture", device=device))

    def compile_later(self, text: str, *, device: str = "", material: str = "", name: str = "text") -> Future:
        return Future(
            self._make(lib.wale_library_compile_later, {"text": text}, "WaleFuture", device=device, material=material, name=name))

    def open_later(self, path: str | os.PathLike[str], *, device: str = "", material: str = "") -> Future:
        return Future(
            self._make(lib.wale_library_open_later, {"path": path}, "WaleFuture", device=device, material=material))

    def _search(self, function: Any, kind_made: str, texts: Mapping[str, str | os.PathLike[str]],
                percepts: Mapping[str, float | tuple[float, float]], **options: Any) -> Any:
        arguments = Arguments()
        ranges = []
        for name, level in percepts.items():
            low, high = pair(level, "percepts") if isinstance(level, (tuple, list)) else (number(level, "percepts"),) * 2
            ranges.append({"percept": arguments.text(name, "percepts"), "low": low, "high": high})
        array = ffi.new("WalePerceptRange[]", ranges) if ranges else ffi.NULL
        arguments.keep(array)
        given = arguments.struct("WaleSearchOptions", percepts=array, percept_count=len(ranges), **options)
        return made(function, kind_made, self._pointer, *(arguments.text(each, name) for name, each in texts.items()), given)

    def search(self, text: str = "", *, kind: str = "", percepts: Mapping[str, float | tuple[float, float]] = {},
               near: str | os.PathLike[str] = "", most: int = 0, device: str = "") -> SearchResult:
        """Materials by words, by how they feel, or both, as `wale find`.

        `percepts` are levels that they are to be near to, or ranges: `{"roughness": (0.4, 0.6), "stickiness": 0.2}`.
        `near` is a material that they are to feel like. By feel, the first search of a library reads all of it for an index
        that is kept, which takes from seconds to minutes: `search_later` shows how far it is, and can end it.
        """
        return _found(self._search(lib.wale_library_search, "WaleMatches", {"text": text}, percepts, kind=kind, near=near,
                                   most=most, device=device))

    def nearest(self, material: str | os.PathLike[str], *, kind: str = "",
                percepts: Mapping[str, float | tuple[float, float]] = {}, most: int = 0, device: str = "") -> SearchResult:
        """Those that feel most like a material, which is not among them."""
        return _found(self._search(lib.wale_library_nearest, "WaleMatches", {"material": material}, percepts, kind=kind,
                                   most=most, device=device))

    def between(self, one: str | os.PathLike[str], other: str | os.PathLike[str], *, kind: str = "", most: int = 0,
                device: str = "") -> SearchResult:
        """Those that are nearer to each of two materials than these are to each other."""
        return _found(self._search(lib.wale_library_between, "WaleMatches", {"one": one, "other": other}, {}, kind=kind,
                                   most=most, device=device))

    def search_later(self, text: str = "", *, kind: str = "", percepts: Mapping[str, float | tuple[float, float]] = {},
                     near: str | os.PathLike[str] = "", most: int = 0, device: str = "") -> Future:
        return Future(self._search(lib.wale_library_search_later, "WaleFuture", {"text": text}, percepts, kind=kind,
                                         near=near, most=most, device=device))

    def nearest_later(self, material: str | os.PathLike[str], *, kind: str = "",
                      percepts: Mapping[str, float | tuple[float, float]] = {}, most: int = 0, device: str = "") -> Future:
        return Future(self._search(lib.wale_library_nearest_later, "WaleFuture", {"material": material}, percepts,
                                         kind=kind, most=most, device=device))

    def between_later(self, one: str | os.PathLike[str], other: str | os.PathLike[str], *, kind: str = "", most: int = 0,
                      device: str = "") -> Future:
        return Future(self._search(lib.wale_library_between_later, "WaleFuture", {"one": one, "other": other}, {},
                                         kind=kind, most=most, device=device))

    def devices(self) -> Sequence[DeviceInfo]:
        """As `wale.devices`, with the declarations of the owner of this computer, and a simulation of each device that the
        text `devices` of this library declares."""
        return devices_of(made(lib.wale_library_devices, "WaleDevices", self._pointer))

    def profile(self, name: str) -> Profile:
        """As `wale.profile`, also of a device that the owner declares, or the text `devices` of this library."""
        arguments, of, library = Arguments(), sized("WaleProfile"), self._pointer  # whose texts are read
        call(lib.wale_library_profile, library, arguments.text(name, "name"), of)
        return profile_of(of)

    def open_device(self, spelling: str = "auto", *, built_for: str = "", transport: str = "",
                    keeper: str | os.PathLike[str] = "", max_force: float = 0.0, priority: int = 0,
                    hand: Hand | None = None, motion: Motion | None = None) -> Device:
        """Opens a device as `--device` of the command line spells it, with the declarations of its owner.

        The devices of the text `devices` of this library are simulated by name. A simulated one
        is in the hand of a simulated person who rubs to and fro, unless `hand` (not all 0) or `motion` are given.
        """
        arguments = Arguments()
        options = device_options(arguments, built_for=built_for, transport=transport, keeper=keeper,
                                 max_force=max_force, priority=priority, disregard_owner=False, hand=hand, motion=motion)
        return Device(made(lib.wale_library_open_device, "WaleDevice", self._pointer, arguments.text(spelling, "spelling"), options))


def _found(pointer: Any) -> SearchResult:
    held = ffi.gc(pointer, lib.wale_matches_free)

    def distance(low: float, high: float, plainest: Any, unknown: Any, count: int, index: int) -> FeltDistance | None:
        if low != low:
            return None
        return FeltDistance(low, high, tuple(read(unknown(held, index, i)) for i in range(count)), read(plainest))

    matches = []
    for index in range(lib.wale_matches_count(held)):
        of = sized("WaleMatch")
        call(lib.wale_matches_match, held, index, of)
        matches.append(Match(
            name=read(of.name), module=read(of.module), file=read(of.file), title=read(of.title), kind=read(of.kind),
            found_by=read(of.found_by), found_in=read(of.found_in), score=of.score,
            distance=distance(of.low, of.high, of.plainest, lib.wale_matches_unknown, of.unknown, index),
            from_other=distance(of.other_low, of.other_high, of.other_plainest, lib.wale_matches_other_unknown,
                                of.other_unknown, index)))
    warnings: list[Error] = []
    while warning := lib.wale_matches_warning(held, len(warnings)):
        warnings.append(described(warning))
    return SearchResult(tuple(matches), tuple(warnings))


def _level(level: str | float) -> str:
    return level if isinstance(level, str) else repr(number(level, "level"))
