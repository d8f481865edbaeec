"""Words of the front door and of the source: angles, names, messages, sources; plain English by measure."""

import ast
import re
from functools import cache
from importlib.util import find_spec

import numpy as np
import pytest

import ballsocket as bs

from . import plain_words
from .joints import HIP
from .places import ROOT
from .rooms import files_of, rooms, tree_of

NEEDS_STUDIES = pytest.mark.skipif(find_spec("xarray") is None, reason="the extra for studies is not installed")
PRESSED = bs.HessForsbach().press(HIP, force=3000.0)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: bs.Exact().press("Hip 28", force=1.0),
            r"joint must be a Joint, got 'Hip 28'; use bs.joints\['hip-28'\]",
        ),
        (lambda: bs.Exact().press(28.0, force=1.0), r"joint must be a Joint, got 28\.0$"),
        (lambda: bs.PinInHole().press("hip-28", line_load=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: bs.Exact().press(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
        (lambda: bs.PinInHole().press(HIP, 30.0), "a load needs its name: line_load in N/mm"),
        (lambda: bs.compare(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
        (lambda: bs.compare("hip-28", force=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: bs.compare(HIP, force=1.0, models="exact"), r"models must be a list .* got 'exact'$"),
        (lambda: bs.compare(HIP, force=1.0, models={"exact": "exact"}), r"models\['exact'\] must be a model"),
        pytest.param(
            lambda: bs.study("exact", HIP, force=1.0),
            r"model must be a Model, got 'exact'; bs.catalogue\['exact'\] is",
            marks=NEEDS_STUDIES,
        ),
    ],
)
def test_arguments_of_another_type_are_refused_in_one_sentence(ask, message):
    with pytest.raises(TypeError, match=message):
        ask()


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: bs.joints["hip36"], "joint 'hip36' is not known; did you mean 'hip-36'"),
        (lambda: bs.materials["UHMPE"], "material 'UHMPE' is not known; did you mean 'uhmwpe'"),
        (lambda: bs.catalogue["hess"], "model 'hess' is not known; did you mean 'hess-forsbach'"),
        (lambda: bs.compare(HIP, force=1.0)["herz"], "model 'herz' is not in this comparison; did you mean 'hertz'"),
    ],
)
def test_unknown_names_are_refused_with_the_closest_name(ask, message):
    with pytest.raises(KeyError, match=message):
        ask()


def test_citations_are_those_of_the_cited_objects():
    text = bs.cite(bs.Bartel().press(HIP, force=1.0), bs.hess_forsbach, bs.PinInHole())
    for key in ("bartel1985", "hess2021", "persson1964", "ciavarella2001"):
        assert text.count("{" + key + ",") == 1
    assert "hertz1882" not in text


def test_every_source_is_in_the_bibliography():
    from ballsocket.core.sources import bibliography

    for model in (*bs.catalogue.values(), bs.PinInHole()):
        for source in model.sources:
            assert source.key in bibliography()
            assert source.authors_and_year
            assert "\\" not in str(source)
    assert bs.HessForsbach().sources[0].doi == "10.3390/app112311170"


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: PRESSED.pressure(30), "angle = 30 is not allowed: .* in radians; 30 degrees are 0.5236 radians$"),
        (lambda: PRESSED.pressure([0.1, 30.0]), r"angle\[1\] = 30 is not allowed: .*; 30 degrees are 0.5236 radians$"),
        (lambda: PRESSED.friction_torque(0.1, 90), "axis_angle = 90 is .* radians; 90 degrees are 1.571 radians$"),
        (lambda: bs.Exact().press(HIP, force=1e3).stress(angle=30, depth=1.0), "angle = 30 is .* are 0.5236 radians$"),
        (lambda: bs.Exact().press(HIP, force=1e3).displacement(30), "angle = 30 is .* 30 degrees are 0.5236 radians$"),
        (lambda: bs.Exact().press(HIP, half_angle=40), "half_angle = 40 is .*; 40 degrees are 0.6981 radians$"),
        (lambda: bs.Cup(arc_of_cover=160), "arc_of_cover = 160 is .*; 160 degrees are 2.793 radians$"),
        (lambda: bs.Cup(inclination=45), "inclination = 45 is .*; 45 degrees are 0.7854 radians$"),
        pytest.param(
            lambda: bs.study(bs.Hertz(), HIP, half_angle=[20, 40]),
            "half_angle.* = 20 .*; 20 degrees are 0.3491 rad",
            marks=NEEDS_STUDIES,
        ),
    ],
)
def test_angles_that_can_only_be_degrees_get_a_hint_in_radians(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_angles_up_to_half_a_turn_are_accepted():
    angles = np.array([0.0, 1.0, np.pi, -1.0, np.nan])
    assert PRESSED.pressure(angles)[:3].tolist() == [PRESSED.pressure(0.0), 0.0, 0.0]
    assert PRESSED.pressure(np.float32(np.pi)) == 0.0


LEANING = re.compile(r"^(Of|The same|That of|Those of|As|Its|Their|Like) ")


def test_the_first_line_of_a_docstring_names_its_noun():
    """First lines are read in lists, beside a name and without their context."""
    leaning = []
    for path in sorted((ROOT / "src" / "ballsocket").rglob("*.py")):
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                said = ast.get_docstring(node) or ""
                leaning += [f"{path.name}: {said.splitlines()[0]}"] if LEANING.match(said) else []
    assert leaning == []


NOT_YET = ()
"""Rooms that do not meet the goals of plain English yet; every other room of the package must."""

NOT_YET_IMPERATIVE = (*NOT_YET,)
"""Rooms whose functions are not yet described by an imperative verb and its object."""


@cache
def measures(room):
    """Measure a room once for all its rules."""
    return plain_words.measure(files_of(room))


@pytest.mark.parametrize("rule", ["clause", "dialect", "vague name"])
@pytest.mark.parametrize("room", [room for room in rooms() if room not in NOT_YET])
def test_rooms_are_written_in_plain_english(room, rule):
    """See `plain_words` for the rules; `python -m tests.plain_words ROOM` prints all figures of a room."""
    found = measures(room)[rule]
    assert found.met, "\n".join([str(found), *map(str, found.findings)])


@pytest.mark.parametrize("room", [room for room in rooms() if room not in NOT_YET_IMPERATIVE])
def test_functions_are_described_by_an_imperative_verb(room):
    found = measures(room)["no verb"]
    assert found.met, "\n".join([str(found), *map(str, found.findings)])


def test_class_names_are_unique_in_the_package():
    files = [path for room in rooms() for path in files_of(room)]
    twice = plain_words.defined_twice(files)
    lines = [f"class {name}: {', '.join(places)}" for name, places in twice.items()]
    assert len(lines) <= plain_words.MAX_TWICE, "\n".join(lines)


@pytest.mark.parametrize(
    ("source", "findings"),
    [
        ('"""What is pressed."""', ["2: clause: What is pressed."]),
        ('"""Joint under load.\n\nIt is told here."""', ["4: dialect: told"]),
        ('"""Joint under load."""  # there is no load, but is no joint', ["2: dialect: is no joint"]),
        (
            '"""Joint under load."""\ndef found(force, _given): share = force',
            ["3: vague name: _given", "3: vague name: found"],
        ),
        ('def area():\n    """Return the area of a contact."""', []),
        ('def area():\n    """Returns the area of a contact."""', ["3: no verb: Returns the area of a contact."]),
        ('def area():\n    """The area of a contact."""', ["3: no verb: The area of a contact."]),
        ('def area():\n    """p(φ) = K d cos φ."""', []),
        ('def press():\n    """Press a joint, and assess it."""', []),
        ('class Area:\n    """A contact."""\n    @property\n    def edge(self):\n        """The edge."""', []),
    ],
)
def test_each_rule_of_plain_english_is_measured(source, findings, tmp_path):
    path = tmp_path / "module.py"
    path.write_text("\n" + source, encoding="utf-8")
    measured = plain_words.measure([path]).values()
    found = [str(finding).removeprefix(f"{path}:") for one in measured for finding in one.findings]
    assert sorted(found) == findings


def test_a_private_class_of_the_same_name_counts_as_a_second_one(tmp_path):
    (tmp_path / "one.py").write_text("class Law: ...\n")
    (tmp_path / "two.py").write_text("class Area: ...\nclass _Law: ...\n")
    twice = plain_words.defined_twice(sorted(tmp_path.glob("*.py")))
    assert twice == {"Law": [f"{tmp_path}/one.py:1", f"{tmp_path}/two.py:2"]}
