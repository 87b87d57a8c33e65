"""What stands in the files of a site, read by Python's own parsers."""

import html.parser
import json
import os
import pathlib
import re
import subprocess
import urllib.parse

from conftest import SOURCE, WALE, pages, wale

HOSTILE = """wale 1

/// <script>alert("doc")</script> "quoted" ' & \u202e turned
material Evil_One {
  representative {
    title   "</title><script>alert(1)</script><img src=x onerror=alert(2)>"
    called  "\\"><svg onload=alert(3)>", "javascript:alert(4)"
    feels   "like </script><script>alert(5)</script>"
    kind    fabric.woven
    source  "<a href=javascript:alert(6)>x</a>", "http://evil.example/track.png"
    licence "CC0-1.0"
  }
  perceptual { roughness 0.4 }
  physical {
    param rib = 2 mm in 1 mm .. 3 mm "<b onclick=alert(7)>"
    force = lateral(grating(x, period: rib, duty: 0.5, smooth: 24/256))
  }
}
"""


class Page(html.parser.HTMLParser):
    """The elements of a page, its links, and the texts of its scripts; complains about elements that do not close."""

    EMPTY = {"meta", "link", "img", "br", "input", "path", "rect", "circle"}

    def __init__(self, text):
        super().__init__()
        self.elements, self.links, self.open, self.ids, self.script = [], [], [], [], ""
        self.feed(text)
        assert self.open == [], self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.elements.append((tag, attributes))
        self.links += [attributes[name] for name in ("href", "src", "data-touch", "data-plane") if name in attributes]
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1] == "script":
            self.script += data


def with_parts(path, page):
    """The bytes of a page with all that it may load by itself."""
    parts = {path}
    for tag, attributes in page.elements:
        if tag in ("img", "script", "link") and attributes.get("rel") != "alternate":
            for name in ("src", "href"):
                if name in attributes:
                    parts.add((path.parent / attributes[name]).resolve())
    return sum(part.stat().st_size for part in parts)


def test_every_page_is_whole_small_and_loads_nothing_from_elsewhere(shipped):
    assert len(pages(shipped)) > 100
    for path in pages(shipped):
        page = Page(path.read_text())
        assert len(page.ids) == len(set(page.ids)), path
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            assert not parts.scheme and not parts.netloc and not link.startswith("/"), (path, link)
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            assert target.is_file() and shipped.resolve() in target.parents, (path, link)
        policy = [a["content"] for t, a in page.elements if t == "meta" and a.get("http-equiv")]
        assert len(policy) == 1 and "default-src 'none'" in policy[0] and "unsafe" not in policy[0]
        assert not any(name.startswith("on") or name == "style" for _, a in page.elements for name in a), path
        assert with_parts(path, page) < 300_000, (path, with_parts(path, page))
        assert [t for t, _ in page.elements].count("h1") == 1, path
        for tag, attributes in page.elements:
            if tag == "img":
                assert "alt" in attributes and attributes["width"] and attributes["height"], path


def test_numbers_on_a_page_are_those_of_describe(shipped):
    for name in ("corduroy", "slate", "denim"):
        told = json.loads(wale("describe", name, "--json"))
        data = json.loads((shipped / "material" / (name + ".json")).read_text())
        assert data["wale"] == told
        assert data["@type"] == "Dataset" and data["@context"] == "https://schema.org"
        measured = {each["name"]: each for each in data["variableMeasured"]}
        page = (shipped / "material" / (name + ".html")).read_text()
        for percept, reading in told["percepts"].items():
            assert measured[percept]["value"] == reading["level"]
            assert (measured[percept]["minValue"], measured[percept]["maxValue"]) == (reading["low"], reading["high"])
            row = page.split('<tr data-percept="%s">' % percept)[1].split("</tr>")[0]
            read = re.search(r'<data value="([^"]*)" data-low="([^"]*)" data-high="([^"]*)">([^<]*)</data>', row)
            assert [float(each) for each in read.groups()[:3]] == [reading["level"], reading["low"], reading["high"]]
            assert read.group(4) == "%.2f" % reading["level"]
            assert '<strong class="grade %s">' % reading["evidence"] in row
            if reading["asked"] is not None:
                asked = re.search(r'data-label="asked"><data value="([^"]*)"', row)
                assert float(asked.group(1)) == reading["asked"]
        assert float(re.search(r'<data value="([^"]*)" class="newton"', page).group(1)) == told["force"]["max_newton"]
        assert page.index("<dt>Size</dt>") < page.index("<dt>Height</dt>") < page.index("<dt>Tiles</dt>") < page.index("<img")
        inside = json.loads(Page(page).script)
        assert inside["variableMeasured"][0]["value"] == list(told["percepts"].values())[0]["level"]


