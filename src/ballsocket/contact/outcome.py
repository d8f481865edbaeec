"""Status, validity and notes of a result, point by point."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.validity import Range, Status, is_missing
from ..problem import Joint
from .model_info import ModelInfo


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Outcome(ABC):
    """Base class of results, with status, validity and notes of each point.

    Attributes
    ----------
    model : ModelInfo
        The model that computed the result.
    joint : Joint
    status : Status or array of int
        Success, or the reason of the failure, of each point.
    """

    model: ModelInfo
    joint: Joint
    status: Array

    @property
    @abstractmethod
    def _load(self) -> Array:
        """Load of the result, whose shape and array library all quantities have.

        A single contact has a float.
        """

    @cached_property
    def valid(self) -> Array:
        """Mask of the valid points: joint and result lie inside the model's validity."""
        inside = self.status == int(Status.OK)
        for limit in self._limits:
            inside = inside & limit.holds(self)
        inside = arrays.broadcast(inside, self._load) if hasattr(inside, "shape") else inside
        return bool(inside) if self._is_plain else inside

    @property
    def _limits(self) -> tuple[Range, ...]:
        """Ranges that a valid result satisfies."""
        return self.model.validity

    @property
    def notes(self) -> tuple[str, ...]:
        """Messages on failed points and points outside the model's validity, and remarks of the model."""
        notes = []
        for status in list(Status)[1:]:
            reason = f": {self.model.reach}" if status == Status.NOT_REACHED and self.model.reach else ""
            notes += self._note(self.status != int(status), status.sentence + reason)
        for limit in (*self.model.validity, *self.model.remarks):
            notes += self._note(limit.holds(self) | self._failed, limit.sentence)
        return tuple(notes)

    def _note(self, good: Array, sentence: str) -> list[str]:
        """List a note with the number of affected points, where `good` is false; [] if there are none."""
        if arrays.all_true(good) is not False:
            return []
        good = arrays.to_numpy(good)
        return [sentence if good.size == 1 else f"{int((~good).sum())} of {good.size}: {sentence}"]

    @property
    def _failed(self) -> Array:
        """Mask of the points whose results are NaN."""
        return is_missing(self.status)

    @property
    def _is_plain(self) -> bool:
        """True if the result consists of Python numbers."""
        return isinstance(self._load, float)

    def _mask_failed(self, law: Callable[[], Array]) -> Array:
        """Evaluate a function, and replace its values at failed points by NaN."""
        with numpy.errstate(all="ignore"):  # a failed point has a status, not a warning
            value = law()
            return self._match_load(arrays.where(self._failed, numpy.nan, value) if self._some_failed else value)

    @cached_property
    def _some_failed(self) -> bool:
        """True if at least one point failed, or if the status is traced."""
        return self.status.failed if self._is_plain else arrays.all_true(arrays.logical_not(self._failed)) is not True

    @cached_property
    def _numpy_joint(self) -> Joint:
        """Joint with its numbers as NumPy arrays; divisions by zero become infinite instead of raising."""
        return self.joint.with_numbers(arrays.to_common_arrays(*self.joint.numbers())) if self._is_plain else self.joint

    def _match_load(self, value: Array) -> Array:
        """Convert a value to the type and the shape of the load: a float for plain numbers."""
        if type(value) is float:
            return value
        if self._is_plain and getattr(value, "shape", ()) == () and arrays.namespace(value) is numpy:
            return float(value)
        if hasattr(self._load, "shape"):
            return arrays.broadcast(value, self._load)
        return value
