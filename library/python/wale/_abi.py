"""The shared library, and how its functions are called."""

import operator
import os
import sysconfig
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn, Self, SupportsIndex

import cffi  # type: ignore[import]
import numpy as np

from wale import _declarations
from wale.codes import Code
from wale.errors import Error, Span

ffi: Any = cffi.FFI()
ffi.cdef(_declarations.declarations)


def _installed() -> str:
    """The library in the prefix in which this package is installed, PREFIX/lib/python…/…-packages/wale; else the system's."""
    name, package = "libwale.so.1", Path(__file__).resolve().parent
    if package.parents[1].name.startswith("python"):
        prefix = package.parents[3]
        for folder in ("lib", "lib64", f"lib/{sysconfig.get_config_var('MULTIARCH')}"):
            if (found := prefix / folder / name).exists():
                runtime = found.with_name("libwale-runtime.so.1")
                if runtime.exists():  # which the library needs, and which may not be where the system looks
                    _kept.append(ffi.dlopen(str(runtime), ffi.RTLD_NOW | ffi.RTLD_GLOBAL))
                return str(found)
    return name


_kept: list[Any] = []


def _opened() -> Any:
    """The library that WALE_SHARED_LIBRARY names, else the installed one."""
    name = os.environ.get("WALE_SHARED_LIBRARY") or _installed()
    try:
        lib = ffi.dlopen(name)
    except OSError as why:
        raise ImportError(f"the shared library of Wale cannot be loaded: {why}; install libwale1, or set the environment "
                          "variable WALE_SHARED_LIBRARY to the path of libwale.so.1") from why
    if lib.wale_interface() < _declarations.interface:
        raise ImportError(f"libwale has interface {lib.wale_interface()}; this package needs {_declarations.interface}")
    return lib


lib: Any = _opened()


class Arguments:
    """Makes arguments of a call, and keeps their memory until it is over."""

    def __init__(self) -> None:
        self._kept: list[object] = []

    def text(self, text: str | bytes | os.PathLike[str], name: str = "argument") -> Any:
        """A WaleText. Paths may hold bytes that are no UTF-8. TypeError for what is no text; `name` is its argument's."""
        if not isinstance(text, (str, bytes, os.PathLike)):
            raise TypeError(f"{name}: expected a text, found {text!r}")
        try:
            data = os.fsencode(text) if not isinstance(text, str) else text.encode("utf-8", "surrogateescape")
        except UnicodeEncodeError as why:
            raise ValueError(f"{name}: expected a text, found half a character, {text!r}") from why
        buffer = ffi.from_buffer(data)
        made = ffi.new("WaleText*", (buffer, len(data)))
        self._kept += [data, buffer, made]
        return made[0]

    def struct(self, kind: str, /, **fields: Any) -> Any:
        """A struct that begins with its size; texts become WaleText, what is not given is 0.

        TypeError for a value of another type than the field's, by the field's name; ValueError for one that it cannot hold.
        """
        made = sized(kind)
        types = dict(ffi.typeof(kind).fields)
        for name, value in fields.items():
            if value is None:
                continue
            of = types[name].type
            if of.cname == "WaleText":
                value = self.text(value, name)
            elif of.kind == "primitive":
                value = number(value, name) if of.cname in ("float", "double") else whole(value, name)
            try:
                setattr(made, name, value)
            except OverflowError as why:
                size = "smaller" if value > 0 else "larger"
                raise ValueError(f"{name}: expected a {size} number, found {value!r}") from why
        self._kept.append(made)
        return made

    def keep(self, value: object) -> None:
        self._kept.append(value)


def sized(kind: str) -> Any:
    """A new struct of zeros that knows its size."""
    made = ffi.new(kind + "*")
    made.size = ffi.sizeof(kind)
    return made


def read(text: Any) -> str:
    """A text that the library gave."""
    return bytes(ffi.buffer(text.data, text.length)).decode("utf-8", "surrogateescape") if text.data else ""


