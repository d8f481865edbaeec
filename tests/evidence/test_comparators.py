"""Comparators: published numbers, our results, and the applicability to a question."""

import math

import numpy as np
import pytest

from ballsocket import Exact
from ballsocket.evidence import comparators
from ballsocket.evidence.comparators import CLAIMS, PUBLISHED, SIMILARITY, applicability, claim, similarity_ranges
from ballsocket.problem import Joint, Layer, Material
from ballsocket.problem.presets import ALUMINA, COCR, UHMWPE, joints

HIP = joints["hip-36"]
NEEDED = similarity_ranges([(HIP, 2000.0), (HIP.replace(clearance=0.05), 3000.0)])


@pytest.fixture(scope="module")
def published():
    return {name: make() for name, make in PUBLISHED.items()}


def test_hertz_is_within_a_seventh_for_a_ceramic_insert(published):
    pressure, area, width = published["mak"].ours.values()
    assert pressure == (pytest.approx(1 - 1 / 7, abs=0.02), pytest.approx(1.0, abs=0.01))
    assert area == (pytest.approx(1.0, abs=0.01), pytest.approx(1.1, abs=0.01))
    assert width[1] == pytest.approx(1.0, abs=0.1)
    assert_reaches(published["mak"], ALUMINA, 2500.0, radii=(14.0, 18.0), clearances=(0.02, 0.08), walls=(5.0, 5.0))


def assert_reaches(comparator, liner, force, radii, clearances, walls):
    """Check the similarity ranges of joints from their smallest and largest sizes."""
    (small, large), reaches = radii, comparator.reaches
    assert reaches["c/R1"] == pytest.approx((clearances[0] / large, clearances[1] / small))
    assert reaches["R1/L"] == pytest.approx((small / walls[1], large / walls[0]))
    assert reaches["F/(E R1²)"] == pytest.approx([force / (liner.young * radius**2) for radius in (large, small)])


def test_comparators_apply_by_the_range_of_their_joints(published):
    assert applicability(published["durom"].reaches, NEEDED, tilted=False)["verdict"] == "does not apply"
    assert applicability(published["anderson"].reaches, NEEDED, tilted=False)["verdict"] == "does not apply"
    around = {name: (0.9 * low, 1.1 * high) for name, (low, high) in NEEDED.items()}
    assert applicability(around, NEEDED, tilted=False)["text"] == "applies"
    tilted = applicability(around, NEEDED, tilted=True)["text"]
    assert tilted == "applies in part: a tilted load against one along the axis"
    thick = applicability({**around, "R1/L": (8.0, 9.0)}, NEEDED, tilted=False)
    assert thick["where"]["R1/L"] == "outside"
    assert thick["text"] == "applies in part: R1/L 3.6 against 8 to 9"


@pytest.mark.parametrize("name", CLAIMS)
def test_claims_have_the_similarity_ranges_of_their_joints(name):
    result = claim(name)
    assert result["call"] == f"ballsocket.evidence.comparators.claim({name!r})"
    reaches = result["reaches"]
    assert set(reaches) == set(SIMILARITY)
    assert applicability(reaches, NEEDED, tilted=False)["verdict"] != "does not apply"


def test_similarity_numbers_are_those_of_the_joint_and_similar_joints_have_equal_ones_and_half_angles():
    joint = Joint(ball_radius=20.0, clearance=0.1, liner_thickness=5.0, liner=UHMWPE, ball=COCR)
    soft_ball = joint.replace(ball=Material(young=10 * UHMWPE.young, poisson=0.3))
    numbers = similarity_ranges([(joint, 1000.0)])
    assert [*numbers["c/R1"], *numbers["R1/L"]] == pytest.approx([0.005, 0.005, 4.0, 4.0])
    assert numbers["F/(E R1²)"] == pytest.approx((1000.0 / (UHMWPE.young * 400.0),) * 2)
    assert numbers["E/E of the ball"] == (0.0, 0.0)  # less than a fiftieth
    assert similarity_ranges([(soft_ball, 1000.0)])["E/E of the ball"] == pytest.approx((0.1, 0.1))
    assert similarity_ranges([(joint.replace(ball=None), 1.0)])["E/E of the ball"] == (0.0, 0.0)
    both = similarity_ranges([(joint, 1000.0), (joint, np.array([500.0, np.nan]))])["F/(E R1²)"]
    assert both == pytest.approx((500.0 / (UHMWPE.young * 400.0), 1000.0 / (UHMWPE.young * 400.0)))
    # lengths twice as large and moduli three times: the same numbers at twelve times the force
    liner = Material(young=3 * UHMWPE.young, poisson=UHMWPE.poisson)
    ball = Material(young=3 * COCR.young, poisson=COCR.poisson)
    small = Joint(ball_radius=14.0, clearance=0.1, liner_thickness=6.0, liner=UHMWPE, ball=COCR)
    large = Joint(ball_radius=28.0, clearance=0.2, liner_thickness=12.0, liner=liner, ball=ball)
    numbers, scaled = similarity_ranges([(small, 2000.0)]), similarity_ranges([(large, 24000.0)])
    assert all(numbers[name] == pytest.approx(scaled[name]) for name in SIMILARITY)
    half_angle = Exact().press(large, force=24000.0).half_angle
    assert Exact().press(small, force=2000.0).half_angle == pytest.approx(half_angle)


