"""Limits on the dimensions and the contact quantities of a design."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..contact.verdict import Bounded, Verdict
from ..core.checks import check_names, degrees_hint, require
from ..core.kinds import Kind
from ..core.quantities import CONTACT, YIELD_LIMITS
from ..core.quantities import QUANTITIES as ALL_QUANTITIES
from ..core.unit_systems import Amount, Sentence
from ..core.validity import Status
from ..problem.cup import UP, Cup, Direction
from .metadata import joint_dimension, missing_reasons
from .parameters import PARAMETERS
from .task import EDGE_DISTANCE, FURTHER, QUANTITIES, with_bounds

if TYPE_CHECKING:
    import xarray


_ANGLES = tuple(name for name, quantity in {**PARAMETERS, **CONTACT}.items() if quantity.kind is Kind.ANGLE)

LIMITED_NAMES = (*PARAMETERS, *QUANTITIES, *FURTHER)
"""Names of parameters and quantities that can have a limit."""


@dataclass(frozen=True, kw_only=True)
class Limit:
    """Closed range of a parameter, a contact quantity, or the `edge_distance`.

    Parameters
    ----------
    name : str
        Parameter of a study, quantity of a contact, or "edge_distance".
    low, high : float
        Ends of the range in mm, N, MPa, rad.
    cup : Cup
        Cup from whose rim the edge distance is measured. The default `Cup()` is a hemisphere that opens downwards.
    direction : tuple of float
        Direction of the force on that cup, upwards by default; of any length.

    Raises
    ------
    ValueError
        An unknown name, or an empty range.
    """

    name: str
    low: float = -inf
    high: float = inf
    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    direction: Direction = UP

    def __post_init__(self) -> None:
        check_names([self.name], LIMITED_NAMES, "among what can be limited")
        if self.name in _ANGLES:
            for end in (self.low, self.high):
                good = (abs(end) <= pi) | (abs(end) == inf)
                require(self.name, end, good, f"it is in radians; {degrees_hint(end)}")
        for end in (self.low, self.high):
            require(self.name, end, end == end, "a limit is a number")
        require(
            self.name, self.low, self.low <= self.high, f"the lower limit is not above the upper one, {self.high:g}"
        )

    @property
    def ends(self) -> dict[str, float]:
        """Ends of the range as arguments of a verdict."""
        return {"low": self.low, "high": self.high}

    def bar(self, study: xarray.Dataset) -> Bounded:
        """Return the limited quantity with its error bar at every point, in mm, N, MPa or rad.

        The bar has no width if the study has no bounds.
        """
        if self.name == EDGE_DISTANCE and EDGE_DISTANCE not in study.data_vars:
            radius, angle = joint_dimension(study, "socket_radius"), study.half_angle
            angles = (angle, *(study.get(f"half_angle_{end}", angle) for end in ("high", "low")))
            return Bounded(*(self.cup.edge_distance(radius, angle, self.direction) for angle in angles))
        value = study[self.name] if self.name in study.data_vars else joint_dimension(study, self.name)
        return Bounded(value, *(study.get(f"{self.name}_{end}", value) for end in ("low", "high")))

    def margin(self, study: xarray.Dataset) -> Bounded:
        """Compute the distance to the nearer end of the range at every point; negative outside the range.

        Its lower bound is the margin of the worse end of the error bar, and its upper bound that of the better end.
        """

        def distance(smallest: Any, largest: Any) -> Any:
            below = smallest - self.low if self.low > -inf else inf + 0.0 * numpy.isnan(smallest)
            above = self.high - largest if self.high < inf else inf + 0.0 * numpy.isnan(largest)
            return numpy.minimum(below, above)

        bar = self.bar(study)
        return Bounded(distance(bar.value, bar.value), distance(bar.low, bar.high), distance(bar.high, bar.low))

    def __str__(self) -> Sentence:
        return self.sentence(self.name)

    def sentence(self, name: str) -> Sentence:
        """Write the limit of the quantity with this name or title."""
        low, high = (Amount(end, ALL_QUANTITIES[self.name].shown, 6) for end in (self.low, self.high))
        if self.high == inf:
            return Sentence("{} ≥ {}", name, low)
        if self.low == -inf:
            return Sentence("{} ≤ {}", name, high)
        return Sentence("{} ≤ {} ≤ {}", low, name, high)


def margin_on_plane(study: xarray.Dataset, limit: Limit, x_axis: str, y_axis: str) -> Bounded:
    """Compute the margin of a limit on the plane of two axes of a study, arrays of shape (y, x)."""
    margins = (margin + 0.0 * study[x_axis] + 0.0 * study[y_axis] for margin in limit.margin(study))
    return Bounded(*(margin.transpose(y_axis, x_axis).values for margin in margins))


def relative_margins(
    study: xarray.Dataset, limits: Iterable[Limit], x_axis: str, y_axis: str
) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Compute the smallest margin of all limits on a plane, each relative to its largest value, between -1 and 1.

    Returns the margins (y, x) of the worse and of the better end of the error bar: negative, the first where a limit is
    not kept, and the second where one is exceeded.
    """
    worst, best = numpy.ones((2, study.sizes[y_axis], study.sizes[x_axis]))
    for limit in limits:
        margin = margin_on_plane(study, limit, x_axis, y_axis)
        size = float(numpy.nanmax(abs(margin.value), initial=0.0, where=numpy.isfinite(margin.value))) or 1.0
        worst, best = numpy.minimum(worst, margin.low / size), numpy.minimum(best, margin.high / size)
    return numpy.clip(worst, -1.0, 1.0), numpy.clip(best, -1.0, 1.0)


