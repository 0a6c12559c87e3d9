"""Errors and remarks."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from ._native import CheckError, ComputationError, ExcavatorError, ModelError, ReadError, StoreError

__all__ = ["CheckError", "ComputationError", "ExcavatorError", "ModelError", "ReadError", "Remark", "StoreError", "remark"]


class Remark(UserWarning):
    """A remark, which the program prints on standard error: worth knowing, but no reason to stop."""


def remark(lines: Iterable[str], depth: int = 3) -> None:
    """Issues a warning for each line, with the stack level `depth`."""
    for line in lines:
        warnings.warn(line, Remark, stacklevel=depth)
