"""The paper recomputed: its claims, its figures, the accuracy of the catalogue, and a report that resumes."""

import json
import re
from importlib import import_module

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.output import accuracy_table
from ballsocket.paper import cases, claims, curves
from ballsocket.paper.accuracy import FORCES, accuracies, edge_joints, paper_joints
from ballsocket.paper.claims import agreement, elsewhere
from ballsocket.paper.figure import Figure
from ballsocket.paper.plan import Plan, full_plan, quick_plan

from .. import extent
from ..places import DATA, ROOT

README = ROOT / "README.md"
ACCURACY = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))

EXACT = bs.Exact(tolerance=1e-4)
FEW = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}


@pytest.fixture(scope="module")
def ledger():
    return {finding.name: finding for finding in claims.ledger(EXACT, claims.CLAIMS + claims.ELSEWHERE)}


def test_every_finding_names_the_function_that_made_it(ledger):
    for name, finding in ledger.items():
        module, function = finding.code.rsplit(".", 1)
        assert function == name.replace("-", "_").replace(".", "_")
        assert callable(getattr(import_module(module), function))
    assert json.loads(json.dumps([finding.summary() for finding in ledger.values()]))
    assert all(np.isfinite(list(finding.numbers.values())).all() for finding in ledger.values())


def test_both_older_models_overestimate_as_the_paper_says(ledger):
    numbers = ledger["overestimated-pressure"].numbers
    assert numbers["Bartel, %"] == pytest.approx(17.0, abs=1.0)
    assert numbers["bonded layer, %"] == pytest.approx(25.0, abs=1.5)


def test_what_holds_and_what_does_not(ledger):
    held = {name for name, finding in ledger.items() if finding.verdict is claims.Verdict.HOLDS}
    assert held >= {"hertz-is-inadequate", "stiffness-and-geometry", "unbounded-moduli", "lowest-pressure"}
    failed = {name for name, finding in ledger.items() if finding.verdict is claims.Verdict.FAILS}
    assert failed == {
        "constant-at-0.49",
        "independent-of-clearance-at-0.49",
        "quality-of-the-fit-on-thin-liners",
        "varies-below-one-kilonewton",
    }
    assert ledger["quality-of-the-fit"].text == "holds within 3.3 %"
    assert all(ledger[name].comment for name in failed)


def test_finite_elements_give_the_same_verdict_on_figure_4(ledger):
    by_elements = agreement.overestimated_pressure(bs.FiniteElement(meshes=1))
    for name, value in ledger["overestimated-pressure"].numbers.items():
        assert by_elements.numbers[name] == pytest.approx(value, abs=0.3)


def test_numbers_of_others(ledger):
    exact = ledger["exact-agrees-with-calculix"].numbers
    assert exact["peak pressure off by, %"] < 0.2
    assert exact["half angle off by, °"] < 0.1
    assert ledger["ordering-of-plank"].verdict is claims.Verdict.HOLDS
    angles = ledger["half-angles-of-jin"].numbers.values()
    assert 35 < min(angles) < max(angles) < 55


def test_calculix_table_is_the_reference_file():
    cases_of_file = json.loads((DATA / "calculix.json").read_text(encoding="utf-8"))["cases"]
    forces = [step["force"] for case in cases_of_file for step in case["linearised"]]
    np.testing.assert_array_equal(elsewhere.calculix()["force"], forces)


@pytest.mark.long
def test_the_papers_mesh_is_fine_enough_and_calculix_agrees_with_elements():
    found = [claim(EXACT) for claim in claims.MESHED_CLAIMS + claims.MESHED_ELSEWHERE]
    assert [finding.verdict for finding in found] == [claims.Verdict.HOLDS] * 2
    elements = found[0].numbers
    assert 66_000 < elements["elements"] < 73_000  # the paper: 27 000 in the head, 40 000 in the liner
    assert elements["twice as many"] / elements["elements"] == pytest.approx(2.0, abs=0.05)


def test_figures_survive_their_files():
    for figure in (
        curves.figure_2(0.4, {"exact": EXACT}),
        curves.figure_3_or_4(3, FEW),
        curves.figure_5("head radius", "R1 11 mm", FEW),
        curves.figure_6("hess-forsbach", bs.HessForsbach(), points=7),
        curves.figure_6_areas("bartel", bs.Bartel(), bs.HessForsbach(), points=7),
    ):
        assert Figure.of(json.loads(json.dumps(figure.summary()))) == figure


