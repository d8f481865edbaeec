"""The damping of a joint from what a ball keeps of its speed: measured restitutions, or the times of its bounces."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require
from .damping import Damping
from .restitution import restitution_of

GRAVITY = 9806.65
"""In mm/s²."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Identified:
    """A damping that was found from measurements.

    Attributes
    ----------
    damping : Damping
        Its hysteresis χ is the one that explains the measurements best (least squares).
    error : float
        The standard error of χ in s/mm; NaN where one measurement alone, without its uncertainty, cannot tell.
    noise : float
        The uncertainty of a measured coefficient of restitution: the one that was given, or the scatter that was found.
    speed, restitution : array
        What was measured.
    """

    damping: Damping
    error: float
    noise: float
    speed: Numbers
    restitution: Numbers

    @property
    def residuals(self) -> Numbers:
        """Measured less explained coefficients of restitution."""
        return self.restitution - _kept(self.damping.hysteresis, self.speed)

    def __str__(self) -> str:
        return f"χ = {self.damping.hysteresis:.4g} ± {self.error:.2g} s/mm from {len(self.speed)} restitutions"


def from_restitution(*, speed: Any, restitution: Any, uncertainty: float | None = None) -> Identified:
    """The damping of measured coefficients of restitution, by the exact relation, which holds for any law of contact.

    Parameters
    ----------
    speed : array
        At touch-down in mm/s, above 0.
    restitution : array
        What was kept of each, above 0 and up to 1.
    uncertainty : float, optional
        The standard deviation of each coefficient. None, the default, takes the scatter about the fit.

    Raises
    ------
    ValueError
        Numbers that are not allowed, named; rows of different lengths.

    Examples
    --------
    >>> from ballsocket.dynamics import from_restitution
    >>> print(from_restitution(speed=[20.0, 40.0, 80.0], restitution=[0.951, 0.902, 0.822]))
    χ = 0.004037 ± 3.6e-05 s/mm from 3 restitutions
    """
    speeds = numpy.atleast_1d(numpy.asarray(speed, dtype=float))
    shares = numpy.atleast_1d(numpy.asarray(restitution, dtype=float))
    if speeds.shape != shares.shape or speeds.ndim != 1 or not len(speeds):
        raise ValueError(f"speed and restitution are rows of one length, got {speeds.shape} and {shares.shape}")
    require("speed", speeds, (speeds > 0) & (speeds < inf), "a speed (mm/s) is above 0 and finite")
    require("restitution", shares, (shares > 0) & (shares <= 1), "a coefficient of restitution is above 0, up to 1")
    if uncertainty is not None:
        good = 0.0 < check_number("uncertainty", uncertainty) < inf
        require("uncertainty", uncertainty, good, "a standard deviation is above 0 and finite")
    chi = _fitted(speeds, shares)
    slope = _slope(chi, speeds)
    freedom = len(speeds) - 1
    scatter = float(numpy.sqrt(numpy.sum((shares - _kept(chi, speeds)) ** 2) / freedom)) if freedom else nan
    noise = scatter if uncertainty is None else float(uncertainty)
    error = noise / float(numpy.sqrt(numpy.sum(slope**2)))
    return Identified(damping=Damping(hysteresis=chi), error=error, noise=noise, speed=speeds, restitution=shares)


def from_bounces(*, times: Any, gravity: float = GRAVITY, uncertainty: float | None = None) -> Identified:
    """The damping of a ball that bounces under its weight, from the times at which it touches down.

    The flight between two touch-downs tells the speed at both its ends, v = g Δt/2; what one flight is shorter than the
    one before is what the bounce between them took.

    Parameters
    ----------
    times : array
        Of three touch-downs or more in s, growing.
    gravity : float
        In mm/s².
    uncertainty : float, optional
        Of each coefficient of restitution, as in `from_restitution`.

    Raises
    ------
    ValueError
        Fewer than three times; times that do not grow, or flights that do not get shorter.
    """
    instants = numpy.asarray(times, dtype=float)
    require("the number of times", instants.size, instants.size >= 3, "two flights are needed to see what one lost")
    flights = numpy.diff(instants)
    require("a flight", flights, flights > 0, "each touch-down is later than the one before")
    speed = check_number("gravity", gravity) * flights / 2
    return from_restitution(speed=speed[:-1], restitution=speed[1:] / speed[:-1], uncertainty=uncertainty)


def _kept(chi: float, speeds: Numbers) -> Numbers:
    return numpy.array([restitution_of(chi * speed) for speed in speeds.tolist()])


def _slope(chi: float, speeds: Numbers) -> Numbers:
    """∂e/∂χ, from h (1 + e) = ln[(1 + h)/(1 - h e)]."""
    h, e = chi * speeds, _kept(chi, speeds)
    small = h < 1e-4
    safe = numpy.where(small, 1.0, h)
    steep = (1 / (1 + safe) - e * e / (1 - safe * e)) * (1 - safe * e) / (safe * e)
    return speeds * numpy.where(small, -2 / 3, steep)


def _fitted(speeds: Numbers, shares: Numbers) -> float:
    """Gauss and Newton, from the relation of Hunt & Crossley; never below 0."""
    chi = float(numpy.median(1.5 * (1 - shares) / speeds))
    for _ in range(50):
        slope = _slope(chi, speeds)
        step = float(numpy.sum(slope * (shares - _kept(chi, speeds))) / numpy.sum(slope**2))
        after = max(chi + step, chi / 4)
        moved, chi = abs(after - chi), after
        if moved <= 1e-12 * chi:
            break
    return chi
