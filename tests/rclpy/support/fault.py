"""Rows of docs/faults.md, written at the end of a test; the Rust tests in tests/hostile write the same."""

import json
import os
import re
from pathlib import Path

_ROWS = Path(__file__).resolve().parents[3] / "target" / "faults"


def survived(group, tried, outcome, **measured):
    """Writes a row. `measured`: what was measured, with its unit at the end of the name, `closed_after_ms=12.3`."""
    folder = Path(os.environ.get("EXCAVATOR_FAULTS", _ROWS))
    folder.mkdir(parents=True, exist_ok=True)
    figures = [[re.sub(r" ms$", " [ms]", name.replace("_", " ")), f"{value:.3g}"] for name, value in measured.items()]
    row = {"group": group, "tried": tried, "outcome": outcome, "measured": figures}
    name = re.sub(r"[^A-Za-z0-9]", "-", tried)[:80]
    (folder / f"{name}.json").write_text(json.dumps(row, indent=2))
