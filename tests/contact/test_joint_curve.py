"""Curves of joints: many loads on one joint, compared with presses of few, and the piecewise polynomials themselves."""

import copy
import pickle
from itertools import product
from math import exp

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact import joint_curve
from ballsocket.contact.octave_curve import derivatives_at, fit_octave_curve

from ..extent import either
from ..joints import HIP

MODELS = [bs.Tabulated(), bs.Refined(), bs.ExactCurve()]
FEW = joint_curve.MANY_LOADS - 1
QUANTITIES = ("force", "indentation", "half_angle", "max_pressure", "stiffness")
EVERY = pytest.mark.parametrize("model", MODELS, ids=["tabulated", "refined", "exact-curve"])


def random_joint(seed):
    """A joint inside the domain of all models, log-uniform in size, modulus, clearance and thickness."""
    rng = np.random.default_rng(seed)
    socket = 10 ** rng.uniform(-1, 3)
    clearance = socket * 10 ** rng.uniform(-5, -1.5)
    ratio = 10 ** rng.uniform(np.log10(0.2), np.log10(20))
    liner = bs.Material(young=10 ** rng.uniform(0, 5), poisson=rng.uniform(0.0, 0.499))
    return bs.Joint(ball_radius=socket - clearance, clearance=clearance, liner_thickness=socket / ratio, liner=liner)


LINERS = product((100.0, 1.0), (bs.Material(young=1000.0, poisson=poisson) for poisson in (0.0, 0.499)))
CORNERS = [bs.Joint(ball_radius=19.9, clearance=0.1, liner_thickness=size, liner=liner) for size, liner in LINERS]
STEEL_BALL = HIP.replace(liner=bs.Material(young=2000.0, poisson=0.4))
JOINTS = [HIP, STEEL_BALL, *CORNERS, *(random_joint(seed) for seed in range(either(quick=12, long=100)))]


def check_against_single_solutions(model, joint, kind):
    curve = joint_curve.joint_curve(model, joint, kind)
    loads = np.geomspace(curve.low, curve.high, FEW) * np.append(np.ones(FEW - 1), 1 - 1e-12)
    direct = model.press(joint, **{kind: loads})
    many = model.press(joint, **{kind: np.append(loads, loads)})
    assert isinstance(many.laws, joint_curve.CurveSolution)
    assert many.laws.interpolation_error <= joint_curve.MAX_ERROR
    for name in QUANTITIES:
        np.testing.assert_allclose(getattr(many, name)[:FEW], getattr(direct, name), rtol=1e-9, err_msg=name)


@EVERY
def test_many_loads_on_one_joint_equal_few_of_them_to_the_stated_error(model):
    for joint in JOINTS[:: 1 if isinstance(model, bs.Tabulated) else 5]:
        for kind in ("force", "indentation"):
            check_against_single_solutions(model, joint, kind)


@EVERY
def test_quantities_that_a_curve_lacks_are_solved(model):
    force = np.linspace(100.0, 3000.0, FEW)
    few, many = (model.press(HIP, force=loads) for loads in (force, np.append(force, force)))
    for name in (*QUANTITIES, "energy", "pressure_integral", "pole_pressure", "max_pressure_angle", "von_mises"):
        np.testing.assert_allclose(getattr(many, name)[:FEW], getattr(few, name), rtol=2e-9, err_msg=name)
    np.testing.assert_allclose(many.pressure(0.1)[:FEW], few.pressure(0.1), rtol=2e-9)
    assert (many.valid[:FEW] == few.valid).all()
    assert few.error.keys() == many.error.keys()
    for name, error in few.error.items():
        np.testing.assert_allclose(many.error[name][:FEW], error, rtol=1e-6, atol=1.1 * joint_curve.MAX_ERROR)


@EVERY
def test_first_touch_and_loads_outside_the_curve_are_those_of_single_presses(model):
    """A load of 0 has no contact; a tiny one, and one that is too large, are solved."""
    deepest = joint_curve.joint_curve(model, HIP, "indentation").high
    for loads in (np.append(0.0, np.linspace(0.01, 0.1, FEW)), np.append(1e-9, np.linspace(0.01, 2 * deepest, FEW))):
        many = model.press(HIP, indentation=loads)
        for index in (0, 1, FEW):
            alone = model.press(HIP, indentation=loads[index : index + 1])
            assert many.status[index] == alone.status[0]
            for name in QUANTITIES:
                np.testing.assert_allclose(getattr(many, name)[index], getattr(alone, name)[0], rtol=1e-9)


def test_contacts_of_a_curve_are_pickled():
    contact = bs.Tabulated().press(HIP, force=np.linspace(100.0, 3000.0, FEW + 1))
    for same in (pickle.loads(pickle.dumps(contact)), copy.deepcopy(contact)):
        np.testing.assert_array_equal(same.half_angle, contact.half_angle)
        np.testing.assert_array_equal(same.energy, contact.energy)


@pytest.mark.parametrize("name", ["cosine-limit", "bonded-layer"])
def test_a_curve_of_a_joint_without_clearance_equals_its_formula(name):
    model, joint = bs.catalogue[name], HIP.replace(clearance=0.0, ball_radius=18.0).with_floats()
    curve, law = model.curve(joint), model.law(joint)
    for depth in np.geomspace(1e-5, 0.5, 20).tolist():
        assert curve(depth) == pytest.approx(law(depth), rel=1e-7)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0])
@pytest.mark.parametrize("rate", [0.0, 1.0])
def test_a_power_law_and_a_smooth_law_are_reproduced(n, rate):
    """F = 7 dⁿ exp(rate d) with its slope and curvature: a power of d alone also below the fitted range."""
    curve = fit_octave_curve(lambda d: 7.0 * d[None] ** n * np.exp(rate * d), 1e-6, 2.0)
    assert 0.75e-6 < curve.low <= 1e-6
    assert curve.error[0] < 1e-9
    for d in [*np.geomspace(1e-6, 2.0, 57).tolist(), *[1e-9] * (rate == 0.0)]:
        force, power = 7.0 * d**n * exp(rate * d), n / d + rate
        expected = force, power * force, (power**2 - n / d**2) * force
        found = derivatives_at(d, *curve.plain_numbers)
        assert found[0] == pytest.approx(expected[0], rel=1e-9)
        assert found[1] == pytest.approx(expected[1], rel=1e-7)
        assert found[2] == pytest.approx(expected[2], rel=1e-5, abs=1e-5 * force / d**2)
