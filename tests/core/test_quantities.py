"""One description of each quantity, used by tables, files, studies and messages."""

import re
from dataclasses import replace
from functools import cache
from math import inf, nan, pi
from operator import attrgetter

import numpy as np
import pint
import pytest

import ballsocket as bs
from ballsocket.comparison import COLUMN_HEADS
from ballsocket.core import quantities
from ballsocket.core.kinds import Unit
from ballsocket.core.quantities import BEARING, CONTACT, DERIVED, FIT, JOINT, QUANTITIES, STRESS_LIMITS
from ballsocket.core.sources import Source, bibliography, find_cited_keys
from ballsocket.files.units import parse
from ballsocket.studies.design import grid
from ballsocket.studies.limits import LIMITED_NAMES as LIMITED
from ballsocket.studies.metadata import variable_attributes
from ballsocket.studies.parameters import PARAMETERS
from ballsocket.studies.task import QUANTITIES as ANSWERS

from ..joints import HIP

EVERY = pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=attrgetter("name"))
CHECKED = [each for each in QUANTITIES.values() if each.allowed]


def _numbers(thing):
    """The names of a thing's numbers."""
    public = (name for name in dir(thing) if not name.startswith("_"))
    return {name for name in public if isinstance(getattr(thing, name), float)}


def test_every_quantity_of_contact_joint_and_cup_is_an_attribute_and_no_other_number_is_one():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    known = {*CONTACT, *BEARING, *DERIVED, *JOINT, *FIT, "shell"} - {"edge_distance"}
    assert _numbers(contact) | _numbers(HIP) == known
    assert _numbers(replace(HIP.liner, **dict.fromkeys(STRESS_LIMITS, 1.0))) == {*quantities.MATERIAL, *STRESS_LIMITS}
    assert _numbers(bs.Layer(thickness=3.0, material=bs.TITANIUM)) == set(quantities.LAYER)
    assert _numbers(bs.Cup()) - {"rim"} == set(quantities.CUP)


@cache
def units():
    return pint.UnitRegistry()


@EVERY
def test_units_have_the_stated_factors_and_keys_of_angles_end_in_degrees(quantity):
    shown = quantity.written if quantity.name == "cycles" else quantity.shown  # "million" is no unit of pint
    for unit in (Unit(quantity.unit), quantity.written, shown):
        text = unit.text.replace("°", "deg") if unit.text not in ("", "1") else ""
        assert parse(quantity.name, f"{unit.factor!r} {text}".strip(), quantity.kind) == pytest.approx(1.0, rel=1e-15)
    inside = units().Quantity(quantity.unit.replace("mm2", "mm**2").replace("mm3", "mm**3"))
    for unit in (quantity.written, shown):
        there = inside.to(
            (unit.text or "1").replace("°", "deg").replace("²", "**2").replace("³", "**3").replace("million", "1e6")
        )
        assert there.magnitude == pytest.approx(unit.factor, rel=1e-15)
    assert (quantity.written.text == "°") == (quantity.unit == "rad") == quantity.key.endswith("_deg")


def test_tables_studies_and_json_use_the_same_quantities():
    assert all(parameter is QUANTITIES[name] for name, parameter in PARAMETERS.items())
    assert all(load is PARAMETERS[name] is CONTACT[name] for name, load in quantities.LOADS.items())
    assert set(ANSWERS) == {*CONTACT, *BEARING}
    assert set(LIMITED) <= set(QUANTITIES)
    assert all(any(head.startswith(QUANTITIES[name].symbol) for head in COLUMN_HEADS) for name in quantities.HEADLINE)


def test_names_symbols_and_titles_are_unique():
    groups = [CONTACT, BEARING, JOINT, FIT, STRESS_LIMITS, DERIVED, quantities.MATERIAL, quantities.PARTS]
    groups += [
        quantities.PLASTIC,
        quantities.YIELD_LIMITS,
        quantities.SHELL,
        quantities.LAYER,
        quantities.CUP,
        quantities.AIM,
        quantities.FIELD,
        quantities.WEAR,
    ]
    assert len(QUANTITIES) == sum(map(len, groups))
    shared = {each.symbol for each in (*quantities.MATERIAL.values(), *quantities.PARTS.values())}
    symbols = [each.symbol for each in QUANTITIES.values() if each.symbol and each.symbol not in shared]
    assert sorted(symbols) == sorted(set(symbols))
    assert len({each.title.casefold() for each in QUANTITIES.values()}) == len(QUANTITIES)
    for each in QUANTITIES.values():
        assert each.title
        assert each.meaning.endswith(".")


