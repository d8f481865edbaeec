"""The first view and the view of the cup: dimensions, handles that are inputs, checks, and off-axis contact."""

import json
import re
from base64 import b64decode
from dataclasses import replace
from functools import partial
from math import degrees, radians
from unittest.mock import Mock

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app import jobs, long_view, results
from ballsocket.app.jobs import Job
from ballsocket.app.pictures.bore import pressed_bore
from ballsocket.app.results import ResultStore
from ballsocket.app.running import RunFinished, RunRefused
from ballsocket.app.session import Page
from ballsocket.app.views import contact as contact_view
from ballsocket.app.views import real_cup
from ballsocket.app.views.cup import _hint, angle_map
from ballsocket.app.widgets.reading import Reading
from ballsocket.app.widgets.words import accuracy_sentence
from ballsocket.core.unit_systems import Units
from ballsocket.core.validity import Status
from ballsocket.design_checks import checks_of
from ballsocket.elasticity.off_axis.orientations import Orientations
from ballsocket.files.joint_file import JointFile
from ballsocket.problem.cup import Cup, Side
from ballsocket.reports.joint_drawing import petals
from ballsocket.reports.orientation_plots import orientation_figure
from ballsocket.reports.pages import check_cells, checks_html

from ..extent import either
from .asking import blocks, cells, does, edits, numbers, opened, saved, told, trouble

HIP, HIP_36 = bs.joints["hip-28"], bs.joints["hip-36"]
SHELL = "&backing.0.thickness=3&backing.0.material=titanium&cup.arc_of_cover=160"
JOINT = "joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=UHMWPE&load.force=3000"


def drawing(page):
    section, *colours = page.channel.shown_value("#press-section")
    return "".join([*section["below"], *section["above"], *(text for scale in colours for text in scale["words"])])


def handles(page):
    return dict(re.findall(r'role="slider" data-drag="(\w+)"[^>]* aria-valuetext="([^"]*)"', drawing(page)))


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


@pytest.mark.parametrize("tilt", either([20.0], [20.0, 45.0, 75.0]))
def test_a_tilted_contact_is_that_of_the_real_cup_in_this_view_and_in_the_view_cup(tilt, at_once):
    page = opened(f"{JOINT}&load.tilt={tilt} deg")
    contact = bs.Sphere().press(page.screen.file.joint, force=3000.0, tilt=radians(tilt))
    said, table = told(page, "press-numbers"), cells(page, "press-table")
    assert numbers(page, "press-numbers")["max_pressure"] == contact.max_pressure
    rows = [check_cells(check, page.screen.reading.with_unit) for check in checks_of(contact, page.screen.file.cup)]
    assert blocks(page, "press-numbers", "checks")[0]["rows"] == rows
    assert ("✗ Exceeded" in said) == contact.edge_loaded == (tilt > 45)
    assert "within" not in said
    axial = bs.compare(page.screen.file.joint, force=3000.0, tilt=radians(tilt))  # in a cup that is tilted as much
    assert sum(row[-1] == "yes" for row in table) == sum(bool(each.valid) for each in (contact, *axial.values()))
    assert f"{contact.max_pressure:.4g}" in table[1]
    assert page.channel.shown_value("=press.answered_by")["hidden"]
    cell = f'"{contact.max_pressure:.4g}", " MPa"'
    assert cell in said
    does(page, "view", value="cup")
    assert cell in told(page, "cup-numbers")
    assert f"max_pressure_MPa,{contact.max_pressure!r}" in saved(page, "CSV").decode()


def test_an_axial_load_is_answered_by_the_chosen_model_unless_the_rim_is_near_and_one_out_of_the_bore_by_none(at_once):
    page = opened(JOINT)
    assert "of the exact solution" in told(page, "press-numbers")
    page = opened(f"{JOINT}&cup.arc_of_cover=110")
    assert "outside the range in which this model can be trusted" in told(page, "press-numbers")
    edits(page, "press.run", True)
    assert "near the rim" in told(page, "press-numbers")
    assert told(page, "press-table").count("distance to the rim") == len(bs.catalogue)
    page = opened(f"{JOINT}&load.tilt=95 deg")
    assert "the load pushes the ball out" in told(page, "press-numbers")
    assert not numbers(page, "press-numbers")


