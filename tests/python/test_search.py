"""Materials by words and by feel: what is found is compared with the command line by tests/index/for_programs.cpp."""

import math
import os
import subprocess
from pathlib import Path

import pytest
import wale

ribs = """wale 1
/// Ribs.
material ribs{0} {{
  representative {{
    title "Ribs {0}"
    kind trial.woven
  }}
  perceptual {{ roughness 0.{1} estimated }}
  physical {{ force = lateral(cos(2 pi * x / 2.5 mm)) }}
}}
"""


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> wale.Library:
    """A library that looks in an index of five materials, which the command line made."""
    folder = tmp_path_factory.mktemp("shelf")
    (folder / "wale.project").write_text('licence "CC0-1.0"\n')
    for i in range(1, 6):
        (folder / f"ribs{i}.wale").write_text(ribs.format(i, 2 + i))
    index = folder / "an.index"
    program = Path(os.environ["WALE_SHARED_LIBRARY"]).resolve().parents[1] / "wale"
    subprocess.run([program, "library", "index", folder, "-o", index], check=True, capture_output=True)
    return wale.Library(index=index)


def test_words(library: wale.Library) -> None:
    first = library.search("rough ribbed cotton").matches[0]
    assert (first.name, first.module, first.found_by, first.found_in) == ("corduroy", "fabric.corduroy", "called", "ribbed cotton")
    assert first.score > 0 and first.distance is None and first.from_other is None
    assert library.search_later("ribbed", kind="fabric", most=1).take_matches().matches[0].kind.startswith("fabric")
    assert library.search("zzzz").matches == ()
    why = library.search("corduroi").warnings[0]
    assert (why.code, why.argument, why.text) == (wale.Code.unknown_name, "text", "corduroi")
    assert why.mend == 'did you mean "corduroy"?' and why.nearest == ("corduroy",)
    assert '"ribed"' in library.search("ribed fbric").warnings[0].sentence
    assert library.search("slate", kind="fabric").warnings[0].mend == "one of another kind has it"
    assert library.search("cotton", kind="stone").warnings[0].mend.endswith("of other kinds have it")
    assert "a blank text" in library.search("qqqqqqqqqqqq").warnings[0].mend
    assert library.search("slate").warnings == ()


def test_feel(shelf: wale.Library) -> None:
    near = shelf.nearest("ribs3")
    assert near.warnings == (), "the library and the command line of one build are one build"
    assert [each.name for each in near.matches] == ["ribs4", "ribs2", "ribs5", "ribs1"]
    nearest = near.matches[0].distance
    assert nearest is not None and 0 < nearest.low <= nearest.high and nearest.plainest == "amplitude"
    assert nearest.unknown == () or math.isinf(nearest.high)
    assert [each.name for each in shelf.search(percepts={"roughness": 0.41}, most=2).matches] == ["ribs2", "ribs3"]
    assert [each.name for each in shelf.search(percepts={"roughness": (0.45, 0.65)}).matches] == ["ribs3", "ribs4"]
    assert [each.name for each in shelf.search("ribs", near="ribs1", most=1).matches] == ["ribs2"]
    between = shelf.between("ribs1", "ribs5").matches
    assert {each.name for each in between} == {"ribs2", "ribs3", "ribs4"}
    assert all(each.distance and each.from_other for each in between)


def test_a_search_under_way(shelf: wale.Library) -> None:
    future = shelf.between_later("ribs1", "ribs5", most=1)
    assert future.wait() and future.poll() and future.progress() == (0, 0)
    future.cancel()  # too late
    assert len(future.take_matches().matches) == 1
    with pytest.raises(wale.Error) as raised:
        future.take_matches()
    assert raised.value.code == wale.Code.wrong_moment


def test_what_is_wrong(shelf: wale.Library) -> None:
    for call, code, argument in [
        (lambda: shelf.nearest("ribs33"), wale.Code.unknown_name, "material"),
        (lambda: shelf.search(kind="trail"), wale.Code.unknown_name, "kind"),
        (lambda: shelf.search(percepts={"roughness": 2}), wale.Code.level_out_of_range, "percepts"),
        (lambda: shelf.nearest("ribs1", device="falcon"), wale.Code.other_device, "device"),
    ]:
        with pytest.raises(wale.Error) as raised:
            call()
        assert (raised.value.code, raised.value.argument) == (code, argument)
    for wrong in [{"roughness": "rough"}, {"roughness": ("a", 1)}]:
        with pytest.raises(TypeError):
            shelf.search(percepts=wrong)  # type: ignore[dict-item]
    with pytest.raises(ValueError):
        shelf.search(percepts={"roughness": (0.1, 0.2, 0.3)})  # type: ignore[dict-item]
    with pytest.raises(TypeError):
        shelf.search("ribs", most=1.5)  # type: ignore[arg-type]
