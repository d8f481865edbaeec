"""Constants of a force element, the position of its ball, and smooth corners of its formulas.

r = (x, y, z) is the position of the ball centre relative to the socket centre, in axes fixed to the socket. From it
follow e = |r|, n = r/e and d = e - c, with the radial clearance c.
"""

from __future__ import annotations

from math import inf, pi
from typing import NamedTuple

from ..core.arrays import Array, atan2, clip, safe_divisor, sqrt, where

Vector = tuple[Array, Array, Array]  # components of a vector


class Constants(NamedTuple):
    """Constants of a force element except its potential: lengths in mm, speeds in mm/s, times in s.

    `rim` is the polar angle of the cup rim in rad, 0 without a rim. `dome` is the unit vector to the pole of the bore.
    `film_damping` is π η (R1 R2)²/c³ in N s/mm with the viscosity η, 0 without a lubricant. `least_film` is the least
    thickness of its film, and `film_tension` the largest tensile force in N that the squeezed film bears.
    """

    ball_radius: float
    socket_radius: float
    clearance: float
    wall: float
    smoothing: float
    hysteresis: float
    time: float
    sliding: float
    static: float
    transition_speed: float
    stribeck_speed: float
    viscous: float
    rim: float
    dome_x: float
    dome_y: float
    dome_z: float
    film_damping: float = 0.0
    least_film: float = 0.0
    film_tension: float = inf


class BallCentre(NamedTuple):
    """Position of the ball centre: distance and direction from the socket centre, indentation, and inverse distance.

    The direction is a unit vector, or zero where the centres coincide.
    """

    distance: Array
    x: Array
    y: Array
    z: Array
    indentation: Array
    inverse_distance: Array


def ball_centre_at(x: Array, y: Array, z: Array, clearance: float) -> BallCentre:
    """Compute distance, direction and indentation of the ball centre from its coordinates in mm."""
    distance = sqrt(x * x + y * y + z * z)
    inverse_distance = 1.0 / safe_divisor(distance)
    return BallCentre(
        distance,
        x * inverse_distance,
        y * inverse_distance,
        z * inverse_distance,
        distance - clearance,
        inverse_distance,
    )


def dome_angle(centre: BallCentre, constants: Constants) -> tuple[Array, Array, Array, Array, Array]:
    """Compute cosine and sine of the angle γ from the dome axis to the ball, and sin γ times its direction.

    The last three results are sin γ times the direction of increasing γ.
    """
    dome_cosine = constants.dome_x * centre.x + constants.dome_y * centre.y + constants.dome_z * centre.z
    ax = dome_cosine * centre.x - constants.dome_x
    ay = dome_cosine * centre.y - constants.dome_y
    az = dome_cosine * centre.z - constants.dome_z
    return dome_cosine, sqrt(ax * ax + ay * ay + az * az), ax, ay, az


def smooth_ramp(y: Array, width: float) -> tuple[Array, Array, Array]:
    """Compute max(y, 0) with a smooth corner within ± `width`, and its first and second derivative."""
    if width == 0.0:
        zero = 0.0 * y
        return where(y > 0.0, y, zero), where(y >= 0.0, zero + 1.0, zero), zero
    t = clip((y + width) / (2.0 * width), 0.0, 1.0)
    bend = 15.0 * t * t * (1.0 - t) * (1.0 - t) / width
    return where(y >= width, y, 2.0 * width * _corner_polynomial(t)), t * t * t * (10.0 - 15.0 * t + 6.0 * t * t), bend


def smooth_ramp_value(y: Array, width: Array) -> Array:
    """Compute max(y, 0) with a smooth corner within ± `width`; the width may be an array."""
    span = where(width > 0.0, width, 1.0)
    t = clip((y + width) / (2.0 * span), 0.0, 1.0)
    return where(y >= width, y, 2.0 * width * _corner_polynomial(t))


def _corner_polynomial(t: Array) -> Array:
    """Compute the polynomial ∫ (10 t³ - 15 t⁴ + 6 t⁵) dt of the smooth corner."""
    return t * t * t * t * (2.5 - 3.0 * t + t * t)


def rim_share(rim_distance: Array) -> tuple[Array, Array, Array]:
    """Compute the fraction W of the contact energy inside a straight rim, with its first and second derivative.

    s is the distance of the rim from the patch centre over the half angle. W is 1 for s >= 1, and 0 for s <= -1. It is
    the marginal of (1 - x² - y²)² over a disc, the energy density of radial springs under a small patch.
    """
    clipped_distance = clip(rim_distance, -1.0, 1.0)
    one_minus_square = clip(1.0 - clipped_distance * clipped_distance, 0.0, 1.0)
    root = sqrt(one_minus_square)
    W = (
        0.5
        + (
            atan2(clipped_distance, root)
            + clipped_distance
            * root
            * (33.0 + clipped_distance * clipped_distance * (8.0 * clipped_distance * clipped_distance - 26.0))
            / 15.0
        )
        / pi
    )
    slope = 16.0 / (5.0 * pi) * one_minus_square * one_minus_square * root
    return clip(W, 0.0, 1.0), slope, -16.0 / pi * clipped_distance * one_minus_square * root
