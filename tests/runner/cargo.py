"""The tests of Rust: built once by cargo, then run as programs, so that each test's duration is known.

A stable toolchain reports the durations of tests only to those who ask for it by RUSTC_BOOTSTRAP. Set for the test programs and not for
cargo, it changes nothing that is built.
"""

import json
import os
import re
import subprocess
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

RESULT = re.compile(r"^test (\S+)(?: - should panic)? \.\.\. (ok|FAILED|ignored)\b.*?(?: <([\d.]+)s>)?$", re.MULTILINE)
# Two programs at once keep both cores busy while the last tests of one of them run.
AT_ONCE = 2


@dataclass(frozen=True)
class TestProgram:
    """A program of tests: the crate that it belongs to, its file, and the folder in which cargo would run it."""

    crate: str
    target: str
    file: str
    folder: str


def build(root, crates, run):
    """Builds all test programs and the programs that they start; `run` runs a command and raises if it fails."""
    command = ["cargo", "test", *crates, "--lib", "--bins", "--tests", "--no-run", "--message-format=json-render-diagnostics"]
    found = []
    for line in run(command, root).splitlines():
        message = json.loads(line) if line.startswith("{") else {}
        if message.get("reason") == "compiler-artifact" and message["profile"]["test"] and message.get("executable"):
            folder = Path(message["manifest_path"]).parent
            target = message["target"]
            found.append(TestProgram(crate_name(folder), target["name"], message["executable"], str(folder)))
    return found


def crate_name(folder):
    """Name of the package whose Cargo.toml is in the folder."""
    return re.search(r'^name = "(.*)"$', (folder / "Cargo.toml").read_text(), re.MULTILINE).group(1)


def run_all(programs, words):
    """Runs test programs, two at a time; yields what `run_one` returns, in the order of their ends."""
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for ended in as_completed([pool.submit(run_one, program, words) for program in programs]):
            yield ended.result()


def run_one(program, words):
    """Runs one test program with further words for it; returns (program, exit status, output, timed tests, counts)."""
    command = [program.file, "-Zunstable-options", "--report-time", *words]
    variables = os.environ | {"RUSTC_BOOTSTRAP": "1", "CARGO_MANIFEST_DIR": program.folder}
    done = subprocess.run(
        command, cwd=program.folder, env=variables, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, errors="replace",
    )  # fmt: skip
    timed, counts = read(program, done.stdout)
    return program, done.returncode, done.stdout, timed, counts


def read(program, output):
    """Timed tests and counts from what a test program printed."""
    timed, counts = [], Counter()
    for name, outcome, seconds in RESULT.findall(output):
        counts[{"ok": "passed", "FAILED": "failed", "ignored": "skipped"}[outcome]] += 1
        if seconds:
            timed.append((f"{program.crate} {name}", float(seconds)))
    return timed, counts
