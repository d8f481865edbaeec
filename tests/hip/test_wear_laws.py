"""Wear laws on small exposures with depths by hand, their units and JSON, and creep of a liner."""

import re
import tomllib
from dataclasses import replace
from operator import attrgetter
from types import SimpleNamespace

import numpy as np
import pytest

from ballsocket.hip import Archard, ContactAreaWear, CrossShear, CustomWearLaw, FrictionEnergyWear, wear_integrator
from ballsocket.hip.creep_law import confinement_note, constrained_share
from ballsocket.hip.creep_laws import CREEP_LAWS, KelvinVoigtChain, LogarithmicCreep, logarithmic, read_creep_law
from ballsocket.hip.law_fields import law_summary
from ballsocket.hip.wear_law import (
    CycleExposure,
    coefficient_field,
    max_wear_sensitivity,
    wear_factor,
    wear_per_energy,
    wear_per_slide,
)
from ballsocket.hip.wear_laws import WEAR_LAWS, read_ball_law, read_wear_law

from .hips import QUICK, WALK, K, hip, report_after, socket_force

PRESSURE = np.array([[2.0, 0.0, 4.0], [3.0, 0.0, 0.0]])
SLIDES = np.array([[1.0, 5.0, 2.0], [2.0, 7.0, 3.0]])
SHARES = np.array([[1.0, 0.0, 0.5], [0.25, 0.0, 0.0]])
WORK = np.array([8.0, 0.0, 8.0])
CROSS_SHEAR = np.array([0.0, 0.1, 0.5])


def exposure(pressure=PRESSURE, shares=SHARES, slides=SLIDES):
    sliding = SimpleNamespace(steps=slides, distances=slides, cross_shear=lambda pressure: CROSS_SHEAR)
    return CycleExposure(pressure=pressure, sliding=sliding, contact_shares=None if shares is None else lambda: shares)


def test_depths_are_those_of_the_formulas():
    cycle = exposure()
    assert cycle.work == pytest.approx(WORK, rel=1e-15)
    assert Archard(coefficient=2e-6).depth(cycle) == pytest.approx(2e-9 * WORK, rel=1e-15)
    energy = FrictionEnergyWear(coefficient=4e-5, friction=0.05)
    assert energy.depth(cycle) == pytest.approx(2e-9 * WORK, rel=1e-14)
    area = ContactAreaWear(coefficient=3e-9)
    assert area.depth(cycle) == pytest.approx([4.5e-9, 0.0, 3e-9], rel=1e-15)
    assert area.depth(exposure(shares=None)) == pytest.approx([9e-9, 0.0, 6e-9])  # a positive pressure is contact
    assert CustomWearLaw(function=lambda cycle: 5 * cycle.work).depth(cycle) == pytest.approx(5 * WORK)
    assert Archard(coefficient=0.0).depth(cycle).max() == 0
    law = CrossShear(straight=1e-6, circular=3e-6)
    assert law.depth(exposure()) == pytest.approx([8e-9, 0.0, 24e-9], rel=1e-14)
    mean = np.array([8.0 / 3.0, 1.0, 4.0])  # over the slides in contact: 3 mm and 2 mm
    steep = CrossShear(straight=1e-6, circular=3e-6, exponent=0.5, reference=2.0)
    assert steep.depth(exposure()) == pytest.approx(np.array([8e-9, 0.0, 24e-9]) * (mean / 2) ** 0.5, rel=1e-14)


def test_wear_sensitivity_is_the_derivative_by_the_pressure():
    cycle, law = exposure(), Archard(coefficient=1e-6)
    assert max_wear_sensitivity(law, cycle) == pytest.approx(1e-9 * 3.0, rel=1e-6)  # over 3 mm in contact
    assert max_wear_sensitivity(ContactAreaWear(coefficient=1e-6), cycle) == 0.0
    assert max_wear_sensitivity(law, exposure(pressure=0 * PRESSURE)) == 0.0


