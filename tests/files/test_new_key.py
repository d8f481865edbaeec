"""One line of a schema is enough for a new key: reading, refusals, JSON schema, documentation and options follow."""

from inspect import signature
from typing import Annotated

import pytest

from ballsocket.cli import options
from ballsocket.files import inputs
from ballsocket.files.inputs import inputs_of, json_schema
from ballsocket.files.joint_file import CupTable, JointFileTable
from ballsocket.files.schema import Length, meaning
from ballsocket.files.tables import read_table
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
    assert (key.values, key.meaning) == ("a length, such as '16 mm'", "depth of a groove in the cup")
    described = {"$ref": "#/$defs/Length", "description": "depth of a groove in the cup"}
    assert json_schema(GroovedFilm)["properties"]["groove_depth"] == described
    with pytest.raises(ValueError, match="groove_depth = '3 N' is not a length, such as '16 mm'"):
        read_table({"groove_depth": "3 N"}, GroovedFilm)
    with pytest.raises(ValueError, match="'grove_depth' .* is not known; did you mean 'groove_depth'?"):
        read_table({"grove_depth": 1}, GroovedFilm)


def test_options_of_commands_and_arguments_of_tools_follow_a_new_key_of_a_joint_file(monkeypatch):
    monkeypatch.setattr(inputs, "JointFileTable", GroovedJoint)

    @options.expand_groups
    def press(*, joint_options: Annotated[options.JointOptions, ("cup",)]) -> None:
        assert joint_options.tables == {"cup": {"groove_depth": "0.2 mm"}}

    press(**{**dict.fromkeys(signature(press).parameters), "groove_depth": "0.2 mm"})
    described = schema(TOOLS["press"], {"press": press})["properties"]["groove_depth"]["description"]
    assert described == "Depth of a groove in the cup in mm."
