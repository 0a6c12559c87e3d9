"""Makes the helpers of this folder importable, wherever pytest was started, and names the program."""

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))


@pytest.fixture
def excavator():
    """The program, as `tests/run` builds it."""
    binary = os.environ.get("EXCAVATOR_BINARY")
    if not binary:
        pytest.skip("EXCAVATOR_BINARY does not say where the program is")
    return binary
