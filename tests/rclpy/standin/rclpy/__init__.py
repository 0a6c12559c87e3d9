"""Stand-in for the part of rclpy that the tests use, for machines without ROS 2. See ../README.md.

Everything that does not start with an underscore has the name and the meaning that it has in rclpy of ROS 2 Jazzy.
"""

from . import _import_interfaces

_import_interfaces.install()

from .context import Context  # noqa: E402
from .executors import SingleThreadedExecutor  # noqa: E402
from .node import Node  # noqa: E402
from .utilities import get_default_context  # noqa: E402

__all__ = [
    "Context",
    "Node",
    "create_node",
    "get_default_context",
    "init",
    "shutdown",
    "spin",
    "spin_once",
    "try_shutdown",
]

_executors = {}


def init(*, args=None, context=None, domain_id=None):
    (context or get_default_context()).init(args, domain_id=domain_id)


def shutdown(*, context=None):
    (context or get_default_context()).shutdown()


def try_shutdown(*, context=None):
    (context or get_default_context()).try_shutdown()


def create_node(node_name, *, context=None, namespace=None, enable_rosout=True, start_parameter_services=True):
    return Node(
        node_name,
        context=context,
        namespace=namespace,
        enable_rosout=enable_rosout,
        start_parameter_services=start_parameter_services,
    )


def _executor():
    context = get_default_context()
    if context not in _executors:
        _executors[context] = SingleThreadedExecutor(context=context)

        def forget():
            _executors.pop(context).shutdown()

        context.on_shutdown(forget)
    return _executors[context]


def _with_node(node, executor, work):
    executor = executor or _executor()
    added = executor.add_node(node)
    try:
        work(executor)
    finally:
        if added:
            executor.remove_node(node)


def spin_once(node, *, executor=None, timeout_sec=None):
    _with_node(node, executor, lambda executor: executor.spin_once(timeout_sec))


def spin(node, executor=None):
    _with_node(node, executor, lambda executor: executor.spin())
