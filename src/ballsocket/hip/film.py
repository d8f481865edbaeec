"""The film between ball and socket over a cycle, and what friction does: moment, power, heat."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..problem import Joint, Material
from .kinematics import SurfaceSliding
from .placing import Placed
from .springs import CycleBed, Rest

CONFORMING = (
    "Hamrock and Dowson's films are those of bodies that hardly conform: here they tell a regime, not a thickness"
)
_MIXED, _FULL = 1.0, 3.0


@dataclass(frozen=True, kw_only=True)
class Lubricant:
    """What lies between ball and socket, and how rough they are.

    Parameters
    ----------
    viscosity : float
        In Pa s: 2.5e-3 (default) in a joint, about 1e-3 in diluted serum.
    ball_roughness, cup_roughness : float
        Ra in mm, 2e-5 and 1e-3 by default.
    friction : float
        The coefficient of friction, 0.06 by default.
    """

    viscosity: float = 2.5e-3
    ball_roughness: float = 2e-5
    cup_roughness: float = 1e-3
    friction: float = 0.06

    def __post_init__(self) -> None:
        require("viscosity", self.viscosity, 0 < self.viscosity < inf, "a viscosity (Pa s) is positive and finite")
        for name in ("ball_roughness", "cup_roughness"):
            value = getattr(self, name)
            require(name, value, 0 <= value < inf, "a roughness (mm) is at least 0, and finite")
        require("friction", self.friction, 0 <= self.friction < 10, "a coefficient of friction is 0 to 10")


def film_thickness(joint: Joint, force: Numbers, spin: Numbers, viscosity: float) -> tuple[Numbers, Numbers]:
    """The least and the central thickness of a film in mm, by Hamrock and Dowson: isoviscous, elastic, circular.

    Parameters
    ----------
    joint : Joint
    force : array
        In N.
    spin : array
        Of the ball across the load, in rad/s.
    viscosity : float
        In Pa s.

    Returns
    -------
    pair of arrays
        NaN without clearance, where no body of revolution stands for ball and socket.
    """
    if float(joint.clearance) == 0:
        return numpy.full_like(force, numpy.nan), numpy.full_like(force, numpy.nan)
    # h_min = 2.80 R* U^.65 W^-.21, h_cen = 3.34 R* U^.64 W^-.22, U = ηu/(E'R*), W = F/(E'R*²), u = ωR1/2
    radius = float(joint.ball_radius * joint.socket_radius / joint.clearance)
    modulus = 2 / (_give(joint.liner) + (0.0 if joint.ball is None else _give(joint.ball)))
    speed = 1e-6 * viscosity * spin * float(joint.ball_radius) / 2 / (modulus * radius)
    load = force / (modulus * radius**2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        least, central = 2.80 * radius * speed**0.65 * load**-0.21, 3.34 * radius * speed**0.64 * load**-0.22
    return least, central


def _give(material: Material) -> float:
    return float((1 - material.poisson**2) / material.young)


@dataclass(frozen=True, kw_only=True, eq=False)
class Film:
    """A cycle of film and friction, over the instants in which the ball is pressed.

    Attributes
    ----------
    phases : array (instants,)
        0 to 1.
    least, central : array (instants,)
        Thickness in mm.
    ratio : array (instants,)
        λ, the least thickness over the roughness of both.
    moment : array (instants, 3)
        Of friction on the cup about its centre in N mm, in the cup's frame; that on the ball is its opposite.
    power : array (instants,)
        Of friction in W.
    heat : float
        Of a cycle in J.
    duration : float
        Of a cycle in s.
    """

    phases: Numbers
    least: Numbers
    central: Numbers
    ratio: Numbers
    moment: Numbers
    power: Numbers
    heat: float
    duration: float

    @property
    def regime(self) -> str:
        """Where the film is thickest: boundary, mixed or full; unknown without clearance."""
        largest = float(self.ratio.max(initial=0.0))
        if numpy.isnan(largest):
            return "unknown"
        return "boundary" if largest < _MIXED else "mixed" if largest < _FULL else "full"

    def summary(self) -> dict[str, Any]:
        """For JSON; thickness in nm."""
        if not len(self.phases):
            return {}
        size = numpy.linalg.norm(self.moment, axis=1)
        told = {
            "least_nm": 1e6 * self.least.min(),
            "largest_nm": 1e6 * self.least.max(),
            "lambda_least": self.ratio.min(),
            "lambda_largest": self.ratio.max(),
            "moment_Nmm": size.max(),
            "power_W": self.heat / self.duration,
            "heat_J_per_cycle": self.heat,
        }
        numbers = {name: float(each) if numpy.isfinite(each) else None for name, each in told.items()}
        most = [float(part) for part in self.moment[size.argmax()]]
        return {**numbers, "moment_on_cup_Nmm": most, "regime": self.regime, "note": CONFORMING}


def film(placed: Placed, bed: CycleBed, sliding: SurfaceSliding, rest: Rest, lubricant: Lubricant) -> Film:
    """The film and the friction of a cycle of contacts, where the ball slides so over this bore."""
    instant = placed.cycle.seconds[placed.loaded]
    carried = placed.carried(rest.displacement)
    size = numpy.linalg.norm(carried, axis=1)
    across = numpy.linalg.norm(numpy.cross(placed.rotation_increments, carried), axis=1) / numpy.where(
        size > 0, size, 1.0
    )
    least, central = film_thickness(placed.joint, size, across / instant, lubricant.viscosity)
    rough = float(numpy.hypot(lubricant.ball_roughness, lubricant.cup_roughness))
    work = lubricant.friction * numpy.einsum("tp,tp,p->t", rest.pressure, sliding.distances, bed.areas)
    return Film(
        phases=placed.cycle.phases[placed.loaded],
        least=least,
        central=central,
        ratio=least / rough if rough > 0 else numpy.full_like(least, inf),
        moment=lubricant.friction * _moment(bed, sliding, rest.pressure),
        power=1e-3 * work / instant,
        heat=1e-3 * float(work.sum()),
        duration=placed.cycle.duration,
    )


def _moment(bed: CycleBed, sliding: SurfaceSliding, pressure: Numbers) -> Numbers:
    """∫ R n × v/abs(v) p dA, v = R ω × n: n × (ω × n) = ω - (ω·n) n; in N mm: (instants, 3)."""
    n, turns, steps = bed.directions, sliding.rotation_increments, sliding.distances
    share = numpy.divide(pressure * bed.areas * sliding.radius**2, steps, out=numpy.zeros_like(steps), where=steps > 0)
    along = share * (turns @ n)
    return turns * share.sum(axis=1)[:, None] - along @ n.T
