"""Parameter sets of the figures of the paper (doi 10.3390/app112311170): steel on 1 GPa, lengths in mm, loads in N."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy

from ..core.arrays import Numbers
from ..core.quantities import JOINT
from ..problem import Joint, Material
from ..problem.presets import STEEL
from .accuracy import RANGES, THICKNESS
from .table_3 import paper_joint

POISSON = (0.30, 0.35, 0.40, 0.45, 0.49)
"""Poisson's ratios of Table 3 and Figure 2."""

CLEARANCES = (0.05, 0.1, 0.15, 0.2)
HEAD_RADII = (11.0, 14.0, 16.0, 20.0, 23.0)
THICKNESSES = (3.0, 6.0, 9.0, 12.0)
"""Series of Figure 5 in mm. The paper states the ends of each series, and not always the values between them."""

LOAD = 3000.0
"""Force in N at which pressures and areas are shown."""

LOADS = numpy.array([1000.0, 1500.0, 2000.0, 2500.0, 3000.0])
"""Forces in N over which the foundation modulus is averaged."""

OUTER_RADII = RANGES["outer_radius"]
"""Limits of Table 1 for R2 + L in mm, dotted in Figure 6."""


def hip(poisson: Numbers | float = 0.4) -> Joint:
    """Create the joint of Figures 3 and 4: R2 18, L 6.75, c 0.1 mm."""
    return joint(head_radius=17.9, liner_thickness=6.75, poisson=poisson)


def joint(
    *,
    head_radius: Numbers | float = 16.0,
    clearance: Numbers | float = 0.1,
    liner_thickness: Numbers | float = 6.0,
    poisson: Numbers | float = 0.4,
) -> Joint:
    """Create a joint of Figure 5; the defaults are the common joint of its series."""
    return Joint(
        ball_radius=head_radius,
        clearance=clearance,
        liner_thickness=liner_thickness,
        liner=Material(young=1000.0, poisson=poisson),
        ball=STEEL,
    )


def series() -> dict[str, Joint]:
    """Return the three series of Figure 5, each as one joint of arrays."""
    return {
        "clearance": joint(clearance=numpy.array(CLEARANCES)),
        "head_radius": joint(head_radius=numpy.array(HEAD_RADII)),
        "liner_thickness": joint(liner_thickness=numpy.array(THICKNESSES)),
    }


def named_series() -> Iterator[tuple[str, Joint, tuple[float, ...]]]:
    """Yield symbol, joints and values of each series of Figure 5."""
    symbols = (JOINT[name].symbol for name in ("clearance", "ball_radius", "liner_thickness"))
    yield from zip(symbols, series().values(), (CLEARANCES, HEAD_RADII, THICKNESSES), strict=True)


def by_ratio(ratio: Numbers, poisson: Numbers | float) -> Joint:
    """Create the joints of Figure 2 (right) and Table 3 from R2/L; their outer radius is 24 mm."""
    return paper_joint(poisson, ratio)


def outline(poisson: float = 0.4, heads: int = 5, liners: int = 3) -> tuple[Numbers, Numbers, Joint]:
    """Return head radii and liner thicknesses in mm over the range of Table 1, and their joints with c 0.1 mm."""
    radius = numpy.linspace(*RANGES["ball_radius"], heads)[:, None] + numpy.zeros(liners)
    thinnest, thickest = (numpy.clip(outer - radius - 0.1, *THICKNESS) for outer in (OUTER_RADII[0], OUTER_RADII[1]))
    thickness = thinnest + (thickest - thinnest) * numpy.linspace(0.0, 1.0, liners)
    radius, thickness = radius.ravel(), thickness.ravel()
    return radius, thickness, joint(head_radius=radius, liner_thickness=thickness, poisson=poisson)


def with_clearance(joints: Joint, clearance: float) -> Joint:
    """Replace the radial clearance (mm) of joints."""
    return replace(joints, clearance=clearance)


def scaled_modulus(contact_pressure: Numbers, indentation: Numbers, socket_radius: Numbers) -> Numbers:
    """Compute the dimensionless modulus K~ = p0 R2/(d E), Eq. (17), for a liner of 1000 MPa."""
    return contact_pressure * socket_radius / (indentation * 1000.0)
