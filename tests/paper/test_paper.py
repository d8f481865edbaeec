"""Recomputation of the paper: claims, figures, accuracy of the catalogue, and resumable plans."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.storage.pieces import Plan
from ballsocket.paper import cases, claims, curves
from ballsocket.paper.accuracy import accuracies, edge_joints, paper_joints
from ballsocket.paper.claims.evaluation import (
    ACCEPTABLY,
    EXACTLY,
    STATED,
    VERY_WELL,
    Claim,
    Evaluation,
    Judgement,
    judge,
)
from ballsocket.paper.curves import Figure
from ballsocket.paper.plan import full_plan, quick_plan
from ballsocket.reports import accuracy_results

from .. import extent
from ..places import DATA, ROOT

TABLES = ROOT / "docs" / "explanation" / "choosing.md", ROOT / "README.md"
"""Pages with a row for each model; the README has the first of them."""
ACCURACY = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))

EXACT = bs.Exact(tolerance=1e-4)
FEW = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}


@pytest.fixture(scope="module")
def ledger():
    return {finding.name: finding for finding in claims.ledger(EXACT, claims.CLAIMS + claims.ELSEWHERE)}


def test_the_code_of_a_finding_is_its_claim(ledger):
    for name, finding in ledger.items():
        assert eval(finding.code.removeprefix("ballsocket.paper.")) is claims.claim(name)
    assert json.loads(json.dumps([finding.summary() for finding in ledger.values()]))
    assert all(np.isfinite(list(finding.numbers.values())).all() for finding in ledger.values())


def test_verdicts_of_the_claims_are_known(ledger):
    holding = {name for name, finding in ledger.items() if finding.verdict is Judgement.HOLDS}
    assert holding >= {"hertz-is-inadequate", "stiffness-and-geometry", "unbounded-moduli", "lowest-pressure"}
    failed = {name for name, finding in ledger.items() if finding.verdict is Judgement.FAILS}
    confined = {"quality-of-the-fit-on-thin-liners", "varies-below-one-kilonewton-above-0.4", "usable-above-0.45"}
    assert failed == {"constant-at-0.49", "independent-of-clearance-at-0.49", *confined}
    assert all(ledger[name].comment for name in failed)
    older = ledger["overestimated-pressure"].numbers  # as published
    assert older["Bartel, %"] == pytest.approx(17.0, abs=1.0)
    assert older["bonded layer, %"] == pytest.approx(25.0, abs=1.5)


def test_one_scale_judges_the_sizes_of_all_claims(ledger):
    """Considerable begins where acceptable ends: at the promise of springs, whoever's model it is."""
    assert {row.tolerance for row in claims.CLAIMS} == {EXACTLY, STATED, VERY_WELL, ACCEPTABLY}
    assert claims.claim("older-models-err-considerably").expected[0] == 100 * bs.HessForsbach().promise.within
    older, closed_form = (
        ledger[name].numbers.values() for name in ("older-models-err-considerably", "usable-above-0.45")
    )
    assert min(older) > max(closed_form)


@pytest.mark.parametrize(("ball", "poisson", "error"), [(bs.STEEL, 0.3, -1.43), (None, 0.3, -2.31), (None, 0.4, -1.59)])
def test_table_3_is_judged_with_the_head_that_is_named(ledger, ball, poisson, error):
    """The mean over 1 to 3 kN depends on its loads by 0.05 %."""
    joint = replace(cases.paper_joint(poisson, 18.0 / 6.75), ball=ball)
    ratio = bs.HessForsbach().modulus(joint) / bs.calibrate(joint).wanted
    assert 100 * (ratio - 1) == pytest.approx(error, abs=0.05)
    head = "rigid" if ball is None else "steel"
    worst = ledger["quality-of-the-fit"].numbers[f"{head} head, ν {poisson:g}, worst, %"]
    assert abs(error) - 0.05 < worst < abs(error) + 0.5


def test_finite_elements_give_the_same_verdict_on_figure_4(ledger):
    by_elements = claims.claim("overestimated-pressure")(bs.FiniteElement(meshes=1))
    for name, value in ledger["overestimated-pressure"].numbers.items():
        assert by_elements.numbers[name] == pytest.approx(value, abs=0.3)


def test_claims_of_other_authors_hold(ledger):
    exact = ledger["exact-agrees-with-calculix"].numbers
    assert exact["peak pressure off by, %"] < 0.2
    assert exact["half angle off by, °"] < 0.1
    assert ledger["ordering-of-plank"].verdict is Judgement.HOLDS
    angles = ledger["half-angles-of-jin"].numbers.values()
    assert 35 < min(angles) < max(angles) < 55


