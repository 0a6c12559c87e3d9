"""The commands of the docs: every one of them parses, and those of the first pages run, in order, in an empty folder."""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
SAMPLES = REPOSITORY / "bags" / "samples"
HIDDEN_LAW = SAMPLES / "hidden-law"
COMMAND = re.compile(r"^    (?:\$ )?(excavator .*)$")

# What stands for a file of the reader, by what the test puts in its place.
PLACEHOLDERS = {
    "M": "zx30u-arm",
    "BAG": HIDDEN_LAW / "validation",
    "BAG-A": HIDDEN_LAW / "identification",
    "BAG-B": HIDDEN_LAW / "validation",
    "my-bag": SAMPLES / "arm-swing",
    "bag-a": HIDDEN_LAW / "identification",
    "bag-b": HIDDEN_LAW / "validation",
    "TABLE.csv": "drive.csv",
    "BAG@20..40": f"{HIDDEN_LAW / 'validation'}@2..8",
    "OTHER": "zx30u-arm",
    "$REPO": REPOSITORY,
}
# Verbs whose screen ends with the command that comes next.
LEADS_ON = {"demo", "info", "compare", "diagnose", "identify", "energy", "refine"}
# Pages whose offline commands run. A command with live nodes is for tests/rclpy.
RUN = ["start.md", "your-data.md", "verdict.md", "laws.md"]
LIVE = {"node", "play", "record", "up", "dashboard"}
# Searches take minutes on whole recordings; EXCAVATOR_LONG=1 runs them as printed.
SEARCHES = {"diagnose", "propose"}
LONG = bool(os.environ.get("EXCAVATOR_LONG"))


def commands(page):
    """The words of each command of a page, continued lines joined; what is optional in it is left out."""
    lines = page.read_text().splitlines()
    found = []
    for number, line in enumerate(lines):
        match = COMMAND.match(line)
        if not match:
            continue
        text = match.group(1)
        while text.endswith("\\"):
            number += 1
            text = text[:-1] + lines[number]
        text = re.sub(r"\[-.*?\]", "", text)
        text = re.sub(r"\s>\s.*$", "", text) if ' "' not in text else text
        words = [word for word in shlex.split(text, comments=True) if word != "&"]
        found.append(words)
    return found


# The page of the verbs has usages, and is compared with the program elsewhere.
ALL = [(page, words) for page in sorted(DOCS.glob("*.md")) if page.name != "verbs.md" for words in commands(page)]


def test_there_are_commands():
    assert len(ALL) > 40


@pytest.mark.parametrize(("page", "words"), ALL, ids=[f"{page.name}: {' '.join(words[1:4])}" for page, words in ALL])
def test_every_command_parses(excavator, page, words):
    words = words[1 : words.index("--ros-args")] if "--ros-args" in words else words[1:]
    result = subprocess.run([excavator, *words, "--help"], capture_output=True, text=True)
    assert result.returncode == 0, f"{page}: {' '.join(words)}\n{result.stderr}"


@pytest.mark.parametrize("name", RUN)
def test_the_commands_of_a_page_run(excavator, tmp_path, name):
    shutil.copy(SAMPLES / "arm-swing.csv", tmp_path / "drive.csv")
    (tmp_path / "bags").symlink_to(REPOSITORY / "bags")
    own = [words for words in commands(DOCS / name) if words[1] not in LIVE]
    assert own
    for words in own:
        words = [str(PLACEHOLDERS.get(word, word)) for word in words[1:]]
        run(excavator, words if LONG else in_part(words), tmp_path)


def test_the_commands_of_the_readme_run_in_an_empty_folder(excavator, tmp_path):
    lines = re.findall(r"^    cargo run --release -- (\S.*?)(?:\s+#.*)?$", (REPOSITORY / "README.md").read_text(), re.MULTILINE)
    assert lines
    for line in lines:
        run(excavator, shlex.split(line), tmp_path)


def in_part(words):
    """A search through some seconds of recordings instead of all."""
    if words[0] not in SEARCHES:
        return words
    parts = {"identification": "@..8", "validation": "@..5"}
    return [word + next((part for end, part in parts.items() if word.endswith(f"hidden-law/{end}")), "") for word in words]


def run(excavator, words, folder):
    """Runs a command, which must succeed and, where its verb promises that, end with the next one."""
    result = subprocess.run([excavator, *words], cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, f"{' '.join(words)}\n{result.stdout}\n{result.stderr}"
    # With JSON on standard output there is no screen.
    if words[0] in LEADS_ON and "-" not in words:
        _, _, last = result.stdout.rpartition("\nNext, ")
        why, *command = last.rstrip().splitlines()
        told = why.endswith(":") and command and command[0].startswith("  excavator ")
        assert told and all(line.startswith("  ") for line in command), f"{' '.join(words)} ends with\n{last}"