def test_a_study_is_labelled_as_the_table_says():
    found = bs.study(bs.HessForsbach(), HIP, grid(clearance=[0.1, 0.2], force=3000.0), quantities=list(ANSWERS))
    for name in (*ANSWERS, "clearance"):
        quantity = QUANTITIES[name]
        words = {"long_name": quantity.title, "symbol": quantity.symbol, "units": quantity.unit}
        assert found[name].attrs == variable_attributes(name) == words


_WRONG = {"force": -1.0, "indentation": inf, "half_angle": pi / 2, "clearance": -0.1}
_WRONG |= {"arc_of_cover": 0.5, "anteversion": 2.0, "angle": 4.0}


@pytest.mark.parametrize("quantity", CHECKED, ids=attrgetter("name"))
def test_messages_of_invalid_numbers_state_what_is_allowed(quantity):
    for wrong in (_WRONG.get(quantity.name, -1.0), nan, np.array([nan])):
        with pytest.raises(ValueError, match=re.escape(quantity.allowed)) as refused:
            quantity.check(wrong)
        assert str(refused.value).startswith(quantity.name)
    with pytest.raises(TypeError, match=f"{quantity.name} must be a number"):
        quantity.check("1")
    assert not quantity.allows(nan)


@pytest.mark.parametrize(
    ("name", "inside", "outside"),
    [
        ("poisson", (np.nextafter(-1.0, 0.0), 0.5), (-1.0, np.nextafter(0.5, 1.0))),
        ("half_angle", (0.0, np.nextafter(pi / 2, 0.0)), (np.nextafter(0.0, -1.0), pi / 2)),
        *((name, (0.0, 1e300), (-1e-9, inf)) for name in ("force", "clearance", "chamfer")),
        *((name, (1e-200, inf), (0.0, 1e-301)) for name in ("liner_thickness", "thickness")),
        *((name, (1e-200, 1e200), (0.0, inf)) for name in ("ball_radius", "young", "yield_stress")),
        ("angle", (-pi, float(np.float32(pi))), (-pi - 1e-3, pi + 1e-3)),
        *(
            (name, tuple(np.radians(ends)), (np.radians(ends[0]) - 1e-6, np.radians(ends[1]) + 1e-6))
            for name, *ends in (
                *(("arc_of_cover", 40.0, 340.0), ("inclination", 0.0, 90.0), ("anteversion", -90.0, 90.0)),
                *(("tilt", 0.0, 180.0), ("azimuth", 0.0, 360.0)),
            )
        ),
    ],
)
def test_allowed_ranges_end_at_the_stated_limits(name, inside, outside):
    allows = QUANTITIES[name].allows
    assert all(map(allows, inside))
    assert not any(map(allows, outside))


def test_columns_and_labels_have_their_unit_and_only_angles_in_degrees_a_hint_in_radians():
    assert QUANTITIES["half_angle"].radian_hint(100.0) == QUANTITIES["force"].radian_hint(1.0) == ""
    assert [QUANTITIES[name].column for name in ("indentation", "conformity")] == ["indentation_mm", "conformity"]
    assert (QUANTITIES["half_angle"].column, QUANTITIES["half_angle"].key) == ("half_angle_deg", "half_angle_deg")
    assert QUANTITIES["indentation"].label() == "indentation d [µm]"
    assert QUANTITIES["edge_distance"].label() == "edge distance [mm]"


def test_sources_have_authors_and_year():
    key = bs.HessForsbach().sources[0].key
    source = Source(key, "Eq. (13)")
    assert source.doi == "10.3390/app112311170"
    assert source.authors_and_year == "Heß & Forsbach 2021"
    assert str(source) == "Heß & Forsbach 2021, Eq. (13)"
    assert str(Source(key)) == "Heß & Forsbach 2021"
    assert any(" et al. " in Source(key).authors_and_year for key in bibliography())
    assert list(find_cited_keys(f"E of {source.authors_and_year}, Table 2; doi {source.doi}")) == [key]
    assert list(find_cited_keys("")) == []
    assert bs.cite(bs.HessForsbach(), bs.HessForsbach()) == bs.cite(bs.HessForsbach())


@pytest.mark.parametrize("name", ["ball_radius", "clearance", "liner_thickness"])
def test_joint_and_study_reject_the_same_numbers(name):
    wrong = _WRONG.get(name, -1.0)
    with pytest.raises(ValueError, match=re.escape(JOINT[name].allowed)):
        replace(HIP, **{name: wrong})
    with pytest.raises(ValueError, match=re.escape(JOINT[name].allowed)):
        grid(**{name: [wrong]})
