"""Materials and levels by name, errors, programs."""

import gc
import math
import threading

import pytest
import wale

unfinished = "wale 1\nmaterial m {\n  physical {\n    force = 1 + nothing\n  }\n}\n"
unused = "wale 1\nmaterial m {\n  physical {\n    let half = 0.5 mm\n    force = -1 N/m * hand\n  }\n}\n"


def test_a_material_is_the_same_by_every_way(library: wale.Library, corduroy: wale.Program, tmp_path) -> None:
    data = bytes(corduroy)
    assert data == bytes(library.find("fabric.corduroy"))
    assert data == bytes(library.find_later("corduroy").take())
    assert data == bytes(wale.Program.load(data)) == bytes(library.open_bytes(data))
    assert data == bytes(library.open_bytes(memoryview(bytes(each for byte in data for each in (byte, 0)))[::2]))
    file = tmp_path / "corduroy.wpp"
    file.write_bytes(data)
    assert data == bytes(library.open(file)) == bytes(library.open_later(file).take())


def test_a_program_says_what_it_is(corduroy: wale.Program) -> None:
    assert (corduroy.material, corduroy.device, corduroy.vibrates) == ("corduroy", "sandpaper", False)
    ribs = next(each for each in corduroy.parameters if each.name == "wale")
    assert (ribs.unit, ribs.si_unit, ribs.description) == ("mm", "m", "distance between ribs")
    assert (ribs.low, ribs.value, ribs.high) == pytest.approx((1e-3, 2.5e-3, 5e-3))
    roughness = corduroy.percepts[0]
    assert (roughness.name, roughness.unit, roughness.parameter) == ("roughness", "N", "roughness")
    assert roughness.level == pytest.approx(0.6, abs=0.01)
    assert roughness.amplitude == pytest.approx(1.934, abs=0.002)  # N
    assert corduroy.warnings == []


def test_levels(library: wale.Library) -> None:
    assert library.level("roughness", 0.6).percepts[0].level == pytest.approx(0.6, abs=0.01)
    assert bytes(library.level("roughness", 0.5)) == bytes(library.level("roughness", "0.5"))
    assert library.level("roughness", "coarse").percepts[0].level > 0.5
    for wrong, code in [(1.5, wale.Code.level_out_of_range), (math.nan, None), ("coarze", wale.Code.unknown_name)]:
        with pytest.raises(wale.Error) as raised:
            library.level("roughness", wrong)
        assert code is None or raised.value.code == code


def test_an_unknown_name_comes_with_the_nearest(library: wale.Library) -> None:
    with pytest.raises(wale.Error) as raised:
        library.find("corduory")
    error = raised.value
    assert error.code == wale.Code.unknown_name and error.name == "unknown_name" and error.severity == "error"
    assert error.nearest[0] == "corduroy" and len(error.nearest) <= 3
    assert (error.argument, error.text, error.span) == ("name", "corduory", None)
    assert "corduory" in str(error) and str(error).startswith("W0201")


def test_an_error_in_a_text_has_its_place(library: wale.Library) -> None:
    with pytest.raises(wale.Error) as raised:
        library.compile(unfinished, name="mine.wale")
    assert raised.value.span == wale.Span(file="mine.wale", line=4, column=17, length=7)
    assert raised.value.mend


def test_warnings_come_with_the_program(library: wale.Library) -> None:
    (warning,) = library.compile(unused).warnings
    assert (warning.code, warning.severity) == (wale.Code.unused_name, "warning")
    assert warning.span is not None and warning.span.line == 4


def test_texts_may_be_anything(library: wale.Library) -> None:
    for text in ["", "\0", "cor\0duroy", "\udcff", "ä" * 1000, "\U0001f9f5"]:
        with pytest.raises(wale.Error):
            library.find(text)


def test_futures(library: wale.Library) -> None:
    with wale.Library() as own:
        future = own.find_later("denim")
        assert future.wait(60) and future.poll()
        assert future.take().material == "denim"
        with pytest.raises(wale.Error) as raised:
            future.take()
        assert raised.value.code == wale.Code.wrong_moment
        with pytest.raises(wale.Error):
            own.level_later("roughness", 7).take()
        with pytest.raises(wale.Error):
            own.compile_later(unfinished).take()


def test_what_is_closed_says_so(library: wale.Library) -> None:
    own = wale.Library()
    own.close()
    own.close()
    with pytest.raises(ValueError, match="the Library is closed"):
        own.find("corduroy")
    program = library.find("denim")
    with program:
        pass
    with pytest.raises(ValueError, match="the Program is closed"):
        bytes(program)


