"""Who may move the machine: owners, leases, stamps, limits, stops, and what happens when the node itself dies."""

import os
import re
import signal

import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticStatus
from excavator_msgs.msg import OrificeCommand
from rcl_interfaces.msg import Log
from std_msgs.msg import Bool
from support.diagnostics import Diagnostics
from support.fault import survived
from support.process import stopped
from support.simulator import (
    COMMAND_QOS, MAXIMUM_AREA, NEWEST_QOS, RENEWAL, Simulator, command, cylinder, neutral, seconds, stamped, steps,
)  # fmt: skip

AREA = 5e-5
# Several simulators run at once, and all of them are heard, Hz.
RATE = 100.0
# From fully open, s.
CLOSING = 0.05
# The machine gives up after a minute where its valves do not close, s.
GIVES_UP = 60.0
# States after which a valve that is still closed was closed by the node, and not by the way of a message.
STAYS_CLOSED = 30


class Operator:
    """A node of its own that commands on a topic until it is told something else, or falls silent."""

    def __init__(self, ros, topic="/arm/orifice_command"):
        self._ros = ros
        self._publisher = ros.publisher(OrificeCommand, topic, COMMAND_QOS)
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
def diagnostics(ros, simulator):
    return Diagnostics(ros, simulator.node)


@pytest.fixture(scope="module")
def machine(ros, excavator):
    """Boom and arm."""
    sources = "['autonomy:0:/arm/orifice_command', 'remote:10:/arm/remote/orifice_command']"
    arguments = ["-p", "model:=zx30u", "-p", f"command_sources:={sources}"]
    return Simulator(ros, excavator, rate=RATE, arguments=arguments)


@pytest.fixture
def simulator(ros, machine):
    """Boom and arm, with closed valves that nobody owns: a stop ends every lease."""
    yield machine
    told, panel = Diagnostics(ros, machine.node), ros.publisher(Bool, "/arm/stop")
    panel.publish(Bool(data=True))
    ros.spin_until(lambda: is_stopped(told), "the stop after a test")
    ros.spin_until(lambda: machine.area("boom") == machine.area("arm") == 0.0, "closed valves")
    panel.publish(Bool(data=False))
    ros.spin_until(lambda: not is_stopped(told), "the release after a test")


def is_stopped(told):
    """Whether the machine is stopped now; that it was stopped is said for a while."""
    return "commands" in told.newest and told.newest["commands"].message.startswith("stopped by")


def until_area(ros, simulator, wanted, name="arm"):
    ros.spin_until(lambda: simulator.area(name) == pytest.approx(wanted), f"{name} to open {wanted} m2")


def open_by(ros, simulator, operator, wanted):
    """Until the operator has opened the valve. The lever goes back to neutral where the valve stays closed."""
    pressed = None

    def is_open():
        nonlocal pressed
        heard = len(simulator.states)
        if simulator.area() == 0.0 and (pressed is None or heard > pressed + STAYS_CLOSED):
            pressed = heard
            operator.command(arm=wanted)
        return pressed is not None and simulator.area() == pytest.approx(wanted)

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
        simulator.next(50)
        before = len(simulator.states)
        first.fall_silent()
        silent = simulator.time
        # where the other one renewed this lease, too, it would stay open
        closed[len(others)] = seconds(simulator.closes(before).header.stamp) - silent
        second.fall_silent()
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
    simulator.next(100)
    assert all(cylinder(state).orifice_area == pytest.approx(AREA) for state in simulator.states[before:])
    survived("Commands", "two operators command one valve", "the first keeps it; the other one is refused and named")


def test_a_higher_priority_takes_over(ros, simulator, operators):
    autonomy, remote = operators(), operators("/arm/remote/orifice_command")
    open_by(ros, simulator, autonomy, AREA)
    remote.command(arm=-AREA)
    until_area(ros, simulator, -AREA)
    assert all(cylinder(state).orifice_area == pytest.approx(-AREA) for state in simulator.next(100))


@pytest.fixture(scope="module")
def strict(ros, excavator):
    """One with its own limits for the age of commands."""
    return Simulator(ros, excavator, rate=RATE, command_timeout=None, under="/strict")


