"""The built-in DBC file of COM3 agrees with the published one, as PyPI's cantools reads both."""

import os
from pathlib import Path

import cantools
import pytest

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("EXCAVATOR_SHARED", ROOT.parent / "shared"))
FIELDS = ["name", "start", "length", "byte_order", "is_signed", "scale", "offset", "minimum", "maximum"]


def facts(path):
    database = cantools.database.load_file(path, strict=False)
    return {
        (message.name, message.frame_id, message.is_extended_frame, message.length): sorted(
            tuple(getattr(signal, field) for field in FIELDS) for signal in message.signals
        )
        for message in database.messages
    }


def test_the_built_in_file_has_the_facts_of_the_published_one():
    published = SHARED / "opera" / "excavator_com3.dbc"
    if not published.exists():
        pytest.skip(f"{published} does not exist (set EXCAVATOR_SHARED to the folder of shared files)")
    own = facts(ROOT / "bags/src/can/com3.dbc")
    assert own == facts(published) and len(own) == 22
