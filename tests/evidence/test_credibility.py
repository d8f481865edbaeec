"""Credibility levels, and the rows of requirements, for changed records."""

import pytest

pytest.importorskip("xarray", reason="the extra for studies is not installed")
from ballsocket.evidence.credibility import FACTORS, assess, gaps, model_risk
from ballsocket.evidence.credibility_levels import error_margins

CONDITIONS, EQUIVALENCY, OUTPUTS = "test conditions", "equivalency of input parameters", "output comparison"
QUANTITIES = "relevance of the quantities of interest"
RELEVANCE = "relevance of the validation activities to the context of use"


def factor(record, name):
    return {row["factor"]: row for row in assess(record)["credibility"]}[name]


def reached(record, name):
    return factor(record, name)["reached"]


def apply_only(record, name, verdict="applies", force="within"):
    """Let one comparator apply, and no other."""
    for comparator in (*record["claims"], *record["comparators"]):
        chosen = comparator["name"] == name
        comparator["applicability"]["verdict"] = verdict if chosen else "does not apply"
        if chosen:
            comparator["applicability"]["where"]["F/(E R1²)"] = force
    return record


@pytest.mark.parametrize("rank", range(1, 6))
def test_model_risk_is_the_sum_of_the_steps_of_influence_and_consequence(rank):
    levels = ("low", "medium", "high")
    pairs = [(i, c) for i in range(3) for c in range(3) if i + c + 1 == rank]
    names = ("low", "low to medium", "medium", "medium to high", "high")
    for influence, consequence in pairs:
        risk = model_risk(levels[influence], levels[consequence])
        assert (risk["rank"], risk["level"]) == (rank, names[rank - 1])


def test_a_higher_risk_sets_higher_goals(record):
    risks = [{**record, "risk": model_risk(influence, "medium")} for influence in ("low", "medium", "high")]
    low, medium, high = map(assess, risks)
    goals = [[row["goal"] for row in result["credibility"]] for result in (low, medium, high)]
    assert goals[0] < goals[1] < goals[2]
    assert low["adequacy"]["met"] > medium["adequacy"]["met"] > high["adequacy"]["met"]
    levels = [[row["reached"] for row in result["credibility"]] for result in (low, medium, high)]
    assert levels[0] == levels[1] == levels[2]


def test_goals_rise_with_the_risk_and_exist_in_their_gradation(record):
    assert len(FACTORS) == len(record["credibility"]) == 13
    assert all(row["supported_by"] and row["missing"] for row in record["credibility"])
    for item in FACTORS:
        assert list(item.goals) == sorted(item.goals)
        assert len(item.goals) == 5
        assert ord(item.goals[-1]) - ord("a") < len(item.gradation)


def test_levels_of_the_small_pack(record):
    levels = "".join(row["reached"] for row in assess(record)["credibility"])
    assert levels in ("bcbcacbacbbbb", "bccdacbacbbbb")


@pytest.mark.parametrize(
    ("name", "verdict", "force", "subject", "level"),
    [
        ("kurtz", "applies", "within", CONDITIONS, "c"),
        ("kurtz", "applies", "in part", CONDITIONS, "b"),
        ("kurtz", "applies", "outside", CONDITIONS, "a"),
        ("kurtz", "does not apply", "", CONDITIONS, "a"),
        ("kurtz", "applies", "within", EQUIVALENCY, "a"),  # its inputs are assumed
        ("half-angles-of-jin", "applies", "within", EQUIVALENCY, "c"),
        ("half-angles-of-jin", "applies in part", "within", EQUIVALENCY, "b"),
        ("nothing", "applies", "within", EQUIVALENCY, "a"),
        ("kurtz", "applies", "within", OUTPUTS, "b"),
        ("half-angles-of-jin", "applies", "within", OUTPUTS, "b"),
        ("anderson", "applies", "within", OUTPUTS, "a"),  # without numbers
        ("nothing", "applies", "within", OUTPUTS, "a"),
    ],
)
def test_levels_of_the_comparison_follow_from_applying_comparators(record, name, verdict, force, subject, level):
    assert reached(apply_only(record, name, verdict, force), subject) == level


def test_a_measured_comparator_raises_the_level_of_the_samples(record):
    assert reached(record, "test samples") == "a"
    row = factor(apply_only(record, "anderson"), "test samples")
    assert (row["reached"], row["supported_by"].split(",")[1]) == ("b", " 1 of them measured on joints like these")


