"""The site from the disk in headless Chromium: without scripts, by keyboard, on a phone, in the dark."""

import pytest

import browser
from conftest import pages

pytestmark = pytest.mark.skipif(browser.PROGRAM is None, reason="chromium is missing (Debian: chromium)")


@pytest.fixture(scope="module")
def chromium():
    started = browser.Browser()
    yield started
    started.close()


@pytest.fixture(autouse=True)
def as_a_desk(chromium):
    chromium.screen(1280, 900)
    chromium.scheme("light")
    yield
    chromium.ask("Emulation.setScriptExecutionDisabled", value=False)


def some_pages(folder):
    return ["index.html", "all.html", "collections.html", "space.html", "percepts.html", "devices.html", "unknown.html",
            "material/corduroy.html", "material/velvet.html", "percept/roughness.html", "map/minsky1995.figure19.html",
            "device/sandpaper.html", "kind/fabric.woven.html"]


def address(folder, page):
    return (folder / page).as_uri()


def test_pages_load_without_complaint_and_only_from_the_folder(chromium, shipped):
    for page in some_pages(shipped):
        chromium.open(address(shipped, page))
        assert chromium.complaints() == [], page
        assert all(url.startswith((shipped.as_uri(), "data:")) for url in chromium.requests()), page


def test_the_search_finds_by_word_and_by_level(chromium, shipped):
    chromium.open(address(shipped, "index.html"))
    titles = "[...document.querySelectorAll('#results strong')].map(each => each.textContent)"
    chromium.value("document.getElementById('words').focus()")
    chromium.ask("Input.insertText", text="Wide-wale")
    assert chromium.until(f"document.querySelector('#results .card') && {titles}")[0] == "Wide-wale corduroy"
    chromium.value("""(() => { const at = id => document.getElementById(id); at('words').value = ''; at('order').value = 'roughness';
        document.querySelector('[data-least=roughness]').value = '0.3'; document.querySelector('[data-most=roughness]').value = '0.5';
        at('search').dispatchEvent(new Event('input')); })()""")
    chromium.until(f"{titles}.length && {titles}[0] !== 'Wide-wale corduroy'")
    levels = chromium.value("""[...document.querySelectorAll('#results .levels')].map(each =>
        parseFloat(each.textContent.match(/roughness ([0-9.]+)/)[1]))""")
    assert levels and all(0.295 <= level <= 0.505 for level in levels)
    assert levels == sorted(levels, reverse=True)
    assert chromium.complaints() == []


def test_without_scripts_everything_is_there_but_search_map_and_pointer(chromium, shipped):
    chromium.ask("Emulation.setScriptExecutionDisabled", value=True)
    chromium.open(address(shipped, "material/corduroy.html"))
    tree = chromium.ask("Accessibility.getFullAXTree")["nodes"]
    names = [node.get("name", {}).get("value", "") for node in tree if not node.get("ignored")]
    for text in ("Wide-wale corduroy", "How it feels", "Neighbours by feel", "As it is written", "Take it along"):
        assert text in names
    assert "Sound" not in names  # the panel of the pointer is hidden
    chromium.open(address(shipped, "index.html"))
    tree = chromium.ask("Accessibility.getFullAXTree")["nodes"]
    links = [node["name"]["value"] for node in tree if node.get("role", {}).get("value") == "link"]
    assert "Canvas" in links and "Collections" in links and "fabric" in links and "2" in links
    assert not any(node.get("role", {}).get("value") == "searchbox" and not node.get("ignored") for node in tree)