def test_notes_name_wear_factors_outside_the_usual_range():
    for value in (0.0, 1e-9, 1e-4):
        assert Archard(coefficient=value).notes == ()
    for value in (0.9e-9, 1.1e-4):
        assert Archard(coefficient=value).notes[0].startswith(f"a wear factor of {value:g} mm^3/(N m)")
    assert CrossShear(straight=1e-6, circular=1e-3).notes[0].startswith("a wear factor of 0.001")
    for other in (FrictionEnergyWear(coefficient=1e-3, friction=0.0), ContactAreaWear(coefficient=1.0)):
        assert other.notes == ()


def examples(laws):
    """Make registered laws from the examples of their fields: rows of a test, by the names of the laws."""
    made = [law(**{field.name: field.example for field in law.law_fields()}) for law in laws.values()]
    return pytest.mark.parametrize("law", made, ids=attrgetter("name"))


def read_from_file(law, read, *words):
    """Read a law from the lines of a file that state its examples with their units."""
    lines = (f"{field.key} = {field.unit.example(getattr(law, field.name))}" for field in law.law_fields())
    return read(tomllib.loads("\n".join([f"law = '{law.name}'", *lines])), *words)


@examples(WEAR_LAWS)
def test_wear_needs_pressure_and_sliding_and_grows_with_coefficient_and_cycles(law):
    depth = law.depth(exposure())
    assert (depth.shape, depth[1]) == ((3,), 0.0)
    assert min(depth[0], depth[2]) > 0
    assert depth.max() < np.inf
    if coefficient_field(law).unit.text == "mm³/(N m)":  # then it is near Archard's wear, and not 1000 times as large
        assert 0.01 < law.with_coefficient(2e-6).depth(exposure())[0] / (2e-9 * WORK[0]) < 100
    assert law.depth(exposure(pressure=0 * PRESSURE, shares=0 * SHARES)) == pytest.approx(0.0, abs=0)
    assert law.depth(exposure(slides=0 * SLIDES)) == pytest.approx(0.0, abs=0)
    twice = exposure(*(np.tile(part, (2, 1)) for part in (PRESSURE, SHARES, SLIDES)))
    assert law.depth(twice) == pytest.approx(2 * depth, rel=1e-12)
    coefficient = getattr(law, coefficient_field(law).name)
    assert law.with_coefficient(3 * coefficient).depth(exposure()) == pytest.approx(3 * depth, rel=1e-12)
    if law.pressure_degree is not None:
        expected = 2**law.pressure_degree * depth
        assert law.depth(exposure(pressure=2 * PRESSURE)) == pytest.approx(expected, rel=1e-12)
    assert (read_from_file(law, read_wear_law), law.summary()["law"]) == (law, law.name)
    assert law.title
    assert law.storable


@examples(CREEP_LAWS)
def test_creep_grows_from_zero_and_does_not_depend_on_time_steps(law):
    seconds = np.append(0.0, np.logspace(-1.0, 9.0, 50))
    response, strain, pressure = law.response(seconds), law.initial_strain(2), np.array([0.0, 5.0])
    assert response[0] == 0
    assert 0 <= np.diff(response).min() < response[-1] < np.inf
    for step, total in zip(np.diff(seconds), response[1:], strict=True):
        strain = law.advance_strain(strain, pressure, step)
        assert strain.sum(axis=0) == pytest.approx(total * pressure, rel=1e-9)
    assert replace(law, confinement=0.5).response(seconds) == pytest.approx(response / 2, rel=1e-12)
    assert (read_from_file(law, read_creep_law, 0.4), law.summary()["law"]) == (law, law.name)
    assert law.title
    assert law.storable


def test_summaries_have_units_in_their_keys():
    assert law_summary(None) is None
    summary = law_summary(CrossShear(straight=1e-6, circular=2e-6))
    assert {name: summary[name] for name in ("law", "exponent")} == {"law": "cross-shear", "exponent": 0.0}
    assert list(summary)[1:] == ["straight_mm3_per_Nm", "circular_mm3_per_Nm", "exponent", "reference_MPa"]
    chain = KelvinVoigtChain(compliances=(1e-3,), times=(60.0,))
    assert law_summary(chain) == {"law": "kelvin-voigt", "compliances_per_MPa": [1e-3], "times_s": [60.0]}
    assert law_summary(SimpleNamespace(depth=None)) == {"law": "SimpleNamespace"}


