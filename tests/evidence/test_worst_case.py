"""Calculations for the worst cases: methods, deviations, bands, CalculiX and wear."""

import sys
from types import SimpleNamespace
from unittest.mock import PropertyMock

import numpy as np
import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
import ballsocket as bs
from ballsocket.core.unit_systems import from_json
from ballsocket.evidence import worst_case
from ballsocket.evidence.question import Question
from ballsocket.evidence.worst_case import compare_methods, largest_deviation, propagate_tolerances, solve_with_calculix
from ballsocket.studies.variance_shares import sensitivity

from ..extent import some
from ..places import EXAMPLES
from .small_pack import CLEARANCE, FORCE, YOUNG, question_of

CASE = {"clearance": 0.15, "force": 4000.0}
JOINT = bs.joints["hip-36"].replace(clearance=0.15)


def method(numbers, valid=True, aligned=True):
    return {"numbers": numbers, "valid": valid, "aligned": aligned}


def test_largest_deviation_is_relative_to_the_first_method():
    first = method({"a": 2.0, "b": 4.0, "c": 0.0})
    others = [method({"a": 2.2, "c": 1.0}), method({"a": 1.7, "b": 4.0})]
    assert largest_deviation([first, *others]) == {"a": pytest.approx(0.15), "b": 0.0}
    assert largest_deviation([first]) == {}
    assert largest_deviation([first, method({"a": 9.0}, valid=False), method({"b": 9.0}, aligned=False)]) == {}


def test_an_aligned_case_is_solved_by_three_methods(pack):
    methods = compare_methods(pack[0], CASE)
    assert [m.name for m in methods] == ["exact", "tabulated", "sphere (along the axis)"]
    exact = bs.Exact().press(JOINT, force=4000.0)
    summary = methods[0].summary()
    assert summary["numbers"]["half_angle_deg"] == pytest.approx(np.degrees(exact.half_angle))
    assert summary["numbers"]["area"] == pytest.approx(exact.area)
    assert set(summary["errors"]) == {"force", "half_angle_deg", "indentation", "max_pressure"}
    assert (summary["valid"], summary["aligned"]) == (True, True)


@pytest.mark.parametrize(("joint", "clearance"), some([('gap = "circular"\njoint', 0.15), ("joint", 0.3)], 1))
def test_the_tables_of_the_linear_gap_are_not_compared_with_the_circular_gap(joint, clearance, tmp_path):
    """The circular gap is that of the question, or by default that of clearances above 0.01 R2."""
    methods = compare_methods(question_of(tmp_path, ("joint", joint)), {**CASE, "clearance": clearance})
    assert [m.name for m in methods] == ["exact", "sphere (along the axis)"]


def test_a_tilted_case_is_also_solved_on_rings_of_half_the_width(tmp_path, monkeypatch):
    wide = property(lambda question: bs.Sphere(cup=question.file.cup, ring_width=np.radians(4.0)))
    monkeypatch.setattr(Question, "model", wide)  # for speed
    question = question_of(tmp_path, (CLEARANCE, 'inclination = "40 deg"'), (FORCE, 'force = "4 kN"'))
    methods = compare_methods(question, {"inclination": np.radians(40.0), "force": 4000.0})
    assert [m.name for m in methods[:2]] == ["sphere", "sphere, rings of half the width"]
    assert [m.name for m in methods[2:]] == [f"{name} (along the axis)" for name in ("exact", "tabulated", "sphere")]
    assert [m.aligned for m in methods] == [False] * 2 + [True] * 3
    deviation = largest_deviation([m.summary() for m in methods])
    assert 0 < deviation["max_pressure"] < 0.02
    assert methods[0].numbers["max_pressure"] != methods[1].numbers["max_pressure"]
    tilted, _, aligned, *_ = (m.numbers["max_pressure"] for m in methods)
    assert tilted != aligned


