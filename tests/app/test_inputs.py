"""Numbers as people type and read them: fractions, bounds, refusals in the words of the field, inches and pounds."""

import csv
import io
import re
from html import unescape

import pytest

import ballsocket as bs
from ballsocket.app import session
from ballsocket.app.session import Page
from ballsocket.app.state.screen import START
from ballsocket.app.widgets.cup_fields import cup_edited, cup_fields
from ballsocket.app.widgets.fields import in_words_of
from ballsocket.app.widgets.joint_fields import joint_inputs
from ballsocket.app.widgets.numbers import CUP_NUMBERS, NUMBERS
from ballsocket.app.widgets.reading import box_text, handy_step, number_text
from ballsocket.core.quantities import QUANTITIES

from .asking import does, edits, saved, told, trouble
from .test_screen import screen_with

INCHES = screen_with(units="imperial")


def typed(name, value, screen=START):
    return joint_inputs(screen)[name].edit(value)


def field_of(name, screen=START):
    return joint_inputs(screen)[name].field


@pytest.mark.parametrize("text", ["1 1/8", "1-1/8", "9/8 in", "1.125", "28.575 mm"])
def test_a_diameter_in_inches_may_be_a_fraction(text):
    assert 2 * typed("ball_radius", text, INCHES).joint.ball_radius == pytest.approx(28.575, rel=1e-12)


def test_a_box_shows_a_number_that_can_be_read():
    inches = 32 / 25.4, 0.2 / 25.4, 0.001 / 25.4, 1.0625
    assert [box_text(value, "in") for value in inches] == ["1.26", "0.0079", "3.9e-05", "1.0625"]
    others = (22.225, "mm"), (26.1234567, "mm"), (674.427, "lbf"), (33.35868, "Mpsi"), (1234567.0, "N")
    assert [box_text(*pair) for pair in others] == ["22.225", "26.123", "674", "33.4", "1234600"]
    assert [number_text(value, "in") for value in (32 / 25.4, 0.2 / 25.4, 8.0)] == ["1.26", "0.0079", "8"]
    assert number_text(0.2 / 25.4) == "0.007874"


def test_moduli_have_the_units_of_engineers():
    liner, ball = field_of("liner_young", INCHES), field_of("ball_young", INCHES)
    assert (liner["unit"], ball["unit"]) == ("ksi", "Mpsi")
    assert 25 < float(ball["text"]) < 40  # a metal
    assert typed("liner_young", "109", INCHES).joint.liner.young == pytest.approx(109 * 6.894757293168)
    assert typed("load", "700", INCHES).load == {"force": pytest.approx(700 / LBF)}
    assert typed("allowable", 3000, INCHES).joint.liner.allowable_pressure == pytest.approx(3000 / PSI)


@pytest.mark.parametrize("name", [*NUMBERS, "load", "tilt", "allowable"])
def test_no_box_takes_what_no_joint_has(name):
    for value in ("1e12", "-1e12", "inf", "nan", "x" * 5000, *[""] * (name != "allowable")):
        with pytest.raises(ValueError, match=f"^{re.escape(field_of(name)['label'])}.* must be .{{1,150}}$"):
            typed(name, value)


@pytest.mark.parametrize("name", CUP_NUMBERS)
def test_no_box_of_a_cup_takes_what_no_cup_has(name):
    with pytest.raises(ValueError, match=f"^{re.escape(cup_fields(START)[f'cup.{name}']['label'])} must be "):
        cup_edited(START, name, 1e9)


@pytest.mark.parametrize(
    ("screen", "name", "text", "sentence"),
    [
        (START, "ball_radius", "-5", "Head diameter must be positive, got -5 mm"),
        (screen_with(size="radius"), "ball_radius", "-5", "Ball radius must be positive, got -5 mm"),
        (INCHES, "ball_radius", "4000", "Head diameter must be 7.9e-05 to 787.4 in .*, got 4000 in"),
        (INCHES, "ball_radius", "wide", "Head diameter must be a number in inches, or a length such as '16 mm', .*"),
        (INCHES, "ball_radius", "1,125", "Head diameter '1,125' could be two numbers: write 1125 or 1.125"),
        (START, "clearance", "-0.1", "Diametral clearance must be zero or positive, got -0.1 mm"),
    ],
)
def test_a_refusal_speaks_of_the_field_and_its_unit(screen, name, text, sentence):
    with pytest.raises(ValueError, match=f"^{sentence}$"):
        typed(name, text, screen)


