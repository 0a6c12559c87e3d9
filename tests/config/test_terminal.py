"""What people see on a terminal of 80 columns: no line is wider."""

import os
import pathlib
import pty
import select
import struct
import subprocess

import fcntl
import termios

import pytest

COLUMNS = 80
SAMPLES = pathlib.Path(__file__).resolve().parents[2] / "bags" / "samples" / "hidden-law"
BAG = f"{SAMPLES / 'validation'}"


def on_a_terminal(words, folder):
    """What a program prints on a terminal of 80 columns; it must succeed."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, COLUMNS, 0, 0))
    process = subprocess.Popen(words, stdout=theirs, stderr=subprocess.DEVNULL, stdin=theirs, cwd=folder)
    os.close(theirs)
    output = b""
    while True:
        ready, _, _ = select.select([ours], [], [], 120)
        assert ready, "nothing for two minutes"
        try:
            piece = os.read(ours, 65536)
        except OSError:
            break
        if not piece:
            break
        output += piece
    assert process.wait() == 0, output.decode()
    return output.decode()


@pytest.mark.parametrize(
    "words",
    [
        ["info", BAG],
        ["compare", "--model", "zx30u-arm", "--bag", BAG],
        ["compare", "--verbose", "--model", "zx30u-arm", "--bag", BAG],
        ["identify", "--verbose", "--model", "zx30u-arm", "--bag", BAG],
        ["energy", "--model", "zx30u-arm", "--bag", BAG],
        ["characterise", "--model", "zx30u-arm", BAG],
        ["diagnose", "--verbose", "--model", "zx30u-arm", "--identification", f"{BAG}@..10", "--validation", f"{BAG}@10.."],
        ["refine", "--add", "stribeck_friction@arm", "hose_loss@arm", "--model", "zx30u-arm", "--identification", f"{BAG}@..10",
         "--validation", f"{BAG}@10..", "-o", "refined.toml"],
        ["effects"],
        ["effects", "valve_dead_zone"],
        ["model", "check", "zx30u-arm"],
    ],
    ids=lambda words: " ".join(words[:2]),
)
def test_no_line_is_wider_than_the_terminal(excavator, tmp_path, words):
    output = on_a_terminal([excavator, *words], tmp_path)
    lines = [line.replace("\x1b[1m", "").replace("\x1b[0m", "") for line in output.replace("\r", "").split("\n")]
    # A path or a number cannot be broken.
    wide = [line for line in lines if len(line) > COLUMNS and " " in line.strip() and str(SAMPLES) not in line]
    assert not wide, "\n".join(wide)
    assert len(lines) > 3
