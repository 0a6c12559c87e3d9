"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def needed(package: str, what: str) -> Any:
    """The module `package`, or an error that says how to get it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        distribution = package.partition(".")[0]
        raise ImportError(f"{what} needs {distribution}: pip install {distribution}") from error
