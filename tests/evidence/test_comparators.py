"""Comparators: published numbers, our results, and the applicability to a question."""

import math

import numpy as np
import pytest

from ballsocket import Exact
from ballsocket.evidence.comparators import (
    CLAIMS,
    PUBLISHED,
    SIMILARITY,
    applicability,
    claim,
    question_ranges,
    range_text,
    similarity_ranges,
)
from ballsocket.problem import Joint, Layer, Material
from ballsocket.problem.presets import ALUMINA, COCR, UHMWPE, joints

HIP = joints["hip-36"]
NEEDED = similarity_ranges([(HIP, 2000.0), (HIP.replace(clearance=0.05), 3000.0)])


@pytest.fixture(scope="module")
def published():
    return {name: make() for name, make in PUBLISHED.items()}


def test_comparators_state_the_read_part_the_inputs_and_the_assumptions(published):
    for name, comparator in published.items():
        assert comparator.read
        assert comparator.inputs
        assert comparator.published
        assert bool(comparator.assumed) == bool(comparator.reaches)  # without assumptions no joint of ours is computed
        assert all(low <= high for low, high in comparator.ours.values())
        summary = comparator.summary()
        assert summary["call"] == f"ballsocket.evidence.comparators.PUBLISHED[{name!r}]()"
        assert (summary["name"], summary["kind"]) == (name, comparator.kind)
        assert summary["ours"] == {title: list(ends) for title, ends in comparator.ours.items()}


def test_resurfacing_has_the_published_pressure_and_a_smaller_area(published):
    low, high = published["durom"].ours["largest pressure, MPa"]
    assert low < 22 < high
    small, large = (area / 237 for area in published["durom"].ours["contact area, mm²"])
    assert (small, large) == (pytest.approx(2 / 3, abs=0.02), pytest.approx(7 / 8, abs=0.02))


def test_pressure_of_the_inlay_depends_on_its_wall(published):
    low, high = published["metasul"].ours["largest pressure, MPa"]
    assert low < 47 < high
    assert high > 2 * low


def test_hertz_is_within_a_seventh_for_a_ceramic_insert(published):
    pressure, area, width = published["mak"].ours.values()
    assert pressure == (pytest.approx(1 - 1 / 7, abs=0.02), pytest.approx(1.0, abs=0.01))
    assert area == (pytest.approx(1.0, abs=0.01), pytest.approx(1.1, abs=0.01))
    assert width[1] == pytest.approx(1.0, abs=0.1)


def test_pressure_of_a_3_mm_liner_exceeds_that_of_12_mm_by_41_to_69_percent(published):
    (ratio,) = published["kurtz"].ours.values()
    assert ratio == (pytest.approx(1.41, abs=0.005), pytest.approx(1.69, abs=0.005))
    assert "41 to 69 %" in published["kurtz"].agreement


def test_strain_of_a_ptfe_liner_at_its_limit_is_a_sixth(published):
    (strain,) = published["ptfe"].ours.values()
    assert strain[0] < 100 / 6 < strain[1]


def test_similar_joints_have_equal_similarity_numbers_and_half_angles():
    """Lengths twice as large and moduli three times: the same numbers at twelve times the force."""
    liner = Material(young=3 * UHMWPE.young, poisson=UHMWPE.poisson)
    ball = Material(young=3 * COCR.young, poisson=COCR.poisson)
    small = Joint(ball_radius=14.0, clearance=0.1, liner_thickness=6.0, liner=UHMWPE, ball=COCR)
    large = Joint(ball_radius=28.0, clearance=0.2, liner_thickness=12.0, liner=liner, ball=ball)
    numbers, scaled = similarity_ranges([(small, 2000.0)]), similarity_ranges([(large, 24000.0)])
    assert all(numbers[name] == pytest.approx(scaled[name]) for name in SIMILARITY)
    assert Exact().press(small, force=2000.0).half_angle == pytest.approx(
        Exact().press(large, force=24000.0).half_angle
    )


