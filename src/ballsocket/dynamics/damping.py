"""Damping of a contact: hysteresis damping, a Kelvin-Voigt liner, and damping estimated from measured rebounds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, nan
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require
from ..core.display import counted
from ..core.records import Record
from ..core.sources import Source
from ..core.unit_systems import Sentence, with_error
from . import restitution as relations
from .friction import check_and_store_number
from .restitution import Relation, restitution_of


@dataclass(frozen=True, kw_only=True)
class Damping:
    """Contact damping with the normal force F + (χ F + τ k) ḋ, which is never negative.

    F and k are the elastic force and stiffness at the indentation d. The term with χ is that of Hunt & Crossley. The
    term with τ is a liner of Kelvin-Voigt springs with the pressure K (u + τ u̇). It also dissipates the power
    τ F/e v² when the contact moves along the socket with the speed v, at a distance e of the centres.

    Parameters
    ----------
    hysteresis : float
        χ in s/mm, 0 or more. `Flores(...)` and similar functions compute it from a coefficient of restitution.
    time : float
        Retardation time τ of the liner in s, 0 or more.
    sources : tuple of Source
        Published sources of the relation.

    Raises
    ------
    ValueError
        A number that is negative or not finite.
    TypeError
        A value that is not a number.

    Examples
    --------
    >>> from ballsocket.dynamics import Flores
    >>> damping = Flores(restitution=0.8, impact_speed=100.0)
    >>> round(damping.hysteresis, 5), round(damping.restitution(100.0), 3), round(damping.restitution(200.0), 3)
    (0.004, 0.789, 0.648)
    """

    hysteresis: float = 0.0
    time: float = 0.0
    sources: tuple[Source, ...] = ()

    def __post_init__(self) -> None:
        check_and_store_number(
            self, "hysteresis", 0.0, "damping must be at least 0 and finite; negative damping would generate energy"
        )
        check_and_store_number(self, "time", 0.0, "a retardation time (s) must be at least 0 and finite")

    def restitution(self, speed: float) -> float:
        """Compute the coefficient of restitution at an impact speed in mm/s, for the hysteresis χ without τ.

        It does not depend on the force law F(d).
        """
        return restitution_of(self.hysteresis * speed)


def damping_from_restitution(relation: Relation, restitution: float, impact_speed: float) -> Damping:
    """Compute the damping that gives a coefficient of restitution at an impact speed, by a published relation.

    Parameters
    ----------
    relation : Relation
        One of `ballsocket.dynamics.relations`; `exact` reproduces the coefficient, the others approximate it.
    restitution : float
        e, above 0 and up to 1.
    impact_speed : float
        Speed at first contact in mm/s, above 0.

    Raises
    ------
    ValueError
        A value out of range.
    """
    speed = check_number("impact_speed", impact_speed)
    require("impact_speed", speed, 0.0 < speed < inf, "a speed (mm/s) must be above 0 and finite")
    chi = relation.damping(check_number("restitution", restitution)) / speed
    return Damping(hysteresis=chi, sources=relation.sources)


def _damping_constructor(relation: Relation) -> Callable[..., Damping]:
    """Make a function that computes damping from a coefficient of restitution by a published relation."""

    def compute_damping(*, restitution: float, impact_speed: float) -> Damping:
        return damping_from_restitution(relation, restitution, impact_speed)

    compute_damping.__doc__ = f"""Compute damping from a coefficient of restitution by the relation of {relation.name}.

    Parameters
    ----------
    restitution : float
        e, above 0 and up to 1.
    impact_speed : float
        Speed at first contact in mm/s, above 0.

    Returns
    -------
    Damping
        χ = h/v with {relation.law}.
    """
    return compute_damping


HuntCrossley = _damping_constructor(relations.hunt_crossley)
LankaraniNikravesh = _damping_constructor(relations.lankarani_nikravesh)
Flores = _damping_constructor(relations.flores)
Gonthier = _damping_constructor(relations.gonthier)
Restitution = _damping_constructor(relations.exact)


GRAVITY = 9806.65  # acceleration of gravity in mm/s²


@dataclass(frozen=True, kw_only=True, eq=False)
class DampingEstimate(Record):
    """Damping estimated from measured coefficients of restitution.

    Attributes
    ----------
    damping : Damping
        Damping whose hysteresis χ is the least-squares fit to the measurements.
    error : float
        Standard error of χ in s/mm; NaN for a single measurement without uncertainty.
    noise : float
        Standard deviation of a measured coefficient of restitution: as stated, or the scatter about the fit.
    speed, restitution : array
        Measured speeds in mm/s and coefficients of restitution.
    """

    damping: Damping
    error: float
    noise: float
    speed: Numbers
    restitution: Numbers

    @property
    def residuals(self) -> Numbers:
        """Measured minus fitted coefficients of restitution."""
        return self.restitution - _restitutions_at(self.damping.hysteresis, self.speed)

    def __str__(self) -> str:
        numbers = with_error(self.damping.hysteresis, self.error)
        return Sentence("χ = {} ± {} s/mm from {}", *numbers, counted(len(self.speed), "restitution"))


def from_restitution(*, speed: Any, restitution: Any, uncertainty: float | None = None) -> DampingEstimate:
    """Fit damping to coefficients of restitution measured at several impact speeds in mm/s.

    Parameters
    ----------
    speed : array
        Impact speeds in mm/s, above 0.
    restitution : array
        Coefficients of restitution, above 0 and up to 1.
    uncertainty : float, optional
        Standard deviation of each coefficient; None, the default, uses the scatter about the fit.

    Raises
    ------
    ValueError
        A number out of range; arrays of different lengths.

    Examples
    --------
    >>> from ballsocket.dynamics import from_restitution
    >>> print(from_restitution(speed=[20.0, 40.0, 80.0], restitution=[0.951, 0.902, 0.822]))
    χ = 0.004037 ± 0.000036 s/mm from 3 restitutions
    """
    speeds = numpy.atleast_1d(numpy.asarray(speed, dtype=float))
    restitutions = numpy.atleast_1d(numpy.asarray(restitution, dtype=float))
    if speeds.shape != restitutions.shape or speeds.ndim != 1 or not len(speeds):
        raise ValueError(
            f"speed and restitution must be rows of equal length, got {speeds.shape} and {restitutions.shape}"
        )
    require("speed", speeds, (speeds > 0) & (speeds < inf), "a speed (mm/s) must be above 0 and finite")
    require(
        "restitution",
        restitutions,
        (restitutions > 0) & (restitutions <= 1),
        "a coefficient of restitution must be above 0 and at most 1",
    )
    if uncertainty is not None:
        valid = 0.0 < check_number("uncertainty", uncertainty) < inf
        require("uncertainty", uncertainty, valid, "a standard deviation must be above 0 and finite")
    hysteresis = _fit_hysteresis(speeds, restitutions)
    restitution_slopes = _restitution_slopes(hysteresis, speeds)
    residuals, freedom = restitutions - _restitutions_at(hysteresis, speeds), len(speeds) - 1
    scatter = float(numpy.sqrt(numpy.sum(residuals**2) / freedom)) if freedom else nan
    noise = scatter if uncertainty is None else float(uncertainty)
    error = noise / float(numpy.sqrt(numpy.sum(restitution_slopes**2)))
    return DampingEstimate(
        damping=Damping(hysteresis=hysteresis), error=error, noise=noise, speed=speeds, restitution=restitutions
    )


def from_bounces(*, times: Any, gravity: float = GRAVITY, uncertainty: float | None = None) -> DampingEstimate:
    """Fit damping to the touchdown times in s of a ball that bounces under its weight.

    The duration Δt of a flight gives the speed at both its ends, v = g Δt/2. The ratio of two successive speeds is the
    coefficient of restitution of the bounce between them.

    Parameters
    ----------
    times : array
        Times of at least three touch-downs in s, increasing.
    gravity : float
        Acceleration of gravity in mm/s².
    uncertainty : float, optional
        Standard deviation of each coefficient of restitution, as in `from_restitution`.

    Raises
    ------
    ValueError
        Fewer than three times; times that do not increase, or flights that do not become shorter.
    """
    touchdown_times = numpy.asarray(times, dtype=float)
    require("the number of times", touchdown_times.size, touchdown_times.size >= 3, "at least three are needed")
    flight_durations = numpy.diff(touchdown_times)
    require("a flight", flight_durations, flight_durations > 0, "times must increase")
    speed = check_number("gravity", gravity) * flight_durations / 2
    return from_restitution(speed=speed[:-1], restitution=speed[1:] / speed[:-1], uncertainty=uncertainty)


def _restitutions_at(chi: float, speeds: Numbers) -> Numbers:
    """Compute the coefficients of restitution at impact speeds in mm/s, for a hysteresis χ in s/mm."""
    return numpy.array([restitution_of(chi * speed) for speed in speeds.tolist()])


def _restitution_slopes(chi: float, speeds: Numbers) -> Numbers:
    """Compute the derivatives ∂e/∂χ of the coefficients of restitution, from h (1 + e) = ln[(1 + h)/(1 - h e)]."""
    h, e = chi * speeds, _restitutions_at(chi, speeds)
    small = h < 1e-4
    nonzero_h = numpy.where(small, 0.5, h)
    slope = (1 / (1 + nonzero_h) - e * e / (1 - nonzero_h * e)) * (1 - nonzero_h * e) / (nonzero_h * e)
    return speeds * numpy.where(small, -2 / 3, slope)


def _fit_hysteresis(speeds: Numbers, restitutions: Numbers) -> float:
    chi = float(numpy.median(1.5 * (1 - restitutions) / speeds))
    for _ in range(50):
        slope = _restitution_slopes(chi, speeds)
        newton_step = float(numpy.sum(slope * (restitutions - _restitutions_at(chi, speeds))) / numpy.sum(slope**2))
        updated = max(chi + newton_step, chi / 4)
        change, chi = abs(updated - chi), updated
        if change <= 1e-12 * chi:
            break
    return chi
