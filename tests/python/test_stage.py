"""Devices, stages, patches, edits, loops, snapshots and recordings."""

import math
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import wale


def code_of(call) -> int:
    with pytest.raises(wale.Error) as raised:
        call()
    return raised.value.code


def test_devices(library: wale.Library) -> None:
    listed = wale.devices()
    assert [each.spelling for each in library.devices()] == [each.spelling for each in listed]
    assert library.profile("gamepad") == wale.profile("gamepad")
    assert {each.kind for each in listed} >= {wale.DeviceKind.pointer, wale.DeviceKind.simulated}
    assert any(each.spelling == "simulated:sandpaper" for each in listed)
    profile = wale.profile("sandpaper")
    assert profile.rate > 100 and profile.position_step > 0 and not profile.vibrates
    assert code_of(lambda: wale.profile("sandpeper")) == wale.Code.unknown_device
    assert code_of(lambda: wale.open_device("1-77")) == wale.Code.absent_device
    for wrong in [{"priority": 100}, {"max_force": math.nan}, {"hand": wale.Hand(-1)},
                  {"motion": wale.Motion.trace([[0, 0, 0], [0, 0, 0]])}]:
        assert code_of(lambda: wale.open_device("simulated:sandpaper", **wrong)) == wale.Code.malformed_value
    with pytest.raises(ValueError):
        wale.open_device("simulated:sandpaper", motion=wale.Motion.trace([0, 1]))
    assert code_of(lambda: wale.open_device("simulated:sandpaper", motion=wale.Motion.rest())) == wale.Code.malformed_value
    with wale.Stage(library.open_device("simulated", motion=wale.Motion.rest())) as still:
        still.add(library.level("roughness", 0.5))
        assert np.abs(still.run(1, virtual_time=True).ticks["position"]).max() < 1e-3
    hand = wale.Hand(0.5)
    for motion in [wale.Motion.rest(), wale.Motion.circular(0.01, 1), wale.Motion.press(0.01, 1),
                   wale.Motion.trace([[0, 0, 0], [1, 0.01, 0]])]:
        with wale.open_device("simulated:sandpaper", hand=hand, motion=motion) as device:
            assert device.profile == profile


def test_a_run_gives_arrays_and_levels(stage: wale.Stage, corduroy: wale.Program) -> None:
    patch = stage.add(corduroy)
    run = stage.run(2, virtual_time=True)
    ticks = run.ticks
    assert len(ticks) == run.ticks_run == 2 * wale.profile("sandpaper").rate
    assert ticks["position"].shape == (len(ticks), 2) and ticks["force"].dtype == np.float32
    assert np.allclose(np.diff(ticks["time"]), run.seconds_per_tick)
    felt = run.measure(patch, settling=0.5, least_crossings=10)
    # The figures, once more by numpy.
    settled = ticks[ticks["time"] >= 0.5]
    assert felt.force.maximum == pytest.approx(np.abs(settled["force"][:, 0]).max(), rel=1e-3)
    (level,) = felt.levels
    assert level.name == "roughness" and level.problem is None and level.level == pytest.approx(0.6, abs=0.05)
    again = stage.run(2, virtual_time=True, kept_seconds=0.5).ticks
    assert len(again) == 450 and (again["time"] == ticks["time"][-450:]).all()


def test_errors_of_runs(stage: wale.Stage, corduroy: wale.Program) -> None:
    assert code_of(lambda: stage.run(1, virtual_time=True)) == wale.Code.wrong_moment
    assert code_of(stage.stop) == wale.Code.wrong_moment
    stage.add(corduroy)
    for seconds in [0, -1, math.nan, math.inf]:
        assert code_of(lambda: stage.run(seconds)) == wale.Code.malformed_value


def test_real_time(stage: wale.Stage, corduroy: wale.Program) -> None:
    patch = stage.add(corduroy)
    stage.start()
    assert stage.is_running
    end = time.monotonic() + 30
    while stage.now().ticks_run < 20 and time.monotonic() < end:
        time.sleep(0.005)
    now = stage.now()
    assert now.ticks_run >= 20 and now.inside and now.patch == patch.id
    assert stage.stop().ticks_run >= now.ticks_run
    runner = threading.Thread(target=lambda: stage.run(3600))
    runner.start()
    while not stage.is_running and time.monotonic() < end:
        time.sleep(0.001)
    stage.close()  # ends it
    runner.join(30)
    assert not runner.is_alive()


