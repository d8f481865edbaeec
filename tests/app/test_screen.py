"""The screen as a link, as a joint file and as a session file of designs: what goes in comes out."""

import json
import tomllib
from dataclasses import replace
from math import inf, pi
from urllib.parse import parse_qs

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.app.state import screen as screen_module
from ballsocket.app.state.designs import MAX_DESIGNS, file_stem, read_upload, session_text
from ballsocket.app.state.screen import START, MapAxis, Screen, link_of, read_link
from ballsocket.files.joint_file import JointFile, parse_joint, read_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.files.toml import MAX_FILE_SIZE
from ballsocket.problem.cup import Cup, Interface, Side
from ballsocket.problem.presets import materials

from ..places import EXAMPLES


def screen_with(query="preset=hip-28", **changes):
    """Return the screen of a link with other fields."""
    return replace(read_link(parse_qs(query)), **changes)


lengths = st.floats(1e-3, 1e3)
names = st.text(st.characters(exclude_categories=("Cc", "Cs")), max_size=8)
presets, moduli = st.sampled_from(list(materials.values())), st.floats(1.0, 1e6)
made_materials = st.one_of(
    presets,
    st.builds(bs.Material, young=moduli, poisson=st.floats(-0.9, 0.5)),
    st.builds(lambda one, young: replace(one, young=young), presets, moduli),
)
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
cups = st.builds(
    Cup,
    arc_of_cover=st.floats(0.8, 5.9),
    chamfer=st.floats(0.0, 2.0),
    interface=st.sampled_from(Interface),
    inclination=st.floats(0.0, pi / 2),
    anteversion=st.floats(-pi / 2, pi / 2),
    side=st.sampled_from(Side),
)
loads = st.one_of(
    st.fixed_dictionaries({"force": st.floats(1e-3, 1e5)}),
    st.fixed_dictionaries({"indentation": st.floats(1e-6, 1.0)}),
    st.fixed_dictionaries({"half_angle": st.floats(0.01, 1.5)}),
)
models = st.sampled_from(list(bs.catalogue))
ways = st.tuples(*3 * (st.floats(-1e3, 1e3),)).filter(lambda way: any(abs(each) > 1e-3 for each in way))
aims = st.one_of(st.just({}), st.builds(lambda way: {"direction": way}, ways), st.just({"tilt": 0.5}))
made_files = st.builds(JointFile, made_joints, loads, cups, aims)
axes = st.sampled_from([("ball_radius", "liner_thickness"), ("clearance", "force"), ("liner_poisson", "outer_radius")])


@st.composite
def screens(draw):
    ends = st.tuples(lengths, lengths).filter(lambda pair: pair[0] < pair[1])
    across, up = (MapAxis(name=name, low=low, high=high) for name in draw(axes) for low, high in [draw(ends)])
    return Screen(
        view=draw(st.sampled_from(screen_module.VIEWS)),
        file=draw(made_files),
        beside=tuple(draw(st.lists(made_files, max_size=2))),
        shown=tuple(draw(st.lists(models, max_size=3, unique=True))),
        answered_by=draw(models),
        across=across,
        up=up,
        map_model=draw(st.sampled_from(screen_module.MAP_MODELS)),
        angle=draw(st.sampled_from(screen_module.ANGLES)),
        size=draw(st.sampled_from(screen_module.SIZES)),
        theme=draw(st.sampled_from(screen_module.THEMES)),
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


@given(made_files)
def test_a_joint_file_that_is_written_is_read(file):
    assert near(file, parse_joint(toml_of(file).encode(), "file"))


@given(screens())
def test_a_link_leads_back(screen):
    assert_same(screen, read_link(parse_qs(link_of(screen), keep_blank_values=True)))


def test_presets_make_short_links():
    assert link_of(START) == "preset=hip-28&load.force=3000.0&theme=light"
    assert read_link(parse_qs(link_of(START))) == START
    assert read_link({"load.force": ["5000"]}) == replace(START, file=replace(START.file, load={"force": 5000.0}))
    bare = replace(START, shown=())  # without curves
    assert read_link(parse_qs(bare.link, keep_blank_values=True)) == bare


def test_a_massive_socket_is_written_and_arrays_are_not():
    file = JointFile(bs.joints["tilting-pad-pivot"], {"force": 1e3})
    assert "liner_thickness = inf" in toml_of(file)
    assert parse_joint(toml_of(file).encode(), "file").joint.liner_thickness == inf
    many = replace(bs.joints["hip-28"], clearance=np.array([0.1, 0.2]))
    with pytest.raises(ValueError, match="a joint file holds one joint"):
        toml_of(JointFile(many, {}))


REST = "joint.clearance=1&joint.liner_thickness=2&liner.material=pom"


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ("view=pres", "'pres' as view is not known; did you mean 'press'?"),
        ("frob=2", "'frob' in the link is not known"),
        (f"joint.ball_radius=-1&{REST}", "ball_radius = '-1' is not"),
        ("preset=hip-29", "'hip-29' as preset is not known; did you mean"),
        ("preset=hip-28&liner.young=3", "'liner' beside a preset is not known"),
        ("backing.thickness=2", "a layer is 'backing.0.thickness' and so on"),
        ("limit=3", "'3' is not a limit"),
        ("limit=frob<=3", "'frob' among what can be limited is not known"),
        ("joint=2", "joint = '2' must be a table"),
        ("backing.1111111111.thickness=2", "a layer is 'backing.0.thickness' and so on"),
        ("joint.ball_radius=" + "1" * 7000 + "!", "joint.ball_radius|a length|the liner needs"),
        ("a" * 7900 + "=1", "'aaaa.* in the link is not known"),
        ("limit=force<=1&" * 21, "a map has at most 20 limits, got 21"),
        ("across=force=" + " .." * 1500 + "%0a", "is not a range"),
        ("name=%1b[31m&joint=2", "name = .* no control characters|must be a table"),
        ("joint=2&joint.clearance=1", "'joint' is given as text and as a table in the link"),
        ("up=head_diameter=1..2", "a map has two axes, and both are head_diameter"),
        ("up=clearance=2..1", "clearance from 2 to 1 is not a range: it must increase"),
        ("across=half_angle=10..40", "'half_angle' among the axes of a map is not known"),
        ("load.force=1&load.force=2", "'load.force' is given 2 times in the link"),
        ("load.force=1&load.indentation=2&preset=hip-28", "one load is needed, got force, indentation"),
        ("shown=exact,frob", "'frob' as shown is not known"),
        ("picked=30", "two numbers with a comma"),
        ("picked=30,nan", "two finite numbers"),
        ("name=" + "x" * 9000, "the link is longer than 8000 characters"),
        ("joint.ball_radius=1e999", "ball_radius = '1e999' is too large a number"),
        (f"joint.ball_radius=__import__('os')&{REST}", "is not a length"),
    ],
)
def test_a_bad_link_is_one_sentence(link, message):
    with pytest.raises(ValueError, match=message):
        read_link(parse_qs(link))