def test_each_page_has_its_data(shipped):
    for path in pages(shipped):
        page = Page(path.read_text())
        ways = [a["href"] for t, a in page.elements if t == "link" and a.get("type") == "application/ld+json"]
        assert len(ways) == 1, path
        data = json.loads((path.parent / urllib.parse.unquote(ways[0])).read_text())
        assert data["@context"] == "https://schema.org" and data["@type"] in ("Dataset", "DefinedTerm", "ItemList"), path
        assert (path.parent / urllib.parse.unquote(data["url"])).resolve() == path.resolve()
        assert data["@id"] == "/" + path.relative_to(shipped).as_posix().removesuffix(".html")
        for each in data.get("itemListElement", []):
            assert (path.parent / urllib.parse.unquote(each["url"])).is_file(), (path, each)
    data = json.loads((shipped / "percept/roughness.json").read_text())
    reads = {each["name"]: each["reads"] for each in data["wale"]["materials"]}
    told = json.loads(wale("describe", "corduroy", "--json"))
    assert abs(reads["corduroy"] - told["percepts"]["roughness"]["level"]) < 1e-6
    sandpaper = json.loads((shipped / "device/sandpaper.json").read_text())
    figures = {each["name"]: (each["value"], each["unitText"]) for each in sandpaper["variableMeasured"]}
    declared = (SOURCE / "calibration/devices/sandpaper.wale").read_text()
    assert figures["rate"] == (float(re.search(r"rate +(\d+) Hz", declared)[1]), "Hz")


def test_downloads_are_what_wale_builds(shipped, tmp_path):
    wale("build", "corduroy", "-o", tmp_path / "corduroy.wpp")
    assert (shipped / "take/corduroy.wpp").read_bytes() == (tmp_path / "corduroy.wpp").read_bytes()
    assert (shipped / "take/corduroy.hpp").read_text() == wale("build", "corduroy", "--emit", "cpp")
    source = SOURCE / "library/fabric/corduroy.wale"
    assert (shipped / "source/fabric.corduroy.wale").read_bytes() == source.read_bytes()


def test_an_author_who_writes_tags_writes_text(tmp_path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "wale.project").write_text("")
    (library / "evil.wale").write_text(HOSTILE)
    (library / "nul.wale").write_text(HOSTILE.replace("Evil_One", "con").replace("2 mm in", "2.5 mm in"))
    site = tmp_path / "site"
    wale("library", "site", library, "-o", site)
    assert (site / "material/Evil_One.html").is_file() and (site / "material/-63on.html").is_file()
    for path in pages(site):
        text = path.read_text()
        page = Page(text)
        assert not any(name.startswith("on") for _, a in page.elements for name in a), path
        assert all("evil.example" not in link and "javascript" not in link for link in page.links), path
        scripts = [a for t, a in page.elements if t == "script"]
        assert all("src" in a or a.get("type") == "application/ld+json" for a in scripts), path
        assert "\u202e" not in text
    for path in site.rglob("*.js"):
        if path.parent.name in ("data", "touch"):
            assert "<" not in path.read_text(), path
    json.loads(Page((site / "material/Evil_One.html").read_text()).script)
    assert not [each for each in tmp_path.iterdir() if each.name not in ("library", "site")]


def test_what_a_licence_forbids_to_pass_on_is_not_published_and_said(tmp_path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "wale.project").write_text('licence "CC0-1.0"\n')
    ours = HOSTILE.replace("Evil_One", "open_one")
    (library / "open.wale").write_text(ours)
    (library / "kept.wale").write_text(HOSTILE.replace("Evil_One", "kept_one").replace("CC0-1.0", "CC-BY-NC-4.0"))
    (library / "rests.wale").write_text("wale 1\nimport kept\n" + HOSTILE.replace("wale 1", "")
                                        .replace("Evil_One", "rests_one"))
    site = tmp_path / "site"
    run = subprocess.run([WALE, "library", "site", library, "-o", site, "--json"], capture_output=True, text=True)
    assert run.returncode == 1
    report = json.loads(run.stdout)
    assert report["materials"] == 1
    assert sorted(each["material"] for each in report["left_out"]) == ["kept_one", "rests_one"]
    assert all("CC-BY-NC-4.0" in each["why"] for each in report["left_out"])
    assert [path.name for path in (site / "material").glob("*.html")] == ["open_one.html"]
    assert [path.name for path in (site / "source").iterdir()] == ["open.wale"]
    assert "kept_one" in (site / "unknown.html").read_text()
    assert str(tmp_path) not in (site / "unknown.html").read_text()


