"""Timers on the steady clock."""

import time


class Timer:
    def __init__(self, node, callback, period_sec):
        self._node = node
        self.callback = callback
        self._period = period_sec
        self._next = time.monotonic() + period_sec

    def _seconds_left(self):
        return self._next - time.monotonic()

    def _execute_if_due(self):
        if self._seconds_left() > 0:
            return False
        # missed periods are left out, not caught up
        late = time.monotonic() - self._next
        self._next += self._period * (1 + int(late / self._period))
        self.callback()
        return True

    def destroy(self):
        self._node.destroy_timer(self)
