"""Makes the foreign samples: one recording as others would have it. Needs the Python package rosbags.

    make.py table BAG FILE.csv     a bag as a table with semicolons, decimal commas and units in the headings
    make.py bag BAG FOLDER [KIND]  a bag as topics of sensor_msgs and std_msgs on clocks of their own; KIND is sqlite3,
                                   sqlite3-file, sqlite3-message (compressed), mcap, mcap-file or mcap-message
"""

import sys
from pathlib import Path

import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

# Area of the valve that full current opens, m2, and that current, mA.
FULL_AREA, FULL_CURRENT = 1e-4, 800.0


def recording(bag: Path) -> tuple[list, list]:
    """State and command messages of a bag, each with its log time in ns."""
    states, commands = [], []
    with AnyReader([bag]) as reader:
        for connection, time, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            (states if connection.topic == "/arm/state" else commands).append((time, message))
    return states, commands


def write_bag(bag: Path, folder: Path, kind: str) -> None:
    """The recording as topics of common types; pressures are stamped 2 ms late, the pump has half the rate."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    storage, _, mode = kind.partition("-")
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin[storage.upper()])
    if mode:
        writer.set_compression(CompressionMode[mode.upper()], CompressionFormat.ZSTD)

    def header(time: int):
        stamp = types["builtin_interfaces/msg/Time"](sec=time // 10**9, nanosec=time % 10**9)
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id="")

    states, commands = recording(bag)
    with writer:
        topics = {
            name: (writer.add_connection(name, kind, typestore=store), kind)
            for name, kind in [
                ("/joint_states", "sensor_msgs/msg/JointState"),
                ("/chambers", "std_msgs/msg/Float64MultiArray"),
                ("/pump", "sensor_msgs/msg/FluidPressure"),
                ("/valve_current", "std_msgs/msg/Float64"),
            ]
        }

        def write(topic: str, time: int, **fields) -> None:
            connection, kind = topics[topic]
            writer.write(connection, time, store.serialize_cdr(types[kind](**fields), kind))

        for index, (time, state) in enumerate(states):
            arm = state.cylinders[0]
            write(
                "/joint_states",
                time + 500_000,
                header=header(time),
                name=["boom_cylinder", "arm_cylinder"],
                position=np.array([0.0, 1e3 * arm.displacement + 350.0]),
                velocity=np.array([]),
                effort=np.array([]),
            )
            layout = types["std_msgs/msg/MultiArrayLayout"](dim=[], data_offset=0)
            data = np.array([arm.cap_pressure / 1e5, arm.rod_pressure / 1e5, state.tank_pressure / 1e5])
            write("/chambers", time + 2_000_000, layout=layout, data=data)
            if index % 2 == 0:
                write("/pump", time, header=header(time), fluid_pressure=state.pump_pressure + 101_325.0, variance=0.0)
        for time, command in commands:
            write("/valve_current", time, data=FULL_CURRENT * float(command.areas[0]) / FULL_AREA)


def write_table(bag: Path, path: Path) -> None:
    """The recording as a spreadsheet program of continental Europe writes it."""
    states, commands = recording(bag)
    rows = ["Zeit [ms];Weg [mm];p_A [bar];p_B [bar];Pumpendruck [bar];Tankdruck [bar];Ventil [mm2]"]
    pending, area = list(commands), float("nan")
    for time, state in states:
        while pending and pending[0][0] <= time:
            area = pending.pop(0)[1].areas[0]
        arm = state.cylinders[0]
        pressures = (arm.cap_pressure, arm.rod_pressure, state.pump_pressure, state.tank_pressure)
        cells = [(time - states[0][0]) / 1e6, 1e3 * arm.displacement, *(p / 1e5 for p in pressures), 1e6 * area]
        rows.append(";".join(f"{cell:.6f}".replace(".", ",") for cell in cells))
    path.write_text("\n".join(rows) + "\n")


def main() -> None:
    """See the module's description."""
    match sys.argv[1:]:
        case ["table", bag, path]:
            write_table(Path(bag), Path(path))
        case ["bag", bag, folder, *kind]:
            write_bag(Path(bag), Path(folder), kind[0] if kind else "sqlite3")
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main()
