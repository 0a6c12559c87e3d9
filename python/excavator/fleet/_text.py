"""JSON as the program writes it."""

from __future__ import annotations

import re

_TOKENS = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\],:]|[^\s{}\[\],:"]+')

INDENT = "  "


def as_program(text: str) -> str:
    """The same JSON laid out as a file of the program's `--json`, character by character.

    Numbers and texts are copied as they stand. To read them and write them again would change the writing of numbers.
    """
    out: list[str] = []
    depth, previous = 0, ""
    for token in _TOKENS.findall(text):
        if token in ("}", "]"):
            depth -= 1
            if previous not in ("{", "["):
                out.append("\n" + INDENT * depth)
            out.append(token)
        else:
            if previous in ("{", "[", ","):
                out.append("\n" + INDENT * depth)
            elif previous == ":":
                out.append(" ")
            out.append(token)
            if token in ("{", "["):
                depth += 1
        previous = token
    return "".join(out) + "\n"
