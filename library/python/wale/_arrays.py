"""Arrays of the C structs, as numpy sees them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wale._abi import ffi

_plain = {"float": np.float32, "double": np.float64, "int32_t": np.int32, "uint32_t": np.uint32, "int64_t": np.int64}


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


def vectors(values: ArrayLike, name: str) -> NDArray[np.float32]:
    """Contiguous pairs of floats."""
    array = np.ascontiguousarray(values, dtype=np.float32)
    if array.ndim == 0 or array.shape[-1] != 2:
        raise ValueError(f"{name}: expected an array whose last axis is x and y, found the shape {array.shape}")
    return array


def size_in_full(size: Sequence[float]) -> tuple[float, float, float]:
    """Width, height and rim of a patch, where the rim may be left out."""
    if len(size) not in (2, 3):
        raise ValueError(f"size: expected width, height and perhaps a rim, found {len(size)} numbers")
    if size[0] == 0 and size[1] == 0:
        raise ValueError("size: expected positive sides")  # in the C interface two zeros mean the program's own size
    return (size[0], size[1], size[2] if len(size) == 3 else 0.0)


def pointer(array: NDArray[Any], kind: str) -> Any:
    """The array's memory as a pointer; the array must outlive it."""
    return ffi.cast(kind + "*", array.ctypes.data)
