"""One Ray instance for all fleet tests, because it takes seconds to start."""

import os

import pytest
import ray

from . import cheap


def pytest_collection_modifyitems(items):
    """Fleets need Ray and minutes."""
    for item in items:
        if item.path.parent.name == "fleet":
            item.add_marker(pytest.mark.full)


@pytest.fixture(scope="session")
def engine():
    """A local Ray instance with two workers."""
    os.environ.setdefault("RAY_DISABLE_MEMORY_MONITOR", "1")
    # Workers can import the package, but not the tests.
    ray.cloudpickle.register_pickle_by_value(cheap)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="error", object_store_memory=100 << 20)
    yield ray
    ray.shutdown()
