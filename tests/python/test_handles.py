"""Handles: closed while other threads use them, kept by errors, never copied."""

import copy
import faulthandler
import inspect
import pickle
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import wale
from wale._abi import Handle, lib


class Maker:
    """Makes a handle of each kind, and the calls of each of its public members."""

    def __init__(self, folder: Path) -> None:
        self.library = wale.Library()
        self.corduroy = self.library.find("corduroy")
        self.nap = self.library.find("Nap")
        self.folder, self.files = folder, 0
        self.kitchen = self.library.workspace(
            "wale 1\nworkspace one {\n  patch left = corduroy { at -30 mm, 0 mm; size 40 mm, 50 mm; shape ellipse }\n}\n")
        self.file = folder / "kept.wrec"
        with wale.Stage(self.stick(), record=self.file) as stage:
            stage.add(self.corduroy)
            self.run = stage.run(2, virtual_time=True)

    def stick(self) -> wale.Device:
        return self.library.open_device("simulated")

    def stage(self) -> wale.Stage:
        stage = wale.Stage(self.stick())
        self.patch = stage.add(self.corduroy)
        return stage

    def running(self) -> wale.Stage:
        stage = self.stage()
        stage.start()
        self.kept = stage  # a patch and an edit do not keep it
        return stage

    def loop(self) -> wale.Loop:
        self.kept = wale.Stage(wale.profile("sandpaper"))
        self.kept.add(self.corduroy)
        return wale.Loop(self.kept)

    def measured(self) -> wale.Run:
        stage = self.stage()
        self.kept, self.at = stage, self.patch
        return stage.run(1, virtual_time=True)

    def patched(self) -> wale.Patch:
        self.running()
        return self.patch

    def edit(self) -> wale.Edit:
        return self.running().edit()

    def snapshot(self) -> wale.Snapshot:
        self.kept = self.stage()
        return self.patch.snapshot()

    def of(self) -> dict[type, tuple]:
        """The kinds of handles: how one is made, and the arguments of its calls (None: not called here)."""
        text = {"text": ("wale 1\nmaterial m {\n physical {\n  force = 0 N\n }\n}\n",)}
        return {
            wale.Library: (wale.Library, {
                "find": ("corduroy",), "level": ("roughness", 0.5), "compile": text["text"], "open_bytes": (bytes(self.corduroy),),
                "open": (self.folder / "corduroy.wpp",), "workspace": ("wale 1\n",), "open_workspace": (self.folder / "no.wws",),
                "find_later": ("corduroy",), "level_later": ("roughness", 0.5), "compile_later": text["text"],
                "open_later": (self.folder / "corduroy.wpp",), "devices": (), "profile": ("sandpaper",), "open_device": ("simulated",),
                "search": ("ribbed",), "search_later": ("ribbed",),  # by feel, a library would have to be read first
                "nearest": ("nix",), "nearest_later": ("nix",), "between": ("nix", "nix"), "between_later": ("nix", "nix")}),
            wale.Future: (lambda: self.library.find_later("corduroy"), {
                "poll": (), "wait": (), "take": (), "take_matches": (), "progress": (), "cancel": ()}),
            wale.Program: (lambda: wale.Program.load(bytes(self.nap)), {
                "load": None, "parameters": None, "percepts": None, "fates": None, "warnings": None, "__bytes__": (), "profile": None}),
            wale.Device: (self.stick, {"profile": None}),
            wale.Shape: (lambda: wale.Shape.ellipse(0.01, 0.01), {
                "ellipse": None, "polygon": None, "mask": None, "size": None, "edge": ((0, 0),)}),
            wale.Stage: (self.stage, {
                "add": (self.corduroy,), "add_workspace": (self.kitchen,), "edit": (), "__len__": (), "run": (60,),
                "start": (), "stop": (), "is_running": None, "now": (), "on_contact": (print,), "poll": ()}),
            wale.Patch: (self.patched, {
                "id": None, "number": None, "exists": None, "set": ("wale", 0.002), "move": ((0, 0),), "resize": ((0.1, 0.1),),
                "replace": (self.nap,), "enable": (), "bring": (), "remove": (), "snapshot": (), "placement": None, "published": None, "value": ("wale",),
                "values": None}),
            wale.Placement: (lambda: self.patched().placement, {"program": None, "shape": None, "values": None, "value": ("wale",)}),
            wale.Edit: (self.edit, {
                "add": (self.corduroy,), "set": lambda: (self.patch, "wale", 0.002), "move": lambda: (self.patch, (0, 0)),
                "resize": lambda: (self.patch, (0.1, 0.1)), "replace": lambda: (self.patch, self.nap),
                "enable": lambda: (self.patch,), "bring": lambda: (self.patch,), "remove": lambda: (self.patch,), "fail": ("no",), "commit": ()}),
            wale.Loop: (self.loop, {"step": ((1, 1),), "exerted": ((0, 0),)}),
            wale.Snapshot: (self.snapshot, {
                "states": None, "grids": None, "surface": (np.zeros((1000, 2)),), "colours": (np.zeros((1000, 2)),), "show": (),
                "placement": None}),
            wale.Run: (self.measured, {"ticks": None, "measure": lambda: (self.at,)}),
            wale.Recording: (lambda: wale.Recording(self.file), {"ticks": None, "intact": None, "replay": ()}),
            wale.Workspace: (lambda: wale.Workspace.load(bytes(self.kitchen)), {
                "load": None, "__bytes__": (), "patches": None, "warnings": None}),
        }