def test_calculix_table_is_the_reference_file():
    cases_of_file = json.loads((DATA / "calculix.json").read_text(encoding="utf-8"))["cases"]
    forces = [step["force"] for case in cases_of_file for step in case["linearised"]]
    np.testing.assert_array_equal(cases.calculix()["force"], forces)


@pytest.mark.long
def test_elements_agree_with_a_finer_mesh_and_with_calculix():
    findings = [claim(EXACT) for claim in claims.MESHED_CLAIMS + claims.MESHED_ELSEWHERE]
    assert [finding.verdict for finding in findings] == [Judgement.HOLDS] * 2
    elements = findings[0].numbers
    assert 66_000 < elements["elements"] < 73_000  # the paper: 27 000 in the head, 40 000 in the liner
    assert elements["twice as many"] / elements["elements"] == pytest.approx(2.0, abs=0.05)


def test_figures_are_equal_after_a_round_trip_through_json():
    for figure in (
        curves.figure_2(0.4, {"exact": EXACT}),
        curves.figure_3_or_4(3, FEW),
        curves.figure_5("head radius", "R1 11 mm", FEW),
        curves.figure_6("hess-forsbach", bs.HessForsbach(), points=7),
        curves.figure_6_deviations("area", "bartel", bs.Bartel(), bs.HessForsbach(), points=7),
    ):
        assert Figure.of(json.loads(json.dumps(figure.summary()))) == figure


def test_figure_2_has_the_published_fit_and_the_reference_for_each_poisson_ratio():
    panels = Figure.joined(curves.figure_2(poisson, {"exact": EXACT}) for poisson in cases.POISSON).panels
    assert {panel.title: len(panel.lines) for panel in panels} == {"by force": 10, "by clearance": 10, "by R2/L": 10}
    lines = {line.model[:3]: line for line in panels[2].lines if line.case == "ν 0.4"}
    np.testing.assert_allclose(lines["Eq."].y[1:5], lines["exa"].y[1:5], rtol=0.015)


def test_figure_5_shows_the_pressure_over_the_arc_where_the_radius_varies():
    force, pressure = curves.figure_5("head radius", "R1 23 mm", FEW).panels
    assert "R1 φ [mm]" in pressure.x
    contact = bs.HessForsbach().press(curves.SERIES["head radius"]["R1 23 mm"], force=3000.0)
    line = next(line for line in pressure.lines if line.model == "hess-forsbach")
    assert line.x[-1] == pytest.approx(23.0 * contact.half_angle)
    assert line.y[0] == pytest.approx(contact.max_pressure)
    assert all(force.lines[0].x[i] < force.lines[0].x[i + 1] for i in range(10))


def test_deviations_in_a_map_equal_those_of_single_contacts():
    deviation = curves.figure_6_deviations("max_pressure", "bartel", bs.Bartel(), bs.HessForsbach(), points=7).maps[0]
    joint = cases.joint(head_radius=15.0, liner_thickness=7.0)
    one, other = (model.press(joint, force=3000.0).max_pressure for model in (bs.Bartel(), bs.HessForsbach()))
    assert deviation.z[deviation.y.index(7.0)][deviation.x.index(15.0)] == pytest.approx(100 * (one / other - 1))
    assert deviation.z[0][0] is None  # R1 11, L 3: below every outer radius


def worst_joints():
    """Return the joints with the largest error of some model, as arrays."""
    places = [error["worst_at"]["joint"] for row in ACCURACY for error in row["errors"].values()]
    lengths = ("ball_radius", "clearance", "liner_thickness")
    numbers = {(*(place[name] for name in lengths), place["liner"]["poisson"]) for place in places}
    *sizes, poisson = np.array(sorted(numbers)).T
    liner = bs.Material(young=1000.0, poisson=poisson)
    return bs.Joint(**dict(zip(lengths, sizes, strict=True)), liner=liner, ball=bs.STEEL)


def test_largest_errors_of_the_models_are_unchanged():
    worst = worst_joints()
    found = accuracies() if extent.whole else accuracies(joints=worst, edges=worst)
    rows = {row.model: row.summary()["errors"] for row in found}
    ranked = [before["model"] for before in ACCURACY]
    assert list(rows) == ranked if extent.whole else set(rows) == set(ranked)
    for before in ACCURACY:
        for name, error in rows[before["model"]].items():
            assert error["worst"] == pytest.approx(before["errors"][name]["worst"], rel=1e-3), (before["model"], name)


