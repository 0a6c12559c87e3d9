"""Makes vectors.json: random signals and frames, and what PyPI's cantools reads from them.

    python bags/tests/can/vectors.py           # writes the file beside this one

Signals of both byte orders, signed, unsigned and float, simple and extended multiplexers, 8 and 64 bytes.
"""

import json
import random
import struct
from pathlib import Path

import cantools

HERE = Path(__file__).resolve().parent
SEED = 20261121
MESSAGES, FRAMES = 40, 12


def big_endian_start(first, length):
    """Where DBC says that a big endian number starts that takes bits `first`... in the order of transmission."""
    return first // 8 * 8 + 7 - first % 8


def signal(numbers, name, bits, mark=""):
    """A line of DBC, or None, and the line that says that it is a float; `bits` are those that a frame has."""
    coding = numbers.choice(["unsigned", "signed", "unsigned", "signed", "float32", "float64"])
    length = {"float32": 32, "float64": 64}.get(coding) or numbers.randint(2 if coding == "signed" else 1, 64)
    if length > bits:
        return None
    first = numbers.randrange(bits - length + 1)
    big = numbers.random() < 0.5
    start = big_endian_start(first, length) if big else first
    factor, offset = numbers.choice([(1, 0), (0.01, -40), (-0.5, 3.25), (1e-3, 100), (2, 0)])
    sign = "+" if coding == "unsigned" else "-"
    line = f' SG_ {name}{mark} : {start}|{length}@{0 if big else 1}{sign} ({factor},{offset}) [0|0] "" Bridge'
    return line, {"float32": 1, "float64": 2}.get(coding)


def message(numbers, index):
    """(DBC text, lines that follow all messages)."""
    length = numbers.choice([8, 8, 8, 64])
    identifier = numbers.choice([index + 1, (1 << 31) | (0x18FF0000 + index)])
    lines, after = [f"BO_ {identifier} M{index}: {length} Sensors"], []
    kind = numbers.choice(["plain", "simple", "extended"])
    marks = [""] * 4
    first_free = 0
    if kind == "simple":
        lines.append(' SG_ Page M : 0|3@1+ (1,0) [0|7] "" Bridge')
        marks = ["", " m0", " m1", " m5"]
    elif kind == "extended":
        lines.append(' SG_ Page M : 0|3@1+ (1,0) [0|7] "" Bridge')
        lines.append(' SG_ Inner m1M : 3|2@1+ (1,0) [0|3] "" Bridge')
        marks = ["", " m0", " m2", " m3"]
        after.append(f"SG_MUL_VAL_ {identifier} Inner Page 1-2;")
    for number, mark in enumerate(marks):
        name = f"S{number}"
        found = signal(numbers, name, length * 8, mark)
        if found is None:
            continue
        lines.append(found[0])
        if found[1]:
            after.append(f"SIG_VALTYPE_ {identifier} {name} : {found[1]};")
        if kind == "extended" and mark:
            parent, ranges = {" m0": ("Page", "0-0, 4-7"), " m2": ("Inner", "2-2"), " m3": ("Inner", "0-1, 3-3")}[mark]
            after.append(f"SG_MUL_VAL_ {identifier} {name} {parent} {ranges};")
    return "\n".join(lines) + "\n", after


def make():
    numbers = random.Random(SEED)
    parts = [message(numbers, index) for index in range(MESSAGES)]
    head = 'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: Sensors Bridge\n\n'
    text = head + "\n".join(body for body, _ in parts) + "\n"
    text += "".join(f"{line}\n" for wanted in ("SIG_VALTYPE_", "SG_MUL_VAL_") for _, after in parts for line in after
                    if line.startswith(wanted))
    database = cantools.database.load_string(text, "dbc", strict=False)
    frames = []
    for known in database.messages:
        for _ in range(FRAMES):
            data = numbers.randbytes(known.length)
            try:
                values = known.decode(data, decode_choices=False, allow_truncated=False)
            except cantools.database.DecodeError:
                # no signal has this value of the multiplexer; cantools refuses the whole frame then
                continue
            if any(value != value or abs(value) == float("inf") for value in values.values()):
                continue
            # floats as bits: what is compared is equal, not near
            bits = {name: struct.pack(">d", float(value)).hex() for name, value in values.items()}
            absent = [one.name for one in known.signals if one.name not in values]
            frames.append({"message": known.name, "data": data.hex(), "values": bits, "absent": absent})
    return {"dbc": text, "frames": frames}


if __name__ == "__main__":
    with open(HERE / "vectors.json", "w", encoding="utf-8") as file:
        json.dump(make(), file, indent=0)
        file.write("\n")
