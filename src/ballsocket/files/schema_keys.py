"""Descriptions of the schemas of input files: lists of their keys, and JSON schemas."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from msgspec import inspect

from ..core.quantities import QUANTITIES
from .refusals import choices_in, customs_in, expected, meaning_of, parts_of, tables_of
from .schema import QuantityValue, Table, Value, choices_schema


@dataclass(frozen=True)
class Key:
    """Key of a table of files, for the documentation, with its accepted values in words.

    `table` is the head of its table, such as "[joint]" or "[[backing]]", and empty at the top of the file. `default` is
    as the file writes it, "required", or empty without a default.
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
        if f"{head.strip('[]')}.{field.encode_name}".lstrip(".") not in heads
        or any(isinstance(part, inspect.StrType) for part in parts_of(field.type))  # a text in place of a table
    ]


def _key(head: str, field: inspect.Field) -> Key:
    default = _plain_default(field)
    text = "" if default is None else str(default).lower() if isinstance(default, bool) else repr(default)
    return Key(
        table=head,
        name=field.encode_name,
        values=_values(field),
        default="required" if field.required else text,
        meaning=meaning_of(field.encode_name, field.type),
    )


def _values(field: inspect.Field) -> str:
    choices = choices_in(field.type)
    if choices:
        return ", ".join(choices)
    customs = customs_in(field.type)
    if not customs:
        return expected(field.encode_name, field.type)
    if issubclass(customs[0], QuantityValue):
        return customs[0].kind.example
    text = (customs[0].__doc__ or "").split(".\n")[0].rstrip(".")
    return text[:1].lower() + text[1:]


def _plain_default(field: inspect.Field) -> Any:
    """Return the default of a key as JSON has it; None without a default, or for a table."""
    value = field.default.value if isinstance(field.default, Enum) else field.default
    plain = next((kind for kind in (bool, int, float, str) if isinstance(value, kind)), None)
    return None if plain is None else plain(value)


def json_schema(table: type[Table]) -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a kind of file, for editors and other programs."""
    definitions: dict[str, Any] = {}
    root = inspect.type_info(table)
    assert isinstance(root, inspect.StructType)
    schema = _object_schema(root, definitions)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "$defs": definitions}


def _object_schema(struct: inspect.StructType, definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a table; `definitions` gets those of the tables in it."""
    return {
        "title": (struct.cls.__doc__ or "").split("\n")[0].rstrip("."),
        "type": "object",
        "properties": {field.encode_name: _key_schema(field, definitions) for field in struct.fields},
        "required": [field.encode_name for field in struct.fields if field.required],
        "additionalProperties": False,
    }


def _key_schema(field: inspect.Field, definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a key, with its meaning and default."""
    described, default = meaning_of(field.encode_name, field.type), _plain_default(field)
    quantity = QUANTITIES.get(field.encode_name)
    if quantity is not None and described == quantity.title:
        described = f"{quantity.title}{quantity.written.text_in_brackets}. {quantity.meaning}"
    return {
        **_type_schema(field.type, definitions),
        **({"description": described} if described else {}),
        **({} if default is None else {"default": default}),
    }


def _type_schema(kind: inspect.Type, definitions: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of a type of values; None is left out, because TOML does not have it."""
    parts = [part for part in parts_of(kind) if not isinstance(part, inspect.NoneType)]
    schemas = [_part_schema(part, definitions) for part in parts]
    return schemas[0] if len(schemas) == 1 else {"anyOf": schemas}


def _part_schema(part: inspect.Type, definitions: dict[str, Any]) -> dict[str, Any]:
    if isinstance(part, inspect.CustomType):
        value: type[Value] = part.cls
        definitions[value.__name__] = value.json_schema()
        return {"$ref": f"#/$defs/{value.__name__}"}
    if isinstance(part, inspect.EnumType):
        return choices_schema(choices_in(part))
    if isinstance(part, inspect.ListType):
        return {"type": "array", "items": _type_schema(part.item_type, definitions)}
    if isinstance(part, inspect.DictType):
        return {"type": "object", "additionalProperties": _type_schema(part.value_type, definitions)}
    if isinstance(part, inspect.StructType):
        name = part.cls.__name__
        if name not in definitions:
            definitions[name] = _object_schema(part, definitions)
        return {"$ref": f"#/$defs/{name}"}
    return {"type": {inspect.BoolType: "boolean", inspect.StrType: "string"}[type(part)]}
