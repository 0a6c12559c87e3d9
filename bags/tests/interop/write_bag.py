"""Writes a small bag with the Writer of rosbags (MCAP storage) for Rust to read.

    write_bag.py FOLDER MSG_FOLDER

The message definitions are the .msg files in MSG_FOLDER. Sample i has stamp 1 000 000 000 + 2 000 000 i ns, displacement
0.001 i m, and NaN where nothing is measured; each tenth sample comes with a command of 1e-6 i m2.
"""

import math
import sys
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

SAMPLES = 200


def typestore_with(msg_folder: Path):
    """The types of ROS 2 Jazzy and our own."""
    store = get_typestore(Stores.ROS2_JAZZY)
    types = {}
    for path in sorted(msg_folder.glob("*.msg")):
        types.update(get_types_from_msg(path.read_text(), f"excavator_msgs/msg/{path.stem}"))
    store.register(types)
    return store


def main() -> None:
    """See the module's description."""
    folder, msg_folder = (Path(argument) for argument in sys.argv[1:])
    store = typestore_with(msg_folder)
    types = store.types
    state_type, command_type = "excavator_msgs/msg/ArmState", "excavator_msgs/msg/OrificeCommand"

    def header(nanoseconds: int):
        time = types["builtin_interfaces/msg/Time"](
            sec=nanoseconds // 1_000_000_000, nanosec=nanoseconds % 1_000_000_000
        )
        return types["std_msgs/msg/Header"](stamp=time, frame_id="base")

    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        state_connection = writer.add_connection("/arm/state", state_type, typestore=store)
        command_connection = writer.add_connection("/arm/orifice_command", command_type, typestore=store)
        for i in range(SAMPLES):
            now = 1_000_000_000 + 2_000_000 * i
            if i % 10 == 0:
                command = types[command_type](
                    header=header(now), names=["arm"], areas=np.array([1e-6 * i], dtype=np.float64)
                )
                writer.write(command_connection, now, store.serialize_cdr(command, command_type))
            cylinder = types["excavator_msgs/msg/CylinderState"](
                name="arm",
                joint_angle=math.nan,
                displacement=0.001 * i,
                velocity=math.nan,
                cap_pressure=1e6 + i,
                rod_pressure=2e6 - i,
                orifice_area=1e-4,
                rod_force=math.nan,
            )
            state = types[state_type](
                header=header(now),
                cylinders=[cylinder],
                pump_pressure=2e7,
                tank_pressure=math.nan,
                pump_flow=1e-3,
                oil_temperature=45.5,
            )
            writer.write(state_connection, now, store.serialize_cdr(state, state_type))


if __name__ == "__main__":
    main()
