"""Force laws of all models, compared with presses, and their ends."""

from functools import cache
from math import inf, isnan, nan, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact.law import CurveLaw

from ..joints import HIP
from ..refusals import refused_calls

WIDE = bs.Joint(ball_radius=16.0, clearance=0.5, liner_thickness=3.0, liner=bs.Material(young=700.0, poisson=0.3))
EVERY = pytest.mark.parametrize("model", bs.catalogue.values(), ids=bs.catalogue)
LONG = {("wide", "exact"), ("wide", "plane-layer")}
LAWS = [
    pytest.param(model, joint, id=f"{name}-{key}", marks=[pytest.mark.long] * ((name, key) in LONG))
    for name, joint in {"hip": HIP, "wide": WIDE}.items()
    for key, model in bs.catalogue.items()
]
POINTS = 60


@cache
def law_and_end(model, joint):
    """The law, and the deepest indentation that it speaks of: for formulas without an end the socket's radius."""
    law = model.law(joint)
    return law, law.curve.high if isinstance(law, CurveLaw) else joint.socket_radius


@pytest.mark.parametrize(("model", "joint"), LAWS)
def test_a_law_has_force_and_stiffness_of_a_press_up_to_its_end(model, joint):
    law, deepest = law_and_end(model, joint)
    d = np.append(0.0, np.geomspace(1e-6 * joint.clearance, deepest, POINTS))
    said = np.array([law(float(depth)) for depth in d])
    contact = model.press(joint, indentation=d)
    # the law of the exact solution goes through its interpolated contacts, to a tenth of its tolerance
    tolerance = 1e-7 if isinstance(model, bs.Exact) else 1e-9
    np.testing.assert_allclose(said[:, 0], contact.force, rtol=tolerance)
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


test_joints_and_models_without_a_law_are_refused = refused_calls(
    (lambda: bs.HessForsbach().law(HIP.replace(clearance=np.array([0.1, 0.2]))), "a law needs one joint"),
    (lambda: bs.AdhesiveSocket(work_of_adhesion=np.array([0.0])).law(HIP), "a law needs one joint"),
    (lambda: bs.Refined().law(HIP.replace(clearance=0.0)), "c = 0"),
    (lambda: bs.FiniteElement().law(HIP), "use exact|ask exact"),
    (lambda: bs.Sphere().law(HIP), "use exact|ask exact"),
    error=(TypeError, bs.OutsideDomainError),
)


def test_indentations_that_overflow_are_nan():
    vast = bs.Joint(ball_radius=1e200, clearance=1e190, liner_thickness=1e200, liner=bs.UHMWPE)
    for name in ("vessel", "bartel", "hertz", "adhesive"):
        assert isnan(bs.catalogue[name].press(vast, indentation=0.1).force)
        assert np.isnan(bs.catalogue[name].law(vast)(0.1)).all()


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Refined()], ids=lambda model: model.name)
def test_a_cup_does_not_change_the_law_of_a_model_without_a_rim(model):
    cup = bs.Cup(arc_of_cover=radians(120.0))
    assert model.in_cup(cup).law(HIP)(0.05) == model.law(HIP)(0.05)
