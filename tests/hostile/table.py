"""The table of faults in docs/faults.md, made of the rows that the tests have written.

    python3 tests/hostile/table.py [--check] [ROWS]

Without --check the page is written anew. With --check it is compared: every fault that was tried must be on the page with its
outcome; what was measured may differ from run to run. Faults that only the long tests try stay on the page.
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "faults.md"
GROUPS = ["Commands", "Network", "Remote goals", "Files", "Recorder", "Pages and bridges"]
INTRODUCTION = """# Faults that the tests try

After reading this page, you know how the program reacts to misuse, broken programs and attacks. Each row is a test in `tests/hostile` or
`tests/rclpy`. The first column states the action of a careless user, a broken program or a stranger. The last column gives the figures of
one run on a machine with two cores. Some faults are tried by the long tests only (`tests/run --long`).

`tests/run --all` collects the rows and checks that this page has all of them. `python3 tests/hostile/table.py` rewrites the page.
"""


def rows_in(folder):
    rows = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    return sorted(rows, key=lambda row: (GROUPS.index(row["group"]), row["tried"]))


def line(row, measured=True):
    figures = "; ".join(f"{name} {value}" for name, value in row["measured"]) if measured else ""
    return f"| {row['tried']} | {row['outcome']} | {figures} |"


def page(rows):
    parts = [INTRODUCTION]
    for group in GROUPS:
        lines = [line(row) for row in rows if row["group"] == group]
        if lines:
            parts.append("\n".join([f"## {group}", "", "| tried | what happens | measured |", "|---|---|---|", *lines, ""]))
    return "\n".join(parts)


def missing(rows, text):
    return [row for row in rows if line(row, measured=False).removesuffix("|").rstrip(" |") not in text]


def main(arguments):
    check = "--check" in arguments
    folders = [argument for argument in arguments if argument != "--check"]
    rows = rows_in(Path(folders[0]) if folders else ROOT / "target" / "faults")
    if not rows:
        return "no rows: run the tests first (cargo test -p excavator --test it hostile::)"
    if not check:
        PAGE.write_text(page(rows))
        return None
    absent = missing(rows, PAGE.read_text())
    if absent:
        return "docs/faults.md does not have:\n" + "\n".join(line(row) for row in absent)
    return None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
