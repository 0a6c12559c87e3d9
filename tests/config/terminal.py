"""The program on a terminal of 80 columns, and how wide what it prints is there."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import unicodedata

COLUMNS = 80
# No command of the tests says nothing for so long, s.
PATIENCE = 300
# What a progress bar says last: the line is empty again.
CLEARED = "\r\x1b[2K"
ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


def on_a_terminal(words, folder, complaints=False):
    """Status of a program, and what it prints on a terminal of 80 columns; `complaints` puts its standard error there too."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, COLUMNS, 0, 0))
    process = subprocess.Popen(
        [str(word) for word in words],
        stdin=subprocess.DEVNULL,
        stdout=theirs,
        stderr=theirs if complaints else subprocess.DEVNULL,
        cwd=folder,
        env=dict(os.environ, COLUMNS=str(COLUMNS), TERM="xterm-256color"),
    )
    os.close(theirs)
    output = b""
    while True:
        ready, _, _ = select.select([ours], [], [], PATIENCE)
        assert ready, f"nothing for {PATIENCE} s: {words}"
        try:
            piece = os.read(ours, 65536)
        except OSError:
            break
        if not piece:
            break
        output += piece
    os.close(ours)
    return process.wait(), output.decode()


def lines_of(output):
    """Lines as they stand on the terminal: without what was cleared, and without what changes colours."""
    return [ESCAPE.sub("", line.removesuffix("\r").rpartition(CLEARED)[2]) for line in output.split("\n")]


def width(line):
    """Columns that a line takes: a wide character takes two, an accent of its own none."""
    taken = {"W": 2, "F": 2}
    return sum(0 if unicodedata.combining(one) else taken.get(unicodedata.east_asian_width(one), 1) for one in line)


def untidy(output, of_clap=False):
    """Lines that are too wide, or have a tab or blanks at their end; between the paragraphs of its help clap has lines of blanks."""
    lines = [line for line in lines_of(output) if not (of_clap and line.isspace())]
    return [line for line in lines if width(line) > COLUMNS or "\t" in line or line != line.rstrip()]