def test_figure_2_has_the_published_fit_and_the_reference_for_each_poisson_ratio():
    panels = Figure.joined(curves.figure_2(poisson, {"exact": EXACT}) for poisson in cases.POISSON).panels
    assert [panel.title for panel in panels] == ["by force", "by clearance", "by R2/L"]
    for panel in panels:
        assert len(panel.lines) == 10
    fit, reference = (
        next(line for line in panels[2].lines if line.case == "ν 0.4" and line.model.startswith(model))
        for model in ("Eq.", "exact")
    )
    np.testing.assert_allclose(fit.y[1:5], reference.y[1:5], rtol=0.015)


def test_figure_5_shows_the_pressure_over_the_arc_where_the_radius_varies():
    force, pressure = curves.figure_5("head radius", "R1 23 mm", FEW).panels
    assert "R1 φ [mm]" in pressure.x
    contact = bs.HessForsbach().press(curves.SERIES["head radius"]["R1 23 mm"], force=3000.0)
    line = next(line for line in pressure.lines if line.model == "hess-forsbach")
    assert line.x[-1] == pytest.approx(23.0 * contact.half_angle)
    assert line.y[0] == pytest.approx(contact.max_pressure)
    assert all(force.lines[0].x[i] < force.lines[0].x[i + 1] for i in range(10))


def test_deviations_over_the_map_are_those_of_single_presses():
    figure = curves.figure_6_pressures("bartel", bs.Bartel(), bs.HessForsbach(), points=7)
    each = figure.maps[0]
    i, j = each.y.index(7.0), each.x.index(15.0)
    joint = cases.joint(head_radius=15.0, liner_thickness=7.0)
    pressures = [model.press(joint, force=3000.0).max_pressure for model in (bs.Bartel(), bs.HessForsbach())]
    assert each.z[i][j] == pytest.approx(100 * (pressures[0] / pressures[1] - 1))
    assert each.z[0][0] is None  # R1 11, L 3: below every outer radius


def worst_joints():
    """Those on which some model is worst, as arrays: the worst of a model over them is its worst over all joints."""
    places = [error["worst_at"]["joint"] for row in ACCURACY for error in row["errors"].values()]
    lengths = ("ball_radius", "clearance", "liner_thickness")
    numbers = {(*(place[name] for name in lengths), place["liner"]["poisson"]) for place in places}
    *sizes, poisson = np.array(sorted(numbers)).T
    liner = bs.Material(young=1000.0, poisson=poisson)
    return bs.Joint(**dict(zip(lengths, sizes, strict=True)), liner=liner, ball=bs.STEEL)


def test_no_model_has_become_worse_or_better():
    worst = worst_joints()
    found = accuracies() if extent.whole else accuracies(joints=worst, edges=worst)
    rows = {row.model: row.summary()["errors"] for row in found}
    ranked = [before["model"] for before in ACCURACY]
    assert list(rows) == ranked if extent.whole else set(rows) == set(ranked)
    for before in ACCURACY:
        for name, error in rows[before["model"]].items():
            assert error["worst"] == pytest.approx(before["errors"][name]["worst"], rel=1e-3), (before["model"], name)


