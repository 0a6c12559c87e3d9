"""Durations, in nanoseconds inside."""


class Duration:
    def __init__(self, *, seconds=0, nanoseconds=0):
        self._nanoseconds = int(seconds * 1e9) + int(nanoseconds)

    @property
    def nanoseconds(self):
        return self._nanoseconds

    def __repr__(self):
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __eq__(self, other):
        return isinstance(other, Duration) and self._nanoseconds == other._nanoseconds

    __hash__ = None