def test_comparators_apply_by_the_range_of_their_joints(published):
    assert applicability(published["durom"].reaches, NEEDED, tilted=False)["verdict"] == "does not apply"
    assert applicability(published["anderson"].reaches, NEEDED, tilted=False)["verdict"] == "does not apply"
    around = {name: (0.9 * low, 1.1 * high) for name, (low, high) in NEEDED.items()}
    assert applicability(around, NEEDED, tilted=False) == {
        "verdict": "applies",
        "where": dict.fromkeys(SIMILARITY, "within"),
        "text": "applies",
    }
    assert applicability(around, NEEDED, tilted=True)["text"] == (
        "applies in part: a tilted load against one along the axis"
    )
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


def test_similarity_numbers_are_those_of_the_joint():
    joint = Joint(ball_radius=20.0, clearance=0.1, liner_thickness=5.0, liner=UHMWPE, ball=COCR)
    soft_ball = joint.replace(ball=Material(young=10 * UHMWPE.young, poisson=0.3))
    numbers = similarity_ranges([(joint, 1000.0)])
    assert numbers["c/R1"] == pytest.approx((0.005, 0.005))
    assert numbers["R1/L"] == pytest.approx((4.0, 4.0))
    assert numbers["F/(E R1²)"] == pytest.approx((1000.0 / (UHMWPE.young * 400.0),) * 2)
    assert numbers["E/E of the ball"] == (0.0, 0.0)  # less than a fiftieth
    assert similarity_ranges([(soft_ball, 1000.0)])["E/E of the ball"] == pytest.approx((0.1, 0.1))
    assert similarity_ranges([(joint.replace(ball=None), 1.0)])["E/E of the ball"] == (0.0, 0.0)
    both = similarity_ranges([(joint, 1000.0), (joint, np.array([500.0, np.nan]))])["F/(E R1²)"]
    assert both == pytest.approx((500.0 / (UHMWPE.young * 400.0), 1000.0 / (UHMWPE.young * 400.0)))


@pytest.mark.parametrize(
    ("reached", "position", "verdict"),
    [
        ((1.0, 4.0), "within", "applies"),
        ((2.0, 3.0), "within", "applies"),
        ((2.5, 3.0), "in part", "applies in part"),
        ((1.0, 2.5), "in part", "applies in part"),
        ((2.0, 2.0), "in part", "applies in part"),
        ((3.0, 3.0), "in part", "applies in part"),
        ((3.5, 4.0), "outside", "does not apply"),
        ((1.0, 1.5), "outside", "does not apply"),
    ],
)
def test_verdict_follows_from_the_overlap_of_ranges(reached, position, verdict):
    result = applicability({"ν": reached}, {"ν": (2.0, 3.0)}, tilted=False)
    assert result["where"] == {"ν": position}
    assert result["verdict"] == verdict


def test_half_of_the_numbers_outside_still_applies_in_part():
    needed = {"ν": (0.4, 0.4), "c/R1": (0.01, 0.01)}
    reaches = {"ν": (0.4, 0.4), "c/R1": (0.02, 0.02)}
    assert applicability(reaches, needed, tilted=False)["verdict"] == "applies in part"
    stiff = {"E/E of the ball": (0.0, 0.0), "ν": (0.4, 0.4), "c/R1": (0.01, 0.01)}
    soft = {**stiff, "E/E of the ball": (0.5, 0.5)}
    assert applicability(soft, stiff, tilted=False)["verdict"] == "does not apply"


def test_ranges_are_written_with_three_digits():
    assert range_text((0.12345, 0.12345)) == "0.123"
    assert range_text((1.0, 2.5)) == "1 to 2.5"


def test_ranges_of_a_question_include_its_tolerances(pack):
    question, record, _ = pack
    from ballsocket.evidence.matrix import Row

    ranges = question_ranges(question, [Row.of(row) for row in record["matrix"]])
    assert ranges["c/R1"] == pytest.approx((0.05 / 17.9, 0.15 / 17.9), rel=0.02)
    low, high = ranges["F/(E R1²)"]
    radius = question.file.joint.ball_radius
    assert low < 2000.0 / (750.0 * radius**2) < 4000.0 / (750.0 * radius**2) < high
    assert high == pytest.approx(4000.0 / (675.0 * radius**2), rel=0.06)


