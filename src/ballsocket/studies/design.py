"""Which points a study presses: axes of a grid, samples of distributions, rows of a table, and products of these."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache
from math import inf, prod
from pathlib import Path
from typing import Any

import numpy

from ..checks import require
from ..files import check_names
from .distributions import Distribution
from .parameters import PARAMETERS, contradiction

Array = numpy.ndarray


class Axis(ABC):
    """One dimension of a study: one or more parameters that vary along it together."""

    name: str

    @property
    @abstractmethod
    def values(self) -> Mapping[str, Array]:
        """By parameter, float64 of shape (length,)."""

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))


@dataclass(frozen=True, eq=False)
class GridAxis(Axis):
    """One parameter at given values."""

    name: str
    column: Array

    @property
    def values(self) -> Mapping[str, Array]:
        return {self.name: self.column}


@dataclass(frozen=True)
class SpanAxis(Axis):
    """One parameter at equal steps, which are not written down before they are needed."""

    name: str
    span: Span

    def __len__(self) -> int:
        return self.span.count

    @property
    def values(self) -> Mapping[str, Array]:
        return _stepped(self)


@lru_cache(maxsize=16)
def _stepped(axis: SpanAxis) -> Mapping[str, Array]:
    return {axis.name: numpy.linspace(axis.span.low, axis.span.high, axis.span.count)}


@dataclass(frozen=True)
class Span:
    """`count` numbers at equal steps from `low` to `high`.

    Raises
    ------
    ValueError
        Ends that are not finite, or no number at all.

    Examples
    --------
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
        require("count", self.count, self.count >= 1, "a span has at least one value")


class Method(Enum):
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
    def values(self) -> Mapping[str, Array]:
        return _drawn(self)


@lru_cache(maxsize=4)
def _drawn(axis: SampleAxis) -> Mapping[str, Array]:
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

    columns: Mapping[str, Array]
    name: str = "row"

    @property
    def values(self) -> Mapping[str, Array]:
        return self.columns


