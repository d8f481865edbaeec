"""Preloaded joints: equilibrium without a load, separation, wear and stiffness; friction and pull-out forces."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs

from ...extent import some
from .shapes import TIGHT, WRAPPED

SPRINGS = replace(WRAPPED, surface=bs.Springs())


def held(arc, **options):
    return replace(WRAPPED, cup=bs.Cup(arc_of_cover=radians(arc)), **options)


def test_preloaded_joint_is_in_equilibrium_without_a_load():
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    assert fitted.equilibrium.max_pressure > 50
    assert fitted.equilibrium.force == pytest.approx(0, abs=1.0)
    assert fitted.equilibrium.displacement[2] < 0  # the opening pushes less
    closed = replace(WRAPPED, surface=bs.ClosedShell()).press(TIGHT, displacement=(0.0, 0.0, 0.0))
    uniform = closed.pressure_at((0.0, 0.6, 0.8))
    assert closed.pressure_at((0.0, 0.0, 1.0)) == pytest.approx(uniform, rel=0.02)


def test_displacement_and_wear_open_a_preloaded_contact():
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    out, side = fitted.separation_displacement((0.0, 0.0, -1.0)), fitted.separation_displacement((1.0, 0.0, 0.0))
    assert 0 < out < side < 2 * 0.05
    assert fitted.wear_depth_to_loosen() == pytest.approx(0.05, rel=0.05)
    start = fitted.equilibrium.displacement
    inside, beyond = (fitted.displace(start + factor * side * np.array([1.0, 0.0, 0.0])) for factor in (0.99, 1.02))
    assert (inside.pressure_map[2] > 0).all()
    assert not (beyond.pressure_map[2] > 0).all()


@pytest.mark.parametrize("interference", some([0.05, 0.002], 1))
def test_springs_separate_at_the_interference(interference):
    """On springs each cell opens alone: the lateral displacement at which the first one does is the interference."""
    fitted = bs.Preload(model=SPRINGS, joint=TIGHT.replace(interference=interference))
    assert fitted.separation_displacement((0.0, 1.0, 0.0)) == pytest.approx(interference, rel=0.03)
    assert fitted.wear_depth_to_loosen() == pytest.approx(interference, rel=1e-3)
    assert fitted.separation_displacement((0.0, 5.0, 0.0)) == fitted.separation_displacement((0.0, 1.0, 0.0))


@pytest.mark.parametrize("arc", some([200.0, 240.0], 1))
def test_uniform_wear_loosens_a_socket_with_an_open_dome_at_the_interference(arc):
    """Pressures are proportional to the interference that is left, even where the opening pushes the ball outwards."""
    worn = bs.BoreDeviation(of=lambda n: 0.01)
    fitted, looser = (bs.Preload(model=held(arc, worn=depth), joint=TIGHT) for depth in (None, worn))
    assert fitted.equilibrium.pressure_map[2].min() == 0.0
    assert fitted.separation_displacement((1.0, 0.0, 0.0)) == 0.0
    assert fitted.wear_depth_to_loosen() == pytest.approx(0.05, rel=1e-3)
    assert looser.wear_depth_to_loosen() == pytest.approx(0.04, rel=1e-3)
    assert fitted.equilibrium.notes[-1] == "the contact reaches the rim, as is normal in a preloaded joint"


@pytest.mark.parametrize("rings", some([1.5, 2.0, 3.0, 4.0], 2))
def test_the_ball_is_loose_where_it_fits_through_the_worn_bore(rings):
    """A shifted bore holds the ball as a centred one, and an oval bore as long as its narrow diameter is too small."""
    shifted, oval = (lambda n: 0.02 * n[0]), (lambda n: 0.02 * (n[0] ** 2 - n[1] ** 2) / 2)
    for depth, expected in ((None, 0.05), (shifted, 0.05), (oval, 0.06), (lambda n: 0.07, 0.0)):
        worn = None if depth is None else bs.BoreDeviation(of=depth)
        fitted = bs.Preload(model=held(240.0, worn=worn, ring_width=radians(rings)), joint=TIGHT)
        assert fitted.wear_depth_to_loosen() == pytest.approx(expected, rel=2e-3, abs=1e-9)


def test_preloaded_joint_resists_push_and_pull():
    pressed, pulled = (WRAPPED.press(TIGHT, indentation=indentation) for indentation in (0.06, 0.03))
    unloaded = WRAPPED.press(TIGHT, force=0.0)
    assert pulled.indentation < unloaded.indentation < pressed.indentation
    assert pulled.force < 0 < pressed.force
    assert min(contact.stiffness for contact in (pressed, pulled, unloaded)) > 0
    slope = (pressed.force - pulled.force) / 0.03
    assert slope == pytest.approx(pressed.stiffness, rel=1e-3)  # the contact is closed: linear
    assert WRAPPED.press(TIGHT, force=5000.0).indentation > unloaded.indentation


def test_a_half_socket_does_not_hold_a_preloaded_ball():
    assert held(180.0).press(TIGHT, force=0.0).status is bs.Status.DISLOCATED
    contact = held(180.0).press(TIGHT, force=2000.0)
    assert not contact.valid
    assert "a half socket does not hold a preloaded ball: set arc_of_cover above 180 deg" in " ".join(contact.notes)
    assert held(181.0).press(TIGHT, force=2000.0).valid


def test_springs_in_a_closed_preloaded_contact_are_linear():
    """In full contact F = K R2² ∫ n nᵀ dΩ e, without a half angle."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(340.0)), surface=bs.Springs(), ring_width=radians(2.0))
    contact = model.press(TIGHT, displacement=(0.01, 0.0, 0.0))
    reach = radians(170.0)
    integral = pi * (2 / 3 - np.cos(reach) + np.cos(reach) ** 3 / 3)  # ∫ sin²θ cos²φ dΩ
    stiffness = bs.hess_forsbach(TIGHT) * TIGHT.socket_radius**2 * integral
    for value in (contact.force_vector[0] / 0.01, contact.stiffness_matrix[0, 0], contact.stiffness):
        assert value == pytest.approx(stiffness, rel=2e-3)


