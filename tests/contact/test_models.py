"""Contract of all models: domain, pickling, broadcasting and zero load."""

import pickle

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP

GOOD = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, "liner": bs.UHMWPE}


def test_a_modulus_outside_its_domain_states_the_reason():
    joint = bs.Joint(**(GOOD | {"liner": bs.Material(young=1000.0, poisson=0.5)}))
    with pytest.raises(ValueError, match=r"spherical-vessel has no answer for ν = 0\.5: the modulus is unbounded"):
        bs.spherical_vessel(joint)


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


@pytest.mark.parametrize("model", bs.catalogue.values(), ids=bs.catalogue)
def test_a_contact_without_load_is_zero(model):
    contact = model.press(HIP, force=[])
    assert contact.indentation.shape == (0,)
    assert contact.max_pressure.shape == (0,)
    assert contact.valid.shape == (0,)
    assert "no answer" in repr(contact)
