"""Statuses, ranges and remarks: limits, messages, and the domain of a model."""

from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core import validity
from ballsocket.core.validity import NeverValid, Promise, Range, Remark, Status

HIP = bs.joints["hip-28"]
FAILED = {"OUTSIDE_DOMAIN", "NOT_REACHED", "NOT_CONVERGED", "NOT_ROUND", "NO_JOINT", "DISLOCATED"}


def test_statuses_have_the_codes_of_stored_studies_and_those_without_numbers_have_failed():
    names = "OK OUTSIDE_DOMAIN NOT_REACHED NOT_CONVERGED BEYOND_EQUATOR AT_RIM NOT_ROUND NO_JOINT DISLOCATED"
    assert {status.name: int(status) for status in Status} == {name: code for code, name in enumerate(names.split())}
    assert {status.name for status in Status if status.failed} == FAILED
    assert all(len(status.sentence) > 3 for status in Status)
    np.testing.assert_array_equal(validity.is_missing(np.arange(9)), [status.failed for status in sorted(Status)])


@pytest.mark.parametrize(
    ("limits", "text"),
    [
        ({"quantity": "joint.liner.poisson", "low": 0.1, "high": 0.4}, "ν 0.1 to 0.4"),
        ({"quantity": "joint.liner.poisson", "high": 0.4}, "ν ≤ 0.4"),
        ({"quantity": "joint.liner.poisson", "low": 0.1}, "ν ≥ 0.1"),
        ({"quantity": "half_angle", "high": np.radians(30.0)}, "ε ≤ 30°"),
        ({"quantity": "joint.backing", "low": 1.0}, "backing ≥ 1"),
        ({"quantity": lambda contact: contact.force, "symbol": "x", "high": 2.0}, "x ≤ 2"),
    ],
)
def test_ranges_are_printed_with_symbols_and_units(limits, text):
    limit = Range(**limits, why="of a reason")
    assert str(limit) == text
    assert limit.sentence == f"outside {text}: of a reason"


def test_ranges_are_closed_and_domains_open():
    limit = Range(quantity="force", low=1.0, high=2.0)
    contact = SimpleNamespace(force=np.array([0.9, 1.0, 1.5, 2.0, 2.1, np.nan]))
    np.testing.assert_array_equal(limit.holds(contact), [False, True, True, True, False, False])
    np.testing.assert_array_equal(limit.strictly_holds(contact), [False, False, True, False, False, False])


def test_an_empty_range_holds_for_no_contact():
    never = NeverValid(why="of a test")
    assert not never.holds(SimpleNamespace(indentation=1.0))
    assert str(never) == "nothing"
    assert never.sentence == "never valid: of a test"
    assert Remark(quantity="force", high=1.0, why="a large force").sentence == "a large force"
    assert str(Promise(within=0.025)) == "within 2.5 % in d and pmax"
    assert str(Promise(within=0.1, quantities=("stiffness",))) == "within 10 % in dF/dd"


def test_domain_is_a_mask_of_the_points_and_a_joint_outside_is_rejected():
    domain = (Range(quantity="joint.clearance", low=0.0, high=1.0, why="of a test"),)
    joint = HIP.replace(clearance=np.array([0.0, 0.5, 1.0]))
    np.testing.assert_array_equal(validity.check_domain(domain, joint, "test"), [False, True, False])
    assert validity.check_domain(domain, HIP, "test")
    assert validity.check_domain(domain, HIP.replace(clearance=np.zeros(0)), "test").shape == (0,)
    domain = (Range(quantity="joint.clearance", low=1.0, why="of a test"),)
    several = HIP.replace(clearance=[0.5, 0.7, 0.9])
    for joint, text in ((HIP, "c = 0.1: of a test"), (several, r"c = 0.5 \(and 2 more\): of a test")):
        with pytest.raises(bs.OutsideDomainError, match=f"test has no answer for {text}"):
            validity.check_domain(domain, joint, "test")


@pytest.mark.parametrize(
    ("limit", "name", "inside", "outside"),
    [
        (validity.SMALL_STRAIN, "depth_ratio", 0.1, 0.11),
        (validity.RIGID_BALL, "modulus_ratio", 0.02, 0.021),
        (validity.RIGID_BACKING, "backing_ratio", 0.009, 0.011),
    ],
)
def test_limits_of_common_validities(limit, name, inside, outside):
    for value, holds in ((inside, True), (outside, False)):
        contact = SimpleNamespace(**{name: value}, joint=SimpleNamespace(**{name: value}))
        assert limit.holds(contact) == holds


def test_fraction_of_an_infinite_layer_follows_its_formula():
    """0.1 (1 + ν) F/(E b d) with the constants and the inner radius b of the last layer."""
    massive = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=np.inf, liner=bs.UHMWPE)
    shell, bone = bs.Layer(thickness=2.0, material=bs.TITANIUM), bs.Layer(thickness=np.inf, material=bs.CANCELLOUS_BONE)
    layered = massive.replace(liner_thickness=5.0, backing=(shell, bone))
    for joint, force, indentation, expected in (
        (massive, 1000.0, 0.05, 0.1 * 1.4 * 1000.0 / (1000.0 * 14.1 * 0.05)),
        (layered, 1000.0, 0.05, 0.1 * 1.2 * 1000.0 / (500.0 * 21.1 * 0.05)),
        (HIP, 1000.0, 0.05, 0.0),
        (massive, 0.0, 0.0, 0.0),
    ):
        contact = SimpleNamespace(joint=joint, force=force, indentation=indentation)
        assert validity.infinite_layer_share(contact) == pytest.approx(expected, rel=1e-14)
