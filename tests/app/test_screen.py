"""The screen as links and files of designs, and numbers as people type and read them: bounds, refusals, units."""

import csv
import io
import json
import re
import tomllib
from dataclasses import replace
from html import unescape
from math import inf, pi
from pathlib import Path
from urllib.parse import parse_qs

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.app import session
from ballsocket.app.session import Page
from ballsocket.app.state import screen as screen_module
from ballsocket.app.state.designs import MAX_DESIGNS, file_stem, read_upload, session_text
from ballsocket.app.state.screen import START, MapAxis, Screen, link_of, link_of_file, read_link
from ballsocket.app.state.use import Use
from ballsocket.app.widgets import design_table, words
from ballsocket.app.widgets.controls import by_name, fields_of, refusal_of
from ballsocket.app.widgets.joint_controls import cup_controls, joint_controls
from ballsocket.app.widgets.reading import box_text, handy_step, number_text
from ballsocket.contact import Contact
from ballsocket.core.kinds import Kind
from ballsocket.core.quantities import CONTACT, QUANTITIES, Quantity
from ballsocket.core.unit_systems import Units
from ballsocket.files.joint_file import JointFile, parse_joint, read_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.files.toml import MAX_FILE_SIZE
from ballsocket.problem.cup import Cup, Interface, Side
from ballsocket.problem.presets import materials

from ..places import EXAMPLES
from ..refusals import text_tables
from .asking import cells, does, edits, numbers, saved, told, trouble


def screen_with(query="preset=hip-28", **changes):
    return replace(read_link(parse_qs(query)), **changes)


lengths = st.floats(1e-3, 1e3)
names = st.text(st.characters(exclude_categories=("Cc", "Cs")), max_size=8)
presets, moduli = st.sampled_from(list(materials.values())), st.floats(1.0, 1e6)
changed_presets = st.builds(lambda one, young: replace(one, young=young), presets, moduli)
made_materials = presets | st.builds(bs.Material, young=moduli, poisson=st.floats(-0.9, 0.5)) | changed_presets
layers = st.builds(bs.Layer, thickness=lengths, material=made_materials)
made_joints = st.builds(
    bs.Joint,
    ball_radius=lengths,
    clearance=st.floats(0.0, 10.0),
    liner_thickness=lengths,
    liner=made_materials,
    ball=st.one_of(st.none(), made_materials),
    backing=st.lists(layers, max_size=2).map(tuple),
    support=st.sampled_from(list(bs.Support)),
    name=names,
    source=names,
)
cup_sizes = {"arc_of_cover": st.floats(0.8, 5.9), "chamfer": st.floats(0.0, 2.0)}
orientation = {"inclination": st.floats(0.0, pi / 2), "anteversion": st.floats(-pi / 2, pi / 2)}
choices = {"interface": st.sampled_from(Interface), "side": st.sampled_from(Side)}
cups = st.builds(Cup, **cup_sizes, **orientation, **choices)
load_ranges = {"force": (1e-3, 1e5), "indentation": (1e-6, 1.0), "half_angle": (0.01, 1.5)}
loads = st.one_of(*(st.fixed_dictionaries({name: st.floats(*ends)}) for name, ends in load_ranges.items()))
models = st.sampled_from(list(bs.catalogue))
ways = st.tuples(*3 * (st.floats(-1e3, 1e3),)).filter(lambda way: any(abs(each) > 1e-3 for each in way))
aims = st.one_of(st.just({}), st.builds(lambda way: {"direction": way}, ways), st.just({"tilt": 0.5}))
made_files = st.builds(JointFile, made_joints, loads, cups, aims)
axes = st.sampled_from([("ball_radius", "liner_thickness"), ("clearance", "force"), ("liner_poisson", "outer_radius")])

CHOICES = "view", "map_model", "angle", "size", "theme"


@st.composite
def screens(draw):
    ends = st.tuples(lengths, lengths).filter(lambda pair: pair[0] < pair[1])
    across, up = (MapAxis(name=name, low=low, high=high) for name in draw(axes) for low, high in [draw(ends)])
    drawn = {name: draw(st.sampled_from(getattr(screen_module, f"{name.upper()}S"))) for name in CHOICES}
    return Screen(
        file=draw(made_files),
        beside=tuple(draw(st.lists(made_files, max_size=2))),
        shown=tuple(draw(st.lists(models, max_size=3, unique=True))),
        answered_by=draw(models),
        across=across,
        up=up,
        **drawn,
    )