@dataclass(frozen=True, eq=False)
class Design:
    """The points of a study: every combination of its axes, with some numbers fixed.

    Raises
    ------
    ValueError
        A parameter that is not known or varies twice, or parameters that contradict each other.
    """

    axes: tuple[Axis, ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names = self.names
        check_names(names, PARAMETERS, "among the axes")
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"{name} varies along two axes; one is needed")
        contradiction(dict.fromkeys(names))
        for dim in self.dims:
            if self.dims.count(dim) > 1:
                raise ValueError(f"two axes are called {dim}: draw all samples, or take all rows, in one")

    def __mul__(self, other: Design) -> Design:
        """Every combination of both."""
        twice = [name for name in self.fixed if name in other.fixed]
        if twice:
            raise ValueError(f"{twice[0]} is given twice; one is needed")
        return Design(self.axes + other.axes, {**self.fixed, **other.fixed})

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions."""
        return tuple(axis.name for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each dimension."""
        return tuple(len(axis) for axis in self.axes)

    @property
    def size(self) -> int:
        """Points in all."""
        return prod(self.shape)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters that vary or are fixed."""
        return (*(name for axis in self.axes for name in _names(axis)), *self.fixed)

    def part(self, place: Sequence[slice]) -> dict[str, Array]:
        """The parameters in a box of points, each with as many dimensions as the study, to broadcast."""
        found = {name: numpy.full([1] * len(self.axes), value) for name, value in self.fixed.items()}
        for dimension, (axis, where) in enumerate(zip(self.axes, place, strict=True)):
            shape = [1] * len(self.axes)
            for name, values in axis.values.items():
                shape[dimension] = -1
                found[name] = values[where].reshape(shape)
        return found


def _names(axis: Axis) -> tuple[str, ...]:
    if isinstance(axis, SampleAxis):
        return tuple(name for name, _ in axis.distributions)
    return (axis.name,) if isinstance(axis, GridAxis | SpanAxis) else tuple(axis.values)


def grid(**axes: Any) -> Design:
    """Every combination of the values of named parameters.

    Parameters
    ----------
    **axes : number, Span or sequence of numbers
        By name of a parameter (`ballsocket.studies.parameters.PARAMETERS`), in mm, N, MPa, rad. A number is fixed and
        makes no axis.

    Raises
    ------
    ValueError
        A name that is not known; an empty axis; a value that is not finite (only a thickness may be infinite).

    Examples
    --------
    >>> grid(ball_radius=[14.0, 16.0], force=[1000.0, 2000.0, 3000.0]).shape
    (2, 3)
    """
    check_names(axes, PARAMETERS, "among the axes")
    fixed = {name: _fixed(name, value) for name, value in axes.items() if not isinstance(value, Span) and is_one(value)}
    varying = {name: value for name, value in axes.items() if name not in fixed}
    return Design(tuple(_axis(name, value) for name, value in varying.items()), fixed)


def check_values(design: Design) -> None:
    """Raise ValueError for the first value of an axis that no joint and no load has.

    Of a span only the ends are looked at, since all that lies between them is allowed with them.
    """
    for axis in design.axes:
        ends = {axis.name: numpy.array([axis.span.low, axis.span.high])} if isinstance(axis, SpanAxis) else axis.values
        for name, values in ends.items():
            _check_allowed(name, values, "; cut the distribution off" if isinstance(axis, SampleAxis) else "")
    for name, value in design.fixed.items():
        _check_allowed(name, numpy.array([value]), "")


def _check_allowed(name: str, values: Array, hint: str) -> None:
    bad = ~PARAMETERS[name].allows(values)
    if bad.any():
        first = int(numpy.argmax(bad))
        more = f" (and {int(bad.sum()) - 1} more)" if bad.sum() > 1 else ""
        what = PARAMETERS[name].title
        raise ValueError(f"{name}[{first}] = {values[first]:g}{more} is not allowed for a {what}{hint}")


def is_one(value: Any) -> bool:
    """Whether a value is one number."""
    return numpy.ndim(value) == 0


def _fixed(name: str, value: Any) -> float:
    return float(_column(name, numpy.asarray([value]))[0])


def _axis(name: str, value: Any) -> Axis:
    return SpanAxis(name, value) if isinstance(value, Span) else GridAxis(name, _column(name, numpy.asarray(value)))


def sample(count: int, *, seed: int = 0, method: Method = Method.SOBOL, **distributions: Distribution) -> Design:
    """Samples of parameters that scatter independently of each other.

    Parameters
    ----------
    count : int
        How many; a power of two fills the space most evenly with Sobol's points.
    seed : int
        The same seed gives the same samples.
    method : Method
    **distributions : Rectangular or Normal
        By name of a parameter.

    Raises
    ------
    ValueError
        No distribution, or fewer than one sample.

    Examples
    --------
    >>> from ballsocket.studies.distributions import Rectangular
    >>> sample(8, clearance=Rectangular(low=0.05, high=0.15)).dims
    ('sample',)
    """
    require("count", count, count >= 1, "at least one sample is drawn")
    if not distributions:
        raise ValueError("samples need at least one parameter that scatters")
    return Design((SampleAxis(count=count, distributions=tuple(distributions.items()), seed=seed, method=method),))


def table(path: str | Path) -> Design:
    """The rows of a CSV or Parquet file, whose columns are named like parameters, in mm, N, MPa and rad.

    A column that ends in `_deg` is in degrees.

    Raises
    ------
    ValueError
        A column that is not known; a value that is missing or no number, named with its row.
    OSError
        The file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() not in _READERS:
        raise ValueError(f"{str(path)!r} must end in {' or '.join(_READERS)}")
    columns = {}
    for name, values in _READERS[path.suffix.lower()](path).items():
        parameter = name.removesuffix("_deg") if name.endswith("half_angle_deg") else name
        if parameter in columns:
            raise ValueError(f"{path.name} has {parameter} twice")
        check_names([parameter], PARAMETERS, f"among the columns of {path.name}")
        column = _column(parameter, values, row=f" in row {{}} of {path.name}")
        columns[parameter] = numpy.radians(column) if name != parameter else column
    if not columns:
        raise ValueError(f"{path.name} has no columns")
    return Design((TableAxis(columns),))


def _read_csv(path: Path) -> dict[str, Array]:
    import csv

    with path.open(encoding="utf-8-sig", newline="") as stream:
        reader = csv.DictReader(stream, strict=True)
        rows = list(reader)
    heads = reader.fieldnames or () if rows else ()
    for name in heads:
        if heads.count(name) > 1:
            raise ValueError(f"{path.name} has {name} twice")
    for number, row in enumerate(rows):
        if None in row:
            raise ValueError(f"row {number} of {path.name} has more cells than there are columns")
    return {name: numpy.array([_number(row[name]) for row in rows]) for name in heads}


def _number(text: str | None) -> float:
    try:
        return float(text or "nan")
    except ValueError:
        return float("nan")


def _read_parquet(path: Path) -> dict[str, Array]:
    from ..checks import needs

    needs("study", "pyarrow")
    from pyarrow import parquet

    read = parquet.read_table(path)
    return {name: read.column(name).to_numpy() for name in read.column_names}


_READERS = {".csv": _read_csv, ".parquet": _read_parquet}


def _column(name: str, values: Array, row: str = "[{}]") -> Array:
    """Float64 numbers that a parameter may have."""
    if values.ndim != 1 or values.dtype.kind not in "iuf":
        raise ValueError(f"{name} must be a row of numbers, got {values.dtype} of shape {values.shape}")
    if not len(values):
        raise ValueError(f"{name} has no values")
    numbers = values.astype(float)
    bad = ~numpy.isfinite(numbers)
    if name == "liner_thickness":
        bad &= numbers != numpy.inf
    if bad.any():
        first = int(numpy.argmax(bad))
        more = f" (and {int(bad.sum()) - 1} more)" if bad.sum() > 1 else ""
        raise ValueError(f"{name}{row.format(first)} = {numbers[first]:g}{more} is not allowed: a finite number")
    return numbers
