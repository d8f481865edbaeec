"""Hydrodynamic forces of a lubricant between a rigid ball and its rigid socket, in closed form.

The film of a ball at r = e n is h = c - e cos θ, with the angle θ from n. Reynolds' equation of the ball's velocity v
and spin ω has the right-hand side -V·m at the direction m, with V = v - ½ ω x r. So squeeze and wedge are one linear
problem, solved by the pressures

    p = 3 η R² V_n/(e h²) + constant,   p = 12 η R² V_t (2c - e cos θ) sin θ cos φ/[(4c² + e²) h²].

Their resultants, with κ = e/c, g = (artanh κ - κ)/κ³ and G = 1 + (1 + κ²) g, are the force and the moment

    f = -D_n V_n n - D_t V_t,   m = -½ r x f - C_n ω_n n - C_t ω_t,
    D_n = 12 D [1/(1 - κ²) - g],   D_t = 24 D G/(4 + κ²),   D = π η R⁴/c³,
    C_n = 4 D c² [1 - (1 - κ²) g],   C_t = 2 D c² G.

C_n and C_t are the shear of the film. The damping matrix is symmetric and positive semidefinite. No pressure is cut
off (full Sommerfeld), so that the fluid bears tension; `squeeze_damping` may limit it along n. With all negative
pressures set to 0 (half Sommerfeld) the damping matrix would not be symmetric. R² = R1 R2 makes the concentric limits
exact to (c/R)². Elsewhere the error is that of Reynolds' equation, of the order c/R.
"""

from __future__ import annotations

from math import inf, pi
from typing import NamedTuple

from ..core.arrays import Array, cos, log1p, safe_divisor, sin, sqrt, where
from ..core.checks import require
from ..lubrication import Lubricant
from ..problem import Joint
from .ball_centre import BallCentre, Constants, Vector, smooth_ramp


def film_constants(lubricant: Lubricant | None, tension: float, joint: Joint) -> dict[str, float]:
    """Return the constants of the lubricant's film by their names in `Constants`; None has no film.

    `tension` is the largest tension in MPa that the fluid bears.
    """
    if lubricant is None:
        if tension < inf:
            raise ValueError(f"film_tension = {tension:g} needs a lubricant")
        return {}
    clearance, roughness = float(joint.clearance), lubricant.roughness
    require("clearance", clearance, clearance > 0.0, "a lubricant needs a film, and so a clearance above 0 mm")
    allowed = (
        f"the least film (mm) of a lubricant must be above 0 and at most half of the clearance: {0.5 * clearance:g}"
    )
    require("roughness", roughness, 0.0 < roughness <= 0.5 * clearance, allowed)
    radii_product = float(joint.ball_radius * joint.socket_radius)
    damping = pi * lubricant.viscosity_mpa * radii_product**2 / clearance**3
    require("viscosity", lubricant.viscosity, 0.0 < damping < inf, "the damping of its film must be a finite number")
    return {"film_damping": damping, "least_film": roughness, "film_tension": pi * radii_product * tension}


class FilmDamping(NamedTuple):
    """Damping by the film: `along` and `across` the eccentricity in N s/mm, `drilling` and `turning` in N mm s.

    `along` is D_n, `across` D_t, `drilling` C_n and `turning` C_t. `steepening` is a bound of the increase of D_n with
    the eccentricity in N s/mm², for the iterations of a time step. `share` is the least film over the clearance.
    """

    along: Array
    across: Array
    drilling: Array
    turning: Array
    steepening: Array
    share: Array