def test_no_number_is_shown_while_the_real_cup_is_prepared(monkeypatch, asked):
    monkeypatch.setattr(results, "RESULTS", ResultStore())
    for module in (contact_view, real_cup):
        monkeypatch.setattr(module, "is_prepared", lambda file: False)
    page = opened(f"{JOINT}&load.tilt=20 deg")
    button = page.channel.shown_value("=press.run")
    assert (button["label"], button["hidden"]) == ("Compute the real cup", False)
    assert not numbers(page, "press-numbers")
    does(page, "save", kind="CSV")
    assert "still being prepared" in trouble(page)
    edits(page, "tilt", 0)
    assert page.channel.shown_value("=press.run")["hidden"]
    assert "max_pressure" in numbers(page, "press-numbers")
    page = opened(f"{JOINT}&cup.arc_of_cover=110")
    assert not page.channel.shown_value("=press.answered_by")["hidden"]
    edits(page, "press.run", True)  # one model alone from here on
    assert page.channel.shown_value("=press.answered_by")["hidden"]


@pytest.mark.parametrize("arc", [60.0, 180.0])
def test_the_band_of_pressure_ends_with_the_contact_and_at_the_rim(arc):
    file = JointFile(HIP, {"force": 3000.0}, bs.Cup(arc_of_cover=radians(arc)))
    contact = bs.Exact().press(file.joint, force=3000.0)
    _, angles, _ = petals(file, contact)
    widest = degrees(np.abs(angles).max())
    assert widest == pytest.approx(min(arc / 2, degrees(contact.half_angle)), abs=0.01)
    assert petals(replace(file, load={}), bs.Exact().press(HIP, force=0.0))[2].size == 0


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
    kinds = [block["kind"] for block in page.channel.shown_value("#press-numbers") if isinstance(block, dict)]
    assert kinds.index("numbers") < kinds.index("checks") < len(kinds) - 1 - kinds[::-1].index("numbers")
    largest = bs.Exact().press(HIP, force=3000.0).max_pressure
    rows = {row["title"]: row for row in blocks(page, "press-numbers", "checks")[0]["rows"]}
    row = rows["pressure on the liner"]
    texts = f"{largest:.4g} MPa", "20.5 MPa (allowable pressure)", f"{100 * largest / 20.5:.0f} %"
    assert (row["state"], row["demand"], row["capacity"], row["ratio"]) == ("kept", *texts)
    shown = numbers(page, "press-numbers")
    contact = bs.Exact().press(HIP.replace(liner=page.screen.file.joint.liner), force=3000.0)
    assert shown["indentation"] == pytest.approx(1e3 * contact.indentation)
    assert shown["half_angle"] == pytest.approx(degrees(contact.half_angle))
    assert "von Mises stress in the liner" in rows
    assert page.channel.shown_value("=liner")["value"] == "uhmwpe"
    edits(page, "allowable", "")
    assert "no allowable pressure of the liner is known" in told(page, "press-numbers")


def test_a_liner_takes_its_own_hardening_as_files_do():
    page = Page("preset=hip-28")
    assert page.channel.shown_value("=hardening")["value"] == str(bs.UHMWPE.hardening)
    edits(page, "hardening", "20:0, 24 MPa:0.01; E 1.2 GPa")
    curve = bs.Hardening(stress=(20.0, 24.0), plastic_strain=(0.0, 0.01), young=1200.0)
    assert page.screen.file.joint.liner.hardening == curve
    assert Page(page.screen.link).screen.file.joint.liner.hardening == curve
    edits(page, "hardening", "20:0, 18:0.1")
    assert "stresses do not descend" in trouble(page)
    edits(page, "hardening", "20")
    assert "must be points" in trouble(page)
    edits(page, "hardening", "")
    assert page.screen.file.joint.liner.hardening is None