@pytest.mark.parametrize("row", ACCURACY, ids=lambda row: row["model"])
def test_the_readme_has_the_error_of_the_largest_pressure(row):
    """Median and worst error in percent are the last cell of the model's row."""
    error = row["errors"]["max_pressure"]
    cell = " / ".join(dict.fromkeys(accuracy_table.percent(error[name]) for name in ("median", "worst")))
    (line,) = re.findall(rf"^\| `{row['model']}` \|.*$", README.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert line.endswith(f" | {cell} |")


def test_accuracies_are_ranked_and_name_their_worst_joint():
    joints = paper_joints(32)
    rows = {row.model: row for row in accuracies({**FEW, "hertz": bs.Hertz(), "refined": bs.Refined()}, joints, joints)}
    assert list(rows) == ["refined", "hess-forsbach", "hertz"]
    spread = rows["hess-forsbach"].spreads["max_pressure"]
    assert spread.median < spread.high < spread.worst < 0.25
    again = bs.HessForsbach().press(spread.joint, force=spread.load).max_pressure
    truth = bs.Exact().press(spread.joint, force=spread.load).max_pressure
    assert abs(again / truth - 1) == pytest.approx(spread.worst, rel=1e-3)
    assert spread.load in FORCES
    assert rows["hertz"].valid == 0


def test_the_worst_is_looked_for_on_the_ends_of_the_ranges():
    few = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}
    within, ends = paper_joints(16), edge_joints()
    (inner,) = accuracies(few, within, within)
    (whole,) = accuracies(few, within, ends)
    for name, spread in whole.spreads.items():
        assert spread.median == inner.spreads[name].median
        assert spread.worst >= inner.spreads[name].worst
    outer = ends.socket_radius + ends.liner_thickness
    assert outer.min() >= 16 - 1e-9
    assert outer.max() <= 26 + 1e-9
    assert set(ends.ball_radius.round(9)) == {11.0, 16.9, 22.8}
    assert (ends.socket_radius / ends.liner_thickness).max() > 7.6


def test_joints_fill_the_papers_ranges():
    joints = paper_joints(256)
    outer = joints.socket_radius + joints.liner_thickness
    assert joints.ball_radius.min() < 12 < 22 < joints.ball_radius.max()
    assert outer.min() >= 16 - 1e-9
    assert outer.max() <= 26 + 1e-9
    assert joints.liner_thickness.min() >= 3
    assert joints.liner_thickness.max() <= 15


def test_a_run_goes_on_where_it_stopped(tmp_path):
    asked = []

    def piece(name, value):
        def compute():
            asked.append(name)
            if value is None:
                raise KeyboardInterrupt
            return value

        return compute

    with pytest.raises(KeyboardInterrupt):
        Plan(name="a", parts={"x": {"one": piece("one", 1), "two": piece("two", None)}}).results(tmp_path)
    done = Plan(name="a", parts={"x": {"one": piece("one", 1), "two": piece("two", 2)}})
    heard = []
    assert done.results(tmp_path, heard.append) == {"x": [1, 2]}
    assert heard == ["x one", "x two"]
    assert asked == ["one", "two", "two"]
    (tmp_path / "a" / "x_one.json").write_text('{"key": "half of', encoding="utf-8")
    assert done.results(tmp_path) == {"x": [1, 2]}
    assert asked == ["one", "two", "two", "one"]
    other = Plan(name="b", parts={"x": {"one": piece("one", 3)}})
    assert other.results(tmp_path) == {"x": [3]}
    assert done.results(tmp_path) == {"x": [1, 2]}  # the other plan took nothing of it
    assert asked == ["one", "two", "two", "one", "one"]


def test_what_other_code_computed_is_not_taken(tmp_path, monkeypatch):
    plan = Plan(name="a", parts={"x": {"one": lambda: 1}})
    assert plan.results(tmp_path) == {"x": [1]}
    monkeypatch.setattr("ballsocket.paper.plan.fingerprint", lambda: "0.0.0+other")
    assert Plan(name="a", parts={"x": {"one": lambda: 2}}).results(tmp_path) == {"x": [2]}


def test_both_plans_have_the_same_parts_and_the_full_one_has_elements():
    quick, full = quick_plan().parts, full_plan().parts
    assert list(quick) == list(full)
    more = {part: set(full[part]) - set(quick[part]) for part in full}
    assert more["table_3"] == {f"finite elements {poisson:g}" for poisson in cases.POISSON}
    assert more["claims"] == {"mesh_is_fine_enough"}
    assert more["elsewhere"] == {"elements_agree_with_calculix"}
    assert more["figure_3"] == more["figure_6_areas"] == {"finite elements"}


def test_pieces_have_files_of_their_own():
    for part, pieces in full_plan().parts.items():
        assert len({name.replace(" ", "") for name in pieces}) == len(pieces), part


def test_a_number_that_is_missing_is_named(tmp_path):
    plan = Plan(name="a", parts={"x": {"one": lambda: float("nan")}})
    with pytest.raises(ValueError, match="x_one has a number that is missing"):
        plan.results(tmp_path)
