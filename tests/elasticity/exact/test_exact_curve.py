"""A joint's curve through a few dozen exact solutions, against the solutions themselves."""

from math import inf

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact import chebyshev_curve, subsurface
from ballsocket.elasticity.exact.chebyshev_curve import ChebyshevState

from ...extent import either
from ...joints import HIP

SHELL = bs.Layer(thickness=3.0, material=bs.TITANIUM)
CEMENT = bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
BONE = bs.Layer(thickness=inf, material=bs.CANCELLOUS_BONE)
SOFT = bs.Material(young=120.0, poisson=0.45)
JOINTS = {
    "shell": HIP.replace(backing=(SHELL,)),
    "shell, cement and bone": HIP.replace(backing=(SHELL, CEMENT, BONE)),
    "cement and bone, full before 85°": HIP.replace(backing=(CEMENT, BONE)),
    "free outside, lifted at the pole": HIP.replace(support=bs.Support.FREE, liner_thickness=1.5),
    "a soft ball in a massive socket": HIP.replace(ball=SOFT, liner_thickness=inf),
    "thin and incompressible": HIP.replace(liner=bs.Material(young=10.0, poisson=0.4999), liner_thickness=1.0),
}
NAMES = (
    *("force", "indentation", "half_angle", "max_pressure", "pole_pressure", "stiffness", "energy"),
    *("pressure_integral", "area", "foundation_modulus"),
)
EVERY_JOINT = pytest.mark.parametrize("joint", JOINTS.values(), ids=JOINTS)


@EVERY_JOINT
def test_every_quantity_is_within_its_stated_error(joint):
    angles = np.radians([1e-3, 0.3, 2.0, 11.0, 29.0, 47.0, 63.0, 77.0])
    exact, curve = bs.Exact(tolerance=1e-9).press(joint, half_angle=angles), bs.ExactCurve()
    assert (exact.status == bs.Status.OK).all()
    for kind in ("half_angle", "force", "indentation"):
        found = curve.press(joint, **{kind: getattr(exact, kind)})
        assert (found.status == bs.Status.OK).all()
        for name in NAMES:
            off = abs(getattr(found, name) / getattr(exact, name) - 1)
            assert off.max() < 2e-7, (kind, name)
            assert (off <= found.error.get(name, 1e-6) + 1e-10).all(), (kind, name)


@EVERY_JOINT
def test_every_joint_is_fitted_by_series(joint):
    """A curve that cannot be fitted would be solved contact by contact, with the same results."""
    state = bs.ExactCurve().press(joint, force=10.0).single_state
    assert isinstance(state, ChebyshevState)
    series, knots = state.series, state.series.knots.half_angle
    assert series.is_accurate
    assert (series.truncation_error < 1e-6).all()
    values, slopes = series.evaluate_dimensionless_functions(knots)
    np.testing.assert_allclose(values, chebyshev_curve._dimensionless_quantities(series.knots), rtol=1e-9, atol=1e-9)
    middle, step = knots[8:-4], 1e-5
    above, below = (series.evaluate_dimensionless_functions(middle * np.exp(side * step))[0][:2] for side in (1, -1))
    np.testing.assert_allclose(slopes[:, 8:-4], (above - below) / (2 * step), rtol=1e-4, atol=1e-6)


@EVERY_JOINT
def test_the_pressure_profile_is_within_a_millionth_of_the_peak(joint):
    angles = np.radians([0.3, 11.0, 47.0, 77.0])
    exact, found = (model.press(joint, half_angle=angles) for model in (bs.Exact(tolerance=1e-9), bs.ExactCurve()))
    places = np.linspace(0.0, 1.1, 12)[:, None] * angles
    off = found.pressure(places) - exact.pressure(places)
    assert (abs(off) < 1e-6 * exact.max_pressure).all()
    np.testing.assert_allclose(found.max_pressure_angle, exact.max_pressure_angle, atol=2e-2)


def test_results_do_not_depend_on_the_other_loads():
    joint, forces = JOINTS["shell"], np.geomspace(0.1, 9000.0, 5000)
    company = bs.ExactCurve().press(joint, force=forces)
    for place in (0, 17, 2500, 4999):
        alone = bs.ExactCurve().press(joint, force=float(forces[place]))
        for name in (*NAMES, "status"):
            assert getattr(alone, name) == pytest.approx(getattr(company, name)[place], rel=1e-13), name


def test_statuses_equal_those_of_the_exact_solutions():
    joint, loads = JOINTS["cement and bone, full before 85°"], np.radians([0.0, 30.0, 83.0, 84.5, 86.0])
    exact, found = (model.press(joint, half_angle=loads) for model in (bs.Exact(), bs.ExactCurve()))
    assert found.status.tolist() == exact.status.tolist()
    assert found.force[0] == 0
    assert np.isnan(found.force[3:]).all()
    beyond = bs.ExactCurve().press(joint.replace(backing=(SHELL,)), force=1e9)
    assert beyond.status == bs.Status.NOT_REACHED
    far = bs.ExactCurve(model=bs.Exact(tolerance=1e-10)).press(JOINTS["shell"], force=3000.0)
    assert max(far.error.values()) <= 1e-10 or far.status == bs.Status.NOT_CONVERGED


def test_stresses_equal_those_of_the_exact_solution():
    exact, found = (model.press(JOINTS["shell"], force=3000.0) for model in (bs.Exact(), bs.ExactCurve()))
    assert found.peak_stress.von_mises == pytest.approx(exact.peak_stress.von_mises, rel=1e-6)
    assert found.von_mises == pytest.approx(exact.von_mises, rel=2e-3)
    assert found.stress(0.2, 1.0).hoop == pytest.approx(exact.stress(0.2, 1.0).hoop, rel=1e-6)


def test_validity_of_many_loads_needs_few_stress_solutions(monkeypatch):
    """Yield is checked at each load; the largest stress is located for a few contacts only."""
    looks, forces = [], np.geomspace(1.0, 40_000.0, either(quick=1_000, long=5_000))
    peak = subsurface.largest_von_mises
    monkeypatch.setattr(subsurface, "largest_von_mises", lambda *all: looks.append(1) or peak(*all))
    found = bs.ExactCurve().press(JOINTS["shell"].replace(clearance=0.11), force=forces)
    first = int(np.argmin(found.valid))
    assert (found.valid == (np.arange(len(forces)) < first)).all()
    assert found.utilisation[first] == pytest.approx(1.38, rel=2e-3)
    assert len(looks) <= 41


def test_circular_gaps_and_other_models_are_refused():
    with pytest.raises(ValueError, match="circular"):
        bs.ExactCurve(model=bs.Exact(gap=bs.CircularGap))
    with pytest.raises(TypeError, match="Exact"):
        bs.ExactCurve(model=bs.Hertz())
