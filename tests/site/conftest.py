import os
import pathlib
import subprocess

import pytest

WALE = os.environ["WALE_BINARY"]
SOURCE = pathlib.Path(os.environ["WALE_SOURCE_DIR"])


def wale(*words, status=0):
    """Runs wale in the source folder; its standard output."""
    run = subprocess.run([WALE, *map(str, words)], capture_output=True, text=True, cwd=SOURCE)
    assert run.returncode == status, run.stderr
    return run.stdout


@pytest.fixture(scope="session")
def shipped(tmp_path_factory):
    """The site of a part of the shipped library: a file of each kind of surface, and one with many materials."""
    folder = tmp_path_factory.mktemp("site") / "shipped"
    wale("library", "site", "library/fabric", "library/stone", "library/mechanism", "library/fluid", "-o", folder)
    return folder


def pages(folder):
    return sorted(folder.rglob("*.html"))
