"""All models: domain, pickling, broadcasting, delegation of a wrapped model, and validity near the rim of a cup."""

import pickle
from dataclasses import dataclass
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact import ModelWrapper

from ..joints import HIP


@pytest.mark.parametrize(
    "model", [*bs.catalogue.values(), bs.RadialFoundation(modulus=bs.polynomial(1, 2, 3))], ids=str
)
def test_models_and_contacts_can_be_pickled(model):
    contact = model.press(HIP, force=3000.0)
    again = pickle.loads(pickle.dumps(contact))
    assert again.model == model
    assert again.max_pressure == contact.max_pressure


def test_parameters_of_models_broadcast():
    sticky = bs.AdhesiveSocket(work_of_adhesion=[0.0, 1e-3])
    contact = sticky.press(HIP, force=np.array([[100.0], [200.0]]))
    assert contact.indentation.shape == (2, 2)
    assert sticky.press(HIP, force=100.0).indentation.shape == (2,)
    own = bs.RadialFoundation(modulus=bs.constant(np.array([200.0, 300.0])))
    np.testing.assert_allclose(own.press(HIP, indentation=0.02).max_pressure, [4.0, 6.0])
    for constants in ((0.0, 0.0, 0.0), (1.0, np.inf, 0.0)):
        with pytest.raises(ValueError, match="Eq. .18."):
            bs.polynomial(*constants)


@dataclass(frozen=True, kw_only=True)
class Renamed(ModelWrapper):
    @property
    def name(self) -> str:
        return "renamed"


def test_a_wrapper_presses_as_the_wrapped_model():
    model, wrapped = bs.HessForsbach(), Renamed(model=bs.HessForsbach())
    for force in (3000.0, 1e-9):
        assert wrapped.press(HIP, force=force).indentation == model.press(HIP, force=force).indentation
    assert wrapped.law(HIP)(0.05) == model.law(HIP)(0.05)
    assert wrapped.press(HIP, force=1.0).model is wrapped


NARROW = bs.Cup(arc_of_cover=radians(60.0))


@pytest.mark.parametrize("model", bs.catalogue.values(), ids=bs.catalogue)
def test_a_model_without_a_rim_is_invalid_where_its_contact_passes_the_rim(model):
    contact = model.in_cup(NARROW).press(HIP, force=3000.0)
    whole = model.press(HIP, force=3000.0)
    assert not contact.valid
    assert any("use fem" in note for note in contact.notes)
    assert contact.max_pressure == pytest.approx(whole.max_pressure, rel=1e-12)  # its answer is the same
    assert contact.model.name == model.name
    assert model.in_cup(bs.Cup()) is model


@pytest.mark.parametrize(("gap", "trusted"), [(0.9, False), (1.1, True)])
def test_validity_ends_a_liner_thickness_before_the_rim(gap, trusted):
    exact = bs.Exact().press(HIP, force=3000.0)
    rim = exact.half_angle + gap * HIP.liner_thickness / HIP.socket_radius
    contact = bs.Exact().in_cup(bs.Cup(arc_of_cover=2 * rim)).press(HIP, force=3000.0)
    assert contact.valid is trusted


def test_finite_elements_agree_at_the_limit_of_validity():
    """At one liner thickness from the rim, ν 0.46: d 2.2 % deeper than in a whole sphere, pmax 0.8 % higher."""
    liner = bs.Material(young=1000.0, poisson=0.46)
    joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=5.0, liner=liner)
    exact = bs.Exact().press(joint, force=3000.0)
    rim = exact.half_angle + joint.liner_thickness / joint.socket_radius
    meshed = bs.FiniteElement(cup=bs.Cup(arc_of_cover=2 * rim), meshes=1).press(joint, force=3000.0)
    assert 0.0 < meshed.indentation / exact.indentation - 1 < 0.025
    assert 0.0 < meshed.max_pressure / exact.max_pressure - 1 < 0.01


def test_tilt_brings_the_rim_closer_to_the_contact():
    for arc, tilt, valid in ((170.0, 0.0, True), (170.0, 45.0, False), (340.0, 95.0, True), (340.0, 140.0, False)):
        model = bs.Exact().in_cup(bs.Cup(arc_of_cover=radians(arc)), tilt=radians(tilt))
        assert model.press(HIP, force=3000.0).valid is valid
        cup = bs.Cup(arc_of_cover=radians(arc), inclination=radians(min(tilt, 90.0)))
        assert tilt > 90.0 or bs.Exact().in_cup(cup).press(HIP, force=3000.0).valid is valid


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
