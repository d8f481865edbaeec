"""The words of the front door: angles, names and sentences, sources, docstrings."""

import ast
import re
from importlib.util import find_spec

import numpy as np
import pytest

import ballsocket as bs

from .joints import HIP
from .places import ROOT

NEEDS_STUDIES = pytest.mark.skipif(find_spec("xarray") is None, reason="the extra for studies is not installed")
PRESSED = bs.HessForsbach().press(HIP, force=3000.0)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda: bs.Exact().press("Hip 28", force=1.0),
            r"joint must be a Joint, got 'Hip 28'; bs.joints\['hip-28'\] ",
        ),
        (lambda: bs.Exact().press(28.0, force=1.0), r"joint must be a Joint, got 28\.0$"),
        (lambda: bs.PinInHole().press("hip-28", line_load=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: bs.Exact().press(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
        (lambda: bs.PinInHole().press(HIP, 30.0), "a load needs its name: line_load in N/mm"),
        (lambda: bs.compare(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
        (lambda: bs.compare("hip-28", force=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: bs.compare(HIP, force=1.0, models=["exact"]), r"models must be a mapping .* got \['exact'\]$"),
        (lambda: bs.compare(HIP, force=1.0, models={"exact": "exact"}), r"models\['exact'\] must be a model"),
        pytest.param(
            lambda: bs.study("exact", HIP, force=1.0),
            r"model must be a Model, got 'exact'; bs.catalogue\['exact'\] is",
            marks=NEEDS_STUDIES,
        ),
    ],
)
def test_what_is_something_else_is_told_in_a_sentence(ask, message):
    with pytest.raises(TypeError, match=message):
        ask()


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: bs.joints["hip36"], "joint 'hip36' is not known; did you mean 'hip-36'"),
        (lambda: bs.materials["UHMPE"], "material 'UHMPE' is not known; did you mean 'uhmwpe'"),
        (lambda: bs.catalogue["hess"], "model 'hess' is not known; did you mean 'hess-forsbach'"),
        (lambda: bs.compare(HIP, force=1.0)["herz"], "model 'herz' was not asked; did you mean 'hertz'"),
    ],
)
def test_a_name_that_is_not_known_is_told_with_the_nearest(ask, message):
    with pytest.raises(KeyError, match=message):
        ask()


def test_bibtex_of_what_was_used():
    text = bs.cite(bs.Bartel().press(HIP, force=1.0), bs.hess_forsbach, bs.PinInHole())
    for key in ("bartel1985", "hess2021", "persson1964", "ciavarella2001"):
        assert text.count("{" + key + ",") == 1
    assert "hertz1882" not in text


def test_every_source_is_in_the_bibliography():
    from ballsocket.core.sources import bibliography

    for model in (*bs.catalogue.values(), bs.PinInHole()):
        for source in model.sources:
            assert source.key in bibliography()
            assert source.short
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
def test_an_angle_that_can_only_be_degrees_is_told_in_radians(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_angles_up_to_half_a_turn_are_taken():
    angles = np.array([0.0, 1.0, np.pi, -1.0, np.nan])
    assert PRESSED.pressure(angles)[:3].tolist() == [PRESSED.pressure(0.0), 0.0, 0.0]
    assert PRESSED.pressure(np.float32(np.pi)) == 0.0


LEANING = re.compile(r"^(Of|The same|That of|Those of|As|Its|Their|Like) ")


def test_the_first_line_of_a_docstring_names_its_noun():
    """It is read in a list, beside a name, where nothing else says what it is about."""
    leaning = []
    for path in sorted((ROOT / "src" / "ballsocket").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                said = ast.get_docstring(node) or ""
                leaning += [f"{path.name}: {said.splitlines()[0]}"] if LEANING.match(said) else []
    assert leaning == []
