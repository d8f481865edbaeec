"""One option: `pytest --long` runs every case, and the proofs that take half a minute each."""

import os
from tempfile import gettempdir, mkdtemp

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the cores are busy with other tests
os.environ.setdefault("BALLSOCKET_CACHE", mkdtemp(prefix="ballsocket-cache-"))  # not that of who runs them

os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", f"{gettempdir()}/ballsocket-jax")  # compiled once for all workers
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.1")

import pytest
from hypothesis import settings

from . import extent
from .schedule import FileScheduling, start_rank

settings.register_profile("quick", max_examples=15, deadline=None, derandomize=True, database=None)
settings.register_profile("long", max_examples=100, deadline=None, database=None)


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="every case, and the proofs that take long")


def pytest_configure(config):
    config.addinivalue_line("markers", "long: a proof that takes long; it runs with --long")
    extent.whole = config.getoption("long")
    settings.load_profile("long" if extent.whole else "quick")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    return FileScheduling(config, log)


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: start_rank(item.nodeid))
    if extent.whole:
        return
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker(pytest.mark.skip(reason="takes long: pytest --long"))