def ends(values):
    return pytest.approx((min(values), max(values)), rel=1e-9)


def test_resurfacing_is_computed_for_the_stated_ranges_of_wall_and_bone(published):
    """Wall 3.5 to 4.5 mm of cobalt-chromium on bone of 0.3 to 1 GPa, head 50 mm, bore 50.145 mm, 3200 N."""
    contacts = [
        Exact().press(
            Joint(
                ball_radius=25.0,
                clearance=0.0725,
                liner_thickness=wall,
                liner=COCR,
                ball=COCR,
                backing=(Layer(thickness=math.inf, material=Material(young=bone, poisson=0.3)),),
            ),
            force=3200.0,
        )
        for wall in (3.5, 4.0, 4.5)
        for bone in (300.0, 1000.0)
    ]
    ours = published["durom"].ours
    assert ours["largest pressure, MPa"] == ends([float(contact.max_pressure) for contact in contacts])
    assert ours["pole pressure, MPa"] == ends([float(contact.pole_pressure) for contact in contacts])
    assert ours["contact area, mm²"] == ends([float(contact.area) for contact in contacts])
    assert published["durom"].reaches["R1/L"] == pytest.approx((25.0 / 4.5, 25.0 / 3.5))
    assert published["durom"].reaches["c/R1"] == pytest.approx((0.0029, 0.0029))
    assert published["durom"].reaches["F/(E R1²)"][0] == pytest.approx(3200.0 / (COCR.young * 625.0))


def test_inlay_is_computed_for_the_stated_ranges_of_wall_and_polyethylene(published):
    """Wall 2 to 4 mm on 3 to 5 mm of polyethylene, head 28 mm, bore 28.12 mm, 3200 N."""
    pressures = [
        float(
            Exact()
            .press(
                Joint(
                    ball_radius=14.0,
                    clearance=0.06,
                    liner_thickness=wall,
                    liner=COCR,
                    ball=COCR,
                    backing=(Layer(thickness=thickness, material=UHMWPE),),
                ),
                force=3200.0,
            )
            .max_pressure
        )
        for wall in (2.0, 3.0, 4.0)
        for thickness in (3.0, 5.0)
    ]
    assert published["metasul"].ours["largest pressure, MPa"] == ends(pressures)
    assert published["metasul"].reaches["R1/L"] == pytest.approx((3.5, 7.0))


def test_ceramic_insert_covers_two_heads_and_three_clearances(published):
    reaches = published["mak"].reaches
    assert reaches["c/R1"] == pytest.approx((0.02 / 18.0, 0.08 / 14.0))
    assert reaches["R1/L"] == pytest.approx((14.0 / 5.0, 18.0 / 5.0))
    assert reaches["F/(E R1²)"] == pytest.approx(
        (2500.0 / (ALUMINA.young * 18.0**2), 2500.0 / (ALUMINA.young * 14.0**2))
    )


def test_liners_in_a_shell_cover_three_heads_and_three_clearances(published):
    reaches = published["kurtz"].reaches
    assert reaches["c/R1"] == pytest.approx((0.05 / 16.0, 0.2 / 11.0))
    assert reaches["R1/L"] == pytest.approx((11.0 / 12.0, 16.0 / 3.0))
    assert reaches["F/(E R1²)"] == pytest.approx((2500.0 / (UHMWPE.young * 16.0**2), 2500.0 / (UHMWPE.young * 11.0**2)))
    middle = [
        float(
            Exact()
            .press(
                Joint(ball_radius=14.0, clearance=0.1, liner_thickness=thickness, liner=UHMWPE, ball=COCR), force=2500.0
            )
            .max_pressure
        )
        for thickness in (3.0, 12.0)
    ]
    low, high = published["kurtz"].ours["largest pressure of 3 mm over that of 12 mm"]
    assert low < middle[0] / middle[1] < high


def test_strain_of_the_ptfe_liner_follows_from_the_stated_modulus(published):
    (strain,) = published["ptfe"].ours.values()
    assert strain == pytest.approx((482 / 31.0264, 541 / 31.0264), rel=1e-4)