def test_verdict_follows_from_the_overlap_of_ranges():
    part, none = ("in part", "applies in part"), ("outside", "does not apply")
    overlaps = {(2.0, 3.0): ("within", "applies"), (2.5, 3.0): part, (1.0, 2.5): part, (2.0, 2.0): part}
    overlaps |= {(3.0, 3.0): part, (3.5, 4.0): none, (1.0, 1.5): none}
    for reached, (position, verdict) in overlaps.items():
        result = applicability({"ν": reached}, {"ν": (2.0, 3.0)}, tilted=False)
        assert (result["where"], result["verdict"]) == ({"ν": position}, verdict)
    two = {"ν": (0.4, 0.4), "E/E of the ball": (0.0, 0.0)}  # half of the numbers outside, and those of a soft ball
    assert applicability({**two, "ν": (0.3, 0.3)}, two, tilted=False)["verdict"] == "applies in part"
    assert applicability({**two, "E/E of the ball": (0.5, 0.5)}, two, tilted=False)["verdict"] == "does not apply"


def test_ranges_of_a_question_include_its_tolerances(pack):
    from ballsocket.evidence.matrix import MatrixRow

    question, record, _ = pack
    ranges = comparators.question_ranges(question, [MatrixRow.of(row) for row in record["matrix"]])
    assert ranges["c/R1"] == pytest.approx((0.05 / 17.9, 0.15 / 17.9), rel=0.02)
    low, high = ranges["F/(E R1²)"]
    radius = question.file.joint.ball_radius
    assert low < 2000.0 / (750.0 * radius**2) < 4000.0 / (750.0 * radius**2) < high
    assert high == pytest.approx(4000.0 / (675.0 * radius**2), rel=0.06)


def test_resurfacing_has_the_published_pressure_and_a_smaller_area(published):
    """Wall 3.5 to 4.5 mm of cobalt-chromium on bone of 0.3 to 1 GPa, head 50 mm, bore 50.145 mm, 3200 N."""
    durom = published["durom"]
    assert_reaches(durom, COCR, 3200.0, radii=(25.0, 25.0), clearances=(0.0725, 0.0725), walls=(3.5, 4.5))
    low, high = durom.ours["largest pressure, MPa"]
    assert low < 22 < high
    small, large = (area / 237 for area in durom.ours["contact area, mm²"])
    assert (small, large) == (pytest.approx(2 / 3, abs=0.02), pytest.approx(7 / 8, abs=0.02))
    bone = Layer(thickness=math.inf, material=Material(young=300.0, poisson=0.3))  # the softest bone, the thickest wall
    shell = Joint(ball_radius=25.0, clearance=0.0725, liner_thickness=4.5, liner=COCR, ball=COCR, backing=(bone,))
    assert low < Exact().press(shell, force=3200.0).max_pressure < high


def test_pressure_of_the_inlay_depends_on_its_wall(published):
    """Wall 2 to 4 mm on 3 to 5 mm of polyethylene, head 28 mm, bore 28.12 mm, 3200 N."""
    low, high = published["metasul"].ours["largest pressure, MPa"]
    assert low < 47 < high
    assert high > 2 * low
    assert published["metasul"].reaches["R1/L"] == pytest.approx((3.5, 7.0))


def test_pressure_of_a_3_mm_liner_exceeds_that_of_12_mm_by_41_to_69_percent(published):
    kurtz = published["kurtz"]
    (ratio,) = kurtz.ours.values()
    assert ratio == (pytest.approx(1.41, abs=0.005), pytest.approx(1.69, abs=0.005))
    assert "41 to 69 %" in kurtz.agreement
    assert_reaches(kurtz, UHMWPE, 2500.0, radii=(11.0, 16.0), clearances=(0.05, 0.2), walls=(3.0, 12.0))
    liner = Joint(ball_radius=14.0, clearance=0.1, liner_thickness=3.0, liner=UHMWPE, ball=COCR)
    thin, thick = (Exact().press(liner.replace(liner_thickness=wall), force=2500.0) for wall in (3.0, 12.0))
    assert ratio[0] < thin.max_pressure / thick.max_pressure < ratio[1]


def test_strain_of_a_ptfe_liner_at_its_limit_is_a_sixth(published):
    (strain,) = published["ptfe"].ours.values()
    assert strain[0] < 100 / 6 < strain[1]
    assert strain == pytest.approx((482 / 31.0264, 541 / 31.0264), rel=1e-4)
