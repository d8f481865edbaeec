"""The dimensions of a study: values of a grid, equal steps, samples of distributions, rows of a table."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.kinds import Choice
from ..core.quantities import MATERIAL, QUANTITIES
from ..problem import Material
from .distributions import Distribution

MOST = 10**15
"""Values along an axis. There is never so much room, but as many can be counted."""


class Axis(ABC):
    """One dimension of a study: one or more parameters that vary along it together."""

    name: str

    @property
    @abstractmethod
    def values(self) -> Mapping[str, Numbers]:
        """By parameter, float64 of shape (length,)."""

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters."""
        return (self.name,)

    @property
    def labels(self) -> tuple[str, ...]:
        """What its places are called; empty where numbers say it."""
        return ()

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))


@dataclass(frozen=True, eq=False)
class GridAxis(Axis):
    """One parameter at given values."""

    name: str
    column: Numbers

    @property
    def values(self) -> Mapping[str, Numbers]:
        return {self.name: self.column}


@dataclass(frozen=True)
class SpanAxis(Axis):
    """One parameter at equal steps, which are not written down before they are needed."""

    name: str
    span: Span

    def __len__(self) -> int:
        return self.span.count

    @property
    def values(self) -> Mapping[str, Numbers]:
        return _stepped(self)


@lru_cache(maxsize=16)
def _stepped(axis: SpanAxis) -> Mapping[str, Numbers]:
    return {axis.name: numpy.linspace(axis.span.low, axis.span.high, axis.span.count)}


@dataclass(frozen=True)
class Span:
    """`count` numbers at equal steps from `low` to `high`.

    Raises
    ------
    ValueError
        Ends that are not finite, no value at all, or more than `MOST`.

    Examples
    --------
    >>> from ballsocket.studies.design import grid
    >>> grid(force=Span(500.0, 4000.0, 8)).part([slice(None)])["force"]
    array([ 500., 1000., 1500., 2000., 2500., 3000., 3500., 4000.])
    """

    low: float
    high: float
    count: int

    def __post_init__(self) -> None:
        for name in ("low", "high"):
            value = getattr(self, name)
            require(name, value, abs(value) < inf, "the end of a span is finite")
        require("count", self.count, 1 <= self.count <= MOST, "a span has at least one value, at most 1e15")


@dataclass(frozen=True)
class MaterialAxis(Axis):
    """Materials of a part of the joint, "liner" or "ball", whose numbers vary together.

    Raises
    ------
    ValueError
        No material at all, or the same one twice.
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
    def _numbers(self) -> tuple[str, ...]:
        """What all of them have."""
        known = all(each.yield_stress is not None for each in self.materials)
        return (*MATERIAL, *(["yield_stress"] if known else []))

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(f"{self.name}_{number}" for number in self._numbers)

    @property
    def values(self) -> Mapping[str, Numbers]:
        return {
            f"{self.name}_{number}": numpy.array([float(getattr(each, number)) for each in self.materials])
            for number in self._numbers
        }

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(each.name or str(each) for each in self.materials)


class Method(Choice):
    """How samples fill the space."""

    SOBOL = "sobol"
    LATIN_HYPERCUBE = "latin-hypercube"


@dataclass(frozen=True, kw_only=True)
class SampleAxis(Axis):
    """Samples of distributions, drawn anew from the seed wherever they are needed."""

    count: int
    distributions: tuple[tuple[str, Distribution], ...]
    seed: int = 0
    method: Method = Method.SOBOL
    name: str = field(default="sample", init=False)

    def __len__(self) -> int:
        return self.count

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self.distributions)

    @property
    def values(self) -> Mapping[str, Numbers]:
        return _drawn(self)


@lru_cache(maxsize=4)
def _drawn(axis: SampleAxis) -> Mapping[str, Numbers]:
    """Once in each process: a worker is sent the recipe, not the numbers."""
    from scipy.stats.qmc import LatinHypercube, Sobol

    engines = {Method.SOBOL: Sobol, Method.LATIN_HYPERCUBE: LatinHypercube}
    engine = engines[axis.method](len(axis.distributions), rng=axis.seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of counts that are no power of two: the docstring says so
        shares = engine.random(axis.count)
    return {
        name: distribution.frozen.ppf(share)
        for (name, distribution), share in zip(axis.distributions, shares.T, strict=True)
    }


@dataclass(frozen=True, eq=False)
class TableAxis(Axis):
    """Rows of a table, a column a parameter."""

    columns: Mapping[str, Numbers]
    name: str = "row"

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(self.columns)

    @property
    def values(self) -> Mapping[str, Numbers]:
        return self.columns


def column(name: str, values: Numbers, row: str = "[{}]") -> Numbers:
    """Float64 numbers that a parameter may have."""
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
        more = f" (and {int(bad.sum()) - 1} more)" if bad.sum() > 1 else ""
        raise ValueError(f"{name}{row.format(first)} = {numbers[first]:g}{more} is not allowed: a finite number")
    return numbers
