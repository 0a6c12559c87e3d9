"""Checks the documentation: links, anchors, table of contents, words.

    python3 tests/docs/links.py

It prints each fault with file and line, and ends with status 1 if there is one.

- Every relative link and anchor of the pages leads somewhere.
- Pages of the book link within docs/, because the built book has nothing else.
- Every page of docs/ is in docs/SUMMARY.md, and every entry there exists.
- No phrase of tests/docs/words.txt appears.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
SUMMARY = DOCS / "SUMMARY.md"
WORDS = ROOT / "tests" / "docs" / "words.txt"
OUTSIDE = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"]

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
CODE = re.compile(r"(`+)(.+?)\1")
HEADING = re.compile(r"(#{1,6})\s+(.*?)\s*#*$")
FENCE = re.compile(r"\s*(```|~~~)")


def pages():
    return [ROOT / name for name in OUTSIDE] + sorted(DOCS.rglob("*.md"))


def prose(text):
    """Number and text of each line outside code blocks; a block that is only indented counts where it follows a blank line."""
    fenced, block, blank, listed = False, False, True, False
    for number, line in enumerate(text.splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
            blank = False
            continue
        if fenced:
            continue
        if not line.strip():
            blank = True
            continue
        indented = line.startswith("    ")
        block = indented and (block or (blank and not listed))
        if not indented:
            listed = bool(re.match(r"([-*+]|\d+\.)\s", line)) or (listed and line.startswith(" "))
        blank = False
        if not block:
            yield number, line


def slug(heading):
    """The anchor that GitHub and mdBook give a heading."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    kept = "".join(letter for letter in plain.lower() if letter.isalnum() or letter in " -_")
    return kept.strip().replace(" ", "-")


def anchors(path):
    found, seen = set(), {}
    for _, line in prose(path.read_text()):
        heading = HEADING.match(line)
        if heading:
            name = slug(heading[2])
            count = seen.get(name, 0)
            seen[name] = count + 1
            found.add(f"{name}-{count}" if count else name)
    return found


def links(path):
    for number, line in prose(path.read_text()):
        for target in LINK.findall(CODE.sub("", line)):
            yield number, target


def link_fault(path, target):
    if re.match(r"[a-z][a-z0-9+.-]*:", target):
        return None
    name, _, anchor = target.partition("#")
    goal = (path.parent / name).resolve() if name else path
    if not goal.is_relative_to(ROOT) or not goal.exists():
        return f"{target} does not exist"
    if path.is_relative_to(DOCS) and not goal.is_relative_to(DOCS):
        return f"{target} is not in the book; write its path as code"
    if anchor and goal.suffix == ".md" and anchor not in anchors(goal):
        return f"{target}: no such heading"
    return None


def link_faults():
    for path in pages():
        for number, target in links(path):
            fault = link_fault(path, target)
            if fault:
                yield path, number, fault


def contents_faults():
    listed = {}
    for number, target in links(SUMMARY):
        listed.setdefault((DOCS / target).resolve(), number)
    for page in sorted(DOCS.glob("*.md")):
        if page != SUMMARY and page not in listed:
            yield page, 1, "is not in docs/SUMMARY.md"


def word_faults():
    phrases = [line.strip() for line in WORDS.read_text().splitlines() if line.strip() and not line.startswith("#")]
    patterns = [(phrase, phrase_pattern(phrase)) for phrase in phrases]
    for path in pages():
        text = path.read_text()
        for phrase, pattern in patterns:
            for match in pattern.finditer(text):
                yield path, text.count("\n", 0, match.start()) + 1, f'"{phrase}" is not a phrase of the docs'


def phrase_pattern(phrase):
    """The phrase as whole words, whatever its case, also over the end of a line."""
    body = r"\s+".join(re.escape(word) for word in phrase.split())
    return re.compile(rf"(?<!\w){body}(?!\w)", re.IGNORECASE)


def main():
    faults = sorted(set([*link_faults(), *contents_faults(), *word_faults()]))
    for path, number, fault in faults:
        print(f"{path.relative_to(ROOT)}:{number}: {fault}")
    if not faults:
        print(f"{len(pages())} pages, no fault")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
