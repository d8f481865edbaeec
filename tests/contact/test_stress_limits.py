"""Fitted stress ratios, bounds of stresses, and notes about limits of materials."""

from dataclasses import replace
from math import inf, isnan
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact import strength
from ballsocket.contact.verdict import StrengthUse, strength_uses_at

from ..joints import HIP


def joint_of(liner=None, ball=None):
    liner, ball = ({"yield_stress": limit} if limit else {} for limit in (liner, ball))
    return replace(
        HIP,
        liner=bs.Material(young=1000.0, poisson=0.4, **liner),
        ball=bs.Material(young=2e5, poisson=0.3, **ball),
    )


def test_variables_of_the_fit():
    angle, width, poisson = strength.fit_variables(1.0, 0.3, 4.0)
    reach = 4.0 * np.sin(1.0)
    assert (angle, width, poisson) == pytest.approx((np.sin(0.5), reach / (1 + reach), 0.3))
    assert strength.fit_variables(1.6, -0.2, 4.0) == pytest.approx(strength.fit_variables(np.radians(85.0), 0.0, 4.0))
    assert strength.fit_variables(0.0, 0.0, 4.0) == strength.fit_variables(-0.1, -0.5, 4.0) == (0.0, 0.0, 0.0)
    assert strength.fit_variables(1.0, 0.5, 4.0)[2] == 0.5
    assert len(strength.FIT_EXPONENTS) == len(set(strength.FIT_EXPONENTS)) == 20
    assert all(sum(exponents) <= 3 for exponents in strength.FIT_EXPONENTS)


def test_ratio_of_the_ball_is_that_of_hertz():
    """Largest von Mises stress below a Hertz pressure: 0.620 pmax for ν 0.3 (Johnson 1985)."""
    for poisson in (0.1, 0.3, 0.45):
        z = np.linspace(0.0, 2.0, 4001)[1:]
        axial, lateral = 1 / (1 + z**2), (1 + poisson) * (1 - z * np.arctan(1 / z)) - 0.5 / (1 + z**2)
        assert strength.ball_stress_ratio(poisson) == pytest.approx(np.max(abs(axial - lateral)), rel=0.02)
    assert strength.joint_ball_stress_ratio(replace(HIP, ball=None)) == 0.0
    assert strength.joint_ball_stress_ratio(HIP) == strength.ball_stress_ratio(0.3)


def test_utilisation_is_the_larger_of_liner_and_ball():
    ball = strength.ball_stress_ratio(0.3)
    assert strength.utilisation(joint_of(20.0), 5.0, 10.0) == 0.25
    assert strength.utilisation(joint_of(None, 200.0), 5.0, 10.0) == pytest.approx(ball * 10.0 / 200.0)
    assert strength.utilisation(joint_of(20.0, 200.0), 5.0, 10.0) == 0.25
    assert strength.utilisation(joint_of(20.0, 2.0), 5.0, 10.0) == pytest.approx(ball * 10.0 / 2.0)
    assert isnan(strength.utilisation(joint_of(), 5.0, 10.0))


def test_bounds_of_the_stress_contain_the_fit():
    contact = SimpleNamespace(joint=HIP, max_pressure=10.0)
    assert strength.von_mises_bounds(contact, 5.0) == pytest.approx((0.8 * 5.0 - 0.8, 1.2 * 5.0 + 0.8))
    free = SimpleNamespace(joint=replace(HIP, support=bs.Support.FREE), max_pressure=10.0)
    assert strength.von_mises_bounds(free, 5.0) == (0.0, inf)


def test_elastic_limit_solves_for_stresses_only_where_bounds_do_not_decide():
    solved = []

    def utilisation_at(mask):
        solved.append(mask.tolist())
        return np.array([9.0, 1.0, 2.0, 9.0])

    contact = SimpleNamespace(
        utilisation_bounds=(np.array([0.2, 1.0, 1.0, 1.5]), np.array([0.5, 1.5, 2.0, 3.0])),
        utilisation_at=utilisation_at,
    )
    limit = strength.ElasticLimit()
    np.testing.assert_array_equal(limit.holds(contact), [True, True, False, False])
    assert solved == [[False, True, True, False]]
    decided = SimpleNamespace(utilisation_bounds=(np.array([0.2, 1.5]), np.array([0.5, 3.0])))
    np.testing.assert_array_equal(limit.holds(decided), [True, False])
    assert limit.high == 1.38


