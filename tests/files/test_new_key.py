"""One line of a schema is enough for a new key: reading, refusals, JSON schema and documentation follow."""

from typing import Annotated

import pytest

from ballsocket.files.schema import Length, meaning
from ballsocket.files.schema_keys import json_schema, keys_of
from ballsocket.files.tables import read_table
from ballsocket.hip.schema import FilmTable


class GroovedFilm(FilmTable, frozen=True, kw_only=True):
    """Film of a cup with a groove."""

    groove_depth: Annotated[Length | None, meaning("depth of a groove in the cup")] = None


def test_reading_schema_and_documentation_follow_a_new_key():
    assert read_table({"groove_depth": "0.02 cm"}, GroovedFilm).groove_depth == pytest.approx(0.2)
    (key,) = [key for key in keys_of(GroovedFilm) if "groove_depth" in key.name]
    assert (key.values, key.meaning) == ("a length, such as '16 mm'", "depth of a groove in the cup")
    described = {"$ref": "#/$defs/Length", "description": "depth of a groove in the cup"}
    assert json_schema(GroovedFilm)["properties"]["groove_depth"] == described
    with pytest.raises(ValueError, match="groove_depth = '3 N' is not a length, such as '16 mm'"):
        read_table({"groove_depth": "3 N"}, GroovedFilm)
    with pytest.raises(ValueError, match="'grove_depth' .* is not known; did you mean 'groove_depth'?"):
        read_table({"grove_depth": 1}, GroovedFilm)
