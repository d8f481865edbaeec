"""A press of Python numbers is computed faster, with the same results, statuses and types."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP, random_joint

TOTALS = ("force", "indentation", "half_angle", "area", "stiffness", "energy")
NAMES = (*TOTALS, "max_pressure", "max_pressure_angle", "pole_pressure", "foundation_modulus", "pressure_integral")
QUICK = {name: model for name, model in bs.catalogue.items() if model.accepts_floats}
EACH = pytest.mark.parametrize("model", QUICK.values(), ids=QUICK)
LOADS = (
    *({"force": force} for force in (0.0, 1.0, 3000.0, 1e9, 1e300)),
    *({"indentation": indentation} for indentation in (0.0, 0.06, 1e5, 1e200)),
    *({"half_angle": angle} for angle in (0.0, 0.7, 1.5)),
)


STIFFNESS_ERRORS = {"tabulated": 1e-9}
"""Error of the stiffness in arrays, whose last correction of the contact keeps the slopes of its curves."""


@EACH
@pytest.mark.parametrize("load", LOADS, ids=str)
def test_plain_numbers_and_arrays_of_one_number_have_equal_results(model, load):
    one = model.press(HIP, **load)
    other = model.press(HIP, **{kind: np.array([value]) for kind, value in load.items()})
    assert one.status == bs.Status(int(other.status[0]))
    assert type(one.status) is bs.Status
    assert one.valid is bool(other.valid[0])
    for name in NAMES:
        assert type(getattr(one, name)) is float, name
        rtol = STIFFNESS_ERRORS.get(model.name, 1e-12) if name == "stiffness" else 1e-12
        np.testing.assert_allclose(getattr(one, name), getattr(other, name)[0], rtol=rtol, err_msg=name)
    for angle in (0.0, 0.3, 1.2, 3.0):
        pressure = one.pressure(angle)
        assert type(pressure) is float
        np.testing.assert_allclose(pressure, other.pressure(np.array([angle]))[0], rtol=1e-10)
    assert one.pressure(np.array([0.1, 0.2])).shape == (2,)


@EACH
def test_random_joints_have_equal_results_alone_and_in_an_array(model):
    size = 60
    many = random_joint(size, seed=3)
    force = many.liner.young * many.ball_radius**2 * 10 ** np.random.default_rng(3).uniform(-10, -1, size)
    together = model.press(many, force=force)
    for place in range(size):
        alone = many.with_numbers([float(number[place]) for number in many.numbers()])
        try:
            contact = model.press(alone, force=float(force[place]))
        except ValueError:
            assert together.status[place] == bs.Status.OUTSIDE_DOMAIN
            continue
        assert contact.status == together.status[place]
        for name in ("indentation", "half_angle", "pole_pressure", "stiffness"):
            # near a perfect fit numbers are worth as much less as they grow faster
            np.testing.assert_allclose(getattr(contact, name), getattr(together, name)[place], rtol=1e-9, err_msg=name)


@EACH
def test_integers_and_numpy_scalars_give_the_results_of_floats(model):
    expected = model.press(HIP, force=3000.0).indentation
    integers = replace(HIP, ball_radius=17, clearance=1, liner_thickness=7, liner=bs.Material(young=1000, poisson=0.4))
    assert type(model.press(integers, force=3000).indentation) is float
    for force in (3000, np.float64(3000.0)):
        contact = model.press(HIP, force=force)
        assert (contact.indentation, type(contact.pole_pressure)) == (expected, float)
    assert model.press(HIP, force=[1000, 3000]).max_pressure.dtype == np.float64


def test_overflow_and_division_by_zero_have_the_status_of_arrays():
    huge = bs.Joint(ball_radius=1e200, clearance=1e-3, liner_thickness=1e200, liner=bs.UHMWPE)
    for model in (bs.HessForsbach(), bs.Bartel(), bs.Hertz()):
        one, other = model.press(huge, force=1.0), model.press(huge, force=np.array([1.0]))
        assert one.status == other.status[0]
        np.testing.assert_allclose([one.indentation, one.energy], [other.indentation[0], other.energy[0]])
