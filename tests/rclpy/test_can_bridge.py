"""CAN frames become states: each number is what PyPI's cantools reads from the same log, on the clock of the log."""

import math
import re
import tomllib
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from excavator_msgs.msg import ArmState
from support.recorder import bag_states
from support.simulator import STATE_QOS, cylinder

cantools = pytest.importorskip("cantools", reason="PyPI's cantools is not installed")

EXAMPLE = Path(__file__).resolve().parents[2] / "config" / "can"
LINE = re.compile(r"\((\d+)\.(\d{6})\) (\S+) ([0-9A-F]+)#([0-9A-F]*)$")
# ns; what rounding of stamps and of the decoder makes of equal times
ROUNDING = 2000


def description(folder, change=lambda text: text):
    """The example with other words; files are seen from its new place."""
    text = (EXAMPLE / "arm.toml").read_text()
    for name in ("excavator.dbc", "arm.log"):
        text = text.replace(f'"{name}"', f'"{EXAMPLE / name}"')
    path = folder / "arm.toml"
    path.write_text(change(text))
    return path


def decoded():
    """{(message, signal): [(time in ns, value in the unit of the DBC file)]}; frames that carry no data left out."""
    database = cantools.database.load_file(EXAMPLE / "excavator.dbc")
    found = {}
    for line in (EXAMPLE / "arm.log").read_text().splitlines():
        match = LINE.match(line)
        if not match:
            continue
        seconds, micros, _, identifier, data = match.groups()
        try:
            message = database.get_message_by_frame_id(int(identifier, 16))
        except KeyError:
            continue
        time = int(seconds) * 10**9 + int(micros) * 1000
        for name, value in message.decode(bytes.fromhex(data), decode_choices=False).items():
            found.setdefault((message.name, name), []).append((time, value))
    return found


def expected(signal, values, limits, moment, now):
    """The value in SI at `moment` as known at `now`: on the line between two measurements, NaN when impossible or old."""
    # whole nanoseconds: since the epoch they are more than a float holds
    delay, age = round(signal.get("delay", 0.0) * 1e9), round(signal.get("age", 0.1) * 1e9)
    scale, offset = signal.get("scale", 1.0), signal.get("offset", 0.0)
    known = [(time - delay, value) for time, value in values if time <= now + ROUNDING]
    before = [one for one in known if one[0] <= moment]
    after = [one for one in known if one[0] > moment]
    if not before or moment - before[-1][0] > age:
        return math.nan

    def possible(value):
        si = value * scale + offset
        inside = signal.get("minimum", -math.inf) <= si <= signal.get("maximum", math.inf)
        return limits[0] <= value <= limits[1] and inside

    (time, value) = before[-1]
    if not possible(value):
        return math.nan
    if after and possible(after[0][1]) and not signal["signal"].endswith("orifice_area"):
        share = (moment - time) / (after[0][0] - time)
        value += share * (after[0][1] - value)
    return value * scale + offset


def measured(state, signal):
    name = signal["signal"].split(".")
    return getattr(cylinder(state, name[0]), name[1]) if len(name) == 2 else getattr(state, name[0])


def test_every_number_is_that_of_an_independent_decoder(ros, excavator, tmp_path):
    """As fast as possible: states have the stamps of the log, so they can be compared one by one."""
    path = description(tmp_path, lambda text: text.replace('pace = "stamps"', 'pace = "fastest"'))
    bag = tmp_path / "bag"
    recorder = ros.start(excavator, "record", "/arm/state", "-o", bag)
    ros.spin_until(lambda: "bag_recorder" in ros.node.get_node_names(), "the recorder")
    bridge = ros.start(excavator, "node", "arm-bridge", "--ros-args", "-p", f"description:={path}")
    assert bridge.wait() == 0, bridge.output()
    assert recorder.interrupt() == 0, recorder.output()
    states = bag_states(bag)
    stamps = [state.header.stamp.sec * 10**9 + state.header.stamp.nanosec for state in states]
    assert len(states) == 400
    assert {later - earlier for earlier, later in zip(stamps, stamps[1:])} == {10_000_000}

    words = tomllib.loads(path.read_text())
    signals = words["can"][0]["signals"]
    common = round(max(signal.get("delay", 0.0) for signal in signals) * 1e9)
    database = cantools.database.load_file(EXAMPLE / "excavator.dbc")
    bus = decoded()
    compared = missing = 0
    for stamp, state in zip(stamps, states):
        for signal in signals:
            known = database.get_message_by_name(signal["message"]).get_signal_by_name(signal["name"])
            values = bus[signal["message"], signal["name"]]
            wanted = expected(signal, values, (known.minimum, known.maximum), stamp, stamp + common)
            value = measured(state, signal)
            if math.isnan(wanted):
                assert math.isnan(value), f"{signal['signal']} at {stamp}: {value}"
                missing += 1
            else:
                assert value == pytest.approx(wanted, rel=1e-6, abs=1e-9), f"{signal['signal']} at {stamp}"
                compared += 1
    # half a second without speed is fifty states, and a few at the beginning
    assert compared > 3400 and 50 <= missing < 80


def test_a_log_is_a_bus_in_real_time_and_what_ends_is_not_measured(ros, excavator, tmp_path):
    signals = tomllib.loads((EXAMPLE / "arm.toml").read_text())["can"][0]["signals"]
    told = []

    def take(array):
        for status in array.status:
            told.extend(f"{value.key}: {value.value}" for value in status.values)

    ros.listen_with(DiagnosticArray, "/diagnostics", take, 100)
    states = ros.listen(ArmState, "/arm/state", STATE_QOS)

    def heard(words):
        return any(words in word for word in told)

    def plays_to_its_end():
        """Whether we heard it from near the beginning: the log lasts four seconds, and a bridge does not wait for its readers."""
        del told[:], states[:]
        bridge = ros.start(excavator, "node", "arm-bridge", "--ros-args", "-p", f"description:={EXAMPLE / 'arm.toml'}")
        ros.spin_until(lambda: heard("arm.cap_pressure: stale"), "the end of the log")
        ros.spin_until(lambda: all(math.isnan(measured(states[-1], signal)) for signal in signals), "states without values")
        assert heard("error and remote frames: 1")
        assert bridge.interrupt() == 0, bridge.output()
        return heard("arm.velocity: out of range") and any(state.oil_temperature == 42.0 for state in states)

    ros.spin_until(plays_to_its_end, "the missing speed, and the oil temperature before the end")


@pytest.mark.parametrize(
    "old, new, word",
    [
        ('name = "Stroke"', 'name = "Strike"', "no signal Strike"),
        ('message = "ValveState"', 'message = "ValvesState"', "no message ValvesState"),
        ('log = "', 'log = "/nowhere', "/nowhere"),
        ('log = "', 'device = "nocan9" # "', "nocan9"),
        ('excavator.dbc"', 'excavator.dbx"', "excavator.dbx"),
    ],
)
def test_mistakes_are_said_in_one_line(ros, excavator, tmp_path, old, new, word):
    path = description(tmp_path, lambda text: text.replace(old, new, 1))
    bridge = ros.start(excavator, "node", "arm-bridge", "--ros-args", "-p", f"description:={path}")
    assert bridge.wait() == 1
    (line,) = [line for line in bridge.output().splitlines() if line.startswith("excavator: ")]
    assert word in line
