"""Lubricated socket: the forces of Reynolds' equation between rigid surfaces, passive and the same in every path."""

from dataclasses import replace
from math import atanh, inf, nan, pi, radians

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.sparse.linalg import splu

import ballsocket as bs
from ballsocket.dynamics import Bristles, ContactState, Damping, Friction, simulate
from ballsocket.lubrication.mesh import polar_mesh
from ballsocket.lubrication.newton_system import balance_cells

from ..extent import either
from ..joints import HIP
from ..lubrication import rigid_fields

C, RADIUS = HIP.clearance, (HIP.ball_radius * HIP.socket_radius) ** 0.5
OIL = bs.Lubricant(viscosity=0.1, ball_roughness=0.0, cup_roughness=5e-4)
ETA = 1e-6 * OIL.viscosity
WET = bs.ForceElement(bs.HessForsbach(), HIP, lubricant=OIL)
DRY = replace(WET, lubricant=None)
LOSSY = {"damping": Damping(hysteresis=0.01, time=1e-4), "friction": Friction(coefficient=0.05, viscous=1e-4)}
CUPS = {"sphere": None, "cup": bs.Cup(inclination=radians(50.0), arc_of_cover=radians(150.0))}
EVERY_TENSION = pytest.mark.parametrize("tension", [inf, 0.1], ids=["linear", "cavitating"])
EVERY_CUP = pytest.mark.parametrize("cup", CUPS.values(), ids=CUPS)


