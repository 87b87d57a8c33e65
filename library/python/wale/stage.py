"""Patches under a hand."""

import contextlib
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from wale._abi import Arguments, Handle, call, ffi, held, lib, made, number, pair, sized, whole
from wale._arrays import size_in_full
from wale.codes import Code, ContactKind
from wale.device import Device, Profile
from wale.placement import Placement
from wale.program import Program
from wale.run import Now, Run, Vector, now_of, vector_of
from wale.shape import Shape
from wale.snapshot import Snapshot
from wale.workspace import Workspace

Size = Sequence[float]
"""m: width, height and, if it has one, rim."""


@dataclass(frozen=True)
class Contact:
    """A moment at which a hand and a patch begin or end to touch, or the button changes on a patch."""

    kind: ContactKind
    patch: int
    """Its `Patch.id`."""
    time: float
    position: Vector
    velocity: Vector
    force: Vector


def _placed(at: Vector, size: Size | None, layer: float, shape: Shape | None) -> tuple[Any, Any]:
    """The options, and what keeps the shape that they point to."""
    width, height, rim = size_in_full(size) if size is not None else (0.0, 0.0, 0.0)
    x, y = pair(at, "at")
    kept = None if shape is None else held(shape, Shape, "shape")
    return Arguments().struct("WalePatchOptions", x=x, y=y, width=width, height=height, rim=rim, layer=layer, shape=kept), kept


class Patch(Handle):
    """A patch on a stage. It may outlive the patch and the stage: its calls then raise `wrong_moment`.

    Closing it leaves the patch where it is. All calls are safe from any thread, also during a run.
    """

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_patch_free)

    @property
    def id(self) -> int:
        """What `Now`, `Contact` and `Run.ticks` call it; never 0."""
        return int(lib.wale_patch_id(self._pointer))

    @property
    def number(self) -> int:
        """What `Recording.ticks` call it. A later patch may get the number of a removed one."""
        return int(lib.wale_patch_number(self._pointer))

    @property
    def exists(self) -> bool:
        """Whether it names a patch that is on its stage."""
        return bool(lib.wale_patch_exists(self._pointer))

    def set(self, parameter: str, value: float) -> None:
        """Sets a parameter, in SI units. A value outside its range raises `malformed_value`; only `wale.batch` clamps."""
        arguments = Arguments()
        call(lib.wale_patch_set, self._pointer, arguments.text(parameter, "parameter"), number(value, "value"))

    def move(self, to: Vector) -> None:
        """Moves its centre, m from the workspace's centre."""
        call(lib.wale_patch_move, self._pointer, *pair(to, "to"))

    def resize(self, size: Size) -> None:
        """Width, height and rim, m.

        No length is too great, here and in `add`: a side beyond the workspace's diameter counts as that diameter, and a rim
        of half the smaller side or more as a quarter of it.
        """
        call(lib.wale_patch_resize, self._pointer, *size_in_full(size))

    def replace(self, program: Program) -> None:
        """Another program."""
        call(lib.wale_patch_replace, self._pointer, held(program, Program, "program"))

    def enable(self, enabled: bool = True) -> None:
        """A patch that is not enabled is not felt, and keeps its memory."""
        call(lib.wale_patch_enable, self._pointer, whole(enabled, "enabled", 32))

    def bring(self, layer: float = 0.0) -> None:
        """Puts it in front of all patches of a layer."""
        call(lib.wale_patch_bring, self._pointer, number(layer, "layer"))

    def remove(self) -> None:
        """Removes the patch from its stage."""
        call(lib.wale_patch_remove, self._pointer)

    @property
    def placement(self) -> Placement:
        """The patch as it is wanted: as all calls and commits that have returned have made it, felt already or not."""
        return Placement(made(lib.wale_patch_placement, "WalePlacement", self._pointer))

    @property
    def published(self) -> Placement:
        """The patch as the loop of the present run has it, or that of the last run had it.

        While a bank is prepared it is older than `placement`. Raises `wrong_moment` if no run has had the patch yet.
        """
        return Placement(made(lib.wale_patch_published, "WalePlacement", self._pointer))

    def value(self, parameter: str) -> float:
        """The wanted value of a parameter, SI. Raises `unknown_name`."""
        arguments, value = Arguments(), ffi.new("float*")
        call(lib.wale_patch_value, self._pointer, arguments.text(parameter, "parameter"), value)
        return float(value[0])

    @property
    def values(self) -> dict[str, float]:
        """The wanted values of all parameters by their names, SI."""
        with self.placement as placement:
            return placement.values

    def snapshot(self) -> Snapshot:
        """Its parameters and memory at one tick. Takes a period or two during a run."""
        return Snapshot(made(lib.wale_patch_snapshot, "WaleSnapshot", self._pointer))


