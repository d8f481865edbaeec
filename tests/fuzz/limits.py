"""Number of inputs, limits of time and memory for each, the folder of an input, and the form of a refusal."""

import os
import signal
import sys
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from hypothesis import HealthCheck, Phase, settings

from ..cli.command import run
from ..extent import either
from ..processes import PATIENCE

try:
    import resource
except ImportError:  # on Windows memory is not limited
    resource = None

MAX_SECONDS = 5.0
"""Processor time of one input."""

MAX_GROWTH = 1e9
"""Bytes by which the process may grow for one input."""

_KIB = 1 if sys.platform == "darwin" else 1024
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
    """An input took longer than any machine needs. No handler of errors swallows it."""


def _peak_memory():
    return 0 if resource is None else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KIB


def _end(number, frame):
    raise InputTimeout


@contextmanager
def within_limits():
    """Check the processor time and the memory of one input; interrupt it late where alarms are possible."""
    before, start = _peak_memory(), time.process_time()
    alarm = hasattr(signal, "SIGALRM") and threading.current_thread() is threading.main_thread()
    previous = signal.signal(signal.SIGALRM, _end) if alarm else None
    try:
        signal.alarm(PATIENCE) if alarm else None
        yield
    finally:
        if alarm:
            signal.alarm(0)
            signal.signal(signal.SIGALRM, previous)
    seconds, growth = time.process_time() - start, _peak_memory() - before
    assert seconds <= MAX_SECONDS, f"{seconds:.3g} s"
    assert growth <= MAX_GROWTH, f"{growth / 1e9:.3g} GB"


@contextmanager
def folder_with(files):
    with TemporaryDirectory() as name:
        for file, raw in files.items():
            (Path(name) / file).write_bytes(raw)
        yield Path(name)


def check_sentence(text):
    """Check that a refusal is one line that any terminal shows."""
    assert text.strip()
    assert len(text) <= 700, text
    assert all(char.isprintable() for char in text), ascii(text)


def check_run(run):
    assert run.returncode in (0, 2, 3), (run.returncode, run.stderr)
    assert not any(text in run.stdout + run.stderr for text in ("Traceback", "\x1b"))
    if run.returncode == 2:
        assert not run.stdout
        assert run.stderr.startswith("ballsocket: ")
        assert run.stderr.endswith("\n")
        check_sentence(run.stderr[:-1])


def check_command(files, *words):
    with folder_with(files) as folder, within_limits():
        check_run(run(*words, folder=folder))
