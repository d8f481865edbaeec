"""What a tool takes, as JSON Schema: read from the command's own options, units with them."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from inspect import Parameter, signature
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, get_args, get_origin

from ...core.quantities import QUANTITIES
from ...files.schema_keys import json_schema
from ...problem.dimensions import DIAMETERS
from ..root import app
from ..schema import file_table
from .table import Tool

NEVER = ("as_json", "workers", "scheduler", "units")
"""What is for terminals, and for whoever owns the machine."""

_FILE = "A TOML file about {}, in the folder that the server was given."
_CONTENT = "Content of that file, in place of its name: text in TOML, or an object with the same tables and keys."


def parameters(tool: Tool) -> Mapping[str, Parameter]:
    """The parameters of a tool's command that are offered, by name."""
    known = {each.name or "": each.callback for each in app.registered_commands}
    known |= {each.callback.__name__: each.callback for each in app.registered_commands if each.callback}
    command = known[tool.command]
    assert command is not None
    found = signature(command, eval_str=True).parameters
    return {name: each for name, each in found.items() if _offered(tool, name, each)}


def _offered(tool: Tool, name: str, parameter: Parameter) -> bool:
    return name not in (*NEVER, *tool.hidden) and Path not in _types(parameter)


def schema(tool: Tool) -> dict[str, Any]:
    """The JSON Schema of a tool's arguments."""
    properties = {name: _property(name, each) for name, each in parameters(tool).items()}
    definitions: dict[str, Any] = {}
    if tool.file:
        content, definitions = _content_schema(tool)
        named = {"type": "string", "description": _FILE.format(tool.file)}
        properties = {"file": named, "content": content, **properties}
    return {
        "type": "object",
        "properties": properties,
        "required": list(tool.required),
        "additionalProperties": False,
        **({"$defs": definitions} if definitions else {}),
    }


def _content_schema(tool: Tool) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the schema of the content of a tool's file, and the definitions that it refers to."""
    file = json_schema(file_table(tool.command))
    keys = {key: part for key, part in file["properties"].items() if key not in tool.forbidden}
    table = {"type": "object", "properties": keys, "required": file["required"], "additionalProperties": False}
    return {"description": _CONTENT, "anyOf": [{"type": "string"}, table]}, file["$defs"]


def _property(name: str, parameter: Parameter) -> dict[str, Any]:
    types = _types(parameter)
    one = _ONE[next((kind for kind in _ONE if any(issubclass(each, kind) for each in types)), str)]
    described = {"description": f"{_measure(name)}{option(parameter).help or ''}"}
    if list in types:
        return {"type": "array", "items": one, "maxItems": 50, **described}
    return {**one, **described}


def _measure(name: str) -> str:
    """What a number is, and the unit of a bare one."""
    known = DIAMETERS.get(name, f"liner_{name}" if f"liner_{name}" in QUANTITIES else name)
    if known not in QUANTITIES:
        return ""
    each, twice = QUANTITIES[known], "twice " if name in DIAMETERS else ""
    return f"{twice}{each.title}{each.written.text_in_brackets}. "


_TEXT = {"type": ["string", "number"], "maxLength": 300}
_ONE: Mapping[type, dict[str, Any]] = {
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    float: {"type": "number"},
    str: _TEXT,
}
"""Text has a unit, or is a bare number in mm, N, MPa, degrees."""


def option(parameter: Parameter) -> Any:
    """What typer is told of a parameter."""
    return get_args(parameter.annotation)[1]


def _types(parameter: Parameter) -> tuple[type, ...]:
    """Every type that a parameter's annotation names."""
    return tuple(_flat(get_args(parameter.annotation)[0]))


def _flat(kind: Any) -> list[type]:
    if kind is NoneType:
        return []
    if get_origin(kind) is list:
        return [list, *_flat(get_args(kind)[0])]
    if isinstance(kind, UnionType):
        return [each for part in get_args(kind) for each in _flat(part)]
    return [str] if issubclass(kind, Enum) else [kind]
