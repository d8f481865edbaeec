"""Profile likelihood: intervals of each unknown with all other unknowns fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from .misfit import Misfit

_MAX_ITERATIONS = 40
_FIRST_STEP = 0.5  # largest step of an unknown, in deviations of its prior
_SMALLEST_STEP = 1e-3
_SLOW_STEP = 0.02  # lower limit of the step on a curved profile
_TOLERANCE = 0.02  # relative tolerance of the rise in χ² at an end
_LEVENBERG = 1e-6  # damping added to the curvature, in units of the prior's information
_PULL = 0.1  # smallest gain, over the rise in χ², for which the end of a range limits an interval
_AT_LIMIT = 1e-9  # distance from the end of a range, in deviations of the prior


@dataclass(frozen=True, eq=False)
class ProfileEnd:
    """One end of a profile interval.

    Attributes
    ----------
    theta : array (unknowns,)
        Scaled unknowns at the end; all other unknowns are fitted.
    closed : bool
        True where χ² reaches its limit; False where the range of the unknown ends first.
    limited_by : tuple of int
        Indices of the unknowns at an end of their ranges that increase χ² there.
    """

    theta: Numbers
    closed: bool
    limited_by: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Profiles:
    """Ends of profile intervals, and the best point on all paths.

    Attributes
    ----------
    ends : list of list of pairs of ProfileEnd
        Lower and upper end, by the limit on the rise of χ² and by unknown.
    lowest : array (unknowns,)
        Point of the smallest misfit on all paths.
    cost : float
        Misfit at that point, half of χ².
    """

    ends: list[list[tuple[ProfileEnd, ProfileEnd]]]
    lowest: Numbers
    cost: float


@dataclass(eq=False)
class _Path:
    """Path along the profile of one unknown to one of its ends."""

    index: int
    side: int
    rise: float
    theta: Numbers
    previous: Numbers
    step: float = _FIRST_STEP
    end: ProfileEnd | None = None


@dataclass(frozen=True, eq=False)
class _Point:
    """Quadratic model of χ² about a point of a path."""

    rise: float
    gradient: Numbers
    hessian: Numbers


def profile_ends(misfit: Misfit, starts: Sequence[Numbers], cost: float, rises: Sequence[float]) -> Profiles:
    """Find both ends of the profile interval of each unknown.

    All ends are computed together: an iteration needs one array call of the model.

    Parameters
    ----------
    misfit : Misfit
    starts : sequence of array (unknowns,)
        Best point, and other points with nearly the same misfit.
    cost : float
        Misfit of the best point, half of χ².
    rises : sequence of float
        Limits on the rise of χ² above that of the best point.

    References
    ----------
    Venzon & Moolgavkar 1988, Appl. Stat. 37, 87; Raue et al. 2009, Bioinformatics 25, 1923.
    """
    indices = range(len(starts[0]))
    paths = [
        _Path(index, side, rise, start, start)
        for rise in rises
        for index in indices
        for side in (-1, 1)
        for start in starts
    ]
    low, high = misfit.scales.low, misfit.scales.high
    lowest, least = starts[0], cost
    for _ in range(_MAX_ITERATIONS):
        active = [path for path in paths if path.end is None]
        if not active:
            break
        residuals, slopes = misfit.both(numpy.stack([path.theta for path in active]))
        costs = numpy.nan_to_num(numpy.sum(residuals**2, axis=1) / 2, nan=numpy.inf)
        if costs.min() < least:
            lowest, least = active[int(costs.argmin())].theta, float(costs.min())
        for path, residual, slope in zip(active, residuals, slopes, strict=True):
            _advance(path, residual, slope, cost, low, high)
    ends = iter([path.end or ProfileEnd(path.previous, False, (path.index,)) for path in paths])
    rows = [
        [(_outermost(ends, len(starts), index, -1), _outermost(ends, len(starts), index, 1)) for index in indices]
        for _ in rises
    ]
    return Profiles(rows, lowest, least)


def _outermost(ends: Iterator[ProfileEnd], count: int, index: int, side: int) -> ProfileEnd:
    """Read the next ends, one for each start, and choose the outermost."""
    return max([next(ends) for _ in range(count)], key=lambda end: side * float(end.theta[index]))


def _limits(path: _Path, point: _Point, move: Numbers, low: Numbers, high: Numbers) -> tuple[int, ...]:
    """Find the other unknowns at an end of their ranges whose gradient of χ² points outward."""
    theta = numpy.clip(path.theta + move, low, high)
    pull = point.gradient + point.hessian @ move
    outward = ((theta - low < _AT_LIMIT) & (pull > 0)) | ((high - theta < _AT_LIMIT) & (pull < 0))
    inner = set(numpy.flatnonzero(~outward).tolist()) - {path.index}
    pressed = [index for index in numpy.flatnonzero(outward).tolist() if index != path.index]
    return tuple(index for index in pressed if _gain(point.hessian, pull, [*inner, index]) > _PULL * path.rise)


def _gain(hessian: Numbers, gradient: Numbers, free: list[int]) -> float:
    """Compute the decrease of χ² to its minimum over the free unknowns, by the quadratic model."""
    return float(gradient[free] @ numpy.linalg.solve(hessian[numpy.ix_(free, free)], gradient[free]))


def _advance(path: _Path, residual: Numbers, slope: Numbers, best: float, low: Numbers, high: Numbers) -> None:
    """Take one Newton step towards the end, or cut the step to a quarter where the model has no result."""
    if not (numpy.isfinite(residual).all() and numpy.isfinite(slope).all()):
        path.step /= 4
        path.theta = path.previous + (path.theta - path.previous) / 4
        if path.step < _SMALLEST_STEP:
            path.end = ProfileEnd(path.previous, False, (path.index,))
        return
    theta = path.theta
    hessian = slope.T @ slope + _LEVENBERG * numpy.eye(len(theta))
    point = _Point(float(residual @ residual) - 2 * best, slope.T @ residual, hessian)
    move, excess, gain = _newton_step(path, point, low, high)
    limit = high[path.index] - theta[path.index] if path.side > 0 else theta[path.index] - low[path.index]
    path.previous = theta
    relaxed = gain < _TOLERANCE * path.rise
    if relaxed and abs(excess - path.rise) < _TOLERANCE * path.rise:
        end = numpy.clip(theta + move, low, high)
        path.end = ProfileEnd(end, True, _limits(path, point, move, low, high))
    elif relaxed and limit < _AT_LIMIT and excess < path.rise:
        limits = _limits(path, point, numpy.zeros(len(theta)), low, high)
        path.end = ProfileEnd(theta, False, (path.index, *limits))
    else:
        path.step = max(path.step / 2, _SLOW_STEP) if gain > path.rise else path.step
        path.theta = numpy.clip(theta + move, low, high)


def _newton_step(path: _Path, point: _Point, low: Numbers, high: Numbers) -> tuple[Numbers, float, float]:
    """Solve the quadratic model for the end; return the step, the rise of χ² on the profile, and the gain.

    The other unknowns minimise χ² within their ranges.
    """
    index, theta = path.index, path.theta
    outward = ((theta - low < _AT_LIMIT) & (point.gradient > 0)) | ((high - theta < _AT_LIMIT) & (point.gradient < 0))
    held = outward.copy()
    held[index] = True
    fixed = numpy.zeros(len(theta))
    while True:
        pull = point.gradient + point.hessian @ fixed
        level = point.rise + float(fixed @ (point.gradient + pull))
        free = numpy.flatnonzero(~held)
        sides = numpy.stack([pull[free], point.hessian[free, index]], axis=1)
        answers = numpy.linalg.solve(point.hessian[numpy.ix_(free, free)], sides) if len(free) else sides
        gain = float(pull[free] @ answers[:, 0])
        slope, curvature = (
            numpy.array([pull[index], point.hessian[index, index]]) - point.hessian[index, free] @ answers
        )
        along = 0.0
        if gain < path.rise:  # χ² rises by 2 slope δ + curvature δ² along the profile
            root = max(slope * slope + curvature * (path.rise - level + gain), 0.0) ** 0.5
            along = float(numpy.clip((path.side * root - slope) / curvature, -path.step, path.step))
        along = float(numpy.clip(theta[index] + along, low[index], high[index]) - theta[index])
        move = fixed.copy()
        move[index] = along
        move[free] = -answers[:, 0] - answers[:, 1] * along
        beyond = numpy.where(held, 0.0, numpy.maximum(low - theta - move, theta + move - high))
        worst = int(numpy.argmax(beyond))
        if beyond[worst] <= 0:
            return move, level - gain, gain
        held[worst] = True
        fixed[worst] = numpy.clip(theta[worst] + move[worst], low[worst], high[worst]) - theta[worst]
