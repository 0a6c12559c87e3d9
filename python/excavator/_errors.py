"""Errors and remarks."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from ._native import CheckError, ComputationError, ExcavatorError, ModelError, ReadError, StoreError

__all__ = ["CheckError", "ComputationError", "ExcavatorError", "ModelError", "ReadError", "Remark", "StoreError", "remark"]


class Remark(UserWarning):
    """What the program remarks on standard error: nothing is wrong enough to stop, and a person should know it."""


def remark(lines: Iterable[str], depth: int = 3) -> None:
    """Warns of each line, at the place `depth` calls above."""
    for line in lines:
        warnings.warn(line, Remark, stacklevel=depth)
