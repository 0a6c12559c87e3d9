"""Bad commands are refused with a diagnostic, and change nothing."""

import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from excavator_msgs.msg import OrificeCommand
from support.simulator import MAXIMUM_AREA, RENEWAL, Simulator, command, cylinder

AREA = 3e-5

BAD = {
    "not a number": (command(arm=math.nan), "arm"),
    "infinite": (command(arm=math.inf), "arm"),
    "minus infinite": (command(arm=-math.inf), "arm"),
    "too wide": (command(arm=1.5 * MAXIMUM_AREA), "arm"),
    "too wide the other way": (command(arm=-2.0 * MAXIMUM_AREA), "arm"),
    "unknown cylinder": (command(tail=AREA), "tail"),
    "no name": (OrificeCommand(names=[""], areas=[AREA]), ""),
    "more names than areas": (OrificeCommand(names=["arm", "arm"], areas=[AREA]), "2"),
    "more areas than names": (OrificeCommand(names=[], areas=[AREA]), "1"),
    "named twice": (OrificeCommand(names=["arm", "arm"], areas=[AREA, -AREA]), "arm"),
    "one good and one bad": (OrificeCommand(names=["arm", "bucket"], areas=[AREA, AREA]), "bucket"),
}


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator)


@pytest.fixture
def complaints(ros):
    """Messages of statuses that are not OK and tell of a refusal, as they come."""
    diagnostics = ros.listen(DiagnosticArray, "/diagnostics")
    ros.spin_until(lambda: diagnostics, "/diagnostics")

    def found():
        return [
            status.message
            for message in diagnostics
            for status in message.status
            if status.level in (DiagnosticStatus.WARN, DiagnosticStatus.ERROR) and "refused" in status.message
        ]

    return found


@pytest.mark.parametrize("bad", BAD)
def test_a_bad_command_opens_nothing_and_is_told(ros, simulator, complaints, bad):
    message, word = BAD[bad]
    simulator.settle()
    before = complaints()
    simulator.send(message)
    sent = len(simulator.states)
    ros.spin_until(lambda: set(complaints()) - set(before), f"a diagnostic about {bad}")
    simulator.next(25)
    assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states[sent:])
    (told,) = set(complaints()) - set(before)
    assert word in told


def test_a_bad_command_does_not_disturb_the_good_one(ros, simulator):
    """A test that has to wait for the processor misses a renewal. A bad command that closes the valve does so every time."""

    def stays_open():
        simulator.open_until(arm=AREA)
        states = []
        with simulator.holding(arm=AREA):
            for message, _ in BAD.values():
                states += simulator.next(25)
                simulator.send(message)
            states += simulator.next(25)
        return all(cylinder(state).orifice_area == pytest.approx(AREA) for state in states)

    ros.spin_until(stays_open, "a valve that stays open")


def test_a_bad_command_does_not_renew_the_lease(ros, excavator):
    """Else a program gone mad would hold the valve open."""
    simulator = Simulator(ros, excavator, rate=100.0, command_timeout=None, under="/short_lease")
    simulator.open_until(arm=AREA)
    timer = ros.node.create_timer(RENEWAL, lambda: simulator.send(command(arm=math.nan)))
    try:
        ros.spin_until(lambda: simulator.area() == 0.0, "the valve to close")
    finally:
        ros.node.destroy_timer(timer)
