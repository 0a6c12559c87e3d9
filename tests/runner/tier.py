"""How much is checked."""

from enum import IntEnum


class Tier(IntEnum):
    """Each has all of the ones before it."""

    COMMIT = 0
    ALL = 1
    LONG = 2
