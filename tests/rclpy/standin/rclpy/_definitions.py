"""Interface definitions: what fields a message, service or action has.

The messages of ROS 2 Jazzy come with rosbags; services, which rosbags leaves out, lie in ../interfaces; the project's
own package is read from msgs/ of the repository, the same files that colcon builds.
"""

from pathlib import Path

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

STANDIN = Path(__file__).resolve().parents[1]
REPOSITORY = STANDIN.parents[2]

# Where packages outside of rosbags' store have their folders msg/, srv/ and action/.
PACKAGE_FOLDERS = {
    "excavator_msgs": REPOSITORY / "msgs",
    "rcl_interfaces": STANDIN / "interfaces" / "rcl_interfaces",
    "action_msgs": STANDIN / "interfaces" / "action_msgs",
    "lifecycle_msgs": STANDIN / "interfaces" / "lifecycle_msgs",
}

store = get_typestore(Stores.ROS2_JAZZY)


def _package_file(package, kind, name, suffix):
    folder = PACKAGE_FOLDERS.get(package)
    path = folder / kind / f"{name}.{suffix}" if folder else None
    return path if path and path.is_file() else None


def _qualified(text, package):
    """Names of the same package get their package: rosbags cannot know it for types that are not in pkg/msg."""
    lines = []
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words and "=" not in line.split("#")[0]:
            base = words[0].split("[")[0]
            if "/" not in base and base[0].isupper():
                words[0] = f"{package}/{words[0]}"
        lines.append(" ".join(words))
    return "\n".join(lines)


def _register(text, name):
    """Registers one message, or one part of a service or action; the parser itself knows only pkg/msg/Type."""
    package, kind, base = name.split("/")
    constants, fields = get_types_from_msg(_qualified(text, package), f"{package}/msg/{base}")[f"{package}/msg/{base}"]
    if kind == "action":  # the parts of an action refer to each other
        own = f"{package}/msg/{base.split('_')[0]}_"
        for index, (field, (field_kind, detail)) in enumerate(fields):
            if isinstance(detail, str) and detail.startswith(own):
                fields[index] = (field, (field_kind, detail.replace("/msg/", "/action/")))
    store.register({name: (constants, fields)})


def _parts(path, count):
    parts = [part.strip("\n") for part in f"\n{path.read_text()}".split("\n---\n")]
    if len(parts) != count:
        raise ImportError(f"{path} has {len(parts)} parts between '---', expected {count}")
    return parts


def require_message(name):
    """Makes `pkg/msg/Type` and everything in it known to the store; ImportError when there is no definition."""
    if name in store.fielddefs:
        return
    package, kind, base = name.split("/")
    path = _package_file(package, kind, base, "msg") if kind == "msg" else None
    if path is None:
        raise ImportError(f"no definition of {name}")
    _register(path.read_text(), name)
    require_dependencies(name)


def require_dependencies(name):
    for _, (kind, detail) in store.fielddefs[name][1]:
        while int(kind) in (3, 4):  # array, sequence: look at the element
            kind, detail = detail[0]
        if int(kind) == 2:
            require_message(detail)


def require_service(name):
    """Registers `pkg/srv/Type_Request` and `pkg/srv/Type_Response`."""
    package, kind, base = name.split("/")
    path = _package_file(package, "srv", base, "srv") if kind == "srv" else None
    if path is None:
        raise ImportError(f"no definition of {name}")
    for suffix, text in zip(("_Request", "_Response"), _parts(path, 2)):
        _register(text, name + suffix)
        require_dependencies(name + suffix)


def require_action(name):
    """Registers the parts of an action and the messages that carry them, named as rosidl names them."""
    package, kind, base = name.split("/")
    path = _package_file(package, "action", base, "action") if kind == "action" else None
    if path is None:
        raise ImportError(f"no definition of {name}")
    goal_id = "unique_identifier_msgs/UUID goal_id"
    goal, result, feedback = _parts(path, 3)
    texts = {
        "_Goal": goal,
        "_Result": result,
        "_Feedback": feedback,
        "_SendGoal_Request": f"{goal_id}\n{package}/{base}_Goal goal",
        "_SendGoal_Response": "bool accepted\nbuiltin_interfaces/Time stamp",
        "_GetResult_Request": goal_id,
        "_GetResult_Response": f"int8 status\n{package}/{base}_Result result",
        "_FeedbackMessage": f"{goal_id}\n{package}/{base}_Feedback feedback",
    }
    for suffix, text in texts.items():
        _register(text, name + suffix)
        require_dependencies(name + suffix)


def exists(package):
    """Whether any interface of the package is known."""
    return package in PACKAGE_FOLDERS or any(name.startswith(f"{package}/") for name in store.fielddefs)
