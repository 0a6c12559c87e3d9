"""The docs, followed by a reader: every command runs, in the order of its page, in an empty folder, and prints what the page says.
Commands that start nodes are followed in tests/rclpy."""

import os
import re
import shlex
import shutil
import subprocess
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path

import pytest
from pages import DOCS, REPOSITORY, Save, all_commands, missing_from, runs, starts_nodes, steps
from recipes import position_test, valve_test

SAMPLES = REPOSITORY / "bags" / "samples"
HIDDEN_LAW = SAMPLES / "hidden-law"
BENCH = REPOSITORY / "tests" / "blind" / "bench" / "cases" / "01"
# Measurements that the repository does not have.
MEASURED = Path(os.environ.get("EXCAVATOR_SHARED", REPOSITORY.parent / "shared")) / "realdata"

# Verbs whose screen ends with the command that comes next.
LEADS_ON = {"demo", "info", "compare", "diagnose", "identify", "energy", "refine"}
# Searches take minutes on whole recordings; EXCAVATOR_LONG=1 runs them as printed, and follows every page.
SEARCHES = {"diagnose", "propose"}
LONG = bool(os.environ.get("EXCAVATOR_LONG"))
# The law is proposed from these parts, as it is from the whole.
PARTS = {"hidden-law/identification": "@..8", "hidden-law/validation": "@..5"}


@dataclass
class Reader:
    """What the reader of a page has before the first command."""

    # Files of the folder by their names: where each comes from, or a function that gives its text.
    files: dict = field(default_factory=dict)
    # Words of the page that stand for something of the reader.
    means: dict = field(default_factory=dict)


PAGES = {
    "start.md": Reader(
        means={"my-bag": SAMPLES / "arm-swing", "bag-a": HIDDEN_LAW / "identification", "bag-b": HIDDEN_LAW / "validation"}
    ),
    "your-data.md": Reader(
        files={"drive.csv": SAMPLES / "arm-swing.csv"},
        means={
            "M": "zx30u-arm",
            "OTHER": "zx30u-arm",
            "TABLE.csv": "drive.csv",
            "BAG": HIDDEN_LAW / "validation",
            "BAG-B": HIDDEN_LAW / "identification",
            "BAG@20..40": f"{HIDDEN_LAW / 'validation'}@2..8",
        },
    ),
    "verdict.md": Reader(means={"M": "zx30u-arm", "BAG-A": HIDDEN_LAW / "identification", "BAG-B": HIDDEN_LAW / "validation"}),
    "laws.md": Reader(),
    "energy.md": Reader(means={"M": "zx30u-arm", "BAG": HIDDEN_LAW / "validation"}),
    "design.md": Reader(
        means={
            "M": "zx30u-arm",
            "BAG": HIDDEN_LAW / "validation",
            "RUN1": HIDDEN_LAW / "identification",
            "RUN2": HIDDEN_LAW / "validation",
        }
    ),
    "own-machine.md": Reader(
        files={
            "bench.csv": BENCH / "identification.csv",
            "other-day.csv": BENCH / "validation.csv",
            "valve-test.csv": valve_test,
            "test1.csv": position_test,
            "test2.csv": position_test,
        }
    ),
    "tutorial.md": Reader(),
    "own-physics.md": Reader(),
    "install.md": Reader(),
    "measured-crane.md": Reader(files={"actuator.mat": MEASURED / "sjoberg_hydraulic_actuator" / "actuator.mat"}),
    "measured-drive.md": Reader(
        files={name: MEASURED / "emps" / name for name in ("DATA_EMPS.mat", "DATA_EMPS_PULSES.mat")},
    ),
}
# Their searches take a minute or two, and other pages have the same verbs.
LONG_PAGES = {"design.md", "verdict.md", "measured-crane.md", "measured-drive.md"}
# Its offline command reads what its nodes have recorded.
ON_THE_NETWORK = {"ros2.md"}
ALL = all_commands()


