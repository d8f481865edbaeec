"""Credibility levels, and the rows of requirements, for changed records."""

import re
from itertools import product
from operator import itemgetter

import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.evidence.credibility import FACTORS, assess, model_risk
from ballsocket.evidence.credibility_levels import error_margins

CONDITIONS, EQUIVALENCY, OUTPUTS = "test conditions", "equivalency of input parameters", "output comparison"
CODE, FORM, SOLVER = "numerical code verification", "model form", "numerical solver error"
QUANTITIES, SAMPLES = "relevance of the quantities of interest", "test samples"
RELEVANCE = "relevance of the validation activities to the context of use"


def factor(record, name):
    return {row["factor"]: row for row in assess(record)["credibility"]}[name]


def reached(record, name):
    return factor(record, name)["reached"]


def apply_only(record, name, verdict="applies", force="within"):
    for comparator in (*record["claims"], *record["comparators"]):
        comparator["applicability"]["verdict"] = "does not apply"
        if comparator["name"] == name:
            comparator["applicability"]["verdict"] = verdict
            comparator["applicability"]["where"]["F/(E R1²)"] = force


def test_model_risk_is_the_sum_of_the_steps_of_influence_and_consequence():
    levels, ranks = ("low", "medium", "high"), ("low", "low to medium", "medium", "medium to high", "high")
    for (i, influence), (c, consequence) in product(enumerate(levels), repeat=2):
        risk = model_risk(influence, consequence)
        assert (risk["rank"], risk["level"]) == (i + c + 1, ranks[i + c])


def test_goals_rise_with_the_risk_and_exist_in_their_gradation(record):
    assert len(FACTORS) == len(record["credibility"]) == 13
    assert all(row["supported_by"] and row["missing"] for row in record["credibility"])
    for item in FACTORS:
        assert list(item.goals) == sorted(item.goals)
        assert len(item.goals) == 5
        assert ord(item.goals[-1]) - ord("a") < len(item.gradation)
    results = [assess({**record, "risk": model_risk(level, "medium")}) for level in ("low", "medium", "high")]
    goals = [[row["goal"] for row in result["credibility"]] for result in results]
    assert goals[0] < goals[1] < goals[2]
    met = [result["adequacy"]["met"] for result in results]
    assert met[0] > met[1] > met[2]
    levels = {"".join(row["reached"] for row in result["credibility"]) for result in results}
    assert re.fullmatch("bc[cd][cd]acbacbbbb", *levels)
    for result in results:
        short = [row["factor"] for row in result["credibility"] if row["reached"] < row["goal"]]
        adequacy = result["adequacy"]
        assert (adequacy["not_met"], adequacy["met"], adequacy["of"]) == (short, 13 - len(short), 13)


@pytest.mark.parametrize(
    ("name", "verdict", "force", "levels"),
    [
        ("kurtz", "applies", "within", "cabac"),  # its inputs are assumed
        ("kurtz", "applies", "in part", "babac"),
        ("kurtz", "applies", "outside", "aabac"),
        ("kurtz", "applies in part", "within", "cabab"),
        ("kurtz", "does not apply", "within", "aaaaa"),
        ("half-angles-of-jin", "applies", "within", "ccbac"),
        ("half-angles-of-jin", "applies in part", "within", "cbbab"),
        ("anderson", "applies", "within", "ccabc"),  # without numbers, measured on joints like these
        ("nothing", "applies", "within", "aaaaa"),
    ],
)
def test_levels_of_the_comparison_follow_from_applying_comparators(record, name, verdict, force, levels):
    apply_only(record, name, verdict, force)
    rows = [factor(record, subject) for subject in (CONDITIONS, EQUIVALENCY, OUTPUTS, SAMPLES, RELEVANCE)]
    assert "".join(row["reached"] for row in rows) == levels
    assert ("a comparator whose range includes all cases" in rows[4]["missing"]) == (levels[4] == "b")
    measured = rows[3]["supported_by"].split(",")[1] == " 1 of them measured on joints like these"
    assert measured == (levels[3] == "b")


