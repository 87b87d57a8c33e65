"""The page of the C interface names what is called otherwise in C++, and nothing that does not exist."""

import re
from pathlib import Path

import wale

root = Path(__file__).resolve().parents[2]
page = (root / "runtime/C_INTERFACE.md").read_text()
section = page.split("## Names that differ")[1]


def headers(ending: str) -> str:
    texts = [file.read_text() for folder in ("schema", "runtime", "library") for file in
             sorted((root / folder / "include/wale").glob(f"*.{ending}"))]
    return "\n".join(texts)


in_c = re.sub(r"/\*.*?\*/", "", headers("h"), flags=re.S)
in_cpp = re.sub(r"//.*", "", headers("hpp"))
functions = set(re.findall(r"\b(wale_[a-z_]+)\(", in_c))
rows = [tuple(re.findall(r"`([^`]+)`", cell) for cell in row) for row in re.findall(r"^\| (.+) \| (.+) \|$", section, re.M)]
alone = re.findall(r"`([\w:]+)`", section.split("C++ alone has")[1].split("\n\n")[0])


def words(names: list[str]) -> set[str]:
    return {word for name in names for word in re.findall(r"\w+", name) if word not in ("std", "future")}


def test_what_the_table_names_exists() -> None:
    assert len(rows) > 15 and len(alone) > 8
    for c, cpp in rows:
        for name in c:
            if name.startswith("wale_x_"):
                assert any(each.endswith(name.removeprefix("wale_x")) for each in functions), name
            elif name.startswith("wale_"):
                assert name in functions, name
            else:
                assert re.search(rf"\b{name}\b", in_c), name
        for word in words(cpp):
            assert re.search(rf"\b{word}\b", in_cpp), word
    for word in words(alone):
        assert re.search(rf"\b{word}\b", in_cpp), word


def test_each_function_of_c_is_in_cpp_or_in_the_table() -> None:
    told = {name for c, _ in rows for name in c}
    endings = tuple(name.removeprefix("wale_x") for name in told if name.startswith("wale_x_"))
    for function in functions - told:
        if not function.endswith(endings):
            name = function.removeprefix("wale_").split("_", 1)[-1]
            assert re.search(rf"\b{name}\(", in_cpp), f"{function} is not in C++, and the page does not say so"


def test_what_is_in_cpp_alone_is_not_in_c() -> None:
    for name in alone:
        if "::" in name and name not in ("Library::open_later", "Recording::read"):  # of these one form
            kind, member = name.split("::")
            assert f"wale_{kind.lower()}_{member}" not in functions, name


def test_python_has_the_names_of_c() -> None:
    kinds = {name.lower(): kind for name, kind in vars(wale).items() if isinstance(kind, type) and name != "Code"}
    otherwise = {"create", "free", "details", "figures", "bytes", "create_for", "interrupt", "ticks", "size", "begin",
                 "parameter", "percept", "warning", "patch", "program", "shape", "mark", "open_part", "open", "code", "nearest",
                 "fate", "other", "state_name", "grid", "level", "measure", "values"}
    for function in functions:
        kind, _, member = function.removeprefix("wale_").partition("_")
        if kind in kinds and member and member not in otherwise:
            assert hasattr(kinds[kind], member), function


def test_headers_name_installed_files_only() -> None:
    public = {f"wale/{file.name}" for folder in ("schema", "runtime", "library", "calibration")
              for file in (root / folder / "include/wale").iterdir()} | {"wale.h"}
    pages = re.search(r"set\(pages ([^)]*)\)", (root / ".setup/package/pages.cmake").read_text())
    assert pages
    installed = public | set(pages.group(1).split()) | {page.split("/")[-1] for page in pages.group(1).split()}
    for folder in ("schema", "runtime", "library", "calibration"):
        for header in [*(root / folder / "include").rglob("*.h"), *(root / folder / "include").rglob("*.hpp")]:
            text = re.sub(r"#include <.*>", "", header.read_text())
            for name in re.findall(r"(?<![\w./~-])([\w/]*\w\.(?:hpp|h|md|cpp))\b", text):
                assert name in installed, f"{header.name} names {name}, which is not installed"
