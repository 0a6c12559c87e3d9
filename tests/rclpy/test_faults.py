"""Malformed packets, peers that come, go and die: the nodes keep publishing, and say what they refused."""

import os
import random
import re
import socket
import struct
import threading
import time
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from excavator_msgs.msg import ArmState
from support.flood import dds_ports, flood, malformed_packet
from support.session import LONGEST_WAIT
from support.simulator import STATE_QOS, Simulator, seconds

pytestmark = pytest.mark.middleware

LONG = os.environ.get("EXCAVATOR_LONG") == "1"
RATE = 1000.0
MALFORMED = 200_000 if LONG else 20_000
VISITORS = Path(__file__).parent / "support" / "visitor.py"
# s; a writer that waits for a peer that is gone stands still for its lease of 10 s. A busy machine makes gaps, too.
STALL = 3.0
BRIDGE = """
rate = 200.0
[[udp]]
port = {port}
length = 4
[[udp.fields]]
at = 0
kind = "f32"
signal = "arm.displacement"
age = 0.2
"""


class Told:
    """The newest values in /diagnostics, by part and key."""

    def __init__(self, ros):
        self.values = {}
        ros.listen_with(DiagnosticArray, "/diagnostics", self._take)

    def _take(self, array):
        for status in array.status:
            for value in status.values:
                self.values[status.name, value.key] = value.value

    def number(self, part, key):
        return int(self.values.get((part, key), -1))


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE)


@pytest.fixture
def steady(ros, excavator, simulator, tmp_path):
    """A recorder on /arm/state; ends it and returns how many messages it lost and the stamps that it has."""
    bag = tmp_path / "bag"
    recorder = ros.start(excavator, "record", "/arm/state", "-o", bag)
    ros.spin_until(lambda: ros.node.count_subscribers("/arm/state") >= 2, "the recorder")
    simulator.next(1000)

    def end():
        from rosbags.highlevel import AnyReader

        assert recorder.interrupt() == 0, recorder.output()
        (lost,) = re.findall(r"lost_messages:/arm/state\W+(\d+)", (bag / "metadata.yaml").read_text())
        with AnyReader([bag]) as reader:
            states = [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]
        return int(lost), [seconds(state.header.stamp) for state in states]

    return end


def longest_gap(stamps):
    return max(later - earlier for earlier, later in zip(stamps, stamps[1:]))


def in_background(work, *arguments):
    thread = threading.Thread(target=work, args=arguments, daemon=True)
    thread.start()
    return thread


def test_malformed_packets_at_the_ports_of_dds_stop_nobody(ros, simulator, steady):
    told = Told(ros)
    flooding = in_background(flood, dds_ports(ros.domain), MALFORMED, malformed_packet)
    before = len(simulator.states)
    while flooding.is_alive():
        simulator.watch(0.1)
    simulator.next(1000)
    lost, stamps = steady()
    assert lost == 0
    assert longest_gap(stamps) < STALL
    # the packets arrived, and the nodes that they reached say so
    ros.spin_until(lambda: told.number("arm_simulator: link", "malformed packets") > 100, "the count of packets")
    assert told.number("arm_simulator: simulation", "refused states") == 0
    assert len(simulator.states) > before + RATE
    # commands come through as before
    simulator.open_until(arm=3e-5)


def test_datagrams_of_another_kind_do_not_stop_the_bridge(ros, excavator, tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    description = tmp_path / "bridge.toml"
    description.write_text(BRIDGE.format(port=port))
    told = Told(ros)
    remap = ["-r", "/arm/state:=/bridge/state"]
    bridge = ros.start(excavator, "node", "arm-bridge", "--ros-args", "-p", f"description:={description}", *remap)
    states = ros.listen(ArmState, "/bridge/state", STATE_QOS)
    ros.spin_until(lambda: states, "the bridge")

    def wrong(numbers):
        length = numbers.choice([0, 1, 3, 5, 8, 1400, 9000])
        return numbers.randbytes(length)

    def impossible(numbers):
        return struct.pack("<f", numbers.choice([float("nan"), float("inf"), -float("inf")]))

    flooding = in_background(flood, [port], MALFORMED // 4, wrong, 20, 0.004)
    good = random.Random(1)
    before = len(states)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        # A machine with other work may not hear a state for seconds.
        deadline = time.monotonic() + LONGEST_WAIT
        while flooding.is_alive() or (len(states) - before <= 200 and time.monotonic() < deadline):
            sender.sendto(struct.pack("<f", 0.125), ("127.0.0.1", port))
            ros.spin_for(0.01 + 0.001 * good.random())
        measured = [state.cylinders[0].displacement for state in states[before:]]
        assert len(measured) > 200
        # the first good datagram may have come after the first state
        assert measured.count(0.125) > 0.9 * len(measured)
        flood([port], 100, impossible)
    ros.spin_until(lambda: states[-1].cylinders[0].displacement != 0.125, "the impossible value to be refused")
    ros.spin_until(lambda: told.number("arm_bridge: signals", "refused datagrams") > 1000, "the count of datagrams")
    assert bridge.interrupt() == 0, bridge.output()


def test_ten_participants_come_and_go_and_a_steady_reader_loses_nothing(ros, simulator, steady):
    """Each joins, reads the state for a moment and leaves, some of them without a word."""
    guests = []
    for number in range(10 if not LONG else 60):
        guest = ros.start_python(VISITORS)
        guests.append(guest)
        simulator.watch(0.15)
        if len(guests) >= 4:
            leaving = guests.pop(0)
            ros.spin_until(lambda: "heard" in leaving.output(), "a visitor to hear the state")
            if number % 3 == 0:
                leaving.vanish()
            else:
                in_background(leaving.interrupt)
    for guest in guests:
        ros.spin_until(lambda: "heard" in guest.output(), "a visitor to hear the state")
        in_background(guest.interrupt)
    simulator.next(1000)
    lost, stamps = steady()
    assert lost == 0
    assert longest_gap(stamps) < STALL
    assert len(stamps) > RATE


def test_a_killed_simulator_is_replaced_and_its_readers_go_on(ros, excavator, steady, simulator):
    """The recorder hears the second one too, though the first left without a word."""
    simulator.process.vanish()
    died = time.time()
    second = Simulator(ros, excavator, rate=RATE)
    ros.spin_until(lambda: seconds(second.last.header.stamp) > died, "states of the second simulator")
    second.next(1500)
    _, stamps = steady()
    after = [stamp for stamp in stamps if stamp > died]
    assert len(after) > 0.5 * RATE
    second.open_until(arm=3e-5)
    assert second.process.interrupt() == 0


def test_a_killed_reader_is_replaced(ros, excavator):
    """The simulator goes on while a reliable reader that died still counts, and serves the next one."""
    simulator = Simulator(ros, excavator, rate=RATE)
    first = ros.start_python(VISITORS, "stay")
    ros.spin_until(lambda: "heard" in first.output(), "the first reader")
    first.vanish()
    states = simulator.next(2000)
    assert longest_gap([seconds(state.header.stamp) for state in states]) < STALL
    second = ros.start_python(VISITORS, "stay")
    ros.spin_until(lambda: "heard" in second.output(), "the second reader")
    second.interrupt()