def test_laws_are_read_with_their_units_and_the_creep_law_follows_from_its_keys():
    archard = read_wear_law({"coefficient": "2e-15 m^3/(N m)"})
    assert (archard.name, archard.coefficient) == ("archard", pytest.approx(2e-6))
    law = read_wear_law({"law": "cross-shear", "coefficient": 1e-6, "circular": 2e-6, "reference": "500 kPa"})
    assert (law.reference, law.exponent) == (pytest.approx(0.5), 0.0)
    table = {"law": "energy", "coefficient": 1e-6, "friction": 0.1}
    assert read_ball_law(table) is None
    ball = read_ball_law({**table, "ball_coefficient": "3 mm^3/MJ"})
    assert (ball.name, ball.coefficient, ball.friction) == ("energy", pytest.approx(3e-6), 0.1)
    assert (wear_factor("k", 1), wear_per_energy("e", 2), wear_per_slide("C", "3 mm/m")) == (1, 2, pytest.approx(3e-3))
    per_work = "1e-6 mm^3/(N m)", "1e-6 mm³/(N·m)", "1e-6 mm3/Nm", "1e-6 mm^3/N/m", "1e-15 m^3/(N m)", "1e-6", 1e-6
    assert [wear_factor("coefficient", text) for text in per_work] == pytest.approx([1e-6] * 7, rel=1e-12)
    for text in ("1e-6 mm/m", "1e-6 mm^3/(mm^2 m)", "1e-9", 1e-9):
        assert wear_per_slide("coefficient", text) == pytest.approx(1e-9, rel=1e-12)
    assert read_creep_law({}, 0.4) == LogarithmicCreep()
    chain = read_creep_law({"compliances": [1e-3], "times": [60], "confinement": "constrained"}, 0.4)
    assert (chain.compliances, chain.times, chain.confinement) == ((1e-3,), (60.0,), pytest.approx(7 / 15))
    note = "creep strain is ([0-9.]+) of that of a free bar: the liner is laterally constrained"
    assert float(re.fullmatch(note, confinement_note(chain, 0.4))[1]) == pytest.approx(7 / 15, abs=1e-3)
    for poisson, text in {0.4: "is 0.47 of that", 0.5: "is 0 of that"}.items():
        assert text in confinement_note(LogarithmicCreep(), poisson)
    assert confinement_note(LogarithmicCreep(), 0.0) == confinement_note(LogarithmicCreep(), -0.2) == ""


# creep: the ladder against its closed form, the logarithm, and together with wear

LADDER = KelvinVoigtChain(compliances=(1e-3, 5e-4, 2e-3), times=(30.0, 4e3, 7e5))


def test_creep_strain_recovers_and_is_linear_in_the_pressure():
    closed = sum(J * (1 - np.exp(-1e4 / time)) for J, time in zip(LADDER.compliances, LADDER.times, strict=True))
    assert LADDER.response(1e4) == pytest.approx(closed, rel=1e-10)
    strain = LADDER.advance_strain(LADDER.initial_strain(1), np.array([5.0]), 1e9)
    assert strain.sum() == pytest.approx(5 * sum(LADDER.compliances), rel=1e-10)
    assert LADDER.advance_strain(strain, np.zeros(1), 1e9).sum() == pytest.approx(0.0, abs=1e-15)
    rng = np.random.default_rng(4)
    strain, pressure = rng.uniform(size=(3, 5)), rng.uniform(size=5)
    stays, adds = LADDER.linear_response(strain, 500.0)
    advanced = LADDER.advance_strain(strain, pressure, 500.0).sum(axis=0)
    assert stays + adds * pressure == pytest.approx(advanced, rel=1e-12)


def test_logarithmic_creep_is_within_two_percent_of_its_formula():
    minutes = np.logspace(1.0, 7.3, 300)
    expected = 3.491e-3 + 7.966e-4 * (np.log10(minutes) - 4)
    assert logarithmic().response(60 * minutes) == pytest.approx(expected, rel=0.02)
    assert "not verified" in logarithmic().notes[0]


