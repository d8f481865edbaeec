"""LuGre friction: bristles between ball and socket, whose deflections are an internal state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..core.arrays import Array, safe_divisor, sqrt, where
from ..core.sources import Source
from .ball_centre import BallCentre
from .friction import (
    CoulombCoefficients,
    check_and_store_number,
    effective_slip,
    friction_coefficient,
    rolling_slip_ratio,
)
from .reaction import Sliding, versine

DEFLECTIONS = 4  # number of deflections
Deflections = tuple[Array, Array, Array, Array]
"""Deflections of the bristles in mm: x, y and z across the load, and the arc at the lever ρ about the load."""


@dataclass(frozen=True, kw_only=True)
class Bristles(CoulombCoefficients):
    """LuGre friction with the deflection of bristles as an internal state.

    For a deflection z, a slip v and a normal force N::

        z' = v - σ0 q(v) z/(h μ(q)),    f = -N (σ0 z + σ1 z' + σ2 v),

    for the slip across the load and the spin about it, which share the limit μ. q is the effective slip speed of
    `Friction`, and h v/q its slope. Sliding bristles have the resultants of the patch, within 1 % of the force and 7 %
    of the drilling moment. Rolling about a pole that does not slip has no loss in this model. Sticking bristles are
    springs of stiffness N σ0. The damping σ1 falls with the slip just enough that they generate no energy. After the
    ball leaves the socket the deflections decay with the time constant `release`. With σ1 = σ2 = 0 and one coefficient
    it is Dahl's model.

    Parameters
    ----------
    coefficient : float
        Coefficient of sliding friction, 0 or more.
    stiffness : float
        σ0 in 1/mm, above 0. The ball slides after a displacement of about μ/σ0.
    damping : float
        σ1 in s/mm, 0 or more.
    viscous : float
        σ2 in s/mm, 0 or more.
    static_coefficient : float, optional
        Coefficient at vanishing slip, not below `coefficient`. None, the default, is the same coefficient.
    stribeck_speed : float
        Speed of the transition from static to sliding friction in mm/s, above 0.
    release : float
        Time constant in s, above 0, of the decay of the deflections without contact.

    Raises
    ------
    ValueError
        A value out of range.
    TypeError
        A value that is not a number.

    References
    ----------
    Canudas de Wit et al. 1995, doi 10.1109/9.376053.
    """

    sources: ClassVar[tuple[Source, ...]] = (Source("canudas1995"),)

    coefficient: float
    stiffness: float = 100.0
    damping: float = 0.0
    viscous: float = 0.0
    static_coefficient: float | None = None
    stribeck_speed: float = 10.0
    release: float = 1e-3

    def __post_init__(self) -> None:
        for name in ("coefficient", "damping", "viscous"):
            check_and_store_number(
                self, name, 0.0, "friction must be at least 0 and finite; negative friction would generate energy"
            )
        for name in ("stiffness", "stribeck_speed", "release"):
            check_and_store_number(self, name, 5e-324, "it must be above 0 and finite")
        self.check_static()


def bristle_forces(
    centre: BallCentre, slip: Sliding, deflection: Deflections, bristles: Bristles
) -> tuple[Deflections, Deflections, Array]:
    """Compute friction force and dissipated power of bristles per normal force, and the rates of their deflections.

    The friction has three components across the load and one about it, a moment divided by the lever ρ.
    """
    slip_components = slip.x + slip.bx, slip.y + slip.by, slip.z + slip.bz, sqrt(slip.lever_squared) * slip.spin
    deflection_x, deflection_y, deflection_z, deflection_arc = deflection
    normal_part = deflection_x * centre.x + deflection_y * centre.y + deflection_z * centre.z
    tangential_deflection = (
        deflection_x - normal_part * centre.x,
        deflection_y - normal_part * centre.y,
        deflection_z - normal_part * centre.z,
        deflection_arc,
    )
    speed, slopes, least_slope = _effective_slip_speed(slip_components, centre)
    friction_coefficient_at_speed = safe_divisor(
        friction_coefficient(speed, bristles.coefficient, bristles.breakaway_coefficient, bristles.stribeck_speed)
    )
    decay = bristles.stiffness * speed / friction_coefficient_at_speed
    damping = bristles.damping / (1.0 + bristles.damping * speed / (4.0 * friction_coefficient_at_speed * least_slope))
    losses = tuple(decay * bend / slope for bend, slope in zip(tangential_deflection, slopes, strict=True))
    deflection_rates = tuple(slip_rate - loss for slip_rate, loss in zip(slip_components, losses, strict=True))
    states = zip(tangential_deflection, deflection_rates, slip_components, strict=True)
    force = tuple(
        bristles.stiffness * bend + damping * change + bristles.viscous * slip_rate
        for bend, change, slip_rate in states
    )

    def dot_product(first: Deflections, second: Deflections) -> Array:
        x, *others = (a * b for a, b in zip(first, second, strict=True))
        return sum(others, x)

    dissipated = (
        bristles.stiffness * dot_product(losses, tangential_deflection)
        + damping * dot_product(deflection_rates, slip_components)
        + bristles.viscous * dot_product(slip_components, slip_components)
    )
    touching = slip.normal > 0.0
    released_rate = tuple(
        where(touching, change, -bend / bristles.release)
        for change, bend in zip(deflection_rates, deflection, strict=True)
    )
    return force, released_rate, dissipated


_TRANSITION_SPEED_SQUARED = 1e-30  # square of the transition speed in (mm/s)²; too small to change the slip


def _effective_slip_speed(slip: Deflections, centre: BallCentre) -> tuple[Array, Deflections, Array]:
    """Compute the effective slip speed in mm/s, its derivatives by half the squares of the slip, and the least."""
    slip_x, slip_y, slip_z, slip_arc = slip
    patch_versine = versine(centre)
    squared_slip, slip_ratio = slip_x * slip_x + slip_y * slip_y + slip_z * slip_z, rolling_slip_ratio(patch_versine)
    squared_slip_ratio = slip_ratio * slip_ratio
    squared_speed, by_slip, by_tilt, by_spin, _ = effective_slip(
        squared_slip,
        squared_slip_ratio * squared_slip,
        slip_arc * slip_arc,
        0.0,
        _TRANSITION_SPEED_SQUARED,
        squared_slip_ratio,
        patch_versine,
    )
    by_slip_and_tilt = by_slip + squared_slip_ratio * by_tilt
    return (
        sqrt(squared_speed),
        (by_slip_and_tilt, by_slip_and_tilt, by_slip_and_tilt, by_spin),
        where(by_slip_and_tilt < by_spin, by_slip_and_tilt, by_spin),
    )
