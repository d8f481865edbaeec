"""Preloaded joints: equilibrium without a load, separation, wear and stiffness."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs

from .shapes import RIGID, TIGHT, WRAPPED

SPRINGS = replace(WRAPPED, surface=bs.Springs())


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


@pytest.mark.parametrize("interference", [0.002, 0.05])
def test_springs_separate_at_the_interference(interference):
    """On springs each cell opens alone: the lateral displacement at which the first one does is the interference."""
    joint = TIGHT.replace(interference=interference)
    fitted = bs.Preload(model=SPRINGS, joint=joint)
    assert fitted.separation_displacement((0.0, 1.0, 0.0)) == pytest.approx(interference, rel=0.03)
    assert fitted.wear_depth_to_loosen() == pytest.approx(interference, rel=1e-3)
    assert fitted.separation_displacement((0.0, 5.0, 0.0)) == fitted.separation_displacement((0.0, 1.0, 0.0))


def test_open_contact_separates_at_zero():
    groove = bs.BoreDeviation(of=lambda n: np.where(n[2] > 0.9, 0.2, 0.0))
    fitted = bs.Preload(model=replace(SPRINGS, worn=groove), joint=TIGHT)
    assert fitted.separation_displacement((0.0, 0.0, 1.0)) == 0.0


def test_preloaded_joint_resists_push_and_pull():
    pressed, pulled = (WRAPPED.press(TIGHT, indentation=indentation) for indentation in (0.06, 0.03))
    unloaded = WRAPPED.press(TIGHT, force=0.0)
    assert pulled.indentation < unloaded.indentation < pressed.indentation
    assert pulled.force < 0 < pressed.force
    for contact in (pressed, pulled, unloaded):
        assert contact.stiffness > 0
    slope = (pressed.force - pulled.force) / 0.03
    assert slope == pytest.approx(pressed.stiffness, rel=1e-3)  # the contact is closed: linear
    assert WRAPPED.press(TIGHT, force=5000.0).indentation > unloaded.indentation


def test_hemisphere_does_not_hold_a_larger_ball():
    contact = replace(WRAPPED, cup=bs.Cup()).press(TIGHT, force=0.0)
    assert contact.status is bs.Status.DISLOCATED


def test_springs_in_a_closed_preloaded_contact_are_linear():
    """In full contact F = K R2² ∫ n nᵀ dΩ e, without a half angle."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(340.0)), surface=bs.Springs(), ring_width=radians(2.0))
    contact = model.press(TIGHT, displacement=(0.01, 0.0, 0.0))
    reach = radians(170.0)
    integral = pi * (2 / 3 - np.cos(reach) + np.cos(reach) ** 3 / 3)  # ∫ sin²θ cos²φ dΩ
    expected = bs.hess_forsbach(TIGHT) * TIGHT.socket_radius**2 * integral * 0.01
    assert contact.force_vector[0] == pytest.approx(expected, rel=2e-3)
    stiffness = bs.hess_forsbach(TIGHT) * TIGHT.socket_radius**2 * integral
    assert contact.stiffness_matrix[0, 0] == pytest.approx(stiffness, rel=2e-3)
    assert contact.stiffness == pytest.approx(stiffness, rel=2e-3)


def test_preload_needs_an_interference_and_a_cup_beyond_the_equator():
    for model in (bs.Exact(), bs.HessForsbach(), bs.Tabulated()):
        with pytest.raises(bs.OutsideDomainError, match="sphere"):
            model.press(TIGHT, force=100.0)
    with pytest.raises(ValueError, match="beyond the equator"):
        bs.Preload(model=bs.Sphere(), joint=TIGHT)
    with pytest.raises(ValueError, match="interference"):
        bs.Preload(model=WRAPPED, joint=RIGID)
    with pytest.raises(ValueError, match="one too many"):
        bs.Joint(ball_radius=13.5, interference=0.05, clearance=0.1, liner_thickness=2.5, liner=bs.POM)
    with pytest.raises(ValueError, match="a tenth of the ball"):
        bs.Joint(ball_radius=13.5, interference=5.0, liner_thickness=2.5, liner=bs.POM)
    assert TIGHT.replace(liner_thickness=3.0).interference == pytest.approx(0.05)


def test_methods_of_version_1_0_warn_and_work():
    fitted = bs.Preload(model=SPRINGS, joint=TIGHT)
    with pytest.warns(DeprecationWarning, match="use equilibrium"):
        assert fitted.rest is fitted.equilibrium
    with pytest.warns(DeprecationWarning, match="use separation_displacement"):
        assert fitted.lost_at == fitted.separation_displacement
