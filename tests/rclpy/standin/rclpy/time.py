"""Points in time."""

from ._messages import message_class
from .duration import Duration


class Time:
    def __init__(self, *, seconds=0, nanoseconds=0):
        self._nanoseconds = int(seconds * 1e9) + int(nanoseconds)

    @property
    def nanoseconds(self):
        return self._nanoseconds

    def to_msg(self):
        sec, nanosec = divmod(self._nanoseconds, 10**9)
        return message_class("builtin_interfaces/msg/Time")(sec=sec, nanosec=nanosec)

    @classmethod
    def from_msg(cls, msg):
        return cls(nanoseconds=msg.sec * 10**9 + msg.nanosec)

    def __sub__(self, other):
        if isinstance(other, Time):
            return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)
        if isinstance(other, Duration):
            return Time(nanoseconds=self._nanoseconds - other.nanoseconds)
        return NotImplemented

    def __repr__(self):
        return f"Time(nanoseconds={self._nanoseconds})"