def near(one, other):
    """Angles turn to degrees and back; all else is the same."""
    angles = {name: getattr(one.cup, name) for name in ("arc_of_cover", "inclination", "anteversion")}
    return (
        one == replace(other, load=one.load, cup=replace(other.cup, **angles))
        and other.load == pytest.approx(one.load, rel=1e-14)
        and {name: getattr(other.cup, name) for name in angles} == pytest.approx(angles, rel=1e-14)
    )


def assert_same(screen, again):
    assert near(screen.file, again.file)
    assert all(near(*pair) for pair in zip(screen.beside, again.beside, strict=True))
    assert replace(screen, file=START.file, beside=()) == replace(again, file=START.file, beside=())


def test_presets_make_short_links_and_the_link_to_a_file_opens_its_joint():
    assert link_of(START) == "preset=hip-28&load.force=3000.0&theme=light"
    assert read_link(parse_qs(link_of(START))) == START
    file = read_joint(EXAMPLES / "metal_backed_hip.toml")
    opened = read_link(parse_qs(link_of_file(file).removeprefix("?"))).file
    assert (opened.joint, opened.joint.given_lengths, opened.load) == (file.joint, file.joint.given_lengths, file.load)
    assert read_link({"load.force": ["5000"]}) == replace(START, file=replace(START.file, load={"force": 5000.0}))
    for changes in ({"shown": ()}, {"use": Use(instant=0, spread=5.0, millions=50.0)}):  # no curves; ends of ranges
        changed = replace(START, **changes)
        assert read_link(parse_qs(changed.link, keep_blank_values=True)) == changed


def test_a_massive_socket_is_written_and_arrays_are_not():
    file = JointFile(bs.joints["tilting-pad-pivot"], {"force": 1e3})
    assert "liner_thickness = inf" in toml_of(file)
    assert parse_joint(toml_of(file).encode(), "file").joint.liner_thickness == inf
    many = replace(bs.joints["hip-28"], clearance=np.array([0.1, 0.2]))
    with pytest.raises(ValueError, match="a joint file holds one joint"):
        toml_of(JointFile(many, {}))


REST = "joint.clearance=1&joint.liner_thickness=2&liner.material=pom"


LINKS, VALUES, SESSIONS, _ = text_tables(Path(__file__).parent / "refused.txt")
LINKS += [
    ("joint.ball_radius=" + "1" * 7000 + "!", "joint.ball_radius|a length|the liner needs"),
    ("a" * 7900 + "=1", "'aaaa.* in the link is not known"),
    ("limit=force<=1&" * 21, "a map has at most 20 limits, got 21"),
    ("across=force=" + " .." * 1500 + "%0a", "is not a range"),
    ("name=" + "x" * 9000, "the link is longer than 8000 characters"),
]


@pytest.mark.parametrize(("link", "message"), LINKS)
def test_a_bad_link_is_one_sentence(link, message):
    with pytest.raises(ValueError, match=message):
        read_link(parse_qs(link))


EXAMPLE = EXAMPLES / "designs.toml"
JOINT = """[[design]]
joint = {ball_radius = "14 mm", clearance = 0.1, liner_thickness = 5}
liner = {material = "pom"}
"""


@given(st.lists(screens(), min_size=1, max_size=3))
def test_links_and_the_tables_of_a_session_file_bring_every_design_back(designs):
    again = read_upload(session_text([link_of(screen) for screen in designs]), START)
    for screen, read in zip(designs, again, strict=True):
        assert_same(replace(screen, theme="light"), read)


def test_a_session_file_has_designs_and_their_pages_as_toml_and_json_and_is_no_joint_file():
    text = EXAMPLE.read_text(encoding="utf-8")
    small, large = read_upload(text, START)
    assert read_upload(json.dumps(tomllib.loads(text)), START) == [small, large]
    assert [float(screen.file.joint.ball_radius) for screen in (small, large)] == [14.0, 18.0]
    assert (small.view, large.view, large.units) == ("press", "map", "imperial")
    assert [limit.name for limit in large.limits] == ["outer_diameter", "max_pressure"]
    with pytest.raises(ValueError, match=r"^designs.toml: .*; this is a session file with 2 of"):
        read_joint(EXAMPLE)


def test_a_joint_file_keeps_the_page_and_names_no_picture_of_the_server():
    text = '[joint]\nball_radius = 18\nclearance = 0.1\nliner_thickness = 6\n[liner]\nmaterial = "pom"\n'
    screen = read_link(parse_qs("preset=hip-28&load.force=900&units=imperial"))
    (read,) = read_upload(f'{text}[report]\nlogo = "/etc/secret.png"\ncustomer = "A"\n', screen)
    assert (read.units, read.file.load, read.file.report.logo) == ("imperial", {"force": 900.0}, None)
    assert read.file.joint.liner == bs.POM
    assert read_link(parse_qs(link_of(read), keep_blank_values=True)) == read


