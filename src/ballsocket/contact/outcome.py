"""Status, validity and notes of a result, and the properties of the model that they come from."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.lazy import cached_property
from ..core.records import cached_array
from ..core.sources import Source
from ..core.validity import UNIT_REMARKS, Promise, Range, Status, is_missing
from ..problem import Joint


class ModelInfo(ABC):
    """Base class for the description of a model: name, sources and validity."""

    reach: ClassVar[str] = ""
    """Description of the loads that have a result, printed with results that have none; may be empty."""

    planar: ClassVar[bool] = False
    """True if the contact is a flat circle whose pressure has one direction, False if it acts along the radius."""

    is_closed_sphere: ClassVar[bool] = False
    """True for an accurate model of a closed sphere: a cup with a free rim is softer, and its stress may be higher."""

    @property
    @abstractmethod
    def name(self) -> str:
        """Key of the model in the catalogue, in files and on the command line."""

    @property
    @abstractmethod
    def title(self) -> str:
        """One-line description of the model."""

    @property
    @abstractmethod
    def sources(self) -> tuple[Source, ...]:
        """Publications of the model's formulas."""

    @property
    @abstractmethod
    def validity(self) -> tuple[Range, ...]:
        """Closed ranges of contact quantities in which a result is valid."""

    @property
    def promise(self) -> Promise | None:
        """Largest measured difference from the elastic solution inside the validity; None if it was not measured."""
        return None

    @property
    def remarks(self) -> tuple[Range, ...]:
        """Ranges of contact quantities outside of which a valid result gets a note."""
        return ()


class Finding(NamedTuple):
    """Sentence on some points of a result, with a mask of the points that it is not about."""

    spared: Array
    sentence: str

    @property
    def applies(self) -> bool:
        """True if the sentence is about a point."""
        return arrays.all_true(self.spared) is False


def notes_of(findings: Iterable[Finding]) -> tuple[str, ...]:
    """Write the sentences that are about points, each after the number of these if there are several."""
    spared = [(arrays.to_numpy(finding.spared), finding.sentence) for finding in findings if finding.applies]
    return tuple(text if mask.size == 1 else f"{int((~mask).sum())} of {mask.size}: {text}" for mask, text in spared)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class Outcome(ABC):
    """Base class of results, with status, validity and notes of each point."""

    model: ModelInfo  # the model that computed the result
    joint: Joint
    status: Array  # success, or the reason of the failure, of each point

    @property
    @abstractmethod
    def _load(self) -> Array:
        """Load of the result, a float for a single contact; all quantities have its shape and array library."""

    @cached_array
    def valid(self) -> Array:
        """Mask of the valid points: joint and result lie inside the model's validity."""
        mask = (self.status == int(Status.OK)) & (self.broken_limit == 0)
        return mask if self._is_plain else arrays.broadcast(mask, self._load)

    @cached_array
    def broken_limit(self) -> Array:
        """Number of the first range of the validity that a point lies outside of, from 1; 0 inside of all."""
        limits = list(enumerate(self._validity_ranges, 1))
        if self._is_plain:
            return next((number for number, limit in limits if not limit.holds(self)), 0)
        broken = 0 * self.status
        for number, limit in reversed(limits):
            broken = arrays.where(limit.holds(self), broken, number)
        return broken

    @property
    def error(self) -> dict[str, Array]:
        """Estimated relative error of each quantity by name; a quantity whose error is not known is absent.

        Solvers estimate the error of each point. Other models have the measured error of their promise, relative to the
        elastic solution at equal force, and NaN at points that are not valid. Without a promise it is empty.
        """
        nan, errors = numpy.nan + 0.0 * self._load, self.stated_error.items()
        return {name: self._match_load(arrays.where(self.valid, error, nan)) for name, error in errors}

    @property
    def stated_error(self) -> dict[str, Array]:
        """Relative errors as in `error`, also at points that are not valid: these can exceed a limit."""
        promise = self.model.promise
        return {} if promise is None else dict.fromkeys(promise.quantities, promise.within)

    @property
    def _validity_ranges(self) -> tuple[Range, ...]:
        return self.model.validity

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the points, each with the number of points that it is about."""
        return notes_of(self.findings())

    def findings(self) -> Iterator[Finding]:
        """Yield messages on failed points, points outside the model's validity, remarks of the model, and on units."""
        for status in () if arrays.all_true(self.status == int(Status.OK)) else list(Status)[1:]:
            reason = f": {self.model.reach}" if status == Status.NOT_REACHED and self.model.reach else ""
            yield Finding(self.status != int(status), status.sentence + reason)
        limits = () if arrays.all_true(self.valid) else self.model.validity
        for limit in (*limits, *self.model.remarks, *UNIT_REMARKS):
            acceptable = limit.holds(self) | self._failed
            if arrays.all_true(acceptable) is False:
                yield Finding(acceptable, limit.note(self))

    @cached_property
    def _failed(self) -> Array:
        """Mask of the points whose results are NaN."""
        return self.status.failed if self._is_plain else is_missing(self.status)

    @cached_property
    def _is_plain(self) -> bool:
        """True if the numbers of the result are Python numbers, not arrays."""
        return isinstance(self._load, float)

    def _mask_failed(self, compute_quantity: Callable[[], Array]) -> Array:
        """Compute a quantity by a function, and replace its values at failed points by NaN."""
        with arrays.silent_numpy(self._load):  # a failed point has a status, not a warning
            value = compute_quantity()
            return self._match_load(arrays.where(self._failed, numpy.nan, value) if self._has_failed_points else value)

    @cached_property
    def _has_failed_points(self) -> bool:
        """True if at least one point failed, or if JAX traces the status."""
        return arrays.all_true(arrays.logical_not(self._failed)) is not True

    def _match_load(self, value: Array) -> Array:
        """Convert values to the type and the shape of the load, a float for one number, or a read-only array."""
        if type(value) is float:
            return value
        if self._is_plain and getattr(value, "shape", ()) == () and arrays.namespace(value) is numpy:
            return float(value)
        if hasattr(self._load, "shape"):
            return arrays.read_only(arrays.broadcast(value, self._load))
        return value
