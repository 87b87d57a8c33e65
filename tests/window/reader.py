"""One session by a screen reader alone: through AT-SPI a script finds two materials, places them, changes a slider, hears
what is touched, mends a warning and saves; no mouse, no pixel. Run by tests/window/read_aloud; the window's process is named
by the arguments: PROGRAM FILE."""

import os
import subprocess
import sys
import time

import pyatspi

PROGRAM, FILE = sys.argv[1:3]
PATIENCE = 60.0


def wait_for(what, find):
    """The first true answer of `find`, asked again and again."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            found = find()
        except Exception:  # an object that has gone meanwhile
            found = None
        if found:
            return found
        time.sleep(0.1)
    raise SystemExit(f"a screen reader does not find {what}")


def objects(root):
    """All objects below one, without the long lists' items."""
    yield root
    for i in range(min(root.childCount, 60)):
        child = root.getChildAtIndex(i)
        if child is not None:
            yield from objects(child)


def named(root, name, role=None):
    return next((each for each in objects(root)
                 if each.name == name and (role is None or each.getRoleName() == role)), None)


def act(thing, wanted):
    actions = thing.queryAction()
    names = [actions.getName(i) for i in range(actions.nActions)]
    matching = [i for i, name in enumerate(names) if name.lower() == wanted.lower()]
    assert matching, f"{thing.name} can do {names}, not {wanted}"
    actions.doAction(matching[0])


def main():
    window = subprocess.Popen([PROGRAM, FILE, "--device", "simulated:sandpaper"])
    try:
        desktop = pyatspi.Registry.getDesktop(0)
        application = wait_for("the window", lambda: next(
            (each for each in desktop if each is not None and each.name == "sandpaper" and each.childCount), None))
        frame = wait_for("its frame", lambda: application.getChildAtIndex(0))
        search = wait_for("the search field", lambda: named(frame, "Search the library", "text"))
        materials = wait_for("the list of materials", lambda: named(frame, "Materials of the library", "list"))
        place = wait_for("the button that places", lambda: named(frame, "Place on the workspace", "push button"))
        canvas = wait_for("the workspace", lambda: named(frame, "Workspace", "list"))

        # Two materials are found by their names and placed.
        for count, word in enumerate(("corduroy", "needlecord"), 1):
            search.queryEditableText().setTextContents(word)
            wait_for(word, lambda: materials.childCount and materials.getChildAtIndex(0).name
                     and word[-4:] in materials.getChildAtIndex(0).name.lower()
                     and materials.getChildAtIndex(0).getState().contains(pyatspi.STATE_SELECTED))
            act(place, "Press")
            wait_for("the new patch", lambda: canvas.childCount == count)
        assert [canvas.getChildAtIndex(i).name for i in range(2)] == ["corduroy", "needlecord"], \
            [canvas.getChildAtIndex(i).name for i in range(2)]

        # The first one goes to the left, out of the other's way, and its slider is changed.
        first = canvas.getChildAtIndex(0)
        act(first, "Press")
        for _ in range(25):
            act(first, "move left")
        assert "at -25.0, 0.0 mm" in first.description, first.description
        slider = wait_for("its slider", lambda: named(frame, "roughness", "slider"))
        before = slider.queryValue().currentValue
        slider.queryValue().currentValue = 900
        wait_for("the changed slider", lambda: slider.queryValue().currentValue != before)
        wait_for("the changed material", lambda: "roughness: 0.9" in canvas.getChildAtIndex(0).description)

        # The hand of the device rubs over the middle: what it touches is heard.
        act(wait_for("the button for the force", lambda: named(frame, "Feel it", "push button")), "Press")
        wait_for("what is touched", lambda: "the hand is on" in canvas.description)
        act(wait_for("the button that ends the force", lambda: named(frame, "Take all force away", "push button")), "Press")
        wait_for("the end of the force", lambda: named(frame, "Feel it", "push button"))

        # A warning is heard, and mended where it says how: the first patch is taken out of reach and fitted again.
        for _ in range(110):
            act(first, "move left")
        problems = wait_for("the list of problems", lambda: named(frame, "Problems in the text", "list"))
        wait_for("the warning", lambda: any("beyond the reach" in each.name for each in problems))
        act(named(frame, "Fit into the device's reach", "menu item") or
            wait_for("the menu", lambda: named(application, "Fit into the device's reach", "menu item")), "Press")
        wait_for("the mended warning", lambda: not any("beyond the reach" in each.name for each in problems))

        act(wait_for("the menu item", lambda: named(application, "Save", "menu item")), "Press")
        wait_for("the saved file", lambda: os.path.getsize(FILE) > 0 and "needlecord" in open(FILE).read())
        text = open(FILE).read()
        assert "roughness: 0.9" in text, text
        assert window.poll() is None, "the window ended"
        print("a screen reader alone: placed, changed, heard, mended and saved")
    finally:
        window.kill()


main()
