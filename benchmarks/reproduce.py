"""The whole paper by one command, by the clock on all cores."""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from .report import Pair, Row, compare
from .start import checkout_environment
from .timing import Job, wall_time


def measure() -> list[Row]:
    with TemporaryDirectory() as folder:
        commands = {"ballsocket reproduce --quick": ["--quick"], "ballsocket reproduce": []}
        pairs = [Pair(name, _reproduce(Path(folder) / name, options)) for name, options in commands.items()]
        return compare(pairs, repeats=0, clock=wall_time)


def _reproduce(folder: Path, options: list[str]) -> Job:
    words = [sys.executable, "-m", "ballsocket", "reproduce", *options, "--out", str(folder)]
    return Job(partial(subprocess.run, words, check=True, capture_output=True, env=checkout_environment()))