def interrupt_when_running(stage: wale.Stage, times: int) -> threading.Thread:
    def interrupt() -> None:
        while not stage.is_running:
            time.sleep(0.001)
        for _ in range(times):
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
            time.sleep(0.01)

    interrupter = threading.Thread(target=interrupt)
    interrupter.start()
    return interrupter


def test_an_interrupt_ends_a_run(stage: wale.Stage, corduroy: wale.Program) -> None:
    stage.add(corduroy)
    for _ in range(5):
        interrupter = interrupt_when_running(stage, 1)
        with pytest.raises(KeyboardInterrupt):
            stage.run(3600)
        assert not stage.is_running
        interrupter.join()


def test_an_interrupt_is_handed_on(stage: wale.Stage, corduroy: wale.Program) -> None:
    stage.add(corduroy)
    heard: list[int] = []
    usual = signal.signal(signal.SIGINT, lambda number, _: heard.append(number))
    try:
        interrupter = interrupt_when_running(stage, 3)
        assert stage.run(3600).ticks_run >= 0  # its own handler raises nothing, so the run is only short
        interrupter.join()
        assert heard and not stage.is_running
    finally:
        signal.signal(signal.SIGINT, usual)


def test_patches(stage: wale.Stage, corduroy: wale.Program) -> None:
    patch = stage.add(corduroy, at=(0.01, 0), size=(0.02, 0.02))
    patch.set("wale", 0.003)
    patch.move((0, 0.01))
    patch.resize((0.03, 0.03, 0.001))
    patch.enable(False)
    patch.bring(2)
    patch.replace(corduroy)
    assert patch.exists and len(stage) == 1
    assert code_of(lambda: patch.set("whale", 0.003)) == wale.Code.unknown_name
    for wrong in [lambda: patch.set("wale", math.nan), lambda: patch.set("wale", 1), lambda: patch.move((math.inf, 0)),
                  lambda: patch.resize((-1, 1)), lambda: patch.resize((0, 0)), lambda: stage.add(corduroy, size=(0, 0)),
                  lambda: patch.bring(math.nan),
                  lambda: stage.add(corduroy, at=(math.nan, 0))]:
        assert code_of(wrong) == wale.Code.malformed_value
    with pytest.raises(ValueError):
        stage.add(corduroy, size=(1,))
    other = stage.add(corduroy)
    other.remove()
    assert not other.exists and code_of(other.remove) == wale.Code.wrong_moment
    stage.close()
    for gone in [lambda: patch.move((0, 0)), lambda: patch.enable(), patch.remove, patch.snapshot]:
        assert code_of(gone) == wale.Code.wrong_moment


def test_shapes(stage: wale.Stage, corduroy: wale.Program) -> None:
    circle = wale.Shape.ellipse(0.01, 0.01)
    assert circle.size == pytest.approx((0.02, 0.02)) and circle.edge((0.004, 0.003)) == pytest.approx(0.005)
    triangle = wale.Shape.polygon([(-0.01, -0.01), (0.01, -0.01), (-0.01, 0.01)])
    assert triangle.edge((-0.009, 0)) == pytest.approx(0.001) and triangle.edge((0.01, 0.01)) < 0
    mask = wale.Shape.mask(np.array([[1, 0], [1, 1]]), 0.01)
    assert mask.edge((0.005, 0.005)) == pytest.approx(-0.005) and mask.size == pytest.approx((0.02, 0.02))
    for wrong in [lambda: wale.Shape.ellipse(0, 1), lambda: wale.Shape.polygon([(0, 0), (1, 0)]),
                  lambda: wale.Shape.mask([[0]], 0.01)]:
        assert code_of(wrong) == wale.Code.malformed_value
    with pytest.raises(ValueError):
        wale.Shape.polygon([0, 1, 2])
    stage.add(corduroy, shape=circle)
    ticks = stage.run(2, virtual_time=True).ticks
    away = np.hypot(*ticks["position"].T)
    sure = abs(away - 0.01) > 1e-4
    assert (ticks["inside"].astype(bool) == (away < 0.01))[sure].all() and ticks["inside"].any()