@pytest.mark.parametrize(("verdict", "level"), [("applies", "c"), ("applies in part", "b"), ("does not apply", "a")])
def test_relevance_follows_from_the_applicability(record, verdict, level):
    row = factor(apply_only(record, "kurtz", verdict), RELEVANCE)
    assert row["reached"] == level
    assert ("a comparator whose range includes all cases" in row["missing"]) == (level == "b")
    assert "not of these joints" in row["missing"]


@pytest.mark.parametrize(
    ("names", "level"),
    [(["max_pressure"], "c"), (["max_pressure", "edge_distance"], "b"), (["edge_distance"], "a"), (["force"], "c")],
)
def test_relevance_of_quantities_follows_from_the_limits(record, names, level):
    (limit, *_) = record["limits"]
    record["limits"] = [{**limit, "name": name} for name in names]
    if names == ["force"]:
        record["limits"] = []  # without limits the worst numbers count
        record["worst"] = {"max_pressure": None, "half_angle": None}
    assert reached(record, QUANTITIES) == level


def test_sources_and_tolerances_raise_the_levels_of_the_inputs(record):
    assert (reached(record, "use error"), reached(record, "model inputs")) == ("a", "b")
    for row in record["inputs"]:
        row["source"] = "drawing"
    assert (reached(record, "use error"), reached(record, "model inputs")) == ("b", "b")
    assert (
        "a tolerance for the ball radius, liner thickness, Poisson's ratio of the liner"
        in factor(record, "model inputs")["missing"]
    )
    for row in record["inputs"]:
        row["tolerance"] = "1 to 2"
    assert reached(record, "model inputs") == "c"
    record["uncertainty"] = None
    assert reached(record, "model inputs") == "a"


def test_calculix_raises_the_level_of_the_solver(record):
    assert reached(record, "numerical solver error") in "cd"
    methods = record["calculation"][0]["methods"]
    methods.append({**methods[0], "name": "CalculiX"})
    assert reached(record, "numerical solver error") == "d"
    for deviation, level in ((0.049, "d"), (0.051, "b")):  # the required accuracy is 5 %
        record["calculation"][0]["deviation"]["area"] = deviation
        assert reached(record, "numerical solver error") == level
    for calculation in record["calculation"]:
        calculation["deviation"] = {}
    assert reached(record, "numerical solver error") == "a"
    record["calculation"] = []
    assert reached(record, "numerical solver error") == "a"


def test_finite_elements_with_their_order_raise_the_level_of_the_code(record):
    for check in record["code_verification"]:
        check["passed"] = True
    methods = record["calculation"][0]["methods"]
    methods[:] = [method for method in methods if not method["name"].startswith("finite")]
    assert reached(record, "numerical code verification") == "c"
    methods.append({**methods[0], "name": "finite elements"})
    assert reached(record, "numerical code verification") == "d"
    methods[-1]["valid"] = False
    assert reached(record, "numerical code verification") == "c"
    methods[-1]["valid"] = True
    record["code_verification"][-1].update(passed=None)
    row = factor(record, "numerical code verification")
    assert (row["reached"], "not run: order-of-elements" in row["missing"]) == ("c", True)
    assert row["supported_by"] == "7 of 7 checks passed on this machine"
    for check in record["code_verification"]:
        check["passed"] = check["name"] != "own-tolerance" or None
    assert reached(record, "numerical code verification") == "b"
    record["code_verification"][0]["passed"] = False
    assert reached(record, "numerical code verification") == reached(record, "software quality assurance") == "a"
    record["code_verification"] = []
    assert reached(record, "numerical code verification") == "a"


def test_the_off_axis_solver_has_no_order_of_convergence(record):
    record["model"]["name"] = "sphere"
    assert reached(record, "numerical code verification") == "b"


@pytest.mark.parametrize(
    ("change", "level", "missing"),
    [
        (lambda record: None, "c", "plasticity"),
        (lambda record: record["matrix"][0].update(valid=False), "b", "1 of 4 cases lie outside the range"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=None), "b", "strength not checked"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=1.01), "b", "exceeds the yield stress"),
        (lambda record: record["matrix"][0]["numbers"].update(utilisation=0.99), "c", "plasticity"),
        (lambda record: record.update(calculation=[]), "a", "a second body or method"),
    ],
)
def test_model_form_follows_from_the_methods_and_the_strength(record, change, level, missing):
    change(record)
    row = factor(record, "model form")
    assert row["reached"] == level
    assert missing in row["missing"]