class Edit(Handle):
    """Several changes that are felt at one tick, all or none. At the end of a `with` they are made, unless it raised."""

    def __init__(self, pointer: Any) -> None:
        super().__init__(pointer, lib.wale_edit_free)

    def add(self, program: Program, *, at: Vector = (0.0, 0.0), size: Size | None = None, layer: float = 0.0,
            shape: Shape | None = None) -> Patch:
        placed, _kept = _placed(at, size, layer, shape)
        return Patch(made(lib.wale_edit_add, "WalePatch", self._pointer, held(program, Program, "program"), placed))

    def set(self, patch: Patch, parameter: str, value: float) -> None:
        arguments = Arguments()
        call(lib.wale_edit_set, self._pointer, held(patch, Patch, "patch"), arguments.text(parameter, "parameter"), number(value, "value"))

    def move(self, patch: Patch, to: Vector) -> None:
        call(lib.wale_edit_move, self._pointer, held(patch, Patch, "patch"), *pair(to, "to"))

    def resize(self, patch: Patch, size: Size) -> None:
        call(lib.wale_edit_resize, self._pointer, held(patch, Patch, "patch"), *size_in_full(size))

    def replace(self, patch: Patch, program: Program) -> None:
        call(lib.wale_edit_replace, self._pointer, held(patch, Patch, "patch"), held(program, Program, "program"))

    def enable(self, patch: Patch, enabled: bool = True) -> None:
        call(lib.wale_edit_enable, self._pointer, held(patch, Patch, "patch"), whole(enabled, "enabled", 32))

    def bring(self, patch: Patch, layer: float = 0.0) -> None:
        call(lib.wale_edit_bring, self._pointer, held(patch, Patch, "patch"), number(layer, "layer"))

    def remove(self, patch: Patch) -> None:
        call(lib.wale_edit_remove, self._pointer, held(patch, Patch, "patch"))

    def fail(self, sentence: str, *, code: Code = Code.malformed_value, argument: str = "", mend: str = "") -> None:
        """Makes the next commit raise this error, unless an earlier call of the edit has failed.

        For who finds out by himself that a change cannot be made. The sentence says what is wrong, in a line.
        """
        arguments = Arguments()
        texts = [arguments.text(each, name) for name, each in
                 (("argument", argument), ("sentence", sentence), ("mend", mend))]
        call(lib.wale_edit_fail, self._pointer, whole(code, "code", 32), *texts)

    def commit(self) -> None:
        """Makes all changes. If one has an error, nothing has changed. Afterwards the edit is empty and may be used again."""
        call(lib.wale_edit_commit, self._pointer)

    def __exit__(self, *raised: object) -> None:
        try:
            if raised[0] is None:
                self.commit()
        finally:
            self.close()


@ffi.callback("void(const WaleContact*, void*)")  # type: ignore[misc]
def _hear(of: Any, user: Any) -> None:
    ffi.from_handle(user).append(Contact(ContactKind(of.kind), of.patch, of.time, vector_of(of.position),
                                         vector_of(of.velocity), vector_of(of.force)))


@contextlib.contextmanager
def _interrupts_later() -> Iterator[list[int]]:
    """On the main thread, an interrupt meanwhile raises nothing, but is noted, and handed on at the end."""
    heard: list[int] = []
    usual = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(usual):
        yield heard
        return
    signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    try:
        yield heard
    finally:
        signal.signal(signal.SIGINT, usual)
    if heard:
        usual(heard[0], None)


def _wait_for_end(over: threading.Event, thread: threading.Thread, heard: list[int],
                  interrupt: Callable[[], None]) -> None:
    """Waits for the end of a run, and ends it when an interrupt is heard or another signal's handler raises."""
    raised: BaseException | None = None
    while not over.is_set() and thread.is_alive():  # without memory it may end before it has begun
        try:
            if heard or raised is not None:  # again and again, since the run may not have begun
                interrupt()
            over.wait(0.05)
        except BaseException as other:
            raised = other
    if raised is not None:
        raise raised


