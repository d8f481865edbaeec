"""What a design may be: limits on its dimensions and on what a load does to it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf, pi
from typing import TYPE_CHECKING, Any

import numpy

from ..core.checks import check_names, degrees_hint, require
from ..core.kinds import Kind
from ..core.quantities import CONTACT, JOINT
from ..core.validity import Status
from ..problem.cup import UP, Cup, Direction
from ..problem.dimensions import STORED_LENGTHS, Dimensions, derive_lengths
from .parameters import PARAMETERS
from .task import EDGE_DISTANCE, QUANTITIES

if TYPE_CHECKING:
    import xarray

_ANGLES = tuple(name for name, each in {**PARAMETERS, **CONTACT}.items() if each.kind is Kind.ANGLE)

NAMES = (*PARAMETERS, *QUANTITIES, EDGE_DISTANCE)


@dataclass(frozen=True, kw_only=True)
class Limit:
    """A closed range of a dimension, an answer, or the `edge_distance`.

    Parameters
    ----------
    name : str
        A parameter of a study, a quantity of a contact, or "edge_distance".
    low, high : float
        In mm, N, MPa, rad.
    cup : Cup
        Whose rim the edge distance is taken to. `Cup()`, the default, is half a sphere that opens straight down.
    direction : tuple of float
        Of the force on that cup, upwards by default; of any length.

    Raises
    ------
    ValueError
        A name that is not known, or an empty range.
    """

    name: str
    low: float = -inf
    high: float = inf
    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    direction: Direction = UP

    def __post_init__(self) -> None:
        check_names([self.name], NAMES, "among what can be limited")
        if self.name in _ANGLES:
            for end in (self.low, self.high):
                good = (abs(end) <= pi) | (abs(end) == inf)
                require(self.name, end, good, f"it is in radians; {degrees_hint(end)}")
        require(
            self.name, self.low, self.low <= self.high, f"the lower limit is not above the upper one, {self.high:g}"
        )

    def of(self, study: xarray.Dataset) -> Any:
        """The quantity at every point."""
        if self.name == EDGE_DISTANCE and EDGE_DISTANCE not in study.data_vars:
            return self.cup.edge_distance(dimension(study, "socket_radius"), study.half_angle, self.direction)
        return study[self.name] if self.name in study.data_vars else dimension(study, self.name)

    def margin(self, study: xarray.Dataset) -> Any:
        """How far inside the range, negative outside."""
        value = self.of(study)
        below = value - self.low if self.low > -inf else inf + 0.0 * numpy.isnan(value)
        above = self.high - value if self.high < inf else inf + 0.0 * numpy.isnan(value)
        return numpy.minimum(below, above)

    def __str__(self) -> str:
        if self.high == inf:
            return f"{self.name} ≥ {self.low:g}"
        return f"{self.name} ≤ {self.high:g}" if self.low == -inf else f"{self.low:g} ≤ {self.name} ≤ {self.high:g}"


def dimension(study: xarray.Dataset, name: str) -> Any:
    """A dimension or modulus of the joints of a study: an axis, a fixed number, or what follows from others.

    Raises
    ------
    ValueError
        The joint has no such number: a rigid ball has no modulus.
    """
    if name in study.coords:
        return study[name]
    joint = json.loads(study.attrs["joint"])
    if name in JOINT:
        return getattr(_lengths(study, joint), name)
    part, _, number = name.rpartition("_")
    value = joint.get(name) if name in joint else (joint.get(part) or {}).get(number)
    if value is None:
        raise ValueError(f"the joint of this study has no {name}")
    return float(value)


@dataclass(frozen=True, kw_only=True)
class _LengthDimensions(Dimensions):
    """Dimensions of the joints of a study, each a number or labelled along axes."""

    ball_radius: Any
    clearance: Any
    liner_thickness: Any
    behind: float

    @property
    def shell(self) -> float:
        return self.behind


def _lengths(study: xarray.Dataset, joint: Mapping[str, Any]) -> _LengthDimensions:
    given = {str(name): study[name] for name in study.coords if name in JOINT}
    thickness = float(joint["backing"][0]["thickness"]) if joint["backing"] else inf
    shell = thickness if thickness < inf else 0.0
    return _LengthDimensions(
        **derive_lengths(given, {name: float(joint[name]) for name in STORED_LENGTHS}, shell), behind=shell
    )


def margin_over(study: xarray.Dataset, limit: Limit, across: str, up: str) -> numpy.ndarray:
    """The margin of a limit at every point of a plane, whatever it depends on: an array (up, across)."""
    spread = limit.margin(study) + 0.0 * study[across] + 0.0 * study[up]
    values: numpy.ndarray = spread.transpose(up, across).values
    return values


def allowed(study: xarray.Dataset, limits: Iterable[Limit]) -> xarray.DataArray:
    """Where a study has an answer and every limit holds."""
    first = next(iter(study.data_vars))
    good = study[first].notnull()
    for limit in limits:
        good = good & (limit.margin(study) >= 0)
    return good


def refusal(study: xarray.Dataset, limits: Iterable[Limit], nobody: str, anywhere: str) -> str:
    """Why no point of a study is allowed: limits, or a model without an answer.

    `nobody` says so ("no point is allowed"), `anywhere` of what ("at any point").
    """
    model = study.attrs["model"]
    if bool(allowed(study, ()).any()):
        return f"{nobody} by {' and '.join(map(str, limits))}, as {model} answers"
    numbers, counts = numpy.unique(study.status.values, return_counts=True)
    return f"{model} has no answer {anywhere}: {Status(int(numbers[counts.argmax()])).sentence}"
