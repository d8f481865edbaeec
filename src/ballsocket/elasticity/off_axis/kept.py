"""What takes long to set up, kept on disk: shared by processes, checked when read, made anew where it is not sound."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

from ...core.arrays import Numbers
from ...core.storage.npz import read_arrays, write_arrays

VERSION = 3
"""Of what is kept: a change of the elements or of the rings makes it another."""

_MOST = 2 * 2**30
"""Bytes in the folder; the oldest files go first."""


def folder() -> Path:
    """Where it is kept: the environment's BALLSOCKET_CACHE, or a folder of the user's cache."""
    named = os.environ.get("BALLSOCKET_CACHE")
    if named:
        return Path(named)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ballsocket"


def kept(key: object, make: Callable[[], Numbers]) -> Numbers:
    """An array by its key: read, or made and written. Where nothing can be written it is made each time.

    Parameters
    ----------
    key : object
        Whatever it depends on, as its `repr` tells.
    make : function
    """
    path = folder() / f"cup-{sha256(f'{VERSION} {key!r}'.encode()).hexdigest()[:32]}.npz"
    found = _read(path)
    if found is None:
        found = make()
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            write_arrays(path, rings=found)
            _thin_out(path.parent)
    return found


def _read(path: Path) -> Numbers | None:
    """The array of a file, or None where there is none or it is damaged."""
    try:
        return read_arrays(path)["rings"]
    except (OSError, ValueError, KeyError):
        return None


def _thin_out(room: Path) -> None:
    """Remove the oldest files while there is too much."""
    files = sorted(room.glob("cup-*"), key=lambda path: path.stat().st_mtime, reverse=True)
    total = 0
    for path in files:
        total += path.stat().st_size
        if total > _MOST:
            path.unlink(missing_ok=True)
