"""The first view: the joint with its dimensions, handles that are inputs, and a verdict on what its materials bear."""

import re
from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app import results
from ballsocket.app.jobs import Job
from ballsocket.app.pictures.section import petals
from ballsocket.app.results import ResultStore
from ballsocket.app.running import RunFinished, RunRefused
from ballsocket.app.session import Page
from ballsocket.app.views.contact import view as contact_view
from ballsocket.app.widgets.words import accuracy_sentence
from ballsocket.reports.check_table import checks_html, checks_of
from ballsocket.reports.section_plots import gap_factor

from ..extent import either
from .asking import does, edits, opened, saved, told, trouble

HIP = bs.joints["hip-28"]


SHELL = "&backing.0.thickness=3&backing.0.material=titanium&cup.arc_of_cover=160"
JOINT = "joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=UHMWPE&load.force=3000"


def drawing(page):
    return told(page, "press-section")


def handles(page):
    return dict(re.findall(r'role="slider" data-drag="(\w+)"[^>]* aria-valuetext="([^"]*)"', drawing(page)))


def test_the_drawing_says_every_dimension_and_how_often_its_gap_is_drawn():
    texts = set(re.findall(r"<text[^>]*>([^<]*)</text>", drawing(Page("preset=hip-28&load.force=3000"))))
    assert {"⌀ 28 mm", "⌀ 28.2 mm", "5 mm", "⌀ 38.2 mm", "⌀ 0.2 mm", "drawn × 10", "3000 N"} <= texts
    assert {"CoCr", "UHMWPE"} <= texts


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


@pytest.mark.parametrize("tilt", either([20.0, 75.0], [20.0, 45.0, 75.0]))
def test_a_tilted_contact_is_that_of_the_real_cup_in_this_view_and_in_the_view_cup(tilt, at_once):
    page = opened(f"{JOINT}&load.tilt={tilt} deg")
    contact = bs.Sphere().press(page.screen.file.joint, force=3000.0, tilt=radians(tilt))
    numbers, table = told(page, "press-numbers"), told(page, "press-table")
    assert f"data-name='max_pressure' data-value='{contact.max_pressure!r}'" in numbers
    assert checks_html(checks_of(contact, page.screen.file.cup), page.screen.reading.with_unit) in numbers
    assert ("✗ Fails" in numbers) == contact.edge_loaded == (tilt > 45)
    assert "of the exact solution" not in page_text(page)
    answering = [name for name in bs.catalogue if f"</svg>{name}</th><td colspan" not in table]
    assert table.count("no: for an axial load: not valid at this tilt") == len(answering)
    assert f"<td data-head='pmax [MPa]'>{contact.max_pressure:.4g}</td>" in table
    assert page.channel.shown_value("=answered_by")["hidden"]
    cell = f"{contact.max_pressure:.4g} <span class='unit'>MPa"
    assert cell in numbers
    does(page, "choose", name="view", value="cup")
    assert cell in told(page, "cup-numbers")
    assert f"max_pressure_MPa,{contact.max_pressure!r}" in saved(page, "CSV").decode()


def page_text(page):
    return " ".join(told(page, f"press-{part}") for part in ("section", "numbers", "charts", "table"))


def test_an_axial_load_is_answered_by_the_chosen_model_unless_the_rim_is_near(at_once):
    page = opened(JOINT)
    assert "of the exact solution" in page_text(page)
    assert "not valid at this tilt" not in page_text(page)
    page = opened(f"{JOINT}&cup.arc_of_cover=110")
    assert "outside the range in which this model can be trusted" in told(page, "press-numbers")
    edits(page, "press.run", True)
    assert "near the rim" in told(page, "press-numbers")
    assert "not valid so near the rim" in told(page, "press-table")
    assert "of the exact solution" not in page_text(page)


def test_no_number_is_shown_while_the_real_cup_is_prepared(monkeypatch, asked):
    monkeypatch.setattr(results, "RESULTS", ResultStore())
    monkeypatch.setattr(contact_view, "is_prepared", lambda file: False)
    page = opened(f"{JOINT}&load.tilt=20 deg")
    button = page.channel.shown_value("=press.run")
    assert (button["label"], button["hidden"]) == ("Compute the real cup", False)
    assert "data-value" not in told(page, "press-numbers")
    does(page, "save", kind="CSV")
    assert "still being prepared" in trouble(page)
    edits(page, "tilt", 0)
    assert page.channel.shown_value("=press.run")["hidden"]
    assert "data-name='max_pressure'" in told(page, "press-numbers")


def test_a_load_that_leaves_the_bore_has_a_sentence_and_no_number(at_once):
    page = opened(f"{JOINT}&load.tilt=95 deg")
    assert "the load pushes the ball out" in told(page, "press-numbers")
    assert "data-value" not in told(page, "press-numbers")


@pytest.mark.parametrize("arc", [60.0, 180.0])
def test_the_band_of_pressure_ends_with_the_contact_and_at_the_rim(arc):
    file = JointFile(HIP, {"force": 3000.0}, bs.Cup(arc_of_cover=radians(arc)))
    contact = bs.Exact().press(file.joint, force=3000.0)
    _, angles, _ = petals(file, contact)
    widest = degrees(np.abs(angles).max())
    assert widest == pytest.approx(min(arc / 2, degrees(contact.half_angle)), abs=0.01)


