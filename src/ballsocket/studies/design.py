"""Designs of studies: grids, samples, tables and their products, with fixed parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import prod
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require, shown
from ..core.quantities import MATERIAL
from ..core.storage.atomic_files import check_local
from ..files.columns import ALL_COLUMNS, HeadChoice, read_columns
from ..problem import Joint, Material
from .axes import MAX_COUNT, Axis, ListedAxis, SampleAxis, Span, SpanAxis, check_allowed, parameter_values
from .distributions import MAX_SOBOL_COUNT, Correlation, Distribution, Method, copula_matrix
from .parameters import MATERIAL_PARTS, PARAMETERS, check_contradictions, hold


@dataclass(frozen=True, eq=False)
class Design:
    """Points of a study: all combinations of its axes, with fixed parameters.

    Attributes
    ----------
    axes : tuple of Axis
    fixed : mapping of str to float
    held : mapping of str to float
        Lengths of the joint that stay while others vary, see `holding`.

    Raises
    ------
    ValueError
        An unknown parameter, one that varies twice, or parameters that contradict each other.
    """

    axes: tuple[Axis, ...] = ()
    fixed: Mapping[str, float] = field(default_factory=dict)
    held: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names = self.names
        check_names(names, PARAMETERS, "among the axes")
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"{name} varies along two axes; one is needed")
        check_contradictions(dict.fromkeys(names))
        for dim in self.dims:
            if self.dims.count(dim) > 1:
                raise ValueError(f"two axes have the name {dim}: combine all samples, or all rows, in one axis")

    def __mul__(self, other: Design) -> Design:
        """Combine every point of this design with every point of another one."""
        duplicates = [name for name in self.fixed if name in other.fixed]
        if duplicates:
            raise ValueError(f"{duplicates[0]} is given twice; one is needed")
        return Design(self.axes + other.axes, {**self.fixed, **other.fixed})

    def holding(self, joint: Joint) -> Design:
        """Return the design with the lengths of a joint that stay while others vary; raise ValueError as `hold`."""
        return replace(self, held=hold(joint, self.names))

    @property
    def constants(self) -> dict[str, float]:
        """Parameters that do not vary, fixed or held."""
        return {**self.fixed, **self.held}

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the axes."""
        return tuple(axis.name for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis."""
        return tuple(len(axis) for axis in self.axes)

    @property
    def size(self) -> int:
        """Total number of points."""
        return prod(self.shape)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the varied, the fixed and the held parameters."""
        return (*(name for axis in self.axes for name in axis.names), *self.constants)

    def values_in(self, box: Sequence[slice]) -> dict[str, Numbers]:
        """Return the values of all parameters in a box of points, given by its range along each axis.

        The arrays have one dimension per axis, and broadcast against each other.
        """
        arrays = {name: numpy.full([1] * len(self.axes), value) for name, value in self.constants.items()}
        for dimension, (axis, section) in enumerate(zip(self.axes, box, strict=True)):
            shape = [1] * len(self.axes)
            for name, values in axis.values_in(section).items():
                shape[dimension] = -1
                arrays[name] = values.reshape(shape)
        return arrays


def grid(**axes: Any) -> Design:
    """Create the design of all combinations of the values of parameters.

    Parameters
    ----------
    **axes : number, Span or sequence of numbers; Material or sequence of Material
        Values by parameter (`ballsocket.studies.parameters.PARAMETERS`), in mm, N, MPa, rad; materials by `liner` or
        `ball`. A single number or material is fixed and adds no axis.

    Raises
    ------
    ValueError
        An unknown name; an empty axis; a value twice, or outside the range of its parameter.

    Examples
    --------
    >>> grid(ball_radius=[14.0, 16.0], force=[1000.0, 2000.0, 3000.0]).shape
    (2, 3)
    """
    check_names(axes, (*PARAMETERS, *MATERIAL_PARTS), "among the axes")
    varying: list[Axis] = []
    fixed: dict[str, float] = {}
    for name, value in axes.items():
        if isinstance(value, Span) or not is_number(value):
            varying.append(_create_axis(name, value))
        elif name in MATERIAL_PARTS and not isinstance(value, Material):
            raise ValueError(f"{name} must be a Material or a list of Materials, got {shown(value)}")
        else:
            columns = _create_axis(name, [value]).values_in()
            fixed |= {parameter: float(column[0]) for parameter, column in columns.items()}
    return Design(tuple(varying), fixed)


def is_number(value: Any) -> bool:
    """Check if a value is a single number."""
    return numpy.ndim(value) == 0


def _create_axis(name: str, value: Any) -> Axis:
    if name in MATERIAL_PARTS:
        return _create_material_axis(name, value)
    if isinstance(value, Span):
        check_allowed(name, numpy.array([value.low, value.high]))
        return SpanAxis(name, value)
    column = parameter_values(name, numpy.asarray(value))
    values, counts = numpy.unique(column, return_counts=True)
    if counts.max() > 1:
        unit = PARAMETERS[name].written
        repeated = float(values[counts.argmax()]) * unit.factor
        raise ValueError(f"{name} has {f'{repeated:g} {unit.text}'.strip()} twice: list each value once")
    return ListedAxis(name, {name: column})


def _create_material_axis(part: str, materials: Any) -> Axis:
    """Create the axis of materials of a part, whose properties vary together; an unknown yield stress is NaN."""
    if not (isinstance(materials, Sequence) and all(isinstance(material, Material) for material in materials)):
        raise ValueError(f"{part} must be a list of Materials, got {shown(materials)}")
    if not materials:
        raise ValueError(f"{part} has no values")
    labels = tuple(material.name or str(material) for material in materials)
    for label in labels:
        if labels.count(label) > 1:
            raise ValueError(f"{part} has {label} twice")
    numbers = {number: [getattr(material, number) for material in materials] for number in (*MATERIAL, "yield_stress")}
    columns = {f"{part}_{number}": numpy.array(values, dtype=float) for number, values in numbers.items()}
    return ListedAxis(part, columns, labels)


def sample(
    count: int,
    *,
    seed: int = 0,
    method: Method = Method.SOBOL,
    correlation: Correlation = MappingProxyType({}),
    **distributions: Distribution,
) -> Design:
    """Create a design of samples of scattered parameters.

    Parameters
    ----------
    count : int
        Number of samples; a power of two fills the space most evenly with Sobol points.
    seed : int
        The same seed gives the same samples.
    method : Method
        Method of sampling.
    correlation : mapping of (str, str) to float
        Rank correlations (Spearman) of pairs of parameters, by a Gaussian copula. Other pairs are independent.
    **distributions : Rectangular, Normal or LogNormal
        Distributions by parameter.

    Raises
    ------
    ValueError
        No distribution, fewer than one sample, more than 2^30 of Sobol's sequence, a seed below 0, or correlations that
        are not possible.

    Examples
    --------
    >>> from ballsocket.studies.distributions import Rectangular
    >>> sample(8, clearance=Rectangular(low=0.05, high=0.15)).dims
    ('sample',)
    """
    require("count", count, 1 <= count <= MAX_COUNT, "at least one sample is drawn, at most 1e15")
    if method is Method.SOBOL:
        require("count", count, count <= MAX_SOBOL_COUNT, "Sobol's sequence has 2^30 points; use latin-hypercube")
    require("seed", seed, seed >= 0, "a seed is 0 or more")
    if not distributions:
        raise ValueError("samples need at least one parameter with a distribution")
    copula_matrix(tuple(distributions), correlation)
    pairs = tuple(correlation.items())
    axis = SampleAxis(
        count=count, distributions=tuple(distributions.items()), seed=seed, method=method, correlation=pairs
    )
    return Design((axis,))


def check_samples(design: Design) -> None:
    """Check that all samples of a design are in the ranges of their parameters; a grid is checked when it is made.

    Raises ValueError: a sample is not allowed; the message has the first one.
    """
    for axis in design.axes:
        if not isinstance(axis, SampleAxis):
            continue
        doubtful = [  # only what a distribution allows outside the range of its parameter is drawn
            name
            for name, distribution in axis.distributions
            if not PARAMETERS[name].allows(numpy.array(distribution.frozen.support())).all()
        ]
        for section in axis.sections if doubtful else ():
            samples, numbering = axis.values_in(section), range(section.start, section.stop)
            for name in doubtful:
                check_allowed(name, samples[name], numbering=numbering, hint="; truncate the distribution")


def table(path: str | Path, heads: HeadChoice = ALL_COLUMNS) -> Design:
    """Create a design from the rows of a table in a file with a column for each parameter.

    A bare name is in mm, N, MPa or rad. A name may have a unit: `ball_radius_mm`, `force_N`, `half_angle_deg`, or
    "force [kN]". The forms of tables are those of `ballsocket.files.columns`.

    Parameters
    ----------
    path : str or Path
    heads : HeadChoice
        Columns of the file that get another name, or that are not used.

    Raises
    ------
    ValueError
        An unknown column, a missing value or one outside its range (the message has its row), content of another
        format, or more rows than fit into the memory.
    OSError
        The file cannot be read.
    """
    check_local(path)
    path = Path(path)
    rows = read_columns(path, PARAMETERS, heads)
    if not len(rows):
        raise ValueError(f"{path.name} has no rows of numbers")
    kinds = {name: parameter.kind for name, parameter in PARAMETERS.items()}
    columns = {
        name: parameter_values(name, values, f" in line {{}} of {path.name}", rows.lines)
        for name, values in rows.in_units(kinds, {name: kind.unit for name, kind in kinds.items()}).items()
    }
    return Design((ListedAxis("row", columns, remark=rows.remark()),))
