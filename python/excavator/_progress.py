"""Progress of long work."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

WIDTH = 30
"""Length of the bar, characters."""


@contextmanager
def teller(progress: bool | Callable[[str, float], object] | None) -> Iterator[Callable[[str, float], object] | None]:
    """The function that is told of progress: none, the caller's, or a line on standard error that goes away at the end."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        longest = 0

        def tell(what: str, done: float) -> None:
            nonlocal longest
            bar = "#" * round(WIDTH * done)
            line = f"{bar:.<{WIDTH}} {100 * done:3.0f} %  {what}"
            longest = max(longest, len(line))
            print(f"\r{line:<{longest}}", end="", file=sys.stderr, flush=True)

        try:
            yield tell
        finally:
            print(f"\r{'':<{longest}}\r", end="", file=sys.stderr, flush=True)
    else:
        yield progress
