"""What is recorded is what was published, and what is played is what was recorded. The judge is PyPI's rosbags."""

import math
import tomllib

import pytest
from excavator_msgs.msg import ArmState
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.session import LONGEST_WAIT
from support.simulator import STATE_QOS, Simulator, cylinder

rosbags_rosbag2 = pytest.importorskip("rosbags.rosbag2", reason="PyPI's rosbags is not installed")

RATE = 250.0
TOPICS = ["/arm/state", "/arm/orifice_command", "/arm/model", "/joint_states"]
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def key(message):
    return message.header.stamp.sec, message.header.stamp.nanosec


def numbers(state):
    """All numbers of a state, whichever library made the object; NaN as None, since it is not equal to itself."""
    values = [state.pump_pressure, state.tank_pressure, state.pump_flow, state.oil_temperature]
    for one in state.cylinders:
        values += [one.joint_angle, one.displacement, one.velocity, one.cap_pressure]
        values += [one.rod_pressure, one.orifice_area, one.rod_force]
    return [None if math.isnan(value) else float(value) for value in values]


def travel(states):
    """How far the piston moved while the valve was open outwards, m; missing values are left out. On the way back it
    moves for as long as the last command holds, which is after the end of the bag."""
    positions = [cylinder(state).displacement for state in states if cylinder(state).orifice_area > 0.9e-4]
    positions = [position for position in positions if not math.isnan(position)]
    return max(positions) - min(positions)


def read(bag):
    """topic -> messages in the order of the bag, decoded with the definitions that are in the bag."""
    from rosbags.highlevel import AnyReader

    found = {}
    with AnyReader([bag]) as reader:
        for connection, _, data in reader.messages():
            found.setdefault(connection.topic, []).append(reader.deserialize(data, connection.msgtype))
    return found


@pytest.fixture(scope="module")
def recorded(ros, excavator, tmp_path_factory):
    """(bag, states that the test itself heard), while the arm moved; with noise and missing values."""
    bag = tmp_path_factory.mktemp("bags") / "motion"
    simulator = Simulator(
        ros, excavator, rate=RATE, arguments=["-p", "pressure_noise:=2000.0", "-p", "dropout_probability:=0.02"]
    )
    recorder = ros.start(excavator, "record", "-o", bag, "--max-bag-duration", "0.5", *TOPICS)
    for topic in TOPICS:
        readers = 1 if topic != "/arm/state" else 2  # we listen too
        ros.spin_until(
            lambda topic=topic, readers=readers: ros.node.count_subscribers(topic) >= readers,
            f"the recorder on {topic}",
        )
    simulator.next(75)
    states = simulator.hold(0.8, arm=1e-4) + simulator.hold(0.8, arm=-1e-4)
    simulator.next(75)
    assert recorder.interrupt() == 0, recorder.output()
    assert simulator.process.interrupt() == 0
    return bag, states


def test_the_bag_has_what_was_asked_for(recorded):
    bag, _ = recorded
    with rosbags_rosbag2.Reader(bag) as reader:
        types = {connection.topic: connection.msgtype for connection in reader.connections}
        assert types == {
            "/arm/state": "excavator_msgs/msg/ArmState",
            "/arm/orifice_command": "excavator_msgs/msg/OrificeCommand",
            "/arm/model": "std_msgs/msg/String",
            "/joint_states": "sensor_msgs/msg/JointState",
        }
        assert reader.duration > 1.5e9
        assert all(connection.msgcount > 0 for connection in reader.connections)
    assert (bag / "metadata.yaml").is_file()


def test_the_bag_goes_on_in_another_file_when_one_is_long_enough(recorded):
    bag, _ = recorded
    files = sorted(path.name for path in bag.glob("*.mcap"))
    assert files == [f"{bag.name}_{number}.mcap" for number in range(len(files))]
    with rosbags_rosbag2.Reader(bag) as reader:
        assert len(files) == pytest.approx(reader.duration * 1e-9 / 0.5, abs=1)


def test_no_state_is_lost_and_none_is_changed(recorded):
    bag, heard = recorded
    in_bag = {key(state): numbers(state) for state in read(bag)["/arm/state"]}
    assert len(heard) > RATE
    missing = [key(state) for state in heard if key(state) not in in_bag]
    assert not missing
    assert all(in_bag[key(state)] == numbers(state) for state in heard)
    assert any(None in values for values in in_bag.values())  # dropouts came through as NaN


def test_latched_topics_are_recorded_though_they_were_published_before(recorded):
    bag, _ = recorded
    (model,) = read(bag)["/arm/model"]
    assert tomllib.loads(model.data)["machine"]["name"] == "zx30u-arm"


