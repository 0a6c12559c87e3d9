"""Makes the helpers of this folder and of the docs importable, wherever pytest was started, and names the program."""

import os
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "docs")]


@pytest.fixture
def excavator():
    """The program, as `tests/run` builds it."""
    binary = os.environ.get("EXCAVATOR_BINARY")
    if not binary:
        pytest.skip("EXCAVATOR_BINARY does not say where the program is")
    return binary
