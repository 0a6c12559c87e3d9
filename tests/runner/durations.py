"""What a run took: each step, each test of two seconds or more, and how many tests passed."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

# s; shorter tests are counted only.
SHORTEST_LISTED = 2.0
MOST_SHOWN = 10


@dataclass
class Durations:
    """Rows of (name, seconds, kind), where kind is "step" or "test", and counts of tests by kind and outcome."""

    rows: list = field(default_factory=list)
    counts: dict = field(default_factory=dict)

    def add_step(self, name, seconds):
        self.rows.append((name, seconds, "step"))

    def add_tests(self, kind, timed, counts):
        """`timed`: (name, seconds) of tests; `counts`: how many passed, failed, were skipped."""
        self.rows += [(name, seconds, "test") for name, seconds in timed if seconds >= SHORTEST_LISTED]
        self.counts.setdefault(kind, Counter()).update(counts)

    def total_counts(self):
        return sum(self.counts.values(), Counter())

    def longest(self, most=MOST_SHOWN):
        return sorted(self.rows, key=lambda row: -row[1])[:most]

    def write(self, path, total):
        """A table with tabs: name, seconds, kind; the longest first, below the total."""
        path = Path(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        rows = [("total", total, "total"), *self.longest(None)]
        lines = ["name\tseconds\tkind", *(f"{name}\t{seconds:.1f}\t{kind}" for name, seconds, kind in rows)]
        path.write_text("\n".join(lines) + "\n")


def minutes(seconds):
    """For people: "3 min 05 s"."""
    return f"{seconds:.0f} s" if seconds < 60 else f"{int(seconds) // 60} min {int(seconds) % 60:02d} s"


def in_words(counts):
    """For people: "967 passed, 2 failed, 3 skipped"."""
    said = [f"{counts['passed']} passed"]
    return ", ".join(said + [f"{counts[word]} {word}" for word in ("failed", "skipped") if counts[word]])
