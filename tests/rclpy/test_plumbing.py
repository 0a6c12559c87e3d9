"""The tests' own plumbing between two Python programs: what fails here is not the fault of the nodes."""

from pathlib import Path

import pytest
from action_msgs.msg import GoalStatus
from action_msgs.srv import CancelGoal
from excavator_msgs.action import Identify
from rcl_interfaces.srv import GetParameters
from rclpy.action import get_action_names_and_types
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from std_msgs.msg import String

pytestmark = pytest.mark.middleware

PEER = Path(__file__).parent / "support" / "peer.py"


@pytest.fixture(scope="module", autouse=True)
def peer(ros):
    process = ros.start_python(PEER)
    ros.spin_until(lambda: "peer" in ros.node.get_node_names(), "the peer")
    yield process
    process.interrupt()


def test_a_message_goes_there_and_back(ros):
    answers = ros.listen(String, "/peer/echo")
    publisher = ros.publisher(String, "/peer/call")
    text = "30° über Null, \u6cb9\u5727"
    ros.spin_until(lambda: publisher.publish(String(data=text)) or answers, "the echo of a message")
    assert answers[0].data == text


def test_reliable_messages_come_all_and_in_order(ros):
    ticks = ros.listen(String, "/peer/ticks", 1000)
    ros.spin_until(lambda: len(ticks) >= 20, "twenty messages")
    numbers = [int(tick.data) for tick in ticks]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


@pytest.mark.parametrize(
    ("topic", "profile", "heard"),
    [
        ("/peer/ticks", QoSProfile(depth=10), True),
        ("/peer/ticks", qos_profile_sensor_data, True),
        ("/peer/loose_ticks", qos_profile_sensor_data, True),
        ("/peer/loose_ticks", QoSProfile(depth=10), False),
        ("/peer/ticks", QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL), False),
    ],
)
def test_incompatible_profiles_do_not_talk(ros, topic, profile, heard):
    messages = ros.listen(String, topic, profile)
    if heard:
        ros.spin_until(lambda: messages, f"a message on {topic}")
    else:
        # another reader, announced after it, hears the topic
        loose = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
        others = ros.listen(String, topic, loose)
        ros.spin_until(lambda: len(others) >= 20, f"messages on {topic} for another reader")
        assert not messages


def test_a_late_reader_gets_the_latched_message(ros):
    messages = ros.listen(String, "/peer/latched", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    ros.spin_until(lambda: messages, "the latched message")
    assert [message.data for message in messages] == ["kept"]


def test_a_service_answers_every_client_its_own_question(ros):
    clients = [ros.client(GetParameters, "/peer/get_parameters") for _ in range(3)]
    futures = [
        (name, client.call_async(GetParameters.Request(names=[name, "both"])))
        for client, name in zip(clients, "abc", strict=True)
        for _ in range(3)  # every client hears all replies, and a service keeps ten
    ]
    for name, future in futures:
        values = ros.result(future, "a reply").values
        assert [value.string_value for value in values] == [name, "both"]


def test_an_action_gives_feedback_and_a_result(ros):
    client = ros.action_client(Identify, "/peer/run")
    goal = Identify.Goal(model="m", bags=["a", "four"])
    early = []
    # The feedback of the first goals may go where our reader is not seen yet.
    ros.spin_until(
        lambda: early or ros.result(client.send_goal_async(goal, feedback_callback=early.append), "an answer") and early,
        "any feedback",
    )
    feedback = []
    handle = ros.result(client.send_goal_async(goal, feedback_callback=feedback.append), "the answer to a goal")
    assert handle.accepted
    ros.spin_until(lambda: len(feedback) == 3, "the feedback")
    assert [message.feedback.stage for message in feedback] == ["step 0", "step 1", "step 2"]
    assert feedback[1].feedback.progress == 0.5
    answer = ros.result(handle.get_result_async(), "the result")
    assert answer.status == GoalStatus.STATUS_SUCCEEDED
    assert answer.result.success and answer.result.message == "m"
    assert list(answer.result.nmse_after) == [1.0, 4.0]
    ros.spin_until(lambda: handle.status == GoalStatus.STATUS_SUCCEEDED, "the status")


def test_an_action_refuses_and_cancels(ros):
    client = ros.action_client(Identify, "/peer/run")
    handle = ros.result(client.send_goal_async(Identify.Goal(model="m")), "the answer to a goal without bags")
    assert not handle.accepted
    handle = ros.result(client.send_goal_async(Identify.Goal(model="m", bags=["a"])), "the answer to a goal")
    answer = ros.result(handle.cancel_goal_async(), "the answer to a cancel request")
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert bytes(answer.goals_canceling[0].goal_id.uuid) == bytes(handle.goal_id.uuid)
    assert ros.result(handle.get_result_async(), "the result").status == GoalStatus.STATUS_CANCELED


def test_the_graph_shows_the_peer(ros):
    node = ros.node

    def shows(what, found):
        """Endpoints are announced one by one."""
        ros.spin_until(found, what)

    string = ["std_msgs/msg/String"]
    shows("the node", lambda: ("peer", "/") in node.get_node_names_and_namespaces())
    shows("a topic", lambda: ("/peer/ticks", string) in node.get_topic_names_and_types())
    shows("a publisher", lambda: ("/peer/latched", string) in node.get_publisher_names_and_types_by_node("peer", "/"))
    shows("a subscription", lambda: ("/peer/call", string) in node.get_subscriber_names_and_types_by_node("peer", "/"))
    assert "/peer/call" not in dict(node.get_publisher_names_and_types_by_node("peer", "/"))
    service = ("/peer/get_parameters", ["rcl_interfaces/srv/GetParameters"])
    shows("a service", lambda: service in node.get_service_names_and_types_by_node("peer", "/"))
    shows("an action", lambda: ("/peer/run", ["excavator_msgs/action/Identify"]) in get_action_names_and_types(node))

    def infos():
        return node.get_publishers_info_by_topic("/peer/loose_ticks")

    shows("the owner of a publisher", lambda: [info.node_name for info in infos()] == ["peer"])
    (info,) = infos()
    assert [info.topic_type] == string
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT


def test_a_node_that_ends_leaves_the_graph(ros, peer):
    assert peer.interrupt() == 0
    ros.spin_until(lambda: "peer" not in ros.node.get_node_names(), "the peer to leave")
    ros.spin_until(lambda: ros.node.count_publishers("/peer/ticks") == 0, "its topic to be without a publisher")
