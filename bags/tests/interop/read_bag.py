"""Reads a bag with two independent Python readers and prints what they see, as JSON.

    read_bag.py FOLDER FILE.mcap

FOLDER goes to rosbags, FILE.mcap to mcap-ros2-support. Floats are printed as the hexadecimal of their bits, so that a
comparison is exact and NaN is a value like any other.
"""

import json
import struct
import sys
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

CYLINDER = ("joint_angle", "displacement", "velocity", "cap_pressure", "rod_pressure", "orifice_area", "rod_force")
SHARED = ("pump_pressure", "tank_pressure", "pump_flow", "oil_temperature")


def bits(value: float) -> str:
    """The 64 bits of a float in hexadecimal."""
    return struct.pack(">d", value).hex()


def stamp(header) -> int:
    """Nanoseconds since the epoch."""
    return header.stamp.sec * 1_000_000_000 + header.stamp.nanosec


def plain(message) -> dict:
    """The content of an ArmState or OrificeCommand, whichever library made it."""
    if hasattr(message, "areas"):
        return {
            "stamp": stamp(message.header),
            "names": list(message.names),
            "areas": [bits(area) for area in message.areas],
        }
    return {
        "stamp": stamp(message.header),
        "shared": [bits(getattr(message, name)) for name in SHARED],
        "cylinders": [
            {"name": cylinder.name, "values": [bits(getattr(cylinder, name)) for name in CYLINDER]}
            for cylinder in message.cylinders
        ],
    }


def with_rosbags(folder: Path) -> dict:
    """Topic name -> type and messages."""
    topics: dict = {}
    with AnyReader([folder]) as reader:
        for connection, _, data in reader.messages():
            topic = topics.setdefault(connection.topic, {"type": connection.msgtype, "messages": []})
            topic["messages"].append(plain(reader.deserialize(data, connection.msgtype)))
    return topics


def with_mcap(file: Path) -> dict:
    """Topic name -> type and messages."""
    topics: dict = {}
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, _, message in reader.iter_decoded_messages():
            topic = topics.setdefault(channel.topic, {"type": schema.name, "messages": []})
            topic["messages"].append(plain(message))
    return topics


def main() -> None:
    """See the module's description."""
    folder, file = (Path(argument) for argument in sys.argv[1:])
    json.dump({"rosbags": with_rosbags(folder), "mcap": with_mcap(file)}, sys.stdout)


if __name__ == "__main__":
    main()
