"""The executor that runs one callback at a time."""

import time

from cyclonedds.core import GuardCondition, WaitSet

from .utilities import get_default_context


class ExternalShutdownException(Exception):
    """The context was shut down while spinning."""


class SingleThreadedExecutor:
    def __init__(self, *, context=None):
        self._context = get_default_context() if context is None else context
        self._nodes = []
        self._waiting_for = None
        self._waitset = None
        self._guard = None
        self._turn = 0

    @property
    def context(self):
        return self._context

    def add_node(self, node):
        if node in self._nodes:
            return False
        self._nodes.append(node)
        node.executor = self
        self.wake()
        return True

    def remove_node(self, node):
        if node in self._nodes:
            self._nodes.remove(node)
            node.executor = None
            self._forget_conditions()

    def get_nodes(self):
        return list(self._nodes)

    def wake(self):
        if self._guard is not None:
            self._guard.set(True)

    def shutdown(self, timeout_sec=None):
        for node in list(self._nodes):
            self.remove_node(node)
        self._guard = None
        return True

    def _forget_conditions(self):
        """A wait set holds its conditions, and they their readers: readers that should go have to be let go here."""
        self.wake()
        self._waitset = self._waiting_for = None

    def spin(self):
        while self._context.ok():
            self.spin_once()

    def spin_once(self, timeout_sec=None):
        """Runs one callback, or returns after the time-out (None: waits for ever)."""
        endless = timeout_sec is None or timeout_sec < 0
        end = float("inf") if endless else time.monotonic() + timeout_sec
        while self._context.ok():
            if self._execute_one():
                return
            timers = [timer for node in self._nodes for timer in node._timers]
            left = min([end - time.monotonic(), *(timer._seconds_left() for timer in timers)])
            if end <= time.monotonic():
                return
            self._wait(left)
        raise ExternalShutdownException()

    def _execute_one(self):
        for node in list(self._nodes):
            for timer in list(node._timers):
                if timer._execute_if_due():
                    return True
        waitables = [entity for node in self._nodes for entity in node._waitables]
        # nobody is served twice before the others had their turn
        for step in range(len(waitables)):
            index = (self._turn + step) % len(waitables)
            if waitables[index]._execute_one():
                self._turn = index + 1
                return True
        return False

    def _wait(self, seconds):
        conditions = [
            reader.condition for node in self._nodes for entity in node._waitables for reader in entity._readers
        ]
        if self._waitset is None or conditions != self._waiting_for:
            participant = self._context._participant
            self._guard = self._guard or GuardCondition(participant)
            self._waitset = WaitSet(participant)
            for condition in [*conditions, self._guard]:
                self._waitset.attach(condition)
            self._waiting_for = conditions
        # an endless wait is cut into pieces, so that Ctrl-C is heard
        self._waitset.wait(int(min(max(seconds, 0.0), 0.5) * 1e9))
        self._guard.set(False)