def test_a_refusal_of_the_mechanics_has_the_words_of_the_field_too():
    field = field_of("outer_radius")
    with pytest.raises(ValueError, match="outer_radius = 5.0 is not allowed") as refused:
        typed("outer_radius", "10")
    sentence = rf"Outer diameter 10 mm is not allowed: it must leave a liner.*; {field['text']} mm stays in use"
    assert re.fullmatch(sentence, in_words_of(field, str(refused.value), "10 mm"))


def test_a_changed_preset_keeps_its_name_but_not_its_source():
    changed = typed("ball_radius", "30")
    assert (changed.joint.name, changed.joint.source) == ("hip-28 (changed)", "")
    assert START.file.joint.source
    assert typed("ball_radius", "28", screen_with(file=changed)).joint == START.file.joint
    named = typed("name", " Anna  Meier ")
    assert (named.joint.name, named.joint.source) == ("Anna Meier", START.file.joint.source)
    assert typed("clearance", "0.3", screen_with(file=named)).joint.name == "Anna Meier"


@pytest.mark.parametrize("name", ["x" * 81, "a\x1bb", "\ud800", 3, None])
def test_a_name_is_short_text(name):
    with pytest.raises(ValueError, match="the name"):
        typed("name", name)


MAP = "view=map&preset=hip-28&load.force=3000&across=ball_radius=11..23"
LIMITED = f"{MAP}&limit=max_pressure<=12"
HUGE = 10**400
WALK = "phase [%], force [N], flexion [deg]\n0, 300, 20\n25, 2000, 0\n100, 300, 20\n"


@pytest.mark.parametrize(
    ("link", "name", "value", "sentence"),
    [
        ("", "load", "3,000", "Normal force '3,000' could be two numbers: write 3000 or 3.000"),
        ("", "load", HUGE, "the integer is too large"),
        ("", "liner_poisson", "0,7", "Liner Poisson's ratio must be -0.999 to 0.5 (the limits of an isotropic solid)"),
        ("", "clearance", None, "Diametral clearance must be a number in mm, or a length such as '16 mm', got None"),
        ("", "clearence", "1", "'clearence' among the inputs is not known"),
        ("", "liner", 3, "liner = 3 is not a material"),
        ("", "preset", "hip-29", "'hip-29' as preset is not known"),
        ("", "kind", ["force"], "as load is not known"),
        ("", "massive", "yes", "must be true or false"),
        ("", "behind.add", "cheese", "'cheese' as material is not known"),
        ("", "behind.0", "titanium", "'0' among the layers is not known"),
        ("", "behind.support", "loose", "'loose' as support is not known"),
        (MAP, "map.pick", [HUGE, 1], "the integer is too large"),
        (f"{LIMITED}&up=outer_radius=15..30", "map.drag", [0, 22.0, 16.0], "<p"),
        (LIMITED, "map.drag", [0, 1], "<p"),
        (LIMITED, "map.drag", "elsewhere", "<p"),
        (LIMITED, "map.drag", [7, 20.0, 8.0], "<p"),
        (MAP, "map.limits", "outer_radius<=26", "<p"),
        (MAP, "map.limits", [["outer_radius", "<="]], "<p"),
        (MAP, "map.limits", [["frob", "<=", "3"]], "<p"),
        (MAP, "map.limits", [["force", "=", "3"]], "<p"),
        ("view=wear", "wear.coefficient", "much", "coefficient = 'much'"),
        ("view=wear", "wear.millions", "0", "Million cycles 0"),
        ("view=wear", "wear.spread", "0.5", "Patient-to-patient factor 0.5"),
        ("view=wear", "wear.law", "magic", "'magic' as law is not known"),
        ("view=wear", "wear.creep", True, "creep = True is not a choice"),
        ("view=wear", "wear.beside", "my hip", "'my hip' as design is not known"),
        ("view=cup", "cup.inclination", "91", "Inclination must be 0 to 90° (from an upright axis to a level one)"),
        ("view=cup", "cup.arc_of_cover", "0", "Arc of cover must be 40 to 340° (the ball must stay in its socket)"),
        ("view=cup", "cup.side", "middle", "side = 'middle' is not allowed"),
        ("view=cup", "cup.aim", "up", "'up' as aim is not known"),
        ("view=cup", "cup.pick", [1.0], "is not a point of the map"),
        ("view=cup", "cup.pick", [1, HUGE], "the integer is too large"),
        ("view=cup", "cup.show", "area", "'area' as standing is not known"),
        ("view=cup", "cup.colour", "red", "'colour' among the inputs of a cup"),
        ("view=gait", "gait.cycle", "dancing", "'dancing' as cycle is not known"),
        ("view=gait", "gait.body_weight", "0", "Body weight must be positive, got 0 N"),
        ("view=gait", "gait.instant", "seven", "an instant of a cycle is a whole number"),
        ("view=gait", "gait.instant", -1, "instant = -1"),
        ("view=gait", "gait.own", {"name": "walk.exe", "text": WALK}, "'walk.exe' is not a table of a cycle"),
        ("view=gait", "gait.own", {"name": "a.csv", "text": "", "size": 10**9}, "longer than 100000 characters"),
        ("view=gait", "gait.own", "walk.csv", "has a name and a text"),
        ("view=evidence", "evidence.influence", "huge", "influence"),
    ],
    ids=lambda value: str(value)[-20:],
)
def test_a_value_that_no_input_takes_gets_one_sentence_and_stays_in_its_box(asked, link, name, value, sentence):
    page = Page(link)
    before = page.screen
    edits(page, name, value)
    assert sentence in unescape(trouble(page))
    assert (page.screen, page.screen.link) == (before, before.link)
    edits(page, name, (page.channel.shown_value(f"={name}") or {}).get("text"))  # the box as it was
    edits(page, "load", 2900)
    assert page.screen.file.load["force"] == 2900


