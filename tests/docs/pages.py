"""A page of the docs as a reader follows it: files to save, commands to type, and what they print."""

import re
import shlex
from dataclasses import dataclass, field
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"

INDENT = "    "
PROMPT = "$ "
# First words that make an indented line without a prompt a command.
PROGRAMS = {"excavator", "cp", "mkdir"}
# Verbs that join the network.
LIVE = {"node", "play", "record", "up", "dashboard"}
FENCE = "```"
# What a usage shows as optional.
OPTIONAL = re.compile(r"\[-.*?\]")
# The sentence before a block that the reader saves.
FILE = re.compile(r"(?:Save this as|Change) `([^`]+)`(?: to)?[^`]*:$")


@dataclass
class Save:
    """A block that the reader saves as a file."""

    name: str
    text: str


@dataclass
class Command:
    """A command as it is printed, continued lines joined and without what is optional, and the lines that the page prints below it."""

    text: str
    shown: list = field(default_factory=list)

    @property
    def words(self):
        """Its words, without a comment."""
        return shlex.split(self.text, comments=True)


def steps(page):
    """The steps of a page, in order. `page` is a path."""
    lines = page.read_text().splitlines()
    found, save, last, number = [], None, None, 0
    while number < len(lines):
        line = lines[number]
        number += 1
        if line.startswith(FENCE):
            end = lines.index(FENCE, number)
            if save:
                found.append(Save(save, "\n".join(lines[number:end]) + "\n"))
            number, save, last = end + 1, None, None
        elif line.startswith(INDENT):
            text = line.removeprefix(INDENT)
            if text.startswith(PROMPT) or text.split()[0] in PROGRAMS:
                text = text.removeprefix(PROMPT)
                while text.endswith("\\"):
                    text = text[:-1] + lines[number]
                    number += 1
                last = Command(OPTIONAL.sub("", text))
                found.append(last)
            elif last:
                last.shown.append(text)
        elif line.strip():
            save, last = (match.group(1) if (match := FILE.search(line)) else None), None
    return found


def blocks(page, language):
    """The fenced blocks of a language, in order."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)


def commands(page):
    """The commands of a page, in order."""
    return [step for step in steps(page) if isinstance(step, Command)]


def all_commands():
    """The commands of every page by its name. The page of the verbs has usages, and is compared with the program elsewhere."""
    return {page.name: commands(page) for page in sorted(DOCS.glob("*.md")) if page.name != "verbs.md"}


def runs(command, verbs):
    """Whether the command starts the program with one of these verbs."""
    words = command.words
    return "excavator" in words and words[words.index("excavator") + 1] in verbs


def starts_nodes(command):
    return runs(command, LIVE)


def missing_from(output, shown):
    """The shown lines that the output lacks; "..." stands for what the page leaves out. Words count and not where lines are broken,
    because that depends on the terminal."""
    printed = tokens(output)
    return [line for line in shown if not all(is_part(tokens(piece), printed) for piece in line.split("..."))]


def tokens(text):
    """The words and numbers of a text, without the rules of tables."""
    return re.sub(r"[│┆┌┐└┘├┤─═╞╡╪┬┴┼]", " ", text).split()


def is_part(wanted, words):
    """Whether the words follow each other somewhere."""
    starts = range(len(words) - len(wanted) + 1)
    return any(all(map(is_same, wanted, words[start:])) for start in starts)


def is_same(one, other):
    """Whether two words say the same. Numbers may differ by 1 %, because another processor rounds differently."""
    first, second = number(one), number(other)
    if first is None or second is None:
        return one == other
    return abs(first - second) <= 0.01 * max(abs(first), abs(second))


def number(word):
    """The value of a word that is a number, or `None`."""
    try:
        return float(word.strip("().,;:"))
    except ValueError:
        return None
