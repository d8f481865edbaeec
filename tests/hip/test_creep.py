"""Creep: the ladder against its closed form, the logarithm, and together with wear."""

import re
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, KelvinVoigtChain, constrained_share, iso_14242_1, logarithmic

from .hips import QUICK, TILTED, K, hip, report_after

LADDER = KelvinVoigtChain(compliances=(1e-3, 5e-4, 2e-3), times=(30.0, 4e3, 7e5))


@pytest.mark.parametrize("steps", [1, 3, 1000])
@pytest.mark.parametrize("last", [10.0, 1e4, 1e7])
def test_creep_under_a_pressure_step_is_exact_for_any_time_steps(steps, last):
    rng = np.random.default_rng(steps)
    ends = np.sort(np.append(rng.uniform(0.0, last, steps - 1), last))
    pressure, strain = np.array([0.0, 3.0, 11.0]), LADDER.initial_strain(3)
    for seconds in np.diff(ends, prepend=0.0):
        strain = LADDER.advance_strain(strain, pressure, seconds)
    assert strain.sum(axis=0) == pytest.approx(LADDER.response(last) * pressure, rel=1e-10)
    closed = sum(J * (1 - np.exp(-last / time)) for J, time in zip(LADDER.compliances, LADDER.times, strict=True))
    assert LADDER.response(last) == pytest.approx(closed, rel=1e-10)


def test_unloaded_creep_strain_recovers():
    strain = LADDER.advance_strain(LADDER.initial_strain(1), np.array([5.0]), 1e9)
    assert strain.sum() == pytest.approx(5 * sum(LADDER.compliances), rel=1e-10)
    assert LADDER.advance_strain(strain, np.zeros(1), 1e9).sum() == pytest.approx(0.0, abs=1e-15)


def test_linear_response_equals_the_advanced_strain():
    rng = np.random.default_rng(4)
    strain, pressure = rng.uniform(size=(3, 5)), rng.uniform(size=5)
    stays, adds = LADDER.linear_response(strain, 500.0)
    assert stays + adds * pressure == pytest.approx(
        LADDER.advance_strain(strain, pressure, 500.0).sum(axis=0), rel=1e-12
    )


def test_logarithmic_creep_is_within_two_percent_of_its_formula():
    minutes = np.logspace(1.0, 7.3, 300)
    expected = 3.491e-3 + 7.966e-4 * (np.log10(minutes) - 4)
    assert logarithmic().response(60 * minutes) == pytest.approx(expected, rel=0.02)
    assert "not verified" in logarithmic().notes[0]


def test_creep_without_wear_balances_its_loads():
    use = hip(wear=Archard(coefficient=0.0), creep=LADDER, **QUICK)
    report = report_after(use, 1e7)
    rest = use.solve_equilibrium((report.wear + report.crept).ravel())
    carried = np.einsum("tp,kp,p->tk", rest.pressure, use.foundation.normals, use.foundation.areas)
    assert carried == pytest.approx(use.loads, abs=1e-6 * 300)
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


@pytest.mark.long
def test_constrained_layer_strains_by_the_oedometric_modulus():
    """Uniaxial strain: σr = σθ = ν/(1 - ν) σz, hence εz = σz (1 - 2 ν²/(1 - ν))/E."""
    for poisson in (0.0, 0.3, 0.4, 0.49, 0.5):
        assert constrained_share(poisson) == pytest.approx(1 - 2 * poisson**2 / (1 - poisson), abs=1e-15)
    assert 1 / constrained_share(0.4) == pytest.approx(15 / 7)


def test_confinement_scales_the_strain_of_a_free_bar():
    share = constrained_share(0.4)
    confined = replace(LADDER, confinement=share)
    for seconds in (1.0, 1e4, 1e8):
        assert confined.response(seconds) == pytest.approx(share * LADDER.response(seconds), rel=1e-15)
        pressure = np.array([1.0, 10.0])
        after = [one.advance_strain(one.initial_strain(2), pressure, seconds) for one in (LADDER, confined)]
        assert after[1] == pytest.approx(share * after[0], rel=1e-14)
    assert (replace(LADDER, confinement=1.0).response(1e4) == LADDER.response(1e4)).all()


def test_confined_liner_creeps_less_and_has_a_note():
    free, confined = (hip(creep=logarithmic(share), **QUICK) for share in (1.0, constrained_share(0.4)))
    deep, less = (report_after(use, 1e3).creep_depth for use in (free, confined))
    assert constrained_share(0.4) * deep < less < deep  # pressures fall less where less creeps
    assert any("the strain of a laterally constrained liner is 0.47 of that" in note for note in free.notes)
    assert any(re.search(r"creep strain is [0-9.]+ of that of a free bar", note) for note in confined.notes)


def test_creep_does_not_depend_on_the_block_length(monkeypatch):
    from ballsocket.hip import wear_integrator

    use = hip(creep=LADDER, **QUICK)
    usual = report_after(use, 3e5)
    monkeypatch.setattr(wear_integrator, "_CREEP_GROWTH", wear_integrator._CREEP_GROWTH / 2)
    finer = report_after(use, 3e5)
    assert usual.creep_depth == pytest.approx(finer.creep_depth, rel=0.01)
    assert usual.volume == pytest.approx(finer.volume, rel=0.005)


def test_creep_depends_on_time_and_not_on_cycles():
    slow = report_after(hip(creep=LADDER, seconds_per_cycle=100.0, **QUICK), 1e4)
    usual = report_after(hip(creep=LADDER, wear=Archard(coefficient=1e-2 * K), **QUICK), 1e6)
    assert slow.creep_depth == pytest.approx(usual.creep_depth, rel=1e-2)


def test_fast_creep_softens_the_springs():
    """A fast element of compliance J adds J L to 1/K under the mean pressure of a constant load."""
    walk = replace(iso_14242_1(72), force=lambda t: 2000.0 + 0 * t)
    joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    fast = KelvinVoigtChain(compliances=(1e-4,), times=(1.0,))
    use = HipSimulation(joint=joint, cup=TILTED, cycle=walk, wear=Archard(coefficient=0.0), creep=fast)
    softer = 1 / (1 / use.foundation.modulus + 8.0 * 1e-4)
    expected = (
        replace(use.foundation, modulus=softer)
        .solve_equilibrium(use.loads, np.zeros(len(use.foundation.areas)))
        .pressure.max()
    )
    assert report_after(use, 1e4).max_pressure == pytest.approx(expected, rel=2e-3)


def test_socket_of_infinite_thickness_wears():
    assert report_after(hip(liner=float("inf"), **QUICK), 1e5).volume > 0
