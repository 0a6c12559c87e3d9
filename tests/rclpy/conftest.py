"""Fixtures of the tests that check the live nodes through rclpy.

With ROS 2 sourced (and excavator_msgs built) the tests use its rclpy. Without, `standin/` takes its place: the used
part of rclpy over Eclipse Cyclone DDS. The header of the run says which of the two it was.
"""

import importlib.util
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def _rclpy_is_installed():
    # a folder named rclpy on the path is found too, but as a namespace without an origin
    spec = importlib.util.find_spec("rclpy")
    return spec is not None and spec.origin is not None


USES_STANDIN = not _rclpy_is_installed()
if USES_STANDIN:
    sys.path.insert(0, str(HERE / "standin"))
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(HERE / "standin"), os.environ.get("PYTHONPATH")]))
sys.path.insert(0, str(HERE))

import pytest  # noqa: E402
from support import loopback  # noqa: E402

if USES_STANDIN:
    try:
        MISSING = loopback.prepare()
        import rclpy  # noqa: F401  makes std_msgs and its like importable
    except ImportError as error:
        MISSING = f"neither rclpy nor PyPI's cyclonedds can be imported ({error})"
else:
    MISSING = None


def pytest_report_header(config):
    if MISSING:
        return f"rclpy: none, all tests skip: {MISSING}"
    from rclpy.utilities import get_rmw_implementation_identifier
    from support.binary import binary_or_reason

    found, reason = binary_or_reason()
    which = (
        "stand-in over Eclipse Cyclone DDS, no ROS 2 here"
        if USES_STANDIN
        else f"of ROS 2 ({importlib.util.find_spec('rclpy').origin})"
    )
    return [
        f"rclpy: {which}; middleware {get_rmw_implementation_identifier()}",
        f"network: {loopback.summary() if USES_STANDIN else 'as the environment says'}",
        f"excavator: {found or reason}",
    ]


def pytest_collection_modifyitems(items):
    if MISSING:
        for item in items:
            item.add_marker(pytest.mark.skip(reason=MISSING))


@pytest.fixture(scope="session")
def uses_standin():
    """Whether the tests run on the stand-in and not on a real rclpy."""
    return USES_STANDIN


@pytest.fixture(scope="module")
def ros():
    """A ROS context with a node of its own, in a domain that no other test module uses."""
    from support.session import Session

    with Session() as session:
        yield session


@pytest.fixture(autouse=True)
def _nothing_left_listening(request):
    """What one test subscribed to does not load the next one."""
    session = request.getfixturevalue("ros") if "ros" in request.fixturenames else None
    mark = session.mark() if session else 0
    yield
    if session:
        session.release(mark)


@pytest.fixture(scope="session")
def excavator():
    """Path of the program; the test skips when it is not built."""
    from support.binary import binary_or_reason

    found, reason = binary_or_reason()
    if not found:
        pytest.skip(reason)
    return found


@pytest.fixture(scope="session")
def model():
    """The model file that the simulated nodes run on."""
    return HERE.parents[1] / "config" / "zx30u-arm.toml"
