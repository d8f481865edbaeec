"""Axes of a study: listed values, equal steps, samples of distributions; and the check of their values."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.quantities import QUANTITIES
from .distributions import CHUNK_SIZE, Distribution, Method, copula_matrix, correlate, draw_chunk

MAX_COUNT = 10**15
"""Largest number of values along an axis."""


class Axis(ABC):
    """Dimension of a study: one or more parameters that vary together."""

    name: str
    labels: tuple[str, ...] = ()
    """Texts for the positions along the axis, which are names of materials; empty for an axis of numbers."""
    remark: str = ""
    """Rows of a file that were read, and lines that were left out; empty without such lines."""

    @property
    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""

    @abstractmethod
    def __len__(self) -> int: ...

    @abstractmethod
    def values_in(self, section: slice = slice(None)) -> Mapping[str, Numbers]:
        """Return the values of each parameter in a section of the axis, float64."""

    @property
    def sections(self) -> Iterator[slice]:
        """Sections of at most `CHUNK_SIZE` values, in which large axes are written."""
        return (slice(start, min(start + CHUNK_SIZE, len(self))) for start in range(0, len(self), CHUNK_SIZE))


@dataclass(frozen=True, eq=False)
class ListedAxis(Axis):
    """Axis of listed values: of one parameter, of the properties of materials, or of the columns of a table."""

    name: str
    columns: Mapping[str, Numbers]
    labels: tuple[str, ...] = ()
    remark: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def values_in(self, section: slice = slice(None)) -> Mapping[str, Numbers]:
        return {name: column[section] for name, column in self.columns.items()}


@dataclass(frozen=True)
class Span:
    """Range of `count` numbers with equal steps from `low` to `high`.

    Raises
    ------
    ValueError
        An end that is not finite, no value, or more than `MAX_COUNT` values.

    Examples
    --------
    >>> from ballsocket.studies.design import grid
    >>> grid(force=Span(500.0, 4000.0, 8)).values_in([slice(None)])["force"]
    array([ 500., 1000., 1500., 2000., 2500., 3000., 3500., 4000.])
    """

    low: float
    high: float
    count: int

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            value = getattr(self, name)
            require(name, value, abs(value) < inf, "the end of a span is finite")
        require("count", self.count, 1 <= self.count <= MAX_COUNT, "a span has at least one value, at most 1e15")


@dataclass(frozen=True)
class SpanAxis(Axis):
    """Axis of one parameter with equal steps, computed when they are used."""

    name: str
    span: Span

    @property
    def names(self) -> tuple[str, ...]:
        return (self.name,)

    def __len__(self) -> int:
        return self.span.count

    def values_in(self, section: slice = slice(None)) -> Mapping[str, Numbers]:
        low, high, count = self.span.low, self.span.high, self.span.count
        start, stop, _ = section.indices(count)
        values = numpy.arange(start, stop, dtype=float)  # in place: a span may fill the memory
        values *= (high - low) / max(1, count - 1)
        values += low
        if start < stop == count > 1:
            values[-1] = high  # without rounding
        return {self.name: values}


@dataclass(frozen=True, kw_only=True)
class SampleAxis(Axis):
    """Axis of samples of distributions, drawn from the seed in chunks when they are used.

    `correlation` lists pairs of names with their rank correlation.
    """

    count: int
    distributions: tuple[tuple[str, Distribution], ...]
    seed: int = 0
    method: Method = Method.SOBOL
    correlation: tuple[tuple[tuple[str, str], float], ...] = ()
    name: str = field(default="sample", init=False)

    def __len__(self) -> int:
        return self.count

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self.distributions)

    def values_in(self, section: slice = slice(None)) -> Mapping[str, Numbers]:
        """Draw the samples of each parameter in a section of the axis; workers receive the seed, not the samples."""
        start, stop, _ = section.indices(self.count)
        values = {name: numpy.empty(stop - start) for name in self.names}
        for number in range(start // CHUNK_SIZE, -(-stop // CHUNK_SIZE)):
            first = number * CHUNK_SIZE
            low, high = max(start, first), min(stop, first + CHUNK_SIZE)
            for column, samples in zip(values.values(), _draw_samples(self, number), strict=True):
                column[low - start : high - start] = samples[low - first : high - first]
        return values


CACHED_CHUNKS = 8
"""Number of chunks of samples that each process keeps."""


@lru_cache(maxsize=CACHED_CHUNKS)
def _draw_samples(axis: SampleAxis, chunk: int) -> tuple[Numbers, ...]:
    probabilities = draw_chunk(axis.method, axis.count, len(axis.distributions), axis.seed, chunk)
    if axis.correlation:
        probabilities = correlate(probabilities, copula_matrix(axis.names, dict(axis.correlation)))
    return tuple(
        distribution.frozen.ppf(row) for (_, distribution), row in zip(axis.distributions, probabilities, strict=True)
    )


def parameter_values(
    name: str, values: Numbers, position: str = "[{}]", numbering: Sequence[int] | None = None
) -> Numbers:
    """Convert the values of a parameter to float64, and check that they are allowed, see `check_allowed`.

    Raises ValueError: other shapes or types, no values, or a value outside the range of the parameter.
    """
    if values.ndim != 1 or values.dtype.kind not in "iuf":
        raise ValueError(f"{name} must be a row of numbers, got {values.dtype} of shape {values.shape}")
    if not len(values):
        raise ValueError(f"{name} has no values")
    numbers = values.astype(float)
    check_allowed(name, numbers, position, numbering)
    return numbers


def check_allowed(
    name: str, values: Numbers, position: str = "[{}]", numbering: Sequence[int] | None = None, hint: str = ""
) -> None:
    """Raise ValueError for the first value outside the range of a parameter.

    The message has the `position` of the value by its number: its index, or that of the `numbering`.
    """
    parameter = QUANTITIES[name]
    bad = numpy.flatnonzero(~parameter.allows(values))
    if len(bad):
        first = int(bad[0])
        place = position.format(first if numbering is None else numbering[first])
        more = f" (and {len(bad) - 1} more)" if len(bad) > 1 else ""
        rule = f"{parameter.allowed}{hint}{parameter.radian_hint(float(values[first]))}"
        raise ValueError(f"{name}{place} = {values[first]:g}{more} is not allowed: {rule}")
