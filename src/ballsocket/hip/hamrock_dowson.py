"""Film thickness by the formulas of Hamrock and Dowson, for bodies of low conformity."""

from __future__ import annotations

import numpy

from ..core.arrays import Numbers
from ..problem import Joint, Material

CONFORMITY_NOTE = (
    "Hamrock and Dowson's formulas hold for bodies of low conformity: here they give a regime, not a thickness"
)
"""Note on the film thickness of a conforming joint."""


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
        minimum = 2.80 * effective_radius * speed_parameter**0.65 * load_parameter**-0.21
        central = 3.34 * effective_radius * speed_parameter**0.64 * load_parameter**-0.22
    return minimum, central


def _plane_strain_compliance(material: Material) -> float:
    return float((1 - material.poisson**2) / material.young)
