"""A run whose ticks the program serves itself."""

from wale._abi import Handle, ffi, held, lib, made, pair, sized, two, whole
from wale.codes import ReadingContact
from wale.run import Vector, vector_of
from wale.stage import Stage


class Loop(Handle):
    """A run of a stage, by the program's own clock: `force = loop.step((x, y))`. All guards are in it. Closing ends it."""

    def __init__(self, stage: Stage) -> None:
        super().__init__(made(lib.wale_loop_begin, "WaleLoop", held(stage, Stage, "stage")), lib.wale_loop_free)
        self._reading = sized("WaleReading")

    def step(self, counts: tuple[int, int], *, button: bool = False, contact: ReadingContact = ReadingContact.good,
             interaction: Vector | None = None, periods: int = 1) -> Vector:
        """Serves one tick: the force (N; of a pad its amplitude and frequency) to command.

        `counts`: of the encoder, from the workspace's centre. `interaction`: N, of the hand on the handle, if the device
        measures it. `periods` have passed since the last step: the loop looks at no clock, and gives no force once where they
        say that more than 20 ms were missed.
        """
        of = self._reading
        x, y = two(counts, "counts", "whole numbers")
        of.counts_x, of.counts_y = _count(x), _count(y)
        of.button, of.contact = whole(button, "button", 32), whole(contact, "contact", 32)
        of.measures_interaction = int(interaction is not None)
        of.interaction_x, of.interaction_y = pair((0.0, 0.0) if interaction is None else interaction, "interaction")
        return vector_of(lib.wale_loop_step(self._pointer, of, max(-1, min(whole(periods, "periods"), 2**62))))

    def exerted(self, force: Vector) -> None:
        """The force that the actuator really exerts since the last step, where the device tells it."""
        lib.wale_loop_exerted(self._pointer, ffi.new("WaleVector*", pair(force, "force"))[0])


def _count(value: int) -> int:
    """A count that the struct can hold. What is beyond is beyond every device too: a lost reading."""
    return max(-(2**31), min(2**31 - 1, whole(value, "counts")))
