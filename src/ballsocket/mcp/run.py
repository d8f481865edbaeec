"""Call of a tool: its command in a separate process, killed with its children at a time limit."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.input_files import restriction_variables
from ..core.storage.array_files import cache_folder

MAX_ANSWER = 2_000_000
"""Largest size of an answer in bytes."""


@dataclass(frozen=True)
class CallResult:
    """Result of a call: an answer, a refusal, or both if the answer is incomplete."""

    answer: dict[str, Any] | None
    refusal: str = ""


async def run(arguments: Sequence[str], folder: Path, longest: float) -> CallResult:
    """Run a command in a separate Python process, and return its result.

    Parameters
    ----------
    arguments : sequence of str
        Arguments of Python: those of the program, the name of the command and its arguments.
    folder : Path
        Working folder of the process.
    longest : float
        Time limit in seconds.
    """
    with _lifeline() as stdin:
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            *arguments,
            cwd=folder,
            env={**os.environ, **restriction_variables((folder, cache_folder()))},
            stdin=stdin,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            start_new_session=True,
        )
        try:
            out, err = await asyncio.wait_for(process.communicate(), longest)
        except TimeoutError:
            return CallResult(None, f"stopped after {longest:g} s, the time limit of a call here{_RESUME}")
        finally:
            _kill(process)
            await process.wait()
    return _call_result(process.returncode, out, err.decode("utf-8", errors="replace"))


_RESUME = "; the finished parts of an evidence pack are stored: call the tool again to resume"


@contextmanager
def _lifeline() -> Iterator[int]:
    """Open a pipe whose reading end is for a child, and whose writing end closes when this process ends."""
    reading, writing = os.pipe()
    try:
        yield reading
    finally:
        os.close(writing)
        os.close(reading)


def _kill(process: asyncio.subprocess.Process) -> None:
    """Kill a process and its children."""
    with suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        elif process.returncode is None:
            process.kill()


def _call_result(status: int | None, out: bytes, err: str) -> CallResult:
    """Return the result of a process from its exit status and its output."""
    messages = [line.removeprefix("ballsocket: ") for line in err.splitlines() if line.startswith("ballsocket: ")]
    refusal = "" if status == 0 else "; ".join(messages) or "its process died; it may have had too little memory"
    if len(out) > MAX_ANSWER:
        return CallResult(None, f"the answer has {len(out)} bytes; allowed are {MAX_ANSWER}: request fewer points")
    return CallResult(json.loads(out) if out.strip() else None, refusal)
