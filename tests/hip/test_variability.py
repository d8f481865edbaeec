"""Variability between patients: the hip of a patient, its coarse simulation, and its results."""

import pickle
from dataclasses import replace
from math import inf, radians
from operator import attrgetter

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Activity, CrossShear, Mix, PatientVariability, iso_14242_1, iso_14242_4, logarithmic, rocking
from ballsocket.hip.variability import RESULT_COLUMNS, RESULT_UNITS, Patient, contact_table, result_table
from ballsocket.studies import LogNormal, Normal, Rectangular

from .hips import QUICK, K, hip, refuses

FEW_CYCLES = 1e3
"""Cycles after which the bore is as good as unworn."""

TIGHT = Rectangular(low=0.05, high=0.2)
WEIGHT = Normal(mean=800.0, deviation=100.0)
COEFFICIENT = LogNormal(median=K, factor=1.5)


def variability(use=None, **distributions):
    return PatientVariability(use=use or hip(**QUICK), distributions=distributions)


def test_a_patient_has_the_values_of_its_sample_and_nominal_ones_of_what_is_not_sampled():
    angle = Normal(mean=0.5, deviation=0.1)
    spread = {"body_weight": WEIGHT, "clearance": TIGHT, "cycles_per_year": LogNormal(median=1e6, factor=2.0)}
    spread |= {"inclination": angle, "anteversion": angle}
    use = hip(seconds_per_cycle=20.0, **QUICK)
    every = PatientVariability(use=use, distributions=spread, body_weight=750.0)
    values = {"body_weight": 900.0, "inclination": 0.4, "anteversion": 0.1, "clearance": 0.15, "cycles_per_year": 2e6}
    patient = every.patient(values)
    assert patient.use.cycle.largest_force == pytest.approx(1.2 * every.coarse_simulation.cycle.largest_force)
    assert patient.use.frame.placed == bs.Cup(inclination=0.4, anteversion=0.1)
    assert patient.use.joint.clearance == 0.15
    assert patient.cycle_ratio == 2.0
    assert patient.use.seconds == 10.0  # the same time with twice as many cycles
    assert patient.simulate([FEW_CYCLES])[0].cycles == 2 * FEW_CYCLES
    one = variability(body_weight=WEIGHT, clearance=TIGHT, coefficient=COEFFICIENT)
    patient, nominal = one.patient({}), one.coarse_simulation
    assert patient.cycle_ratio == 1.0
    for name in ("joint", "wear", "frame.placed"):
        assert attrgetter(name)(patient.use) == attrgetter(name)(one.use)
    assert patient.use.cycle is nominal.cycle
    heavy = one.patient({"body_weight": 1000.0})  # the forces of the cycle are those of the median weight
    assert heavy.use.cycle.largest_force == pytest.approx(1.25 * nominal.cycle.largest_force)
    tilted = variability(tilt=Rectangular(low=0.0, high=1.0)).patient({"tilt": 0.3}).use.frame.placed
    assert tilted == nominal.cup.tilted(0.3) != one.use.frame.placed
    law = variability(hip(wear=CrossShear(straight=1e-7, circular=5e-7), **QUICK), coefficient=COEFFICIENT)
    wear = law.patient({"coefficient": 3e-7}).use.wear
    assert (wear.straight, wear.circular) == pytest.approx((3e-7, 1.5e-6))  # their ratio is kept


MIX = Mix(activities=(Activity(cycle=iso_14242_1(), per_year=1e6), Activity(cycle=rocking(), per_year=1e5)))


def test_cycles_per_year_are_the_median_or_those_of_a_mix():
    assert variability(clearance=TIGHT).cycles_per_year is None
    assert variability(cycles_per_year=LogNormal(median=1.5e6, factor=2.0)).cycles_per_year == pytest.approx(1.5e6)
    mixed = variability(hip(cycle=MIX), cycles_per_year=LogNormal(median=2e6, factor=2.0))
    assert mixed.cycles_per_year == 1.1e6
    assert mixed.patient({"cycles_per_year": 2.2e6}).cycle_ratio == pytest.approx(2.0)


def test_the_coarse_simulation_has_springs_wide_rings_and_few_instants_or_rings_of_full_elasticity():
    fine = variability(hip(surface=bs.ClosedShell(), ring_width=radians(3.0)), clearance=TIGHT).coarse_simulation
    assert isinstance(fine.surface, bs.Springs)
    assert (fine.ring_width, fine.cycle.n_steps) == (radians(8.0), 32)
    coarse = hip(cycle=iso_14242_1(16), ring_width=radians(9.0))
    same = variability(coarse, clearance=TIGHT).coarse_simulation
    assert (same.ring_width, same.cycle.n_steps) == (radians(9.0), 16)
    assert same.surface is coarse.surface
    wide = variability(hip(ring_width=radians(10.0)), clearance=TIGHT)
    shell = replace(wide, surface=bs.ClosedShell())
    assert shell.coarse_simulation.ring_width == pytest.approx(radians(6.0))
    assert shell.patient({"clearance": 0.07}).use.contact_model.ring_width == pytest.approx(radians(6.0))
    assert wide.coarse_simulation.ring_width == pytest.approx(radians(10.0))
    checked = hip(surface=bs.ClosedShell(), ring_width=radians(8.0))
    assert checked.unworn_checks[0].valid
    assert checked.contact_model.ring_width == pytest.approx(radians(6.0))


