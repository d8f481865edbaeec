"""Adhesive ball: attachment, separation, pull-off force, and dissipation of a cycle."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.dynamics import ContactState, Damping, simulate

from ..joints import HIP
from .test_element import states

STICKY = bs.AdhesiveSocket(work_of_adhesion=2e-3)
ELEMENT = bs.ForceElement(STICKY, HIP)
C, STRETCH = HIP.clearance, ELEMENT.stretch


def at(depth, attached):
    depth = np.asarray(depth)
    zero = np.zeros_like(depth)
    return ELEMENT(np.stack([zero, zero, C + depth], axis=-1), attached=attached)


def test_ball_attaches_at_first_touch_above_the_wall_and_separates_at_the_critical_stretch():
    assert pytest.approx(STICKY.critical_stretch(HIP)) == STRETCH
    approaching, leaving = (at(np.array([-0.5 * STRETCH, -1e-9, 0.0, 0.01]), attached) for attached in (False, True))
    assert (approaching.force[:2] == 0).all()
    pull = -STICKY.force(HIP, 0.0)
    assert approaching.force[2, 2] == pytest.approx(pull)  # towards the wall
    assert pull > 0
    np.testing.assert_array_equal(leaving.force[2:], approaching.force[2:])
    assert leaving.force[0, 2] > 0
    assert leaving.attached.all()
    assert approaching.attached.tolist() == [False, False, True, True]
    edge = at(np.array([-1.001, -0.99999]) * STRETCH, True)
    assert edge.force[0, 2] == 0
    assert edge.status[0] == ContactState.FREE
    assert abs(edge.force[1, 2]) < 1e-3 * pull
    assert pytest.approx(HIP.liner_thickness, rel=1e-12) == ELEMENT.wall
    status = at(np.array([0.999, 1.001]) * HIP.liner_thickness, True).status
    assert status.tolist() == [ContactState.CONTACT, ContactState.THROUGH_WALL]


def test_dissipation_of_a_cycle_equals_the_energy_jump_at_attachment():
    depth = np.linspace(-1.5 * STRETCH, 0.02, 100_001)
    approaching, leaving = at(depth, False), at(depth, True)
    assert leaving.force[:, 2].max() == pytest.approx(STICKY.pull_off(HIP), rel=1e-8)
    dissipated = np.trapezoid(leaving.force[:, 2] - approaching.force[:, 2], depth)
    jump = at(np.array([-1e-12]), False).energy - at(np.array([1e-12]), False).energy
    assert dissipated == pytest.approx(float(jump[0]), rel=1e-3)
    energy = STICKY.energy(HIP, np.array([0.0, -STRETCH]))
    assert float(jump[0]) == pytest.approx(energy[1] - energy[0], rel=1e-6)


def test_force_of_an_attached_ball_is_the_derivative_of_the_energy():
    depth, step = np.linspace(-0.95 * STRETCH, 0.05, 60), 1e-6
    slope = (at(depth + step, True).energy - at(depth - step, True).energy) / (2 * step)
    force = at(depth, True).force[:, 2]
    np.testing.assert_allclose(-slope, force, atol=1e-6 * np.abs(force).max())
    single = ELEMENT((0.0, 0.0, C - 0.5 * STRETCH), attached=True)
    assert single.force[2] == pytest.approx(float(at(-0.5 * STRETCH, True).force[2]), rel=1e-12)
    assert single.indentation == pytest.approx(-0.5 * STRETCH)
    energy = at(np.array([-STRETCH * (1 - 1e-9), 0.0, 0.05]), True).energy
    assert energy[0] == pytest.approx(0.0, abs=1e-9 * energy[2])
    assert energy[1] < 0 < energy[2]


def test_damping_does_not_generate_energy_in_tension():
    element = bs.ForceElement(STICKY, HIP, damping=Damping(hysteresis=0.05, time=1e-3))
    position, velocity, _ = states(5000, deepest=STRETCH / 0.3)  # from -STRETCH
    assert (element(position, velocity, attached=True).dissipation >= 0).all()


def test_bouncing_ball_loses_the_energy_jump_until_it_stays_attached():
    energy_jump = float((at(np.array([-1e-12]), False).energy - at(np.array([1e-12]), False).energy)[0])
    thrown = {"mass": 2.0, "position": (0.0, 0.0, 0.0), "velocity": (0.0, 0.0, 20.0)}
    fast = simulate(ELEMENT, duration=0.09, step=1e-4, **thrown)
    assert fast.drift < 1e-6
    assert fast.bounces == 400.0e-3 // energy_jump  # kinetic energy in N mm over the loss of a bounce
    assert fast.dissipated_energy[-1] == pytest.approx((fast.bounces + 1) * energy_jump, rel=1e-5)
    assert fast.attached[-1]
    assert fast.indentation[-1] > -STRETCH
