"""The compiled path is the same model."""

import numpy as np
import pytest

import ballsocket as bs

from ..extent import some
from ..joints import HIP, random_joint

pytest.importorskip("numba")
from ballsocket.compiled import Compiled
from ballsocket.compiled.foundation import _angle_polynomial
from ballsocket.models.kinematics import angle_of

KINEMATICS = (bs.linear_kinematics, bs.exact_kinematics, bs.cosine_kinematics)
MODELS = [
    bs.RadialFoundation(modulus=modulus, kinematics=kinematics)
    for modulus in (
        bs.hess_forsbach,
        bs.spherical_vessel,
        bs.bonded_layer,
        bs.polynomial(1.0, 1.2, 0.1),
        bs.constant(250.0),
    )
    for kinematics in KINEMATICS
]
NAMES = ("force", "indentation", "half_angle", "max_pressure", "area", "stiffness", "energy", "status", "valid")


def assert_same(one: bs.Contact, other: bs.Contact) -> None:
    for name in NAMES:
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=2e-14, err_msg=name)


@pytest.mark.parametrize("model", some(MODELS, 5), ids=lambda model: f"{model.modulus.name}-{model.kinematics.name}")
def test_same_answer(model):
    joint = random_joint(2_000, seed=11)
    force = joint.liner.young * joint.ball_radius**2 * 1e-6
    assert_same(Compiled(model=model).press(joint, force=force), model.press(joint, force=force))


def test_shapes_numbers_and_strides():
    fast, model = Compiled(model=bs.HessForsbach()), bs.HessForsbach()
    force = np.linspace(0.0, 4000.0, 24).reshape(4, 6)
    assert_same(fast.press(HIP, force=force), model.press(HIP, force=force))
    assert_same(fast.press(HIP, force=force[::2, ::-1].T), model.press(HIP, force=force[::2, ::-1].T))
    joint = bs.Joint(ball_radius=np.array([[14.0], [16.0]]), clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    row = np.array([500.0, 3000.0])
    assert_same(fast.press(joint, force=row), model.press(joint, force=row))


def test_what_is_not_compiled_is_passed_on():
    fast, model = Compiled(model=bs.Bartel()), bs.Bartel()
    assert fast.press(HIP, force=3000.0).indentation == model.press(HIP, force=3000.0).indentation
    for load in ({"indentation": np.array([0.01, 0.02])}, {"half_angle": np.array([0.3])}):
        assert_same(fast.press(HIP, **load), model.press(HIP, **load))
    single = fast.press(HIP, force=np.array([3000.0], dtype=np.float32))
    assert single.max_pressure.dtype == np.float32


def test_failures_are_the_same_failures():
    fast, model = Compiled(model=bs.Bartel()), bs.Bartel()
    force = np.array([3000.0, 1e13])
    assert_same(fast.press(HIP, force=force), model.press(HIP, force=force))
    poisson = np.array([0.4, 0.5])
    joint = bs.Joint(
        ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.Material(young=1e3, poisson=poisson)
    )
    assert_same(fast.press(joint, force=force[:1]), model.press(joint, force=force[:1]))
    with pytest.raises(ValueError, match="force = -1|force.0. = -1"):
        fast.press(HIP, force=np.array([-1.0]))


def test_angle_polynomial():
    for versine in np.linspace(0.0, 1.0, 4001):
        assert _angle_polynomial(float(versine)) == pytest.approx(angle_of(versine), rel=6e-16, abs=0)
