"""A managed simulator waits for `ros2 lifecycle`: nothing is published and nobody is followed until it is active."""

import pytest
from excavator_msgs.msg import ArmState, OrificeCommand
from support.simulator import STATE_QOS, command, cylinder, neutral, stamped

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
    words = ["--ros-args", "-p", "rate:=200.0", "-p", "managed:=true", "-p", "command_timeout:=1.0"]
    return ros.start(excavator, "node", "arm-simulator", *words)


def state(ros):
    return ros.call(GetState, "/arm_simulator/get_state", GetState.Request()).current_state.label


def change(ros, number):
    request = ChangeState.Request(transition=Transition(id=number))
    return ros.call(ChangeState, "/arm_simulator/change_state", request, attempts=1).success


def test_the_graph_of_states_is_that_of_lifecycle_nodes(ros, simulator):
    assert state(ros) == "unconfigured"
    states = ros.call(GetAvailableStates, "/arm_simulator/get_available_states", GetAvailableStates.Request())
    assert [one.label for one in states.available_states] == ["unconfigured", "inactive", "active", "finalized"]
    request = GetAvailableTransitions.Request()
    possible = ros.call(GetAvailableTransitions, "/arm_simulator/get_available_transitions", request)
    assert {one.transition.label for one in possible.available_transitions} == {"configure", "shutdown"}
    graph = ros.call(GetAvailableTransitions, "/arm_simulator/get_transition_graph", request)
    assert len(graph.available_transitions) == 7


def test_it_works_while_it_is_active_and_only_then(ros, simulator):
    states = ros.listen(ArmState, "/arm/state", STATE_QOS)
    events = ros.listen(TransitionEvent, "/arm_simulator/transition_event")
    commands = ros.publisher(OrificeCommand, "/arm/orifice_command")
    assert not change(ros, Transition.TRANSITION_ACTIVATE)
    assert change(ros, Transition.TRANSITION_CONFIGURE) and state(ros) == "inactive"
    assert not states
    assert change(ros, Transition.TRANSITION_ACTIVATE) and state(ros) == "active"
    ros.spin_until(lambda: states, "a state of the active simulator")

    def opens():
        commands.publish(stamped(neutral(["arm"])))
        commands.publish(stamped(command(arm=AREA)))
        return cylinder(states[-1]).orifice_area == pytest.approx(AREA)

    ros.spin_until(opens, "the valve to open")
    assert change(ros, Transition.TRANSITION_DEACTIVATE)
    # what was under way
    ros.spin_until(lambda: len(events) >= 3, "the events")
    heard = len(states)
    commands.publish(stamped(command(arm=AREA)))
    assert state(ros) == "inactive"
    assert len(states) <= heard + 1
    assert change(ros, Transition.TRANSITION_ACTIVATE)
    ros.spin_until(lambda: len(states) > heard + 5, "a state after the pause")
    assert cylinder(states[-1]).orifice_area == 0.0
    assert [event.goal_state.label for event in events[:3]] == ["inactive", "active", "inactive"]


def test_shutdown_ends_it(ros, simulator):
    assert change(ros, Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert simulator.wait(30.0) == 0, simulator.output()


def test_a_node_that_nobody_manages_has_no_such_services(ros, excavator):
    process = ros.start(excavator, "node", "arm-simulator", "--ros-args", "-p", "rate:=50.0", "-r", "__ns:=/free")
    states = ros.listen(ArmState, "/free/arm/state")
    ros.spin_until(lambda: states, "a state of a simulator that works at once")
    services = {name for name, _ in ros.node.get_service_names_and_types()}
    assert "/free/arm_simulator/get_parameters" in services
    assert not {name for name in services if name.startswith("/free") and "state" in name}
    process.interrupt()
