"""What every press ends with: numbers of one shape, how it went point by point, and where the model can be trusted."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.validity import Range, Status, is_missing
from ..problem import Joint


class Answerer(Protocol):
    """What an outcome knows of what answered."""

    @property
    def name(self) -> str: ...
    @property
    def validity(self) -> tuple[Range, ...]: ...
    @property
    def remarks(self) -> tuple[Range, ...]: ...
    @property
    def reach(self) -> str: ...


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Outcome(ABC):
    """A pressed joint: what answered, how it ended, and what is to be said of it."""

    model: Answerer
    joint: Joint
    status: Array

    @property
    @abstractmethod
    def _load(self) -> Array:
        """A load, which has the shape and the library of every other quantity: a plain number, or an array."""

    @cached_property
    def valid(self) -> Array:
        """Whether joint and answer lie inside the model's validity, point by point."""
        inside = self.status == int(Status.OK)
        for limit in self._limits:
            inside = inside & limit.holds(self)
        inside = arrays.broadcast(inside, self._load) if hasattr(inside, "shape") else inside
        return bool(inside) if self._is_plain else inside

    @property
    def _limits(self) -> tuple[Range, ...]:
        """What has to hold of a valid answer."""
        return self.model.validity

    @property
    def notes(self) -> tuple[str, ...]:
        """What has no answer, what is outside the model's validity, and its remarks; empty where all is well."""
        notes = []
        for status in list(Status)[1:]:
            more = f": {self.model.reach}" if status == Status.NOT_REACHED and self.model.reach else ""
            notes += self._note(self.status != int(status), status.sentence + more)
        for limit in (*self.model.validity, *self.model.remarks):
            notes += self._note(limit.holds(self) | self._failed, limit.sentence)
        return tuple(notes)

    def _note(self, good: Array, sentence: str) -> list[str]:
        if arrays.all_true(good) is not False:
            return []
        good = arrays.to_numpy(good)
        return [sentence if good.size == 1 else f"{int((~good).sum())} of {good.size}: {sentence}"]

    @property
    def _failed(self) -> Array:
        return is_missing(self.status)

    @property
    def _is_plain(self) -> bool:
        return isinstance(self._load, float)

    def _mask_failed(self, law: Callable[[], Array]) -> Array:
        with numpy.errstate(all="ignore"):  # a point without an answer has a status, not a warning
            value = law()
            return self._match_load(arrays.where(self._failed, numpy.nan, value) if self._some_failed else value)

    @cached_property
    def _some_failed(self) -> bool:
        return self.status.failed if self._is_plain else arrays.all_true(arrays.logical_not(self._failed)) is not True

    @cached_property
    def _numbers(self) -> Joint:
        """The joint for formulas: NumPy numbers in place of plain ones, which raise where those become infinite."""
        return self.joint.with_numbers(arrays.to_common_arrays(*self.joint.numbers())) if self._is_plain else self.joint

    def _match_load(self, value: Array) -> Array:
        """The answer to plain numbers in plain numbers."""
        if type(value) is float:
            return value
        if self._is_plain and getattr(value, "shape", ()) == () and arrays.namespace(value) is numpy:
            return float(value)
        if hasattr(self._load, "shape"):
            return arrays.broadcast(value, self._load)
        return value
