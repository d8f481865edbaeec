"""Measured validity of the models, on joints that were not used to find the ranges."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.evidence.validity import EXCESS, SHARE, TRUTH, measure, models_with_promise, population

from ..extent import either

PROMISING = {model.name: model for model in models_with_promise()}
SLOW = pytest.param("plane-layer", marks=pytest.mark.long)
SIZES = {"plane-layer": 120, "cosine-limit": either(30_000, 60_000)}


@pytest.mark.parametrize("name", [*sorted(PROMISING.keys() - {"plane-layer"}), SLOW])
def test_valid_results_are_within_the_promise(name):
    measured = measure(PROMISING[name], size=SIZES.get(name, 12_000), seed=7)
    assert 10 < measured.valid <= measured.contacts
    assert measured.kept_share >= SHARE, measured
    assert max(measured.worst.values()) <= EXCESS * measured.promise.within, measured
    assert measured.holds
    assert measured.summary()["kept"] == measured.kept_share


def test_models_without_a_promise_are_known():
    without = {name for name, model in bs.catalogue.items() if model.promise is None}
    assert without >= {"exact", "adhesive", "steuermann", "liu-reconstruction"}
    assert bs.Steuermann(exponent=1).promise == bs.Hertz().promise
    with pytest.raises(ValueError, match="exact has no promise of accuracy"):
        measure(bs.Exact())


def test_a_range_that_is_too_wide_is_detected():
    """Without the measured ranges every tenth result of the paper's model exceeds the promise."""
    wide = replace(bs.hess_forsbach, validity=bs.hess_forsbach.validity[:2])
    measured = measure(bs.RadialFoundation(modulus=wide), size=12_000)
    assert not measured.holds
    assert measured.kept_share < 0.95
    assert max(measured.worst.values()) > 0.5


def test_reference_agrees_with_the_exact_solution():
    joint, angle = population(40, seed=3)
    tabulated = TRUTH.press(joint, half_angle=angle)
    known = np.flatnonzero(np.isfinite(tabulated.force))
    exact = bs.Exact(gap=bs.LinearGap).press(joint, half_angle=angle)
    for name in ("force", *TRUTH.promise.quantities):
        difference = abs(getattr(tabulated, name)[known] / getattr(exact, name)[known] - 1)
        assert difference.max() <= EXCESS * TRUTH.promise.within, name


def test_hip_of_the_paper_is_valid_and_thin_stiff_liners_are_not():
    hip = bs.joints["hess-forsbach"]
    soft = hip.replace(liner=bs.Material(young=1000.0, poisson=0.45))
    assert all(bs.HessForsbach().press(joint, force=3000.0).valid for joint in (hip, soft))
    liner = bs.Material(young=1000.0, poisson=0.487)
    thin = bs.Joint(ball_radius=17.0, clearance=0.036, liner_thickness=3.2, liner=liner)
    contact = bs.HessForsbach().press(thin, force=30_000.0)
    assert not contact.valid
    assert any("nearly incompressible" in note for note in contact.notes)


def test_plane_layer_is_not_valid_for_liners_thicker_than_twice_the_radius():
    liner = bs.Material(young=1e3, poisson=0.0)
    for ratio, valid in ((0.4, False), (0.6, True)):
        joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=14.1 / ratio, liner=liner)
        contact = bs.PlaneLayer().press(joint, half_angle=np.radians(13.0))
        assert contact.valid == valid
        assert any("R2/L" in note for note in contact.notes) == (not valid)


def test_the_population_covers_the_stated_ranges():
    joint, angle = population(4000, seed=5)
    for values, low, high in (
        (joint.ball_radius, 4.0, 30.0),
        (joint.clearance / joint.ball_radius, 5e-4, 2e-2),
        (joint.socket_radius / joint.liner_thickness, 0.2, 20.0),
        (joint.liner.young, 200.0, 3500.0),
    ):
        assert low <= values.min() < 1.02 * low
        assert high / 1.02 < values.max() <= high
        middle = (np.log(low) + np.log(high)) / 2
        assert np.log(values).mean() == pytest.approx(middle, abs=0.03 * np.log(high / low))
    assert 0 <= joint.liner.poisson.min() < 0.001
    assert 0.498 < joint.liner.poisson.max() <= 0.499
    assert np.degrees([angle.min(), angle.max()]) == pytest.approx([1.0, 84.0], abs=0.1)
    assert (joint.ball.young[0], joint.ball.young[1], joint.ball.poisson) == (1e9, 210_000.0, 0.3)
