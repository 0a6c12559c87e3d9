"""Who may move the machine: owners, leases, stamps, limits, stops, and what happens when the node itself dies."""

import os
import re
import signal
import time

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from excavator_msgs.msg import ArmState, OrificeCommand
from rcl_interfaces.msg import Log
from std_msgs.msg import Bool
from support.fault import survived
from support.session import LONGEST_WAIT
from support.simulator import MAXIMUM_AREA, RENEWAL, STATE_QOS, Simulator, command, cylinder, neutral, seconds, stamped

AREA = 5e-5
TIMEOUT = 0.1
# From fully open, s.
CLOSING = 0.05
# What a busy machine may add, s.
SLACK = 1.0


class Operator:
    """A node of its own that commands on a topic until it is told something else, or falls silent."""

    def __init__(self, ros, topic="/arm/orifice_command"):
        self._ros = ros
        self._publisher = ros.publisher(OrificeCommand, topic)
        self._areas = None
        self._timer = ros.node.create_timer(RENEWAL, self._renew)

    def _renew(self):
        if self._areas is not None:
            self._publisher.publish(command(**self._areas))

    def send(self, message):
        self._publisher.publish(message)

    def command(self, **areas):
        """From now on, neutral first."""
        self.send(neutral(areas))
        self._areas = areas
        self._renew()

    def fall_silent(self):
        self._areas = None

    def leave(self):
        self._ros.node.destroy_timer(self._timer)


class Diagnostics:
    """What the node says of itself: the newest status of each part."""

    def __init__(self, ros):
        self.newest = {}
        ros.listen_with(DiagnosticArray, "/diagnostics", self._take)

    def _take(self, array):
        for status in array.status:
            self.newest[status.name.partition(": ")[2]] = status

    def says(self, part, words, level=DiagnosticStatus.WARN):
        status = self.newest.get(part)
        return status is not None and status.level == level and words in status.message

    def value(self, part, key):
        status = self.newest.get(part)
        found = [pair.value for pair in status.values if pair.key == key] if status else []
        return found[0] if found else None


@pytest.fixture
def operators(ros):
    """Makes operators, and ends them."""
    made = []

    def make(topic="/arm/orifice_command"):
        made.append(Operator(ros, topic))
        return made[-1]

    yield make
    for operator in made:
        operator.leave()


@pytest.fixture
def diagnostics(ros):
    found = Diagnostics(ros)
    ros.spin_until(lambda: "commands" in found.newest, "/diagnostics")
    return found


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    """Boom and arm. The node's own time-out is that of the tests which measure it."""
    sources = "['autonomy:0:/arm/orifice_command', 'remote:10:/arm/remote/orifice_command']"
    arguments = ["-p", "model:=zx30u", "-p", f"command_sources:={sources}"]
    return Simulator(ros, excavator, rate=500.0, arguments=arguments)


def area(simulator, name="arm"):
    return cylinder(simulator.last, name).orifice_area


def until_area(ros, simulator, wanted, name="arm"):
    ros.spin_until(lambda: area(simulator, name) == pytest.approx(wanted), f"{name} to open {wanted} m2")


def open_by(ros, simulator, operator, wanted):
    """Until the operator has opened the valve, once it is closed: whoever commanded before may still have a lease. The lever
    goes back to neutral where the lease ran out on a busy machine."""
    pressed = 0.0

    def is_open():
        nonlocal pressed
        if area(simulator) == 0.0 and time.monotonic() - pressed > SLACK:
            pressed = time.monotonic()
            operator.command(arm=wanted)
        return pressed and area(simulator) == pytest.approx(wanted)

    ros.spin_until(is_open, f"arm to open {wanted} m2")


def test_a_silent_operators_valve_closes_while_another_one_speaks(ros, excavator, operators):
    closed = {}
    simulator = Simulator(
        ros, excavator, rate=500.0, command_timeout=None, under="/falls_silent", arguments=["-p", "model:=zx30u"]
    )
    for others in ({"boom": 0.0}, {}):
        first, second = operators("/falls_silent/orifice_command"), operators("/falls_silent/orifice_command")
        open_by(ros, simulator, first, AREA)
        second.command(**others)
        before = len(simulator.states)
        first.fall_silent()
        silent = time.time()
        until_area(ros, simulator, 0.0)
        simulator.next(150)
        after = [state for state in simulator.states[before:] if cylinder(state).orifice_area == 0.0]
        closed[len(others)] = seconds(after[0].header.stamp) - silent
        assert closed[len(others)] < TIMEOUT + CLOSING + SLACK
        assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states[-100:])
        second.fall_silent()
        simulator.settle()
    survived(
        "Commands",
        "operator A opens the arm and falls silent, B goes on with `boom = 0` or with no names at all",
        "the arm's valve closes when A's lease has run out",
        closed_after_ms=1e3 * max(closed.values()),
    )