def test_a_joint_without_a_load_has_no_band():
    file = JointFile(replace(HIP, name=""), {}, bs.Cup())
    assert petals(file, bs.Exact().press(file.joint, force=0.0))[2].size == 0


@pytest.mark.parametrize("tilt", [45.0, 75.0])
def test_the_pressure_of_a_tilted_contact_is_painted_about_the_load_inside_the_bore(tilt):
    contact = bs.Sphere().press(HIP, force=3000.0, tilt=radians(tilt))
    _, corners, pressures = petals(JointFile(HIP, {"force": 3000.0}), contact)
    angles = np.degrees(corners).mean(axis=1)
    assert min(angles) >= -90.0
    assert angles[int(np.argmax(pressures))] == pytest.approx(-tilt, abs=15.0)
    assert max(pressures) == pytest.approx(contact.max_pressure, rel=0.1)


def test_the_first_number_comes_with_its_own_check():
    page = Page("preset=hip-28&load.force=3000")
    edits(page, "allowable", "20,5")
    numbers = told(page, "press-numbers")
    largest = bs.Exact().press(HIP, force=3000.0).max_pressure
    row = re.search(r"<tr class='(\w+)'><th scope='row'>pressure on the liner</th>(.*?)</tr>", numbers, re.DOTALL)
    assert row[1] == "passes"
    assert f"<td>{largest:.4g} MPa</td><td>20.5 MPa (allowable pressure)</td>" in row[2]
    assert f"{100 * largest / 20.5:.0f} %" in row[2]
    assert numbers.index("data-name='max_pressure'") < numbers.index(row[0]) < numbers.index("data-name='force'")
    shown = dict(re.findall(r"data-name='(\w+)' data-value='([^']*)'", numbers))
    contact = bs.Exact().press(HIP.replace(liner=page.screen.file.joint.liner), force=3000.0)
    assert float(shown["indentation"]) == pytest.approx(1e3 * contact.indentation)
    assert float(shown["half_angle"]) == pytest.approx(degrees(contact.half_angle))
    assert "von Mises stress in the liner" in numbers
    assert page.channel.shown_value("=liner")["value"] == "uhmwpe"
    edits(page, "allowable", "")
    assert "no allowable pressure of the liner is known" in told(page, "press-numbers")


def test_one_line_says_how_near_all_numbers_are():
    exact, other = (bs.catalogue[name].press(HIP, force=3000.0) for name in ("exact", "hess-forsbach"))
    assert accuracy_sentence(exact, exact) == "All within 0.001 % of the exact solution"
    apart = max(abs(other.area / exact.area - 1), abs(other.half_angle / exact.half_angle - 1))
    assert accuracy_sentence(other, exact) == f"All within {100 * apart:.2g} % of the exact solution"
    assert told(Page(""), "press-numbers").count("of the exact solution") == 1


def test_a_design_that_is_shown_again_has_its_stress_at_once(monkeypatch):
    page = Page("preset=hip-28&load.force=2990")
    numbers = told(page, "press-numbers")
    assert "stress estimated" not in numbers
    monkeypatch.setattr(page, "later", lambda seconds, function: lambda: None)
    edits(page, "load", 3110)
    assert "stress estimated" in told(page, "press-numbers")
    edits(page, "load", 2990)
    assert told(page, "press-numbers") == numbers


def test_stresses_in_the_liner_are_painted_when_they_are_asked_for():
    page = Page("preset=hip-28&load.force=3000")
    assert "von Mises" not in drawing(page)
    does(page, "choose", name="painted", value="stress")
    top = float(re.search(r"<span>([\d.]+) MPa", drawing(page))[1])
    assert top == pytest.approx(bs.Exact().press(HIP, force=3000.0).von_mises, rel=0.05)
    does(page, "choose", name="answered_by", value="hertz")
    assert "this model has no stresses inside the liner" in drawing(page)


def test_a_report_is_printed_with_the_address_of_the_server(monkeypatch):
    """PDF is the page of HTML, printed in a process on the paper of the units; a refusal is a sentence."""
    printed = []

    def ask(self, key, work):
        printed.append(work.args)
        self._heard(key, RunFinished(b"%PDF") if len(printed) == 1 else RunRefused(why="WeasyPrint is not installed"))

    monkeypatch.setattr(Job, "ask", ask)
    page = Page("preset=hip-28&load.force=3000", origin="https://explorer.example")
    assert saved(page, "PDF") == b"%PDF"
    html, paper = printed[0]
    assert "https://explorer.example/?preset=hip-28" in html
    assert html.index("id='checks'") < html.index("id='drawing'")
    assert paper == "A4"
    does(page, "choose", name="units", value="imperial")
    assert "file" not in does(page, "save", kind="PDF")
    assert printed[1][1] == "letter"
    assert "WeasyPrint is not installed" in trouble(page)
