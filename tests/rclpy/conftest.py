"""Fixtures of the tests that check the live nodes through rclpy.

They use rclpy of ROS 2, or `standin/` in its place: the used part of rclpy over Eclipse Cyclone DDS. `support/choice.py`
says which one; the header of the run names it.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "docs")]

import pytest  # noqa: E402
from support import choice, loopback  # noqa: E402

try:
    RCLPY = choice.choose()
except ValueError as error:
    raise pytest.UsageError(str(error)) from None

USES_STANDIN = RCLPY == choice.STANDIN
if USES_STANDIN:
    sys.path.insert(0, str(HERE / "standin"))
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(HERE / "standin"), os.environ.get("PYTHONPATH")]))

MISSING = None
if choice.is_here(RCLPY):
    MISSING = loopback.prepare(for_standin=USES_STANDIN)
    try:
        import rclpy  # noqa: F401  the stand-in makes std_msgs and its like importable
    except ImportError as error:
        MISSING = f"{RCLPY} cannot be imported ({error})"

# Tests with this mark run on every rclpy, the others on the first only.
MIDDLEWARE = "middleware: what differs between middlewares: discovery, profiles, services, actions, outages"
# Variants of a claim that another test checks as well, and what takes long.
FULL = "full: only in tests/run --all"


def pytest_configure(config):
    if not choice.is_here(RCLPY):
        choice.start_anew(RCLPY, config)
    for marker in (MIDDLEWARE, FULL):
        config.addinivalue_line("markers", marker)
    # not ours: lark, with which ROS 2 reads interface files, and rclpy of Kilted with itself
    config.addinivalue_line("filterwarnings", "ignore:module 'sre_:DeprecationWarning:lark")
    config.addinivalue_line("filterwarnings", "ignore:Deprecated in favor of:DeprecationWarning:rclpy")


def pytest_report_header():
    if MISSING:
        return f"rclpy: none, all tests skip: {MISSING}"
    from rclpy.utilities import get_rmw_implementation_identifier
    from support.binary import binary_or_reason

    found, reason = binary_or_reason()
    which = "stand-in over Eclipse Cyclone DDS, no ROS 2" if USES_STANDIN else f"{RCLPY} ({Path(rclpy.__file__).parent})"
    return [
        f"rclpy: {which}; middleware {get_rmw_implementation_identifier()}",
        f"network: {loopback.summary()}",
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
    """What one test started or subscribed to does not load the next one."""
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
