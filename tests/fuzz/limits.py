"""How many inputs there are, what any of them may cost, and how a refusal looks."""

import os
import resource
import signal
import sys
import time
from contextlib import contextmanager

from hypothesis import HealthCheck, Phase, settings

from ..extent import either

LONGEST = 5.0
"""Seconds of the processor."""

MOST = 1e9
"""Bytes that the process may grow by."""

_PATIENCE = 60
_KIB = 1 if sys.platform == "darwin" else 1024

_LONG = int(os.environ.get("BALLSOCKET_INPUTS", "50000")) // 100


def inputs(share):
    """A hundredth of all inputs, so many times: 1000 of them in a quick run, 50 000 in a long one, or as many as
    the environment's BALLSOCKET_INPUTS says."""
    return settings(
        max_examples=either(quick=10, long=_LONG) * share,
        suppress_health_check=list(HealthCheck),
        deadline=None,
        phases=either(quick=[Phase.generate], long=[Phase.generate, Phase.shrink]),
    )


class TakesTooLong(BaseException):
    """It has not ended within a minute; nothing that handles errors may swallow this."""


def _largest():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KIB


@contextmanager
def within_limits():
    """Inside, one input is worked at."""

    def end(number, frame):
        raise TakesTooLong

    before, start, signalled = _largest(), time.process_time(), signal.signal(signal.SIGALRM, end)
    signal.alarm(_PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, signalled)
    seconds, grown = time.process_time() - start, _largest() - before
    assert seconds <= LONGEST, f"{seconds:.3g} s"
    assert grown <= MOST, f"{grown / 1e9:.3g} GB"


def check_sentence(text):
    """One line that any terminal shows, and not a page of it."""
    assert text.strip()
    assert len(text) <= 700, text
    assert all(char.isprintable() for char in text), ascii(text)


def check_run(run):
    """Done, misuse or a failure; a refusal is one line."""
    assert run.returncode in (0, 2, 3), (run.returncode, run.stderr)
    assert "Traceback" not in run.stderr
    assert "\x1b" not in run.stdout + run.stderr
    if run.returncode == 2:
        assert not run.stdout
        assert run.stderr.startswith("ballsocket: ")
        assert run.stderr.endswith("\n")
        check_sentence(run.stderr[:-1])