def test_two_operators_on_one_valve(ros, simulator, operators, diagnostics):
    first, second = operators(), operators()
    open_by(ros, simulator, first, AREA)
    before = len(simulator.states)
    second.command(arm=-AREA)
    ros.spin_until(lambda: diagnostics.says("refusal", "is commanded by"), "a diagnostic about the second operator")
    simulator.next(150)
    assert all(cylinder(state).orifice_area == pytest.approx(AREA) for state in simulator.states[before:])
    survived("Commands", "two operators command one valve", "the first keeps it; the other one is refused and named")


def test_a_higher_priority_takes_over(ros, simulator, operators):
    autonomy, remote = operators(), operators("/arm/remote/orifice_command")
    open_by(ros, simulator, autonomy, AREA)
    remote.command(arm=-AREA)
    until_area(ros, simulator, -AREA)
    assert all(cylinder(state).orifice_area == pytest.approx(-AREA) for state in simulator.next(100))


@pytest.mark.parametrize("offset", [None, -1.8e9, -2.0, 5.0])
def test_stale_commands_and_those_from_the_future_are_refused(ros, simulator, operators, diagnostics, offset):
    simulator.settle()
    operator = operators()
    operator.send(neutral(["arm"]))
    word = {None: "no stamp", 5.0: "in the future"}.get(offset, "ago")
    before = len(simulator.states)
    for _ in range(20):
        message = command(arm=AREA)
        if offset is None:
            message.header.stamp.sec = message.header.stamp.nanosec = 0
        else:
            stamped(message, offset)
        operator.send(message)
        ros.spin_for(RENEWAL)
    ros.spin_until(lambda: diagnostics.says("refusal", word), f"a diagnostic that says {word}")
    assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states[before:])
    if offset == -1.8e9:
        survived("Commands", "a command stamped in 1970, without a stamp, or in the future", "refused, with the age that it has")


def test_a_full_reversal_is_limited_in_its_rate(ros, simulator, operators):
    operator = operators()
    open_by(ros, simulator, operator, 0.9 * MAXIMUM_AREA)
    before = len(simulator.states)
    operator.command(arm=-0.9 * MAXIMUM_AREA)
    until_area(ros, simulator, -0.9 * MAXIMUM_AREA)
    states = simulator.states[before - 1 :]
    rates = [
        abs(cylinder(later).orifice_area - cylinder(earlier).orifice_area)
        / (seconds(later.header.stamp) - seconds(earlier.header.stamp))
        for earlier, later in zip(states, states[1:])
    ]
    fastest = max(rates) / (MAXIMUM_AREA / CLOSING)
    assert 0.9 < fastest < 1.05, fastest
    survived(
        "Commands",
        "a full reversal from one sample to the next",
        "the opening follows at the limit of its rate (`opening_time`)",
        fastest_share_of_the_limit=fastest,
    )


def test_a_valve_that_was_closed_opens_after_neutral_only(ros, simulator, operators, diagnostics):
    operator = operators()
    open_by(ros, simulator, operator, AREA)
    operator.fall_silent()
    until_area(ros, simulator, 0.0)
    before = len(simulator.states)
    for _ in range(20):
        operator.send(command(arm=AREA))
        ros.spin_for(RENEWAL)
    assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states[before:])
    ros.spin_until(lambda: diagnostics.says("refusal", "command an area of 0 first"), "the diagnostic")
    open_by(ros, simulator, operator, AREA)
    survived("Commands", "the first command after the lease ran out", "refused until an area of 0 was commanded")


def test_a_stop_closes_and_needs_release_and_neutral(ros, simulator, operators, diagnostics):
    operator, panel = operators(), ros.publisher(Bool, "/arm/stop")
    open_by(ros, simulator, operator, AREA)
    stopped = time.time()
    panel.publish(Bool(data=True))
    until_area(ros, simulator, 0.0)
    closed = next(state for state in simulator.states if seconds(state.header.stamp) > stopped and cylinder(state).orifice_area == 0.0)
    took = seconds(closed.header.stamp) - stopped
    assert took < CLOSING + SLACK
    operator.command(arm=AREA)
    ros.spin_until(lambda: diagnostics.says("commands", "stopped by /checker"), "the diagnostic about the stop")
    assert area(simulator) == 0.0
    panel.publish(Bool(data=False))
    ros.spin_until(lambda: not diagnostics.says("commands", "stopped by"), "the release")
    simulator.next(100)
    assert area(simulator) == 0.0, "the operator still holds the lever"
    open_by(ros, simulator, operator, AREA)
    survived("Commands", "`true` on `/arm/stop` under an open valve", "the valve closes by its ramp; it opens after release and neutral", closed_after_ms=1e3 * took)