def test_creep_without_wear_balances_its_loads():
    use = hip(wear=Archard(coefficient=0.0), creep=LADDER, **QUICK)
    report = report_after(use, 1e7)
    rest = use.solve_equilibrium((report.wear + report.crept).ravel())
    assert socket_force(use.foundation, rest) == pytest.approx(use.frame.loads, abs=1e-6 * 300)
    mean = rest.pressure.sum(axis=0) / use.cycle.n_steps
    fully = use.joint.liner_thickness * sum(LADDER.compliances) * mean  # 1e7 s are many times of each element
    assert report.crept.ravel() == pytest.approx(fully, abs=2e-2 * fully.max())
    assert report.volume == 0
    assert rest.pressure.max() < 0.8 * use.first.max_pressure


def test_penetration_has_bedding_in_and_then_a_steady_rate():
    history = hip(creep=logarithmic(), **QUICK).after(4e6, [1e5, 1e6, 2e6, 3e6])
    early, *later = history.reports
    assert np.linalg.norm(early.creep_displacement) > 5 * np.linalg.norm(early.wear_displacement)
    rates = np.diff([report.penetration for report in later])
    worn = np.diff([np.linalg.norm(report.wear_displacement) for report in later])
    assert rates == pytest.approx(worn, rel=0.15)
    assert early.penetration > 0.5 * rates[0]
    assert any("not verified" in note for note in history.notes)


def test_confinement_scales_the_strain_of_a_free_bar_and_is_noted():
    """Uniaxial strain: σr = σθ = ν/(1 - ν) σz, hence εz = σz (1 - 2 ν²/(1 - ν))/E."""
    for poisson in (0.0, 0.3, 0.4, 0.49, 0.5):
        assert constrained_share(poisson) == pytest.approx(1 - 2 * poisson**2 / (1 - poisson), abs=1e-15)
    share, pressure = constrained_share(0.4), np.array([1.0, 10.0])
    confined = replace(LADDER, confinement=share)
    for seconds in (1.0, 1e8):
        assert confined.response(seconds) == pytest.approx(share * LADDER.response(seconds), rel=1e-15)
        after = [one.advance_strain(one.initial_strain(2), pressure, seconds) for one in (LADDER, confined)]
        assert after[1] == pytest.approx(share * after[0], rel=1e-14)
    assert (replace(LADDER, confinement=1.0).response(1e4) == LADDER.response(1e4)).all()
    free, confined = (hip(creep=logarithmic(share), **QUICK) for share in (1.0, constrained_share(0.4)))
    deep, less = (report_after(use, 1e3).creep_depth for use in (free, confined))
    assert constrained_share(0.4) * deep < less < deep  # pressures fall less where less creeps
    assert any("the strain of a laterally constrained liner is 0.47 of that" in note for note in free.notes)
    assert any(re.search(r"creep strain is [0-9.]+ of that of a free bar", note) for note in confined.notes)


def test_creep_depends_on_time_and_not_on_cycles_or_the_block_length(monkeypatch):
    use = hip(creep=LADDER, **QUICK)
    usual = report_after(use, 3e5)
    monkeypatch.setattr(wear_integrator, "_CREEP_GROWTH", wear_integrator._CREEP_GROWTH / 2)
    finer = report_after.__wrapped__(use, 3e5)
    assert usual.creep_depth == pytest.approx(finer.creep_depth, rel=0.01)
    assert usual.volume == pytest.approx(finer.volume, rel=0.005)
    slow = report_after(hip(creep=LADDER, seconds_per_cycle=100.0, **QUICK), 1e4)
    usual = report_after(hip(creep=LADDER, wear=Archard(coefficient=1e-2 * K), **QUICK), 1e6)
    assert slow.creep_depth == pytest.approx(usual.creep_depth, rel=1e-2)


def test_fast_creep_softens_the_springs():
    """A fast element of compliance J adds J L to 1/K under the mean pressure of a constant load."""
    fast, walk = KelvinVoigtChain(compliances=(1e-4,), times=(1.0,)), replace(WALK, force=lambda t: 2000.0 + 0 * t)
    use = hip(cycle=walk, wear=Archard(coefficient=0.0), creep=fast)
    bed = replace(use.foundation, modulus=1 / (1 / use.foundation.modulus + 8.0 * 1e-4))
    expected = bed.solve_equilibrium(use.frame.loads, np.zeros(len(bed.areas))).pressure.max()
    assert report_after(use, 1e4).max_pressure == pytest.approx(expected, rel=2e-3)
