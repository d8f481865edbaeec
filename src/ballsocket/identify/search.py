"""The best point: the start by a search over what was known, the end by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from .misfit import Misfit

_SEARCH = 3.0  # s that the search for a start may take
_FEWEST, _MOST = 16, 128
_STARTS = 2
_SAME = 1e-2  # in deviations of what was known, and in cost: ends of two searches that are one
_STEPS = 60
_TIE = 1e-6  # difference of cost that counts as equal


@dataclass(frozen=True, eq=False)
class Found:
    """Where a search ended.

    Attributes
    ----------
    places : array (unknowns,)
        The best point, in deviations of what was known.
    cost : float
        -ln of likelihood and of what was known, but for a constant.
    converged : bool
    rivals : tuple of array
        Ends of other searches that fit about as well, elsewhere.
    """

    places: Numbers
    cost: float
    converged: bool
    rivals: tuple[Numbers, ...] = ()


def found(misfit: Misfit, seed: int) -> Found:
    """The best of a few descents from the best points of a search.

    Raises
    ------
    ValueError
        No point between the ends has an answer for all data.
    """
    ends = [descended(misfit, start) for start in _starts(misfit, seed)]
    best = _central(misfit, ends)
    apart = [each for each in ends if numpy.max(abs(each.places - best.places)) > _SAME]
    near = tuple(each.places for each in apart if each.cost < best.cost + 2.0)
    return Found(best.places, best.cost, best.converged, near)


def _central(misfit: Misfit, ends: list[Found]) -> Found:
    """Choose the end of least cost; among equal costs, that nearest to the middle of the ranges."""
    least, middle = min(each.cost for each in ends), (misfit.scales.low + misfit.scales.high) / 2
    lowest = [each for each in ends if each.cost <= least + _TIE]
    return min(lowest, key=lambda each: float(numpy.max(abs(each.places - middle))))


def _starts(misfit: Misfit, seed: int) -> list[Numbers]:
    """The best point of Sobol's, and the best that is not near it."""
    from scipy.stats import qmc

    scales = misfit.scales
    low, high = scales.low, scales.high
    cost = misfit.answers.model.seconds_a_press * len(misfit.value)
    count = 1 << (int(numpy.clip(_SEARCH / cost, _FEWEST, _MOST)).bit_length() - 1)
    shares = qmc.Sobol(len(low), rng=numpy.random.default_rng(seed)).random(count)
    points = low + shares * (high - low)
    costs = misfit.costs(points)
    if not numpy.isfinite(costs).any():
        raise ValueError(
            f"{misfit.answers.model.name} has no answer for all the data anywhere between the ends: "
            "measured values, ends or model do not go together"
        )
    first = int(numpy.argmin(costs))
    away = numpy.max(abs(points - points[first]), axis=1) > 0.25 * numpy.max(high - low)
    other = int(numpy.argmin(numpy.where(away, costs, numpy.inf)))
    return [points[first], points[other]] if numpy.isfinite(costs[other]) and away[other] else [points[first]]


def descended(misfit: Misfit, start: Numbers) -> Found:
    """Minimise the misfit from a start by least squares with derivatives."""
    from scipy.optimize import least_squares

    kept: dict[bytes, tuple[Numbers, Numbers]] = {}

    def both(places: Numbers) -> tuple[Numbers, Numbers]:
        key = places.tobytes()
        if key not in kept:
            kept.clear()
            kept[key] = misfit.both(places)
        return kept[key]

    ended = least_squares(
        lambda places: both(places)[0],
        start,
        jac=lambda places: both(places)[1],
        bounds=(misfit.scales.low, misfit.scales.high),
        x_scale=1.0,
        ftol=1e-10,
        xtol=1e-8,
        gtol=1e-8,
        max_nfev=_STEPS,
    )
    return Found(ended.x, float(ended.cost), bool(ended.success))
