"""Field names of the project's interface files, as far as the tests of the configuration need them."""

import re
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
CONFIG = REPOSITORY / "config"

# Topics of the nodes and their types; all of package excavator_msgs.
TOPICS = {
    "/arm/state": "ArmState",
    "/arm/energy": "EnergyState",
    "/arm/orifice_command": "OrificeCommand",
}
# Topics of other packages' types, which layouts show whole.
OTHER_TOPICS = {"/diagnostics", "/joint_states", "/arm/model"}

_FIELD = re.compile(r"^(?P<type>[A-Za-z0-9_/]+)(?P<array>\[\d*\])?\s+(?P<name>[a-z][a-z0-9_]*)\s*(#.*)?$")


def fields(message):
    """name -> (type, whether it is an array) of a message of excavator_msgs."""
    text = (REPOSITORY / "msgs" / "msg" / f"{message}.msg").read_text()
    matches = (_FIELD.match(line.strip()) for line in text.splitlines())
    return {match["name"]: (match["type"], bool(match["array"])) for match in matches if match}


def check_path(topic, steps):
    """Follows `steps`, (field, whether one element of it is taken), from a topic's message to a number."""
    assert topic in TOPICS, f"no topic {topic}"
    message = TOPICS[topic]
    for position, (field, element) in enumerate(steps):
        known = fields(message)
        assert field in known, f"{topic}: {message} has no field {field}, but {sorted(known)}"
        kind, array = known[field]
        assert array == element, f"{topic}: {field} of {message} is {'an' if array else 'no'} array"
        if position == len(steps) - 1:
            assert kind == "float64", f"{topic}: {field} is a {kind}, which cannot be plotted"
        message = kind
