"""Workspaces: materials that are laid out side by side."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from wale._abi import Handle, bytes_of, call, described, ffi, lib, made, or_none, read, sized
from wale.errors import Error
from wale.program import Program
from wale.run import Vector
from wale.shape import Shape


@dataclass(frozen=True)
class SliderMark:
    """A range of a slider that a person has marked: from here to here it still felt like `says`."""

    slider: str
    is_percept: bool
    """Whether the range is one of levels, 0 .. 1; otherwise it is in SI units."""
    low: float | None
    high: float | None
    says: str


@dataclass(frozen=True)
class WorkspacePatch:
    """A patch of a workspace. Lengths are m."""

    name: str
    made_of: str
    """Its material as the author wrote it: "denim(roughness: 0.3)"."""
    program: Program
    at: Vector
    size: tuple[float, float, float]
    """Width, height and rim."""
    shape: Shape | None
    """None for a patch that covers its rectangle."""
    marks: Sequence[SliderMark]
    statement: tuple[int, int]
    """Where it stands in its text, bytes from and up to; (0, 0) for a workspace file."""


class Workspace(Handle):
    """Materials that are laid out side by side, compiled for one device. It never changes."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_workspace_free)
        details = sized("WaleWorkspaceDetails")
        call(lib.wale_workspace_details, pointer, details)
        self.name: str = read(details.name)
        self.documentation: str = read(details.documentation)
        self.device: str = read(details.device)
        """The name of the profile that its programs are built for; empty without a patch."""
        self._counts = (details.patches, details.warnings)

    @staticmethod
    def load(data: bytes) -> "Workspace":
        """Reads and verifies the bytes of a .wws file."""
        return Workspace(made(lib.wale_workspace_load, "WaleWorkspace", *bytes_of(data, "data")))

    def __bytes__(self) -> bytes:
        """The bytes of its .wws file; equal workspaces give equal bytes on every machine."""
        length = ffi.new("size_t*")
        call(lib.wale_workspace_bytes, self._pointer, ffi.NULL, 0, length)
        data = bytearray(length[0])
        call(lib.wale_workspace_bytes, self._pointer, ffi.from_buffer(data), len(data), length)
        return bytes(data)

    def __len__(self) -> int:
        """How many patches it has."""
        return int(self._counts[0])

    @property
    def patches(self) -> Sequence[WorkspacePatch]:
        """The last lies in front."""
        held = self._pointer  # whose texts are read
        return [_patch_of(held, i) for i in range(len(self))]

    @property
    def warnings(self) -> Sequence[Error]:
        """About its text, in the order of their places."""
        held = self._pointer
        return [described(lib.wale_workspace_warning(held, i)) for i in range(self._counts[1])]


def _patch_of(workspace: Any, index: int) -> WorkspacePatch:
    of = sized("WaleWorkspacePatch")
    call(lib.wale_workspace_patch, workspace, index, of)
    program = Program(made(lib.wale_workspace_program, "WaleProgram", workspace, index))
    shape = Shape(made(lib.wale_workspace_shape, "WaleShape", workspace, index)) if of.has_shape else None
    marks = [_mark_of(workspace, index, i) for i in range(of.marks)]
    return WorkspacePatch(read(of.name), read(of.made_of), program, (of.x, of.y), (of.width, of.height, of.rim), shape,
                          marks, (of.text_begin, of.text_end))


def _mark_of(workspace: Any, patch: int, index: int) -> SliderMark:
    of = sized("WaleWorkspaceMark")
    call(lib.wale_workspace_mark, workspace, patch, index, of)
    return SliderMark(read(of.slider), bool(of.is_percept), or_none(of.low), or_none(of.high), read(of.says))


def load_workspace(path: str | os.PathLike[str]) -> Workspace:
    """Reads a workspace file, which `wale build --workspace` makes."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as why:
        raise Error.of_file(os.fsdecode(path), why) from why
    return Workspace.load(data)
