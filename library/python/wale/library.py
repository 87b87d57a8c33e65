"""Materials and levels by name."""

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from wale._abi import Arguments, Handle, bytes_of, call, ffi, lib, made, number, sized
from wale.device import Device, DeviceInfo, Hand, Motion, Profile, device_options, devices_of, profile_of
from wale.program import Program
from wale.workspace import Workspace


class Future(Handle):
    """A program that is being made. One thread at a time uses it."""

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


class Library(Handle):
    """Materials and levels by name, compiled for a device. The answers are those of the command line.

    `folders` are searched besides the shipped library. All calls are safe from any thread. `device` is the name of a
    profile; empty: "sandpaper". `material` is one of a text that has several. `devices` is a Wale text that declares the
    application's own devices, each as `export device NAME { … }`: `device` may name one, also for shipped materials.
    `wale.Stage(library.profile(NAME))` with a `wale.Loop` serves it.
    """

    def __init__(self, folders: Iterable[str | os.PathLike[str]] = (), *, unsandboxed_pictures: bool = False,
                 devices: str = "") -> None:
        if isinstance(folders, (str, bytes, os.PathLike)):
            raise TypeError(f"folders: expected a list of folders, found one: write [{folders!r}]")
        if not isinstance(folders, Iterable):
            raise TypeError(f"folders: expected a list of folders, found {folders!r}")
        arguments = Arguments()
        texts = [arguments.text(each, "folders") for each in folders]
        array = ffi.new("WaleText[]", texts) if texts else ffi.NULL
        options = arguments.struct("WaleLibraryOptions", folders=array, folder_count=len(texts),
                                   unsandboxed_pictures=unsandboxed_pictures, devices=devices)
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

    def devices(self) -> Sequence[DeviceInfo]:
        """As `wale.devices`, with the declarations of the owner of this computer."""
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

        A simulated one is in the hand of a simulated person who rubs to and fro, unless `hand` or `motion` are given.
        """
        arguments = Arguments()
        options = device_options(arguments, built_for=built_for, transport=transport, keeper=keeper,
                                 max_force=max_force, priority=priority, disregard_owner=False, hand=hand, motion=motion)
        return Device(made(lib.wale_library_open_device, "WaleDevice", self._pointer, arguments.text(spelling, "spelling"), options))


def _level(level: str | float) -> str:
    return level if isinstance(level, str) else repr(number(level, "level"))
