"""Rows of a benchmark, printed and written into RESULTS.md."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from datetime import date
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from .timing import Clock, Job, Spread, in_turns, processor_time

RESULTS = Path(__file__).with_name("RESULTS.md")
HEAD = """# Measured

`python -m benchmarks NAME ... --write` replaces the rows of NAME; those whose rival is not installed stay.
Ours and the rival took turns in one run. Times are medians of one press, step, patient or run: processor time on one
core, unless a row says "by the clock". The ratio is the rival's time over ours, with its least and its largest value
over the rounds.

| NAME | work | ours | rival | ratio | machine, date |
| --- | --- | --- | --- | --- | --- |
"""


@dataclass(frozen=True)
class Row:
    """One row of RESULTS.md; `rival` is "name" or "name: value"."""

    work: str
    ours: str
    rival: str = ""
    ratio: str = ""
    machine: str = ""
    skipped: bool = False

    @property
    def key(self) -> tuple[str, str]:
        """Work and rival without version and value: the row that this one replaces."""
        return self.work, re.sub(r" \d+\.\d[\d.]*\b", "", self.rival.partition(":")[0])

    @property
    def cells(self) -> tuple[str, ...]:
        return self.work, self.ours, self.rival, self.ratio, self.machine


@dataclass(frozen=True)
class Pair:
    """Our job and a rival's; in place of the rival's job stands the reason why it is skipped."""

    work: str
    ours: Job
    rival: str = ""
    theirs: Job | str | None = None


def compare(pairs: Iterable[Pair], repeats: int = 5, clock: Clock = processor_time) -> list[Row]:
    """Time all jobs of the pairs in turns; a job that several pairs share is timed once a round."""
    pairs = list(pairs)
    jobs = [job for pair in pairs for job in (pair.ours, pair.theirs) if isinstance(job, Job)]
    seconds = in_turns(dict.fromkeys(jobs), repeats, clock)
    return [_row(pair, seconds) for pair in pairs]


def _row(pair: Pair, seconds: dict[Job, Spread]) -> Row:
    ours = seconds[pair.ours]
    if isinstance(pair.theirs, Job):
        theirs = seconds[pair.theirs]
        rival, ratio = f"{pair.rival}: {duration(theirs.median)}", ratio_text(theirs.over(ours))
        return Row(pair.work, duration(ours.median), rival, ratio)
    if pair.theirs is None:
        return Row(pair.work, duration(ours.median))
    return Row(pair.work, duration(ours.median), f"{pair.rival}: skipped, {pair.theirs}", skipped=True)


def if_installed(package: str, make: Callable[[], Job]) -> Job | str:
    """Return the job of a rival, or the reason why it is skipped."""
    return f"{package} is not installed" if find_spec(package) is None else make()


def duration(seconds: float) -> str:
    """Three digits of a time in a suitable unit."""
    units = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))
    unit, name = next((unit for unit in units if seconds >= 0.9995 * unit[0]), units[-1])
    return f"{digits(seconds / unit)} {name}"


def ratio_text(ratio: Spread) -> str:
    return f"{digits(ratio.median)} ({digits(min(ratio.values))}..{digits(max(ratio.values))})"


def digits(value: float) -> str:
    """Three digits, without an exponent."""
    places = 0 if abs(value) >= 99.95 else 1 if abs(value) >= 9.995 else 2 if abs(value) >= 0.9995 else 3
    return f"{value:.{places}f}"


def with_version(package: str) -> str:
    """Package and version; the package alone where it is not installed."""
    return package if find_spec(package) is None else f"{package} {version(package)}"


def machine() -> str:
    """Processor, number of cores and date."""
    listed = Path("/proc/cpuinfo")
    lines = listed.read_text(encoding="utf-8").splitlines() if listed.exists() else []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    processor = models[0] if models else platform.processor() or platform.machine()
    return f"{processor}, {os.cpu_count()} cores, {date.today().isoformat()}"


def show(name: str, title: str, rows: Iterable[Row]) -> None:
    """Print the rows without their machine, in aligned columns."""
    cells = [("work", "ours", "rival", "ratio"), *(row.cells[:4] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    print(f"\n{name}: {title}")
    for row in cells:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())


def write(name: str, rows: Sequence[Row], path: Path = RESULTS) -> None:
    """Replace the rows of a benchmark; a skipped row stays as it was measured before."""
    sections = _read(path)
    before = {row.key: row for row in sections.get(name, [])}
    here = machine()
    measured = [before.get(row.key) if row.skipped else replace(row, machine=row.machine or here) for row in rows]
    sections[name] = [row for row in measured if row is not None]
    lines = ("| " + " | ".join((title, *row.cells)) + " |\n" for title, rows in sections.items() for row in rows)
    path.write_text(HEAD + "".join(lines), encoding="utf-8")


def _read(path: Path) -> dict[str, list[Row]]:
    """Rows by the name of their benchmark."""
    sections: dict[str, list[Row]] = {}
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    for line in [line for line in lines if line.startswith("|")][2:]:
        name, work, ours, rival, ratio, where = (cell.strip() for cell in line.split("|")[1:-1])
        sections.setdefault(name, []).append(Row(work, ours, rival, ratio, where))
    return sections
