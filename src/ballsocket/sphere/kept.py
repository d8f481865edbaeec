"""What takes long to set up, kept on disk: shared by processes, checked when read, made anew where it is not sound."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import numpy

from ..arrays import Numbers
from ..atomic import at_once

VERSION = 1
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
    path = folder() / f"cup-{sha256(f'{VERSION} {key!r}'.encode()).hexdigest()[:32]}.rings"
    found = _read(path)
    if found is None:
        found = make()
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            _write(path, found)
            _thin_out(path.parent)
    return found


def _read(path: Path) -> Numbers | None:
    """The array of a file, or None where there is none or it is damaged."""
    try:
        raw = path.read_bytes()
        size = int.from_bytes(raw[:8], "little")
        shape = tuple(int.from_bytes(raw[8 + 8 * i : 16 + 8 * i], "little") for i in range(3))
        digest, body = raw[32:64], raw[64:]
        if size != len(body) or sha256(body).digest() != digest:
            return None
        return numpy.frombuffer(body).reshape(shape)
    except (OSError, ValueError):
        return None


def _write(path: Path, values: Numbers) -> None:
    """Size and shape in eight bytes each, the checksum, the numbers."""
    body = numpy.ascontiguousarray(values, dtype="<f8").tobytes()
    head = b"".join(number.to_bytes(8, "little") for number in (len(body), *values.shape))
    with at_once(path) as draft:
        draft.write_bytes(head + sha256(body).digest() + body)


def _thin_out(room: Path) -> None:
    """Remove the oldest files while there is too much."""
    files = sorted(room.glob("cup-*.rings"), key=lambda path: path.stat().st_mtime, reverse=True)
    total = 0
    for path in files:
        total += path.stat().st_size
        if total > _MOST:
            path.unlink(missing_ok=True)