def test_damaged_programs_are_refused(corduroy: wale.Program) -> None:
    data = bytearray(bytes(corduroy))
    data[len(data) // 2] ^= 1
    for wrong in [bytes(data), b"", b"\x7fELF"]:
        with pytest.raises(wale.Error) as raised:
            wale.Program.load(wrong)
        assert raised.value.code == wale.Code.damaged_file and raised.value.argument


def test_threads_may_ask_at_the_same_time(library: wale.Library) -> None:
    found: list[bytes] = []
    threads = [threading.Thread(target=lambda: found.append(bytes(library.find("denim")))) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(found) == 2 and found[0] == found[1]
    gc.collect()


def test_levels_are_names_or_numbers(library: wale.Library) -> None:
    for wrong in [math.nan, math.inf, "nan", "0x.8p0", ".5", "1e"]:
        with pytest.raises(wale.Error) as raised:
            library.level("roughness", wrong)
        assert raised.value.code == wale.Code.malformed_value and raised.value.argument == "level"
    with pytest.raises(wale.Error) as raised:
        library.level("roughness", -1e-14)  # not 0
    assert raised.value.code == wale.Code.level_out_of_range


def test_names_of_texts(library: wale.Library) -> None:
    for name, code in [("\udcff", wale.Code.invalid_encoding), ("a\nb", wale.Code.malformed_value)]:
        with pytest.raises(wale.Error) as raised:
            library.compile("wale 1\n", name=name)
        assert raised.value.code == code and raised.value.argument == "name"


def test_folders_are_a_list() -> None:
    with pytest.raises(TypeError, match="write \\['/usr'\\]"):
        wale.Library("/usr")


def child(work) -> int:
    """The status of a child of os.fork that does the work and ends as Python usually does."""
    import os
    import subprocess
    import sys

    program = f"import os, sys, wale\n{work}\nsys.stdout.flush()\n"
    del os
    return subprocess.run([sys.executable, "-c", program], timeout=100, check=False).returncode


def test_a_child_of_fork_ends() -> None:
    assert child("""
library = wale.Library()
library.find_later("oil").take()
later = library.find_later("corduroy")
stage = wale.Stage(wale.open_device("simulated:sandpaper"))
patch = stage.add(library.find("oil"))
stage.start()
loops = wale.Stage(wale.profile("sandpaper"))
loop = wale.Loop(loops)
free, busy = wale.open_device("simulated:sandpaper"), wale.open_device("simulated:sandpaper")
of_busy = wale.Stage(busy)
pid = os.fork()
if pid == 0:
    assert library.find_later("oil").take().material == "oil"
    for wrong in [later.take, stage.stop, stage.start, lambda: patch.move((0, 0)), lambda: wale.Stage(free),
                  lambda: wale.Stage(busy)]:
        try:
            wrong()
            os._exit(3)
        except wale.Error as error:
            assert error.code == wale.Code.wrong_moment and (error.argument != "device" or "parent" in str(error))
    assert loop.step((0, 0)) == (0, 0)
    sys.exit(0)
assert os.waitpid(pid, 0)[1] == 0
assert later.take().material == "corduroy" and stage.is_running
""") == 0


def test_the_package_finds_the_library_of_its_prefix(tmp_path) -> None:
    import os
    import pathlib
    import shutil
    import subprocess
    import sys

    package = tmp_path / "lib/python3/dist-packages/wale"
    shutil.copytree(pathlib.Path(wale.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    library = os.environ["WALE_SHARED_LIBRARY"]
    environment = {key: value for key, value in os.environ.items() if key != "WALE_SHARED_LIBRARY"}
    environment["PYTHONPATH"] = str(package.parent)

    def told() -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-c", "import wale; print(wale.__version__)"], env=environment,
                              capture_output=True, text=True, check=False)

    (tmp_path / "lib/libwale.so.1").write_bytes(b"no library")
    refused = told()
    assert refused.returncode != 0 and "WALE_SHARED_LIBRARY" in refused.stderr and str(tmp_path) in refused.stderr
    (tmp_path / "lib/libwale.so.1").unlink()
    (tmp_path / "lib/libwale.so.1").symlink_to(library)
    for each in pathlib.Path(library).parent.glob("libwale-runtime.so.1"):
        (tmp_path / "lib" / each.name).symlink_to(each)
    assert told().stdout.strip() == wale.__version__


@pytest.mark.parametrize("odd", ["a\nb", "\x1b[31mred", "\u202eyordroc", "x\r\ny", "a\u2028b", "\x9b1m"])
def test_what_a_person_reads_is_one_line_that_a_terminal_shows(library: wale.Library, odd: str) -> None:
    calls = [wale.Recording, wale.load_workspace, wale.profile, wale.open_device, library.open, library.open_workspace,
             library.find, library.profile, library.open_device, lambda name: library.level(name, 0.5),
             lambda name: library.level("roughness", name), lambda name: library.find("corduroy", device=name),
             lambda name: library.compile("wale 1\n", name=name), lambda name: library.compile(f"wale 1\nmaterial {name} {{\n}}\n"),
             lambda name: library.find("corduroy", material=name), lambda name: wale.Library([name])]
    for call in calls:
        with pytest.raises(wale.Error) as raised:
            call(odd)
        words = str(raised.value)
        assert not any(code < " " or "\x7f" <= code < "\xa0" or code in "\u2028\u2029\u202e" for code in words), repr(words)


def test_what_the_device_cannot_give_is_told(library: wale.Library, corduroy: wale.Program) -> None:
    strong = library.compile("wale 1\nmaterial m { physical { force = lateral(sin(2 pi * x / 4 mm), amplitude: 40 N) } }\n")
    saturated = [each for each in strong.fates if each.fate == wale.FateKind.saturated]
    assert len(saturated) == 1 and not saturated[0].is_percept and "40 N" in saturated[0].reason
    roughness = corduroy.fates[0]
    assert (roughness.name, roughness.is_percept, roughness.fate) == ("roughness", True, wale.FateKind.kept)
    assert roughness.asked == pytest.approx(0.6)
    assert roughness.given == pytest.approx(0.6, abs=0.01)
