"""What "valid" is worth is measured, and holds for joints that the ranges were not found with."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.evidence.validity import EXCESS, SHARE, TRUTH, measure, population, promising

PROMISING = {model.name: model for model in promising()}
SIZES = {"plane-layer": 120, "cosine-limit": 60_000}


@pytest.mark.parametrize("name", PROMISING)
def test_a_valid_answer_keeps_the_promise(name):
    found = measure(PROMISING[name], size=SIZES.get(name, 12_000), seed=7)
    assert found.valid > 10
    assert found.kept >= SHARE, found
    assert max(found.worst.values()) <= EXCESS * found.promise.within, found
    assert found.holds


def test_every_model_of_the_catalogue_promises_something_or_has_no_truth_to_promise_by():
    silent = {name for name, model in bs.catalogue.items() if model.promise is None}
    assert silent == {"exact", "adhesive", "steuermann", "liu-reconstruction"}
    assert bs.Steuermann(exponent=1).promise == bs.Hertz().promise
    with pytest.raises(ValueError, match="exact promises nothing"):
        measure(bs.Exact())


def test_a_range_that_is_too_wide_is_found_out():
    """The paper's model without the two ranges that were measured: every tenth answer is off by more."""
    wide = replace(bs.hess_forsbach, validity=bs.hess_forsbach.validity[:4])
    found = measure(bs.RadialFoundation(modulus=wide), size=12_000)
    assert not found.holds
    assert found.kept < 0.95
    assert max(found.worst.values()) > 0.5


def test_the_truth_is_the_elastic_answer():
    joint, angle = population(40, seed=3)
    tabulated = TRUTH.press(joint, half_angle=angle)
    known = np.flatnonzero(np.isfinite(tabulated.force))
    exact = bs.Exact().press(joint, half_angle=angle)
    for name in ("force", *TRUTH.promise.quantities):
        apart = abs(getattr(tabulated, name)[known] / getattr(exact, name)[known] - 1)
        assert apart.max() <= EXCESS * TRUTH.promise.within, name


def test_the_paper_s_hip_is_trusted_and_thin_stiff_liners_are_not():
    hip = bs.joints["hess-forsbach"]
    assert bs.HessForsbach().press(hip, force=3000.0).valid
    soft = replace(hip, liner=bs.Material(young=1000.0, poisson=0.45))
    assert bs.HessForsbach().press(soft, force=3000.0).valid
    thin = bs.Joint(
        ball_radius=17.0, clearance=0.036, liner_thickness=3.2, liner=bs.Material(young=1000.0, poisson=0.487)
    )
    contact = bs.HessForsbach().press(thin, force=30_000.0)
    assert not contact.valid
    assert any("nearly incompressible" in note for note in contact.notes)


def test_a_plane_layer_is_not_trusted_for_liners_thicker_than_twice_the_radius():
    thick, thin = (
        bs.Joint(
            ball_radius=14.0, clearance=0.1, liner_thickness=14.1 / ratio, liner=bs.Material(young=1e3, poisson=0.0)
        )
        for ratio in (0.4, 0.6)
    )
    for joint, valid in ((thick, False), (thin, True)):
        contact = bs.PlaneLayer().press(joint, half_angle=np.radians(13.0))
        assert contact.valid == valid
        assert any("R2/L" in note for note in contact.notes) == (not valid)