def limited_quantities(limits: Iterable[Limit], model: Model) -> tuple[str, ...]:
    """Return the quantities that a study needs for limits: the limited ones and the ends of their error bars.

    The edge distance of a model for axial loads follows from the half angle.

    Raises ValueError: a quantity of liners that yield, which the model does not have.
    """
    known = (*QUANTITIES, *model.further_quantities)
    names = [limit.name if limit.name in known or limit.name != EDGE_DISTANCE else "half_angle" for limit in limits]
    missing = [name for name in names if name in FURTHER and name not in known]
    if missing:
        raise ValueError(f"{missing[0]} needs finite elements whose liner yields: use --plastic or plastic=True")
    return with_bounds(dict.fromkeys(name for name in names if name in known))


def verdicts(study: xarray.Dataset, limits: Iterable[Limit]) -> xarray.DataArray:
    """Return the code of the `Verdict` on all limits at each point; undecided without a result.

    A joint has limits of yielding also at a force that it does not bear.
    """
    results = [name for name in study.data_vars if name not in YIELD_LIMITS] or list(study.data_vars)
    answered = study[results[0]].notnull()
    codes, known = (1 - answered) * int(Verdict.UNDECIDED), answered
    for limit in limits:
        codes = numpy.maximum(codes, limit.margin(study).decide(low=0.0))
        if limit.name in YIELD_LIMITS:
            known = known | study[limit.name].notnull()
    return codes.where(known, int(Verdict.UNDECIDED))


def allowed(study: xarray.Dataset, limits: Iterable[Limit]) -> xarray.DataArray:
    """Mark the points of a study that have a result and keep every limit by their whole error bars; a bool array."""
    return verdicts(study, limits) == int(Verdict.KEPT)


def count_verdicts(study: xarray.Dataset, limits: Iterable[Limit]) -> dict[str, int]:
    """Count the points of a study by their verdict on all limits, and those without a result."""
    codes = verdicts(study, limits)
    decided = allowed(study, ()) | (codes == int(Verdict.EXCEEDED))
    counts = {verdict.word: int(((codes == int(verdict)) & decided).sum()) for verdict in Verdict}
    return {**counts, "no result": int((~decided).sum())}


def undecided_reason(study: xarray.Dataset, limits: Iterable[Limit]) -> str:
    """Explain why limits are undecided at points of a study: by a missing strength, else by their error bars."""
    missing = missing_reasons(study)
    reasons = dict.fromkeys(missing[limit.name] for limit in limits if limit.name in missing)
    return "; ".join(reasons) or "the error bar contains a limit: use a more accurate model"


def refusal_reason(study: xarray.Dataset, limits: Iterable[Limit], refused: str, place: str) -> str:
    """Describe the reason why no point of a study is allowed: limits, or a model without a result.

    `refused` begins the sentence for limits, such as "no point is allowed"; `place` ends that for a model without a
    result, such as "at any point".
    """
    model = study.attrs["model"]
    if bool(allowed(study, ()).any()):
        near = count_verdicts(study, limits := tuple(limits))[Verdict.UNDECIDED.word]
        words = f"; undecided: {near} of {study.status.size}, {undecided_reason(study, limits)}" if near else ""
        return f"{refused} by {' and '.join(map(str, limits))}, according to {model}{words}"
    numbers, counts = numpy.unique(study.status.values, return_counts=True)
    return f"{model} has no answer {place}: {Status(int(numbers[counts.argmax()])).sentence}"
