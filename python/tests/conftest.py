"""Fixtures: the samples, and the program as reference. Makes the helpers of the docs importable."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "docs"))
SAMPLES = REPOSITORY / "bags" / "samples"
HAS_RAY = importlib.util.find_spec("ray") is not None
collect_ignore = [] if HAS_RAY else ["fleet"]


def pytest_report_header():
    """Says what is left out before anything runs."""
    return None if HAS_RAY else "fleets: not tested, Ray is not installed (python/tests/requirements-full.txt)"


@pytest.fixture
def samples():
    """Folder with the samples of the repository."""
    return SAMPLES


@pytest.fixture
def program(tmp_path):
    """Function that runs a verb of the program and returns its JSON."""
    binary = os.environ.get("EXCAVATOR_BINARY")
    if not binary:
        pytest.skip("EXCAVATOR_BINARY is not set: results are not compared with those of the program")

    def run(*words, status=0, as_text=False):
        target = tmp_path / "result.json"
        done = subprocess.run([binary, *map(str, words), "--json", target, "--force"], capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        text = target.read_text()
        return text if as_text else json.loads(text)

    return run
