"""How things feel, from Python: materials and levels by name, on a joystick or many simulated hands.

The names are those of the C and C++ interfaces. Units are SI. Errors are raised as `wale.Error`. Everything that holds
something of the library is closed at the end of a `with`, by `close()`, or when nobody uses it any more.
"""

from wale._abi import lib as _lib
from wale._abi import read as _read
from wale.batch import batch
from wale.codes import Code, ContactKind, DeviceKind, FateKind, MarkKind, ReadingContact
from wale.device import Device, DeviceInfo, Hand, Motion, Profile, devices, open_device, profile
from wale.errors import Error, Span
from wale.library import FeltDistance, Future, Library, Match, SearchResult
from wale.loop import Loop
from wale.placement import Placement
from wale.program import Fate, Parameter, Percept, Program
from wale.recording import Recording, Replay
from wale.run import Felt, ForceSize, Guards, Level, Now, Run, Times
from wale.shape import Shape
from wale.snapshot import Mark, Snapshot
from wale.stage import Contact, Edit, Patch, Stage
from wale.workspace import SliderMark, Workspace, WorkspacePatch, load_workspace

__version__: str = _read(_lib.wale_version())

__all__ = [
    "Code", "Contact", "ContactKind", "Device", "DeviceInfo", "DeviceKind", "Edit", "Error", "Fate", "FateKind",
    "Felt", "FeltDistance", "ForceSize", "Future", "Guards", "Hand", "Level", "Library", "Loop", "Mark", "MarkKind",
    "Match", "Motion", "Now", "Parameter", "Patch", "Percept", "Placement", "Profile", "Program", "ReadingContact",
    "Recording", "Replay", "Run", "SearchResult", "Shape", "SliderMark", "Snapshot", "Span", "Stage", "Times",
    "Workspace", "WorkspacePatch", "batch", "devices", "load_workspace", "open_device", "profile",
]