def spring_force(joint, arc, displacement, friction):
    """Integrate K (penetration of the displaced ball) along the normals of the ball, over the bore."""
    R1, R2, K = joint.ball_radius, joint.socket_radius, bs.hess_forsbach(joint)
    polar = np.linspace(0.0, radians(arc / 2), 4001)
    along = -displacement * np.cos(polar)
    overlap = along + np.sqrt(R1**2 - displacement**2 + along**2) - R2
    outward, across = -R2 * np.cos(polar) - displacement, R2 * np.sin(polar)
    normal = (outward + friction * across) / np.hypot(outward, across)
    return np.trapezoid(K * np.maximum(overlap, 0.0) * normal * 2 * np.pi * R2**2 * np.sin(polar), polar)


@pytest.mark.parametrize(("fit", "friction"), some([({"interference": 0.02}, 0.2), ({"clearance": 0.05}, 0.0)], 1))
def test_the_pull_out_force_on_springs_is_the_largest_integral(fit, friction):
    joint = TIGHT.replace(**fit)
    pulled = bs.pull_out(held(200.0, surface=bs.Springs(), ring_width=radians(1.0)), joint, friction)
    displacements = np.linspace(max(joint.clearance, 0.0), pulled.displacements[-1], 400)
    forces = [spring_force(joint, 200.0, displacement, friction) for displacement in displacements]
    assert pulled.force == pytest.approx(max(forces), rel=0.02)
    assert pulled.displacement == pytest.approx(displacements[np.argmax(forces)], abs=0.1)


@pytest.mark.long
def test_the_pull_out_force_grows_with_cover_and_friction_and_does_not_need_fine_rings():
    narrow, wide = (bs.pull_out(held(arc), TIGHT) for arc in (195.0, 205.0))
    assert 0 < narrow.force < wide.force < bs.pull_out(held(205.0), TIGHT, 0.1).force
    assert narrow.strain < wide.strain < 0.1
    assert wide.force == pytest.approx(bs.pull_out(held(205.0, ring_width=radians(2.0)), TIGHT).force, rel=0.05)
    assert wide.displacements[-1] == pytest.approx(TIGHT.socket_radius * np.sin(radians(12.5)))
    assert wide.forces[-1] < 0  # beyond the widest section the rim expels the ball


def test_a_pull_out_force_beyond_linear_elasticity_is_not_reported():
    pulled, upper = (bs.pull_out(held(arc), TIGHT) for arc in (240.0, 205.0))
    assert np.isnan(pulled.force)
    assert pulled.summary()["force"] is None
    assert pulled.notes[0].startswith("pull-out: not computed, the rim would compress the liner by ")
    assert upper.utilisation > 1.38
    assert upper.notes[0].startswith("pull-out: an upper bound, ")
    assert not any(force.valid for force in (pulled, upper))


def test_friction_of_a_preloaded_ball_is_that_of_its_pressures():
    """A uniform pressure p on a closed bore has the torque μ p R1 R2² π² about every axis: the mean sine is π/4."""
    contact = held(340.0, surface=bs.ClosedShell()).press(TIGHT, displacement=(0.0, 0.0, 0.0))
    uniform = pi**2 * TIGHT.ball_radius * TIGHT.socket_radius**2 * contact.pressure_at((0.0, 0.6, 0.8))
    for axis_angle, lost in ((pi / 2, 1.01), (0.0, 1.0)):  # the opening of 20 degrees takes part of the bore
        assert lost * contact.friction_torque(0.1, axis_angle) == pytest.approx(0.1 * uniform, rel=0.02)
    ring = held(200.0).press(TIGHT, force=0.0)  # pushed out until the rim alone holds the ball
    assert ring.pole_pressure == 0
    assert ring.friction_torque(0.1, 0.0) > ring.friction_torque(0.1) > 1e3
