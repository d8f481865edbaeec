"""Ten million presses into a store, a million from the tables, ten thousand exact ones; and what a study adds to them.

The rival is the model called directly in chunks of the same size, without labels, store or engine: what a user would
write by hand. Fair, because both compute the same quantities with the same model in the same process, in turns.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy

import ballsocket as bs
from ballsocket.contact import Model
from ballsocket.core.executors import Distributed, Engine, Processes, Serial
from ballsocket.core.executors.dask import local_cluster
from ballsocket.studies.design import Design, Span, grid
from ballsocket.studies.task import DEFAULT_QUANTITIES, DTYPES, Blocks

from .report import Report, Rows
from .timing import Spread, Work, _seconds, interleaved

HIP = bs.joints["hess-forsbach"]
REPEATS = 3
SIZES = (3, 4, 5, 6, 7, 8)


def points(count: int, loads: int) -> Design:
    """So many points in all, `loads` of them to a joint."""
    joints = round((count / loads) ** 0.5)
    return grid(
        clearance=Span(0.05, 0.2, joints), ball_radius=Span(11.0, 23.0, joints), force=Span(500.0, 4000.0, loads)
    )


def direct(model: Model, design: Design, chunk: int = 1 << 14) -> None:
    """The same quantities by hand, into arrays of the same shape."""
    whole = {name: numpy.empty(design.shape, dtype=DTYPES[name]) for name in (*DEFAULT_QUANTITIES, "status", "valid")}
    blocks = Blocks.divide(design.shape, chunk)
    for number in range(len(blocks)):
        place = blocks[number]
        values = design.values_in(place)
        joint = bs.Joint(
            ball_radius=values["ball_radius"],
            clearance=values["clearance"],
            liner_thickness=HIP.liner_thickness,
            liner=HIP.liner,
            ball=HIP.ball,
        )
        contact = model.press(joint, force=values["force"])
        for name, array in whole.items():
            array[place] = getattr(contact, name)


def stored(model: Model, design: Design, engine: Engine) -> float:
    """Seconds of a study into a fresh store."""
    with TemporaryDirectory() as folder:
        return _seconds(lambda: bs.study(model, HIP, design, store=Path(folder) / "s.zarr", engine=engine))


def speed(rows: Rows) -> None:
    closed, tabulated, exact = bs.HessForsbach(), bs.Tabulated(), bs.Exact()
    million, single = points(1_000_000, 100), points(1_000_000, 1)
    for name, model, design, engine, aim in (
        ("10^7, paper's model, one core", closed, points(10_000_000, 1000), Serial(), 10.0),
        ("10^6, tabulated, 100 loads a joint, one core", tabulated, million, Serial(), 5.0),
        ("10^6, tabulated, a joint a press, one core", tabulated, single, Serial(), 5.0),
        ("10^6, tabulated, a joint a press, two processes", tabulated, single, Processes(workers=2), 5.0),
        ("10^4, exact, a joint a press, two processes", exact, points(10_000, 1), Processes(workers=2), 30.0),
        ("10^4, exact, 10 loads a joint, two processes", exact, points(10_000, 10), Processes(workers=2), 30.0),
    ):
        taken = Spread(tuple(stored(model, design, engine) for _ in range(REPEATS)))
        rows.add(f"{name}, into Zarr", taken, f"{aim:g}", "met" if taken.median <= aim else "missed")


def overhead(rows: Rows) -> None:
    closed, design = bs.HessForsbach(), points(10_000_000, 1000)
    _, seconds = interleaved(
        REPEATS, {"study": lambda: bs.study(closed, HIP, design), "direct": lambda: direct(closed, design)}
    )
    ratio = seconds["study"].over(seconds["direct"])
    rows.add("10^7, paper's model, in memory", seconds["study"], seconds["direct"], f"{ratio} times as long; aim 1.2")
    exact, few = bs.Exact(), points(2500, 1)
    with local_cluster(1) as first, local_cluster(2) as second:
        one, two = str(first.scheduler_address), str(second.scheduler_address)
        works: dict[str, Work] = {
            "direct": lambda: direct(exact, few, 1 << 7),
            "one worker": lambda: bs.study(exact, HIP, few, engine=Distributed(address=one)),
            "two workers": lambda: bs.study(exact, HIP, few, engine=Distributed(address=two)),
        }
        _, seconds = interleaved(REPEATS, works)
    more = seconds["one worker"].less(seconds["direct"]).per(1e-3 * 2500)
    rows.add(
        "2500 exact, Dask with one worker", seconds["one worker"], seconds["direct"], f"{more} ms more a case; aim 0.1"
    )
    ratio = seconds["one worker"].over(seconds["two workers"])
    rows.add(
        "2500 exact, Dask with two workers",
        seconds["two workers"],
        seconds["one worker"],
        f"{ratio} times faster; aim 1.7",
    )


_ONE = """
import sys, time
import ballsocket as bs
from benchmarks.studies import HIP, points
design = points(10 ** int(sys.argv[1]), 1000 if int(sys.argv[1]) > 5 else 10)
start = time.perf_counter()
bs.study(bs.HessForsbach(), HIP, design, store=sys.argv[2])
seconds = time.perf_counter() - start
lines = open("/proc/self/status").read().splitlines()
print(seconds, *(int(line.split()[1]) / 1e6 for line in lines if line.startswith("VmHWM")))
"""


def size(power: int) -> tuple[float, float]:
    """Seconds, and the largest memory in GB, of 10^power presses of the paper's model in a process of their own."""
    with TemporaryDirectory() as folder:
        words = [sys.executable, "-c", _ONE, str(power), f"{folder}/s.zarr"]
        answer = subprocess.run(words, check=True, capture_output=True, encoding="utf-8", cwd=Path(__file__).parents[1])
    seconds, memory = map(float, answer.stdout.split())
    return seconds, memory


def measure() -> Report:
    fast = Rows("Studies into a store, seconds", ("what", "ours", "aim", "verdict"))
    speed(fast)
    more = Rows("What a study adds, seconds", ("what", "ours", "rival", "ratio"))
    overhead(more)
    grown = Rows(
        "Cost against size: the paper's model into Zarr, one core", ("presses", "seconds", "ns a press", "GB at most")
    )
    found = [(power, *size(power)) for power in SIZES]
    for power, seconds, memory in found:
        grown.add(f"10^{power}", f"{seconds:.3g}", f"{1e9 * seconds / 10**power:.3g}", f"{memory:.2f}")
    _draw(found)
    return Report([fast, more, grown], ["docs/study_cost.png shows the cost against size."], ("xarray", "zarr", "dask"))


def _draw(found: list[tuple[int, float, float]]) -> None:
    from matplotlib.figure import Figure

    from ballsocket.reports.figure_files import save
    from ballsocket.reports.style import finish, in_matplotlib, line_of

    presses = [10.0**power for power, _, _ in found]
    figure = Figure(figsize=(8.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    style = {**in_matplotlib(line_of("hess-forsbach")), "marker": "o"}
    left.loglog(presses, [seconds for _, seconds, _ in found], label="measured", **style)
    last = found[-1][1] / presses[-1]
    left.loglog(presses, [last * each for each in presses], ":", color="0.5", label=f"{1e9 * last:.0f} ns a press")
    right.semilogx(presses, [memory for _, _, memory in found], **style)
    right.set_ylim(0.0, 1.0)
    finish(left, "presses of the paper's model into Zarr", "seconds on one core")
    finish(right, "presses of the paper's model into Zarr", "memory at most [GB]")
    left.legend(frameon=False)
    save(figure, Path(__file__).parents[1] / "docs" / "study_cost.png")
