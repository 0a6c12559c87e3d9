"""A managed simulator waits for `ros2 lifecycle`: nothing is published and nobody is followed until it is active."""

import pytest
from excavator_msgs.msg import ArmState, OrificeCommand
from support.diagnostics import Diagnostics
from support.simulator import COMMAND_AGE, COMMAND_QOS, COMMAND_TIMEOUT, STATE_QOS, command, cylinder, neutral, stamped

lifecycle_msgs = pytest.importorskip("lifecycle_msgs.srv", reason="lifecycle_msgs is not installed")
from lifecycle_msgs.msg import Transition, TransitionEvent  # noqa: E402
from lifecycle_msgs.srv import (  # noqa: E402
    ChangeState,
    GetAvailableStates,
    GetAvailableTransitions,
    GetState,
)

AREA = 5e-5


@pytest.fixture(scope="module")
def simulator(ros, excavator):
    limits = ["-p", f"command_timeout:={COMMAND_TIMEOUT}", "-p", f"command_max_age:={COMMAND_AGE}"]
    words = ["--ros-args", "-p", "rate:=200.0", "-p", "managed:=true", *limits]
    return ros.start(excavator, "node", "arm-simulator", *words)


@pytest.fixture(scope="module")
def changes(ros, simulator):
    """A client that the node has answered: it asks once for each change, since the second time it would be refused."""
    client = ros.client(ChangeState, "/arm_simulator/change_state")
    refused = ros.ask(client, ChangeState.Request(transition=Transition(id=Transition.TRANSITION_DEACTIVATE)))
    assert not refused.success
    return client


def state(ros):
    return ros.call(GetState, "/arm_simulator/get_state", GetState.Request()).current_state.label


def change(ros, changes, number):
    request = ChangeState.Request(transition=Transition(id=number))
    return ros.result(changes.call_async(request), "the answer to a change").success


def test_the_graph_of_states_is_that_of_lifecycle_nodes(ros, simulator):
    assert state(ros) == "unconfigured"
    states = ros.call(GetAvailableStates, "/arm_simulator/get_available_states", GetAvailableStates.Request())
    assert [one.label for one in states.available_states] == ["unconfigured", "inactive", "active", "finalized"]
    request = GetAvailableTransitions.Request()
    possible = ros.call(GetAvailableTransitions, "/arm_simulator/get_available_transitions", request)
    assert {one.transition.label for one in possible.available_transitions} == {"configure", "shutdown"}
    graph = ros.call(GetAvailableTransitions, "/arm_simulator/get_transition_graph", request)
    assert len(graph.available_transitions) == 7


def test_it_works_while_it_is_active_and_only_then(ros, simulator, changes):
    states = ros.listen(ArmState, "/arm/state", STATE_QOS)
    events = ros.listen(TransitionEvent, "/arm_simulator/transition_event")
    commands = ros.publisher(OrificeCommand, "/arm/orifice_command", COMMAND_QOS)
    ros.known_to("/arm_simulator")
    told = Diagnostics(ros)
    assert not change(ros, changes, Transition.TRANSITION_ACTIVATE)
    assert change(ros, changes, Transition.TRANSITION_CONFIGURE) and state(ros) == "inactive"
    told.next(1)
    assert not states
    assert change(ros, changes, Transition.TRANSITION_ACTIVATE) and state(ros) == "active"
    ros.spin_until(lambda: states, "a state of the active simulator")

    def opens():
        commands.publish(stamped(neutral(["arm"])))
        commands.publish(stamped(command(arm=AREA)))
        return cylinder(states[-1]).orifice_area == pytest.approx(AREA)

    ros.spin_until(opens, "the valve to open")
    assert change(ros, changes, Transition.TRANSITION_DEACTIVATE)
    ros.spin_until(lambda: len(events) >= 3, "the events")

    def is_silent():
        """After what was under way: while the node says twice how it is, no state comes."""
        heard = len(states)
        told.next(2)
        return len(states) == heard

    ros.spin_until(is_silent, "the end of the states")
    heard = len(states)
    refused = told.count("refusal", "refused: not active")
    commands.publish(stamped(command(arm=AREA)))
    ros.spin_until(lambda: told.count("refusal", "refused: not active") > refused, "the command to be refused")
    assert state(ros) == "inactive"
    assert len(states) == heard
    assert change(ros, changes, Transition.TRANSITION_ACTIVATE)
    ros.spin_until(lambda: len(states) > heard + 5, "a state after the pause")
    assert cylinder(states[-1]).orifice_area == 0.0
    assert [event.goal_state.label for event in events[:3]] == ["inactive", "active", "inactive"]


def test_shutdown_ends_it(ros, simulator, changes):
    assert change(ros, changes, Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert simulator.wait() == 0, simulator.output()


def test_a_node_that_nobody_manages_has_no_such_services(ros, excavator):
    process = ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=50.0", "-r", "__ns:=/free")
    ros.hear(ArmState, "/free/arm/state")

    def services():
        return {name for name, _ in ros.node.get_service_names_and_types() if name.startswith("/free")}

    # those of the life cycle would be announced before the node is ready
    ros.known_to("/free/arm_simulator")
    ros.spin_until(lambda: "/free/arm_simulator/get_parameters" in services(), "the services of the node")
    assert not {name for name in services() if "state" in name}
    process.interrupt()