def test_discretization_level_follows_from_the_error_bars(record):
    subject = "discretization error"
    assert (reached(record, subject), factor(record, subject)["missing"]) == (
        "b",
        "an error bar for the edge distance, or a margin to the limit",
    )
    record["limits"] = record["limits"][:1]  # of the largest pressure, which has an error bar
    assert (reached(record, subject), factor(record, subject)["missing"]) == ("d", "nothing")
    record["matrix"][0]["errors"]["max_pressure"] = 0.04
    record["limits"][0]["high"] = record["matrix"][0]["numbers"]["max_pressure"] * 1.01
    assert reached(record, subject) == "c"
    assert "a verdict could change" in factor(record, subject)["missing"]
    record["matrix"][0]["errors"]["max_pressure"] = 0.4
    assert reached(record, subject) == "b"
    for row in record["matrix"]:
        row["errors"] = {}
    assert reached(record, subject) == "a"


def test_error_margin_is_the_error_over_the_distance_to_the_limit(record):
    record["limits"] = record["limits"][:1]
    for row in record["matrix"]:
        row["numbers"]["max_pressure"], row["errors"]["max_pressure"] = 10.0, 0.05
    assert error_margins(record)[0]["share"] == pytest.approx(0.5 / 5.0)
    record["limits"][0].update(low=9.0)
    assert error_margins(record)[0]["share"] == pytest.approx(0.5 / 1.0)
    record["matrix"][0]["numbers"]["max_pressure"] = 15.0
    assert error_margins(record)[0]["share"] is None  # no margin
    record["matrix"][0]["numbers"]["max_pressure"] = None
    assert error_margins(record)[0]["share"] is None


def rows(record):
    return {row["id"]: row for row in assess(record)["requirements"]}


def test_rows_state_gap_and_evidence(record):
    table = rows(record)
    assert list(table) == [
        *("L1", "L2", "A1", "E1", "E2", "U1", "U2"),
        *(f"V{number}" for number in range(1, 9)),
        *(f"I{number}" for number in range(1, 11)),
        *(f"F{number}" for number in range(1, 14)),
    ]
    statuses = {name: table[name]["status"] for name in ("L1", "L2", "U1", "U2")}
    assert statuses == {"L1": "not met", "L2": "met", "U1": "not met", "U2": "not known"}  # bands exceed 15 MPa
    assert table["L1"]["gap"] == "cases beyond the limit: 1; without a result: 0"
    assert table["E2"]["gap"] == "an error bar of the edge distance"
    assert table["A1"]["requirement"] == "error bars and deviations of methods within 5 %"
    assert table["A1"]["evidence"].endswith(" % at most")
    assert table["E1"]["evidence"].endswith(" % of the margin")
    assert [table[name]["where"] for name in ("U1", "V1", "F13")] == [
        *("uncertainty.bands", "code_verification[0]", "credibility[12]")
    ]
    assert table["I10"]["gap"] == "a source in [sources]"
    assert all((row["gap"] == "") == (row["status"] == "met") for row in table.values())
    without = [row for row in table.values() if row["id"].startswith("I") and row["status"] == "not met"]
    assert [row["requirement"] for row in without] == ["source of the coefficient of friction"]
    assert {row["id"] for row in gaps(record)} == {name for name, row in table.items() if row["status"] != "met"}
    record["limits"][1]["verdict"] = "not known"
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
    ("largest", "holds", "status"), [(0.01, True, "met"), (0.1, False, "not met"), (None, False, "not known")]
)
def test_the_accuracy_is_a_row(record, largest, holds, status):
    record["accurate"].update(largest=largest, holds=holds)
    row = rows(record)["A1"]
    assert row["status"] == status
    assert row["evidence"] == (
        "no error bar and no second method" if largest is None else f"{100 * largest:g} % at most"
    )


@pytest.mark.parametrize(("error", "status"), [(0.04, "met"), (0.49, "met"), (0.51, "not met"), (0.6, "not met")])
def test_an_error_larger_than_the_margin_is_a_gap(record, error, status):
    for row in record["matrix"]:
        row["numbers"]["max_pressure"], row["errors"]["max_pressure"] = 10.0, error
    assert rows(record)["E1"]["status"] == status


def test_adequacy_counts_the_factors(record):
    result = assess(record)
    short = [row["factor"] for row in result["credibility"] if row["reached"] < row["goal"]]
    assert result["adequacy"]["not_met"] == short
    assert (result["adequacy"]["met"], result["adequacy"]["of"]) == (13 - len(short), 13)
    assert result["adequacy"]["text"].startswith(f"{13 - len(short)} of 13 credibility factors reach the level")
