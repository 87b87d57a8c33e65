"""Workspaces: of a text, of a file, and on a stage."""

import numpy
import pytest
import wale

desk = """wale 1

/// On the table.
workspace desk {
  patch left = corduroy { at -30 mm, 0 mm; size 40 mm, 50 mm; shape ellipse }
  patch right = "denim"(roughness: 0.3) {
    at   30 mm, 0 mm
    size 40 mm, 50 mm
    mark roughness, low 0.2, "still denim"
  }
}

workspace empty {
}
"""


@pytest.fixture(scope="module")
def workspace(library: wale.Library) -> wale.Workspace:
    return library.workspace(desk)


def test_it_says_what_lies_where(workspace: wale.Workspace) -> None:
    assert (workspace.name, workspace.documentation, workspace.device, len(workspace)) == ("desk", "On the table.", "sandpaper", 2)
    left, right = workspace.patches
    assert (left.name, left.made_of, right.made_of) == ("left", "corduroy", '"denim"(roughness: 0.3)')
    assert left.at == pytest.approx((-0.03, 0))
    assert left.size == pytest.approx((0.04, 0.05, 0.001))
    assert right.shape is None and left.shape is not None
    assert left.shape.edge((0.0, 0.0)) == pytest.approx(0.02)  # half of its width
    assert left.marks == []
    [mark] = right.marks
    assert (mark.slider, mark.is_percept, mark.high, mark.says) == ("roughness", True, None, "still denim")
    assert mark.low == pytest.approx(0.2)
    assert right.program.percepts[0].level == pytest.approx(0.3, abs=0.02)
    begin, end = right.statement
    assert desk[begin:end].startswith("patch right =") and desk[begin:end].endswith("}")


def test_a_file_holds_the_same(workspace: wale.Workspace, library: wale.Library, tmp_path) -> None:
    data = bytes(workspace)
    assert bytes(wale.Workspace.load(data)) == data
    file = tmp_path / "desk.wws"
    file.write_bytes(data)
    assert bytes(wale.load_workspace(file)) == data == bytes(library.open_workspace(file))
    written = tmp_path / "desk.wale"
    written.write_text(desk)
    assert bytes(library.open_workspace(written, workspace="desk")) == bytes(library.workspace(desk, name=str(written)))
    assert wale.Workspace.load(data).patches[0].statement == (0, 0)
    with pytest.raises(wale.Error) as damaged:
        wale.Workspace.load(data[:-1])
    assert damaged.value.code == wale.Code.damaged_file and damaged.value.argument == "bytes"


def test_its_patches_are_felt(workspace: wale.Workspace, stage: wale.Stage) -> None:
    patches = stage.add_workspace(workspace)
    assert len(patches) == len(stage) == 2 and all(each.exists for each in patches)
    run = stage.run(seconds=1, virtual_time=True)
    forces = run.ticks["force"]
    assert numpy.isfinite(forces).all() and numpy.abs(forces).max() > 0.1  # N


def test_warnings_and_errors_have_places(library: wale.Library) -> None:
    alike = library.workspace(desk.replace('"denim"(roughness: 0.3)', "corduroy(roughness: 0.6)").replace("30 mm", "20 mm")
                              .replace("; shape ellipse", ""), legibility=True)
    assert [each.code for each in alike.warnings] == [wale.Code.indistinct_neighbours]
    assert alike.warnings[0].span is not None and alike.warnings[0].span.line == 6
    for text, options, code in [(desk, {"workspace": "desc"}, wale.Code.unknown_workspace),
                                (desk, {"device": "falcom"}, wale.Code.unknown_device),
                                (desk.replace("40 mm", "-40 mm"), {}, wale.Code.value_out_of_range),
                                ("wale 1\n", {}, wale.Code.unknown_workspace)]:
        with pytest.raises(wale.Error) as raised:
            library.workspace(text, **options)
        assert raised.value.code == code
    assert len(library.workspace(desk, workspace="empty")) == 0


def test_files_that_are_not_there(tmp_path) -> None:
    with pytest.raises(wale.Error) as raised:
        wale.load_workspace(tmp_path / "no.wws")
    assert raised.value.code == wale.Code.unreadable_file and raised.value.argument.endswith("no.wws")
    with wale.Library() as library:
        for name, mend in [("no.wws", "workspace file"), ("no.wale", "workspace")]:
            with pytest.raises(wale.Error) as raised:
                library.open_workspace(tmp_path / name)
            assert raised.value.code == wale.Code.unreadable_file and mend in raised.value.mend
        (tmp_path / "bad.wws").write_bytes(b"\x00WWS\x01")
        with pytest.raises(wale.Error) as raised:
            library.open_workspace(tmp_path / "bad.wws")
        assert raised.value.code == wale.Code.damaged_file
