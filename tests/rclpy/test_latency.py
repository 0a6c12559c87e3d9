"""States at 1 kHz for a minute, heard by rclpy: of the simulator, and of a node of rclpy at the same time.

It takes a minute and wants the machine for itself: it runs where EXCAVATOR_LONG is set, and prints its figures.
"""

import os
import statistics
import time
from pathlib import Path

import pytest
from excavator_msgs.msg import ArmState
from support.diagnostics import Diagnostics
from support.simulator import STATE_QOS, seconds

RATE = 1000.0
# A minute, in parts that end before a test does.
PARTS, PART = 6, 10.0
PUBLISHER = Path(__file__).with_name("support") / "latency_publisher.py"

pytestmark = [
    pytest.mark.full,
    pytest.mark.skipif(not os.environ.get("EXCAVATOR_LONG"), reason="EXCAVATOR_LONG is not set"),
]


class Heard:
    """Stamps and delays (s) of the states on a topic."""

    def __init__(self, ros, topic):
        self.stamps, self.delays = [], []
        ros.listen_with(ArmState, topic, self._take, STATE_QOS)
        ros.spin_until(lambda: len(self.stamps) > RATE, f"a second of {topic}")

    def _take(self, state):
        self.delays.append(time.time() - seconds(state.header.stamp))
        self.stamps.append(seconds(state.header.stamp))

    def begin(self):
        del self.stamps[:], self.delays[:]

    def tell(self, name):
        """Prints the figures, and returns the median delay."""
        delays = sorted(self.delays)
        p50, p99 = statistics.median(delays), delays[int(0.99 * len(delays))]
        print(f"\n{name}: {len(delays)} states, p50 {1e3 * p50:.2f} ms, p99 {1e3 * p99:.2f} ms")
        return p50

    def missing(self):
        """Gaps between stamps, and samples that would be in them."""
        steps = [round((later - earlier) * RATE) for earlier, later in zip(self.stamps, self.stamps[1:])]
        return sum(step > 1 for step in steps), sum(steps) - len(steps)


def test_a_minute_at_1_khz(ros, excavator, capsys):
    ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", f"rate:={RATE}")
    ros.start_python(PUBLISHER, "/peer/state", RATE)
    ours, theirs = Heard(ros, "/arm/state"), Heard(ros, "/peer/state")
    told = Diagnostics(ros)
    for heard in (ours, theirs):
        heard.begin()
    for part in range(1, PARTS + 1):
        ros.spin_until(lambda: ours.stamps and ours.stamps[-1] >= ours.stamps[0] + part * PART, "states")  # noqa: B023
    gaps, missing = ours.missing()
    with capsys.disabled():
        our_middle, their_middle = ours.tell("simulator to rclpy"), theirs.tell("rclpy to rclpy")
        print(f"missing states of the simulator: {missing}")
    told.reach(ours.stamps[-1])
    assert gaps <= told.count("simulation", "schedule restarts"), "a state is missing that the simulator published"
    # both are heard by one reader in one minute
    assert our_middle < 2 * their_middle
