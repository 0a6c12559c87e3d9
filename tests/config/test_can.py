"""The example of a CAN bus, and the vectors that the decoder is tested with, are what PyPI's cantools says they are."""

import json
import runpy
import tomllib
from pathlib import Path

import pytest

cantools = pytest.importorskip("cantools", reason="PyPI's cantools is not installed")

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLE = REPOSITORY / "config" / "can"
VECTORS = REPOSITORY / "bags" / "tests" / "can"


def test_the_vectors_are_what_cantools_reads():
    made = runpy.run_path(str(VECTORS / "vectors.py"))["make"]()
    assert json.loads((VECTORS / "vectors.json").read_text()) == made


def test_the_example_names_signals_of_its_database():
    database = cantools.database.load_file(EXAMPLE / "excavator.dbc", strict=True)
    (can,) = tomllib.loads((EXAMPLE / "arm.toml").read_text())["can"]
    for signal in can["signals"]:
        database.get_message_by_name(signal["message"]).get_signal_by_name(signal["name"])
    assert len({signal["signal"] for signal in can["signals"]}) == len(can["signals"]) == 9