def test_the_keyboard_reaches_all_in_order_and_moves_the_finger(chromium, shipped):
    chromium.open(address(shipped, "material/corduroy.html"))
    stops = []
    for _ in range(60):
        chromium.press("Tab")
        stop = chromium.value("(() => { const at = document.activeElement; return at === document.body ? '' : at.tagName + ' ' + "
                              "(at.getAttribute('aria-label') || at.textContent).trim().slice(0, 30); })()")
        if not stop:
            break
        stops.append(stop)
    assert stops[0] == "A To the content" and stops[1] == "A Wale library"
    order = [next(i for i, stop in enumerate(stops) if stop.startswith(text)) for text in
             ("A What is unknown", "A fabric.woven", "CANVAS The surface", "BUTTON Pull", "BUTTON Sound", "A roughness",
              "PRE Wale text", "A fabric.corduroy.wale", "SUMMARY")]
    assert order == sorted(order)
    chromium.value("document.querySelector('.stage canvas').focus()")
    chromium.until("document.querySelector('.felt').textContent !== ''")
    before = chromium.value("document.querySelector('.felt').textContent")
    for _ in range(5):
        chromium.press("ArrowRight")
    chromium.until(f"document.querySelector('.felt').textContent !== '{before}'")
    assert " N" in chromium.value("document.querySelector('.felt').textContent")
    assert chromium.complaints() == []


def test_the_finger_is_pulled_by_the_force_of_the_program(chromium, shipped):
    """At a place where the ribs push, the finger stands off the pointer, and with the pull off on it."""
    chromium.open(address(shipped, "material/corduroy.html"))
    box = chromium.value("(() => { const at = document.querySelector('.stage').getBoundingClientRect(); return [at.left, at.top, at.width]; })()")
    chromium.ask("Input.dispatchMouseEvent", type="mouseMoved", x=box[0] + 5, y=box[1] + 5)
    chromium.until("document.querySelector('.felt').textContent !== ''")

    def resting_at(part):  # mm from the middle
        chromium.ask("Input.dispatchMouseEvent", type="mouseMoved", x=box[0] + part * box[2], y=box[1] + box[2] / 2)
        return chromium.value("""new Promise(done => setTimeout(() => done(parseFloat(
            document.querySelector('.felt').textContent.replace('\u2212', '-').match(/at ([-0-9.]+) mm/)[1])), 700))""")

    parts = [0.5 + 0.125 * i / 4 for i in range(4)]  # a period of 2.5 mm in a picture of 20 mm
    pulled = [abs(resting_at(part) - 20 * (part - 0.5)) for part in parts]
    chromium.value("document.querySelector('[data-act=pull]').click()")
    free = [abs(resting_at(part) - 20 * (part - 0.5)) for part in parts]
    assert max(pulled) > 0.3 and max(free) < 0.11


def test_a_phone_has_no_sideways_scrolling(chromium, shipped):
    chromium.screen(360, 740, phone=True)
    for page in some_pages(shipped):
        chromium.open(address(shipped, page))
        assert chromium.value("document.documentElement.scrollWidth") <= 360, page


def test_letters_are_readable_in_light_and_dark(chromium, shipped):
    """The contrast of text by WCAG 2.2: at least 4.5 to 1."""
    contrast = """(() => {
      const light = colour => { const [r, g, b] = colour.match(/[0-9.]+/g).map(each => each / 255).map(each =>
        each <= 0.04045 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
      const behind = at => { for (; at; at = at.parentElement) { const colour = getComputedStyle(at).backgroundColor;
        if (!/, 0\\)$/.test(colour)) return colour; } return 'rgb(255, 255, 255)'; };
      let least = 21, where = '';
      for (const at of document.querySelectorAll('main *, header *, footer *')) {
        if (![...at.childNodes].some(each => each.nodeType === 3 && each.data.trim()) || !at.checkVisibility()) continue;
        if (at.closest('svg, option')) continue;
        const [a, b] = [light(getComputedStyle(at).color), light(behind(at))].sort((x, y) => y - x);
        const ratio = (a + 0.05) / (b + 0.05);
        if (ratio < least) { least = ratio; where = at.tagName + ' ' + at.className + ' ' + at.textContent.slice(0, 30); }
      }
      return [least, where, getComputedStyle(document.body).backgroundColor];
    })()"""
    papers = set()
    for scheme in ("light", "dark"):
        chromium.scheme(scheme)
        for page in ("index.html", "material/corduroy.html", "material/slate.html", "percept/roughness.html"):
            chromium.open(address(shipped, page))
            least, where, paper = chromium.value(contrast)
            assert least >= 4.5, (scheme, page, least, where)
            papers.add((scheme, paper))
    assert len(papers) == 2 and len({paper for _, paper in papers}) == 2
