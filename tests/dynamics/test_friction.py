"""Friction of a ball in its socket: force and moment of regularised Coulomb friction and of bristles."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.dynamics import Bristles, Damping, Friction, simulate
from ballsocket.dynamics.friction import widening_factor

from ..extent import either
from ..joints import HIP
from .test_element import states

DEEP = (0.0, 0.0, HIP.clearance + 0.04)
SMOOTH = bs.ForceElement(bs.HessForsbach(), HIP, friction=Friction(coefficient=0.1, transition_speed=1e-3))
HELD = replace(SMOOTH, friction=Bristles(coefficient=0.1, stiffness=20.0, damping=1e-3, static_coefficient=0.15))


@pytest.mark.parametrize(("spin", "axis"), [((0, 3.0, 0), np.pi / 2), ((0, 0, 3.0), 0.0)], ids=["turn", "drill"])
def test_friction_moment_equals_the_integral_of_the_contact_pressure(spin, axis):
    for depth in (0.002, 0.04, 0.2):
        contact = bs.HessForsbach().press(HIP, indentation=depth)
        moment = SMOOTH((0.0, 0.0, HIP.clearance + depth), spin=spin).moment
        radius = HIP.socket_radius if axis == 0.0 else HIP.ball_radius
        expected = contact.friction_torque(0.1, axis) * radius / HIP.ball_radius
        assert np.linalg.norm(moment) == pytest.approx(expected, rel=1e-3)
        assert np.dot(moment, spin) < 0
    moment = replace(SMOOTH, model=bs.Exact())(DEEP, spin=(0.0, 3.0, 0.0)).moment
    expected = bs.Exact().press(HIP, indentation=0.04).friction_torque(0.1)
    assert np.linalg.norm(moment) == pytest.approx(expected, rel=0.01)


PLAIN = replace(SMOOTH, friction=None)
RADIUS, SOCKET = HIP.ball_radius, HIP.socket_radius


def integrated(half_angle, velocity, spin, rings=200, meridians=400):
    """Integrate Coulomb stresses of μ = 0.1 over a patch about (0, 0, 1): force, moment and power over N."""
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    phi, weights = half_angle * (nodes + 1) / 2, half_angle / 2 * weights
    theta = 2 * np.pi * (np.arange(meridians) + 0.5) / meridians
    around = np.stack([np.cos(theta), np.sin(theta), 0 * theta], axis=-1)
    normal = np.sin(phi)[:, None, None] * around + np.cos(phi)[:, None, None] * np.array([0.0, 0.0, 1.0])
    load = np.outer((np.cos(phi) - np.cos(half_angle)) * np.sin(phi) * weights, theta**0)
    load /= np.sum(load * normal[..., 2])
    levers = np.array([RADIUS, RADIUS, SOCKET])  # about the load the lever is that of the socket
    slip = velocity + np.cross(spin * levers, normal)
    slip -= np.sum(slip * normal, -1, keepdims=True) * normal
    speed = np.linalg.norm(slip, axis=-1)
    stress = -0.1 * (load / speed)[..., None] * slip
    moment = levers * np.cross(normal, stress).sum((0, 1))
    return stress.sum((0, 1)), moment, 0.1 * np.sum(load * speed)


def friction_loads(half_angle, velocity, spin, element=SMOOTH):
    """Compute force, moment and power of friction of an element, over the normal force."""
    position = (0.0, 0.0, HIP.clearance / np.cos(half_angle))
    plain, load = PLAIN(position).force, element(position, tuple(velocity), tuple(spin))
    return np.subtract(load.force, plain) / -plain[2], np.array(load.moment) / -plain[2], load.dissipation / -plain[2]


@pytest.mark.parametrize("degrees", [17, 36, 55, 69])
def test_rolling_about_a_pole_at_rest_dissipates_the_slip_of_the_patch(degrees):
    """Rolling dissipates 1 to 25 % of the power of sliding at the same surface speed."""
    spin = np.array([0.0, 2.0, 0.0])
    velocity = np.array([-RADIUS * spin[1], 0.0, 0.0])
    power = integrated(np.radians(degrees), velocity, spin)[2]
    computed = friction_loads(np.radians(degrees), velocity, spin)
    assert computed[2] == pytest.approx(power, rel=1e-3)
    slid = friction_loads(np.radians(degrees), velocity, np.zeros(3))[2]
    assert 0.01 < computed[2] / slid < 0.25


def test_random_states_have_the_resultants_of_the_patch():
    random, errors = np.random.default_rng(5), []
    for _ in range(either(20, 400)):
        half_angle = np.radians(random.uniform(5.0, 65.0))
        velocity = np.append(random.normal(size=2) * 10.0 ** random.uniform(0, 2), 0.0)
        spin = random.normal(size=3) * 10.0 ** random.uniform(-1, 1)
        # the tests of rolling cover a pole that hardly slips
        slip, tilt = velocity + RADIUS * np.cross(spin, (0, 0, 1)), velocity - RADIUS * np.cross(spin, (0, 0, 1))
        if np.linalg.norm(slip) < (1 - np.cos(half_angle)) * np.linalg.norm(tilt[:2]):
            continue
        force, moment, power = integrated(half_angle, velocity, spin, 60, 240)
        computed = friction_loads(half_angle, velocity, spin)
        drilling = 8 / 15 * SOCKET * np.sin(half_angle)
        sliding, turning = np.linalg.norm(computed[0] - force), abs(computed[1] - moment)[2] / drilling
        errors.append((sliding / 0.1, turning / 0.1, computed[2] / power - 1))
    assert len(errors) >= either(15, 300)
    assert (np.sqrt(np.mean(np.square(errors), axis=0)) < (0.008, 0.008, 0.002)).all()
    assert (np.max(np.abs(errors), axis=0) < (0.055, 0.045, 0.012)).all()


def test_friction_rotates_with_the_state_and_reverses_with_the_motion():
    position, velocity, spin = states(200)
    element = replace(SMOOTH, friction=Friction(coefficient=0.1, static_coefficient=0.2, viscous=1e-4))
    turn = Rotation.from_rotvec([1.0, -2.0, 0.5]).as_matrix()
    load, turned = element(position, velocity, spin), element(position @ turn.T, velocity @ turn.T, spin @ turn.T)
    back, still = element(position, -velocity, -spin), element(position)
    np.testing.assert_allclose(turned.force, load.force @ turn.T, atol=1e-9 * np.abs(load.force).max())
    np.testing.assert_allclose(turned.moment, load.moment @ turn.T, atol=1e-9 * np.abs(load.moment).max())
    np.testing.assert_allclose(back.force + load.force, 2 * still.force, atol=1e-12 * np.abs(load.force).max())
    np.testing.assert_array_equal(back.moment, -load.moment)


def test_friction_potential_is_convex():
    """The damping matrix has no negative eigenvalue."""
    position, velocity, spin = states(2000, deepest=0.3)
    element = replace(SMOOTH, friction=Friction(coefficient=0.1))
    levers = np.array([1.0, 1.0, 1.0, RADIUS, RADIUS, RADIUS])
    for speeds in (1e-3, 1.0):
        matrix = element(position, speeds * velocity, speeds * spin).damping_matrix / np.outer(levers, levers)
        values = np.linalg.eigvalsh(matrix)
        assert (values[:, 0] >= -1e-9 * values[:, -1]).all()


def test_spin_reduces_the_friction_across_the_load_and_stiction_exceeds_sliding():
    still = SMOOTH(DEEP, velocity=(1.0, 0.0, 0.0)).force[0]
    spinning = SMOOTH(DEEP, velocity=(1.0, 0.0, 0.0), spin=(0.0, 0.0, 10.0)).force[0]
    assert abs(spinning) < 0.1 * abs(still)
    element = replace(SMOOTH, friction=replace(SMOOTH.friction, static_coefficient=0.2))
    slow, fast = (abs(element(DEEP, velocity=(speed, 0.0, 0.0)).force[0]) for speed in (0.1, 100.0))
    assert slow == pytest.approx(2 * fast, rel=1e-3)


def test_bristles_decay_without_contact_and_are_springs_before_they_slide_with_the_limit_of_coulomb():
    away = HELD((0.0, 0.0, 0.0), deflection=(1e-3, 0.0, 0.0, 0.0))
    assert away.deflection_rate[0] == pytest.approx(-1.0)
    assert away.force == (0.0, 0.0, 0.0)
    normal = abs(PLAIN(DEEP).force[2])
    grip = abs(SMOOTH(DEEP, velocity=(1.0, 0.0, 0.0)).force[0]) / (0.1 * normal)
    bend = HELD(DEEP, deflection=(1e-4, 0.0, 0.0, 0.0))
    assert bend.force[0] == pytest.approx(-20.0 * 1e-4 * normal * grip, rel=1e-6)
    assert bend.moment[1] == pytest.approx(HIP.ball_radius * bend.force[0], rel=1e-9)
    fast, slow = (steady_slip(HELD, 1.0, velocity=(speed, 0.0, 0.0)).force[0] for speed in (100.0, 0.1))
    assert fast == pytest.approx(-0.1 * normal * grip, rel=1e-3)
    assert slow == pytest.approx(-0.15 * normal * grip, rel=2e-3)


def steady_slip(element, duration, **state):
    """Load on bristles that have slid for a time in s."""

    def rates(_, z):
        return element(DEEP, **state, deflection=tuple(z.tolist())).deflection_rate

    z = solve_ivp(rates, (0.0, duration), [0.0] * 4, method="LSODA", rtol=1e-9, atol=1e-14).y[:, -1]
    return element(DEEP, **state, deflection=tuple(z.tolist()))


def test_sliding_bristles_have_the_resultants_of_the_patch():
    state = {"velocity": (30.0, 0.0, 0.0), "spin": (0.0, 0.0, 2.0)}
    element = replace(HELD, friction=replace(HELD.friction, static_coefficient=None))
    held, slid = steady_slip(element, 0.1, **state), SMOOTH(DEEP, **state)
    assert held.force[0] == pytest.approx(slid.force[0], rel=0.01)
    assert held.moment[2] == pytest.approx(slid.moment[2], rel=0.07)


def test_bristles_dissipate_and_balance_the_power():
    position, velocity, spin = states(10**4)
    random = np.random.default_rng(1)
    speeds = 10.0 ** random.uniform(-4, 3, (10**4, 1))
    deflection = 0.01 * random.normal(size=(10**4, 4))
    for damping in (0.0, 1e-3, 1.0, 1e3):
        element = replace(HELD, friction=replace(HELD.friction, damping=damping, viscous=1e-5))
        load = element(position, speeds * velocity, spin, deflection)
        assert (load.bristle_dissipation >= -1e-12 * np.abs(load.bristle_dissipation).max()).all()
        # power of friction = dissipation + rate of the energy in the bristles
        plain = replace(element, friction=None)(position, speeds * velocity, spin)
        power = -np.sum((load.force - plain.force) * speeds * velocity + load.moment * spin, axis=1)
        n = position / np.linalg.norm(position, axis=1)[:, None]
        across = deflection[:, :3] - np.sum(deflection[:, :3] * n, axis=1)[:, None] * n
        inner = np.sum(across * load.deflection_rate[:, :3], axis=1) + deflection[:, 3] * load.deflection_rate[:, 3]
        normal = -np.sum(plain.force * n, axis=1)
        depth = np.maximum(np.linalg.norm(position, axis=1) - HIP.clearance, 0.0)
        stored = 20.0 * normal * widening_factor(depth / np.linalg.norm(position, axis=1)) * inner
        np.testing.assert_allclose(power, stored + load.bristle_dissipation, atol=1e-9 * np.abs(power).max())


def test_bristles_hold_a_ball_below_the_limit_of_friction():
    normal, side = 700.0, 30.0
    thrown = {"mass": 1.0, "position": (0.0, 0.0, HIP.clearance + 0.019), "duration": either(0.01, 0.02), "step": 1e-4}
    element = replace(HELD, friction=replace(HELD.friction, viscous=1e-3), damping=Damping(time=2e-4))
    held = simulate(element, pull=(side, 0.0, normal), inertia=1e9, **thrown)  # too slow to roll
    assert held.drift < 1e-7
    assert held.end_reason == ""
    assert held.load.force[-1, 0] == pytest.approx(-side, rel=2e-3)
    slipping = replace(element, friction=Friction(coefficient=0.1))
    creeping = simulate(slipping, pull=(side, 0.0, normal), inertia=1e9, **thrown)
    assert abs(held.velocity[-1, 0]) < 0.01 * creeping.velocity[-1, 0]
