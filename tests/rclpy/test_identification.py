"""The action /identification/run: from goal to result, with feedback, refusal and cancel, and never in others' way."""

import subprocess
import tomllib

import pytest
from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from excavator_msgs.action import Identify
from rcl_interfaces.srv import ListParameters
from support.waiting import LONGEST_WAIT

pytestmark = pytest.mark.middleware

PROFILE = """
rate = {rate}
[[profiles]]
cylinder = "arm"
segments = [
  {{ kind = "sine", duration = {long}, amplitude = 6e-5, frequency = 0.5 }},
  {{ kind = "sweep", duration = {long}, amplitude = 4e-5, from_frequency = 0.3, to_frequency = 3.0 }},
  {{ kind = "trapezoid", duration = 2.0, amplitude = 5e-5, ramp = 0.2 }},
  {{ kind = "trapezoid", duration = 2.0, amplitude = -5e-5, ramp = 0.2 }},
]
"""
DAMPING = 20000.0  # N s/m; zx30u-arm starts from 13000


@pytest.fixture(scope="module")
def bags(excavator, model, tmp_path_factory):
    """Recordings of an arm with more damping than the model says: a short one and a long one."""
    folder = tmp_path_factory.mktemp("identification")
    machine = folder / "machine.toml"
    text = model.read_text()
    assert text.count("value = 13000.0") == 1
    machine.write_text(text.replace("value = 13000.0", f"value = {DAMPING}"))
    made = {}
    for name, rate, long in (("short", 200.0, 4.0), ("long", 1000.0, 60.0)):
        profile = folder / f"{name}.toml"
        profile.write_text(PROFILE.format(rate=rate, long=long))
        made[name] = folder / name
        subprocess.run(
            [excavator, "simulate", "--model", machine, "--input", profile, "-o", made[name]],
            check=True, capture_output=True, timeout=LONGEST_WAIT,
        )  # fmt: skip
    return made


@pytest.fixture(scope="module")
def identification(ros, excavator, bags):
    folder = bags["short"].parent
    return ros.start(excavator, "node", "identification", "--ros-args", "-p", f"bag_folder:={folder}")


@pytest.fixture(scope="module")
def action(ros, identification):
    client = ros.action_client(Identify, "/identification/run")
    # no feedback and no answer goes where it is not heard yet
    ros.known_to("/identification")
    return client


def accepted(ros, action, goal, feedback=None):
    handle = ros.result(action.send_goal_async(goal, feedback_callback=feedback), "the answer to a goal")
    assert handle.accepted
    return handle


def test_from_goal_to_result(ros, action, bags):
    told = []
    goal = Identify.Goal(model="zx30u-arm", bags=["short"])
    handle = accepted(ros, action, goal, lambda message: told.append(message.feedback))
    answer = ros.result(handle.get_result_async(), "the result")
    assert answer.status == GoalStatus.STATUS_SUCCEEDED, answer.result.message
    result = answer.result
    assert result.success and result.message

    identified = {
        f"{effect['at']}.{name}": entry["value"]
        for effect in tomllib.loads(result.model)["effects"]
        for name, entry in effect["parameters"].items()
    }
    assert identified["arm.viscous_damping"] == pytest.approx(DAMPING, rel=0.02)
    assert identified["arm.inertia"] == pytest.approx(230.0, rel=0.05)

    assert len(result.signals) == len(result.nmse_before) == len(result.nmse_after)
    assert {"arm.displacement", "arm.velocity", "arm.cap_pressure", "arm.rod_pressure"} <= set(result.signals)
    before, after = (dict(zip(result.signals, table)) for table in (result.nmse_before, result.nmse_after))
    assert after["arm.velocity"] < 0.1 * before["arm.velocity"]

    assert told, "no feedback"
    progress = [feedback.progress for feedback in told]
    assert progress == sorted(progress) and progress[0] >= 0.0 and progress[-1] <= 1.0
    assert all(feedback.stage for feedback in told)