SESSIONS += [
    ("", "the file is empty"),
    ("[" * 50_000, "the file is not TOML|nested"),
    ('{"a":' * 19_000, "the file is not JSON"),
    ("x" * (MAX_FILE_SIZE + 1), f"the file is larger than {MAX_FILE_SIZE} bytes"),
    ('{"design": []}', f"the file: a session has 1 to {MAX_DESIGNS} designs, got 0"),
    ("[[design]]\n" * (MAX_DESIGNS + 1), f"a session has 1 to {MAX_DESIGNS} designs, got {MAX_DESIGNS + 1}"),
]


@pytest.mark.parametrize(("text", "sentence"), SESSIONS)
def test_a_bad_session_file_is_one_sentence(text, sentence):
    with pytest.raises(ValueError, match=sentence) as refused:
        read_upload(text.replace("{joint}", JOINT).replace("\\n", "\n"), START)
    assert len(str(refused.value)) < 400


def test_what_could_not_be_read_is_not_written():
    link = link_of(replace(START, file=replace(START.file, joint=replace(START.file.joint, name="ü" * 900))))
    with pytest.raises(ValueError, match=f"the session file would be larger than {MAX_FILE_SIZE} bytes"):
        session_text([link + "&ask.context=" + "y" * 999] * MAX_DESIGNS)
    with pytest.raises(ValueError, match=f"a session has 1 to {MAX_DESIGNS} designs, got 0"):
        session_text([])
    with pytest.raises(ValueError, match="'frob' in the link is not known"):
        session_text(["frob=1"])


def test_a_file_has_the_name_of_its_design():
    names = "hip-28 (changed)", "../../etc/passwd", "a<b>:c|d?*", "Hüfte 3", "nul.txt", ""
    stems = ["hip-28-changed", "etc-passwd", "a-b-c-d", "Hüfte-3", "design-nul.txt", "ballsocket"]
    assert [file_stem(name) for name in names] == stems


@pytest.mark.long
@given(st.text(max_size=100))
def test_a_file_name_is_one_that_every_system_takes(name):
    stem = file_stem(name)
    assert stem
    assert len(stem.encode()) < 250
    assert not set(stem) & set('<>:"/\\|?*\0 ')
    assert stem[0] not in ".-"
    assert stem[-1] not in ". "


INCHES = screen_with(units="imperial")


def typed(name, value, screen=START):
    return by_name(joint_controls(screen))[name].read(value)["file"]


def field_of(name, screen=START):
    return by_name(joint_controls(screen))[name].field


@pytest.mark.parametrize("text", ["1 1/8", "1-1/8", "9/8 in", "1.125", "28.575 mm"])
def test_a_diameter_in_inches_may_be_a_fraction(text):
    assert 2 * typed("ball_radius", text, INCHES).joint.ball_radius == pytest.approx(28.575, rel=1e-12)


def test_a_box_shows_a_number_that_can_be_read_in_round_steps():
    inches = 32 / 25.4, 0.2 / 25.4, 0.001 / 25.4, 1.0625
    assert [box_text(value, "in") for value in inches] == ["1.26", "0.007874", "3.937e-05", "1.0625"]
    others = (22.225, "mm"), (26.1234567, "mm"), (674.427, "lbf"), (33.35868, "Mpsi"), (1234567.0, "N")
    assert [box_text(*pair) for pair in others] == ["22.225", "26.123", "674.4", "33.36", "1234600"]
    assert [number_text(value) for value in (32 / 25.4, 0.2 / 25.4, 8.0)] == ["1.26", "0.007874", "8"]
    assert list(map(handy_step, (0.0039, 0.2, 11.24, 1450.0))) == pytest.approx([0.002, 0.2, 10.0, 1000.0])


def test_moduli_have_the_units_of_engineers_and_no_quantity_a_metric_one():
    liner, ball = field_of("liner_young", INCHES), field_of("ball_young", INCHES)
    assert (liner["unit"], ball["unit"]) == ("ksi", "Mpsi")
    assert 25 < float(ball["text"]) < 40  # a metal
    assert typed("liner_young", "109", INCHES).joint.liner.young == pytest.approx(109 * 6.894757293168)
    assert typed("load", "700", INCHES).load == {"force": pytest.approx(700 / LBF)}
    assert typed("allowable", 3000, INCHES).joint.liner.allowable_pressure == pytest.approx(3000 / PSI)
    left = {INCHES.reading.unit(each).text for each in QUANTITIES.values()}
    assert not {"mm", "µm", "N", "kN", "MPa", "N/mm", "mm2", "mm²"} & left