class Stage(Handle):
    """Patches on a device's workspace, and the loop that lets the hand feel the front-most one under it.

    Closing it ends its run, also a `run` on another thread, and waits for that.

    `priority`: 1 .. 99, SCHED_FIFO for the loop if it is permitted. `max_force`: N, 0: only the device's own limit.
    `record`: a file for the run's recording; it must not exist yet. Its path counts from the current folder now.
    """

    def __init__(self, device: Device | Profile, *, priority: int = 0, lock_memory: bool = False,
                 low_latency: bool = False, max_force: float = 0.0, record: str | os.PathLike[str] = "",
                 record_hand: str = "") -> None:
        arguments = Arguments()
        options = arguments.struct("WaleStageOptions", priority=priority, lock_memory=lock_memory,
                                   low_latency=low_latency, max_force=max_force, record=record,
                                   record_hand=record_hand)
        if isinstance(device, Device):
            stage = made(lib.wale_stage_create, "WaleStage", device._pointer, options)
        elif not isinstance(device, Profile):
            raise TypeError(f"device: expected a Device or a Profile, found {device!r}")
        else:
            figures = {name: value for name, value in vars(device).items() if not isinstance(value, bool)}
            given = arguments.struct("WaleProfile", vibrates=int(device.vibrates), has_position=int(device.has_position),
                                     **figures)
            stage = made(lib.wale_stage_create_for, "WaleStage", given, options)
        super().__init__(stage, lib.wale_stage_free)
        self._heard: deque[Contact] = deque()
        self._hears: Any = ffi.new_handle(self._heard)
        self._receive: Callable[[Contact], None] | None = None
        self._dropped = 0  # not told yet, since a receiver raised
        self._runs: list[threading.Event] = []  # one for each `run` that is under way

    def close(self) -> None:
        held = self._held
        super().close()
        # A run may end, on its own thread, between any two steps of this one.
        while held is not None and (under_way := self._runs[-1:]):
            lib.wale_stage_interrupt(held)
            under_way[0].wait(0.01)

    def add(self, program: Program, *, at: Vector = (0.0, 0.0), size: Size | None = None, layer: float = 0.0,
            shape: Shape | None = None) -> Patch:
        """Puts a patch on the stage, in front of all others of its layer. `at`: m; `size`: m, with or without a rim.

        `shape`: the part of its rectangle that it covers, stretched to its size.
        """
        placed, _kept = _placed(at, size, layer, shape)
        return Patch(made(lib.wale_stage_add, "WalePatch", self._pointer, held(program, Program, "program"), placed))

    def add_workspace(self, workspace: Workspace) -> list[Patch]:
        """Puts all patches of a workspace on the stage at once, the last in front, and gives them in their order."""
        held(workspace, Workspace, "workspace")
        places = ffi.new("WalePatch*[]", max(1, len(workspace)))
        call(lib.wale_stage_add_workspace, self._pointer, workspace._pointer, places)
        return [Patch(places[i]) for i in range(len(workspace))]

    def edit(self) -> Edit:
        """Begins an edit: `with stage.edit() as edit: edit.move(patch, (0.01, 0))`."""
        return Edit(made(lib.wale_stage_edit, "WaleEdit", self._pointer))

    def __len__(self) -> int:
        """How many patches there are."""
        return int(lib.wale_stage_size(self._pointer))

    def __bool__(self) -> bool:
        return True

    def run(self, seconds: float, *, virtual_time: bool = False, kept_seconds: float = 0.0) -> Run:
        """Runs for so many seconds, in real time or as fast as possible. An interrupt (Ctrl-C) ends it."""
        options = Arguments().struct("WaleRunOptions", seconds=seconds, kept_seconds=kept_seconds,
                                     virtual_time=virtual_time)
        done, over = list[Any](), threading.Event()

        def serve() -> None:
            self._runs.append(over)  # before it looks whether the stage is closed: `close` looks in the other order
            try:
                done.append(Run(made(lib.wale_stage_run, "WaleRun", self._pointer, options)))
            except BaseException as raised:
                done.append(raised)
            finally:
                self._runs.remove(over)
                over.set()

        def interrupt() -> None:
            if (pointer := self._held) is not None:  # else `close` does it
                lib.wale_stage_interrupt(pointer)

        # On a thread of its own, since this one must hear an interrupt. Meanwhile an interrupt raises nothing, since
        # it might do so anywhere here: it ends the run, and is handed on afterwards.
        with _interrupts_later() as heard:
            thread = threading.Thread(target=serve)
            thread.start()
            _wait_for_end(over, thread, heard, interrupt)
        if not done:
            raise MemoryError("the run's thread found no memory")
        if isinstance(done[0], BaseException):
            raise done[0]
        run: Run = done[0]
        return run

    def start(self) -> None:
        """Begins an endless run in real time and returns."""
        call(lib.wale_stage_start, self._pointer)

    def stop(self) -> Run:
        """Ends the run that `start` began."""
        return Run(made(lib.wale_stage_stop, "WaleRun", self._pointer))

    @property
    def is_running(self) -> bool:
        return bool(lib.wale_stage_is_running(self._pointer))

    def now(self) -> Now:
        """The state after the latest tick of the present run or the last one. Never waits."""
        of = sized("WaleNow")
        lib.wale_stage_now(self._pointer, of)
        return now_of(of)

    def on_contact(self, receive: Callable[[Contact], None] | None) -> None:
        """What `poll` calls for each contact; None ends it. Contacts are noted only while there is one.

        What it raises comes out of `poll`; the contacts after that one wait for the next `poll`.
        """
        if receive is not None and not callable(receive):
            raise TypeError(f"receive: expected something to call, or None, found {receive!r}")
        call(lib.wale_stage_on_contact, self._pointer, ffi.NULL if receive is None else _hear, self._hears)
        self._receive = receive

    def poll(self) -> int:
        """Calls the receiver for all contacts since the last poll. Returns how many were dropped, since too many waited."""
        dropped = ffi.new("size_t*")
        with _interrupts_later():  # what is raised in a callback is lost, and the contact with it
            call(lib.wale_stage_poll, self._pointer, dropped)
        self._dropped += int(dropped[0])
        while self._heard:  # what the receiver has not had when it raises waits for the next poll
            each = self._heard.popleft()
            if self._receive is not None:
                self._receive(each)
        lost, self._dropped = self._dropped, 0
        return lost
