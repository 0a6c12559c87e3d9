"""Fixtures of the test of the dashboard in a real browser."""

import os
import shutil
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))


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