@pytest.mark.parametrize("cycle", [iso_14242_1(40), iso_14242_4(), rocking()], ids=lambda cycle: cycle.name)
def test_the_coarse_cycle_has_the_forces_and_angles_of_the_cycle_at_its_instants(cycle):
    coarse = variability(hip(cycle=cycle), clearance=TIGHT).coarse_simulation.cycle
    midpoints, starts = (np.arange(32) + 0.5) / 32, np.arange(32) / 32
    np.testing.assert_allclose(coarse.force(midpoints), cycle.force(midpoints), rtol=1e-12)
    np.testing.assert_allclose(coarse.angles(starts), cycle.angles(starts), atol=1e-12)
    assert np.shape(coarse.angles(starts[:5])) == (3, 5)
    np.testing.assert_allclose(coarse.angles(starts + 1.0), coarse.angles(starts), atol=1e-12)  # periodic
    between = coarse.angles(np.array([1.5 / 32]))[:, 0]
    np.testing.assert_allclose(between, cycle.angles(starts)[:, 1:3].mean(axis=1), atol=1e-12)  # linear


@pytest.mark.parametrize("cycle", [rocking(), iso_14242_4(), MIX], ids=lambda cycle: cycle.name)
def test_the_coarse_hip_can_be_pickled_and_wears_as_the_full_one(cycle):
    use = hip(cycle=cycle, cup=bs.Cup(inclination=radians(30.0), side=bs.Side.LEFT))
    sent = pickle.loads(pickle.dumps(variability(use, clearance=TIGHT).coarse_simulation))
    volume = Patient(use=sent, cycle_ratio=1.0).simulate([FEW_CYCLES])[0].volume
    assert 1e6 / FEW_CYCLES * volume == pytest.approx(use.first.volume, rel=2e-2)


def test_results_are_those_of_the_reports_whose_contacts_balance_their_loads(monkeypatch):
    use = replace(hip(creep=logarithmic(), **QUICK), joint=replace(hip().joint, liner=bs.UHMWPE))
    patient = variability(use, clearance=TIGHT).patient({"clearance": 0.1})
    reports = patient.simulate([FEW_CYCLES, 1e4])
    table = result_table(reports)
    assert table.shape == (2, len(RESULT_UNITS))
    for row, report in zip(table, reports, strict=True):
        results = dict(zip(RESULT_UNITS, row, strict=True))
        assert results["edge_distance"] == report.edge_distance.min()
        assert results["creep_depth"] == report.creep_depth > 0
        assert results["max_pressure"] == report.max_pressure
        assert results["penetration"] == report.penetration
    contact = contact_table(patient.use, reports)
    assert contact.shape == (3, 3)
    assert ((contact[:, 0] > 0) & (contact[:, 0] < 1)).all()
    assert (contact[:, 1] == 1).all()
    unloaded = replace(reports[0], edge_distance=np.array([]))
    assert result_table([unloaded])[0, RESULT_COLUMNS["edge_distance"]] == inf
    patient = variability(clearance=TIGHT).patient({})
    report = replace(patient.simulate([FEW_CYCLES])[0], converged=False)
    monkeypatch.setattr("ballsocket.hip.variability.make_report", lambda run: report)
    refuses("a contact did not balance its load", patient.simulate, [FEW_CYCLES])


@pytest.mark.long
def test_patients_with_the_real_cup_share_its_compliance_and_wear_as_on_springs():
    on_springs = variability(hip(), coefficient=COEFFICIENT, tilt=Normal(mean=0.5, deviation=0.1))
    with_cup = replace(on_springs, surface=bs.RealCup())
    values = [{"coefficient": 2 * K, "tilt": 0.4}, {"coefficient": K, "tilt": 0.6}]
    patients = [with_cup.patient(sample) for sample in values]
    assert patients[0].use.foundation is patients[1].use.foundation
    for patient, sample in zip(patients, values, strict=True):
        elastic, springs = (one.simulate([1e5])[0] for one in (patient, on_springs.patient(sample)))
        assert 0 < abs(elastic.volume / springs.volume - 1) < 0.01
        assert elastic.depth == pytest.approx(springs.depth, rel=0.03)
        assert elastic.max_pressure == pytest.approx(springs.max_pressure, rel=0.03)