def test_an_edit_is_all_or_nothing(stage: wale.Stage, corduroy: wale.Program) -> None:
    with stage.edit() as edit:
        one, two = edit.add(corduroy), edit.add(corduroy, layer=1)
        edit.set(one, "wale", 0.004)
        edit.move(one, (0.01, 0))
        assert len(stage) == 0
    assert len(stage) == 2 and one.exists
    with pytest.raises(wale.Error), stage.edit() as edit:
        edit.remove(two)
        edit.move(one, (math.nan, 0))
    assert len(stage) == 2
    edit = stage.edit()  # the first error counts, and it is one of the calls that are checked by the commit
    edit.move(one, (math.nan, 0))
    edit.fail("there is none", argument="mine")
    with pytest.raises(wale.Error) as raised:
        edit.commit()
    assert raised.value.argument == "to"
    with pytest.raises(KeyError), stage.edit() as edit:
        edit.remove(two)
        raise KeyError
    assert len(stage) == 2
    with stage.edit() as edit:
        edit.enable(one, False)
        edit.bring(one, 2)
        edit.resize(one, (0.01, 0.01))
        edit.replace(one, corduroy)
        edit.remove(two)
    assert len(stage) == 1


def test_contacts(stage: wale.Stage, corduroy: wale.Program) -> None:
    heard: list[wale.Contact] = []
    patch = stage.add(corduroy, size=(0.01, 0.03))
    stage.on_contact(heard.append)
    stage.run(1.25, virtual_time=True)
    assert heard == [] and stage.poll() == 0
    kinds = [each.kind for each in heard]
    assert kinds[:4] == [wale.ContactKind.enter, wale.ContactKind.leave] * 2
    assert all(each.patch == patch.id for each in heard)
    assert [each.time for each in heard] == sorted(each.time for each in heard)

    heard.clear()

    def refuse(each: wale.Contact) -> None:
        heard.append(each)
        raise KeyError

    stage.on_contact(refuse)
    stage.run(1.25, virtual_time=True)
    with pytest.raises(KeyError):
        stage.poll()
    stage.on_contact(heard.append)
    stage.poll()  # all but the one that was refused
    again = [each.kind for each in heard]
    assert len(again) >= 4 and all(one != next for one, next in zip(again, again[1:]))
    stage.on_contact(None)
    assert stage.poll() == 0


def test_a_limit_of_the_user_is_crossed_as_often(device: wale.Device, corduroy: wale.Program) -> None:
    """The hand crosses the ridges as often, whatever part of their force is let through."""
    with wale.Stage(device, max_force=0.3) as stage:
        patch = stage.add(corduroy)
        felt = stage.run(2, virtual_time=True).measure(patch, settling=0.5, least_crossings=10)
    assert felt.crossings > 10
    assert felt.force.p99 == pytest.approx(0.3, rel=0.02)


def test_a_loop_of_ones_own(corduroy: wale.Program) -> None:
    profile = wale.profile("sandpaper")
    with wale.Stage(profile, max_force=1) as stage:
        stage.add(corduroy)
        with wale.Loop(stage) as loop:
            largest = 0.0
            for tick in range(100_000):
                if tick >= 2000 and largest > 0.9:
                    break
                x = int(profile.position_counts / 8 * math.sin(tick * 2 * math.pi / profile.rate))
                force = loop.step((x, 0))
                loop.exerted(force)
                largest = max(largest, abs(force[0]))
                time.sleep(1e-4)
            assert 0.9 < largest <= 1.0
            assert loop.step((0, 0), contact=wale.ReadingContact.lost) == (0, 0)
    profile.rate = 1e9
    assert code_of(lambda: wale.Stage(profile)) == wale.Code.malformed_value


