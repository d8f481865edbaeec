"""Processes of tests: states that are waited for, and ends at a chosen moment."""

import time
from pathlib import Path

PATIENCE = 600
"""Seconds until something that does not happen is taken for a fault: a machine may be slow."""


def wait_until(condition, seconds=PATIENCE):
    """Return the first true value of a condition."""
    end = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.02)
    return value


def is_running(process):
    """Check if a process runs and is no zombie."""
    try:
        status = Path(f"/proc/{process}/stat").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return False
    return status.rpartition(")")[2].split()[0] != "Z"


def stopped_program(change, name, signal="SIGKILL"):
    """Code of `ballsocket` that a signal stops just before its n-th change of a file or folder with a part of a name.

    A store changes by such steps alone, so that every moment of a kill is like one of these; none depends on time.
    """
    return f"""
import os, signal, sys
changes = []
def listen(event, arguments):
    writes = event == "open" and isinstance(arguments[2], int) and arguments[2] & (os.O_WRONLY | os.O_RDWR)
    if (writes or event in ("os.rename", "os.mkdir", "os.remove")) and {name!r} in str(arguments[:2]):
        changes.append(event)
        if len(changes) == {change}:
            os.kill(os.getpid(), getattr(signal, {signal!r}, signal.SIGTERM))
sys.addaudithook(listen)
from ballsocket.cli import main
main()
"""
