"""How patches lie."""

from typing import Any

from wale._abi import Arguments, Handle, call, ffi, lib, made, sized
from wale.program import Program
from wale.run import Vector
from wale.shape import Shape


class Placement(Handle):
    """How a patch lies and what it is, at one moment. Nothing changes it afterwards; it outlives patch and stage."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_placement_free)
        of, count = sized("WalePlacementDetails"), ffi.new("size_t*")
        call(lib.wale_placement_details, pointer, of)
        self.at: Vector = (of.x, of.y)
        """m from the workspace's centre, of the patch's centre."""
        self.size: tuple[float, float, float] = (of.width, of.height, of.rim)
        """m: width, height and rim."""
        self.layer: float = of.layer
        self.enabled: bool = bool(of.enabled)
        """Otherwise it is there and not felt."""
        values = lib.wale_placement_values(pointer, count)
        self._values = [float(values[i]) for i in range(count[0])]
        self._has_shape = bool(of.has_shape)

    @property
    def program(self) -> Program:
        """The program that it has, with the same bytes as the one that it was given, and without its warnings."""
        return Program(made(lib.wale_placement_program, "WaleProgram", self._pointer))

    @property
    def shape(self) -> Shape | None:
        """As it was given, not stretched to `size`; None: all of its rectangle."""
        held = self._pointer
        return Shape(made(lib.wale_placement_shape, "WaleShape", held)) if self._has_shape else None

    @property
    def values(self) -> dict[str, float]:
        """Of its parameters by their names, SI; the nearest 32-bit floats to those that were set."""
        with self.program as program:
            return {each.name: value for each, value in zip(program.parameters, self._values, strict=True)}

    def value(self, parameter: str) -> float:
        """The value of a parameter, SI. Raises `unknown_name`."""
        arguments, value = Arguments(), ffi.new("float*")
        call(lib.wale_placement_value, self._pointer, arguments.text(parameter, "parameter"), value)
        return float(value[0])