@pytest.mark.parametrize(
    ("liner", "ball", "reason"),
    [
        ({"yield_stress": 20.0}, None, ""),
        ({}, None, "strength not checked: the liner has no yield stress"),
        ({"fatigue_limit": 20.0}, None, "yield not checked: the liner has no yield stress"),
        (
            {},
            200.0,
            "strength not checked: the liner has no yield stress; the utilisation is that of the ball alone",
        ),
    ],
)
def test_reasons_of_unchecked_strengths(liner, ball, reason):
    joint = replace(joint_of(None, ball), liner=bs.Material(young=1000.0, poisson=0.4, **liner))
    assert strength.unchecked_strength_reason(joint) == reason


@pytest.mark.parametrize(
    ("ratio", "text"),
    [
        (1.004, "1.0 times"),
        (1.36, "1.4 times"),
        (12.3, "12 times"),
        (np.array([0.5, 2.34]), "up to 2.3 times"),
        (np.array([np.nan, 1.5]), "up to 1.5 times"),
    ],
)
def test_ratios_above_one_are_printed_with_two_digits(ratio, text):
    liner = bs.Material(young=1000.0, poisson=0.4, allowable_pressure=10.0)
    pressure = 10.0 * ratio
    contact = SimpleNamespace(
        joint=replace(HIP, liner=liner, ball=None), max_pressure=pressure, von_mises_bounds=(0.0, 0.0), von_mises=0.0
    )
    notes = [note for _, note in strength.strength_remarks(contact)]
    assert notes == [f"pressure {text} the allowable pressure of the liner"]


def test_a_ball_without_a_yield_stress_is_noted_above_a_strain():
    ratio = strength.ball_stress_ratio(0.3)
    limit = 5e-4 * 2e5 / ratio
    contact = SimpleNamespace(joint=joint_of(), max_pressure=np.array([0.99, 1.01]) * limit)
    ((good, note),) = strength.strength_remarks(contact)
    np.testing.assert_array_equal(good, [True, False])
    assert note.startswith("strength of the ball not checked")


def test_uses_of_strengths_are_sorted():
    liner = bs.Material(young=1000.0, poisson=0.4, yield_stress=20.0, allowable_pressure=40.0)
    joint = replace(HIP, liner=liner, ball=bs.COCR)
    contact = bs.HessForsbach().press(joint, force=3000.0)
    pressure = contact.max_pressure
    uses = strength_uses_at(contact, 5.0)
    assert [(use.part, use.strength) for use in uses] == [
        ("liner", "allowable_pressure"),
        ("liner", "yield_stress"),
        ("ball", "yield_stress"),
    ]
    assert uses[0].ratio == pytest.approx(pressure / 40.0)
    assert uses[1].ratio == 0.25
    assert uses[2].stress == pytest.approx(strength.ball_stress_ratio(0.3) * pressure)


def test_uses_are_printed_in_percent_or_as_a_multiple():
    use = StrengthUse(part="ball", strength="yield_stress", stress=25.0, allowed=100.0)
    assert str(use) == "25 % of the yield stress of the ball"
    assert str(replace(use, stress=100.0)) == "100 % of the yield stress of the ball"
    assert str(replace(use, stress=123.456)) == "1.23 times the yield stress of the ball"


def test_utilisation_of_a_contact_is_its_stress_over_yield_stress():
    contact = bs.HessForsbach().press(replace(HIP, ball=None), force=np.array([500.0, 3000.0]))
    np.testing.assert_allclose(contact.utilisation, contact.von_mises / 21.0)
    ratio = strength.von_mises_ratio(contact.half_angle, 0.4, HIP.thickness_ratio)
    np.testing.assert_allclose(contact.von_mises, ratio * contact.max_pressure)
    np.testing.assert_allclose(contact.utilisation_at(np.array([True, False])), contact.utilisation)
    low, high = bs.Exact().press(HIP, force=3000.0).utilisation_bounds
    assert low < bs.Exact().press(HIP, force=3000.0).utilisation < high
