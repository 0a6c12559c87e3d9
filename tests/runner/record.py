"""The last full run, as a file of the repository: which commit passed, when, how fast and with how many tests."""

import datetime
import os
import platform
import subprocess

from durations import in_words, minutes
from run import ROOT
from tier import Tier

FILE = ROOT / "tests" / "last-full-run.txt"


def write(run, tier, seconds):
    """Writes the file anew."""
    commit = _git("rev-parse", "--short=12", "HEAD")
    changed = " with changes that are not committed" if _git("status", "--porcelain") else ""
    rows = [
        f"command   tests/run --{'long' if tier == Tier.LONG else 'all'}",
        f"commit    {commit}{changed}",
        f"date      {datetime.datetime.now(datetime.UTC):%Y-%m-%d %H:%M} UTC",
        f"duration  {minutes(seconds)}",
        f"machine   {machine()}",
        *(f"passed    {kind}: {in_words(counts)}" for kind, counts in run.durations.counts.items()),
    ]
    FILE.write_text("\n".join(rows) + "\n")


def machine():
    """Processors, memory and system of this machine, in words."""
    pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return f"{os.cpu_count()} processors, {pages / 2**30:.0f} GiB of memory, {platform.system()} on {platform.machine()}"


def _git(*words):
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip()
