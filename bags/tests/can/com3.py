"""Makes com3.json: random frames of every COM3 message, and what PyPI's cantools reads from them with the published file.

    python bags/tests/can/com3.py PUBLISHED.dbc   # excavator_com3.dbc of pwri-opera/com3; writes the file beside this one
"""

import json
import random
import sys
from pathlib import Path

import cantools

FRAMES = 3


def main():
    database = cantools.database.load_file(sys.argv[1], strict=False)
    numbers = random.Random(20230815)
    frames = []
    for message in database.messages:
        for _ in range(FRAMES):
            data = bytes(numbers.randrange(256) for _ in range(message.length))
            values = message.decode(data, decode_choices=False)
            frames.append({"message": message.name, "id": message.frame_id, "data": data.hex(), "values": values})
    path = Path(__file__).resolve().parent / "com3.json"
    path.write_text("[\n" + ",\n".join(json.dumps(frame) for frame in frames) + "\n]\n")


if __name__ == "__main__":
    main()