def film_damping(centre: BallCentre, constants: Constants) -> FilmDamping:
    """Compute the damping coefficients of the film at a position of the ball."""
    c, D = constants.clearance, constants.film_damping
    gap, slope = film_thickness(centre, constants)
    share = gap / c
    kappa, one_minus_square = 1.0 - share, share * (2.0 - share)
    square = kappa * kappa
    g = _eccentricity_function(kappa, share)
    G = 1.0 + (1.0 + square) * g
    along, across = 12.0 * D * (1.0 / one_minus_square - g), 24.0 * D * G / (4.0 + square)
    drilling, turning = 4.0 * D * c * c * (1.0 - one_minus_square * g), 2.0 * D * c * c * G
    if constants.rim > 0.0:
        covered, rim_loss = _covered_share(kappa, one_minus_square, centre, constants)
        along, across = covered * covered * along, covered * covered * (across - rim_loss * D)
        drilling, turning = covered * drilling, covered * turning
    return FilmDamping(along, across, drilling, turning, along * slope / gap, share)


def film_thickness(centre: BallCentre, constants: Constants) -> tuple[Array, Array]:
    """Compute the least thickness of the gap in mm, and its decrease over the distance of the centres.

    It is c - e from two least films on, and falls smoothly to one least film where the surfaces touch.
    """
    least = constants.least_film
    ramp, slope, _ = smooth_ramp(constants.clearance - centre.distance - least, least)
    return least + ramp, slope


_SMALL_ECCENTRICITY = 0.1
"""Relative eccentricity below which the function g is a series, because its closed form cancels."""


def _eccentricity_function(kappa: Array, share: Array) -> Array:
    """Compute g = (artanh κ - κ)/κ³ = Σ κ^(2k)/(2k + 3); `share` is 1 - κ."""
    x = kappa * kappa
    series = 1 / 3 + x * (1 / 5 + x * (1 / 7 + x * (1 / 9 + x * (1 / 11 + x * (1 / 13 + x * (1 / 15 + x / 17))))))
    large = kappa > _SMALL_ECCENTRICITY
    divisor = where(large, kappa, 1.0)
    closed_form = (0.5 * log1p(2.0 * kappa / share) - kappa) / (divisor * divisor * divisor)
    return where(large, closed_form, series)


_RIM_LOSS = 5.6
"""Damping across the eccentricity that a rim at the equator takes from a nearly touching ball, in units of D."""


def _covered_share(
    kappa: Array, one_minus_square: Array, centre: BallCentre, constants: Constants
) -> tuple[Array, Array]:
    """Compute the share of the film inside the rim of a cup, and the damping lost through the rim in units of D.

    The square of the share is exactly the mean of the damping over all directions for a concentric ball. Share and
    loss are fits to solutions of Reynolds' equation with pressure 0 at the rim: `docs/explanation/dynamics.md`.
    """
    rim_cosine, rim_sine = cos(constants.rim), sin(constants.rim)
    dome_cosine = constants.dome_x * centre.x + constants.dome_y * centre.y + constants.dome_z * centre.z
    # κ n·dome with its derivative where the centres coincide
    inverse_distance, c = centre.inverse_distance, constants.clearance
    reach = where(centre.distance > 0.0, kappa * inverse_distance, 1.0 / c) / inverse_distance
    inside = reach * dome_cosine - rim_cosine
    covered = 0.5 + 0.5 * inside / sqrt(inside * inside + one_minus_square * rim_sine * rim_sine)
    square = kappa * kappa
    return covered, _RIM_LOSS * (1.0 + rim_cosine) * 2.0 * square / (1.0 + square)


def squeeze_damping(damping: FilmDamping, speed: Array, constants: Constants) -> tuple[Array, Array]:
    """Compute the squeeze force over the speed along n, and its derivative by the speed, in N s/mm.

    Both are D_n for an approaching ball. For a ball that leaves, the tension of the film is limited::

        f = D_n V_n/[1 + x/(5 h/c) + x²]^½,   x = D_n |V_n|/S κ²/[κ² + 0.05 (1 - κ²)],

    with the largest tensile force S. It is a fit to solutions of Reynolds' equation with a least pressure; the last
    factor makes the force continuous at the centre of the socket, where no direction is that of a leaving ball.
    """
    if constants.film_tension == inf:
        return damping.along, damping.along
    square = (1.0 - damping.share) * (1.0 - damping.share)
    weight = square / (square + 0.05 * (1.0 - square)) / constants.film_tension
    ratio = where(speed < 0.0, -damping.along * speed * weight, 0.0 * speed)
    slope = 0.2 * ratio / damping.share
    divisor = 1.0 + slope + ratio * ratio
    secant = damping.along / sqrt(divisor)
    return secant, secant * (1.0 + 0.5 * slope) / divisor


