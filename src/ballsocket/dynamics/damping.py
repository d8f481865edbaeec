"""What a contact loses while it is pressed and let go: a hysteresis in the speed, and a liner that takes its time."""

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
    """The damping of a contact: its normal force is F + (χ F + τ k) ḋ, and never pulls.

    F and k are the elastic force and stiffness at the indentation d. The first part is that of Hunt & Crossley. The
    second is a liner of Kelvin-Voigt springs, each of which answers to K (u + τ u̇); a contact that travels along the
    socket loses energy with it too, τ F/e v² at a distance e of the centres.

    Parameters
    ----------
    hysteresis : float
        χ in s/mm, 0 or more. `Flores(...)` and its kin find it from a coefficient of restitution.
    time : float
        τ in s, 0 or more: the time of retardation of the liner.
    sources : tuple of Source

    Raises
    ------
    ValueError
        A number below 0, or not finite.
    TypeError
        What is no number.

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
        _set(self, "hysteresis", "damping is 0 or more and finite: below 0 a contact would make energy")
        _set(self, "time", "a time of retardation (s) is 0 or more and finite: below 0 a contact would make energy")

    def restitution(self, speed: float) -> float:
        """The coefficient of restitution at a speed of touch-down (mm/s) of χ alone, the same for all laws F(d)."""
        return restitution_of(self.hysteresis * speed)


def _set(damping: Damping, name: str, allowed: str) -> None:
    value = check_number(name, getattr(damping, name))
    require(name, value, 0.0 <= value < math.inf, allowed)
    object.__setattr__(damping, name, value)


def of_restitution(relation: Relation, restitution: float, impact_speed: float) -> Damping:
    """The damping that a relation takes for a coefficient of restitution at a speed of touch-down.

    Parameters
    ----------
    relation : Relation
        One of `ballsocket.dynamics.relations`; `exact` keeps the coefficient, the others nearly.
    restitution : float
        e, above 0 and up to 1.
    impact_speed : float
        At touch-down in mm/s, above 0.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """
    speed = check_number("impact_speed", impact_speed)
    require("impact_speed", speed, 0.0 < speed < math.inf, "a speed (mm/s) is above 0 and finite")
    chi = relation.damping(check_number("restitution", restitution)) / speed
    return Damping(hysteresis=chi, sources=relation.sources)


def _named(relation: Relation) -> Callable[..., Damping]:
    def damping(*, restitution: float, impact_speed: float) -> Damping:
        return of_restitution(relation, restitution, impact_speed)

    damping.__doc__ = f"""The damping of {relation.name} for a coefficient of restitution.

    Parameters
    ----------
    restitution : float
        e, above 0 and up to 1.
    impact_speed : float
        At touch-down in mm/s, above 0.

    Returns
    -------
    Damping
        χ = h/v with {relation.law}.
    """
    return damping


HuntCrossley = _named(relations.hunt_crossley)
LankaraniNikravesh = _named(relations.lankarani_nikravesh)
Flores = _named(relations.flores)
Gonthier = _named(relations.gonthier)
Restitution = _named(relations.exact)