@pytest.mark.parametrize("offset", [None, -1.8e9, -2.0, 5.0])
def test_stale_commands_and_those_from_the_future_are_refused(ros, strict, operators, offset):
    told = Diagnostics(ros, strict.node)
    operator = operators("/strict/orifice_command")
    word, kind = {None: ("no stamp", "unstamped"), 5.0: ("in the future", "from the future")}.get(offset, ("ago", "too old"))
    known = told.count("refusal", f"refused: {kind}")
    before = len(strict.states)

    def send():
        message = command(arm=AREA)
        if offset is None:
            message.header.stamp.sec = message.header.stamp.nanosec = 0
        else:
            stamped(message, offset)
        operator.send(message)

    def is_refused():
        send()
        return told.count("refusal", f"refused: {kind}") >= known + 20

    operator.send(neutral(["arm"]))
    ros.spin_until(is_refused, f"20 commands to be refused as {kind}")
    ros.spin_until(lambda: told.says("refusal", word), f"a diagnostic that says {word}")
    assert all(cylinder(state).orifice_area == 0.0 for state in strict.states[before:])
    if offset == -1.8e9:
        survived("Commands", "a command stamped in 1970, without a stamp, or in the future", "refused, with the age that it has")


def test_a_full_reversal_is_limited_in_its_rate(ros, simulator, operators):
    operator = operators()
    wide = 0.9 * MAXIMUM_AREA

    def reversal():
        open_by(ros, simulator, operator, wide)
        before = len(simulator.states)
        operator.command(arm=-wide)
        until_area(ros, simulator, -wide)
        states = simulator.states[before - 1 :]
        # closed again for another attempt
        operator.command(arm=0.0)
        until_area(ros, simulator, 0.0)
        return states

    states = simulator.undisturbed(reversal)
    areas = [cylinder(state).orifice_area for state in states]
    rates = [abs(later - earlier) / step for earlier, later, step in zip(areas, areas[1:], steps(states))]
    fastest = max(rates) / (MAXIMUM_AREA / CLOSING)
    assert 0.9 < fastest < 1.05, fastest
    survived(
        "Commands",
        "a full reversal from one sample to the next",
        "the opening follows at the limit of its rate (`opening_time`)",
        fastest_share_of_the_limit=fastest,
    )


def test_a_valve_that_was_closed_opens_after_neutral_only(ros, excavator, operators):
    simulator = Simulator(ros, excavator, rate=RATE, command_timeout=None, under="/neutral_first")
    told = Diagnostics(ros, simulator.node)
    operator = operators("/neutral_first/orifice_command")
    open_by(ros, simulator, operator, AREA)
    operator.fall_silent()
    until_area(ros, simulator, 0.0)
    before = len(simulator.states)

    def is_refused():
        operator.send(command(arm=AREA))
        return told.count("refusal", "refused: neutral first") >= 20

    ros.spin_until(is_refused, "20 commands to be refused")
    assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states[before:])
    ros.spin_until(lambda: told.says("refusal", "command an area of 0 first"), "the diagnostic")
    open_by(ros, simulator, operator, AREA)
    survived("Commands", "the first command after the lease ran out", "refused until an area of 0 was commanded")


def test_a_stop_closes_and_needs_release_and_neutral(ros, simulator, operators, diagnostics):
    operator, panel = operators(), ros.publisher(Bool, "/arm/stop")
    open_by(ros, simulator, operator, AREA)
    before, stopped_at = len(simulator.states), simulator.time
    panel.publish(Bool(data=True))
    # under an operator who goes on, and whose lease lasts for long
    until_area(ros, simulator, 0.0)
    closed = next(state for state in simulator.states[before:] if cylinder(state).orifice_area == 0.0)
    took = seconds(closed.header.stamp) - stopped_at
    operator.command(arm=AREA)
    ros.spin_until(lambda: diagnostics.says("commands", "stopped by /checker"), "the diagnostic about the stop")
    refused = diagnostics.count("refusal", "refused: stopped")
    ros.spin_until(lambda: diagnostics.count("refusal", "refused: stopped") > refused + 5, "commands to be refused")
    assert simulator.area() == 0.0
    early = diagnostics.count("refusal", "refused: neutral first")
    panel.publish(Bool(data=False))
    ros.spin_until(lambda: not is_stopped(diagnostics), "the release")
    ros.spin_until(lambda: diagnostics.count("refusal", "refused: neutral first") > early + 5, "commands to be refused")
    simulator.next(50)
    assert simulator.area() == 0.0, "the operator still holds the lever"
    open_by(ros, simulator, operator, AREA)
    survived(
        "Commands",
        "`true` on `/arm/stop` under an open valve",
        "the valve closes by its ramp; it opens after release and neutral",
        closed_after_ms=1e3 * took,
    )


def test_refusals_are_said_once(ros, simulator, operators, diagnostics):
    lines = []
    ros.listen_with(Log, "/rosout", lambda log: lines.append(log.msg), 1000)
    ros.known_to("/arm_simulator")
    operator = operators()

    def are_refused():
        operator.send(command(tail=AREA))
        return diagnostics.count("refusal", "refused: malformed") >= 100

    ros.spin_until(are_refused, "100 refusals to be counted")
    ros.spin_until(lambda: any("tail" in line for line in lines), "a line in the log")
    # twice as many, and no further line
    before = diagnostics.count("refusal", "refused: malformed")
    ros.spin_until(lambda: are_refused() and diagnostics.count("refusal", "refused: malformed") >= 2 * before, "as many again")
    assert sum("tail" in line for line in lines) == 1


