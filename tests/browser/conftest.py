"""The program, a browser, and every page of the program opened in it."""

import os
import shutil
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from browser import Browser  # noqa: E402
from pages import PAGES, READY, WIDE, prepare, write  # noqa: E402


@pytest.fixture(scope="session")
def excavator():
    """Path of the program; the test skips when it is not built."""
    given = os.environ.get("EXCAVATOR_BINARY")
    if given and not os.access(given, os.X_OK):
        raise pytest.UsageError(f"EXCAVATOR_BINARY={given} is no program")
    target = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parents[1] / "target"))
    built = [path for path in (target / "debug" / "excavator", target / "release" / "excavator") if path.is_file()]
    if not given and not built:
        pytest.skip(f"no excavator in {target}: run `cargo build -p excavator` or set EXCAVATOR_BINARY")
    return Path(given).resolve() if given else max(built, key=lambda path: path.stat().st_mtime)


@pytest.fixture(scope="session")
def chromium():
    """Path of the browser; the test skips where there is none."""
    names = [os.environ.get("CHROMIUM", ""), "chromium", "chromium-browser", "google-chrome"]
    found = next((path for name in names if name and (path := shutil.which(name))), None)
    if found is None:
        pytest.skip("no Chromium here: install it (Debian: apt-get install chromium) or set CHROMIUM to its path")
    return found


@pytest.fixture(scope="session")
def axe():
    """Source of axe-core; the test skips where there is none."""
    folder = os.environ.get("EXCAVATOR_AXE")
    if not folder:
        pytest.skip("EXCAVATOR_AXE does not say where axe-core is (npm install axe-core)")
    return (Path(folder) / "axe.min.js").read_text()


@pytest.fixture(scope="session")
def pictures():
    """Where pictures are kept, made where it is missing; None where nobody asked for them."""
    given = os.environ.get("EXCAVATOR_PICTURES")
    if not given:
        return None
    Path(given).mkdir(parents=True, exist_ok=True)
    return Path(given)


@pytest.fixture(scope="session")
def pages(excavator, tmp_path_factory):
    """The folder for all pages; each is written when a test opens it for the first time."""
    folder = tmp_path_factory.mktemp("pages")
    prepare(excavator, folder)
    return folder


@pytest.fixture(scope="session")
def browser(chromium, tmp_path_factory):
    """A browser for all pages. It notes text of canvases, so that tests can look at it."""
    with Browser(chromium, tmp_path_factory.mktemp("profile")) as opened:
        opened.before_every_page((HERE / "probe.js").read_text())
        yield opened


# The page that every check opens.
FIRST = "comparison"


@pytest.fixture(params=[pytest.param(name, marks=[] if name == FIRST else pytest.mark.full) for name in PAGES])
def page(request, excavator, pages, browser):
    """Name of a page that is open in a wide window; nothing may fail in it."""
    write(excavator, pages, request.param)
    browser.errors.clear()
    browser.screen(*WIDE)
    browser.open((pages / f"{request.param}.html").as_uri())
    browser.wait_for(READY, f"the page of {request.param}")
    yield request.param
    assert browser.errors == []
