"""Validity, utilisation and notes of the contact model in a run: equal to those of a press of the same joint."""

from dataclasses import replace
from math import inf, radians

import pytest

import ballsocket as bs
from ballsocket.contact.verdict import Verdict, error_bar
from ballsocket.hip import Activity, Archard, HipSimulation, Mix, PatientVariability, in_vivo, population
from ballsocket.hip.simulator_cycles import constant_load, iso_14242_1
from ballsocket.reports.hip_report import hip_report
from ballsocket.studies import LogNormal

UPRIGHT = bs.Cup(inclination=0.0)
QUICK = {"ring_width": radians(5.0), "wear": Archard(coefficient=1e-6), "cup": UPRIGHT}
HIP = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
STIFF = bs.Material(young=800.0, poisson=0.49, yield_stress=21.0)
WIDE = bs.Joint(ball_radius=18.0, clearance=0.1, liner_thickness=2.0, liner=STIFF)


def use_of(joint, cycle, **words):
    return HipSimulation(joint=joint, cycle=cycle, **QUICK | words)


def test_a_liner_that_yields_is_not_valid_and_one_without_a_yield_stress_has_no_utilisation():
    """80 kN on a liner that yields at 21 MPa: 204 MPa."""
    use = use_of(HIP, constant_load(12, force=80e3))
    history, press = use.after(1e4), bs.HessForsbach().press(HIP, force=80e3)
    (check,) = use.unworn_checks
    assert (press.valid, history.valid, history.converged) == (False, False, True)
    assert check.max_pressure == pytest.approx(204.0, rel=1e-2)
    assert check.utilisation == history.utilisation == pytest.approx(press.utilisation, rel=1e-2)
    summary = history.summary()
    assert summary["contact"]["valid"] is summary["history"][0]["valid"] is False
    assert summary["contact"]["model"] == "hess-forsbach"
    assert summary["contact"]["unworn"][0]["utilisation"] == summary["contact"]["utilisation"] > 4
    assert summary["history"][0]["contact"][0]["notes"]
    assert any("times the yield stress of the liner" in note and "in the first cycle" in note for note in history.notes)
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=0.4))
    history = use_of(joint, iso_14242_1(12)).after(1e4)
    assert history.utilisation is history.summary()["contact"]["utilisation"] is None
    assert "strength not checked: the liner has no yield stress, give yield_stress in its table" in history.notes


def test_every_activity_is_checked():
    parts = [Activity(cycle=in_vivo(name, 880.0, 24), per_year=1e4) for name in ("walking", "stumbling")]
    use = use_of(HIP, Mix(activities=tuple(parts)), cup=bs.Cup(inclination=radians(20.0)))
    walking, stumbling = use.unworn_checks
    assert walking.utilisation < 0.5
    assert stumbling.utilisation == pytest.approx(1.03, abs=0.03)
    assert not any("yield" in note for note in walking.notes)
    assert stumbling.valid
    history = use.after(1e4)
    assert any("1.0 times the yield" in note and "of stumbling" in note for note in history.notes)
    for checks in (use.unworn_checks, history.contact_checks[0]):
        assert [check.activity for check in checks] == ["walking", "stumbling"]


STEEL = replace(HIP, ball=bs.STEEL, clearance=0.05)


@pytest.mark.parametrize("joint", [HIP, WIDE, STEEL], ids=["hip", "wide", "steel"])
@pytest.mark.parametrize("force", [300.0, 3e3, 3e4])
def test_an_unworn_run_has_the_notes_of_a_press(joint, force):
    use = use_of(joint, constant_load(8, force=force), ring_width=radians(3.0))
    press, (check,) = bs.HessForsbach().press(joint, force=force), use.unworn_checks
    assert check.valid == press.valid
    notes, expected = (
        [note.removeprefix("estimated ").split(" times")[0][:-3] for note in one.notes] for one in (check, press)
    )
    assert notes == expected
    assert check.half_angle == pytest.approx(press.half_angle, abs=radians(0.2))
    assert check.utilisation == pytest.approx(press.utilisation, rel=2e-2)


def test_a_worn_bore_has_its_own_validity():
    """A narrow contact on a nearly incompressible liner is valid; worn in it is wide, and its springs are not."""
    joint = replace(HIP, liner=bs.Material(young=1000.0, poisson=0.46, yield_stress=21.0))
    use = use_of(joint, iso_14242_1(24).scaled(0.25))
    history, unworn = use.after(1e7, [1e5]), use.unworn_checks[0]
    worn = history.contact_checks[-1][0]
    assert (unworn.valid, worn.valid, history.valid) == (True, False, False)
    assert worn.half_angle > unworn.half_angle


