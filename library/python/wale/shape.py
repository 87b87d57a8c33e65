"""What part of its rectangle a patch covers."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from wale._abi import Handle, ffi, lib, made, number, pair
from wale._arrays import numbers, yes_or_no
from wale.run import Vector, vector_of


class Shape(Handle):
    """An ellipse, a polygon or the set cells of a mask, m from the patch's centre; y grows towards the top.

    A patch of another size than the shape's stretches it. Errors: `malformed_value`.
    """

    def __init__(self, pointer: object) -> None:
        super().__init__(pointer, lib.wale_shape_free)

    @staticmethod
    def ellipse(half_width: float, half_height: float) -> "Shape":
        """Half axes, m."""
        return Shape(made(lib.wale_shape_ellipse, "WaleShape", number(half_width, "half_width"),
                          number(half_height, "half_height")))

    @staticmethod
    def polygon(corners: Sequence[Vector] | npt.NDArray[np.float64]) -> "Shape":
        """3 to 256 corners, in either sense of rotation."""
        points = numbers(corners, np.float32, "corners")
        if points.ndim != 2 or points.shape[1] != 2:
            raise ValueError(f"corners: expected corners x 2, found the shape {points.shape}")
        return Shape(made(lib.wale_shape_polygon, "WaleShape", ffi.from_buffer("WaleVector[]", points), len(points)))

    @staticmethod
    def mask(cells: npt.ArrayLike, side: float) -> "Shape":
        """Cells that are true, rows x columns from the top left, each a square with this side, m."""
        bits = yes_or_no(cells, np.uint8, "cells")
        if bits.ndim != 2:
            raise ValueError(f"cells: expected rows x columns, found the shape {bits.shape}")
        rows, columns = bits.shape
        return Shape(made(lib.wale_shape_mask, "WaleShape", ffi.from_buffer("uint8_t[]", bits), columns, rows, number(side, "side")))

    @property
    def size(self) -> Vector:
        """m: of the smallest rectangle around the patch's centre that holds it."""
        return vector_of(lib.wale_shape_size(self._pointer))

    def edge(self, point: Vector) -> float:
        """The distance of a point to the edge, m: positive inside, negative outside."""
        x, y = pair(point, "point")
        return float(lib.wale_shape_edge(self._pointer, {"x": x, "y": y}))