def test_one_line_says_how_near_all_numbers_are():
    exact, other = (bs.catalogue[name].press(HIP, force=3000.0) for name in ("exact", "hess-forsbach"))
    assert accuracy_sentence(exact, exact) == "All within 0.001 % of the exact solution"
    apart = max(abs(other.area / exact.area - 1), abs(other.half_angle / exact.half_angle - 1))
    assert accuracy_sentence(other, exact) == f"All within {100 * apart:.2g} % of the exact solution"
    assert told(Page(""), "press-numbers").count("of the exact solution") == 1


def test_a_design_that_is_shown_again_has_its_stress_at_once(monkeypatch):
    page = Page("preset=hip-28&load.force=2990")
    said = told(page, "press-numbers")
    assert f'"{bs.Exact().press(HIP, force=2990.0).von_mises:.4g} MPa"' in said
    monkeypatch.setattr(page.view, "later", lambda seconds, function: None)
    edits(page, "load", 3110)
    edits(page, "load", 2990)
    assert told(page, "press-numbers") == said


def test_the_drawing_says_every_dimension_and_is_painted_with_stresses_when_they_are_asked_for():
    page = Page("preset=hip-28&load.force=3000")
    texts = set(re.findall(r"<text[^>]*>([^<]*)</text>", drawing(page)))
    assert texts >= {"⌀ 28 mm", "⌀ 28.2 mm", "5 mm", "⌀ 38.2 mm", "⌀ 0.2 mm", "drawn × 10", "3000 N"}
    assert texts >= {"CoCrMo", "UHMWPE"}
    assert "von Mises" not in drawing(page)
    does(page, "edit", name="press.painted", value="stress")
    top = float(page.channel.shown_value("#press-section")[1]["words"][1].removesuffix(" MPa"))
    assert top == pytest.approx(bs.Exact().press(HIP, force=3000.0).von_mises, rel=0.05)
    does(page, "edit", name="press.answered_by", value="hertz")
    assert "this model has no stresses inside the liner" in drawing(page)


@pytest.mark.long
def test_a_report_is_printed_with_the_address_of_the_server(monkeypatch):
    """PDF is the page of HTML, printed in a process on the paper of the units; a refusal is a sentence."""
    printed = []

    def ask(self, key, work):
        printed.append(work.args)
        self._heard(key, RunFinished(b"%PDF") if len(printed) == 1 else RunRefused(why="WeasyPrint is not installed"))

    monkeypatch.setattr(Job, "ask", ask)
    page = Page("preset=hip-28&load.force=3000", origin="https://explorer.example", logo="data:image/png;base64,UE5H")
    assert saved(page, "PDF") == b"%PDF"
    html, paper = printed[0]
    assert "https://explorer.example/?preset=hip-28" in html
    assert "src='data:image/png;base64,UE5H'" in html
    assert html.index("id='checks'") < html.index("id='drawing'")
    assert paper == "A4"
    does(page, "edit", name="units", value="imperial")
    assert "file" not in does(page, "save", kind="PDF")
    assert printed[1][1] == "letter"
    assert "WeasyPrint is not installed" in trouble(page)


CUP_LINK = "view=cup&preset=hip-36&cup.inclination=45&cup.anteversion=15&load.force=3000"