CONTROLS = by_name((*joint_controls(START), *cup_controls(START)))
BOXES = {name: control for name, control in CONTROLS.items() if control.field["kind"] == "number"}


@pytest.mark.parametrize("name", BOXES)
def test_no_box_takes_what_no_joint_or_cup_has(name):
    for value in ("1e12", "-1e12", "inf", "nan", "x" * 5000, *[""] * (name != "allowable")):
        with pytest.raises(ValueError, match=f"^{re.escape(BOXES[name].field['label'])}.* must be .{{1,150}}$"):
            BOXES[name].read(value)


@pytest.mark.parametrize(
    ("screen", "name", "text", "sentence"),
    [
        (START, "ball_radius", "-5", "Head diameter must be positive, got -5 mm"),
        (screen_with(size="radius"), "ball_radius", "-5", "Ball radius must be positive, got -5 mm"),
        (START, "ball_radius", "1e-300", "Head diameter must be 0.002 to 20000 mm .*, got 1e-300 mm"),
        (START, "load", "1e9", "Normal force must be 0 to 624580 N .*mean pressure of Young's modulus.*, got .*"),
        (INCHES, "ball_radius", "4000", "Head diameter must be 7.874e-05 to 787.4 in .*, got 4000 in"),
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
    with pytest.raises(ValueError, match=r"outer_radius = 5(\.0)? is not allowed") as refused:
        typed("outer_radius", "10")
    sentence = rf"Outer diameter 10 mm is not allowed: it must leave a liner.*; {field['text']} mm stays in use"
    assert re.fullmatch(sentence, refusal_of(field, refused.value, "10 mm")["error"])


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
BACKED = f"joint.ball_radius=14&{REST}&backing.0.material=titanium&backing.0.thickness=3"
WALK = "phase [%], force [N], flexion [deg]\n0, 300, 20\n25, 2000, 0\n100, 300, 20\n"


SHORT = {"(start)": "", "{map}": MAP, "{limited}": LIMITED, "{backed}": BACKED}
TOO_LARGE = json.dumps(HUGE), "the integer is too large"
VALUES += [
    ("(start)", "load", *TOO_LARGE),
    ("{map}", "map.pick", f"[{HUGE}, 1]", TOO_LARGE[1]),
    ("view=cup", "cup.pick", f"[1, {HUGE}]", TOO_LARGE[1]),
    ("view=gait", "gait.own", json.dumps({"name": "walk.exe", "text": WALK}), "'walk.exe' is not a table of a cycle"),
]


@pytest.mark.parametrize(("link", "name", "value", "sentence"), VALUES, ids=lambda value: str(value)[-20:])
def test_a_value_that_no_input_takes_gets_one_sentence_and_stays_in_its_box(asked, link, name, value, sentence):
    for short, long in SHORT.items():
        link = link.replace(short, long)
    page = Page(link)
    before = page.screen
    edits(page, name, json.loads(value))
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
        ("use.millions=50.1", "millions = 50.1"),
        ("use.spread=5.1", "spread = 5.1"),
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
    monkeypatch.setattr(session, "read_query", reads.append)
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
    fields = {name: said for name, said in fields_of(page.controls).items() if said["kind"] == "number"}
    assert {name for name, said in fields.items() if not said["unit"]} == {"liner_poisson", "ball_poisson"}
    assert len({said["label"] for said in fields.values()}) == len(fields)
    edits(page, "ball_radius", "3,2 cm")
    assert page.screen.file.joint.ball_radius == pytest.approx(16.0, rel=1e-12)


def test_a_number_typed_before_a_choice_of_units_has_the_units_before_it():
    """The page states the units in which a number was typed: a slow line may bring it after the choice."""
    page = Page("preset=hip-28&load.force=3000")
    before = {"units": "SI", "size": "diameter", "angle": "degrees"}
    does(page, "edit", name="units", value="imperial")
    does(page, "edit", name="size", value="radius")
    does(page, "edit", name="ball_radius", value="30", units=before)
    assert page.screen.file.joint.ball_radius == pytest.approx(15.0, rel=1e-12)
    does(page, "edit", name="load", value="-3", units=before)
    assert "must be zero or positive, got -3 N" in trouble(page)
    does(page, "edit", name="load", value="3", units={"units": "SI"})
    assert "must have units, size, angle" in trouble(page)
    assert (page.screen.units, page.screen.size) == ("imperial", "radius")


def test_a_body_weight_is_in_the_units_of_the_page():
    page = Page("view=wear&use.cycle=walking&units=imperial")
    assert (field(page, "wear.body_weight")["unit"], field(page, "wear.body_weight")["text"]) == ("lbf", "179.8")
    edits(page, "wear.body_weight", "200")
    assert page.screen.use.body_weight == pytest.approx(200 / LBF, rel=1e-9)
    edits(page, "wear.body_weight", "80 kN")
    assert "Body weight must be" in trouble(page)
    assert "lbf" in trouble(page)


def test_inches_and_pounds_hold_on_the_whole_page_and_come_back_as_they_were():
    page = Page("preset=hip-28&load.force=3000")
    before = page.screen
    does(page, "edit", name="units", value="imperial")
    assert trouble(page) == ""
    contact = bs.Exact().press(HIP, force=3000.0)
    said = {name: field(page, name) for name in ("ball_radius", "load", "liner_young", "allowable")}
    assert [said[name]["unit"] for name in said] == ["in", "lbf", "ksi", "psi"]
    assert said["ball_radius"]["value"] == pytest.approx(28 / 25.4)
    assert said["load"]["value"] == pytest.approx(3000 * LBF)
    said, section = (told(page, f"press-{part}") for part in ("numbers", "section"))
    assert numbers(page, "press-numbers")["max_pressure"] == pytest.approx(contact.max_pressure * PSI)
    assert {"⌀ 1.102 in", "674.4 lbf"} <= set(re.findall(r"<text[^>]*>([^<]*)</text>", section))
    assert METRIC.findall(said + section + told(page, "press-charts")) == []
    assert [head.split()[-1] for head in cells(page, "press-table")[0][1:5]] == ["[lbf]", "[mil]", "[°]", "[psi]"]
    edits(page, "ball_radius", "28 mm")
    edits(page, "load", "3 kN")
    does(page, "edit", name="units", value="SI")
    assert page.screen == before


def test_files_and_compared_designs_are_in_the_units_of_the_page():
    page = Page(IMPERIAL)
    rows = list(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    exact = next(row for row in rows if row["model"] == "exact")
    assert float(exact["max_pressure_psi"]) == pytest.approx(bs.Exact().press(HIP, force=3000.0).max_pressure * PSI)
    assert {"force_lbf", "indentation_mil", "half_angle_deg", "area_in2", "stiffness_kip_per_in"} <= set(exact)
    assert "head diameter</td><td>1.102 in" in saved(page, "HTML").decode()
    page = Page(f"{IMPERIAL}&view=map")
    assert "shell_thickness" not in str(page.channel.shown_value("=map.across"))  # this joint has no shell
    row = next(csv.DictReader(io.StringIO(saved(page, "CSV").decode())))
    assert float(row["head_diameter_in"]) == pytest.approx(22 / 25.4)
    assert float(row["half_angle_deg"]) > 5.0
    assert {"max_pressure_psi", "area_in2", "force_lbf"} <= set(row)
    page = Page(f"{IMPERIAL}&view=compare&beside1.preset=hip-36")
    assert METRIC.findall(told(page, "compare-table") + told(page, "compare-charts")) == []
    assert "head ⌀ 1.417 in" in told(page, "compare-table")


@pytest.mark.parametrize("units", Units)
def test_a_new_quantity_of_a_contact_is_in_the_numbers_the_file_and_the_table_of_designs(monkeypatch, units):
    new = Quantity("half_of_force", "F2", "half of the force", Kind.FORCE, "Half of the normal force.")
    monkeypatch.setattr(Contact, new.name, property(lambda contact: contact.force / 2), raising=False)
    for module in (words, design_table):
        monkeypatch.setattr(module, "CONTACT", {**CONTACT, new.name: new})
    screen, contact = screen_with("preset=hip-28", units=units), bs.Exact().press(HIP, force=3000.0)
    unit = screen.reading.unit(new)
    half, text = 1500.0 * unit.factor, number_text(1500.0 * unit.factor)
    said = words.headline(contact, None, Cup(), screen.reading)
    assert [new.name, new.title, text, f" {unit.text}", "", half, ""] in said[-3]["rows"]
    heads, row = words.number_rows("model", {"exact": contact}, screen.reading)
    assert row[heads.index(f"{new.name}_{unit.text}")] == pytest.approx(half)
    designs = {"design": design_table.ComparedDesign(file=screen.file, contact=contact)}
    rows = dict(design_table.design_rows(designs, "design", screen, [new.name]))
    assert rows[f"half of the force [{unit.text}]"][0] == [text]
