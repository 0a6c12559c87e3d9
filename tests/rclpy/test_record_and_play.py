"""What is recorded is what was published, and what is played is what was recorded. The judge is PyPI's rosbags."""

import math
import statistics
import tomllib

import pytest
from excavator_msgs.msg import ArmState
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from support.diagnostics import Diagnostics
from support.player import Player
from support.recorder import start_recorder
from support.simulator import STATE_QOS, Simulator, cylinder, seconds

rosbags_rosbag2 = pytest.importorskip("rosbags.rosbag2", reason="PyPI's rosbags is not installed")

RATE = 250.0
TOPICS = ["/arm/state", "/arm/orifice_command", "/arm/model", "/joint_states"]
# Stamps may be ahead of the clock by as much as a simulator that caught up, s.
AHEAD = 0.1
# Longest file of a bag, s.
FILE = 0.5
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


def speed(states):
    """Mean speed of the piston while the valve was open outwards, m/s; missing values are left out. How long it was open
    is how late a busy machine was."""
    speeds = [cylinder(state).velocity for state in states if cylinder(state).orifice_area > 0.9e-4]
    return statistics.fmean(value for value in speeds if not math.isnan(value))


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
    recorder = start_recorder(ros, excavator, bag, TOPICS, "--max-bag-duration", str(FILE))
    simulator.next(75)
    before = len(simulator.states)
    simulator.open_until(arm=1e-4)
    simulator.hold(0.8, arm=1e-4)
    simulator.open_until(arm=-1e-4)
    simulator.hold(0.8, arm=-1e-4)
    states = simulator.states[before:]
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
    from mcap.reader import make_reader

    bag, _ = recorded
    files = sorted(path.name for path in bag.glob("*.mcap"))
    assert files == [f"{bag.name}_{number}.mcap" for number in range(len(files))]
    assert len(files) > 2
    begins, ends = [], []
    for name in files:
        with (bag / name).open("rb") as file:
            summary = make_reader(file).get_summary()
        begins.append(summary.statistics.message_start_time)
        ends.append(summary.statistics.message_end_time)
    # a file takes no message that is later than it may be long, and the next one begins with that
    assert all(end - begin < FILE * 1e9 for begin, end in zip(begins, ends))
    assert all(later - earlier >= FILE * 1e9 for earlier, later in zip(begins, begins[1:]))


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
        logged, stamps = [], []
        for connection, log_time, data in reader.messages(states):
            logged.append(log_time * 1e-9)
            stamps.append(seconds(reader.deserialize(data, connection.msgtype).header.stamp))
    # stamped with the time of the sample, logged when it came: soon beside the length of the recording
    span = stamps[-1] - stamps[0]
    delays = [log_time - stamp for log_time, stamp in zip(logged, stamps)]
    assert logged == sorted(logged) and stamps == sorted(stamps)
    assert -AHEAD < min(delays) and statistics.median(delays) < span / 4
    assert logged[-1] - logged[0] == pytest.approx(span, rel=0.5)


@pytest.fixture(scope="module")
def played(ros, excavator, recorded):
    """(states, joint states, expected of both): what came over the network, and what was in the bag."""
    bag, _ = recorded
    expected = read(bag)
    mark = ros.mark()
    states = ros.listen(ArmState, "/again/state", STATE_QOS)
    joints = ros.listen(JointState, "/joint_states", 200)
    player = Player(ros, excavator, bag, "--remap", "/arm/state:=/again/state")
    player.go_on()
    ros.spin_until(lambda: not player.process.running(), "the end of the bag")
    assert player.process.wait() == 0, player.process.output()
    for heard, wanted in ((states, expected["/arm/state"]), (joints, expected["/joint_states"])):
        ros.spin_until(lambda: heard and key(heard[-1]) == key(wanted[-1]), "the last message of the bag")  # noqa: B023
    ros.release(mark)
    return states, joints, expected["/arm/state"], expected["/joint_states"]


def test_what_is_played_is_what_was_recorded(played):
    """Every message from the first to the last, in order: the readers were there before it."""
    states, joints, recorded_states, recorded_joints = played
    assert [key(state) for state in states] == [key(state) for state in recorded_states]
    assert [numbers(state) for state in states] == [numbers(state) for state in recorded_states]
    assert [key(joint) for joint in joints] == [key(joint) for joint in recorded_joints]
    assert list(joints[-1].position) == list(recorded_joints[-1].position)
    assert list(joints[-1].name) == ["arm_joint"]


def test_a_latched_topic_is_latched_again(ros, excavator, recorded):
    bag, _ = recorded
    # slowly, so that it lasts until somebody comes late
    player = ros.start(excavator, "play", bag, "--topics", "/arm/model", "/arm/state", "--rate", "0.05")
    ros.hear(ArmState, "/arm/state", STATE_QOS)
    models = ros.hear(String, "/arm/model", LATCHED)  # after the model was played
    assert "zx30u-arm" in models[0].data
    player.interrupt()


def test_at_half_the_speed_half_of_the_bag_is_played(ros, excavator, recorded):
    """When another player, that began with it, has played all of it."""
    bag, _ = recorded
    stamps = [seconds(state.header.stamp) for state in read(bag)["/arm/state"]]
    heard, players = {}, []
    for name, speed_of_bag in (("half", 0.5), ("whole", 1.0)):
        heard[name] = ros.listen(ArmState, f"/{name}/state", STATE_QOS)
        words = ["--rate", str(speed_of_bag), "--topics", "/arm/state", "--remap", f"/arm/state:=/{name}/state"]
        players.append(Player(ros, excavator, bag, *words, node=name))
    for player in players:
        player.go_on()

    def played(name):
        """The share of the bag that was heard."""
        last = seconds(heard[name][-1].header.stamp) if heard[name] else stamps[0]
        return (last - stamps[0]) / (stamps[-1] - stamps[0])

    ros.spin_until(lambda: played("whole") == 1.0, "the end of the bag")
    assert 0.25 < played("half") < 0.75


def test_played_commands_move_the_simulator(ros, excavator, recorded):
    """A recording of commands is enough to repeat a motion."""
    bag, _ = recorded
    simulator = Simulator(ros, excavator, rate=RATE)
    told = Diagnostics(ros)
    contents = read(bag)

    def play():
        """Whether every command arrived: a simulator that does not know the player yet, or is late, misses some."""
        nonlocal before
        known = told.count("refusal", "accepted commands")
        before = len(simulator.states)
        player = Player(ros, excavator, bag, "--topics", "/arm/orifice_command")
        player.go_on()
        ros.spin_until(lambda: not player.process.running(), "the end of the bag")
        told.reach(simulator.time)
        return told.count("refusal", "accepted commands") == known + len(contents["/arm/orifice_command"])

    before = 0
    ros.spin_until(play, "all commands to be followed")
    areas = [cylinder(state).orifice_area for state in simulator.states[before:]]
    assert max(areas) == pytest.approx(1e-4) and min(areas) == pytest.approx(-1e-4)
    assert speed(simulator.states[before:]) == pytest.approx(speed(contents["/arm/state"]), rel=0.2)


@pytest.mark.parametrize(
    "arguments",
    [["play", "/no/such/bag"], ["play", "{bag}", "--rate", "-1"], ["record", "-o", "{bag}", "/arm/state"]],
    ids=["no such bag", "negative rate", "bag exists"],
)
def test_mistakes_are_said_in_one_line(ros, excavator, recorded, arguments):
    bag, _ = recorded
    process = ros.start(excavator, *(argument.format(bag=bag) for argument in arguments))
    assert process.wait() in (1, 2)
    output = process.output()
    assert output.strip() and "panicked" not in output