def test_log_times_follow_the_stamps(recorded):
    bag, _ = recorded
    from rosbags.highlevel import AnyReader

    with AnyReader([bag]) as reader:
        states = [connection for connection in reader.connections if connection.topic == "/arm/state"]
        delays = []
        for connection, log_time, data in reader.messages(states):
            stamp = reader.deserialize(data, connection.msgtype).header.stamp
            delays.append(log_time - (stamp.sec * 10**9 + stamp.nanosec))
    # stamped with the time of the sample, logged when it came
    assert sorted(delays)[len(delays) // 2] < 50e6
    assert min(delays) > -5e6


@pytest.fixture(scope="module")
def played(ros, excavator, recorded):
    """(states, joint states, expected of both): what came over the network, and what was in the bag."""
    bag, _ = recorded
    expected = read(bag)
    mark = ros.mark()
    states = ros.listen(ArmState, "/again/state", STATE_QOS)
    joints = ros.listen(JointState, "/joint_states", 200)
    player = ros.start(excavator, "play", bag, "--delay", "3", "--remap", "/arm/state:=/again/state")
    ros.spin_until(lambda: ros.node.count_publishers("/again/state") == 1, "the player")
    ros.spin_until(lambda: not player.running(), "the end of the bag")
    assert player.wait(1.0) == 0, player.output()
    for heard, wanted in ((states, expected["/arm/state"]), (joints, expected["/joint_states"])):
        ros.spin_until(lambda: heard and key(heard[-1]) == key(wanted[-1]), "the last message of the bag")  # noqa: B023
    ros.release(mark)
    return states, joints, expected["/arm/state"], expected["/joint_states"]


def test_what_is_played_is_what_was_recorded(played):
    """Every message after the first of its topic, in order; the first has a test of its own."""
    states, joints, recorded_states, recorded_joints = played
    first = [key(state) for state in states].index(key(recorded_states[1]))
    assert [key(state) for state in states[first:]] == [key(state) for state in recorded_states[1:]]
    assert [numbers(state) for state in states[first:]] == [numbers(state) for state in recorded_states[1:]]
    first = [key(joint) for joint in joints].index(key(recorded_joints[1]))
    assert [key(joint) for joint in joints[first:]] == [key(joint) for joint in recorded_joints[1:]]
    assert list(joints[-1].position) == list(recorded_joints[-1].position)
    assert list(joints[-1].name) == ["arm_joint"]


def test_the_first_message_of_a_topic_is_played_too(played):
    """The readers were there three seconds before it."""
    states, joints, recorded_states, recorded_joints = played
    assert key(states[0]) == key(recorded_states[0])
    assert key(joints[0]) == key(recorded_joints[0])


def test_a_latched_topic_is_latched_again(ros, excavator, recorded):
    bag, _ = recorded
    player = ros.start(excavator, "play", bag, "--topics", "/arm/model", "/arm/state", "--delay", "0.1")
    states = ros.listen(ArmState, "/arm/state", STATE_QOS)
    ros.spin_until(lambda: states, "the player")
    models = ros.listen(String, "/arm/model", LATCHED)  # after the model was played
    try:
        ros.spin_until(lambda: models, "the model")
        assert "zx30u-arm" in models[0].data
    finally:
        player.interrupt()


def test_twice_as_fast_takes_half_the_time(ros, excavator, recorded):
    bag, _ = recorded
    last_in_bag = key(read(bag)["/arm/state"][-1])
    received = []

    def take(state):
        received.append((ros.node.get_clock().now().nanoseconds * 1e-9, state))

    subscription = ros.node.create_subscription(ArmState, "/arm/state", take, STATE_QOS)
    try:
        player = ros.start(excavator, "play", bag, "--rate", "2", "--delay", "2", "--topics", "/arm/state")
        ros.spin_until(lambda: received and key(received[-1][1]) == last_in_bag, "the last state of the bag")
        ros.spin_until(lambda: not player.running(), "the end of the bag")
    finally:
        ros.node.destroy_subscription(subscription)
    (begin, first), (end, last) = received[0], received[-1]
    recorded_time = (key(last)[0] - key(first)[0]) + (key(last)[1] - key(first)[1]) * 1e-9
    # a busy machine may be late with the last one
    assert 0.4 * recorded_time < end - begin < 0.75 * recorded_time


def test_played_commands_move_the_simulator(ros, excavator, recorded):
    """A recording of commands is enough to repeat a motion."""
    bag, _ = recorded
    simulator = Simulator(ros, excavator, rate=RATE)
    player = ros.start(excavator, "play", bag, "--topics", "/arm/orifice_command", "--delay", "1.5")
    before = len(simulator.states)
    ros.spin_until(lambda: not player.running(), "the end of the bag")
    ros.spin_until(lambda: cylinder(simulator.last).orifice_area == pytest.approx(-1e-4), "the last command")
    simulator.next(75)
    areas = [cylinder(state).orifice_area for state in simulator.states[before:]]
    assert max(areas) == pytest.approx(1e-4) and min(areas) == pytest.approx(-1e-4)
    assert travel(simulator.states[before:]) == pytest.approx(travel(read(bag)["/arm/state"]), rel=0.2)


@pytest.mark.parametrize(
    "arguments",
    [["play", "/no/such/bag"], ["play", "{bag}", "--rate", "-1"], ["record", "-o", "{bag}", "/arm/state"]],
    ids=["no such bag", "negative rate", "bag exists"],
)
def test_mistakes_are_said_in_one_line(ros, excavator, recorded, arguments):
    bag, _ = recorded
    process = ros.start(excavator, *(argument.format(bag=bag) for argument in arguments))
    assert process.wait(LONGEST_WAIT) in (1, 2)
    output = process.output()
    assert output.strip() and "panicked" not in output