def states(count, seed=3):
    """States from the centre to a deep contact, most of them with a thin film, at speeds of many sizes."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    distance = C * np.concatenate([[0.0], 1.3 * random.uniform(0.0, 1.0, count - 1) ** 0.3])
    size = 10.0 ** random.uniform(-2.0, 2.0, (count, 1))
    return direction * distance[:, None], size * random.normal(size=(count, 3)), random.normal(size=(count, 3)) * 5.0


def quadrature(polar_count=200, azimuth_count=16):
    """Angles θ and φ, outward directions and areas (mm²) of points of the sphere."""
    cosine, weight = np.polynomial.legendre.leggauss(polar_count)
    azimuth = 2 * pi * np.arange(azimuth_count) / azimuth_count
    theta, phi = np.meshgrid(np.arccos(cosine), azimuth, indexing="ij")
    normal = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    return theta, phi, normal, RADIUS**2 * (2 * pi / azimuth_count) * weight[:, None] * np.ones_like(phi)


def squeeze(theta, phi, e, speed, spin):
    """Pressure of a ball that approaches the wall; any constant may be added in a full cavity."""
    motion = {"radius": RADIUS, "clearance": C, "eccentricity": e, "speed": speed, "viscosity": ETA}
    return rigid_fields.squeeze_pressure(theta, rim=pi / 2, **motion) + 0 * phi


def wedge(theta, phi, e, speed, spin):
    """Pressure of a ball that turns about y, across its eccentricity."""
    motion = {"radius": RADIUS, "clearance": C, "eccentricity": e, "spin": spin, "viscosity": ETA}
    return rigid_fields.wedge_pressure(theta, phi, **motion)


def integrated_load(pressure, e, speed, spin):
    """Force and moment on a ball at e along z, which approaches at `speed` and turns about y at `spin`.

    The shear stress on the ball is -h/2 ∇p - η V/h.
    """
    theta, phi, normal, area = quadrature()
    step = 1e-5
    p = pressure(theta, phi, e, speed, spin)
    slope_theta = (pressure(theta + step, phi, e, speed, spin) - pressure(theta - step, phi, e, speed, spin)) / step / 2
    slope_phi = (pressure(theta, phi + step, e, speed, spin) - pressure(theta, phi - step, e, speed, spin)) / step / 2
    along = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)], axis=-1)
    around = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], axis=-1)
    slope = (slope_theta[..., None] * along + (slope_phi / np.sin(theta))[..., None] * around) / RADIUS
    film = (C - e * np.cos(theta))[..., None]
    surface_velocity = RADIUS * np.cross([0.0, spin, 0.0], normal)
    shear = -0.5 * film * slope - ETA * surface_velocity / film
    force = -np.sum((p * area)[..., None] * normal, axis=(0, 1))
    return force, RADIUS * np.sum(area[..., None] * np.cross(normal, shear), axis=(0, 1))


@pytest.mark.parametrize("share", [0.02, 0.099, 0.101, 0.5, 0.9, 0.98])
def test_force_and_moment_are_the_resultants_of_the_exact_pressures_and_of_the_shear(share):
    e = share * C
    force, moment = integrated_load(squeeze, e, 2.0, 0.0)
    load = WET((0.0, 0.0, e), (0.0, 0.0, 2.0))
    np.testing.assert_allclose(load.force, force, rtol=1e-6, atol=1e-9 * abs(force[2]))
    np.testing.assert_allclose(load.moment, moment, atol=1e-9 * abs(force[2]))
    force, moment = integrated_load(wedge, e, 0.0, 3.0)
    load = WET((0.0, 0.0, e), spin=(0.0, 3.0, 0.0))
    np.testing.assert_allclose(load.force, force, rtol=1e-6, atol=1e-9 * abs(force[0]))
    np.testing.assert_allclose(load.moment, moment, rtol=1e-6, atol=1e-9 * abs(moment[1]))


@pytest.mark.parametrize("share", [0.02, 0.5, 0.98])
def test_a_ball_that_turns_about_its_eccentricity_has_the_shear_of_the_film_and_no_force(share):
    theta, _, _, area = quadrature()
    shear = ETA * 3.0 * (RADIUS * np.sin(theta)) ** 2 / (C - share * C * np.cos(theta))
    load = WET((0.0, 0.0, share * C), spin=(0.0, 0.0, 3.0))
    assert load.force == pytest.approx((0.0, 0.0, 0.0), abs=1e-15)
    assert load.moment == pytest.approx((0.0, 0.0, -np.sum(shear * area)), rel=1e-12)


def test_a_concentric_ball_has_stokes_flow_in_a_sphere_and_the_mean_damping_of_reynolds_in_a_cup():
    """Translation: Williams (1915) and Happel & Brenner; rotation: Lamb. Errors are of the order (c/R)²."""
    R1, R2, eta = HIP.ball_radius, HIP.socket_radius, ETA
    x = R1 / R2
    drag = 6 * pi * eta * R1 * (1 - x**5) / (1 - 9 * x / 4 + 5 * x**3 / 2 - 9 * x**5 / 4 + x**6)
    torque = 8 * pi * eta * R1**3 * R2**3 / (R2**3 - R1**3)
    load = WET((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 0.0, 0.0))
    assert load.force[0] == pytest.approx(-drag, rel=2 * (C / R1) ** 2)
    assert load.moment[0] == pytest.approx(-torque, rel=2 * (C / R1) ** 2)
    for arc in (120.0, 180.0, 240.0):
        D = reynolds_damping(0.0, np.array([0.0, 0.0, 1.0]), radians(arc / 2))
        load = replace(WET, cup=bs.Cup(arc_of_cover=radians(arc)))((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
        assert -load.force[1] == pytest.approx(np.trace(D) / 3, rel=2e-3)


def test_a_free_ball_in_a_film_has_no_contact_but_a_load_and_the_squeeze_pressure_of_the_exact_field():
    state = (0.0, 0.0, 0.95 * C), (1.0, 2.0, -3.0)
    tension, load = squeeze(0.0, 0.0, 0.95 * C, -3.0, 0.0), WET(*state)
    assert load.squeeze_pressure == pytest.approx(tension, rel=1e-9)
    assert WET(*map(np.array, state)).squeeze_pressure == pytest.approx(tension, rel=1e-9)
    assert DRY(*state).squeeze_pressure == DRY((0.0, 0.0, C + 0.1), state[1]).squeeze_pressure == 0.0
    assert (load.status, load.energy) == (ContactState.FREE, 0.0)
    assert load.force[2] > 0.0
    assert WET((0.0, 0.0, 0.05), (0.0, 0.0, 10.0)).force[2] < 0.0
    assert np.isnan(WET((0.0, 0.0, 0.05), (0.0, nan, 10.0)).force).any()


def test_a_ball_that_orbits_at_half_its_spin_meets_no_resistance_of_the_pressure():
    """The film moves with the mean of both surfaces: half-speed whirl."""
    position, spin = np.array([0.03, 0.0, 0.06]), np.array([0.0, 8.0, 0.0])
    load, still = WET(position, np.cross(spin / 2, position), spin), WET(position, spin=spin)
    assert np.abs(load.force).max() <= 1e-12 * np.abs(still.force).max()


@EVERY_CUP
@EVERY_TENSION
def test_the_film_takes_energy_in_every_state_and_its_loss_balances_the_power(cup, tension):
    element = replace(WET, cup=cup, film_tension=tension)
    position, velocity, spin = states(either(10**4, 10**5))
    load, elastic = element(position, velocity, spin), replace(DRY, cup=cup)(position).force
    touched = load.status != ContactState.FREE
    assert 0.1 < touched.mean() < 0.9
    power = np.sum((load.force - elastic) * velocity + load.moment * spin, axis=1)
    size = np.sum(np.abs(load.force * velocity) + np.abs(elastic * velocity) + np.abs(load.moment * spin), axis=1)
    assert (load.dissipation >= 0.0).all()
    assert (power <= 1e-12 * size).all()
    assert (np.abs(power + load.dissipation) <= 1e-12 * size).all()


@EVERY_CUP
@pytest.mark.parametrize("losses", [{}, LOSSY, {"film_tension": 0.1}], ids=["film", "lossy", "cavitating"])
def test_the_damping_matrix_is_symmetric_and_positive_semidefinite(cup, losses):
    position, velocity, spin = states(either(500, 2000))
    load = replace(WET, cup=cup, **losses)(position, velocity, spin)
    D = load.damping_matrix
    np.testing.assert_array_equal(D, np.swapaxes(D, -1, -2))
    scale = np.diag([1.0, 1.0, 1.0, 1 / RADIUS, 1 / RADIUS, 1 / RADIUS])  # one unit of forces and moments
    eigenvalues = np.linalg.eigvalsh(scale @ D @ scale)
    assert (eigenvalues[:, 0] >= -1e-13 * eigenvalues[:, -1]).all()
    if not losses:
        rates = np.concatenate([velocity, spin], axis=1)
        force = load.force - replace(DRY, cup=cup)(position).force
        lost = -np.concatenate([force, load.moment], axis=1)
        error = np.abs(np.einsum("nij,nj->ni", D, rates) - lost)
        assert (error <= 1e-12 * np.abs(lost).max(axis=1, keepdims=True) + 1e-12 * np.abs(load.force).max()).all()


@EVERY_CUP
def test_the_load_is_finite_and_continuous_through_the_touch(cup):
    least, direction = WET.constants.least_film, np.array([0.6, 0.0, 0.8])
    distance = C + np.linspace(-3 * least, 3 * least, 601)
    velocity, spin = np.array([10.0, 5.0, 30.0]), np.array([1.0, 2.0, -3.0])
    load = replace(WET, cup=cup)(distance[:, None] * direction, velocity + 0 * distance[:, None], spin)
    assert np.isfinite([load.force, load.moment]).all()
    step = np.abs(np.diff(load.force, axis=0)).max(axis=0)
    assert (step <= 0.02 * np.abs(load.force).max()).all()
    thickness = load.film_thickness
    np.testing.assert_allclose(thickness[distance <= C - 2 * least], (C - distance)[distance <= C - 2 * least])
    np.testing.assert_allclose(thickness[distance >= C], least, rtol=1e-12)


def test_the_film_has_its_least_thickness_in_the_contact_and_adds_to_the_dry_load():
    position, velocity = (0.0, 0.0, C + 0.03), (0.0, 0.0, 4.0)
    kappa = 1 - WET.constants.least_film / C
    g = (atanh(kappa) - kappa) / kappa**3
    squeeze = 12 * pi * ETA * RADIUS**4 / C**3 * (1 / (1 - kappa**2) - g) * 4.0
    assert WET(position, velocity).force[2] == pytest.approx(DRY(position, velocity).force[2] - squeeze, rel=1e-9)


def capped_tension(kappa, largest, tension, cells=400):
    """Tensile force over π R² of a ball that leaves a hemisphere; Reynolds' equation with a least pressure.

    `largest` is the constant s of the uncapped tension s (c²/h² - 1).
    """
    scale = np.sqrt(2 * (1 - kappa)) / 2
    edges = scale * np.sinh(np.linspace(0.0, np.arcsinh(pi / 2 / scale), cells + 1))
    middle = (edges[1:] + edges[:-1]) / 2
    film = 1 - kappa * np.cos(edges)
    flow = np.sin(edges[1:]) * film[1:] ** 3 / np.diff(np.append(middle, pi / 2))
    matrix = np.diag(flow) + np.diag(np.append(0.0, flow[:-1]))
    matrix -= np.diag(flow[:-1], 1) + np.diag(flow[:-1], -1)
    uncapped = largest * ((1 - kappa * np.cos(middle)) ** -2 - 1)
    # the multiplier of the bound and the margin to it are both at least 0
    root = np.linalg.cholesky(matrix)
    solved = tension - nnls(root.T, np.linalg.solve(root, matrix @ (tension - uncapped)))[0]
    return np.sum(solved * np.diff(np.sin(edges) ** 2))


@pytest.mark.parametrize(("share", "speed"), [(0.9, 0.01), (0.9, 0.3), (0.9, 10.0), (0.98, 0.01), (0.98, 1.0)])
def test_the_tension_of_a_ball_that_leaves_is_limited_as_by_cavitation(share, speed):
    element = replace(WET, cup=bs.Cup(), film_tension=0.1)
    load = element((0.0, 0.0, share * C), (0.0, 0.0, -speed))
    largest = 3 * ETA * RADIUS**2 * speed / (share * C) / C**2
    expected = pi * RADIUS**2 * capped_tension(share, largest, 0.1)
    assert -0.2 <= load.force[2] / expected - 1 <= 0.25
    assert load.force[2] <= 1.02 * pi * RADIUS**2 * 0.1
    approach = [wet((0.0, 0.0, share * C), (0.0, 0.0, speed)).force for wet in (element, replace(WET, cup=bs.Cup()))]
    assert approach[0] == approach[1]


def test_the_damping_matrix_of_a_cavitating_film_is_the_derivative_over_the_speeds():
    position, velocity, spin = states(300)
    element = replace(WET, film_tension=0.1)
    D, step = element(position, velocity, spin).damping_matrix, 1e-4 * np.eye(3)
    ends = [[element(position, velocity + sign * change, spin) for sign in (-1, 1)] for change in step]
    loads = np.array([[np.concatenate([end.force, end.moment], axis=1) for end in pair] for pair in ends])
    size = np.abs(D).max(axis=(1, 2), keepdims=True)
    assert (np.abs(D[:, :, :3] - np.moveaxis(loads[:, 0] - loads[:, 1], 0, -1) / 2e-4) <= 1e-3 * size).all()
    assert (np.abs(D[:, 2, 2] - WET(position, velocity, spin).damping_matrix[:, 2, 2]) > 0.1 * size[:, 0, 0]).any()


def reynolds_damping(kappa, direction, rim):
    """Damping tensor (3, 3) in N s/mm of a film on a cap about z with pressure 0 at its rim, by finite volumes."""
    mesh = polar_mesh(RADIUS, np.linspace(0.0, rim, 51), 60)
    film, empty = C * (1 - kappa * mesh.direction @ direction), np.zeros(mesh.cells)
    balance = balance_cells(mesh, np.zeros(3), ETA, film, empty, empty, np.zeros(len(mesh.rim_cell)))
    volume = mesh.area[:, None] * mesh.direction
    return volume.T @ splu(balance.by_pressure.tocsc()).solve(volume)


@pytest.mark.parametrize(("arc", "share", "polar"), [(150, 0.9, 20), (180, 0.9, 0), (180, 0.95, 50), (240, 0.9, 60)])
def test_the_film_of_a_cup_is_near_that_of_reynolds_equation(arc, share, polar):
    """Errors stated for a ball 30° and more inside the rim, at 0.9 of the clearance and more."""
    direction = np.array([np.sin(radians(polar)), 0.0, np.cos(radians(polar))])
    across = np.array([direction[2], 0.0, -direction[0]])
    D = reynolds_damping(share, direction, radians(arc / 2))
    element = replace(WET, cup=bs.Cup(arc_of_cover=radians(arc)))
    for way, low, high in ((direction, -0.09, 0.01), (across, -0.1, 0.15), (np.array([0.0, 1.0, 0.0]), -0.1, 0.15)):
        drag = -way @ np.array(element(tuple(share * C * direction), tuple(way)).force)
        assert low <= drag / (way @ D @ way) - 1 <= high


def test_a_ball_pressed_into_a_wet_socket_settles_in_the_time_of_the_closed_form():
    """From the centre, t = 6 π η R⁴/(F c²) [artanh κ + (artanh κ - κ)/κ²] without inertia."""
    force = 30.0
    motion = simulate(WET, mass=1e-3, position=(0.0, 0.0, 0.0), pull=(0.0, 0.0, -force), duration=0.3, step=5e-4)
    assert not motion.end_reason
    assert np.abs(motion.total_energy).max() <= 1e-8 * motion.work[-1]
    kappa = -motion.position[:, 2] / C
    free = (kappa > 0.05) & (kappa < 0.98)
    assert free.sum() > 20
    T = np.arctanh(kappa[free])
    time = 6 * pi * ETA * RADIUS**4 / (force * C**2) * (T + (T - kappa[free]) / kappa[free] ** 2)
    np.testing.assert_allclose(motion.time[free], time, rtol=0.01)


def test_energy_balances_in_an_impact_through_the_film():
    element = replace(WET, cup=bs.Cup(), lubricant=bs.Lubricant(viscosity=1e-4), film_tension=0.1, **LOSSY)
    throw = {"position": (0.01, 0.02, 0.0), "velocity": (30.0, 10.0, 500.0), "spin": (0.0, 4.0, 0.0)}
    motion = simulate(element, mass=1.0, duration=2e-3, step=2e-5, **throw)
    assert motion.energy.max() > 0.0
    assert not motion.end_reason
    assert motion.drift < 1e-12
    assert (np.diff(motion.dissipated_energy) >= 0.0).all()
    assert motion.angular_drift is None


def test_bristles_act_beside_the_film():
    state = (0.0, 0.01, C + 0.02), (3.0, 2.0, 1.0), (0.5, 1.0, 2.0)
    bristles, bent = Bristles(coefficient=0.1), (1e-3, 0.0, 0.0, 1e-3)
    film = np.array([WET(*state).force, WET(*state).moment]) - [DRY(*state).force, DRY(*state).moment]
    wet, dry = (replace(element, friction=bristles)(*state, bent) for element in (WET, DRY))
    np.testing.assert_allclose([wet.force, wet.moment], np.array([dry.force, dry.moment]) + film, rtol=1e-12)


def test_derivatives_by_jax_are_finite_and_right_at_the_centre():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        element, spin = replace(WET, cup=bs.Cup()), (1.0, 2.0, 3.0)

        def force(position):
            return element(position, jax.numpy.ones(3), jax.numpy.asarray(spin)).force

        slope = np.asarray(jax.jacfwd(force)(jax.numpy.zeros(3)))
        step = 1e-5 * np.eye(3)
        ends = [element(sign * step, np.ones((3, 3)), np.tile(spin, (3, 1))).force for sign in (1, -1)]
        np.testing.assert_allclose(slope, (ends[0] - ends[1]).T / 2e-5, rtol=1e-5)
