"""The system clock."""

import time

from .time import Time


class Clock:
    def now(self):
        return Time(nanoseconds=time.time_ns())
