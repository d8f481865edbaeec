"""A call of a tool: its command in a process of its own, killed with all that it started when it takes too long."""

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

from ...core.input_files import restriction_variables
from ...core.storage.array_files import cache_folder
from ..root import DONE

LARGEST = 2_000_000
"""Bytes of an answer."""


@dataclass(frozen=True)
class Told:
    """What a call came to: an answer, a sentence why there is none, or both where it is only half an answer."""

    answer: dict[str, Any] | None
    refusal: str = ""


async def run(words: Sequence[str], folder: Path, longest: float) -> Told:
    """What a command answers.

    Parameters
    ----------
    words : sequence of str
    folder : Path
        Where it works.
    longest : float
        Seconds that it may take.
    """
    with _lifeline() as stdin:
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            *_COMMAND,
            *words,
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
            return Told(None, f"stopped after {longest:g} s, the longest that a call may take here{_KEPT}")
        finally:
            _kill(process)
            await process.wait()
    return _told(process.returncode, out, err.decode("utf-8", errors="replace"))


_COMMAND = ("-P", "-m", "ballsocket.cli.tools.limited")
"""Arguments of Python; -P: a file of the folder that is named as a module is not imported."""


@contextmanager
def _lifeline() -> Iterator[int]:
    """Open a pipe whose reading end is for a child, and whose writing end closes when this process ends."""
    reading, writing = os.pipe()
    try:
        yield reading
    finally:
        os.close(writing)
        os.close(reading)


_KEPT = "; what evidence has finished is kept: ask for it again to go on"


def _kill(process: asyncio.subprocess.Process) -> None:
    """With all that it started."""
    with suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        elif process.returncode is None:
            process.kill()


def _told(status: int | None, out: bytes, err: str) -> Told:
    said = [line.removeprefix("ballsocket: ") for line in err.splitlines() if line.startswith("ballsocket: ")]
    refusal = "" if status == DONE else "; ".join(said) or "its process died; it may have had too little memory"
    if len(out) > LARGEST:
        return Told(None, f"the answer has {len(out)} bytes, and {LARGEST} are the most here: ask for fewer points")
    return Told(json.loads(out) if out.strip() else None, refusal)