def test_snapshots(stage: wale.Stage, library: wale.Library) -> None:
    patch = stage.add(library.find("sandpit"))
    stage.run(2, virtual_time=True)
    snapshot = patch.snapshot()
    stage.close()
    (grid,) = snapshot.grids.values()
    assert grid.ndim == 2 and grid.dtype == np.float32 and np.ptp(grid) > 0
    x, y = np.meshgrid(np.linspace(-0.02, 0.02, 80), np.linspace(-0.02, 0.02, 60))
    places = np.stack([x, y], axis=-1)
    heights = snapshot.surface(places)
    assert heights.shape == (60, 80) and np.ptp(heights) > 0
    assert snapshot.surface(places[7]) == pytest.approx(heights[7])
    assert snapshot.colours(places).shape == (60, 80, 3)
    with pytest.raises(ValueError):
        snapshot.surface(np.zeros((5, 3)))
    assert isinstance(snapshot.states, dict)


def test_marks(stage: wale.Stage, library: wale.Library) -> None:
    program = library.compile("wale 1\nmaterial m {\n  physical {\n    force = -1 N/m * hand\n"
                              "    show circle(hand, 5 mm)\n  }\n}\n")
    patch = stage.add(program)
    (mark,) = patch.snapshot().show(position=(0.01, -0.02))
    assert mark.kind == wale.MarkKind.circle and mark.values[:3] == pytest.approx((0.01, -0.02, 0.005))


def test_recordings(device: wale.Device, corduroy: wale.Program, tmp_path) -> None:
    file = tmp_path / "rän.wrec"
    with wale.Stage(device, record=file, record_hand="lateral", max_force=3) as stage:
        stage.add(corduroy)
        run = stage.run(1, virtual_time=True)
        assert code_of(lambda: stage.run(1, virtual_time=True)) == wale.Code.unwritable_file
    with wale.Recording(file) as recording:
        assert (recording.device, recording.hand, recording.max_force) == ("sandpaper", "lateral", 3)
        assert recording.complete and recording.virtual_time and len(recording) == run.ticks_run
        ticks = recording.ticks
        assert (ticks["force"] == run.ticks["force"]).all()
        assert ticks["counts_x"] * recording.position_step == pytest.approx(run.ticks["position"][:, 0], abs=1e-6)
        replay = recording.replay()
        assert (replay.ticks, replay.differing, replay.largest_force) == (len(ticks), 0, 0)
    file.write_bytes(b"x")
    assert code_of(lambda: wale.Recording(file)) == wale.Code.damaged_file


def test_places_are_two_numbers(stage: wale.Stage, corduroy: wale.Program) -> None:
    patch = stage.add(corduroy)
    with pytest.raises(ValueError, match="to: expected two numbers, x and y"):
        patch.move((0, 0, 0))
    with pytest.raises(TypeError, match="to: expected two numbers, x and y"):
        patch.move(1)
    with pytest.raises(TypeError, match="at: expected a number, found 'a'"):
        stage.add(corduroy, at=("a", 0))


