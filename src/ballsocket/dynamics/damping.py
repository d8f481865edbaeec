"""Damping of a contact: hysteresis damping of Hunt & Crossley, and a Kelvin-Voigt liner."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..core.checks import check_number, require
from ..core.sources import Source
from . import restitution as relations
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
        _check_and_store_number(
            self, "hysteresis", "damping must be at least 0 and finite; negative damping would generate energy"
        )
        _check_and_store_number(self, "time", "a retardation time (s) must be at least 0 and finite")

    def restitution(self, speed: float) -> float:
        """Compute the coefficient of restitution at an impact speed in mm/s, for the hysteresis χ without τ.

        It does not depend on the force law F(d).
        """
        return restitution_of(self.hysteresis * speed)


def _check_and_store_number(damping: Damping, name: str, allowed: str) -> None:
    """Check a field of a `Damping` against its limits, and store it as a float."""
    value = check_number(name, getattr(damping, name))
    require(name, value, 0.0 <= value < math.inf, allowed)
    object.__setattr__(damping, name, value)


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
    require("impact_speed", speed, 0.0 < speed < math.inf, "a speed (mm/s) must be above 0 and finite")
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