EXAMPLE = EXAMPLES / "designs.toml"
JOINT = """[[design]]
joint = {ball_radius = "14 mm", clearance = 0.1, liner_thickness = 5}
liner = {material = "pom"}
"""


@given(st.lists(screens(), min_size=1, max_size=3))
def test_a_session_file_brings_every_design_back(designs):
    again = read_upload(session_text([link_of(screen) for screen in designs]), START)
    for screen, read in zip(designs, again, strict=True):
        assert_same(replace(screen, theme="light"), read)


def test_a_session_file_is_no_joint_file():
    with pytest.raises(ValueError, match=r"^designs.toml: one joint is needed, .* session file with 2 of"):
        read_joint(EXAMPLE)


def test_the_example_has_two_hips_and_the_settings_of_their_pages_as_toml_and_as_json():
    text = EXAMPLE.read_text(encoding="utf-8")
    small, large = read_upload(text, START)
    assert read_upload(json.dumps(tomllib.loads(text)), START) == [small, large]
    assert [float(screen.file.joint.ball_radius) for screen in (small, large)] == [14.0, 18.0]
    assert (small.view, large.view, large.units) == ("press", "map", "imperial")
    assert [limit.name for limit in large.limits] == ["outer_diameter", "max_pressure"]


def test_a_joint_file_keeps_the_page_and_names_no_picture_of_the_server():
    text = '[joint]\nball_radius = 18\nclearance = 0.1\nliner_thickness = 6\n[liner]\nmaterial = "pom"\n'
    screen = read_link(parse_qs("preset=hip-28&load.force=900&units=imperial"))
    (read,) = read_upload(f'{text}[report]\nlogo = "/etc/secret.png"\ncustomer = "A"\n', screen)
    assert (read.units, read.file.load, read.file.report.logo) == ("imperial", {"force": 900.0}, "")
    assert read.file.joint.liner == bs.POM
    assert read_link(parse_qs(link_of(read), keep_blank_values=True)) == read


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "the file is empty"),
        ("{", "the file is not JSON"),
        ("[" * 50_000, "the file is not TOML|nested"),
        ('{"a":' * 19_000, "the file is not JSON"),
        ("x" * (MAX_FILE_SIZE + 1), f"the file is larger than {MAX_FILE_SIZE} bytes"),
        ("design = 3", r"the file: design = 3 must be tables \[\[design\]\]"),
        ('{"design": []}', f"the file: a session has 1 to {MAX_DESIGNS} designs, got 0"),
        ("[[design]]\n" * (MAX_DESIGNS + 1), f"a session has 1 to {MAX_DESIGNS} designs, got {MAX_DESIGNS + 1}"),
        (f"name = 'all'\n{JOINT}", "'name' in a session file is not known"),
        ("[[design]]\nname = 'a'\n", "the file: design 1 .'a'.: "),
        (f"{JOINT}\n[[design]]\njoint = 3\n", "the file: design 2: joint = 3 must be a table"),
        (JOINT.replace("14 mm", "-14 mm"), "design 1: ball_radius = '-14 mm' is not allowed"),
        (f"{JOINT}page = 3", r"design 1: page = 3 must be a table"),
        (f"{JOINT}page = {{vew = 'map'}}", r"design 1: 'vew' in \[page\] is not known; did you mean 'view'"),
        (f"{JOINT}page = {{view = ['map', 'cup']}}", r"design 1: 'view' is given 2 times in \[page\]"),
        (f"{JOINT}page = {{load = {{force = 3}}}}", r"design 1: 'load' in \[page\] belongs to the design"),
        (f"{JOINT}page = {{use = {{cycle = 'jog'}}}}", "design 1: 'jog' as cycle is not known"),
    ],
)
def test_a_bad_session_file_is_one_sentence(text, sentence):
    with pytest.raises(ValueError, match=sentence) as refused:
        read_upload(text, START)
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
