"""Lubricant film between ball and socket over a cycle, and friction: moment, power, heat."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Protocol

import numpy

from ..core.arrays import Numbers
from ..lubrication import Lubricant
from ..problem import Joint, Material
from .cycle import Cycle
from .kinematics import SurfaceSliding
from .mix import Mix
from .socket_foundation import CycleEquilibrium, SocketFoundation

CONFORMITY_NOTE = (
    "Hamrock and Dowson's formulas hold for bodies of low conformity: here they give a regime, not a thickness"
)
"""Note on the film thickness of a conforming joint."""

_MIXED_RATIO, _FULL_RATIO = 1.0, 3.0
"""Film ratios at which mixed and full-film lubrication begin."""


def film_thickness(joint: Joint, force: Numbers, spin: Numbers, viscosity: float) -> tuple[Numbers, Numbers]:
    """Compute the minimum and central film thickness in mm by the formulas of Hamrock and Dowson.

    Parameters
    ----------
    joint : Joint
    force : array
        Load in N.
    spin : array
        Rotation rate of the ball perpendicular to the load, in rad/s.
    viscosity : float
        Viscosity in Pa s.

    Returns
    -------
    pair of arrays
        Thicknesses; NaN without clearance, where no equivalent sphere exists.
    """
    if float(joint.clearance) == 0:
        return numpy.full_like(force, numpy.nan), numpy.full_like(force, numpy.nan)
    # h_min = 2.80 R* U^.65 W^-.21, h_cen = 3.34 R* U^.64 W^-.22, U = ηu/(E'R*), W = F/(E'R*²), u = ωR1/2
    effective_radius = float(joint.ball_radius * joint.socket_radius / joint.clearance)
    ball_compliance = 0.0 if joint.ball is None else _plane_strain_compliance(joint.ball)
    modulus = 2 / (_plane_strain_compliance(joint.liner) + ball_compliance)
    speed_parameter = 1e-6 * viscosity * spin * float(joint.ball_radius) / 2 / (modulus * effective_radius)
    load_parameter = force / (modulus * effective_radius**2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        minimum, central = (
            2.80 * effective_radius * speed_parameter**0.65 * load_parameter**-0.21,
            3.34 * effective_radius * speed_parameter**0.64 * load_parameter**-0.22,
        )
    return minimum, central


def _plane_strain_compliance(material: Material) -> float:
    """Compute the plane-strain compliance (1 - ν²)/E of a material in 1/MPa."""
    return float((1 - material.poisson**2) / material.young)


@dataclass(frozen=True, kw_only=True, eq=False)
class Film:
    """Lubricant film and friction in the loaded instants of a cycle.

    Attributes
    ----------
    phases : array (instants,)
        Phases of the cycle, 0 to 1.
    least, central : array (instants,)
        Minimum and central thickness in mm.
    ratio : array (instants,)
        Film ratio λ: minimum thickness over the combined roughness.
    moment : array (instants, 3)
        Friction moment on the cup about its centre in N mm, in the cup's frame; the moment on the ball is opposite.
    power : array (instants,)
        Friction power in W.
    heat : float
        Friction heat of a cycle in J.
    duration : float
        Duration of a cycle in s.
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
        """Lubrication regime at the thickest film: "boundary", "mixed" or "full"; "unknown" without clearance."""
        largest = float(self.ratio.max(initial=0.0))
        if numpy.isnan(largest):
            return "unknown"
        return "boundary" if largest < _MIXED_RATIO else "mixed" if largest < _FULL_RATIO else "full"

    def summary(self) -> dict[str, Any]:
        """Return film and friction as a dictionary for JSON, with thicknesses in nm."""
        if not len(self.phases):
            return {}
        moment_magnitudes = numpy.linalg.norm(self.moment, axis=1)
        values = {
            "least_nm": 1e6 * self.least.min(),
            "largest_nm": 1e6 * self.least.max(),
            "lambda_least": self.ratio.min(),
            "lambda_largest": self.ratio.max(),
            "moment_Nmm": moment_magnitudes.max(),
            "power_W": self.heat / self.duration,
            "heat_J_per_cycle": self.heat,
        }
        finite_values = {name: float(value) if numpy.isfinite(value) else None for name, value in values.items()}
        largest_moment = [float(component) for component in self.moment[moment_magnitudes.argmax()]]
        return {**finite_values, "moment_on_cup_Nmm": largest_moment, "regime": self.regime, "note": CONFORMITY_NOTE}


class LoadedCycle(Protocol):
    """Interface of the loads and rotations of a cycle in the cup's frame, such as `CupFrame`."""

    @property
    def joint(self) -> Joint:
        """Joint of single numbers."""
        ...

    @property
    def cycle(self) -> Cycle | Mix:
        """Cycle of loads and rotations."""
        ...

    @property
    def loaded(self) -> Numbers:
        """Indices of the loaded instants: (loaded,)."""
        ...

    @property
    def rotation_increments(self) -> Numbers:
        """Rotation vectors of the ball in the loaded instants in rad: (loaded, 3)."""
        ...

    def socket_forces(self, displacement: Numbers) -> Numbers:
        """Compute the forces on the socket in N for displacements (loaded, 3) of the ball in mm."""
        ...


def film(
    frame: LoadedCycle,
    foundation: SocketFoundation,
    sliding: SurfaceSliding,
    equilibrium: CycleEquilibrium,
    lubricant: Lubricant,
) -> Film:
    """Compute film thickness, friction moment, power and heat of a cycle from its contacts and sliding."""
    durations = frame.cycle.seconds[frame.loaded]
    forces = frame.socket_forces(equilibrium.displacement)
    force_magnitudes = numpy.linalg.norm(forces, axis=1)
    spin = numpy.linalg.norm(numpy.cross(frame.rotation_increments, forces), axis=1) / numpy.where(
        force_magnitudes > 0, force_magnitudes, 1.0
    )
    least, central = film_thickness(frame.joint, force_magnitudes, spin / durations, lubricant.viscosity)
    roughness = lubricant.roughness
    work = lubricant.friction * numpy.einsum("tp,tp,p->t", equilibrium.pressure, sliding.distances, foundation.areas)
    return Film(
        phases=frame.cycle.phases[frame.loaded],
        least=least,
        central=central,
        ratio=least / roughness if roughness > 0 else numpy.full_like(least, inf),
        moment=lubricant.friction * _moment_at_unit_friction(foundation, sliding, equilibrium.pressure),
        power=1e-3 * work / durations,
        heat=1e-3 * float(work.sum()),
        duration=frame.cycle.duration,
    )


def _moment_at_unit_friction(foundation: SocketFoundation, sliding: SurfaceSliding, pressure: Numbers) -> Numbers:
    """Compute the friction moment on the cup in N mm for a coefficient of friction of 1: (instants, 3).

    It is ∫ R n × v/abs(v) p dA with v = R ω × n, and n × (ω × n) = ω - (ω·n) n.
    """
    directions, rotations, distances = foundation.directions, sliding.rotation_increments, sliding.distances
    pressure_weight = numpy.divide(
        pressure * foundation.areas * sliding.radius**2,
        distances,
        out=numpy.zeros_like(distances),
        where=distances > 0,
    )
    normal_part = pressure_weight * (rotations @ directions)
    return rotations * pressure_weight.sum(axis=1)[:, None] - normal_part @ directions.T