def test_every_page_with_commands_is_followed():
    offline = {name for name, found in ALL.items() if any(not starts_nodes(command) for command in found)}
    assert offline == set(PAGES) | ON_THE_NETWORK
    assert sum(len(found) for found in ALL.values()) > 50


NODES = [(page, command) for page, found in ALL.items() for command in found if starts_nodes(command)]


@pytest.mark.parametrize(("page", "command"), NODES, ids=[f"{page}: {command.text[:40]}" for page, command in NODES])
def test_a_command_that_starts_nodes_parses(excavator, page, command):
    words = list(takewhile(lambda word: word not in ("--ros-args", "&"), command.words[1:]))
    result = subprocess.run([excavator, *words, "--help"], capture_output=True, text=True)
    assert result.returncode == 0, f"{page}: {command.text}\n{result.stderr}"


@pytest.mark.full
@pytest.mark.parametrize("name", PAGES)
def test_a_page_can_be_followed(run, tmp_path, name):
    if name in LONG_PAGES and not LONG:
        pytest.skip(f"{name} is followed in long runs")
    reader = PAGES[name]
    for file, source in reader.files.items():
        if callable(source):
            (tmp_path / file).write_text(source())
            continue
        if not source.exists():
            pytest.skip(f"{name}: no measurement {source.name} here")
        shutil.copy(source, tmp_path / file)
    (tmp_path / "bags").symlink_to(REPOSITORY / "bags")
    wrong = []
    for step in steps(DOCS / name):
        if isinstance(step, Save):
            (tmp_path / step.name).write_text(step.text)
        elif not starts_nodes(step):
            wrong += follow(run, step, reader)
    assert not wrong, "\n".join(wrong)


@pytest.mark.full
def test_the_commands_of_the_readme_run_in_an_empty_folder(run):
    lines = re.findall(r"^    cargo run --release -- (\S.*?)(?:\s+#.*)?$", (REPOSITORY / "README.md").read_text(), re.MULTILINE)
    assert lines
    for line in lines:
        run(f"excavator {line}")


@pytest.fixture
def run(excavator, tmp_path):
    """Runs a line of shell in the folder of the test: the program is on the path, and the home is new."""
    programs, home = tmp_path / "programs", tmp_path / "home"
    programs.mkdir()
    home.mkdir()
    (programs / "excavator").symlink_to(Path(excavator).resolve())
    environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "REPO": str(REPOSITORY), "HOME": str(home)}

    def run(text):
        shell = ["bash", "-e", "-u", "-o", "pipefail", "-c", text]
        result = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True, env=environment)
        assert result.returncode == 0, f"{text}\n{result.stdout}\n{result.stderr}"
        leads_on(text, result.stdout)
        return result.stdout + result.stderr

    return run


def follow(run, command, reader):
    """Runs a command of a page, and returns what the page shows and the command did not print."""
    text = command.text
    for word, thing in reader.means.items():
        text = re.sub(rf"(?<!\S){re.escape(word)}(?!\S)", str(thing), text)
    whole = text
    if runs(command, SEARCHES) and not LONG:
        for end, part in PARTS.items():
            text = re.sub(rf"(?<={re.escape(end)})(?!\S)", part, text)
    # The page shows what whole recordings give: a part has other numbers, and can have another sentence.
    shown = command.shown if text == whole else []
    return [f"{command.text}\ndid not print: {line}" for line in missing_from(run(text), shown)]


def leads_on(text, screen):
    """A verb that promises it ends its screen with the command that comes next; with JSON on standard output there is none."""
    words = shlex.split(text, comments=True)
    if words[0] != "excavator" or words[1] not in LEADS_ON or "-" in words:
        return
    _, _, last = screen.rpartition("\nNext, ")
    why, *following = last.rstrip().splitlines()
    told = why.endswith(":") and following and following[0].startswith("  excavator ")
    assert told and all(line.startswith("  ") for line in following), f"{text} ends with\n{last}"