def test_arguments_of_a_wrong_type_are_told_by_name(stage: wale.Stage, corduroy: wale.Program, library: wale.Library) -> None:
    patch = stage.add(corduroy)
    run = stage.run(0.1, virtual_time=True)
    loop = wale.Loop(wale.Stage(wale.profile("sandpaper")))
    edit = stage.edit()
    for name, wrong in [
        ("program", lambda: stage.add("corduroy")), ("shape", lambda: stage.add(corduroy, shape="round")),
        ("size", lambda: stage.add(corduroy, size=5)), ("size", lambda: stage.add(corduroy, size=("a", 1))),
        ("layer", lambda: stage.add(corduroy, layer="front")), ("program", lambda: patch.replace(None)),
        ("parameter", lambda: patch.set(3, 1)), ("value", lambda: patch.set("wale", "0.003")),
        ("layer", lambda: patch.bring("front")), ("enabled", lambda: patch.enable("no")), ("patch", lambda: run.measure("p")),
        ("settling", lambda: run.measure(patch, settling="long")), ("seconds", lambda: stage.run("1")),
        ("virtual_time", lambda: stage.run(1, virtual_time="yes")), ("workspace", lambda: stage.add_workspace(corduroy)),
        ("patch", lambda: edit.move(corduroy, (0, 0))), ("device", lambda: wale.Stage("simulated")),
        ("record", lambda: wale.Stage(wale.profile("sandpaper"), record=3)), ("stage", lambda: wale.Loop(corduroy)),
        ("counts", lambda: loop.step(5)), ("counts", lambda: loop.step((0.5, 0))), ("contact", lambda: loop.step((0, 0), contact="ok")),
        ("periods", lambda: loop.step((0, 0), periods=1.5)), ("receive", lambda: stage.on_contact("hear")),
        ("receive", lambda: stage.on_contact(0)), ("hand", lambda: wale.open_device("simulated", hand=0.5)),
        ("motion", lambda: wale.open_device("simulated", motion="rest")), ("spelling", lambda: wale.open_device(3)),
        ("name", lambda: library.find(None)), ("percept", lambda: library.level(1, 1)), ("level", lambda: library.level("roughness", None)),
        ("path", lambda: library.open(3)), ("data", lambda: library.open_bytes("wale 1")), ("data", lambda: wale.Program.load(7)),
        ("folders", lambda: wale.Library(3)), ("folders", lambda: wale.Library([3])), ("name", lambda: wale.profile(1)),
        ("corners", lambda: wale.Shape.polygon("abc")), ("cells", lambda: wale.Shape.mask([["a"]], 0.01)),
        ("side", lambda: wale.Shape.mask([[1]], "a")), ("half_width", lambda: wale.Shape.ellipse("a", 1)),
        ("settings", lambda: wale.batch(corduroy, np.zeros((1, 2)), settings=[("wale", 1)])),
        ("wale", lambda: wale.batch(corduroy, np.zeros((1, 2)), settings={"wale": "wide"})),
        ("position", lambda: wale.batch(corduroy, "here")), ("program", lambda: wale.batch("corduroy", np.zeros((1, 2)))),
        ("time", lambda: wale.batch(corduroy, np.zeros((1, 2)), time=["now"])),
    ]:
        with pytest.raises(TypeError, match=f"^{name}: expected "):
            wrong()
    with pytest.raises(ValueError, match="cells: expected true or false"):
        wale.Shape.mask([[math.nan, 1]], 0.01)
    with pytest.raises(ValueError, match="corners: expected an array"):
        wale.Shape.polygon([(0, 0), (1,)])
    assert loop.step((2**40, 0)) == (0, 0)  # beyond every device: a lost reading


def test_a_receiver_that_is_false_still_receives(stage: wale.Stage, corduroy: wale.Program) -> None:
    class Heard(list):  # empty, so it is false
        def __call__(self, contact: wale.Contact) -> None:
            self.append(contact)

    stage.add(corduroy, size=(0.01, 0.01))
    heard = Heard()
    stage.on_contact(heard)
    stage.run(1, virtual_time=True)
    stage.poll()
    assert len(heard) > 0


def test_the_ticks_before_a_cut_can_be_read(device: wale.Device, corduroy: wale.Program, tmp_path) -> None:
    file = tmp_path / "run.wrec"
    with wale.Stage(device, record=file) as stage:
        stage.add(corduroy)
        stage.run(5, virtual_time=True)
    whole = wale.Recording(file)
    file.chmod(0o600)
    file.write_bytes(file.read_bytes()[:-100_000])
    with pytest.raises(wale.Error) as raised:
        wale.Recording(file)
    assert raised.value.code == wale.Code.damaged_file and "most_ticks" in raised.value.mend
    part = wale.Recording(file, most_ticks=900)
    assert len(part) == 900 < len(whole) and not part.complete
    assert (part.ticks["counts_x"] == whole.ticks["counts_x"][:900]).all()


def test_what_moves_the_handle_is_one_line(device: wale.Device) -> None:
    assert code_of(lambda: wale.Stage(device, record="x.wrec", record_hand="a\nb")) == wale.Code.malformed_value
    assert code_of(lambda: wale.Stage(device, record="x.wrec", record_hand="\udcff")) == wale.Code.invalid_encoding


def test_profiles_beyond_any_device_are_refused() -> None:
    from dataclasses import replace

    profile = wale.profile("sandpaper")
    for wrong in [{"velocity_window": 1e9}, {"delay_x": 1e9}, {"name": ""}]:
        assert code_of(lambda: wale.Stage(replace(profile, **wrong))) == wale.Code.malformed_value


