"""Blocks of large studies, processor time of Dask for each, and memory of samples, beside another checkout.

The rival is an earlier version of this package: `--other CHECKOUT`. Fair, because each version runs the same script in
processes of its own, in turns. Dask runs a scheduler and one worker as processes of their own, and the pieces do
nothing. Processor time is taken, since it depends less on other work of the machine than the time of a clock.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from .report import Report, Rows
from .timing import Spread

ROOT = Path(__file__).parents[1]
REPEATS, PIECES, SAMPLES = 3, 1000, 2_000_000

_BLOCKS = """
import ballsocket as bs
from ballsocket.studies.design import Span
from ballsocket.studies.run import _create_task
for count in (10**4, 10**6, 10**8):
    axes = {"force": Span(1e3, 2e3, count)}
    print(len(_create_task(bs.Exact(), bs.joints["hess-forsbach"], None, axes, ()).blocks))
"""

_PIECES = """
import sys, time
from ballsocket.core.executors import Distributed
list(Distributed(address=sys.argv[1]).run(abs, range(10)))
start = time.process_time()
list(Distributed(address=sys.argv[1]).run(abs, range(int(sys.argv[2]))))
print(time.process_time() - start)
"""

_MEMORY = """
import sys, tracemalloc
import ballsocket as bs
from ballsocket.studies import Rectangular, sample, tolerance
count, hip = int(sys.argv[1]), bs.joints["hess-forsbach"]
scatter = {"clearance": tolerance(0.1, 0.05), "liner_poisson": Rectangular(low=0.3, high=0.4)}
bs.study(bs.HessForsbach(), hip, sample(64, **scatter), force=1e3)
tracemalloc.start()
bs.study(bs.HessForsbach(), hip, sample(count, **scatter), force=1e3)
print(tracemalloc.get_traced_memory()[1] / count)
"""


def run(checkout: Path, code: str, *words: object) -> list[float]:
    """The numbers that a script prints with the package of a checkout."""
    command = [sys.executable, "-c", code, *map(str, words)]
    done = subprocess.run(command, env=environment(checkout), check=True, capture_output=True, encoding="utf-8")
    return [float(word) for word in done.stdout.split()]


def environment(checkout: Path) -> dict[str, str]:
    """Environment of a process that imports the package of a checkout."""
    return {**os.environ, "PYTHONPATH": str(checkout / "src"), "OPENBLAS_NUM_THREADS": "1"}


@contextmanager
def dask(checkout: Path) -> Iterator[tuple[str, int, int]]:
    """Address of a scheduler with a worker, and the numbers of both processes."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        common = ("--no-dashboard", "--host", "127.0.0.1", "--scheduler-file", str(file))
        words = [("scheduler", *common, "--port", "0"), ("worker", *common, "--no-nanny", "--nthreads", "1")]
        options = {"env": environment(checkout), "cwd": folder, "stdout": subprocess.DEVNULL}
        processes = [
            subprocess.Popen([sys.executable, "-m", "dask", *line], stderr=subprocess.DEVNULL, **options)  # type: ignore[call-overload]
            for line in words
        ]
        try:
            while not file.exists() or not file.read_text(encoding="utf-8").strip():
                time.sleep(0.1)
            yield json.loads(file.read_text(encoding="utf-8"))["address"], processes[0].pid, processes[1].pid
        finally:
            for process in processes:
                process.terminate()
                process.wait()


def processor_seconds(process: int) -> float:
    """Processor time that a process has used."""
    parts = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(parts[11]) + int(parts[12])) / os.sysconf("SC_CLK_TCK")


def milliseconds_a_piece(checkout: Path) -> tuple[float, float, float]:
    """Processor time of scheduler, worker and client for an empty piece."""
    with dask(checkout) as (address, *servers):
        run(checkout, _PIECES, address, 10)  # both have imported what they need
        before = [processor_seconds(process) for process in servers]
        (client,) = run(checkout, _PIECES, address, PIECES)
        taken = [processor_seconds(process) - start for process, start in zip(servers, before, strict=True)]
    scheduler, worker = (1e3 * seconds / PIECES for seconds in taken)
    return scheduler, worker, 1e3 * client / PIECES


def measure(other: str | None = None) -> Report:
    checkouts = [ROOT] if other is None else [ROOT, Path(other)]
    rows = Rows("Large studies", ("what", "ours", "before"))
    for name, numbers in zip(
        ("10^4", "10^6", "10^8"), zip(*(run(checkout, _BLOCKS) for checkout in checkouts), strict=True), strict=True
    ):
        rows.add(f"blocks of {name} exact presses", *(f"{number:.0f}" for number in numbers))
    rounds = [[milliseconds_a_piece(checkout) for checkout in checkouts] for _ in range(REPEATS)]
    for part, name in enumerate(("scheduler", "worker", "client")):
        spreads = (Spread(tuple(turn[version][part] for turn in rounds)) for version in range(len(checkouts)))
        rows.add(f"Dask, {PIECES} empty pieces: {name}, ms of processor time a piece", *spreads)
    memory = (run(checkout, _MEMORY, SAMPLES)[0] for checkout in checkouts)
    rows.add(f"{SAMPLES} samples of two numbers: bytes of memory a point", *(f"{size:.0f}" for size in memory))
    return Report([rows], ["Numbers of a machine that did other work at the same time."], ("dask", "distributed"))