@pytest.mark.parametrize(
    ("names", "level"),
    [(["max_pressure"], "c"), (["max_pressure", "edge_distance"], "b"), (["edge_distance"], "a"), ([], "c")],
)
def test_relevance_of_quantities_follows_from_the_limits(record, names, level):
    record["limits"] = [{**record["limits"][0], "name": name} for name in names]
    if not names:
        record["worst"] = {"max_pressure": None, "half_angle": None}  # without limits the worst numbers count
    assert reached(record, QUANTITIES) == level


def test_sources_and_tolerances_raise_the_levels_of_the_inputs(record):
    assert (reached(record, "use error"), reached(record, "model inputs")) == ("a", "b")
    for row in record["inputs"]:
        row["source"] = "drawing"
    assert (reached(record, "use error"), reached(record, "model inputs")) == ("b", "b")
    missing = "a tolerance for the ball radius, liner thickness, Poisson's ratio of the liner"
    assert missing in factor(record, "model inputs")["missing"]
    for row in record["inputs"]:
        row["tolerance"] = "1 to 2"
    assert reached(record, "model inputs") == "c"
    record["uncertainty"] = None
    assert reached(record, "model inputs") == "a"


def test_calculix_raises_the_level_of_the_solver(record):
    assert reached(record, SOLVER) in "cd"
    methods = record["calculation"][0]["methods"]
    methods.append({**methods[0], "name": "CalculiX"})
    for deviation, level in ((0.0, "d"), (0.049, "d"), (0.051, "b")):  # the required accuracy is 5 %
        record["calculation"][0]["deviation"]["area"] = deviation
        assert reached(record, SOLVER) == level
    for calculation in record["calculation"]:
        calculation["deviation"] = {}
    assert reached(record, SOLVER) == reached({**record, "calculation": []}, SOLVER) == "a"


def test_finite_elements_with_their_order_raise_the_level_of_the_code(record):
    checks, methods = record["code_verification"], record["calculation"][0]["methods"]
    for check in checks:
        check["passed"] = True
    methods[:] = [method for method in methods if not method["name"].startswith("finite")]
    assert reached(record, CODE) == "c"
    assert reached({**record, "model": {**record["model"], "name": "sphere"}}, CODE) == "b"  # no order of convergence
    methods.append({**methods[0], "name": "finite elements"})
    for valid, level in ((True, "d"), (False, "c"), (True, "d")):
        methods[-1]["valid"] = valid
        assert reached(record, CODE) == level
    checks[-1].update(passed=None)
    row = factor(record, CODE)
    assert (row["reached"], "not run: order-of-elements" in row["missing"]) == ("c", True)
    assert row["supported_by"] == "7 of 7 checks passed on this machine"
    for check in checks:
        check["passed"] = check["name"] != "own-tolerance" or None
    assert reached(record, CODE) == "b"
    checks[0]["passed"] = False
    assert reached(record, CODE) == reached(record, "software quality assurance") == "a"
    assert reached({**record, "code_verification": []}, CODE) == "a"


@pytest.mark.parametrize(
    ("change", "level", "missing"),
    [
        (lambda record: None, "c", "plasticity"),
        (lambda record: record["matrix"][0].update(valid=False), "b", "outside the range of the model: 1 of 4 cases"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=None), "b", "strength not checked"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=1.01), "b", "exceeds the yield stress"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=0.99), "c", "plasticity"),
        (lambda record: record.update(calculation=[]), "a", "a second body or method"),
    ],
)
def test_model_form_follows_from_the_methods_and_the_strength(record, change, level, missing):
    change(record)
    row = factor(record, FORM)
    assert (row["reached"], missing in row["missing"]) == (level, True)


