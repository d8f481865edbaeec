"""Validity: results that two models mark as valid agree with each other and with the elastic solution."""

import json
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs

from ..joints import CLOSED_FORMS, HIP
from ..places import DATA

CASES = json.loads((DATA / "exact.json").read_text())["cases"]


@pytest.mark.parametrize("model", [model for model in bs.catalogue.values() if model.promise is not None], ids=str)
def test_valid_results_are_close_to_the_elastic_solution(model):
    for case in CASES:
        lengths = {name: case[name] for name in ("ball_radius", "clearance", "liner_thickness")}
        joint = bs.Joint(**lengths, liner=bs.Material(young=case["young"], poisson=case["poisson"]))
        for step in case["steps"]:
            contact = model.press(joint, force=step["force"])
            if contact.valid:
                for name in ("max_pressure", "indentation"):
                    assert getattr(contact, name) == pytest.approx(step[name], rel=1.3 * model.promise.within)


def test_valid_models_agree_on_random_joints_of_the_papers_range():
    rng = np.random.default_rng(5)
    size = 4000
    joint = bs.Joint(
        ball_radius=rng.uniform(5.0, 40.0, size),
        clearance=10 ** rng.uniform(-2.5, -0.3, size),
        liner_thickness=10 ** rng.uniform(-0.5, 2.0, size),
        liner=bs.Material(young=1000.0, poisson=rng.uniform(0.0, 0.499, size)),
        ball=bs.STEEL,
    )
    force = 10 ** rng.uniform(0.0, 4.0, size)
    dry = [model for model in CLOSED_FORMS.values() if model.name != "adhesive"]
    answers = [model.press(joint, force=force) for model in dry]
    compared = 0
    for i, one in enumerate(answers):
        for other in answers[:i]:
            both = one.valid & other.valid
            compared += int(both.sum())
            worst = np.max(np.abs(np.log(one.max_pressure / other.max_pressure))[both], initial=0.0)
            assert worst < 0.3, (one.model.name, other.model.name, worst)
    assert compared > 500


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
