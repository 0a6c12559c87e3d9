"""States at 1 kHz for a minute, heard by rclpy: of the simulator, and of a node of rclpy in the same run.

It takes two minutes and wants the machine for itself: it runs where EXCAVATOR_LONG is set, and prints its figures.
"""

import os
import statistics
import time
from pathlib import Path

import pytest
from excavator_msgs.msg import ArmState
from rclpy.qos import QoSProfile
from support.simulator import STATE_QOS

RATE = 1000.0
SECONDS = 60
PUBLISHER = Path(__file__).with_name("support") / "latency_publisher.py"

pytestmark = pytest.mark.skipif(not os.environ.get("EXCAVATOR_LONG"), reason="EXCAVATOR_LONG is not set")


def heard(ros, topic, what):
    """Stamps and delays (s) of the states of a minute, and how many of their numbers are missing."""
    stamps, delays = [], []

    def take(state):
        stamp = state.header.stamp.sec * 1_000_000_000 + state.header.stamp.nanosec
        stamps.append(stamp)
        delays.append((time.time_ns() - stamp) * 1e-9)

    ros.listen_with(ArmState, topic, take, QoSProfile(depth=STATE_QOS.depth))
    ros.spin_until(lambda: len(stamps) > RATE, f"a second of {what}")
    del stamps[:], delays[:]
    ros.spin_until(lambda: stamps and stamps[-1] - stamps[0] >= SECONDS * 1_000_000_000, what, 10 * SECONDS)
    return stamps, sorted(delays)


def told(name, delays):
    p50, p99 = statistics.median(delays), delays[int(0.99 * len(delays))]
    print(f"\n{name}: {len(delays)} states, p50 {1e3 * p50:.2f} ms, p99 {1e3 * p99:.2f} ms")
    return p50, p99


def test_a_minute_at_1_khz(ros, excavator, capsys):
    simulator = ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", f"rate:={RATE}")
    stamps, ours = heard(ros, "/arm/state", "states of the simulator")
    simulator.interrupt()
    steps = [round((after - before) * 1e-9 * RATE) for before, after in zip(stamps, stamps[1:], strict=False)]
    peer = ros.start_python(PUBLISHER, "/peer/state", RATE)
    _, theirs = heard(ros, "/peer/state", "states of rclpy")
    peer.interrupt()
    with capsys.disabled():
        our_middle, _ = told("simulator to rclpy", ours)
        their_middle, _ = told("rclpy to rclpy", theirs)
        print(f"missing states of the simulator: {sum(steps) - len(steps)} of {len(steps)}")
    assert sum(steps) == len(steps), "a state is missing"
    assert our_middle < 2 * their_middle
