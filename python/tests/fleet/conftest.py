"""One Ray instance for all fleet tests, because it takes seconds to start."""

import os

import pytest

ray = pytest.importorskip("ray")

from . import cheap  # noqa: E402


@pytest.fixture(scope="session")
def engine():
    """A local Ray instance with two workers."""
    os.environ.setdefault("RAY_DISABLE_MEMORY_MONITOR", "1")
    # Workers can import the package, but not the tests.
    ray.cloudpickle.register_pickle_by_value(cheap)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error", object_store_memory=100 << 20)
    yield ray
    ray.shutdown()
