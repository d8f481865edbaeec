"""Available memory and disk space, and checks that a result fits into them."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

_ASSUMED_MEMORY = 4_000_000_000
"""Memory in bytes that is assumed if the system does not state it."""


_GROUPED_COUNT = 10_000
"""Count from which digits are grouped."""


def check_memory(subject: str, size: float) -> None:
    """Check that `size` bytes fit into the available memory.

    Raises
    ------
    ValueError
        The memory is too small; the message begins with `subject`, a plural noun.
    """
    free = available_memory()
    if size > free:
        raise ValueError(f"{subject} take about {size_text(size)}, and there are {size_text(free)} of memory")


def available_memory() -> int:
    """Return the available memory in bytes; half of the installed memory if the system does not state it."""
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    except (OSError, ValueError, AttributeError):
        return _ASSUMED_MEMORY


def available_disk_space(path: Path) -> int:
    """Return the free bytes of the disk on which a path lies, or will lie."""
    folder = path.absolute()
    while not folder.exists():
        folder = folder.parent
    return shutil.disk_usage(folder).free


def count_text(count: int) -> str:
    """Format a count with spaces between groups of three digits, such as "14 800"; plain below 10000."""
    return str(count) if abs(count) < _GROUPED_COUNT else f"{count:,}".replace(",", " ")


def size_text(size: float) -> str:
    """Format a size in bytes with three digits, such as "1.5 GB"."""
    units = ["B", "kB", "MB", "GB", "TB"]
    while size >= 1000 and len(units) > 1:
        size /= 1000
        units.pop(0)
    return f"{size:.3g} {units[0]}"