def test_the_view_says_what_the_sphere_says(at_once):
    page = opened(CUP_LINK)
    contact = bs.Sphere(cup=page.screen.file.cup).press(HIP_36, force=3000.0)
    assert f'"{float(contact.edge_distance):.4g}", " mm"' in told(page, "cup-numbers")
    (margin,) = re.findall(r"([\d.]+)° of arc", told(page, "cup-numbers"))
    assert float(margin) == pytest.approx(degrees(contact.edge_margin), abs=degrees(contact.error["edge_margin"]))
    assert f'"{float(contact.max_pressure):.4g}", " MPa"' in told(page, "cup-numbers")
    assert f"{float(contact.edge_distance):.4g} mm from the rim" in told(page, "cup-map")
    viewed = json.loads(re.search(r"data-viewer='([^']*)'", told(page, "cup-viewer"))[1])
    assert viewed["loads"][0] == pytest.approx(contact.force_vector / 3000.0, abs=1e-4)
    assert viewed["axes"]["up"] == pytest.approx([axis[2] for axis in page.screen.file.cup.frame], abs=1e-4)
    assert viewed["radii"] == pytest.approx([18.0 / 18.1, 1 + 5 / 18.1, 1 + 5 / 18.1], abs=1e-4)
    cells = np.frombuffer(b64decode(viewed["bytes"]), dtype=np.uint8)
    assert cells.max() / 255 * 12 == pytest.approx(float(contact.max_pressure), rel=0.01)
    rows = dict(line.split(",") for line in saved(page, "CSV").decode().splitlines())
    assert float(rows["max_pressure_MPa"]) == pytest.approx(float(contact.max_pressure))
    assert float(rows["half_angle_deg"]) == pytest.approx(degrees(contact.half_angle))
    assert {"force_N", "edge_distance_mm", "rim_distance_mm", "edge_margin_deg"} <= set(rows)
    report = saved(page, "HTML").decode()
    assert f"<td>{float(contact.max_pressure):.4g} MPa</td>" in report
    assert checks_html(checks_of(contact, page.screen.file.cup), page.screen.reading.with_unit) in report
    listed = re.sub("<[^>]*>", "", report.split(">Position of the contact in the cup<")[1].split("</table>")[0])
    assert "_" not in listed
    assert at_once.asked[-1][0] == "cup-stood"  # the orientations follow

    edits(page, "cup.inwards", "20")
    way = page.screen.file.aim["direction"]
    assert degrees(np.arctan2(-way[0], way[2])) == pytest.approx(20)  # the middle is to the left of a right hip
    leaning = bs.Sphere(cup=page.screen.file.cup).press(HIP_36, force=3000.0, direction=way)
    assert f'"{degrees(leaning.tilt):.4g}", "°"' in told(page, "cup-numbers")
    edits(page, "cup.side", "left")
    assert page.screen.file.aim["direction"][0] == pytest.approx(-way[0])
    assert f'"{degrees(leaning.tilt):.4g}", "°"' in told(page, "cup-numbers")  # a mirror changes nothing
    assert "load.direction=" in page.channel.shown_value("link")
    assert opened(page.channel.shown_value("link")).screen == page.screen

    edits(page, "cup.inwards", 0)
    edits(page, "cup.pick", [75.0, 12.34])
    assert degrees(page.screen.file.cup.anteversion) == pytest.approx(12.3)
    assert "✗ Edge loading: the contact reaches the rim" in told(page, "cup-numbers")
    first, *_, last = blocks(page, "cup-numbers", "checks")[0]["rows"]
    assert (first["title"], first["state"], last["state"]) == ("reach of the contact", "exceeded", "unknown")
    edits(page, "cup.inclination", 90)
    assert "dislocated: the load pushes the ball out" in told(page, "cup-trouble")
    assert told(page, "cup-numbers") == ""


def test_an_orientation_of_zero_is_shown_and_not_replaced():
    """A cup without an orientation is offered the usual one, and its map has no directions of the body."""
    upright, default = (bs.Sphere(cup=cup).press(HIP, force=2000.0) for cup in (Cup(inclination=0.0), Cup()))
    assert "cup.usual" in _hint(default)
    assert _hint(upright) == ""
    assert ">anterior</text>" in pressed_bore(upright)
    assert ">anterior</text>" not in pressed_bore(default)


def test_a_load_is_aimed_in_the_body_or_from_the_cups_axis(at_once):
    page = opened(CUP_LINK)
    assert page.channel.shown_value("=cup.tilt")["hidden"]
    assert not page.channel.shown_value("=cup.inclination")["hidden"]
    edits(page, "cup.aim", "axis")
    assert page.screen.file.aim["tilt"] == pytest.approx(page.screen.file.cup.tilt((0.0, 0.0, 1.0)))
    assert page.channel.shown_value("=cup.inclination")["hidden"]
    assert "turns with the cup" in told(page, "cup-stood")
    edits(page, "cup.tilt", 30)
    assert page.screen.file.aim == {"tilt": pytest.approx(radians(30))}
    does(page, "edit", name="angle", value="radians")
    edits(page, "cup.tilt", 0.5)
    assert page.screen.file.aim == {"tilt": pytest.approx(0.5)}
    edits(page, "cup.aim", "body")
    assert page.screen.file.aim == {}


