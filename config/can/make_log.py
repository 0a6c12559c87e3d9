"""Makes arm.log: what a bus with the sensors of excavator.dbc would carry while the simulated arm swings.

    python config/can/make_log.py path/to/excavator

Needs PyPI's cantools and rosbags. The motion is that of bags/samples/profile.toml. For half a
second the speed is not available, as some sensors say by a value outside their range, and other devices talk too.
"""

import subprocess
import sys
import tempfile
from bisect import bisect_right
from math import degrees
from pathlib import Path

import cantools
from rosbags.highlevel import AnyReader

HERE = Path(__file__).resolve().parent
# s since the epoch; any day will do
START = 1_700_000_000
# speed that stands for "not available", mm/s, and when it is sent, s
NO_SPEED, SPEED_MISSING = 2047, (1.5, 2.0)
# message -> (time between two, time of the first), s
SCHEDULE = {"ArmPressures": (0.005, 0.0), "ArmMotion": (0.01, 0.001), "ValveState": (0.01, 0.002)}
PRESSURE_PAGE, TEMPERATURE_PAGE = (0.02, 0.003), (0.1, 0.0035)
SECONDS = 4.0


def simulated(excavator, folder):
    """[(time in s, state)] of the simulation."""
    bag = Path(folder) / "bag"
    words = ["simulate", "--model", HERE.parent / "zx30u-arm.toml"]
    words += ["--input", HERE.parents[1] / "bags/samples/profile.toml", "-o", bag]
    subprocess.run([excavator, *map(str, words)], check=True)
    with AnyReader([bag]) as reader:
        wanted = [connection for connection in reader.connections if connection.topic == "/arm/state"]
        states = [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages(wanted)]
    stamps = [state.header.stamp.sec + state.header.stamp.nanosec * 1e-9 for state in states]
    return [(stamp - stamps[0], state) for stamp, state in zip(stamps, states)]


def main():
    database = cantools.database.load_file(HERE / "excavator.dbc")
    with tempfile.TemporaryDirectory() as folder:
        states = simulated(sys.argv[1], folder)
    times = [time for time, _ in states]

    def at(time):
        return states[max(bisect_right(times, time) - 1, 0)][1]

    def content(message, time):
        state = at(time)
        (arm,) = state.cylinders
        missing = SPEED_MISSING[0] <= time < SPEED_MISSING[1]
        return {
            "ArmPressures": lambda: {
                "CapPressure": arm.cap_pressure * 1e-5,
                "RodPressure": arm.rod_pressure * 1e-5,
                "PressureCounter": round(time / SCHEDULE["ArmPressures"][0]) % 16,
            },
            "ArmMotion": lambda: {
                "JointAngle": degrees(arm.joint_angle),
                "Stroke": (arm.displacement + 0.3) * 1e3,
                "Speed": NO_SPEED if missing else arm.velocity * 1e3,
            },
            "ValveState": lambda: {"OrificeArea": arm.orifice_area * 1e6},
        }[message]()

    frames = []
    for name, (period, first) in SCHEDULE.items():
        for count in range(round(SECONDS / period)):
            time = first + count * period
            frames.append((time, name, content(name, time)))
    for (period, first), page in ((PRESSURE_PAGE, 0), (TEMPERATURE_PAGE, 1)):
        for count in range(round(SECONDS / period)):
            time = first + count * period
            pressures = {"PumpPressure": at(time).pump_pressure * 1e-5, "TankPressure": 0.0}
            frames.append((time, "Supply", {"SupplyPage": page} | (pressures if page == 0 else {"OilTemperature": 42})))
    lines = []
    for time, name, values in frames:
        message = database.get_message_by_name(name)
        data = message.encode(values, strict=False)
        identifier = f"{message.frame_id:08X}" if message.is_extended_frame else f"{message.frame_id:03X}"
        lines.append((time, f"{identifier}#{data.hex().upper()}"))
    # another device, and a request for data
    lines += [(0.5 * count + 0.0042, "7FF#0102") for count in range(int(2 * SECONDS))] + [(1.0, "180#R")]
    with open(HERE / "arm.log", "w", encoding="ascii") as log:
        for time, frame in sorted(lines):
            microseconds = round((START + time) * 1e6)
            log.write(f"({microseconds // 1_000_000}.{microseconds % 1_000_000:06d}) can0 {frame}\n")


if __name__ == "__main__":
    main()
