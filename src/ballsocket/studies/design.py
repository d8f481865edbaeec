"""Which points a study presses: products of axes, with some numbers fixed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import prod
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require, shown
from ..problem import Material
from .axes import MOST, Axis, GridAxis, MaterialAxis, Method, SampleAxis, Span, SpanAxis, column
from .distributions import Distribution
from .parameters import PARAMETERS, PARTS_OF, contradiction


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
        return (*(name for axis in self.axes for name in axis.names), *self.fixed)

    def part(self, place: Sequence[slice]) -> dict[str, Numbers]:
        """The parameters in a box of points, each with as many dimensions as the study, to broadcast."""
        found = {name: numpy.full([1] * len(self.axes), value) for name, value in self.fixed.items()}
        for dimension, (axis, where) in enumerate(zip(self.axes, place, strict=True)):
            shape = [1] * len(self.axes)
            for name, values in axis.values.items():
                shape[dimension] = -1
                found[name] = values[where].reshape(shape)
        return found


def grid(**axes: Any) -> Design:
    """Every combination of the values of named parameters.

    Parameters
    ----------
    **axes : number, Span or sequence of numbers; Material or sequence of these
        By name of a parameter (`ballsocket.studies.parameters.PARAMETERS`), in mm, N, MPa, rad; materials by `liner`
        or `ball`. A number, or one material, is fixed and makes no axis.

    Raises
    ------
    ValueError
        A name that is not known; an empty axis; a value that is not finite (only a thickness may be infinite).

    Examples
    --------
    >>> grid(ball_radius=[14.0, 16.0], force=[1000.0, 2000.0, 3000.0]).shape
    (2, 3)
    """
    check_names(axes, (*PARAMETERS, *PARTS_OF), "among the axes")
    fixed: dict[str, float] = {}
    varying = {}
    for name, value in axes.items():
        if isinstance(value, Material):
            fixed |= {name: float(column[0]) for name, column in _axis(name, [value]).values.items()}
        elif isinstance(value, Span) or not is_one(value):
            varying[name] = value
        else:
            fixed[name] = _fixed(name, value)
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


def _check_allowed(name: str, values: Numbers, hint: str) -> None:
    bad = ~PARAMETERS[name].allows(values)
    if bad.any():
        first = int(numpy.argmax(bad))
        more = f" (and {int(bad.sum()) - 1} more)" if bad.sum() > 1 else ""
        what, meant = PARAMETERS[name].title, PARAMETERS[name].radian_hint(float(values[first]))
        raise ValueError(f"{name}[{first}] = {values[first]:g}{more} is not allowed for a {what}{hint}{meant}")


def is_one(value: Any) -> bool:
    """Whether a value is one number."""
    return numpy.ndim(value) == 0


def _materials(name: str, values: Any) -> tuple[Material, ...]:
    if isinstance(values, Sequence) and all(isinstance(each, Material) for each in values):
        return tuple(values)
    raise ValueError(f"{name} must be a list of Materials, got {shown(values)}")


def _fixed(name: str, value: Any) -> float:
    if name in PARTS_OF:
        raise ValueError(f"{name} must be a Material or a list of Materials, got {shown(value)}")
    return float(column(name, numpy.asarray([value]))[0])


def _axis(name: str, value: Any) -> Axis:
    if name in PARTS_OF:
        return MaterialAxis(name, _materials(name, value))
    return SpanAxis(name, value) if isinstance(value, Span) else GridAxis(name, column(name, numpy.asarray(value)))


def sample(count: int, *, seed: int = 0, method: Method = Method.SOBOL, **distributions: Distribution) -> Design:
    """Samples of parameters that scatter independently of each other.

    Parameters
    ----------
    count : int
        How many; a power of two fills the space most evenly with Sobol's points.
    seed : int
        The same seed gives the same samples.
    method : Method
    **distributions : Rectangular, Normal or LogNormal
        By name of a parameter.

    Raises
    ------
    ValueError
        No distribution, fewer than one sample, or a seed below 0.

    Examples
    --------
    >>> from ballsocket.studies.distributions import Rectangular
    >>> sample(8, clearance=Rectangular(low=0.05, high=0.15)).dims
    ('sample',)
    """
    require("count", count, 1 <= count <= MOST, "at least one sample is drawn, at most 1e15")
    require("seed", seed, seed >= 0, "a seed is 0 or more")
    if not distributions:
        raise ValueError("samples need at least one parameter that scatters")
    return Design((SampleAxis(count=count, distributions=tuple(distributions.items()), seed=seed, method=method),))
