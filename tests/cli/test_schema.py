"""JSON schemas of input files: valid, and in agreement with the readers by an independent validator."""

import json
import tomllib
from functools import cache
from pathlib import Path

import pytest

from ballsocket.mcp.tools import FILE_TABLES

from ..fuzz.test_readers import HIPS, MEASURED
from ..places import EXAMPLES
from ..refusals import text_tables, unescaped
from .command import run

jsonschema = pytest.importorskip("jsonschema")

_HIPS = ("hip_in_use", "hip_of_many", "wear_test", "wear_stations")
KIND_OF_EXAMPLE = {"evidence": "evidence", **dict.fromkeys(_HIPS, "hip")}
KIND_OF_EXAMPLE |= {"measured_areas": "identify", "measured_joint": "identify"}
"""Kinds of the example files; all others are joint files."""


@cache
def validator(kind):
    return jsonschema.Draft202012Validator(json.loads(run("schema", kind).stdout))


def errors(kind, text):
    return [error.message for error in validator(kind).iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("kind", FILE_TABLES)
def test_a_schema_is_valid_and_describes_every_key(kind):
    schema = validator(kind).schema
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["title"]
    tables = [schema, *(part for part in schema["$defs"].values() if "properties" in part and "title" in part)]
    for table in tables:
        assert table["additionalProperties"] is False
        for key, part in table["properties"].items():
            assert part.get("description") or "$ref" in str(part), key


OF_COMMANDS = sorted(path for path in EXAMPLES.glob("*.toml") if path.stem != "designs")  # for the explorer alone


@pytest.mark.parametrize("path", OF_COMMANDS, ids=lambda path: path.stem)
def test_examples_follow_the_schema_of_their_kind(path):
    assert errors(KIND_OF_EXAMPLE.get(path.stem, "joint"), path.read_text("utf-8")) == []


@pytest.mark.parametrize("text", [*map(bytes.decode, HIPS), *map(bytes.decode, MEASURED)])
def test_files_that_are_read_follow_the_schema(text):
    assert errors("identify" if "[free]" in text else "hip", text) == []


(WRONG_KEYS,) = text_tables(Path(__file__).parent / "wrong_keys.txt")


@pytest.mark.parametrize(("kind", "text", "key"), WRONG_KEYS)
def test_a_wrong_key_or_value_is_rejected(kind, text, key):
    parts, found = key.split("|"), errors(kind, unescaped(text))
    assert any(part in message for message in found for part in parts), found


@pytest.mark.parametrize("word", ["UHMWPE", "bone_cement", "Bone Cement"])
def test_words_are_accepted_in_every_spelling_of_the_reader(word):
    assert errors("joint", f"[liner]\nmaterial = {word!r}") == []


def test_a_kind_is_accepted_in_every_case_and_the_help_lists_all_kinds():
    assert run("schema", "HIP").stdout == run("schema", "hip").stdout
    text = run("schema", "--help").stdout
    assert all(kind in text for kind in (*FILE_TABLES, "JSON schema"))
