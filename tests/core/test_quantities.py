"""One description of each quantity, used by tables, files, studies and messages."""

import re
from dataclasses import replace
from functools import cache
from importlib import import_module
from inspect import getattr_static
from math import inf, nan, pi
from operator import attrgetter

import numpy as np
import pint
import pytest

import ballsocket as bs
from ballsocket.compare import COLUMN_HEADS
from ballsocket.contact.describe import COLUMNS
from ballsocket.core import quantities
from ballsocket.core.deprecation import RenamedAttribute
from ballsocket.core.kinds import Unit
from ballsocket.core.quantities import (
    AIM,
    BEARING,
    CONTACT,
    CUP,
    DERIVED,
    FIELD,
    FIT,
    JOINT,
    LAYER,
    LOADS,
    MATERIAL,
    PARTS,
    QUANTITIES,
    STRESS_LIMITS,
)
from ballsocket.files.units import parse
from ballsocket.studies.design import check_values, grid
from ballsocket.studies.limits import LIMITED_NAMES as LIMITED
from ballsocket.studies.metadata import variable_attributes
from ballsocket.studies.parameters import PARAMETERS
from ballsocket.studies.task import QUANTITIES as ANSWERS

from ..joints import HIP
from ..places import ROOT

EVERY = pytest.mark.parametrize("quantity", QUANTITIES.values(), ids=attrgetter("name"))
CHECKED = [each for each in QUANTITIES.values() if each.allowed]


def _numbers(thing):
    """The names of a thing's numbers."""
    current = (name for name in dir(thing) if not isinstance(getattr_static(thing, name), RenamedAttribute))
    public = (name for name in current if not name.startswith("_"))
    return {name for name in public if isinstance(getattr(thing, name), float)}


def test_every_quantity_of_contact_joint_and_cup_is_an_attribute_and_no_other_number_is_one():
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    assert _numbers(contact) | _numbers(HIP) == {*CONTACT, *BEARING, *DERIVED, *JOINT, *FIT, "shell"} - {
        "edge_distance"
    }
    assert _numbers(replace(HIP.liner, **dict.fromkeys(STRESS_LIMITS, 1.0))) == {*MATERIAL, *STRESS_LIMITS}
    assert _numbers(bs.Layer(thickness=3.0, material=bs.TITANIUM)) == set(LAYER)
    assert _numbers(bs.Cup()) - {"rim"} == set(CUP)


@cache
def units():
    """Make the registry of pint once; it takes 0.2 s."""
    return pint.UnitRegistry()


@EVERY
def test_units_are_read_and_have_the_stated_factors(quantity):
    """A number as files give it is the number inside, and the factors are those of the units' names."""
    for unit in (Unit(quantity.unit), quantity.written, quantity.shown):
        text = unit.text.replace("°", "deg") if unit.text not in ("", "1") else ""
        assert parse(quantity.name, f"{unit.factor!r} {text}".strip(), quantity.kind) == pytest.approx(1.0, rel=1e-15)
    inside = units().Quantity(quantity.unit.replace("mm2", "mm**2"))
    for unit in (quantity.written, quantity.shown):
        there = inside.to((unit.text or "1").replace("°", "deg").replace("²", "**2"))
        assert there.magnitude == pytest.approx(unit.factor, rel=1e-15)


@EVERY
def test_keys_of_angles_end_in_degrees(quantity):
    assert (quantity.written.text == "°") == (quantity.unit == "rad") == quantity.key.endswith("_deg")


def test_tables_studies_and_json_use_the_same_quantities():
    assert [column.quantity for column in COLUMNS] == list(CONTACT.values())
    assert all(column.quantity is QUANTITIES[column.attribute] for column in COLUMNS)
    assert all(parameter is QUANTITIES[name] for name, parameter in PARAMETERS.items())
    assert all(load is PARAMETERS[name] is CONTACT[name] for name, load in LOADS.items())
    assert set(ANSWERS) == {*CONTACT, *BEARING}
    assert set(LIMITED) <= set(QUANTITIES)
    assert all(any(head.startswith(QUANTITIES[name].symbol) for head in COLUMN_HEADS) for name in quantities.HEADLINE)


def test_names_symbols_and_titles_are_unique():
    assert len(QUANTITIES) == sum(
        map(len, (CONTACT, BEARING, JOINT, FIT, MATERIAL, STRESS_LIMITS, PARTS, LAYER, CUP, AIM, FIELD, DERIVED))
    )
    shared = {each.symbol for each in (*MATERIAL.values(), *PARTS.values())}
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


_WRONG = {
    "force": -1.0,
    "indentation": inf,
    "half_angle": pi / 2,
    "clearance": -0.1,
    "arc_of_cover": 0.5,
    "anteversion": 2.0,
    "angle": 4.0,
}


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
    ("name", "ends"), [("poisson", (-1.0, 0.5)), ("half_angle", (0.0, pi / 2)), ("force", (0, inf))]
)
def test_allowed_ranges_end_at_the_stated_limits(name, ends):
    low, high = ends
    allows = QUANTITIES[name].allows
    assert allows(low) == (name != "poisson")
    assert allows(high) == (name == "poisson")
    assert allows(np.nextafter(low, 1.0))
    assert allows(np.nextafter(high, 0.0))
    assert not allows(np.nextafter(low, -2.0))


@pytest.mark.parametrize("name", ["ball_radius", "clearance", "liner_thickness"])
def test_joint_and_study_reject_the_same_numbers(name):
    wrong = _WRONG.get(name, -1.0)
    with pytest.raises(ValueError, match=re.escape(JOINT[name].allowed)):
        replace(HIP, **{name: wrong})
    with pytest.raises(ValueError, match=f"is not allowed for a {JOINT[name].title}"):
        check_values(grid(**{name: [wrong]}))


def test_only_the_liner_thickness_may_be_infinite():
    assert {name for name, parameter in PARAMETERS.items() if parameter.allows(inf)} == {"liner_thickness"}


def test_ranges_have_symbol_and_unit_of_their_quantity():
    assert str(bs.Range(quantity="half_angle", high=pi / 18)) == "ε ≤ 10°"
    assert str(bs.Range(quantity="joint.thickness_ratio", low=2.0)) == "R2/L ≥ 2"
    assert str(bs.Range(quantity="joint.liner.poisson", low=0.3, high=0.4)) == "ν 0.3 to 0.4"
    assert str(bs.Range(quantity="joint.roughness", high=0.1)) == "roughness ≤ 0.1"
    assert str(bs.Range(quantity="joint.clearance", symbol="gap", high=0.1)) == "gap ≤ 0.1"


def test_the_glossary_of_the_site_has_every_quantity(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "docs" / "_ext")
    written = import_module("generated")._glossary(QUANTITIES.values())
    for each in QUANTITIES.values():
        entry = re.search(rf"^{re.escape(each.title)}\n  (.*)$", written, flags=re.MULTILINE)[1]
        assert entry.startswith(f"`{each.name}`")
        assert each.meaning in entry
        assert each.allowed[1:] in entry