def test_only_texts_of_which_all_is_published_are_copied(tmp_path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "wale.project").write_text('licence "CC0-1.0"\n')
    open_one = HOSTILE.replace("Evil_One", "open_one")
    licence = '    licence "CC0-1.0"\n'
    (library / "open.wale").write_text(open_one)
    (library / "unquoted.wale").write_text(open_one.replace("open_one", "unquoted").replace(licence, "    licence CC-BY-NC-4.0\n"))
    (library / "misspelt.wale").write_text(
        open_one.replace("open_one", "misspelt").replace(licence, '    license "CC-BY-NC-4.0"\n'))
    (library / "broken.wale").write_text(
        open_one.replace("open_one", "half") + open_one.replace("wale 1", "").replace("open_one", "broken").replace("lateral(", "nothing_such("))
    (library / "garbage.wale").write_text("garbage")
    (library / "number.wale").write_text("wale 1\n\nmaterial 2e_b {\n}\n")
    site = tmp_path / "site"
    run = subprocess.run([WALE, "library", "site", library, "-o", site], capture_output=True, text=True)
    assert run.returncode == 1
    for name in ("unquoted", "misspelt", "broken", "garbage", "number"):
        assert f"{name}.wale has no page: " in run.stderr, run.stderr
        assert not (site / f"source/{name}.wale").exists()
    assert [path.name for path in (site / "source").iterdir()] == ["open.wale"]
    # A text that comes to hold what may not be published goes, and so does one whose library comes to forbid it.
    (library / "open.wale").write_text(open_one + "\nmaterial unfinished { physical { force = } }\n")
    subprocess.run([WALE, "library", "site", library, "-o", site], capture_output=True)
    assert not (site / "source/open.wale").exists()
    (library / "open.wale").write_text(open_one.replace(licence, ""))
    subprocess.run([WALE, "library", "site", library, "-o", site], capture_output=True)
    assert (site / "source/open.wale").exists()
    (library / "wale.project").write_text('licence "CC-BY-NC-4.0"\n')
    subprocess.run([WALE, "library", "site", library, "-o", site], capture_output=True)
    assert not (site / "source/open.wale").exists() and not (site / "material/open_one.html").exists()


def test_no_page_and_no_note_tells_where_the_library_lies(tmp_path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "wale.project").write_text('licence "CC0-1.0"\n')
    (library / "open.wale").write_text(HOSTILE.replace("Evil_One", "open_one"))
    (library / "broken.wale").write_text("wale 1\n\nmaterial broken { physical { force = } }\n")
    site = tmp_path / "site"
    build = [WALE, "library", "site", library, "-o", site, "--json"]
    assert json.loads(subprocess.run(build, capture_output=True, text=True).stdout)["read"] == 1
    for path in site.rglob("*"):
        if path.is_file():
            assert str(tmp_path).encode() not in path.read_bytes(), path
    again = json.loads(subprocess.run(build, capture_output=True, text=True).stdout)
    assert again["read"] == 0 and again["changed"] == 0
    assert [each["file"] for each in again["left_out"]] == [str(library / "broken.wale")]


def test_a_build_touches_only_what_changed(tmp_path):
    library = tmp_path / "library"
    library.mkdir()
    (library / "wale.project").write_text('licence "CC0-1.0"\n')
    plain = ('wale 1\n\nmaterial {0} {{\n  representative {{\n    title "{0}"\n    kind fabric.woven\n  }}\n  perceptual {{ roughness {1} }}\n'
             '  physical {{ force = lateral(grating(x, period: 2 mm, duty: 0.5, smooth: 24/256)) }}\n}}\n')
    for i in range(4):
        (library / f"cloth{i}.wale").write_text(plain.format(f"cloth{i}", 0.2 + 0.15 * i))
    site = tmp_path / "site"

    def build():
        return json.loads(wale("library", "site", library, "-o", site, "--json"))

    def times():
        return {path: path.stat().st_mtime_ns for path in site.rglob("*") if path.is_file()}

    assert build()["read"] == 4
    before = times()
    again = build()
    assert again["read"] == 0 and again["changed"] == 0 and times() == before
    # A word of one material's documentation: its own page changes, and no other material's.
    changed = library / "cloth2.wale"
    changed.write_text(changed.read_text().replace("material cloth2", "/// Softer words.\nmaterial cloth2"))
    assert build()["read"] == 1
    touched = {path.relative_to(site) for path, time in times().items() if before.get(path) != time}
    assert pathlib.Path("material/cloth2.html") in touched
    assert not any(part.parts[0] in ("material", "figure", "touch", "take") and "cloth2" not in part.name for part in touched)
    # One that goes takes its files along, and other people's files stay.
    (site / "mine.txt").write_text("mine")
    changed.unlink()
    build()
    assert not list(site.rglob("*cloth2*")) and (site / "mine.txt").is_file()
    # A build from scratch gives the same bytes.
    anew = tmp_path / "anew"
    wale("library", "site", library, "-o", anew)
    def listed(folder):
        return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*")
                if path.is_file() and path.name != "mine.txt" and not path.name.startswith(".")}
    assert listed(anew) == listed(site)


def test_folders_of_others_are_left_alone(tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    run = subprocess.run([WALE, "library", "site", "library/wood", "-o", tmp_path], capture_output=True, text=True, cwd=SOURCE)
    assert run.returncode == 1 and "W0505" in run.stderr
    assert os.listdir(tmp_path) == ["letter.txt"]
    # A list that somebody forged removes nothing outside.
    victim = tmp_path / "letter.txt"
    site = tmp_path / "site"
    site.mkdir()
    (site / ".wale-site-files").write_text("../letter.txt\n/etc/passwd\nindex.html\n")
    wale("library", "site", "library/wood", "-o", site)
    assert victim.read_text() == "dear" and (site / "index.html").is_file()