def test_effects_are_added(ros, action, bags):
    goal = Identify.Goal(model="zx30u-arm", bags=["short"], effects=["stribeck_friction@arm"])
    handle = accepted(ros, action, goal)
    answer = ros.result(handle.get_result_async(), "the result")
    assert answer.result.success, answer.result.message
    effects = [(effect["effect"], effect["at"]) for effect in tomllib.loads(answer.result.model)["effects"]]
    assert ("stribeck_friction", "arm") in effects


@pytest.mark.parametrize(
    ("goal", "word"),
    [
        (Identify.Goal(model="zx30u-arm", bags=["/no/such/bag"]), "/no/such/bag"),
        (Identify.Goal(model="no-such-model", bags=["/no/such/bag"]), "no-such-model"),
        (Identify.Goal(model="zx30u-arm", bags=["short"], effects=["no_such_effect"]), "no_such_effect"),
        (Identify.Goal(model="zx30u-arm", bags=[]), "bag"),
    ],
    ids=["no such bag", "no such model", "no such effect", "no bags"],
)
def test_what_cannot_be_done_is_refused_or_fails_with_a_reason(ros, action, goal, word):
    handle = ros.result(action.send_goal_async(goal), "the answer to a goal")
    if not handle.accepted:
        return
    answer = ros.result(handle.get_result_async(), "the result")
    assert answer.status == GoalStatus.STATUS_ABORTED
    assert not answer.result.success and not answer.result.model
    assert word in answer.result.message


@pytest.mark.parametrize(
    "name", ["../short", *(pytest.param(name, marks=pytest.mark.full) for name in ("/etc/passwd", "nothing"))]
)
def test_files_outside_the_folder_are_not_there(ros, action, bags, name):
    absolute = str(bags["short"])
    messages = set()
    for bag in (name, absolute):
        handle = accepted(ros, action, Identify.Goal(model="zx30u-arm", bags=[bag]))
        answer = ros.result(handle.get_result_async(), "the result")
        assert answer.status == GoalStatus.STATUS_ABORTED
        messages.add(answer.result.message.replace(bag, "NAME"))
    assert len(messages) == 1 and "bag_folder" in messages.pop()
    handle = accepted(ros, action, Identify.Goal(model=name, bags=["short"]))
    answer = ros.result(handle.get_result_async(), "the result")
    assert answer.status == GoalStatus.STATUS_ABORTED and "model_folder" in answer.result.message


def test_cancel_ends_the_work(ros, action, bags):
    handle = accepted(ros, action, Identify.Goal(model="zx30u-arm", bags=["long"] * 4))
    result = handle.get_result_async()
    answer = ros.result(handle.cancel_goal_async(), "the answer to a cancel request")
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert [bytes(goal.goal_id.uuid) for goal in answer.goals_canceling] == [bytes(handle.goal_id.uuid)]
    answer = ros.result(result, "the result of a cancelled goal")
    assert answer.status == GoalStatus.STATUS_CANCELED
    assert not answer.result.success and not answer.result.model


def test_a_cancelled_goal_cannot_be_cancelled_again(ros, action, bags):
    handle = accepted(ros, action, Identify.Goal(model="zx30u-arm", bags=["short"]))
    ros.result(handle.get_result_async(), "the result")
    answer = ros.result(handle.cancel_goal_async(), "the answer to a cancel request")
    assert answer.return_code in (
        CancelGoal.Response.ERROR_GOAL_TERMINATED,
        CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID,
    )
    assert not answer.goals_canceling


def test_the_work_does_not_block_other_traffic(ros, action, bags):
    client = ros.client(ListParameters, "/identification/list_parameters")
    ros.ask(client, ListParameters.Request())
    handle = accepted(ros, action, Identify.Goal(model="zx30u-arm", bags=["long"] * 4))
    result = handle.get_result_async()
    replies = 0
    try:
        for _ in range(10):
            reply = ros.result(client.call_async(ListParameters.Request()), "a reply of the node at work")
            assert reply.result.names
            if result.done():
                break
            replies += 1
    finally:
        ros.result(handle.cancel_goal_async(), "the answer to a cancel request")
    assert replies, "the first question was answered after the work was done"
    ros.result(result, "the end")
