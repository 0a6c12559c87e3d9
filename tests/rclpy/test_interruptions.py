"""Programs that stop in the middle of their work, in a debugger for one: the others go on, and so do they."""

from pathlib import Path

import pytest
from support.process import stopped
from support.simulator import NEWEST_QOS, Simulator, cylinder, steps

pytestmark = pytest.mark.middleware

READER = Path(__file__).parent / "support" / "counting_reader.py"
BYSTANDER = READER.with_name("bystander.py")
RATE = 1000.0
# Longer than the writer's window of 8192 unacknowledged samples lasts, and than the 10 s after which a silent
# participant of Cyclone DDS counts as gone, s.
LONG_STOP = 12.0
# Ten times as long as a command holds, s.
SHORT_STOP = 1.0
# s; a writer that waits for a reader that is gone stands still for its lease of 10 s. A busy machine makes gaps, too.
STALL = 8.0


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    return Simulator(ros, excavator, rate=RATE, command_timeout=None, qos=NEWEST_QOS)


@pytest.fixture(scope="module")
def other(ros, excavator):
    """A second simulator, whose time goes on while the first one stands still."""
    return Simulator(ros, excavator, rate=100.0, under="/other")


@pytest.mark.full
def test_a_stopped_reader_neither_stops_the_others_nor_is_it_forgotten(ros, simulator):
    reader = ros.start_python(READER)

    def read():
        # Between its words, a middleware may have something to say.
        counts = [line for line in reader.output().splitlines() if line.isdigit()]
        return int(counts[-1]) if counts else 0

    ros.spin_until(lambda: read() > 0, "the reader")
    with stopped(reader):
        start, first = simulator.time, len(simulator.states)
        ros.spin_until(lambda: simulator.time > start + LONG_STOP, "a long stop")
        states = simulator.states[first:]
        before = read()
    # a writer that waits 0.1 s for each sample has 10 in a second; on a busy machine we miss some
    assert len(states) > 50 * LONG_STOP
    assert max(steps(states)) < STALL
    # more than what waited in its queue
    ros.spin_until(lambda: read() > before + 1000, "the reader to go on")
    reader.interrupt()


def test_a_stopped_simulator_goes_on(simulator, other):
    with stopped(simulator.process):
        other.watch(SHORT_STOP)
    simulator.next(500)
    # it hears, too
    simulator.open_until(arm=2e-5)
    assert min(steps(simulator.states)) > 0.0


@pytest.mark.full
def test_a_simulator_that_was_stopped_with_an_open_valve_closes_it(ros, simulator, other):
    """The lease runs on the steady clock and has run out in the meantime; a command that still waited in the socket
    holds for one more 0.1 s, since it arrives only then."""
    simulator.open_until(arm=5e-5)
    with stopped(simulator.process):
        other.watch(SHORT_STOP)
        before = len(simulator.states)
    ros.spin_until(lambda: len(simulator.states) > before and simulator.area() == 0.0, "the valve to close")
    # the simulator's own time: a millisecond per state, whatever share of the processor it gets
    still_open = sum(cylinder(state).orifice_area != 0.0 for state in simulator.states[before:])
    assert still_open < 0.5 * RATE


@pytest.mark.full
def test_a_bystander_that_is_lost_and_comes_back_disturbs_nobody(ros, simulator):
    """A daemon that was starved of its processor: nobody rebuilds a link for it."""
    bystander = ros.start_python(BYSTANDER)
    ros.spin_until(lambda: "here" in bystander.output() and "bystander" in ros.node.get_node_names(), "the bystander")
    rebuilt = simulator.process.output().count("rebuilding the link")
    with stopped(bystander):
        ros.spin_until(lambda: "bystander" not in ros.node.get_node_names(), "its lease to run out")
    before = bystander.output().count("here")
    ros.spin_until(lambda: bystander.output().count("here") > before, "its return")
    # longer than a lost partner's return takes to be found
    start, first = simulator.time, len(simulator.states)
    ros.spin_until(lambda: simulator.time > start + 8.0, "the time in which a link would be rebuilt")
    assert max(steps(simulator.states[first:])) < STALL
    assert simulator.process.output().count("rebuilding the link") == rebuilt
    bystander.interrupt()