@pytest.mark.parametrize("row", ACCURACY, ids=lambda row: row["model"])
def test_tables_of_models_have_the_error_of_the_largest_pressure(row):
    """Median and worst error in percent are the last cell of the model's row."""
    error = row["errors"]["max_pressure"]
    cell = " / ".join(dict.fromkeys(accuracy_results.percent(error[name]) for name in ("median", "worst")))
    whole, short = (re.findall(rf"^\| `{row['model']}` \|.*$", page.read_text("utf-8"), flags=re.M) for page in TABLES)
    assert len(whole) == 1
    assert set(short) <= set(whole)
    assert whole[0].endswith(f" | {cell} |")


def test_largest_errors_include_the_ends_of_the_ranges():
    within, ends = paper_joints(16), edge_joints()
    (inner,), (total,) = accuracies(FEW, within, within), accuracies(FEW, within, ends)
    for name, spread in total.spreads.items():
        assert spread.median == inner.spreads[name].median
        assert spread.worst >= inner.spreads[name].worst
    assert set(ends.ball_radius.round(9)) == {11.0, 16.9, 22.8}
    assert (ends.socket_radius / ends.liner_thickness).max() > 7.6
    filling = paper_joints(256)
    assert filling.ball_radius.min() < 12 < 22 < filling.ball_radius.max()
    assert 3 <= filling.liner_thickness.min() < filling.liner_thickness.max() <= 15
    for joints in (ends, filling):
        outer = joints.socket_radius + joints.liner_thickness
        assert 16 - 1e-9 <= outer.min() < outer.max() <= 26 + 1e-9


def test_the_full_plan_adds_finite_elements_to_the_parts_of_the_quick_plan():
    quick, full = quick_plan().parts, full_plan().parts
    assert list(quick) == list(full)
    more = {part: set(full[part]) - set(quick[part]) for part in full}
    assert more["table_3"] == {f"finite elements {poisson:g}" for poisson in cases.POISSON}
    assert more["claims"] == {"mesh_is_fine_enough"}
    assert more["elsewhere"] == {"elements_agree_with_calculix"}
    assert more["figure_3"] == more["figure_6_areas"] == {"finite elements"}
    for part, pieces in full.items():  # every piece has its own file
        assert len({name.replace(" ", "") for name in pieces}) == len(pieces), part


def test_results_of_other_code_are_not_reused_and_a_missing_number_is_refused(tmp_path, monkeypatch):
    def plan(value):
        return Plan(name="a", parts={"x": {"one": lambda: value}})

    assert plan(1).results(tmp_path) == {"x": [1]}
    monkeypatch.setattr("ballsocket.core.storage.pieces.fingerprint", lambda: "0.0.0+other")
    assert plan(2).results(tmp_path) == {"x": [2]}
    with pytest.raises(ValueError, match="x_one has a number that is missing"):
        plan(float("nan")).results(tmp_path / "other")


def claim_of(numbers, **fields):
    return Claim(name="a-claim-of-0.4", source="", statement="", quantity=lambda reference: numbers, **fields)


@pytest.mark.parametrize(
    ("numbers", "fields", "text"),
    [
        ({"a, %": -2.0, "b, %": 1.0}, {}, "holds"),
        ({"a, %": -2.1, "b, %": 1.0}, {}, "holds within 2.1 %"),
        ({"a, %": 5.0}, {}, "holds within 5 %"),
        ({"a, %": 5.1}, {}, "does not hold: 5.1 %"),
        ({"a": 3.0, "b": 8.0}, {"expected": (3.0, 8.0), "tolerance": EXACTLY}, "holds"),
        ({"a": 2.9, "b": 8.0}, {"expected": (3.0, 8.0), "tolerance": EXACTLY}, "does not hold"),
        ({"a": 3.0, "b": 8.4}, {"expected": (3.0, 8.0), "tolerance": (0.1, 1.0), "unit": "°"}, "holds within 0.4 °"),
        ({"a": 3.0, "b": 99.0}, {"expected": {"a": (3.0, 3.0)}}, "holds"),
        ({"a": 3.0}, {"expected": lambda numbers: numbers["a"] > 3}, "does not hold"),
        (Evaluation({"a": 1.0}, holds=False), {"expected": {}}, "does not hold"),
        (Evaluation({"a": 9.0}, holds=True), {}, "does not hold: 9 %"),
    ],
)
def test_verdicts_follow_from_expected_values_and_tolerance(numbers, fields, text):
    assert judge(claim_of(numbers, **fields), EXACT).text == text


def test_a_claim_is_found_by_its_name():
    assert claim_of({}).identifier == "a_claim_of_0_4"
    with pytest.raises(KeyError, match="claim 'wide-half-angel' is not known; did you mean 'wide-half-angle'"):
        claims.claim("wide-half-angel")
