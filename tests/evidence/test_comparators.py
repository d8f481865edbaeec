"""Published numbers beside ours: what is said of them is what is computed, and whether they speak of a question."""

import pytest

from ballsocket import Exact
from ballsocket.evidence.comparator import SIMILARITY, applicability, reach_of
from ballsocket.evidence.comparators import CLAIMS, PUBLISHED, claim
from ballsocket.problem import Joint, Material
from ballsocket.problem.presets import COCR, UHMWPE, joints

HIP = joints["hip-36"]
ASKED = reach_of([(HIP, 2000.0), (HIP.replace(clearance=0.05), 3000.0)])


@pytest.fixture(scope="module")
def found():
    return {name: make() for name, make in PUBLISHED.items()}


def test_each_says_what_was_read_and_what_is_assumed(found):
    for each in found.values():
        assert each.read
        assert each.inputs
        assert each.published
        assert bool(each.assumed) == bool(each.reaches)  # where nothing is assumed nothing of ours is a joint
        assert all(low <= high for low, high in each.ours.values())


def test_the_resurfacing_has_the_published_pressure_and_less_than_the_published_area(found):
    low, high = found["durom"].ours["largest pressure, MPa"]
    assert low < 22 < high
    small, large = (area / 237 for area in found["durom"].ours["contact area, mm²"])
    assert (small, large) == (pytest.approx(2 / 3, abs=0.02), pytest.approx(7 / 8, abs=0.02))


def test_the_inlay_is_sensitive_to_its_wall(found):
    low, high = found["metasul"].ours["largest pressure, MPa"]
    assert low < 47 < high
    assert high > 2 * low


def test_hertz_estimates_a_ceramic_insert(found):
    pressure, area, width = found["mak"].ours.values()
    assert pressure == (pytest.approx(1 - 1 / 7, abs=0.02), pytest.approx(1.0, abs=0.01))
    assert area == (pytest.approx(1.0, abs=0.01), pytest.approx(1.1, abs=0.01))
    assert width[1] == pytest.approx(1.0, abs=0.1)


def test_a_liner_of_3_mm_is_pressed_harder_than_one_of_12(found):
    (ratio,) = found["kurtz"].ours.values()
    assert ratio == (pytest.approx(1.41, abs=0.005), pytest.approx(1.69, abs=0.005))
    assert "41 to 69 %" in found["kurtz"].agreement


def test_a_lining_is_strained_by_a_sixth_at_its_limit(found):
    (strain,) = found["ptfe"].ours.values()
    assert strain[0] < 100 / 6 < strain[1]


def test_similar_joints_are_one():
    """Lengths twice as large and moduli three times: the same numbers at twelve times the force."""
    liner = Material(young=3 * UHMWPE.young, poisson=UHMWPE.poisson)
    ball = Material(young=3 * COCR.young, poisson=COCR.poisson)
    one = Joint(ball_radius=14.0, clearance=0.1, liner_thickness=6.0, liner=UHMWPE, ball=COCR)
    other = Joint(ball_radius=28.0, clearance=0.2, liner_thickness=12.0, liner=liner, ball=ball)
    here, there = reach_of([(one, 2000.0)]), reach_of([(other, 24000.0)])
    assert all(here[name] == pytest.approx(there[name]) for name in SIMILARITY)
    assert Exact().press(one, force=2000.0).half_angle == pytest.approx(Exact().press(other, force=24000.0).half_angle)


def test_a_comparator_of_other_joints_does_not_apply_and_one_around_the_question_does(found):
    assert applicability(found["durom"].reaches, ASKED, tilted=False)["verdict"] == "does not apply"
    assert applicability(found["anderson"].reaches, ASKED, tilted=False)["verdict"] == "does not apply"
    around = {name: (0.9 * low, 1.1 * high) for name, (low, high) in ASKED.items()}
    assert applicability(around, ASKED, tilted=False) == {
        "verdict": "applies",
        "where": dict.fromkeys(SIMILARITY, "within"),
        "text": "applies",
    }
    assert applicability(around, ASKED, tilted=True)["text"] == (
        "applies in part: a tilted load against one along the axis"
    )
    thick = applicability({**around, "R1/L": (8.0, 9.0)}, ASKED, tilted=False)
    assert thick["where"]["R1/L"] == "outside"
    assert thick["text"] == "applies in part: R1/L 3.6 against 8 to 9"


@pytest.mark.parametrize("name", CLAIMS)
def test_a_claim_says_over_which_joints_it_reaches(name):
    reaches = claim(name)["reaches"]
    assert set(reaches) == set(SIMILARITY)
    assert applicability(reaches, ASKED, tilted=False)["verdict"] != "does not apply"