def test_refusals_are_said_once_and_clear_themselves(ros, simulator, operators, diagnostics):
    lines = []
    ros.listen_with(Log, "/rosout", lambda log: lines.append(log.msg))
    operator = operators()
    for _ in range(100):
        operator.send(command(tail=AREA))
        ros.spin_for(0.01)
    ros.spin_until(lambda: any("tail" in line for line in lines), "a line in the log")
    assert sum("tail" in line for line in lines) == 1
    count = "refused: malformed"
    ros.spin_until(lambda: int(diagnostics.value("refusal", count) or 0) >= 100, "all refusals to be counted")
    ros.spin_until(lambda: diagnostics.says("refusal", "no command was refused lately", DiagnosticStatus.OK), "the status to clear")


def test_only_named_writers_command(ros, excavator):
    topics = ["-r", "/arm/state:=/own/state", "-r", "/arm/orifice_command:=/own/command", "-r", "__node:=own_simulator"]
    process = ros.start(
        excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=250.0", "-p", "command_writers:=['/checker']", *topics
    )
    states = ros.listen(ArmState, "/own/state", STATE_QOS)
    ros.spin_until(lambda: states, "the simulator")
    stranger = rclpy.create_node("stranger", context=ros.node.context, start_parameter_services=False)
    publishers = [node.create_publisher(OrificeCommand, "/own/command", 10) for node in (stranger, ros.node)]
    ros.spin_until(lambda: all(p.get_subscription_count() > 0 for p in publishers), "the subscription")

    def send(publisher, areas):
        for _ in range(20):
            publisher.publish(command(arm=areas))
            ros.spin_for(RENEWAL)

    send(publishers[0], AREA)
    assert all(cylinder(state).orifice_area == 0.0 for state in states)
    ros.spin_until(
        lambda: publishers[1].publish(command(arm=AREA)) or cylinder(states[-1]).orifice_area == pytest.approx(AREA),
        "the named writer to be followed",
    )
    stranger.destroy_node()
    assert process.interrupt() == 0, process.output()
    survived("Commands", "a node that is not on the list `command_writers` commands", "refused, with its name")


def test_a_second_simulator_is_noticed(ros, excavator, simulator, diagnostics):
    second = ros.start(
        excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0", "-r", "__node:=second_simulator"
    )
    ros.spin_until(lambda: diagnostics.says("machine", "/second_simulator"), "a diagnostic that names the other one")
    assert second.interrupt() == 0
    ros.spin_until(lambda: diagnostics.says("machine", "no other node", DiagnosticStatus.OK), "the status to clear")
    survived("Commands", "two simulators on the same topics", "each says which other node publishes the machine's state")


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGABRT])
def test_valves_close_when_the_node_dies(ros, excavator, how):
    """The machine has a process of its own: no packet reaches it, and it closes when its node has gone."""
    simulator = Simulator(ros, excavator, rate=1000.0, command_timeout=None, under=f"/dies_{how}")
    simulator.open_until(arm=AREA)
    os.kill(simulator.process.pid, how)
    simulator.process.wait(LONGEST_WAIT)

    def closed():
        return re.search(r"every valve was closed ([0-9.]+) s later", simulator.process.output())

    ros.spin_until(closed, "the machine to close its valves")
    took = float(closed().group(1))
    assert took < CLOSING + SLACK
    if how == signal.SIGABRT:
        survived(
            "Commands",
            "the simulator's process is killed (kill -9, abort) with an open valve, at 1 kHz",
            "the machine's own process closes every valve by its ramp",
            closed_after_ms=1e3 * took,
        )


def test_valves_close_while_the_node_hangs(ros, excavator):
    simulator = Simulator(ros, excavator, rate=500.0, command_timeout=None, under="/hangs")
    simulator.open_until(arm=AREA)
    os.kill(simulator.process.pid, signal.SIGSTOP)
    try:
        # nothing tells from outside that the machine has closed
        ros.spin_for(TIMEOUT + CLOSING + SLACK)
    finally:
        resumed = time.time()
        os.kill(simulator.process.pid, signal.SIGCONT)

    def since():
        # a state that was measured before the hang and sent after it tells nothing of the time since
        return [state for state in simulator.states if seconds(state.header.stamp) > resumed]

    ros.spin_until(lambda: len(since()) > 100, "states after the hang")
    assert all(cylinder(state).orifice_area == 0.0 for state in since())
    survived("Commands", "the simulator's process hangs (SIGSTOP) with an open valve", "the machine closes it meanwhile; it is closed when the node goes on")