def members(kind: type) -> list[str]:
    own = {name for each in kind.__mro__ if each not in (object, Handle) for name in vars(each)}
    called = {"__bytes__", *(["__len__"] if kind is wale.Stage else [])}  # the others know their length
    return sorted(name for name in own if not name.startswith("_") or name in called)


def close_under_way(folder: Path) -> None:
    """Calls each member of each kind again and again on a thread, while this one closes the handle."""
    maker = Maker(folder)
    (folder / "corduroy.wpp").write_bytes(bytes(maker.corduroy))
    heard = threading.excepthook
    threading.excepthook = lambda _: None
    for kind, (make, arguments) in maker.of().items():
        for name in members(kind):
            if name == "close" or (isinstance(inspect.getattr_static(kind, name), staticmethod)):
                continue
            for wait in (0.0, 0.002):
                handle = make()
                begun, ended = threading.Event(), []

                def call() -> None:
                    given = arguments[name]
                    given = given() if callable(given) else given
                    while True:
                        begun.set()
                        try:
                            got = getattr(handle, name)
                            if given is not None:
                                got(*given)
                        except wale.Error:
                            time.sleep(0)  # a second `start`, `take` …
                        except (ValueError, TypeError) as why:
                            ended.append(str(why))
                            return

                thread = threading.Thread(target=call, daemon=True)
                thread.start()
                begun.wait()
                time.sleep(wait)
                handle.close()
                thread.join(60)
                if thread.is_alive() or not ended:
                    sys.exit(f"{kind.__name__}.{name}: it goes on although it is closed")
                if "is closed" not in ended[0] and "expected a Patch" not in ended[0]:
                    sys.exit(f"{kind.__name__}.{name}: {ended[0]}")
    threading.excepthook = heard


def test_each_member_is_known(tmp_path: Path) -> None:
    known = Maker(tmp_path).of()
    assert set(known) == set(Handle.__subclasses__())
    for kind, (_, arguments) in known.items():
        assert set(members(kind)) - {"close"} <= set(arguments), kind


def test_closing_under_a_call(tmp_path: Path) -> None:
    done = subprocess.run([sys.executable, __file__, str(tmp_path)], timeout=200, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]


def test_closing_a_stage_ends_its_run_at_once(tmp_path: Path) -> None:
    maker = Maker(tmp_path)
    stage, over = maker.stage(), []
    thread = threading.Thread(target=lambda: over.append(stage.run(3600).ticks_run))
    thread.start()
    while not stage.is_running:
        time.sleep(0.001)
    before = lib.wale_handles()
    stage.close()
    thread.join(60)
    assert not thread.is_alive() and over[0] < 3600 * 900
    assert lib.wale_handles() <= before


@pytest.mark.parametrize("what", [copy.copy, copy.deepcopy, pickle.dumps])
def test_handles_are_not_copied(what, tmp_path: Path) -> None:
    maker = Maker(tmp_path)
    for kind, (make, _) in maker.of().items():
        with make() as handle:
            with pytest.raises(TypeError, match=kind.__name__):
                what(handle)
            assert handle._pointer is not None


def test_an_error_that_is_kept_does_not_keep_a_handle(library: wale.Library) -> None:
    stage, kept = wale.Stage(wale.open_device("simulated:sandpaper")), []
    for wrong in [lambda: stage.run(-1), stage.stop, lambda: stage.run(1)]:
        with pytest.raises(wale.Error) as raised:
            wrong()
        kept.append(raised)
    before = lib.wale_handles()
    stage.close()
    assert lib.wale_handles() == before - 1


if __name__ == "__main__":
    faulthandler.enable()
    close_under_way(Path(sys.argv[1]))
