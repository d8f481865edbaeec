"""Validity: results that two models mark as valid agree with each other and with the elastic solution."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Vessel(), bs.BondedLayerExact(), bs.PlaneLayer()], ids=str)
def test_models_of_a_rigid_backing_are_invalid_on_a_soft_one(model):
    told = "outside E/E_backing ≤ 0.01: the model takes the liner's backing as rigid"

    def notes(**changes) -> str:
        return " ".join(model.press(replace(HIP, **changes), force=3000.0).notes)

    shell, cement = (bs.Layer(thickness=3.0, material=material) for material in (bs.TITANIUM, bs.BONE_CEMENT))
    assert told not in notes()
    assert told not in notes(backing=(shell,))
    for changes in ({"backing": (shell, cement)}, {"support": bs.Support.FREE}):
        assert told in notes(**changes)
        assert not model.press(replace(HIP, **changes), force=3000.0).valid


def test_a_reconstruction_is_never_valid_and_spring_models_are_not_at_first_touch():
    contact = bs.LiuReconstruction().press(HIP, force=np.array([1.0, 3000.0]))
    assert not np.any(contact.valid)
    assert contact.notes[0].startswith("2 of 2: never valid: unvalidated reconstruction")
    for model in (bs.HessForsbach(), bs.Vessel(), bs.Bartel(), bs.BondedLayer()):
        assert not model.press(HIP, force=1.0).valid
