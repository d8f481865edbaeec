"""Whole processes, as a user waits for them, with compiled bytecode: the first answer, and the whole paper.

The paper is by the clock on all cores.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from .report import Pair, Row, compare
from .timing import Job, wall_time

ROOT = Path(__file__).parents[1]
COMPILED = Path(tempfile.gettempdir()) / "ballsocket-benchmarks-compiled"
NUMPY = "import numpy"


def measure() -> list[Row]:
    numpy = _process("-c", NUMPY)
    starts = {"import ballsocket": _process("-c", "import ballsocket")}
    for words in ("--help", "press examples/hip.toml"):
        starts[f"ballsocket {words}"] = _process("-m", "ballsocket", *words.split())
    pairs = [Pair(work, job, NUMPY, numpy) for work, job in starts.items()]
    with tempfile.TemporaryDirectory() as folder:
        paper = [
            Pair(f"ballsocket {words}", _process("-m", "ballsocket", *words.split(), "--out", f"{folder}/{len(words)}"))
            for words in ("reproduce --quick", "reproduce")
        ]
        return [*compare(pairs, repeats=9), *compare(paper, repeats=0, clock=wall_time)]


def checkout_environment() -> dict[str, str]:
    """Environment of a process that imports the package of this checkout."""
    paths = (str(ROOT / "src"), os.environ.get("PYTHONPATH", ""))
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}


def _process(*words: str) -> Job:
    """A process that finds its modules compiled, as installed ones are, and this checkout's package first."""
    compiled = {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(COMPILED)}
    variables = {**checkout_environment(), **compiled, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, *words]
    return Job(lambda: subprocess.run(command, check=True, capture_output=True, env=variables, cwd=ROOT))
