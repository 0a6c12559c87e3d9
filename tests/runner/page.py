"""The table of durations in CONTRIBUTING.md, made of the last run.

    python3 tests/runner/page.py
"""

from pathlib import Path

from durations import minutes
from record import machine
from run import ROOT

PAGE = ROOT / "CONTRIBUTING.md"
BEGIN, END = "<!-- durations: python3 tests/runner/page.py -->\n", "<!-- end of durations -->\n"
MOST = 15


def rows(path):
    """(name, seconds, kind) of each line below the heading."""
    lines = Path(path).read_text().splitlines()[1:]
    return [(name, float(seconds), kind) for name, seconds, kind in (line.split("\t") for line in lines)]


def table(found):
    """The total, the longest steps and the longest tests, in Markdown."""
    total = next(seconds for _, seconds, kind in found if kind == "total")
    lines = [f"The last measured run took {minutes(total)} on {machine()}. Steps run beside each other where they wait.", ""]
    lines += ["| longest steps and tests | kind | duration |", "|---|---|---|"]
    listed = [row for row in found if row[2] != "total"][:MOST]
    lines += [f"| {name.replace('|', ' ')} | {kind} | {minutes(seconds)} |" for name, seconds, kind in listed]
    return "\n".join(lines) + "\n"


def main():
    text = PAGE.read_text()
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    PAGE.write_text(before + BEGIN + table(rows(ROOT / "target" / "durations.tsv")) + END + after)


if __name__ == "__main__":
    main()
