"""What is on the explorer's screen, as a link and as a joint file: what goes in comes out."""

from dataclasses import replace
from math import inf, pi
from urllib.parse import parse_qs

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.files.joint_file import JointFile, parse_joint
from ballsocket.files.joint_toml import toml_of
from ballsocket.problem.cup import Cup, Interface, Side
from ballsocket.problem.presets import materials

pytest.importorskip("tomli_w")
pytest.importorskip("xarray")
from ballsocket.app.state.screen import (
    ANGLES,
    MAP_MODELS,
    SIZES,
    START,
    THEMES,
    VIEWS,
    MapAxis,
    Screen,
    link_of,
    read_link,
)


def screen_with(query="preset=hip-28", **changes):
    """Return the screen of a link with other fields."""
    return replace(read_link(parse_qs(query)), **changes)


REST = "joint.clearance=1&joint.liner_thickness=2&liner.material=pom"
lengths = st.floats(1e-3, 1e3)
names = st.text(st.characters(exclude_categories=("Cc", "Cs")), max_size=8)
presets = st.sampled_from(list(materials.values()))
made_materials = st.one_of(
    presets,
    st.builds(bs.Material, young=st.floats(1.0, 1e6), poisson=st.floats(-0.9, 0.5)),
    st.builds(
        lambda one, young: replace(one, young=young), st.sampled_from(list(materials.values())), st.floats(1.0, 1e6)
    ),
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
    st.builds(lambda value: {"force": value}, st.floats(1e-3, 1e5)),
    st.builds(lambda value: {"indentation": value}, st.floats(1e-6, 1.0)),
    st.builds(lambda value: {"half_angle": value}, st.floats(0.01, 1.5)),
)
ways = st.tuples(*3 * (st.floats(-1e3, 1e3),)).filter(lambda way: any(abs(each) > 1e-3 for each in way))
aims = st.one_of(st.just({}), st.builds(lambda way: {"direction": way}, ways), st.just({"tilt": 0.5}))
made_files = st.builds(JointFile, made_joints, loads, cups, aims)
axes = st.sampled_from([("ball_radius", "liner_thickness"), ("clearance", "force"), ("liner_poisson", "outer_radius")])


ANGLES_OF_CUP = ("arc_of_cover", "inclination", "anteversion")


@st.composite
def screens(draw):
    ends = st.tuples(lengths, lengths).filter(lambda pair: pair[0] < pair[1])
    across, up = (MapAxis(**dict(zip(("low", "high"), draw(ends), strict=True)), name=name) for name in draw(axes))
    return Screen(
        view=draw(st.sampled_from(VIEWS)),
        file=draw(made_files),
        beside=tuple(draw(st.lists(made_files, max_size=2))),
        shown=tuple(draw(st.lists(st.sampled_from(list(bs.catalogue)), max_size=3, unique=True))),
        answered_by=draw(st.sampled_from(list(bs.catalogue))),
        across=across,
        up=up,
        map_model=draw(st.sampled_from(MAP_MODELS)),
        angle=draw(st.sampled_from(ANGLES)),
        size=draw(st.sampled_from(SIZES)),
        theme=draw(st.sampled_from(THEMES)),
    )


def near(one, other):
    """Angles turn to degrees and back; all else is the same."""
    (kind, value), (_, again) = *one.load.items(), *other.load.items()
    return (
        one.joint == other.joint
        and one.aim == other.aim
        and kind in other.load
        and again == pytest.approx(value, rel=1e-14)
        and (one.cup.interface, one.cup.side, one.cup.chamfer)
        == (other.cup.interface, other.cup.side, other.cup.chamfer)
        and all(
            getattr(other.cup, angle) == pytest.approx(getattr(one.cup, angle), rel=1e-14) for angle in ANGLES_OF_CUP
        )
    )


@given(made_files)
def test_a_joint_file_that_is_written_is_read(file):
    assert near(file, parse_joint(toml_of(file).encode(), "file"))


@given(screens())
def test_a_link_leads_back(screen):
    again = read_link(parse_qs(link_of(screen), keep_blank_values=True))
    assert near(screen.file, again.file)
    assert all(near(*pair) for pair in zip(screen.beside, again.beside, strict=True))
    assert replace(screen, file=START.file, beside=()) == replace(again, file=START.file, beside=())


def test_a_page_without_curves_has_a_link_that_can_be_read():
    """A reload lost the design after the last curve was unticked."""
    screen = replace(START, shown=())
    assert read_link(parse_qs(screen.link, keep_blank_values=True)) == screen


def test_a_load_alone_presses_the_joint_of_the_start():
    assert read_link({"load.force": ["5000"]}) == replace(START, file=replace(START.file, load={"force": 5000.0}))


def test_a_massive_socket_is_written():
    file = JointFile(bs.joints["tilting-pad-pivot"], {"force": 1e3})
    assert "liner_thickness = inf" in toml_of(file)
    assert parse_joint(toml_of(file).encode(), "file").joint.liner_thickness == inf


def test_presets_make_short_links():
    assert link_of(START) == "preset=hip-28&load.force=3000.0&theme=light"
    assert read_link(parse_qs(link_of(START))) == START


def test_arrays_are_no_joint_file():
    many = replace(bs.joints["hip-28"], clearance=np.array([0.1, 0.2]))
    with pytest.raises(ValueError, match="a joint file holds one joint"):
        toml_of(JointFile(many, {}))


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ("view=pres", "'pres' as view is not known; did you mean 'press'?"),
        ("frob=2", "'frob' in the link is not known"),
        ("joint.ball_radiuss=3", "'ball_radiuss' in .joint. is not known; did you mean 'ball_radius'?"),
        (
            "joint.ball_radius=-1&joint.clearance=1&joint.liner_thickness=2&liner.material=pom",
            "ball_radius = '-1' is not",
        ),
        ("preset=hip-29", "'hip-29' as preset is not known; did you mean"),
        ("preset=hip-28&liner.young=3", "'liner' beside a preset is not known"),
        ("backing.thickness=2", "a layer is 'backing.0.thickness' and so on"),
        ("limit=3", "'3' is not a limit"),
        ("limit=frob<=3", "'frob' among what can be limited is not known"),
        ("joint=2", "joint = '2' must be a table"),
        ("joint.ball_radius=" + "1" * 7000 + "!", "joint.ball_radius|a length|the liner needs"),
        ("backing.1111111111.thickness=2", "a layer is 'backing.0.thickness' and so on"),
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
        ("map_model=fem", "'fem' as map_model is not known"),
        ("name=" + "x" * 9000, "the link is longer than 8000 characters"),
        ("joint.ball_radius=1e999", "ball_radius = '1e999' is too large a number"),
        (
            "joint.ball_radius=__import__('os')&joint.clearance=1&joint.liner_thickness=2&liner.material=pom",
            "is not a length",
        ),
    ],
)
def test_a_bad_link_is_one_sentence(link, message):
    with pytest.raises(ValueError, match=message):
        read_link(parse_qs(link))
