"""What the tests of the package share."""

from collections.abc import Iterator

import pytest
import wale
from wale._abi import lib


@pytest.fixture(scope="session")
def library() -> wale.Library:
    return wale.Library()


@pytest.fixture(scope="session")
def corduroy(library: wale.Library) -> wale.Program:
    return library.find("corduroy")


@pytest.fixture
def device() -> wale.Device:
    """A joystick in a hand that rubs to and fro over 20 mm, once a second."""
    return wale.open_device("simulated:sandpaper", hand=wale.Hand(0.5, 10, 500), motion=wale.Motion.lateral(0.02, 1))


@pytest.fixture
def stage(device: wale.Device) -> Iterator[wale.Stage]:
    with wale.Stage(device) as stage:
        yield stage


@pytest.fixture(autouse=True)
def nothing_leaks(library: wale.Library, corduroy: wale.Program) -> Iterator[None]:
    """Each test closes what it opened, or drops it."""
    before = lib.wale_handles()
    yield
    import gc

    gc.collect()
    assert lib.wale_handles() - before <= 2  # fixtures of this test may end after this one
