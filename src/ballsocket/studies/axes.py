"""Axes of a study: values of a grid, equal steps, samples of distributions, rows of a table."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf, nan

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.quantities import MATERIAL, QUANTITIES
from ..problem import Material
from .distributions import Distribution, copula_matrix, correlate
from .sampling import CHUNK_SIZE, Method, draw_chunk

MAX_COUNT = 10**15
"""Largest number of values along an axis."""


class Axis(ABC):
    """Dimension of a study: one or more parameters that vary together."""

    name: str

    @property
    @abstractmethod
    def values(self) -> Mapping[str, Numbers]:
        """Values of each parameter, float64 of shape (length,)."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        return (self.name,)

    @property
    def labels(self) -> tuple[str, ...]:
        """Texts for the positions along the axis; empty for an axis of numbers."""
        return ()

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))

    def values_in(self, section: slice) -> Mapping[str, Numbers]:
        """Return the values of each parameter in a section of the axis."""
        return {name: values[section] for name, values in self.values.items()}

    @property
    def sections(self) -> Iterator[slice]:
        """Sections of at most `CHUNK_SIZE` values, in which large axes are written."""
        return (slice(start, min(start + CHUNK_SIZE, len(self))) for start in range(0, len(self), CHUNK_SIZE))


@dataclass(frozen=True, eq=False)
class GridAxis(Axis):
    """Axis of one parameter with listed values.

    Raises ValueError: the same value twice.
    """

    name: str
    column: Numbers

    def __post_init__(self) -> None:
        values, counts = numpy.unique(self.column, return_counts=True)
        if counts.max(initial=1) > 1:
            unit = QUANTITIES[self.name].written
            repeated = float(values[counts.argmax()]) * unit.factor
            raise ValueError(f"{self.name} has {f'{repeated:g} {unit.text}'.strip()} twice: list each value once")

    @property
    def values(self) -> Mapping[str, Numbers]:
        return {self.name: self.column}


@dataclass(frozen=True)
class SpanAxis(Axis):
    """Axis of one parameter with equal steps, computed when they are used."""

    name: str
    span: Span

    def __len__(self) -> int:
        return self.span.count

    @property
    def values(self) -> Mapping[str, Numbers]:
        return _span_values(self)


@lru_cache(maxsize=16)
def _span_values(axis: SpanAxis) -> Mapping[str, Numbers]:
    return {axis.name: numpy.linspace(axis.span.low, axis.span.high, axis.span.count)}


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
class MaterialAxis(Axis):
    """Axis of materials of the "liner" or the "ball", whose properties vary together.

    An unknown yield stress is NaN.

    Raises ValueError: no material, or the same material twice.
    """

    name: str
    materials: tuple[Material, ...]

    def __post_init__(self) -> None:
        if not self.materials:
            raise ValueError(f"{self.name} has no values")
        for label in self.labels:
            if self.labels.count(label) > 1:
                raise ValueError(f"{self.name} has {label} twice")

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.values)

    @property
    def values(self) -> Mapping[str, Numbers]:
        yields = [nan if material.yield_stress is None else float(material.yield_stress) for material in self.materials]
        numbers = {name: [float(getattr(material, name)) for material in self.materials] for name in MATERIAL}
        numbers["yield_stress"] = yields
        return {f"{self.name}_{name}": numpy.array(column) for name, column in numbers.items()}

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(material.name or str(material) for material in self.materials)


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

    @property
    def values(self) -> Mapping[str, Numbers]:
        return self.values_in(slice(0, self.count))

    def values_in(self, section: slice) -> Mapping[str, Numbers]:
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


@dataclass(frozen=True, eq=False)
class TableAxis(Axis):
    """Axis of the rows of a table with a column for each parameter."""

    columns: Mapping[str, Numbers]
    name: str = "row"
    remark: str = ""
    """Rows of the file that were read, and lines that were left out; empty without such lines."""

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.columns)

    @property
    def values(self) -> Mapping[str, Numbers]:
        return self.columns


def parameter_values(
    name: str, values: Numbers, position: str = "[{}]", numbering: Sequence[int] | None = None
) -> Numbers:
    """Convert the values of a parameter to float64, and check that they are finite or an allowed infinity.

    A message has the `position` of a value by its number: its index, or that of the `numbering`.

    Raises ValueError: other shapes or types, no values, or a value that is not finite.
    """
    if values.ndim != 1 or values.dtype.kind not in "iuf":
        raise ValueError(f"{name} must be a row of numbers, got {values.dtype} of shape {values.shape}")
    if not len(values):
        raise ValueError(f"{name} has no values")
    numbers = values.astype(float)
    bad = ~numpy.isfinite(numbers)
    if QUANTITIES[name].allows(inf):
        bad &= numbers != inf
    if bad.any():
        first = int(numpy.argmax(bad))
        number = first if numbering is None else numbering[first]
        more = f" (and {int(bad.sum()) - 1} more)" if bad.sum() > 1 else ""
        raise ValueError(f"{name}{position.format(number)} = {numbers[first]:g}{more} is not allowed: a finite number")
    return numbers
