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
    size = count * sum(numpy.dtype(DTYPES[name]).itemsize for name in task.variables)
    free = _free_memory() if path is None else _free_disk(path)
    if size <= free:
        return
    hours = count * task.model.seconds_a_press / 3600
    where = "of memory; give it a store, or fewer points" if path is None else "on the disk of the store"
    raise ValueError(
        f"{count:.3g} points take about {_bytes(size)} and {_hours(hours)} on one core, and there are "
        f"{_bytes(free)} {where}"
    )


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
