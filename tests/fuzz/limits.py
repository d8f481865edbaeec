"""Number of inputs, limits of time and memory for each, and the form of a refusal."""

import os
import signal
import sys
import threading
import time
from contextlib import contextmanager

from hypothesis import HealthCheck, Phase, settings

from ..extent import either

try:
    import resource
except ImportError:  # on Windows memory is not limited
    resource = None

MAX_SECONDS = 5.0
"""Processor time of one input."""

MAX_GROWTH = 1e9
"""Bytes by which the process may grow for one input."""

_TIMEOUT = 60
_KIB = 1 if sys.platform == "darwin" else 1024
_HAS_ALARM = hasattr(signal, "SIGALRM")
_LONG = int(os.environ.get("BALLSOCKET_INPUTS", "50000")) // 100


def inputs(share):
    """Run a share in hundredths of all inputs: 600 in a quick run, 50 000 or BALLSOCKET_INPUTS in a long one."""
    return settings(
        max_examples=either(quick=6, long=_LONG) * share,
        suppress_health_check=list(HealthCheck),
        deadline=None,
        phases=either(quick=[Phase.generate], long=[Phase.generate, Phase.shrink]),
    )


class InputTimeout(BaseException):
    """An input took longer than a minute. No handler of errors swallows it."""


def _peak_memory():
    return 0 if resource is None else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KIB


@contextmanager
def _ended_in_time():
    """Interrupt an input after a minute, where the system has an alarm and the main thread runs the test."""
    if not _HAS_ALARM or threading.current_thread() is not threading.main_thread():
        yield
        return

    def end(number, frame):
        raise InputTimeout

    previous = signal.signal(signal.SIGALRM, end)
    signal.alarm(_TIMEOUT)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, previous)


@contextmanager
def within_limits():
    """Check the processor time and the memory of one input."""
    before, start = _peak_memory(), time.process_time()
    with _ended_in_time():
        yield
    seconds, growth = time.process_time() - start, _peak_memory() - before
    assert seconds <= MAX_SECONDS, f"{seconds:.3g} s"
    assert growth <= MAX_GROWTH, f"{growth / 1e9:.3g} GB"


def check_sentence(text):
    """Check that a refusal is one line that any terminal shows."""
    assert text.strip()
    assert len(text) <= 700, text
    assert all(char.isprintable() for char in text), ascii(text)


def check_run(run):
    """Check the status of a command, and that its refusal is one line."""
    assert run.returncode in (0, 2, 3), (run.returncode, run.stderr)
    assert "Traceback" not in run.stderr
    assert "\x1b" not in run.stdout + run.stderr
    if run.returncode == 2:
        assert not run.stdout
        assert run.stderr.startswith("ballsocket: ")
        assert run.stderr.endswith("\n")
        check_sentence(run.stderr[:-1])
