"""What a node says of itself on /diagnostics."""

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from .simulator import seconds

# s; values are told five times a second, and published within another second.
LATEST_VALUES = 1.3


class Diagnostics:
    """The newest status of each part of one node, from the first one on."""

    def __init__(self, ros, node="arm_simulator"):
        self._ros = ros
        self._node = node
        self._stamp = 0.0
        self._heard = 0
        self.newest = {}
        ros.listen_with(DiagnosticArray, "/diagnostics", self._take, 100)
        ros.spin_until(lambda: self.newest, f"/diagnostics of {node}")

    def _take(self, array):
        self._heard += any(status.name.startswith(f"{self._node}: ") for status in array.status)
        for status in array.status:
            node, _, part = status.name.partition(": ")
            if node == self._node:
                self.newest[part] = status
                self._stamp = seconds(array.header.stamp)

    def says(self, part, words, level=DiagnosticStatus.WARN):
        status = self.newest.get(part)
        return status is not None and status.level == level and words in status.message

    def count(self, part, key):
        """A number that the node counts; 0 where it has not said any."""
        status = self.newest.get(part)
        found = [pair.value for pair in status.values if pair.key == key] if status else []
        return int(found[0]) if found else 0

    def next(self, count):
        """Waits for this many further messages of the node; it sends one each second at least."""
        heard = self._heard
        self._ros.spin_until(lambda: self._heard >= heard + count, f"{count} /diagnostics of {self._node}")

    def reach(self, stamp):
        """Waits for values that were told after this stamp (s) of the node's own clock."""
        self._ros.spin_until(lambda: self._stamp > stamp + LATEST_VALUES, f"later /diagnostics of {self._node}")
