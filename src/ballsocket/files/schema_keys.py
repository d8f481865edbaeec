"""Descriptions of the schemas of input files: lists of their keys, and JSON schemas."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import msgspec
from msgspec import inspect

from ..core.quantities import QUANTITIES
from .refusals import choices_in, customs_in, expected, meaning_of, parts_of, tables_of
from .schema import Quantity, Table, choices_schema


@dataclass(frozen=True)
class Key:
    """Key of a table of files, for the documentation.

    Attributes
    ----------
    table : str
        Head of its table, such as "[joint]" or "[[backing]]"; empty at the top of the file.
    name : str
    values : str
        Accepted values in words.
    default : str
        Default as the file writes it; "required", or empty without a default.
    meaning : str
    """

    table: str
    name: str
    values: str
    default: str
    meaning: str


def keys_of(table: type[Table]) -> list[Key]:
    """List the keys of a file, table by table, those at the top first."""
    root = inspect.type_info(table)
    tables: list[tuple[str, Any]] = [("", root), *tables_of(root)]
    heads = {head.strip("[]") for head, _ in tables}
    return [
        _key(head, field)
        for head, struct in tables
        for field in struct.fields
        if f"{head.strip('[]')}.{field.encode_name}".lstrip(".") not in heads or _takes_text(field.type)
    ]


def _takes_text(kind: inspect.Type) -> bool:
    """Return True if a key takes a text in place of a table."""
    return any(isinstance(part, inspect.StrType) for part in parts_of(kind))


def _key(head: str, field: inspect.Field) -> Key:
    """Describe a key for the documentation."""
    return Key(
        table=head,
        name=field.encode_name,
        values=_values(field),
        default="required" if field.required else _default(field),
        meaning=meaning_of(field.encode_name, field.type),
    )


def _values(field: inspect.Field) -> str:
    """Describe the accepted values of a key in words."""
    choices = choices_in(field.type)
    if choices:
        return ", ".join(choices)
    customs = customs_in(field.type)
    if not customs:
        return expected(field.encode_name, field.type)
    if issubclass(customs[0], Quantity):
        return customs[0].kind.example
    return (customs[0].__doc__ or "").split(".\n")[0].rstrip(".")


def _default(field: inspect.Field) -> str:
    """Return the default of a key as a file writes it; empty without a default."""
    value = field.default.value if isinstance(field.default, Enum) else field.default
    if value is inspect.NODEFAULT or value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else repr(value)


def json_schema(table: type[Table], title: str = "") -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a kind of file, for editors and other programs.

    Parameters
    ----------
    table : class
    title : str, optional
        Title of the schema, by default the first line of the class.
    """
    schema = msgspec.json.schema(table, schema_hook=_value_schema)
    definitions = {name: _readable(part) for name, part in schema["$defs"].items()}
    root = definitions.pop(table.__name__)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **root,
        "title": title or root["description"],
        "$defs": definitions,
    }


def _value_schema(kind: Any) -> dict[str, Any]:
    """Return the JSON schema of a type of values for msgspec."""
    return dict(kind.json_schema())


def _readable(definition: dict[str, Any]) -> dict[str, Any]:
    """Add meanings to the keys of a table, and other spellings to words; leave out null, which TOML does not have."""
    if "enum" in definition:
        return {**choices_schema(definition["enum"]), "title": definition["title"]}
    properties = {key: _without_null(part) for key, part in definition["properties"].items()}
    for key, part in properties.items():
        if "description" not in part and key in QUANTITIES:
            quantity = QUANTITIES[key]
            part["description"] = f"{quantity.title}{quantity.written.text_in_brackets}. {quantity.meaning}"
    return {**definition, "properties": properties}


def _without_null(part: dict[str, Any]) -> dict[str, Any]:
    """Remove null from the accepted values and defaults of a key."""
    choices = [choice for choice in part.get("anyOf", ()) if choice != {"type": "null"}]
    other = {key: value for key, value in part.items() if key != "anyOf" and (key, value) != ("default", None)}
    return {**choices[0], **other} if len(choices) == 1 else {**other, "anyOf": choices} if choices else other