@pytest.mark.full
def test_refusals_clear_themselves(ros, simulator, operators, diagnostics):
    operators().send(command(tail=AREA))
    ros.spin_until(lambda: diagnostics.says("refusal", "tail"), "a diagnostic about the refusal")
    clear = "no command was refused lately"
    ros.spin_until(lambda: diagnostics.says("refusal", clear, DiagnosticStatus.OK), "the status to clear")


def test_only_named_writers_command(ros, excavator):
    simulator = Simulator(ros, excavator, rate=RATE, under="/own", arguments=["-p", "command_writers:=['/checker']"])
    told = Diagnostics(ros, simulator.node)
    stranger = rclpy.create_node("stranger", context=ros.node.context, start_parameter_services=False)
    publisher = stranger.create_publisher(OrificeCommand, "/own/orifice_command", 10)
    ros.spin_until(lambda: publisher.get_subscription_count() > 0, "the subscription")

    def is_refused():
        publisher.publish(neutral(["arm"]))
        publisher.publish(command(arm=AREA))
        by_name = told.says("refusal", "/stranger is not among the command_writers")
        return by_name and told.count("refusal", "refused: writer not allowed") >= 20

    ros.spin_until(is_refused, "20 commands to be refused, and the name of the stranger")
    assert all(cylinder(state).orifice_area == 0.0 for state in simulator.states)
    simulator.open_until(arm=AREA)
    stranger.destroy_node()
    assert simulator.process.interrupt() == 0, simulator.process.output()
    survived("Commands", "a node that is not on the list `command_writers` commands", "refused, with its name")


def test_a_second_simulator_is_noticed(ros, excavator, simulator, diagnostics):
    second = ros.start(
        excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=100.0", "-r", "__node:=second_simulator"
    )
    ros.spin_until(lambda: diagnostics.says("machine", "/second_simulator"), "a diagnostic that names the other one")
    assert second.interrupt() == 0
    ros.spin_until(lambda: diagnostics.says("machine", "no other node", DiagnosticStatus.OK), "the status to clear")
    survived("Commands", "two simulators on the same topics", "each says which other node publishes the machine's state")


@pytest.mark.parametrize("how", [pytest.param(signal.SIGKILL, marks=pytest.mark.full), signal.SIGABRT])
def test_valves_close_when_the_node_dies(ros, excavator, how):
    """The machine has a process of its own: no packet reaches it, and it closes when its node has gone."""
    simulator = Simulator(ros, excavator, rate=1000.0, under=f"/dies_{how}", qos=NEWEST_QOS)
    simulator.open_until(arm=AREA)
    os.kill(simulator.process.pid, how)
    simulator.process.wait()

    def closed():
        return re.search(r"every valve was closed ([0-9.]+) s later", simulator.process.output())

    ros.spin_until(closed, "the machine to close its valves")
    took = float(closed().group(1))
    assert took < GIVES_UP
    if how == signal.SIGABRT:
        survived(
            "Commands",
            "the simulator's process is killed (kill -9, abort) with an open valve, at 1 kHz",
            "the machine's own process closes every valve by its ramp",
            closed_after_ms=1e3 * took,
        )


@pytest.mark.full
def test_valves_close_while_the_node_hangs(ros, excavator):
    simulator = Simulator(ros, excavator, rate=RATE, command_timeout=1.0, under="/hangs")
    (machine,) = simulator.process.children()
    # what the lease takes, and several times what a fully open valve takes
    enough = round(simulator.rate * (10 * CLOSING))

    def hang():
        """Areas from the open valve to the first states after the hang."""
        simulator.open_until(arm=AREA)
        before = len(simulator.states)
        with stopped(simulator.process):
            # alone, it sleeps once per sample
            slept = machine.times_slept()
            ros.spin_until(lambda: machine.times_slept() > slept + enough, "the machine to go on alone")
        ros.spin_until(lambda: simulator.area() == 0.0, "the valve to be closed")
        simulator.next(50)
        return [cylinder(state).orifice_area for state in simulator.states[before:]]

    def is_closed_meanwhile():
        """Nothing is seen between open and closed. On a busy machine the lease may run out before the hang, and that is seen."""
        areas = hang()
        return areas == sorted(areas, reverse=True) and all(area in (0.0, pytest.approx(AREA)) for area in areas)

    assert any(is_closed_meanwhile() for _ in range(5))
    survived(
        "Commands",
        "the simulator's process hangs (SIGSTOP) with an open valve",
        "the machine closes it meanwhile; it is closed when the node goes on",
    )
