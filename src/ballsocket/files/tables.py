"""Tables of files: read from the content of a file, written to it, their values, and their JSON schemas."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any

import msgspec
from msgspec import inspect

from ..core.quantities import QUANTITIES
from .inputs import Input, choices_in, meaning_of, parts_of, plain_default, unit_words
from .schema import FileTable, Parsed, QuantityValue, TableType, Value, choices_schema, read_value


def parsed_values(table: FileTable | None, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the objects of the `Parsed` values of a table, in the order of the file's `content`; empty without one."""
    values = {} if table is None else {name: getattr(table, name, None) for name in content}
    return {name: value.value for name, value in values.items() if isinstance(value, Parsed)}


def quantities_of(table: FileTable, *names: str) -> dict[str, float]:
    """Return the numbers of a table that the file states, by key; all quantities without names."""
    values = {name: getattr(table, name) for name in names or table.__struct_fields__}
    return {name: float(value) for name, value in values.items() if isinstance(value, QuantityValue)}


def written_in(table: FileTable) -> dict[str, Any]:
    """Return the quantities of a table as the file writes them, by key."""
    values = {name: getattr(table, name) for name in table.__struct_fields__}
    return {name: value.written for name, value in values.items() if isinstance(value, QuantityValue)}


def read_table(content: Mapping[str, Any], table: type[TableType]) -> TableType:
    """Convert the content of a file.

    Raises ValueError: one sentence: the table, the key, the value and what is allowed.
    """
    try:
        return msgspec.convert(dict(content), table, dec_hook=read_value)
    except msgspec.ValidationError as error:
        from .refusals import format_refusal  # not loaded for files without faults

        raise ValueError(format_refusal(error, content, table)) from error


def write_table(table: FileTable, with_units: bool = False) -> dict[str, Any]:
    """Return a table as the content of a file, without defaults.

    Parameters
    ----------
    table : Table
    with_units : bool
        True for texts with units, such as "16.0 mm"; otherwise numbers are bare in mm, N, MPa and degrees.
    """
    return {key: _write(value, with_units) for key, value in table.stated().items()}


def _write(value: Any, with_units: bool) -> Any:
    if isinstance(value, FileTable):
        return write_table(value, with_units)
    if isinstance(value, QuantityValue):
        return value.write(with_units)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Parsed):
        return str(value.value)
    if isinstance(value, list):
        return [_write(item, with_units) for item in value]
    return ", ".join(map(repr, value)) if isinstance(value, tuple) else value


def json_schema(table: type[FileTable]) -> dict[str, Any]:
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
    described, default = meaning_of(field.encode_name, field.type), plain_default(field)
    example, quantity = Input("", field).example, QUANTITIES.get(field.encode_name)
    if quantity is not None and described == quantity.title:
        described = f"{quantity.title}{quantity.written.text_in_brackets}. {quantity.meaning}"
    elif described:
        name, mark, condition = described.partition("; ")
        described = f"{name}{unit_words(name, field.type)}{mark}{condition}"
    return {
        **_type_schema(field.type, definitions),
        **({"description": described} if described else {}),
        **({} if default is None else {"default": default}),
        **({"examples": [example]} if example else {}),
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