def test_a_band_has_the_percentiles_of_the_tolerance_and_the_sobol_indices_of_the_study(pack):
    """The largest pressure falls with the modulus as it does in single contacts at the percentiles."""
    result = propagate_tolerances(pack[0], CASE)
    band = result["bands"]["max_pressure"]
    spread = pack[0].tolerances["liner_young"].frozen
    liners = [bs.Material(young=young, poisson=0.4) for young in spread.ppf([0.025, 0.5, 0.975])]
    ends = [bs.Exact().press(JOINT.replace(liner=liner), force=4000.0).max_pressure for liner in liners]
    assert [band["low"], band["median"], band["high"]] == pytest.approx(sorted(map(float, ends)), rel=2e-3)
    assert (result["samples"], result["seed"], band["answered"]) == (1024, 1, 1024)
    assert (result["model"], result["aligned"]) == ("tabulated", False)
    half_angle = result["bands"]["half_angle_deg"]
    assert 40 < half_angle["low"] < half_angle["median"] < half_angle["high"] < 44
    study = {"quantities": ("max_pressure", "half_angle"), "count": 256, "load": {"force": 4e3}}
    expected = sensitivity(bs.Tabulated(), JOINT, pack[0].tolerances, **study).total_order
    index = float(expected.sel(quantity="max_pressure", parameter="liner_young"))
    assert result["sobol"]["max_pressure"] == {"liner_young": pytest.approx(index)}


def test_bands_outside_the_tables_are_solved_exactly(tmp_path):
    (tmp_path / "metal.toml").write_bytes((EXAMPLES / "metal_backed_hip.toml").read_bytes())
    question = question_of(tmp_path, ("hip-36", "metal.toml"))
    result = propagate_tolerances(question, {**CASE, "clearance": 0.1})
    assert (result["model"], result["samples"], result["bands"]["max_pressure"]["answered"]) == ("exact", 64, 64)


def test_a_case_outside_its_tolerance_is_noted_in_the_units_of_files(tmp_path):
    question = question_of(tmp_path, (FORCE, 'half_angle = "50 deg"'), (YOUNG, 'half_angle = "40 +- 1 deg"'))
    (note,) = propagate_tolerances(question, {"clearance": 0.1, "half_angle": np.radians(50.0)})["notes"]
    assert from_json(note).startswith("half angle 50° of the worst case lies outside its tolerance of 39° to 41°: ")
    assert propagate_tolerances(question, {"clearance": 0.1, "half_angle": np.radians(40.9)})["notes"] == []


@pytest.mark.skipif(sys.platform == "win32", reason="programs are no scripts there")
def test_calculix_solves_the_deck_of_the_case_or_its_failure_is_noted(pack, tmp_path, monkeypatch):
    pytest.importorskip("skfem", reason="the extra for finite elements is not installed")
    question = question_of(tmp_path, ('joint = "hip-36"', 'joint = "hip-36"\nfinite_elements = true'))
    monkeypatch.setenv("PATH", str(tmp_path))
    assert solve_with_calculix(question, CASE) == []
    (tmp_path / "ccx").write_text("#!/bin/sh\necho no licence\nexit 3\n", encoding="ascii")
    (tmp_path / "ccx").chmod(0o755)
    assert solve_with_calculix(pack[0], CASE) == []  # the question requires no finite elements
    (result,) = solve_with_calculix(question, CASE)
    assert (result.valid, result.notes) == (False, ("ccx ended with 3 before the first step did: no licence",))

    def run(folder):
        assert any(path.suffix == ".inp" for path in folder.iterdir())
        return SimpleNamespace(indentation=[0, 7], force=[0, 7], half_angle=[0, 7], pole_pressure=[1, 9])

    monkeypatch.setattr("ballsocket.elasticity.finite_elements.calculix.run", run)
    (result,) = solve_with_calculix(question, CASE)
    assert (result.name, result.valid) == ("CalculiX", True)
    assert result.numbers == {"indentation": 7.0, "force": 7.0, "half_angle": 7.0, "max_pressure": 9.0}


def test_hips_without_a_contact_have_no_wear_rate(monkeypatch, pack):
    first = PropertyMock(side_effect=ValueError("no contact"))
    monkeypatch.setattr(worst_case, "read_hip", lambda path: None)
    monkeypatch.setattr(worst_case, "_simulation", lambda *arguments: type("Hip", (), {"first": first})())
    question = SimpleNamespace(hip="hip.toml")
    cases = [{"clearance": 0.1, "force": 1.0}, {"clearance": 0.1, "force": 2.0}, {"clearance": 0.2, "force": 1.0}]
    assert worst_case.wear_rates(question, cases) == [None, None, None]
    assert first.call_count == 2  # cases that differ only in their load are computed once
