"""The first view: the joint with its dimensions, handles that are inputs, and a verdict on what its materials bear."""

import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile

pytest.importorskip("panel", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app.pictures.section import petals
from ballsocket.app.session import Page
from ballsocket.app.widgets.words import accuracy_sentence, estimate_von_mises, most_used, verdict_sentence
from ballsocket.reports.section_plots import gap_factor

from .asking import does, edits, trouble

HIP = bs.joints["hip-28"]
SHELL = "&backing.0.thickness=3&backing.0.material=titanium&cup.arc_of_cover=160"
JOINT = "joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=UHMWPE&load.force=3000"


def drawing(page):
    return page.channel.shown_value("#press-section")


def texts(page):
    return re.findall(r"<text[^>]*>([^<]*)</text>", drawing(page))


def handles(page):
    return dict(re.findall(r'role="slider" data-drag="(\w+)"[^>]* aria-valuetext="([^"]*)"', drawing(page)))


def test_the_drawing_says_every_dimension_and_how_often_its_gap_is_drawn():
    said = texts(Page("preset=hip-28&load.force=3000"))
    assert {"⌀ 28 mm", "⌀ 28.2 mm", "5 mm", "⌀ 38.2 mm", "⌀ 0.2 mm", "drawn × 10", "3000 N"} <= set(said)
    assert {"CoCr", "UHMWPE"} <= set(said)


@pytest.mark.parametrize("clearance", [1e-4, 0.02, 0.1, 0.7])
def test_a_gap_is_drawn_wide_enough_to_be_seen_and_no_wider_than_a_tenth_of_the_ball(clearance):
    drawn = gap_factor(replace(HIP, clearance=clearance)) * clearance
    assert drawn <= 0.1 * HIP.ball_radius
    assert drawn >= 0.02 * HIP.ball_radius or clearance == 1e-4


def test_every_handle_is_an_input_and_says_its_number():
    page = Page(JOINT + SHELL)
    assert handles(page) == {"load": "3000 N", "tilt": "0 °", "liner_thickness": "5 mm", "layer0": "3 mm"}
    for name, value in (("tilt", 30), ("layer0", 4.5), ("liner_thickness", 6), ("load", 2000)):
        edits(page, name, value)
        assert trouble(page) == ""
    assert handles(page) == {"load": "2000 N", "tilt": "30 °", "liner_thickness": "6 mm", "layer0": "4.5 mm"}
    file = page.screen.file
    assert file.aim == {"tilt": pytest.approx(radians(30.0))}
    assert (file.joint.liner_thickness, file.joint.backing[0].thickness) == (6.0, 4.5)
    edits(page, "tilt", 0)
    assert page.screen.file.aim == {}


@pytest.mark.parametrize("tilt", [0.0, 40.0, 75.0])
def test_pressure_is_painted_inside_the_arc_of_the_cup_alone(tilt):
    file = JointFile(HIP, {"force": 3000.0}, bs.Cup(arc_of_cover=radians(160.0)))
    contact = bs.Exact().press(HIP, force=3000.0)
    angles = [np.degrees(np.arctan2(x, -y)) for (x, y), _ in petals(file, contact, radians(tilt))]
    assert min(map(np.min, angles)) == pytest.approx(max(-80.0, -tilt - np.degrees(contact.half_angle)), abs=1e-6)
    assert max(map(np.max, angles)) == pytest.approx(min(80.0, -tilt + np.degrees(contact.half_angle)), abs=1e-6)


def test_a_contact_over_the_rim_is_said():
    page = Page(JOINT + SHELL)
    edits(page, "tilt", 20)
    assert "The contact ends" in drawing(page)
    edits(page, "tilt", 70)
    assert "over the rim, which no answer here knows" in drawing(page)


@pytest.mark.parametrize(
    ("strengths", "force", "holds", "words"),
    [
        ({"allowable_pressure": 20.0}, 3000.0, True, "The liner is within its strength, by a small margin"),
        ({"allowable_pressure": 40.0}, 3000.0, True, "The liner is within its strength"),
        ({"allowable_pressure": 10.0}, 3000.0, False, "1.7 times the allowable pressure of the liner"),
        ({"yield_stress": 21.0, "allowable_pressure": 100.0}, 12000.0, False, "the yield stress of the liner"),
        ({}, 3000.0, None, "No verdict"),
    ],
)
def test_a_verdict_is_that_of_the_strength_that_is_used_most(strengths, force, holds, words):
    liner = bs.Material(young=1000.0, poisson=0.4, **strengths)
    contact = bs.Exact().press(replace(HIP, liner=liner, ball=None), force=force)
    borne = most_used(contact, estimate_von_mises(contact))
    said = verdict_sentence(contact, borne)
    assert said[0] is holds
    assert words in said[1]
    if "allowable_pressure" in strengths and len(strengths) == 1:
        assert borne.ratio == pytest.approx(contact.max_pressure / strengths["allowable_pressure"])


def test_an_answer_that_is_not_to_be_trusted_has_no_verdict():
    contact = bs.Hertz().press(HIP, force=3000.0)
    assert verdict_sentence(contact, most_used(contact, estimate_von_mises(contact))) == (
        None,
        "No verdict: this contact is outside the range of its model",
    )


def test_the_first_number_comes_with_its_share_of_the_allowable():
    page = Page("preset=hip-28&load.force=3000")
    edits(page, "allowable", "20,5")
    numbers = page.channel.shown_value("#press-numbers")
    assert "83 % of the allowable pressure of the liner (UHMWPE, 20.5 MPa)" in numbers
    assert numbers.index("data-name='max_pressure'") < numbers.index("data-name='force'")
    assert page.channel.shown_value("=liner")["value"] == "uhmwpe"
    edits(page, "allowable", "")
    assert "of the yield stress of the liner" in page.channel.shown_value("#press-numbers")


def test_one_line_says_how_near_all_numbers_are():
    exact, other = (bs.catalogue[name].press(HIP, force=3000.0) for name in ("exact", "hess-forsbach"))
    assert accuracy_sentence(exact, exact) == "All within 0.001 % of the exact answer"
    apart = max(abs(other.area / exact.area - 1), abs(other.half_angle / exact.half_angle - 1))
    assert accuracy_sentence(other, exact) == f"All within {100 * apart:.2g} % of the exact answer"
    assert Page("").channel.shown_value("#press-numbers").count("of the exact answer") == 1


def test_stresses_in_the_liner_are_painted_when_they_are_asked_for():
    page = Page("preset=hip-28&load.force=3000")
    assert "von Mises" not in drawing(page)
    does(page, "choose", name="painted", value="stress")
    top = float(re.search(r"<span>([\d.]+) MPa", drawing(page))[1])
    assert top == pytest.approx(bs.Exact().press(HIP, force=3000.0).von_mises, rel=0.05)
    does(page, "choose", name="answered_by", value="hertz")
    assert "this model has no stresses inside the liner" in drawing(page)
