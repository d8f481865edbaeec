"""Is there room for a study? Asked before anything is computed."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy

from .task import DTYPES, Task


def check_room(task: Task, path: Path | None, points: int | None = None) -> None:
    """Raise ValueError, with the size and the time that a study takes, where memory (or the disk) is too small.

    `points` are those that are still to come, all of them by default.
    """
    count = task.design.size if points is None else points
    answers = count * sum(numpy.dtype(DTYPES[name]).itemsize for name in task.variables)
    values = 8 * sum(len(axis) * len(axis.names) for axis in task.design.axes)
    time = f"{count:.3g} points take about {{}} and {_hours(count * task.model.seconds_a_press / 3600)} on one core"
    if path is None:
        size, free = answers + _COPIES * values, _free_memory()
        _refuse(time, size, free, "of memory; give it a store, or fewer points")
        return
    _refuse(time, _COPIES * values, _free_memory(), "of memory for the values along its axes; take fewer")
    labels = values if points is None else 0
    _refuse(time, answers + labels, _free_disk(path), "on the disk of the store")


def check_rows(title: str, rows: int, columns: int) -> None:
    """Raise ValueError where the values of so many rows do not fit into the memory."""
    size, free = _COPIES * 8 * rows * columns, _free_memory()
    if size > free:
        raise ValueError(
            f"{rows:.3g} rows of {title} take about {_bytes(size)}, and there are {_bytes(free)} of memory"
        )


def check_samples(count: int) -> None:
    """Raise ValueError where the intervals of indices of so many samples do not fit into the memory."""
    size, free = 40_000 * count + 25 * count**2, _free_memory()  # as measured: SciPy leaves out each sample in turn
    if size > free:
        raise ValueError(
            f"intervals of {count} samples take about {_bytes(size)}, and there are {_bytes(free)} of memory"
        )


_COPIES = 3  # of the values along an axis: as drawn, as scaled, as labels


def _refuse(time: str, size: int, free: int, where: str) -> None:
    if size > free:
        raise ValueError(f"{time.format(_bytes(size))}, and there are {_bytes(free)} {where}")


def _free_disk(path: Path) -> int:
    folder = path.absolute()
    while not folder.exists():
        folder = folder.parent
    return shutil.disk_usage(folder).free


def _free_memory() -> int:
    """Without another library: pages that are free or can be, where the system tells, else 4 GB."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    except (OSError, ValueError, AttributeError):
        return 4_000_000_000


def _bytes(size: float) -> str:
    units = ["B", "kB", "MB", "GB", "TB"]
    while size >= 1000 and len(units) > 1:
        size /= 1000
        units.pop(0)
    return f"{size:.3g} {units[0]}"


def _hours(hours: float) -> str:
    if hours < 1 / 60:
        return f"{3600 * hours:.2g} s"
    return f"{60 * hours:.2g} minutes" if hours < 1 else f"{hours:.3g} hours"
