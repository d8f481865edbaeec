"""Yield, validity of linear elasticity, and notes about strengths."""

from dataclasses import replace
from itertools import product
from math import inf, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact.strength import MAX_ELASTIC_UTILISATION, von_mises_ratio
from ballsocket.elasticity.exact import subsurface

from ..extent import some

HIP = bs.joints["hip-36"]
WEAK = bs.Material(young=1000.0, poisson=0.4, yield_stress=8.0, fatigue_limit=5.0, allowable_pressure=10.0)
PROMISING = {name: model for name, model in bs.catalogue.items() if model.promise is not None and name != "hertz"}


@pytest.mark.parametrize("model", [*PROMISING.values(), bs.Exact()], ids=lambda model: model.name)
def test_eighty_kilonewtons_in_a_hip_are_valid_for_no_model(model):
    contact = model.press(HIP, force=80e3)
    if not contact.status.failed:
        assert contact.utilisation > 3.0
    assert not contact.valid
    assert contact.status.failed or any("times the yield stress of the liner" in note for note in contact.notes)


def test_yield_is_noted_above_one_and_ends_validity_at_the_stated_factor():
    at = {times: _press_to_utilisation(times) for times in (0.97, 1.1, 1.35, 1.41)}
    assert [contact.valid for contact in at.values()] == [True, True, True, False]
    told = [[note for note in contact.notes if "yield stress" in note] for contact in at.values()]
    assert [len(notes) for notes in told] == [0, 1, 1, 1]
    assert told[1] == [
        "von Mises stress 1.1 times the yield stress of the liner: results are valid up to 1.38 times this stress"
    ]
    assert abs(MAX_ELASTIC_UTILISATION - 1.9**0.5) < 0.002


def _press_to_utilisation(utilisation: float):
    contact = bs.Exact().press(HIP, force=3000.0)
    liner = replace(HIP.liner, yield_stress=contact.peak_stress.von_mises / utilisation)
    return bs.Exact().press(replace(HIP, liner=liner), force=3000.0)


@pytest.mark.long
@pytest.mark.parametrize("model", [bs.Exact(), bs.FiniteElement(meshes=1)], ids=lambda model: model.name)
def test_models_that_solve_for_stresses_report_the_largest(model):
    contact = model.press(HIP, force=20e3)
    assert contact.von_mises == contact.peak_stress.von_mises
    assert contact.utilisation == contact.von_mises / HIP.liner.yield_stress
    both = model.press(HIP, force=np.array([0.0, 20e3, 1e3]))
    assert both.utilisation[0] == 0.0
    assert both.utilisation[1] == pytest.approx(contact.utilisation, rel=1e-6)
    assert both.utilisation[2] == pytest.approx(model.press(HIP, force=1e3).utilisation, rel=1e-6)


@pytest.mark.parametrize(("thickness", "poisson"), some(product([2.0, 6.75, inf], [0.0, 0.3, 0.45, 0.499]), 4))
def test_fitted_stress_ratio_agrees_with_the_exact_solution(poisson, thickness):
    joint = bs.Joint(
        ball_radius=17.9,
        clearance=0.1,
        liner_thickness=thickness,
        liner=bs.Material(young=1000.0, poisson=poisson),
    )
    for angle in (10.0, 32.0, 50.0, 70.0):
        contact = bs.Exact(tolerance=1e-4).press(joint, half_angle=radians(angle))
        known = contact.peak_stress.von_mises / contact.max_pressure
        assert von_mises_ratio(contact.half_angle, poisson, joint.thickness_ratio) == pytest.approx(
            known, rel=0.2, abs=0.08
        )
        least, most = contact.von_mises_bounds
        assert least <= contact.von_mises <= most


def test_stresses_of_a_soft_backed_socket_are_solved_only_near_yield(monkeypatch):
    cement = bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
    soft = HIP.replace(backing=(cement, bs.Layer(thickness=4.0, material=bs.CANCELLOUS_BONE)))
    forces = np.array([300.0, 1000.0, 3000.0, 9000.0, 30000.0])
    known, looks, peak = bs.Exact().press(soft, force=forces), [], subsurface.find_peak_stress
    monkeypatch.setattr(subsurface, "find_peak_stress", lambda *arguments: looks.append(1) or peak(*arguments))
    assert bs.Exact().press(soft, force=forces[:3]).valid.all()
    assert not looks
    least, most = known.von_mises_bounds
    assert ((least <= known.von_mises) & (known.von_mises <= most)).all()
    strong = soft.replace(liner=replace(soft.liner, yield_stress=known.von_mises[3] / (1.01 * MAX_ELASTIC_UTILISATION)))
    looks.clear()
    assert bs.Exact().press(strong, force=forces).valid.tolist() == [True, True, True, False, False]
    assert len(looks) == 1


