"""Arrays that a later press of the same thread takes up again: new memory has to be asked for, page by page."""

from __future__ import annotations

from math import prod
from threading import local

import numpy

_MOST = 1 << 18  # bytes that are kept of each


class _Held(local):
    """What this thread holds, by name."""

    def __init__(self) -> None:
        self.arrays: dict[str, numpy.ndarray] = {}


_held = _Held()


def scratch(name: str, shape: tuple[int, ...], dtype: type = float) -> numpy.ndarray:
    """An array with whatever was in it, good until the same thread asks for that name again."""
    size = prod(shape)
    if size * numpy.dtype(dtype).itemsize > _MOST:
        return numpy.empty(shape, dtype)
    if name not in _held.arrays:
        _held.arrays[name] = numpy.empty(_MOST, numpy.uint8)
    return _held.arrays[name].view(dtype)[:size].reshape(shape)
