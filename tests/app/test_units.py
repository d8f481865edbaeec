"""Shop language: diameters, sizes of catalogues, and one switch to inches and pounds that holds everywhere."""

import csv
import io
import re
from html import unescape

import pytest

import ballsocket as bs

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app.session import Page
from ballsocket.app.widgets.reading import Reading, handy_step
from ballsocket.core.quantities import QUANTITIES
from ballsocket.reports.unit_systems import Units

from .asking import does, edits, saved, told, trouble

HIP = bs.joints["hip-28"]
PSI, LBF = 145.0377377, 0.2248089431  # of a MPa and of a N
IMPERIAL = "preset=hip-28&load.force=3000&units=imperial"
METRIC = re.compile(r"[\d.]\s*(?:</?\w[^>]*>\s*)*(?:mm|µm|N|kN|MPa|kN/mm|mm²|N mm|MPa/mm)\b|\[(?:mm|µm|k?N|MPa|mm²)\b")


def field(page, name):
    return page.channel.shown_value(f"={name}")


def test_a_page_speaks_of_diameters_and_of_what_makers_offer():
    page = Page("")
    heads, shells = (field(page, name) for name in ("ball_radius", "outer_radius"))
    assert (heads["label"], heads["value"], heads["unit"]) == ("Head diameter", 28.0, "mm")
    assert {"22.225", "28", "32", "36"} <= set(heads["sizes"])
    assert "52" in shells["sizes"]
    assert field(page, "clearance")["label"] == "Diametral clearance"
    edits(page, "ball_radius", "3,2 cm")
    assert page.screen.file.joint.ball_radius == pytest.approx(16.0, rel=1e-12)


def test_a_number_typed_before_a_choice_of_units_has_the_units_before_it():
    """The page states the units in which a number was typed: a slow line may bring it after the choice."""
    page = Page("preset=hip-28&load.force=3000")
    before = {"units": "SI", "size": "diameter", "angle": "degrees"}
    does(page, "choose", name="units", value="imperial")
    does(page, "choose", name="size", value="radius")
    does(page, "edit", name="ball_radius", value="30", units=before)
    assert page.screen.file.joint.ball_radius == pytest.approx(15.0, rel=1e-12)
    does(page, "edit", name="load", value="-3", units=before)
    assert "must be zero or positive, got -3 N" in trouble(page)
    does(page, "edit", name="load", value="3", units={"units": "SI"})
    assert "must have units, size, angle" in trouble(page)
    assert (page.screen.units, page.screen.size) == ("imperial", "radius")


def test_a_body_weight_is_in_the_units_of_the_page():
    page = Page("view=wear&use.cycle=walking&units=imperial")
    assert (field(page, "wear.body_weight")["unit"], field(page, "wear.body_weight")["text"]) == ("lbf", "180")
    edits(page, "wear.body_weight", "200")
    assert page.screen.use.body_weight == pytest.approx(200 / LBF, rel=1e-9)
    edits(page, "wear.body_weight", "80 kN")
    assert "Body weight must be" in trouble(page)
    assert "lbf" in trouble(page)


def test_every_number_beside_a_box_has_its_label_and_its_unit():
    fields = {name: said for name, said in Page("").inputs.items() if said["kind"] == "number"}
    assert {name for name, said in fields.items() if not said["unit"]} == {"liner_poisson", "ball_poisson"}
    assert len({said["label"] for said in fields.values()}) == len(fields)


def test_inches_and_pounds_hold_on_the_whole_page_and_come_back_as_they_were():
    page = Page("preset=hip-28&load.force=3000")
    before = page.screen
    does(page, "choose", name="units", value="imperial")
    assert trouble(page) == ""
    contact = bs.Exact().press(HIP, force=3000.0)
    said = {name: field(page, name) for name in ("ball_radius", "load", "liner_young", "allowable")}
    assert [said[name]["unit"] for name in said] == ["in", "lbf", "ksi", "psi"]
    assert said["ball_radius"]["value"] == pytest.approx(28 / 25.4)
    assert said["load"]["value"] == pytest.approx(3000 * LBF)
    numbers, section, table = (told(page, f"press-{part}") for part in ("numbers", "section", "table"))
    (first, *_) = re.findall(r"data-value='([^']+)'", numbers)
    assert float(first) == pytest.approx(contact.max_pressure * PSI)
    assert {"⌀ 1.102 in", "674 lbf"} <= set(re.findall(r"<text[^>]*>([^<]*)</text>", section))
    assert METRIC.findall(numbers + section + told(page, "press-charts")) == []
    assert re.findall(r"\[[^\]]*\]", table)[:4] == ["[lbf]", "[mil]", "[°]", "[psi]"]
    edits(page, "ball_radius", "28 mm")
    edits(page, "load", "3 kN")
    does(page, "choose", name="units", value="SI")
    assert page.screen == before


def test_what_is_typed_is_in_the_unit_beside_the_box_or_in_its_own():
    page = Page(IMPERIAL)
    edits(page, "ball_radius", "1,25")
    assert page.screen.file.joint.ball_radius == pytest.approx(25.4 * 1.25 / 2)
    edits(page, "load", "700")
    assert page.screen.file.load == {"force": pytest.approx(700 / LBF)}
    edits(page, "allowable", 3000)
    assert page.screen.file.joint.liner.allowable_pressure == pytest.approx(3000 / PSI)
    edits(page, "ball_radius", "wide")
    sentence = "Head diameter must be a number in inches, or a length such as '16 mm', got 'wide'"
    assert sentence in unescape(trouble(page))


def test_files_are_in_the_units_of_the_page():
    page = Page(IMPERIAL)
    rows = list(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    exact = next(row for row in rows if row["model"] == "exact")
    assert float(exact["max_pressure_psi"]) == pytest.approx(bs.Exact().press(HIP, force=3000.0).max_pressure * PSI)
    assert {"force_lbf", "indentation_mil", "half_angle_deg", "area_in2", "stiffness_kip_per_in"} <= set(exact)
    report = saved(page, "HTML").decode()
    assert "psi" in report
    assert "head diameter</td><td>1.102 in" in report
    page = Page(f"{IMPERIAL}&view=map")
    row = next(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    assert float(row["head_diameter_in"]) == pytest.approx(22 / 25.4)
    assert float(row["half_angle_deg"]) > 5.0
    assert {"max_pressure_psi", "area_in2", "force_lbf"} <= set(row)


def test_compared_designs_are_in_the_units_of_the_page():
    page = Page(f"{IMPERIAL}&view=compare&beside1.preset=hip-36")
    assert METRIC.findall(told(page, "compare-table") + told(page, "compare-charts")) == []
    assert "head ⌀ 1.417 in" in told(page, "compare-table")


def test_units_of_every_quantity_are_pounds_and_inches_or_have_none():
    reading = Reading(units=Units.IMPERIAL)
    left = {each.kind: reading.unit(each).text for each in QUANTITIES.values()}
    assert not {"mm", "µm", "N", "kN", "MPa", "N/mm", "mm2", "mm²"} & set(left.values())


@pytest.mark.parametrize(("step", "round_one"), [(0.0039, 0.002), (0.2, 0.2), (11.24, 10.0), (1450.0, 1000.0)])
def test_steps_are_round(step, round_one):
    assert handy_step(step) == pytest.approx(round_one)