def test_utilisation_includes_a_weak_ball():
    soft = replace(HIP, ball=replace(bs.COCR, yield_stress=5.0))
    contact = bs.HessForsbach().press(soft, force=3000.0)
    assert contact.utilisation == pytest.approx(0.62 * contact.max_pressure / 5.0, rel=0.01)
    assert any("of the ball" in note for note in contact.notes)


BARE = bs.Material(young=1000.0, poisson=0.4)
NOT_CHECKED = "strength not checked: the liner has no yield stress"


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Exact(), bs.Sphere()], ids=lambda model: model.name)
def test_a_liner_without_a_yield_stress_is_noted_once_for_any_shape(model):
    joint = replace(HIP, liner=BARE, ball=None)
    for force in (3000.0, np.array([2000.0, 3000.0])):
        contact = model.press(joint, force=force)
        assert np.isnan(contact.utilisation).all()
        assert contact.status is bs.Status.OK or not np.any(contact.status)
        assert [note for note in contact.notes if "checked" in note] == [NOT_CHECKED]
        assert contact.summary()["utilisation_note"] == contact.utilisation_note == NOT_CHECKED
    assert "utilisation" not in repr(model.press(joint, force=3000.0))
    assert NOT_CHECKED in repr(model.press(joint, force=3000.0))


def test_a_liner_with_a_yield_stress_has_no_note():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    assert contact.notes == ()
    assert contact.summary()["utilisation_note"] is None


def test_the_reason_depends_on_the_known_strengths():
    pressed = replace(BARE, allowable_pressure=20.0)
    assert "yield not checked: the liner" in _note_on_invalid_points(replace(HIP, liner=pressed, ball=None))
    note = _note_on_invalid_points(replace(HIP, liner=BARE, ball=bs.COCR))
    assert note == f"{NOT_CHECKED}; the utilisation is that of the ball alone"
    failed = bs.Exact().press(replace(HIP, liner=BARE), half_angle=1.55)
    assert failed.status.failed
    assert not any("checked" in note for note in failed.notes)


def _note_on_invalid_points(joint):
    return bs.HessForsbach().press(joint, force=3000.0).notes[0]


def test_a_ball_without_a_yield_stress_is_noted_above_a_strain():
    ball_note = "strength of the ball not checked"
    steel = bs.Exact().press(replace(HIP, ball=bs.STEEL), force=3000.0)
    assert not any(ball_note in note for note in steel.notes)
    soft = bs.Exact().press(replace(HIP, ball=BARE), force=np.array([1.0, 3000.0]))
    assert any(note.startswith(f"1 of 2: {ball_note}") for note in soft.notes)
    rigid = bs.Exact().press(replace(HIP, ball=None), force=3000.0)
    assert not any(ball_note in note for note in rigid.notes)


def test_a_comparison_lists_a_note_once_with_its_models():
    comparison = bs.compare(replace(HIP, liner=BARE, ball=None), force=3000.0)
    told = [note for note in comparison.notes() if NOT_CHECKED in note]
    assert len(told) == 1
    assert told[0].startswith("exact, ") or "exact" in told[0].split(":")[0]
    assert all("utilisation_note" in result for result in comparison.summary()["results"])


@pytest.mark.parametrize("model", [*PROMISING.values(), bs.Exact()], ids=lambda model: model.name)
def test_the_proportional_limit_is_noted_between_itself_and_yield(model):
    force = np.array([1e3, 12e3, 1e5])
    contact = model.press(HIP, force=force)
    expected = contact.von_mises / HIP.liner.proportional_limit
    between = (expected > 1) & (contact.utilisation <= 1)
    told = [note for note in contact.notes if "proportional limit" in note]
    assert len(told) == int(between.any())
    if told:
        assert told[0].startswith(f"{between.sum()} of 3: estimated von Mises stress up to ")
        assert "of the liner: its secant modulus is below E" in told[0]


def test_a_proportional_limit_changes_no_number_and_no_validity():
    without = replace(HIP, liner=replace(HIP.liner, proportional_limit=None))
    for model in (bs.HessForsbach(), bs.Exact()):
        one, other = (model.press(joint, force=6000.0) for joint in (HIP, without))
        assert "estimated von Mises stress 1.3 times the proportional limit of the liner" in one.notes[0]
        assert other.notes == ()
        assert (one.max_pressure, one.utilisation, one.valid) == (other.max_pressure, other.utilisation, True)