@pytest.mark.parametrize(
    ("pairs", "sentence"),
    [
        ("use.cycle=dance", "'dance' as cycle"),
        ("use.body_weight=-1", "body_weight = -1"),
        ("use.coefficient=-1", "coefficient = -1"),
        ("use.millions=1000", "millions = 1000"),
        ("use.speed=1", "'speed' of a hip in use in the link"),
        *((f"use.instant={number}", "instant = ") for number in ("inf", "nan", "1e400", "2.5", "-1")),
        ("joint.ball_radiuss=3", "'ball_radiuss' in [joint] is not known; did you mean 'ball_radius'?"),
    ],
)
def test_a_link_that_cannot_be_read_says_so_and_the_page_goes_on(pairs, sentence, caplog):
    page = Page(f"view=gait&{pairs}")
    assert "This link cannot be read: " in trouble(page)
    assert sentence.replace("'", "&#x27;") in trouble(page).replace("&#39;", "&#x27;")
    assert not caplog.records
    edits(page, "load", 2900)
    assert page.screen.file.load == {"force": 2900}


def test_a_refusal_goes_with_the_next_change():
    page = Page("view=judge")
    assert edits(page, "judge.arc_of_cover", "20")["reset"]
    assert "20" in trouble(page)
    assert page.screen == Page("view=judge").screen
    edits(page, "judge.arc_of_cover", "150")
    assert trouble(page) == ""
    assert page.channel.shown_value("=judge.arc_of_cover")["value"] == pytest.approx(150)


def test_designs_are_counted_before_they_are_read(monkeypatch):
    """Seventy thousand links took the time of all users for seconds."""
    page, reads = Page(""), []
    monkeypatch.setattr(session, "read_link", reads.append)
    edits(page, "designs.compare", [""] * 70_000)
    assert not reads
    assert "at most 6 designs" in trouble(page)


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
    fields = {name: said for name, said in page.inputs.items() if said["kind"] == "number"}
    assert {name for name, said in fields.items() if not said["unit"]} == {"liner_poisson", "ball_poisson"}
    assert len({said["label"] for said in fields.values()}) == len(fields)
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


def test_files_and_compared_designs_are_in_the_units_of_the_page():
    page = Page(IMPERIAL)
    rows = list(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    exact = next(row for row in rows if row["model"] == "exact")
    assert float(exact["max_pressure_psi"]) == pytest.approx(bs.Exact().press(HIP, force=3000.0).max_pressure * PSI)
    assert {"force_lbf", "indentation_mil", "half_angle_deg", "area_in2", "stiffness_kip_per_in"} <= set(exact)
    assert "head diameter</td><td>1.102 in" in saved(page, "HTML").decode()
    page = Page(f"{IMPERIAL}&view=map")
    row = next(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    assert float(row["head_diameter_in"]) == pytest.approx(22 / 25.4)
    assert float(row["half_angle_deg"]) > 5.0
    assert {"max_pressure_psi", "area_in2", "force_lbf"} <= set(row)
    page = Page(f"{IMPERIAL}&view=compare&beside1.preset=hip-36")
    assert METRIC.findall(told(page, "compare-table") + told(page, "compare-charts")) == []
    assert "head ⌀ 1.417 in" in told(page, "compare-table")


def test_units_of_every_quantity_are_pounds_and_inches_or_have_none():
    left = {INCHES.reading.unit(each).text for each in QUANTITIES.values()}
    assert not {"mm", "µm", "N", "kN", "MPa", "N/mm", "mm2", "mm²"} & left


def test_steps_are_round():
    assert list(map(handy_step, (0.0039, 0.2, 11.24, 1450.0))) == pytest.approx([0.002, 0.2, 10.0, 1000.0])