def film_force_and_moment(
    centre: BallCentre, velocity: Vector, spin: Vector, constants: Constants
) -> tuple[Array, ...]:
    """Compute force (N) and moment (N mm) of the film on the ball about its centre, as six components."""
    damping = film_damping(centre, constants)
    nx, ny, nz, (wx, wy, wz) = centre.x, centre.y, centre.z, spin
    speed, ax, ay, az = mean_velocity(centre, velocity, spin)
    turning = wx * nx + wy * ny + wz * nz
    fx, fy, fz = -damping.across * ax, -damping.across * ay, -damping.across * az
    lever, drill = 0.5 / centre.inverse_distance, damping.drilling - damping.turning
    squeeze = squeeze_damping(damping, speed, constants)[0] * speed
    return (
        fx - squeeze * nx,
        fy - squeeze * ny,
        fz - squeeze * nz,
        -lever * (ny * fz - nz * fy) - damping.turning * wx - drill * turning * nx,
        -lever * (nz * fx - nx * fz) - damping.turning * wy - drill * turning * ny,
        -lever * (nx * fy - ny * fx) - damping.turning * wz - drill * turning * nz,
    )


def mean_velocity(centre: BallCentre, velocity: Vector, spin: Vector) -> tuple[Array, Array, Array, Array]:
    """Compute the velocity V = v - ½ ω x r in mm/s: its component along n, and the vector across n.

    r is n over the inverse distance, which has the right derivative where the centres coincide.
    """
    (vx, vy, vz), (wx, wy, wz), half = velocity, spin, 0.5 / centre.inverse_distance
    nx, ny, nz = centre.x, centre.y, centre.z
    speed = vx * nx + vy * ny + vz * nz
    return (
        speed,
        vx - speed * nx - half * (wy * nz - wz * ny),
        vy - speed * ny - half * (wz * nx - wx * nz),
        vz - speed * nz - half * (wx * ny - wy * nx),
    )


def squeeze_pressure(centre: BallCentre, velocity: Vector, constants: Constants) -> Array:
    """Compute the pressure of the squeezed film in MPa where it is thinnest, above that where its thickness is c.

    p = 3 η R² (ė/e) (1/h² - 1/c²) with h = c - e, negative for a ball that leaves the wall.
    """
    c, (vx, vy, vz) = constants.clearance, velocity
    gap = film_thickness(centre, constants)[0]
    speed = vx * centre.x + vy * centre.y + vz * centre.z
    stiffness = 3.0 * constants.film_damping * c / (pi * constants.ball_radius * constants.socket_radius)
    return stiffness * speed * (c + gap) / safe_divisor(gap * gap)


def film_dissipation(centre: BallCentre, velocity: Vector, spin: Vector, constants: Constants) -> Array:
    """Compute the power in N mm/s that the film dissipates."""
    damping, (wx, wy, wz) = film_damping(centre, constants), spin
    speed, ax, ay, az = mean_velocity(centre, velocity, spin)
    turning = wx * centre.x + wy * centre.y + wz * centre.z
    tx, ty, tz = wx - turning * centre.x, wy - turning * centre.y, wz - turning * centre.z
    along = squeeze_damping(damping, speed, constants)[0]
    pressure_power = along * speed * speed + damping.across * (ax * ax + ay * ay + az * az)
    shear_power = damping.drilling * turning * turning + damping.turning * (tx * tx + ty * ty + tz * tz)
    return pressure_power + shear_power
