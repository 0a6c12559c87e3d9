"""Malformed packets, peers that come, go and die: the nodes keep publishing, and say what they refused."""

import os
import re
import socket
import struct
import threading
from pathlib import Path

import pytest
from excavator_msgs.msg import ArmState
from support.diagnostics import Diagnostics
from support.flood import dds_ports, flood, malformed_packet
from support.recorder import bag_states, start_recorder
from support.simulator import STATE_QOS, Simulator, steps

pytestmark = pytest.mark.middleware

LONG = os.environ.get("EXCAVATOR_LONG") == "1"
RATE = 250.0
MALFORMED = 200_000 if LONG else 20_000
VISITORS = Path(__file__).parent / "support" / "visitor.py"
# s; a writer that waits for a peer that is gone stands still for its lease of 10 s. A busy machine makes gaps, too.
STALL = 8.0
BRIDGE = """
rate = 200.0
[[udp]]
port = {port}
length = 4
[[udp.fields]]
at = 0
kind = "f32"
signal = "arm.displacement"
age = 3600.0
"""


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE)


@pytest.fixture
def steady(ros, excavator, simulator, tmp_path):
    """A recorder on /arm/state; ends it and returns how many messages it lost and the states that it has."""
    bag = tmp_path / "bag"
    recorder = start_recorder(ros, excavator, bag, ["/arm/state"])
    simulator.next(round(RATE))

    def end():
        assert recorder.interrupt() == 0, recorder.output()
        (lost,) = re.findall(r"lost_messages:/arm/state\W+(\d+)", (bag / "metadata.yaml").read_text())
        return int(lost), bag_states(bag)

    return end


def in_background(work, *arguments):
    thread = threading.Thread(target=work, args=arguments, daemon=True)
    thread.start()
    return thread


def test_malformed_packets_at_the_ports_of_dds_stop_nobody(ros, simulator, steady):
    told = Diagnostics(ros)
    flooding = in_background(flood, dds_ports(ros.domain), MALFORMED, malformed_packet)
    ros.spin_until(lambda: not flooding.is_alive(), "the end of the flood")
    simulator.next(round(RATE))
    lost, states = steady()
    assert lost == 0
    assert len(states) > RATE
    assert max(steps(states)) < STALL
    # the packets arrived, and the nodes that they reached say so
    ros.spin_until(lambda: told.count("link", "malformed packets") > 100, "the count of packets")
    assert told.count("simulation", "refused states") == 0
    # commands come through as before
    simulator.open_until(arm=3e-5)


def test_datagrams_of_another_kind_do_not_stop_the_bridge(ros, excavator, tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    description = tmp_path / "bridge.toml"
    description.write_text(BRIDGE.format(port=port))
    remap = ["-r", "/arm/state:=/bridge/state"]
    bridge = ros.start(excavator, "node", "arm-bridge", "--ros-args", "-p", f"description:={description}", *remap)
    states = ros.hear(ArmState, "/bridge/state", STATE_QOS)
    told = Diagnostics(ros, "arm_bridge")

    def wrong(numbers):
        length = numbers.choice([0, 1, 3, 5, 8, 1400, 9000])
        return numbers.randbytes(length)

    def impossible(numbers):
        return struct.pack("<f", numbers.choice([float("nan"), float("inf"), -float("inf")]))

    def displacement():
        return states[-1].cylinders[0].displacement

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:

        def is_heard():
            sender.sendto(struct.pack("<f", 0.125), ("127.0.0.1", port))
            return displacement() == 0.125

        ros.spin_until(is_heard, "the good value")
        before = len(states)
        flooding = in_background(flood, [port], MALFORMED // 4, wrong, 20, 0.004)

        def is_flooded():
            """Good values go between the others; the kernel drops what a busy bridge does not fetch, so more are sent."""
            sender.sendto(struct.pack("<f", 0.125), ("127.0.0.1", port))
            enough = told.count("signals", "refused datagrams") > 1000 and len(states) - before > 200
            if not flooding.is_alive() and not enough:
                flood([port], 20, wrong)
            return enough and not flooding.is_alive()

        ros.spin_until(is_flooded, "states in the flood, and the count of datagrams")
        assert {state.cylinders[0].displacement for state in states[before:]} == {0.125}

        def is_refused():
            flood([port], 5, impossible)
            return displacement() != 0.125

        ros.spin_until(is_refused, "the impossible value to be refused")
    assert bridge.interrupt() == 0, bridge.output()


@pytest.mark.full
def test_ten_participants_come_and_go_and_a_steady_reader_loses_nothing(ros, simulator, steady):
    """Each joins, reads the state for a moment and leaves, some of them without a word."""
    guests = []
    for number in range(10 if not LONG else 60):
        guest = ros.start_python(VISITORS)
        guests.append(guest)
        simulator.next(round(0.15 * RATE))
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
    simulator.next(round(RATE))
    lost, states = steady()
    assert lost == 0
    assert max(steps(states)) < STALL
    assert len(states) > RATE


def test_a_killed_simulator_is_replaced_and_its_readers_go_on(ros, excavator, steady, simulator):
    """The recorder hears the second one too, though the first left without a word."""
    simulator.process.vanish()
    second = Simulator(ros, excavator, rate=RATE, arguments=["-p", "frame_id:=second"])

    def of_second(states):
        return [state for state in states if state.header.frame_id == "second"]

    ros.spin_until(lambda: of_second([second.last]), "states of the second simulator")
    second.next(round(1.5 * RATE))
    _, states = steady()
    assert len(of_second(states)) > 0.5 * RATE
    second.open_until(arm=3e-5)
    assert second.process.interrupt() == 0


@pytest.mark.full
def test_a_killed_reader_is_replaced(ros, excavator):
    """The simulator goes on while a reliable reader that died still counts, and serves the next one."""
    simulator = Simulator(ros, excavator, rate=RATE)
    first = ros.start_python(VISITORS, "stay")
    ros.spin_until(lambda: "heard" in first.output(), "the first reader")
    first.vanish()
    assert max(steps(simulator.next(round(2 * RATE)))) < STALL
    second = ros.start_python(VISITORS, "stay")
    ros.spin_until(lambda: "heard" in second.output(), "the second reader")
    second.interrupt()
