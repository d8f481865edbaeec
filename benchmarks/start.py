"""How long a fresh interpreter takes: to import the package, and to answer a joint file on the command line.

Measured as whole processes, as a user waits for them, against an interpreter that does nothing and against one that
imports only NumPy, which no array package can be without. Fair, because all of them start the same interpreter in the
same environment, with compiled bytecode and the files in the system's cache, in turns.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from .report import Report, Rows
from .timing import Work, interleaved

REPEATS, AIM = 15, 0.3  # AIM in seconds
EXAMPLE = Path(__file__).parents[1] / "examples" / "hip.toml"
COMMANDS = {
    "python -c pass": ("-c", "pass"),
    "import numpy": ("-c", "import numpy"),
    "import ballsocket": ("-c", "import ballsocket"),
    "ballsocket press examples/hip.toml": ("-m", "ballsocket", "press", str(EXAMPLE)),
}


def process(words: tuple[str, ...]) -> Work:
    return lambda: subprocess.run([sys.executable, *words], check=True, capture_output=True)


def measure() -> Report:
    _, seconds = interleaved(REPEATS, {name: process(words) for name, words in COMMANDS.items()})
    bare, numpy_only, imported, pressed = seconds.values()
    rows = Rows("A fresh process, seconds", ("what", "ours", "rival", "ratio"))
    ours, command = list(COMMANDS)[2:]
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
        [rows],
        ["The processes run from this checkout's environment; the command as `python -m ballsocket`."],
        ("scipy",),
    )
