"""What is read back: patches, the application's own device, errors, and the part of a recording that is intact."""

from collections.abc import Callable
from pathlib import Path

import pytest
import wale

DECLARED = """wale 1
export device my_stick {
  class force_plane
  workspace disc(100 mm)
  position 8192 counts
  force 4 N, 1000 counts
  rate 1000 Hz
  speed assumed 1 m/s
  slew assumed 100 N/s
  velocity_filter 15, 1 counts
  patch 80 mm, 80 mm, 5 mm
  mass 0.1 kg
  damping assumed 1 N s/m
  friction assumed 0.05 N
}
"""


def error_of(call: Callable[[], object]) -> wale.Error:
    with pytest.raises(wale.Error) as raised:
        call()
    return raised.value


def test_a_patch_tells_how_it_lies() -> None:
    library = wale.Library()
    corduroy = library.find("corduroy")
    oval = wale.Shape.ellipse(0.02, 0.01)
    with wale.Stage(library.open_device("simulated")) as stage:
        patch = stage.add(corduroy, at=(0.25, -0.5), layer=2, shape=oval)
        patch.set("wale", 0.003)
        patch.enable(False)
        lies = patch.placement
        assert lies.at == (0.25, -0.5) and lies.layer == 2 and not lies.enabled
        assert lies.size[:2] == pytest.approx((0.04, 0.02))
        assert lies.shape is not None and lies.shape.size == pytest.approx((0.04, 0.02))
        assert bytes(lies.program) == bytes(corduroy)
        assert lies.value("wale") == patch.value("wale") == pytest.approx(0.003)
        assert list(lies.values) == [each.name for each in corduroy.parameters]
        assert error_of(lambda: patch.value("whale")).nearest[0] == "wale"
        assert error_of(lambda: patch.published).code == wale.Code.wrong_moment
        patch.enable()
        patch.move((0.0, 0.0))
        assert lies.at == (0.25, -0.5), "a value of its own"
        stage.run(seconds=0.1, virtual_time=True)
        assert patch.published.at == patch.placement.at == patch.snapshot().placement.at == (0.0, 0.0)
        assert patch.published.values == patch.values
        assert stage.add(corduroy).placement.shape is None
        patch.remove()
        for gone in (lambda: patch.placement, lambda: patch.published, lambda: patch.values, lambda: patch.value("wale")):
            assert error_of(gone).code == wale.Code.wrong_moment
    assert lies.value("wale") == pytest.approx(0.003), "it outlives patch and stage"


def test_materials_by_name_for_an_own_device() -> None:
    library = wale.Library(devices=DECLARED)
    profile = library.profile("my_stick")
    assert (profile.name, profile.force, profile.rate) == ("my_stick", 4, 1000)
    for program in (library.find("corduroy", device="my_stick"), library.level("roughness", 0.4, device="my_stick"),
                    library.compile("wale 1\nmaterial m { physical { force = spring(50 N/m) } }", device="my_stick"),
                    library.find_later("oak", device="my_stick").take()):
        assert program.device == "my_stick"
        wale.Stage(profile).add(program)
    assert library.find("corduroy").device == "sandpaper"
    assert bytes(library.find("corduroy")) == bytes(wale.Library().find("corduroy")), "shipped devices stay as they are"
    assert error_of(lambda: wale.Library().find("corduroy", device="my_stick")).code == wale.Code.unknown_device
    private = error_of(lambda: wale.Library(devices=DECLARED.replace("export ", "")))
    assert private.code == wale.Code.unknown_device and "export device my_stick" in private.mend
    assert error_of(lambda: wale.Library(devices=DECLARED.replace("my_stick", "falcon"))).code == wale.Code.declared_twice
    wrong = error_of(lambda: wale.Library(devices=DECLARED.replace("4 N,", "four,")))
    assert wrong.span is not None and wrong.span.file == "devices" and wrong.span.line == 6
    with pytest.raises(TypeError):
        wale.Library(devices=3)  # type: ignore[arg-type]


def test_a_device_without_a_slew_does_not_run() -> None:
    profile = wale.profile("sandpaper")
    profile.slew = 0
    stage = wale.Stage(profile)
    error = error_of(lambda: wale.Loop(stage))
    assert error.code == wale.Code.unusable_device and error.argument == "slew"
    assert error.expected == "a positive slew" and error.found == "0"


def test_errors_say_each_thing_once_and_by_members() -> None:
    library = wale.Library()
    error = error_of(lambda: library.find("corduory"))
    assert len(error.nearest) == 3 and error.nearest[0] == "corduroy"
    assert str(error).count("near") == 1 and str(error) == f"W0201: {error.args[0]}"
    assert "wale find" not in str(error) and "--" not in str(error)
    assert error.title == wale.Code.unknown_name.title == "a name that nothing declares"
    assert all(code.title for code in wale.Code)
    for force, expected, found in (("spring(\"soft\")", "a number", "a text"), ("3 kg", "N = kg m s^-2", "kg")):
        wrong = error_of(lambda: library.compile(f"wale 1\nmaterial m {{ physical {{ force = {force} }} }}"))
        assert (wrong.expected, wrong.found) == (expected, found), wrong.sentence
    for name in ("qqqqqqqqqq", "whale", "x"):
        assert len(error_of(lambda: library.find(name)).nearest) == 3, name
        assert len(error_of(lambda: library.level(name, 0.5)).nearest) == 3, name
        assert len(error_of(lambda: library.find("oak", device=name)).nearest) == 3, name
    slew = error_of(lambda: library.compile("wale 1\nmaterial m { physical { force = 3 N m } }"))
    assert slew.code == wale.Code.wrong_dimension and slew.nearest == ()
    imported = error_of(lambda: library.compile("wale 1\nimport nowhere.at_all\nmaterial m { physical { force = 1 N } }"))
    assert "folders" in imported.mend and "--" not in imported.mend


def test_an_edit_may_fail_by_its_caller() -> None:
    library = wale.Library()
    corduroy = library.find("corduroy")
    with wale.Stage(library.open_device("simulated")) as stage:
        edit = stage.edit()
        edit.add(corduroy)
        edit.fail("there is no such colour", code=wale.Code.unknown_name, argument="colour", mend="take another")
        error = error_of(edit.commit)
        assert (error.code, error.argument, error.mend) == (wale.Code.unknown_name, "colour", "take another")
        assert len(stage) == 0
        edit.commit()


def test_the_intact_part_of_a_recording_is_counted(tmp_path: Path) -> None:
    library = wale.Library()
    file, cut = tmp_path / "run.wrec", tmp_path / "cut.wrec"
    with wale.Stage(library.open_device("simulated"), record=str(file)) as stage:
        stage.add(library.find("corduroy"))
        run = stage.run(seconds=2, virtual_time=True)
    assert wale.Recording.intact(file) == run.ticks_run
    data, counts = file.read_bytes(), []
    for tenth in range(1, 10):
        cut.write_bytes(data[: len(data) * tenth // 10])
        try:
            counts.append(wale.Recording.intact(cut))
        except wale.Error as error:  # within its header: it is no recording yet
            assert error.code == wale.Code.damaged_file and not counts
            continue
        if counts[-1] < run.ticks_run:
            assert error_of(lambda: wale.Recording(cut)).code == wale.Code.damaged_file
        if counts[-1] > 0:
            assert len(wale.Recording(cut, most_ticks=counts[-1])) == counts[-1]
    assert counts == sorted(counts) and any(0 < each < run.ticks_run for each in counts), counts
