"""Long replies over a network of ordinary packets: the loopback interface takes 65536 bytes at once, Ethernet 1500."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.middleware, pytest.mark.full]

HERE = Path(__file__).parent
NETWORK = """
ip link set lo mtu 1500 && ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo \
    && exec "$@"
"""
# The result of the action holds a whole model, some 5 kB.
LONG = "from_goal_to_result or all_are_described"


def inside(*words):
    """Runs a program in a network of its own."""
    # Whether there is an rclpy, the tests in there find out by themselves.
    paths = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    paths = os.pathsep.join(path for path in paths if path and Path(path) != HERE / "standin")
    environment = dict(os.environ, PYTHONPATH=paths)
    words = ["unshare", "-n", "sh", "-c", NETWORK, "sh", *words]
    return subprocess.run(words, env=environment, capture_output=True, text=True)


def test_long_replies_arrive_over_a_network_of_ordinary_packets(excavator):
    try:
        possible = inside("true").returncode == 0
    except FileNotFoundError:
        possible = False
    if not possible:
        pytest.skip("no network namespaces here (root and iproute2 are needed)")
    files = [str(HERE / name) for name in ("test_identification.py", "test_parameters.py")]
    tested = inside(sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *files, "-k", LONG)
    assert tested.returncode == 0, tested.stdout[-3000:] + tested.stderr[-1000:]
    assert "skipped" not in tested.stdout and "2 passed" in tested.stdout, tested.stdout