def test_a_bore_whose_rings_are_on_disk_is_pressed_at_once(monkeypatch, asked):
    bs.Sphere(cup=Cup()).press(HIP_36, force=1.0)
    monkeypatch.setattr(real_cup, "RESULTS", ResultStore())
    monkeypatch.setattr(long_view.results, "RESULTS", real_cup.RESULTS)
    page = opened(CUP_LINK)
    assert "MPa" in told(page, "cup-numbers")
    assert {name for name, *_ in asked} == {"cup-stood"}


def test_a_bore_is_prepared_by_one_process_for_all_who_wait(monkeypatch):
    heard, runs = [], [Mock(news=lambda: RunFinished(True)) for _ in range(3)]
    begun = Mock(side_effect=runs)
    monkeypatch.setattr(jobs, "Run", begun)
    first, second = (Job(lambda key, news, name=name: heard.append((name, key, news.value))) for name in "ab")
    (bore, work), (other, other_work) = (
        (arc, partial(real_cup.set_up, HIP_36, Cup(arc_of_cover=arc))) for arc in (3.0, 2.5)
    )
    first.ask(bore, work)
    second.ask(bore, work)
    assert begun.call_count == 1
    first.stop()
    assert second.works
    assert not runs[0].stop.called
    first.ask(bore, work)
    first.hear()
    assert sorted(heard) == [("a", bore, True), ("b", bore, True)]
    assert runs[0].stop.called
    first.ask(bore, work)
    second.ask(other, other_work)
    assert begun.call_count == 3


def test_a_map_of_orientations_says_how_many_keep_off_the_rim():
    angles = {"inclination": np.radians([20.0, 40.0, 60.0]), "anteversion": np.radians([0.0, 20.0])}
    apart = np.array([[5.0, 4.0], [2.0, 1.0], [-2.0, -3.0]])
    fields = {name: np.zeros((3, 2)) for name in ("valid", "tilt", "edge_loaded", "half_angle", "status")}
    fields |= {"edge_distance": apart, "max_pressure": 10 + apart**2}
    made = Orientations(
        **angles, **fields, model=bs.Sphere(), joint=HIP_36, load={"force": 3000.0}, contacts=(), seconds=0.0
    )
    picture = angle_map(made, Cup(inclination=radians(40.0)), "edge_distance")
    assert "67 % of the orientations keep the contact off the rim" in picture
    assert "furthest, 5 mm, at inclination 20°, anteversion 0°" in picture
    assert 'class="here"' in picture
    ends = re.search(r'class="limit" d="M([\d.]+),.*L([\d.]+),', picture).groups()
    assert {float(x) for x in ends} == {58 + 368 * 0.75, 58 + 368 * 0.625}  # at 50° without anteversion, 45° with 20°
    assert 'class="here"' not in angle_map(made, Cup(), "edge_distance")
    assert "edge distance [in]" in angle_map(made, Cup(), "edge_distance", Reading(units=Units.IMPERIAL))
    lost = replace(made, status=np.full((3, 2), int(Status.DISLOCATED)))
    assert "in every orientation of the map the contact reaches the rim" in angle_map(lost, Cup(), "max_pressure")


@pytest.mark.long
def test_the_map_is_that_of_python(monkeypatch):
    page = opened(CUP_LINK)
    angles = {name: getattr(real_cup, f"{name.upper()}S")[::5] for name in ("inclination", "anteversion")}
    for name, values in angles.items():
        monkeypatch.setattr(real_cup, f"{name.upper()}S", values)
    found = real_cup.map_orientations(page.screen.file, lambda news: None)
    asked = bs.orient(HIP_36, model=bs.Sphere(cup=Cup(side=Side.RIGHT)), force=3000.0, **angles)
    assert found.edge_distance == pytest.approx(asked.edge_distance, rel=1e-5)  # as far as a press is solved
    assert orientation_figure(found).axes  # of the report, without the contacts
