"""The whole paper by one command, as a user waits for it: quick, full, and once more when everything is kept.

No rival does this; the aims are ten seconds and five minutes on two cores.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from .report import Report, Rows
from .timing import Spread

QUICK_ROUNDS = 5
AIMS = {"quick": 10.0, "full": 300.0}


def seconds(folder: Path, *options: str) -> float:
    start = time.perf_counter()
    words = [sys.executable, "-m", "ballsocket", "reproduce", *options, "--out", str(folder)]
    subprocess.run(words, check=True, capture_output=True)
    return time.perf_counter() - start


def measure() -> Report:
    rows = Rows("The command, seconds", ("what", "ours", "aim", "verdict"))
    with TemporaryDirectory() as room:
        quick = Spread(tuple(seconds(Path(room) / f"quick{turn}", "--quick") for turn in range(QUICK_ROUNDS)))
        full = Spread((seconds(Path(room) / "full"),))
        again = Spread((seconds(Path(room) / "full"),))
    for name, taken in (("quick", quick), ("full", full)):
        rows.add(name, taken, f"{AIMS[name]:g}", "met" if taken.median <= AIMS[name] else "missed")
    rows.add("full, all pieces kept", again, "", "")
    return Report([rows], ["A fresh process each time; one worker for each of the two cores."], ("scipy", "matplotlib"))
