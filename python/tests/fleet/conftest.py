"""One Ray for all tests of fleets: to start it takes seconds."""

import os

import pytest

ray = pytest.importorskip("ray")

from . import cheap  # noqa: E402


@pytest.fixture(scope="session")
def engine():
    """A Ray with two workers on this machine."""
    os.environ.setdefault("RAY_DISABLE_MEMORY_MONITOR", "1")
    # Workers know the package, not the tests.
    ray.cloudpickle.register_pickle_by_value(cheap)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error", object_store_memory=100 << 20)
    yield ray
    ray.shutdown()
