"""Arrays of the C structs, as numpy sees them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wale._abi import ffi, number
from wale.errors import Error

_plain = {"float": np.float32, "double": np.float64, "int32_t": np.int32, "uint32_t": np.uint32, "int64_t": np.int64,
          "uint64_t": np.uint64}


def dtype_of(kind: str) -> np.dtype[np.void]:
    """The layout of a struct without texts; a WaleVector is two floats."""
    names, formats, offsets = [], [], []
    for name, field in ffi.typeof(kind).fields:
        if name == "reserved":
            continue
        names.append(name)
        offsets.append(field.offset)
        formats.append((np.float32, (2,)) if field.type.cname == "WaleVector" else _plain[field.type.cname])
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": ffi.sizeof(kind)})


def numbers(values: ArrayLike, dtype: Any, name: str) -> NDArray[Any]:
    """A contiguous array of a type of numbers. TypeError for what holds none, ValueError for rows of different lengths."""
    try:
        array = np.asarray(values)
    except ValueError as why:
        raise ValueError(f"{name}: expected an array, found rows of different lengths") from why
    if np.ma.is_masked(values):  # type: ignore[no-untyped-call]
        raise ValueError(f"{name}: expected numbers, found masked ones")
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name}: expected numbers, found an array of {array.dtype}")
    with np.errstate(over="ignore"):  # what is too large for a float is infinite, and the call says so
        return np.ascontiguousarray(array, dtype=dtype)


def yes_or_no(values: ArrayLike, dtype: Any, name: str) -> NDArray[Any]:
    """The same of truths: 0 is no, and any other number yes. ValueError for not-a-number."""
    array = numbers(values, None, name)
    if array.dtype.kind == "f" and np.isnan(array).any():
        raise ValueError(f"{name}: expected true or false, found not-a-number")
    return np.ascontiguousarray(array.astype(np.bool_), dtype=dtype)


def vectors(values: ArrayLike, name: str) -> NDArray[np.float32]:
    """Contiguous pairs of floats."""
    array: NDArray[np.float32] = numbers(values, np.float32, name)
    if array.ndim == 0 or array.shape[-1] != 2:
        raise ValueError(f"{name}: expected an array whose last axis is x and y, found the shape {array.shape}")
    return array


def size_in_full(size: Sequence[float]) -> tuple[float, float, float]:
    """Width, height and rim of a patch, where the rim may be left out."""
    try:
        count = len(size)
    except TypeError as why:
        raise TypeError(f"size: expected width, height and perhaps a rim, found {size!r}") from why
    if count not in (2, 3):
        raise ValueError(f"size: expected width, height and perhaps a rim, found {count} numbers")
    size = [number(each, "size") for each in size]
    if size[0] == 0 and size[1] == 0:  # in the C interface two zeros mean the program's own size
        raise Error.of_argument("size", "the width and height of a patch must be positive and finite",
                                "give lengths in m, as in 0.05",
                                expected="a positive width and height", found="0, 0")
    return (size[0], size[1], size[2] if len(size) == 3 else 0.0)


def pointer(array: NDArray[Any], kind: str) -> Any:
    """The array's memory as a pointer; the array must outlive it."""
    return ffi.cast(kind + "*", array.ctypes.data)