def test_a_device_that_a_text_declares(library: wale.Library) -> None:
    text = (Path(__file__).parents[2] / "examples/custom_device/main.cpp").read_text().split('R"(')[1].split(')"')[0]
    syrup = library.compile(text + "material syrup { physical { force = -2 N s/m * velocity } }", device="rail_stick")
    profile = syrup.profile
    assert (profile.name, profile.force, profile.rate, profile.mass) == ("rail_stick", 4, 1000, 0.1)
    stage = wale.Stage(profile)
    stage.add(syrup)
    with wale.Loop(stage) as loop:
        for count in range(200):
            force = loop.step((count, 0))
    assert -4 <= force[0] < -0.01  # syrup resists
    own = wale.Library(devices=text)
    with own.open_device("simulated:rail_stick") as device, wale.Stage(device) as stage:
        assert device.profile == syrup.profile
        stage.add(syrup)
        assert 0.01 < abs(stage.run(1, virtual_time=True).ticks["force"][:, 0]).max() <= 4
    assert [each.spelling for each in own.devices()].count("simulated:rail_stick") == 1
    assert "simulated:rail_stick" not in [each.spelling for each in library.devices()]
    assert library.find("corduroy").profile == wale.profile("sandpaper")


def test_a_pad_that_a_text_declares() -> None:
    from dataclasses import replace

    text = ("wale 1\nexport device pad {\n  class vibrating_pad\n  position none\n  explores 0.1 m/s\n  acceleration 60 Hz, 100 % = %A m/s^2\n"
            "  frequency 30 Hz .. 180 Hz\n  rate 250 Hz\n  patch 80 mm, 60 mm, 3 mm\n}\n")
    strong, weak = (wale.Library(devices=text.replace("%A", most)) for most in ("12", "3"))
    for own, most in [(strong, 12), (weak, 3), (strong, 12)]:
        program = own.find("corduroy", device="pad")
        with own.open_device("simulated:pad") as device:
            profiles = [device.profile, own.profile("pad"), program.profile]
        for profile in profiles:
            with wale.Stage(profile) as stage:
                stage.add(program)
                with wale.Loop(stage) as loop:
                    drives = [loop.step((0, 0)) for _ in range(100)]
                assert 0 < max(drive[0] for drive in drives) <= most
    with pytest.raises(wale.Error, match="shakes"):
        wale.Stage(replace(wale.profile("gamepad"), name="nobodys_pad"))
    with pytest.raises(wale.Error, match="position"):
        wale.Stage(replace(wale.profile("sandpaper"), has_position=False))


def test_ticks_say_which_patch_they_were_on(device: wale.Device, library: wale.Library, tmp_path) -> None:
    file = tmp_path / "run.wrec"
    with wale.Stage(device, record=file) as stage:
        left = stage.add(library.find("corduroy"), at=(-0.02, 0), size=(0.02, 0.04))
        right = stage.add(library.find("oil"), at=(0.02, 0), size=(0.02, 0.04))
        ticks = stage.run(3, virtual_time=True).ticks
        by_id = {left.id: left.number, right.id: right.number, 0: 0xFFFFFFFF}
    assert set(ticks["patch"]) == set(by_id)
    assert ((ticks["patch"] != 0) == (ticks["inside"] != 0)).all() and len(set(by_id.values())) == 3
    assert (ticks["position"][ticks["patch"] == left.id][:, 0] < 0).all() if left.exists else True
    assert [by_id[each] for each in ticks["patch"]] == list(wale.Recording(file).ticks["patch"])


def test_numbers_that_no_struct_holds_are_named(stage: wale.Stage, corduroy: wale.Program) -> None:
    patch = stage.add(corduroy)
    with wale.Stage(wale.profile("sandpaper")) as other, wale.Loop(other) as loop:
        for name, wrong in [("contact", {"contact": 2**40}), ("button", {"button": 2**40}), ("button", {"button": -2**40})]:
            with pytest.raises(ValueError, match=f"^{name}: "):
                loop.step((0, 0), **wrong)
        for periods in [-2**70, 2**70, -1, 0]:
            loop.step((0, 0), periods=periods)
    for name, wrong in [("enabled", lambda: patch.enable(2**40)), ("parameter", lambda: patch.set("\ud800", 1)),
                        ("name", lambda: wale.profile("\ud800")), ("spelling", lambda: wale.open_device("\ud800"))]:
        with pytest.raises(ValueError, match=f"^{name}: "):
            wrong()
