"""Settings of the suite: `pytest` runs it in few cases, `pytest --long` completely."""

import gc
import signal
from collections import Counter

import pytest
from hypothesis import settings

from . import environment, extent
from .schedule import FileScheduling, start_rank

settings.register_profile("quick", max_examples=8, deadline=None, derandomize=True, database=None)
settings.register_profile("long", max_examples=100, deadline=None, database=None)


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="every case, and the proofs that take long")


def pytest_configure(config):
    config.addinivalue_line("markers", "long: a proof that takes long; it runs with --long")
    extent.whole = config.getoption("long")
    settings.load_profile("long" if extent.whole else "quick")
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # fixtures end what they started


def pytest_unconfigure():
    if environment.workplace is not None:
        environment.workplace.cleanup()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    return FileScheduling(config, log)


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Read the tests without searches for garbage: they are hundreds of thousands of objects that stay."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    if not extent.whole:
        long = [item for item in items if item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if not item.get_closest_marker("long")]
    items.sort(key=lambda item: start_rank(item.nodeid))


def pytest_terminal_summary(terminalreporter):
    """Print each reason for skipped tests once, with their number."""
    skipped = [report.longrepr for report in terminalreporter.stats.get("skipped", ())]
    for reason, number in Counter(entry[2].removeprefix("Skipped: ") for entry in skipped).most_common():
        terminalreporter.write_line(f"skipped {number}: {reason}")
    if not extent.whole:
        terminalreporter.write_line("quick form; `pytest --long` runs every case")
