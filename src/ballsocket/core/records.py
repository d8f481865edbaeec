"""Records: NumPy arrays that cannot be changed, in the fields and cached properties of results, and in inputs."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

from . import arrays
from .lazy import cached_property


class Record:
    """Base class of frozen dataclasses of results: the NumPy arrays in their fields are read-only."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            object.__setattr__(self, name, arrays.read_only(value))


class Input:
    """Base class of frozen dataclasses of inputs: the NumPy arrays in their fields are read-only copies."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            object.__setattr__(self, name, arrays.owned(value))


if TYPE_CHECKING:
    cached_array = cached_property
else:

    class cached_array(cached_property):  # noqa: N801 - as `cached_property`
        """Cached property whose NumPy array is read-only."""

        def __init__(self, function: Callable[[Any], Any]) -> None:
            super().__init__(wraps(function)(lambda instance: arrays.read_only(function(instance))))
