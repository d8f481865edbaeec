"""Kinds of quantities, limits of quantities, sources, registered plots and input files."""

from math import degrees, inf, pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core import display
from ballsocket.core.input_files import (
    AllowedFolders,
    open_input,
    record_inputs,
    resolve_input,
    restriction_variables,
)
from ballsocket.core.kinds import Kind, Unit
from ballsocket.core.quantities import QUANTITIES
from ballsocket.core.sources import Source, bibliography, find_cited_keys

from ..places import symlink_or_skip


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("arc_of_cover", 40.0, 340.0),
        ("inclination", 0.0, 90.0),
        ("anteversion", -90.0, 90.0),
        ("tilt", 0.0, 180.0),
        ("azimuth", 0.0, 360.0),
    ],
)
def test_angles_are_limited_in_degrees(name, low, high):
    allows = QUANTITIES[name].allows
    assert allows(radians(low))
    assert allows(radians(high))
    assert not allows(radians(low) - 1e-6)
    assert not allows(radians(high) + 1e-6)
    assert f"{low:g} to {high:g} degrees" in QUANTITIES[name].allowed


def test_polar_angles_are_within_half_a_turn_in_single_precision():
    allows = QUANTITIES["angle"].allows
    assert allows(float(np.float32(pi)))
    assert allows(-pi)
    assert not allows(pi + 1e-3)
    assert not allows(-pi - 1e-3)


def test_thicknesses_are_positive_or_infinite():
    for name in ("liner_thickness", "thickness"):
        assert QUANTITIES[name].allows(inf)
        assert QUANTITIES[name].allows(1e-200)
        assert not QUANTITIES[name].allows(0.0)
        assert not QUANTITIES[name].allows(1e-301)
    for name in ("ball_radius", "young", "yield_stress"):
        assert not QUANTITIES[name].allows(inf)
        assert not QUANTITIES[name].allows(0.0)
    for name in ("clearance", "force", "chamfer"):
        assert QUANTITIES[name].allows(0.0)
        assert not QUANTITIES[name].allows(-1e-9)


def test_an_angle_in_degrees_gets_a_hint_in_radians():
    with pytest.raises(ValueError, match="half_angle = 45 is not .*; 45 degrees are 0.7854 radians"):
        QUANTITIES["half_angle"].check(45.0)
    assert QUANTITIES["half_angle"].radian_hint(100.0) == ""
    assert QUANTITIES["force"].radian_hint(1.0) == ""


def test_labels_have_symbols_and_units():
    indentation, angle = QUANTITIES["indentation"], QUANTITIES["half_angle"]
    assert indentation.label() == "indentation d [µm]"
    assert indentation.input_label(indentation.written) == "Indentation d [mm]"
    assert indentation.head() == "d [µm]"
    assert (indentation.column, indentation.key) == ("indentation_mm", "indentation")
    assert (angle.column, angle.key) == ("half_angle_deg", "half_angle_deg")
    assert QUANTITIES["conformity"].column == "conformity"
    assert indentation.shown.factor == 1e3
    assert QUANTITIES["stiffness"].shown.factor == 1e-3
    assert QUANTITIES["edge_distance"].label() == "edge distance [mm]"


def test_angles_are_written_in_degrees():
    assert Kind.ANGLE.written == Unit("°", degrees(1.0))
    assert (Kind.ANGLE.unit, Kind.ANGLE.column_suffix, Kind.ANGLE.assumed_unit) == ("rad", "deg", "deg")
    assert (Kind.NUMBER.unit, Kind.NUMBER.column_suffix, Kind.NUMBER.assumed_unit) == ("1", "", "")
    assert (Kind.LENGTH.unit, Kind.LENGTH.column_suffix, Kind.LENGTH.assumed_unit) == ("mm", "mm", "mm")
    assert Kind.AREA.written.text == "mm²"
    assert Unit("").text_in_brackets == ""
    assert Unit("mm").text_in_brackets == " [mm]"
    assert all(kind.example.startswith("a") for kind in Kind)


def test_sources_have_authors_and_year():
    key = bs.HessForsbach().sources[0].key
    source = Source(key, "Eq. (13)")
    assert source.doi == "10.3390/app112311170"
    assert source.authors_and_year == "Heß & Forsbach 2021"
    assert str(source) == "Heß & Forsbach 2021, Eq. (13)"
    assert str(Source(key)) == "Heß & Forsbach 2021"
    several = [Source(key).authors_and_year for key in bibliography() if " et al. " in Source(key).authors_and_year]
    assert several


def test_publications_are_recognized_in_texts():
    key = bs.HessForsbach().sources[0].key
    assert list(find_cited_keys("E of Heß & Forsbach 2021, Table 2")) == [key]
    assert list(find_cited_keys("doi 10.3390/app112311170")) == [key]
    assert list(find_cited_keys("")) == []
    assert key in bs.cite(bs.UHMWPE)
    assert bs.cite(bs.HessForsbach(), bs.HessForsbach()) == bs.cite(bs.HessForsbach())


def test_items_without_sources_cannot_be_cited():
    with pytest.raises(TypeError, match=r"not the class or function HessForsbach; use HessForsbach\(\)"):
        bs.cite(bs.HessForsbach)
    with pytest.raises(TypeError, match="can be cited, not 3"):
        bs.cite(3)
    with pytest.raises(TypeError, match="no known publication is named in the source of"):
        bs.cite(bs.Material(young=1.0, poisson=0.3, source="a guess"))


def test_plots_are_loaded_when_they_are_needed(monkeypatch):
    monkeypatch.setattr(display, "_LOADERS", {})
    with pytest.raises(LookupError, match="plot 'a' is not registered; registered plots: none"):
        display.load_plot("a")
    display.register_plot("b", lambda: max)
    assert display.load_plot("b")(1, 2) == 2
    with pytest.raises(LookupError, match="registered plots: b"):
        display.load_plot("a")


def test_inputs_are_limited_to_allowed_folders(tmp_path, monkeypatch):
    folder = tmp_path / "allowed"
    folder.mkdir()
    (folder / "joint.toml").write_text("inside", encoding="utf-8")
    (tmp_path / "other.toml").write_text("outside", encoding="utf-8")
    symlink_or_skip(folder / "link.toml", tmp_path / "other.toml")
    assert resolve_input(tmp_path / "other.toml") == tmp_path / "other.toml"
    for name, value in restriction_variables([folder]).items():
        monkeypatch.setenv(name, value)
    with open_input(folder / "joint.toml") as stream:
        assert stream.read() == b"inside"
    for path in (tmp_path / "other.toml", folder / "link.toml", folder / ".." / "other.toml"):
        with pytest.raises(ValueError, match="lies outside the folder of this server"):
            open_input(path)
    with pytest.raises(ValueError, match="is not a regular file"):
        open_input(folder)
    with pytest.raises(FileNotFoundError):
        open_input(folder / "missing.toml")
    assert AllowedFolders((tmp_path.resolve(),)).resolve(folder, "folder") == folder.resolve()


def test_opened_inputs_are_recorded_once(tmp_path):
    first, second = tmp_path / "a", tmp_path / "b"
    for path in (first, second):
        path.write_text("text", encoding="utf-8")
    with record_inputs() as outer:
        open_input(first).close()
        with record_inputs() as inner:
            open_input(first).close()
            open_input(second).close()
            open_input(second).close()
        assert inner == [first, second]
    assert outer == [first, second]
    open_input(first).close()
    assert outer == [first, second]
