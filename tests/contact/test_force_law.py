"""Force laws as piecewise polynomials, for forces that are known exactly."""

import math

import numpy as np
import pytest

from ballsocket.contact.law import CurveLaw, finite_or_nan, fit_curve_law, force_and_tangent


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
def test_a_power_law_is_reproduced(exponent):
    law = fit_curve_law(lambda d: 7.0 * d**exponent, 1e-6, 2.0)
    assert (law.shallowest, law.deepest) == (1e-6, 2.0)
    for d in (1e-9, 1e-6, 3e-4, 0.1, 1.999, 2.0):
        force, stiffness = law(d)
        assert force == pytest.approx(7.0 * d**exponent, rel=1e-10)
        assert stiffness == pytest.approx(exponent * 7.0 * d ** (exponent - 1), rel=1e-8)


def test_a_smooth_law_is_reproduced():
    law = fit_curve_law(lambda d: 3.0 * d * np.exp(d), 1e-5, 1.0)
    for d in np.geomspace(1e-5, 1.0, 57):
        force, stiffness = law(float(d))
        assert force == pytest.approx(3.0 * d * np.exp(d), rel=1e-10)
        assert stiffness == pytest.approx(3.0 * (1 + d) * np.exp(d), rel=1e-8)


def test_a_law_is_zero_without_contact_and_nan_beyond_its_end():
    law = fit_curve_law(lambda d: np.where(d < 0.5, d, np.nan), 1e-4, 2.0)
    assert law.deepest == pytest.approx(0.5, rel=3e-6)
    assert law.deepest < 0.5 * (1 - 0.9e-6)  # presses so near to the end may fail
    assert law(0.0) == law(-1.0) == (0.0, 0.0)
    assert all(map(math.isnan, law(0.5)))
    assert all(map(math.isnan, law(math.nan)))


def test_more_pieces_are_used_for_a_sharper_bend():
    smooth = fit_curve_law(lambda d: d, 1e-3, 1.0)
    sharp = fit_curve_law(lambda d: d * (1 + np.tanh(40 * np.log(d / 0.1))) + d, 1e-3, 1.0)
    assert len(smooth.pieces) == 24
    assert len(sharp.pieces) == 96
    assert smooth.pieces.shape[1] == 10
    assert smooth.density == pytest.approx(24 / np.log(1e3))


def test_a_force_that_is_not_positive_has_no_law():
    with pytest.raises(TypeError, match="no force law: the load at an indentation of 0.001 mm must be above 0 N"):
        fit_curve_law(lambda d: 0.0 * d, 1e-3, 1.0)


def test_pieces_are_polynomials_of_a_coordinate_from_minus_one_to_one():
    """ln F = 2 + x on the first piece and 4 - x² on the second, with ln d from 0 to 2."""
    law = CurveLaw(
        shallowest=1.0, deepest=math.e**2, first=0.0, density=1.0, pieces=np.array([[0, 1, 2], [-1, 0, 4.0]])
    )
    assert law(1.0) == pytest.approx((math.e, 2 * math.e))
    force, stiffness = law(math.exp(1.75))
    assert force == pytest.approx(math.exp(4 - 0.25))
    assert stiffness == pytest.approx(-2 * 0.5 * 2 * force / math.exp(1.75))
    force, stiffness = law(0.5)  # a power of d below the first piece
    assert force == pytest.approx(math.e * 0.5**2)
    assert stiffness == pytest.approx(2 * force / 0.5)
    assert force_and_tangent(1.0, 1.0, 9.0, 0.0, 1.0, [[1.0, 2.0]]) == pytest.approx((math.e, 2 * math.e))


def test_numbers_that_are_not_finite_become_nan_together():
    assert finite_or_nan(1.0, 2.0) == (1.0, 2.0)
    for pair in ((math.inf, 1.0), (1.0, math.nan)):
        assert all(map(math.isnan, finite_or_nan(*pair)))
