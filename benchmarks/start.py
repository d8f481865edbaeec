"""How long a fresh interpreter takes: to import the package, and to answer a joint file on the command line.

Measured as whole processes, as a user waits for them, against an interpreter that does nothing and against one that
imports only NumPy, which no array package can be without. Fair, because all of them start the same interpreter in the
same environment, with compiled bytecode and the files in the system's cache, in turns.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

from .report import Report, Rows
from .timing import Spread, Work, interleaved

REPEATS, AIM = 15, 0.3  # AIM in seconds
ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples" / "hip.toml"
COMPILED = Path(tempfile.gettempdir()) / "ballsocket-benchmarks-compiled"
COMMANDS = {
    "python -c pass": ("-c", "pass"),
    "import numpy": ("-c", "import numpy"),
    "import ballsocket": ("-c", "import ballsocket"),
    "ballsocket press examples/hip.toml": ("-m", "ballsocket", "press", str(EXAMPLE)),
    "ballsocket --help": ("-m", "ballsocket", "--help"),
}
AIMS = {"ballsocket press examples/hip.toml": "0.5", "ballsocket --help": "0.25"}


def process(words: tuple[str, ...], **environment: str) -> Work:
    """A process that finds its modules compiled, as installed ones are, also where the shell turns that off."""
    variables = {**os.environ, "PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(COMPILED), **environment}
    return lambda: subprocess.run([sys.executable, *words], check=True, capture_output=True, env=variables)


def processor_seconds(words: tuple[str, ...], checkout: Path) -> float:
    """Processor time of a whole process with the package of a checkout; linear algebra has one thread."""
    work = process(words, PYTHONPATH=str(checkout / "src"), OPENBLAS_NUM_THREADS="1")
    before = getrusage(RUSAGE_CHILDREN)
    work()
    after = getrusage(RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def processor_time(other: str) -> Rows:
    """Processor time of each process, beside that of another checkout, in turns."""
    rows = Rows("Processor time of a fresh process, seconds", ("what", "ours", "before", "aim"))
    for name, words in COMMANDS.items():
        rounds = [[processor_seconds(words, path) for path in (ROOT, Path(other))] for _ in range(REPEATS + 1)]
        ours, before = (Spread(times[1:]) for times in zip(*rounds, strict=True))  # the first compiles
        rows.add(name, ours, before, AIMS.get(name, ""))
    return rows


def measure(other: str | None = None) -> Report:
    _, seconds = interleaved(REPEATS, {name: process(words) for name, words in COMMANDS.items()})
    bare, numpy_only, imported, pressed, _ = seconds.values()
    rows = Rows("A fresh process, seconds", ("what", "ours", "rival", "ratio"))
    ours, command = list(COMMANDS)[2:4]
    rows.add(
        f"{ours}, against the aim",
        imported,
        f"aim {AIM:g}",
        f"{imported.per(AIM)} of the aim: {'met' if imported.median <= AIM else 'missed'}",
    )
    for name, taken in ((ours, imported), (command, pressed)):
        for rival, its in (("python -c pass", bare), ("import numpy", numpy_only)):
            rows.add(f"{name}, against {rival}", taken, its, f"{taken.over(its)} times as long")
    rows.add(
        f"{ours}, without the bare interpreter",
        imported.less(bare),
        numpy_only.less(bare),
        f"{imported.less(bare).over(numpy_only.less(bare))} times NumPy",
    )
    return Report(
        [rows] if other is None else [rows, processor_time(other)],
        [
            "The processes run from this checkout's environment; the command as `python -m ballsocket`.",
            "Processor times are with one thread of linear algebra; before is the checkout of `--other`.",
        ],
        ("scipy",),
    )