def test_discretization_level_follows_from_the_error_bars(record):
    def level_and_gap():
        return itemgetter("reached", "missing")(factor(record, "discretization error"))

    assert level_and_gap() == ("d", "nothing")
    for row in record["matrix"]:
        row["bars"] = {"utilisation": row["bars"]["utilisation"]}  # only some numbers have an error of the solver
    assert level_and_gap() == ("b", "an error bar for the edge distance, or a margin to the limit")
    record["limits"] = record["limits"][:1]  # of the largest pressure, which has one
    assert level_and_gap() == ("d", "nothing")
    first = record["matrix"][0]
    first["errors"]["max_pressure"] = 0.04
    record["limits"][0]["high"] = first["numbers"]["max_pressure"] * 1.01
    level, gap = level_and_gap()
    assert (level, "a verdict could change" in gap) == ("c", True)
    first["errors"]["max_pressure"] = 0.4
    assert level_and_gap()[0] == "b"
    for row in record["matrix"]:
        row["errors"] = {}
    assert level_and_gap()[0] == "a"


def test_an_error_margin_is_the_error_over_the_distance_to_the_limit_and_more_than_all_of_it_is_a_gap(record):
    record["limits"] = record["limits"][:1]
    for error, status in ((0.51, "not met"), (0.49, "met"), (0.05, "met")):
        for row in record["matrix"]:
            row["numbers"]["max_pressure"], row["errors"]["max_pressure"] = 10.0, error
            row["bars"].pop("max_pressure", None)
        assert rows(record)["E1"]["status"] == status
    assert error_margins(record)[0]["share"] == pytest.approx(0.5 / 5.0)
    record["limits"][0].update(low=9.0)
    assert error_margins(record)[0]["share"] == pytest.approx(0.5 / 1.0)
    record["matrix"][0]["bars"]["max_pressure"] = [9.8, 10.8]  # the larger of error and error bar counts
    assert error_margins(record)[0]["share"] == pytest.approx(0.8 / 1.0)
    for pressure in (15.0, None):  # no margin
        record["matrix"][0]["numbers"]["max_pressure"] = pressure
        assert error_margins(record)[0]["share"] is None


def rows(record):
    return {row["id"]: row for row in assess(record)["requirements"]}


def test_rows_state_gap_and_evidence(record):
    table = rows(record)
    groups = {"L": 2, "A": 1, "E": 2, "U": 2, "V": 8, "I": 10, "F": 13}
    assert list(table) == [f"{letter}{number}" for letter, count in groups.items() for number in range(1, count + 1)]
    statuses = {name: table[name]["status"] for name in ("L1", "L2", "U1", "U2")}
    assert statuses == {"L1": "not met", "L2": "met", "U1": "not met", "U2": "not known"}  # bands exceed 15 MPa
    assert table["L1"]["gap"] == "1 case beyond the limit"
    for name in ("E1", "E2"):
        assert table[name]["evidence"].endswith(" % of the margin")
    places = {"U1": "uncertainty.bands", "V1": "code_verification[0]", "F13": "credibility[12]"}
    assert {name: table[name]["where"] for name in places} == places
    assert all((row["gap"] == "") == (row["status"] == "met") for row in table.values())
    without = [row for row in table.values() if row["id"].startswith("I") and row["status"] == "not met"]
    gap = ("source of the coefficient of friction", "a source in [sources]")
    assert [(row["requirement"], row["gap"]) for row in without] == [gap]
    record["limits"][1]["verdict"] = "undecided"
    assert rows(record)["L2"]["status"] == "not known"


@pytest.mark.parametrize(
    ("low", "high", "status"),
    [(None, 16.0, "met"), (None, 15.5, "not met"), (15.0, None, "met"), (15.5, None, "not met"), (15.0, 16.0, "met")],
)
def test_the_band_lies_within_the_limit(record, low, high, status):
    record["limits"][0].update(low=low, high=high)
    assert rows(record)["U1"]["status"] == status
    record["uncertainty"] = None
    assert rows(record)["U1"]["status"] == "not known"


@pytest.mark.parametrize(
    ("largest", "status", "evidence"),
    [(0.01, "met", "1 % at most"), (0.1, "not met", "10 % at most"), (None, "not known", "no error bar and no")],
)
def test_the_accuracy_is_a_row(record, largest, status, evidence):
    record["accurate"].update(largest=largest, holds=status == "met")
    row = rows(record)["A1"]
    assert row["status"] == status
    assert row["evidence"].startswith(evidence)
