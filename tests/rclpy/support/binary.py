"""Where the program under test is."""

import os
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]


def binary_or_reason():
    """(path, None), or (None, why there is none). A wrong EXCAVATOR_BINARY is an error: who sets it wants no skips."""
    given = os.environ.get("EXCAVATOR_BINARY")
    if given:
        if os.access(given, os.X_OK):
            return Path(given).resolve(), None
        raise pytest.UsageError(f"EXCAVATOR_BINARY={given} is no program")
    target = Path(os.environ.get("CARGO_TARGET_DIR", REPOSITORY / "target"))
    built = [path for path in (target / "debug" / "excavator", target / "release" / "excavator") if path.is_file()]
    if not built:
        return None, f"no excavator in {target}: run `cargo build -p excavator` or set EXCAVATOR_BINARY"
    # of two builds the newer one is meant
    return max(built, key=lambda path: path.stat().st_mtime), None