@pytest.mark.parametrize("surface", [bs.ClosedShell(), pytest.param(bs.RealCup(), marks=pytest.mark.long)])
def test_an_elastic_run_has_the_validity_of_the_sphere_with_a_linear_gap(surface):
    joint, cycle = HIP.replace(clearance=0.5), constant_load(8, force=40e3)
    use = use_of(joint, cycle, surface=surface, ring_width=radians(4.0))
    model = bs.Sphere(cup=UPRIGHT, surface=surface, ring_width=radians(4.0), gap=bs.LinearGap)
    press = model.press(joint, force=40e3)
    (check,) = use.unworn_checks
    assert all("Eq. (6) neglects" in " ".join(notes) for notes in (check.notes, press.notes))
    assert use.contact_model.name == "sphere"
    assert check.valid == press.valid
    assert check.utilisation == pytest.approx(press.utilisation, rel=3e-2)
    small = use_of(joint, cycle.scaled(1e-4), surface=surface, ring_width=radians(4.0)).unworn_checks[0]
    assert not small.valid
    assert any("the contact spans few rings" in note for note in small.notes)


def test_a_run_without_contact_has_no_wear_no_check_and_no_figure():
    history = use_of(HIP, constant_load(8, force=0.0)).after(1e4)
    assert history.use.unworn_checks == ()
    assert history.valid
    assert history.last.converged
    assert history.last.volume == history.last.penetration == 0
    assert any(note.startswith("no wear: the ball is never in contact") for note in history.notes)
    assert (history.error.blocks, history.error.volume, history.error.depth) == (0.0, 0.0, 0.0)
    summary = history.summary()
    zeros = ("pressure_slide_integral_Nm", "cross_shear_mean", "crossing_angle_mean_deg")
    assert [summary["cycle"][name] for name in zeros] == [0.0, 0.0, 0.0]
    assert summary["cycle"]["peaks"] == {"force_N": 0.0, "max_pressure_MPa": 0.0, "speed_mm_s": 0.0}
    assert summary["initial"] == {"wear_mm3_per_Mc": 0.0, "depth_mm_per_Mc": 0.0}
    assert (summary["cycle"]["edge"], summary["film"]) == (None, None)
    assert "data:image" not in hip_report(history)


def test_patients_have_their_validity():
    heavy = {"body_weight": LogNormal(median=800.0, factor=3.0)}
    scatter = PatientVariability(use=use_of(HIP, iso_14242_1(24)), distributions=heavy)
    cohort, bands = population(scatter, [1e5, 1e6], patients=24)
    summary = bands.summary()["bands"][-1]
    assert 0.5 < summary["valid"] < 1
    assert summary["peak_utilisation"]["low"] < 0.5 < 1 < summary["peak_utilisation"]["high"]
    heaviest = int(cohort.values["body_weight"].argmax())
    patient = scatter.patient({"body_weight": cohort.values["body_weight"][heaviest]})
    assert bands.cohort.peak_utilisation[heaviest, 0] == pytest.approx(patient.use.unworn_checks[0].utilisation)


def test_the_verdict_includes_the_allowable_pressure():
    liner = replace(bs.UHMWPE, allowable_pressure=5.0)
    (check,) = use_of(replace(HIP, liner=liner), constant_load(12, force=2000.0)).unworn_checks
    assert check.utilisation_bar.verdict(high=1.0) is Verdict.KEPT
    assert check.summary()["pressure_ratio"] == pytest.approx(check.max_pressure / 5.0)
    assert check.verdict is Verdict.EXCEEDED


def test_a_contact_at_the_rim_has_no_bound_of_its_stress_as_in_a_press():
    """The axial stress of the same contact says nothing about the corner of a rim that is loaded."""
    cup, load = bs.Cup(inclination=radians(50.0), arc_of_cover=radians(150.0)), constant_load(8, force=1500.0)
    press = bs.Sphere(cup=cup, ring_width=radians(5.0)).press(HIP, force=1500.0)
    assert (press.edge_loaded, error_bar(press, "utilisation").high) == (True, inf)
    history = use_of(HIP, load, cup=cup).after(1e5)
    for check in (*history.use.unworn_checks, *history.contact_checks[-1]):
        assert check.utilisation < 0.5
        assert (check.utilisation_bar.high, check.verdict) == (inf, Verdict.UNDECIDED)
    (axial,) = use_of(HIP, load).unworn_checks
    assert axial.utilisation_bar.high < 0.6
    assert axial.verdict is Verdict.KEPT
