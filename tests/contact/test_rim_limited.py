"""Models in a cup: their validity ends before the rim."""

from math import degrees, pi, radians

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

NARROW = bs.Cup(arc_of_cover=radians(60.0))
KNOWS_NONE = bs.catalogue


@pytest.mark.parametrize("model", KNOWS_NONE.values(), ids=KNOWS_NONE)
def test_a_model_without_a_rim_is_invalid_where_its_contact_passes_the_rim(model):
    contact = model.in_cup(NARROW).press(HIP, force=3000.0)
    whole = model.press(HIP, force=3000.0)
    assert not contact.valid
    assert any("use fem" in note for note in contact.notes)
    assert contact.max_pressure == pytest.approx(whole.max_pressure, rel=1e-12)  # its answer is the same
    assert contact.model.name == model.name
    assert model.in_cup(bs.Cup()) is model


def test_finite_elements_end_the_contact_at_the_rim():
    fem = bs.FiniteElement(meshes=1)
    narrow = fem.in_cup(NARROW).press(HIP, force=3000.0)
    assert degrees(narrow.half_angle) == pytest.approx(30.0, abs=0.01)
    assert narrow.max_pressure > 1.3 * bs.Exact().press(HIP, force=3000.0).max_pressure


@pytest.mark.parametrize(("gap", "trusted"), [(0.9, False), (1.1, True)])
def test_validity_ends_a_liner_thickness_before_the_rim(gap, trusted):
    exact = bs.Exact().press(HIP, force=3000.0)
    rim = exact.half_angle + gap * HIP.liner_thickness / HIP.socket_radius
    contact = bs.Exact().in_cup(bs.Cup(arc_of_cover=2 * rim)).press(HIP, force=3000.0)
    assert contact.valid is trusted


def test_finite_elements_agree_at_the_limit_of_validity():
    """At one liner thickness from the rim, ν 0.46: d 2.2 % deeper than in a whole sphere, pmax 0.8 % higher."""
    joint = bs.Joint(
        ball_radius=14.0, clearance=0.1, liner_thickness=5.0, liner=bs.Material(young=1000.0, poisson=0.46)
    )
    exact = bs.Exact().press(joint, force=3000.0)
    rim = exact.half_angle + joint.liner_thickness / joint.socket_radius
    meshed = bs.FiniteElement(cup=bs.Cup(arc_of_cover=2 * rim), meshes=1).press(joint, force=3000.0)
    assert 0.0 < meshed.indentation / exact.indentation - 1 < 0.025
    assert 0.0 < meshed.max_pressure / exact.max_pressure - 1 < 0.01


def test_tilt_brings_the_rim_closer_to_the_contact():
    upright = bs.Cup(arc_of_cover=radians(170.0))
    tilted = bs.Cup(arc_of_cover=radians(170.0), inclination=radians(45.0))
    assert bs.Exact().in_cup(upright).press(HIP, force=3000.0).valid
    assert not bs.Exact().in_cup(tilted).press(HIP, force=3000.0).valid


def test_a_sliding_liner_is_valid_only_for_finite_elements():
    sliding = bs.Cup(interface=bs.Interface.SLIDING)
    contact = bs.Exact().in_cup(sliding).press(HIP, force=3000.0)
    assert not contact.valid
    assert any("slides on its backing" in note for note in contact.notes)
    assert bs.FiniteElement().in_cup(sliding).cup is sliding


def test_comparisons_and_studies_take_a_cup():
    answers = bs.compare(HIP, force=np.array([300.0, 3000.0]), cup=bs.Cup(arc_of_cover=2 * pi / 3))
    assert answers["exact"].valid.tolist() == [True, False]
    found = bs.study(bs.Exact().in_cup(NARROW), HIP, force=[3000.0])
    assert not found.valid.item()
