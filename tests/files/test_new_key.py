"""One line of a schema is enough for a new key: reading, refusals, JSON schema, documentation and options follow."""

from inspect import signature
from typing import Annotated

import pytest

from ballsocket.app.widgets import controls
from ballsocket.app.widgets.reading import Reading
from ballsocket.cli import options
from ballsocket.core.kinds import Kind
from ballsocket.core.quantities import QUANTITIES, Quantity
from ballsocket.core.unit_systems import Units
from ballsocket.files import inputs, joint_options
from ballsocket.files.inputs import Typical, inputs_of
from ballsocket.files.joint_file import CupTable, JointFileTable
from ballsocket.files.refusals import values_of
from ballsocket.files.schema import Length, meaning
from ballsocket.files.tables import json_schema, read_table
from ballsocket.hip.schema import FilmTable
from ballsocket.mcp.tools import TOOLS, schema

GrooveDepth = Annotated[Length | None, meaning("depth of a groove in the cup")]


class GroovedFilm(FilmTable, frozen=True, kw_only=True):
    """Film of a cup with a groove."""

    groove_depth: GrooveDepth = None


class GroovedCup(CupTable, frozen=True, kw_only=True):
    """Cup with a groove."""

    groove_depth: GrooveDepth = None


class GroovedJoint(JointFileTable, frozen=True, kw_only=True):
    """Joint whose cup has a groove."""

    cup: GroovedCup | None = None


def test_reading_schema_and_documentation_follow_a_new_key():
    assert read_table({"groove_depth": "0.02 cm"}, GroovedFilm).groove_depth == pytest.approx(0.2)
    (key,) = [key for key in inputs_of(GroovedFilm) if "groove_depth" in key.name]
    assert (values_of(key), key.meaning) == ("a length, such as '16 mm'", "depth of a groove in the cup")
    described = {"$ref": "#/$defs/Length", "description": "depth of a groove in the cup in mm"}
    assert json_schema(GroovedFilm)["properties"]["groove_depth"] == described
    with pytest.raises(ValueError, match="groove_depth = '3 N' is not a length, such as '16 mm'"):
        read_table({"groove_depth": "3 N"}, GroovedFilm)
    with pytest.raises(ValueError, match="'grove_depth' .* is not known; did you mean 'groove_depth'?"):
        read_table({"grove_depth": 1}, GroovedFilm)


def test_options_of_commands_and_arguments_of_tools_follow_a_new_key_of_a_joint_file(monkeypatch):
    monkeypatch.setattr(joint_options, "JointFileTable", GroovedJoint)

    @options.expand_groups
    def press(*, joint_options: Annotated[options.JointOptions, ("cup",)]) -> None:
        assert joint_options.tables == {"cup": {"groove_depth": "0.2 mm"}}

    press(**{**dict.fromkeys(signature(press).parameters), "groove_depth": "0.2 mm"})
    described = schema(TOOLS["press"], {"press": press})["properties"]["groove_depth"]["description"]
    assert described == "Depth of a groove in the cup in mm."


@pytest.mark.parametrize(("units", "unit", "factor"), [("SI", "mm", 1.0), ("imperial", "in", 1 / 25.4)])
def test_a_field_of_the_explorer_follows_a_new_key_with_a_quantity_and_a_range(monkeypatch, units, unit, factor):
    quantity = Quantity("groove_depth", "g", "groove depth", Kind.LENGTH, "Depth of a groove in the cup.")
    monkeypatch.setattr(inputs, "QUANTITIES", {**QUANTITIES, "groove_depth": quantity})
    monkeypatch.setattr(inputs, "_TYPICAL", {"groove_depth": Typical((0, 2), 0.1, "1 mm", (0, 5), "a cup is thin")})
    (key,) = [key for key in inputs_of(GroovedJoint) if "groove_depth" in key.name]
    monkeypatch.setattr(controls, "_INPUTS", {"cup.groove_depth": key})
    reading = Reading(units=Units(units))
    control = controls.number_of("cup.groove_depth").control("groove", 0.5, reading, lambda depth: {"read": depth})
    field = control.field
    assert (field["label"], field["unit"], field["hint"]) == (
        "Depth of a groove in the cup",
        unit,
        "g: Depth of a groove in the cup.",
    )
    assert (field["value"], field["high"]) == pytest.approx((0.5 * factor, 2 * factor), rel=5e-3)
    assert control.take("0.06 cm") == {"read": pytest.approx(0.6)}
    with pytest.raises(ValueError, match=f"must be .* {unit} .a cup is thin., got"):
        control.take("1 cm")