def number(value: Any, name: str) -> float:
    """A number that is an argument. TypeError for anything else."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError("it is a text")
        return float(value)
    except (TypeError, ValueError) as why:
        raise TypeError(f"{name}: expected a number, found {value!r}") from why
    except OverflowError as why:
        raise ValueError(f"{name}: expected a smaller number, found {value!r}") from why


def whole(value: Any, name: str, bits: int = 0) -> int:
    """A whole number, or a yes or no, that is an argument. TypeError for anything else.

    With `bits` ValueError for one that a signed number of so many bits cannot hold.
    """
    if isinstance(value, np.bool_):
        return int(value)
    try:
        number = operator.index(value)
    except TypeError as why:
        raise TypeError(f"{name}: expected a whole number, found {value!r}") from why
    if bits and not -(2 ** (bits - 1)) <= number < 2 ** (bits - 1):
        raise ValueError(f"{name}: expected a number of {bits} bits, found {value!r}")
    return number


def two(values: Any, name: str, of: str) -> tuple[Any, Any]:
    """Two values `of` a kind, x and y. ValueError for more or fewer, TypeError for what holds none."""
    try:
        x, y = values
    except ValueError as why:
        raise ValueError(f"{name}: expected two {of}, x and y, found {values!r}") from why
    except TypeError as why:
        raise TypeError(f"{name}: expected two {of}, x and y, found {values!r}") from why
    return (x, y)


def pair(values: Sequence[float], name: str) -> tuple[float, float]:
    """Two numbers, x and y. ValueError for more or fewer, TypeError for what holds none."""
    x, y = two(values, name, "numbers")
    return (number(x, name), number(y, name))


def bytes_of(data: Any, name: str) -> tuple[Any, int]:
    """The memory of bytes that are an argument, and how many they are. TypeError for what holds none."""
    try:
        view = memoryview(data)
        return ffi.from_buffer(data if view.c_contiguous else view.tobytes()), view.nbytes
    except TypeError as why:
        raise TypeError(f"{name}: expected bytes, found {type(data).__name__}") from why


def held(value: Any, kind: "type[Handle]", name: str) -> Any:
    """The pointer of a handle that is an argument. TypeError for anything else."""
    if not isinstance(value, kind):
        raise TypeError(f"{name}: expected a {kind.__name__}, found {value!r}")
    return value._pointer


def or_none(figure: float) -> float | None:
    """A figure that may not have been measured."""
    return figure if figure == figure else None


def known_code(number: int) -> Code | int:
    """The code of that number; the number itself if it is newer than this package."""
    return Code(number) if number in Code._value2member_map_ else number


def described(error: Any) -> Error:
    """An error or a warning as a value; the handle stays its owner's."""
    details = sized("WaleErrorDetails")
    lib.wale_error_details(error, details)
    span = Span(file=read(details.place), line=details.number, column=details.column, length=details.length)
    return Error(
        read(details.in_words),
        code=known_code(details.code),
        severity="warning" if details.severity == lib.WALE_SEVERITY_warning else "error",
        sentence=read(details.sentence),
        mend=read(details.mend),
        expected=read(details.expected),
        found=read(details.found),
        argument=read(details.place),
        text=read(details.place_text),
        span=span if details.column >= 0 else None,
        nearest=tuple(read(lib.wale_error_nearest(error, i)) for i in range(details.nearest)),
        others=tuple(described(lib.wale_error_other(error, i)) for i in range(details.others)),
    )


def call(function: Any, *arguments: Any) -> None:
    """Calls a function whose last argument takes an error, and raises it."""
    given = list(arguments)
    del arguments
    _call(function, given)


def made(function: Any, kind: str, *arguments: Any) -> Any:
    """Calls a function that gives a handle by its last argument but the error."""
    place = ffi.new(kind + "**")
    given = [*arguments, place]
    del arguments
    _call(function, given)
    return place[0]


def _call(function: Any, given: list[Any]) -> None:
    """Empties the list: the frames of what it raises, which somebody may keep, hold no handle that is closed then."""
    place = ffi.new("WaleError**")
    try:
        failed = function(*given, place) != 0
    finally:
        given.clear()
    if failed:
        raised = described(place[0])
        lib.wale_error_free(place[0])
        raise raised


class Handle:
    """Something of the library that is freed by `close`, at the end of a `with`, or when nobody uses it any more.

    After that its calls raise ValueError. Calls of other threads that are under way then end as usual: the last one
    frees it. It cannot be copied or pickled.
    """

    def __init__(self, pointer: Any, free: Any) -> None:
        self._held: Any = ffi.gc(pointer, free)

    @property
    def _pointer(self) -> Any:
        """What a call has as its argument. Whoever has it keeps it from being freed: use it up within one expression, or
        keep it in a variable while what the library lends is read."""
        held = self._held
        if held is None:
            raise ValueError(f"the {type(self).__name__} is closed")
        return held

    def close(self) -> None:
        """Frees it, as soon as no call of another thread uses it. Doing so again does nothing."""
        self._held = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce_ex__(self, _: SupportsIndex) -> NoReturn:
        raise TypeError(f"a {type(self).__name__} cannot be copied or pickled: it is freed once")

    def __copy__(self) -> NoReturn:
        self.__reduce_ex__(4)

    def __deepcopy__(self, _: dict[int, Any]) -> NoReturn:
        self.__reduce_ex__(4)
