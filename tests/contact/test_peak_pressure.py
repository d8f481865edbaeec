"""Largest pressure and its angle, at the pole or on a ring."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

SOFT = bs.Material(young=800.0, poisson=0.4)


def shell(radius, clearance, wall, behind, material=SOFT):
    """A CoCr ball in a CoCr wall on a soft layer."""
    return bs.Joint(
        ball_radius=radius,
        clearance=clearance,
        liner_thickness=wall,
        liner=bs.COCR,
        ball=bs.COCR,
        backing=(bs.Layer(thickness=behind, material=material),),
    )


def highest(contact):
    """The largest of 20 001 pressures of a contact, and its angle."""
    angle = np.linspace(0.0, contact.half_angle, 20_001)
    pressure = contact.pressure(angle)
    return pressure.max(), angle[pressure.argmax()]


@pytest.mark.parametrize(
    ("joint", "pole", "largest", "angle"),
    [
        (shell(25.0, 0.0725, 4.0, 20.0), 19.40, 21.26, 10.3),
        (shell(25.0, 0.0725, 2.0, 20.0), 9.79, 11.39, 21.3),
        (shell(14.0, 0.06, 2.0, 4.0, bs.UHMWPE), 29.62, 34.73, 18.0),
    ],
    ids=["wall 4", "wall 2", "small"],
)
def test_a_stiff_shell_on_a_soft_backing_has_its_largest_pressure_on_a_ring(joint, pole, largest, angle):
    contact = bs.Exact().press(joint, force=3200.0)
    assert contact.pole_pressure == pytest.approx(pole, rel=4e-3)
    assert contact.max_pressure == pytest.approx(largest, rel=4e-3)
    assert np.degrees(contact.max_pressure_angle) == pytest.approx(angle, abs=0.15)
    peak, where = highest(contact)
    assert contact.max_pressure == pytest.approx(peak, rel=1e-7)
    assert contact.max_pressure_angle == pytest.approx(where, abs=1e-3)
    assert contact.foundation_modulus == pytest.approx(contact.pole_pressure / contact.indentation)
    assert contact.error["max_pressure"] == contact.error["pole_pressure"]


@pytest.mark.long
def test_finite_elements_find_the_same_ring():
    pytest.importorskip("skfem")
    joint = shell(25.0, 0.0725, 4.0, 20.0)
    exact = bs.Exact().press(joint, force=3200.0)
    meshed = bs.FiniteElement(cup=bs.Cup(arc_of_cover=np.radians(300.0))).press(joint, force=3200.0)
    assert meshed.max_pressure == pytest.approx(exact.max_pressure, rel=5e-3)
    assert np.degrees(meshed.max_pressure_angle) == pytest.approx(np.degrees(exact.max_pressure_angle), abs=0.5)
    on_plastic = bs.FiniteElement().press(HIP, force=3000.0)
    assert on_plastic.max_pressure_angle == 0.0
    assert on_plastic.max_pressure == on_plastic.pole_pressure


def test_the_ring_of_each_of_many_loads_is_located():
    joint, force = shell(25.0, 0.0725, 4.0, 20.0), np.array([0.0, 10.0, 1000.0, 3200.0])
    together = bs.Exact().press(joint, force=force)
    assert together.max_pressure_angle[0] == together.max_pressure[0] == 0.0
    for place, one in enumerate(force[1:], 1):
        alone = bs.Exact().press(joint, force=one)
        assert together.max_pressure[place] == pytest.approx(alone.max_pressure, rel=1e-9)
        assert together.max_pressure_angle[place] == pytest.approx(alone.max_pressure_angle, abs=1e-6)


@pytest.mark.parametrize(("order", "place", "excess"), [(1, 0.0, 1.0), (2, np.sqrt(0.5), np.sqrt(2.0))])
def test_largest_pressure_of_steuermann_is_that_of_its_polynomial(order, place, excess):
    contact = bs.Steuermann(exponent=order).press(HIP, force=100.0)
    assert contact.max_pressure_angle == pytest.approx(place * contact.half_angle, rel=1e-12)
    assert contact.max_pressure == pytest.approx(excess * contact.pole_pressure, rel=1e-12)


@pytest.mark.parametrize("order", [3, 5])
def test_largest_pressure_of_flatter_gaps_is_that_of_the_profile(order):
    contact = bs.Steuermann(exponent=order).press(HIP, force=100.0)
    peak, where = highest(contact)
    assert contact.max_pressure == pytest.approx(peak, rel=1e-7)
    assert contact.max_pressure_angle == pytest.approx(where, abs=1e-4 * contact.half_angle)


def test_refined_finds_the_largest_pressure_off_the_pole():
    """Far outside its range β exceeds 1/2."""
    joint = replace(HIP, liner_thickness=60.0, liner=bs.Material(young=1000.0, poisson=-0.9))
    angles = np.radians([20.0, 50.0, 80.0, 84.0])
    contact = bs.Refined().press(joint, half_angle=angles)
    for place in range(len(angles)):
        profile = contact.pressure(np.linspace(0.0, angles, 5000))[:, place]
        assert contact.max_pressure[place] == pytest.approx(profile.max(), rel=1e-6)


def test_tabulated_joints_have_their_largest_pressure_at_the_pole():
    rng, size = np.random.default_rng(3), 4000
    ratio = np.exp(rng.uniform(np.log(0.2), np.log(20.0), size))
    joint = bs.Joint(
        ball_radius=17.9,
        clearance=0.1,
        liner_thickness=18.0 / ratio,
        liner=bs.Material(young=1000.0, poisson=rng.uniform(-0.49, 0.4992, size)),
        ball=bs.Material(young=1000.0 / np.exp(rng.uniform(np.log(1e-4), np.log(0.02), size)), poisson=0.3),
    )
    contact = bs.Tabulated().press(joint, half_angle=np.radians(rng.uniform(0.5, 85.0, size)))
    answered = np.isfinite(contact.indentation)
    assert answered.mean() > 0.9
    profile = contact.pressure(np.linspace(0.03, 0.97, 16)[:, None] * contact.half_angle)
    assert np.all(contact.indentation[answered] > 0)
    assert np.all(profile[:, answered] < contact.max_pressure[answered])
