"""Pictures of patches: states, grids, surfaces and marks."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wale._abi import Handle, call, ffi, lib, made, number, pair, read, sized
from wale._arrays import pointer, vectors
from wale.codes import MarkKind
from wale.placement import Placement


@dataclass(frozen=True)
class Mark:
    """A shape that the picture shows now, in m, rad and s from the patch's centre; its kind says what the values are."""

    kind: MarkKind
    colour: int
    """0xRRGGBB."""
    values: tuple[float, ...]


class Snapshot(Handle):
    """A copy of a patch's parameters and memory at one tick. It outlives patch and stage. One thread at a time uses it."""

    def __init__(self, handle: Any) -> None:
        super().__init__(handle, lib.wale_snapshot_free)

    @property
    def placement(self) -> Placement:
        """How the patch lay then: its place, for hands and places that count from the workspace's centre."""
        return Placement(made(lib.wale_snapshot_placement, "WalePlacement", self._pointer))

    @property
    def states(self) -> dict[str, float]:
        """The states' values by their names, SI."""
        count, held = ffi.new("size_t*"), self._pointer
        values = lib.wale_snapshot_states(held, count)
        return {read(lib.wale_snapshot_state_name(held, i)): values[i] for i in range(count[0])}

    @property
    def grids(self) -> dict[str, NDArray[np.float32]]:
        """The grids by their names: rows from the bottom, SI."""
        grids: dict[str, NDArray[np.float32]] = {}
        of, error, held = sized("WaleGrid"), ffi.NULL, self._pointer
        while lib.wale_snapshot_grid(held, len(grids), of, error) == 0:
            cells = np.frombuffer(ffi.buffer(of.cells, of.rows * of.columns * 4), dtype=np.float32)
            grids[read(of.name)] = cells.reshape(of.rows, of.columns).copy()
        return grids

    def surface(self, places: ArrayLike) -> NDArray[np.float32]:
        """The height (m, or a plain number) at places (m from the patch's centre): an array whose last axis is x and y."""
        at = vectors(places, "places")
        heights = np.zeros(at.shape[:-1], dtype=np.float32)
        call(lib.wale_snapshot_surface, self._pointer, pointer(at, "WaleVector"), heights.size, pointer(heights, "float"),
             ffi.NULL)
        return heights

    def colours(self, places: ArrayLike) -> NDArray[np.float32]:
        """Red, green and blue in 0 .. 1 at places; 0 for a program without colours."""
        at = vectors(places, "places")
        heights = np.zeros(at.shape[:-1], dtype=np.float32)
        colours = np.zeros((*at.shape[:-1], 3), dtype=np.float32)
        call(lib.wale_snapshot_surface, self._pointer, pointer(at, "WaleVector"), heights.size, pointer(heights, "float"),
             pointer(colours, "float"))
        return colours

    def show(self, position: tuple[float, float] = (0.0, 0.0), velocity: tuple[float, float] = (0.0, 0.0),
             time: float = 0.0) -> list[Mark]:
        """The shapes that the picture shows for a hand, in the order of drawing.

        `position` counts from the patch's centre (m, m/s, s); `Now.position` counts from the workspace's, so take
        `placement.at` from it.
        """
        hand = [ffi.new("WaleVector*", pair(each, name))[0] for name, each in (("position", position), ("velocity", velocity))]
        count = ffi.new("size_t*")
        call(lib.wale_snapshot_show, self._pointer, *hand, number(time, "time"), ffi.NULL, 0, count)
        marks = ffi.new("WaleMark[]", max(1, count[0]))
        call(lib.wale_snapshot_show, self._pointer, *hand, time, marks, count[0], count)
        return [Mark(MarkKind(marks[i].kind), marks[i].colour, tuple(marks[i].values)) for i in range(count[0])]
