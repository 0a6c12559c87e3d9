"""Progress of long computations."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

WIDTH = 30
"""Length of the bar, in characters."""


@contextmanager
def teller(progress: bool | Callable[[str, float], object] | None) -> Iterator[Callable[[str, float], object] | None]:
    """Yields the progress function: `None`, the one from the caller, or one that prints a line on standard error and clears it at the end."""
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
