"""Force laws of all models, compared with presses, and as piecewise polynomials for forces known exactly."""

from functools import cache
from math import e, exp, inf, isnan, nan, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact.law import CurveLaw, fit_curve_law

from ..extent import either
from ..joints import HIP

WIDE = bs.Joint(ball_radius=16.0, clearance=0.5, liner_thickness=3.0, liner=bs.Material(young=700.0, poisson=0.3))
EVERY = pytest.mark.parametrize("model", bs.catalogue.values(), ids=bs.catalogue)
LONG = {("wide", "exact"), ("wide", "plane-layer")}
LAWS = [
    pytest.param(model, joint, id=f"{name}-{key}", marks=[pytest.mark.long] * ((name, key) in LONG))
    for name, joint in {"hip": HIP, "wide": WIDE}.items()
    for key, model in bs.catalogue.items()
]
POINTS = either(quick=60, long=200)


@cache
def law_and_end(model, joint):
    """The law, and the deepest indentation that it speaks of: for formulas without an end the socket's radius."""
    law = model.law(joint)
    return law, min(getattr(law, "deepest", inf), joint.socket_radius)


@pytest.mark.parametrize(("model", "joint"), LAWS)
def test_a_law_has_force_and_stiffness_of_a_press_up_to_its_end(model, joint):
    law, deepest = law_and_end(model, joint)
    d = np.append(0.0, np.geomspace(1e-6 * joint.clearance, deepest, POINTS))
    said = np.array([law(float(depth)) for depth in d])
    contact = model.press(joint, indentation=d)
    np.testing.assert_allclose(said[:, 0], contact.force, rtol=1e-9)
    np.testing.assert_allclose(said[1:, 1], contact.stiffness[1:], rtol=1e-7)
    assert all(type(number) is float for number in law(0.05))


@EVERY
def test_a_law_ends_where_presses_fail(model):
    law, deepest = law_and_end(model, HIP)
    beyond = model.press(HIP, indentation=deepest * (1 + 1e-5))
    if model.press(HIP, indentation=deepest).status.failed or beyond.status.failed:
        assert np.isnan(law(deepest * (1 + 1e-5))).all()
    else:  # a curve goes no further than the socket's radius, formulas say what a press says
        assert deepest == HIP.socket_radius
    for depth in (nan, inf):
        assert np.isnan(law(depth)).all()
    assert law(-1e-3) == law(-inf) == (0.0, 0.0)


@EVERY
def test_tangent_stiffness_is_the_slope_of_the_force(model):
    law, deepest = law_and_end(model, HIP)
    for d in np.geomspace(1e-4 * HIP.clearance, 0.99 * deepest, 25):
        force, tangent = law(d)
        if not isnan(force):
            slope = (law(d * (1 + 1e-5))[0] - law(d * (1 - 1e-5))[0]) / (2e-5 * d)
            assert slope == pytest.approx(tangent, rel=2e-7, abs=1e-6)


@pytest.mark.parametrize("name", ["exact", "tabulated", "refined", "plane-layer"])
def test_a_curve_is_a_power_below_a_millionth_of_the_clearance(name):
    model = bs.catalogue[name]
    (law, _), d = law_and_end(model, HIP), 1e-6 * HIP.clearance
    assert law(d / 10)[0] == pytest.approx(law(d)[0] * 0.1 ** (d * law(d)[1] / law(d)[0]), rel=1e-9)
    assert law(d / 10)[0] == pytest.approx(model.press(HIP, indentation=d / 10).force, rel=5e-3)


def test_a_law_of_arrays_is_rejected():
    joint = bs.Joint(ball_radius=16.0, clearance=np.array([0.1, 0.2]), liner_thickness=6.0, liner=bs.UHMWPE)
    for model, pressed in ((bs.HessForsbach(), joint), (bs.AdhesiveSocket(work_of_adhesion=np.array([0.0])), HIP)):
        with pytest.raises(TypeError, match="a law needs one joint"):
            model.law(pressed)


def test_joints_outside_the_domain_and_noisy_models_have_no_law():
    filled = bs.Joint(ball_radius=16.0, clearance=0.0, liner_thickness=6.0, liner=bs.UHMWPE)
    with pytest.raises(bs.OutsideDomainError, match="c = 0"):
        bs.Refined().law(filled)
    for model in (bs.FiniteElement(), bs.Sphere()):
        with pytest.raises(TypeError, match="use exact|ask exact"):
            model.law(HIP)


def test_indentations_that_overflow_are_nan():
    vast = bs.Joint(ball_radius=1e200, clearance=1e190, liner_thickness=1e200, liner=bs.UHMWPE)
    for name in ("vessel", "bartel", "hertz", "adhesive"):
        assert isnan(bs.catalogue[name].press(vast, indentation=0.1).force)
        assert np.isnan(bs.catalogue[name].law(vast)(0.1)).all()


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Refined()], ids=lambda model: model.name)
def test_a_cup_does_not_change_the_law_of_a_model_without_a_rim(model):
    cup = bs.Cup(arc_of_cover=radians(120.0))
    assert model.in_cup(cup).law(HIP)(0.05) == model.law(HIP)(0.05)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("rate", [0.0, 1.0])
def test_a_power_law_and_a_smooth_law_are_reproduced(n, rate):
    """F = 7 dⁿ exp(rate d): a power of d alone also below the fitted range."""
    law = fit_curve_law(lambda d: 7.0 * d**n * np.exp(rate * d), 1e-6, 2.0)
    assert (law.shallowest, law.deepest) == (1e-6, 2.0)
    for d in [*np.geomspace(1e-6, 2.0, 57).tolist(), *[1e-9] * (rate == 0.0)]:
        force, stiffness = law(d)
        assert force == pytest.approx(7.0 * d**n * exp(rate * d), rel=1e-10)
        assert stiffness == pytest.approx((n / d + rate) * 7.0 * d**n * exp(rate * d), rel=1e-8)


def test_a_law_is_zero_without_contact_and_nan_beyond_its_end():
    law = fit_curve_law(lambda d: np.where(d < 0.5, d, np.nan), 1e-4, 2.0)
    assert law.deepest == pytest.approx(0.5, rel=3e-6)
    assert law.deepest < 0.5 * (1 - 0.9e-6)  # presses so near to the end may fail
    assert law(0.0) == law(-1.0) == (0.0, 0.0)
    assert all(map(isnan, law(0.5)))
    assert all(map(isnan, law(nan)))


def test_a_force_that_is_not_positive_has_no_law():
    with pytest.raises(TypeError, match="no force law: the load at an indentation of 0.001 mm must be above 0 N"):
        fit_curve_law(lambda d: 0.0 * d, 1e-3, 1.0)


def test_pieces_are_polynomials_of_a_coordinate_from_minus_one_to_one():
    """ln F = 2 + x on the first piece and 4 - x² on the second, with ln d from 0 to 2."""
    pieces = np.array([[0, 1, 2], [-1, 0, 4.0]])
    law = CurveLaw(shallowest=1.0, deepest=e**2, first=0.0, density=1.0, pieces=pieces)
    assert law(1.0) == pytest.approx((e, 2 * e))
    force, stiffness = law(exp(1.75))
    assert force == pytest.approx(exp(4 - 0.25))
    assert stiffness == pytest.approx(-2 * 0.5 * 2 * force / exp(1.75))
    force, stiffness = law(0.5)  # a power of d below the first piece
    assert force == pytest.approx(e * 0.5**2)
    assert stiffness == pytest.approx(2 * force / 0.5)