def test_proportional_limits_may_be_arrays_of_any_library():
    from array_api_strict import asarray

    for array in (np.array, asarray):
        liner = replace(HIP.liner, proportional_limit=array([1.0, 20.0]))
        contact = bs.HessForsbach().press(replace(HIP, liner=liner), force=3000.0)
        assert contact.force.shape == (2,)
        assert contact.notes[0].startswith("1 of 2: estimated von Mises stress up to")


def test_fatigue_and_allowable_pressure_are_noted_and_do_not_end_validity():
    contact = bs.HessForsbach().press(replace(HIP, liner=WEAK), force=3000.0)
    assert contact.valid
    assert [note.split(" of the liner")[0] for note in contact.notes] == [
        "von Mises stress 1.5 times the fatigue limit",
        "pressure 1.3 times the allowable pressure",
    ]


def test_contacts_broadcast_against_arrays_of_strengths():
    liner = replace(HIP.liner, yield_stress=np.array([4.0, 21.0]))
    for model in (bs.HessForsbach(), bs.Tabulated(), bs.Exact()):
        contact = model.press(replace(HIP, liner=liner), force=3000.0)
        assert contact.force.shape == contact.utilisation.shape == contact.valid.shape == (2,)
        assert contact.valid.tolist() == [False, True]
        assert contact.notes[-1].startswith("1 of 2: von Mises stress up to")


def test_studies_compute_the_utilisation():
    study = bs.study(bs.HessForsbach(), HIP, force=[3000.0, 80e3], quantities=["utilisation"])
    assert study.utilisation.values == pytest.approx(
        bs.HessForsbach().press(HIP, force=np.array([3000.0, 80e3])).utilisation
    )


def test_validity_solves_for_no_stresses_where_bounds_decide(monkeypatch):
    def never(*words):
        raise AssertionError("asked for the inside")

    monkeypatch.setattr("ballsocket.elasticity.exact.contact.largest_von_mises", never)
    contact = bs.Exact().press(HIP, force=np.array([0.0, 3000.0, 80e3]))
    assert contact.valid.tolist() == [True, True, False]
    assert bs.Exact().press(HIP, force=3000.0).notes == ()
    assert len(bs.Exact().press(HIP, force=6000.0).notes) == 1


def test_stresses_of_layered_sockets_are_solved():
    """A liner on bone bends: no share of the pressure tells its stress."""
    bone = bs.Layer(thickness=inf, material=bs.CANCELLOUS_BONE)
    contact = bs.Exact().press(replace(HIP, liner_thickness=2.0, backing=(bone,)), force=3000.0)
    assert contact.utilisation == pytest.approx(contact.peak_stress.von_mises / 21.0)
    flat = von_mises_ratio(contact.half_angle, 0.4, contact.joint.thickness_ratio)
    assert contact.von_mises > 1.3 * flat * contact.max_pressure


def test_strengths_that_are_not_allowed_are_rejected():
    with pytest.raises(ValueError, match="yield_stress = 0 is not allowed: a yield stress \\(MPa\\) is above 0"):
        bs.Material(young=1.0, poisson=0.3, yield_stress=0.0)
    with pytest.raises(TypeError, match="fatigue_limit must be a number"):
        bs.Material(young=1.0, poisson=0.3, fatigue_limit="5 MPa")


def test_presets_with_a_yield_stress_state_its_source():
    for name, material in bs.materials.items():
        assert ("yield: " in material.source) == (material.yield_stress is not None), name
    assert bs.CROSSLINKED_PE.yield_stress is not None


def test_presets_with_a_proportional_limit_state_its_source():
    for name, material in bs.materials.items():
        assert ("proportional limit: " in material.source) == (material.proportional_limit is not None), name
    assert bs.UHMWPE.proportional_limit < bs.UHMWPE.yield_stress


def test_each_material_of_an_axis_has_its_own_strength():
    axis = {"liner": [bs.UHMWPE, bs.POM], "force": 3000.0}
    study = bs.study(bs.HessForsbach(), HIP, bs.studies.grid(**axis), quantities=["utilisation"])
    for material, found in zip(axis["liner"], study.utilisation.values, strict=True):
        alone = bs.HessForsbach().press(replace(HIP, liner=material), force=3000.0).utilisation
        assert found == pytest.approx(alone, rel=1e-12)
    other = bs.studies.grid(liner=[bs.UHMWPE, bs.CORTICAL_BONE], force=3000.0)  # whose yield stress is not known
    assert np.isnan(bs.study(bs.HessForsbach(), HIP, other, quantities=["utilisation"]).utilisation).all()
