"""Tools for AI assistants: their table, the JSON schema of their arguments, and the kinds of files that they read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from importlib import import_module
from inspect import Parameter, signature
from pathlib import Path
from types import MappingProxyType, NoneType, UnionType
from typing import Any, get_args, get_origin

from ..core.checks import known_name
from ..files.schema import FileTable
from ..files.tables import json_schema
from ..model_catalogue import OFF_AXIS

FILE_TABLES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "joint": ("files.joint_file", "JointFileTable"),
        "hip": ("hip.schema", "HipTable"),
        "study": ("studies.file", "StudyTable"),
        "identify": ("identification.file", "IdentifyTable"),
        "evidence": ("evidence.question", "QuestionTable"),
    }
)
"""Module and class of the tables of each kind of input file, by the name of its command."""


def file_table(kind: str) -> type[FileTable]:
    """Return the tables of a kind of input file; raise ValueError with the nearest kind for an unknown one."""
    module, name = FILE_TABLES[known_name("kind of file", kind, FILE_TABLES)]
    tables: type[FileTable] = getattr(import_module(f"ballsocket.{module}"), name)
    return tables


Commands = Mapping[str, Callable[..., None]]
"""Functions of the commands by name; their parameters are annotated for typer."""


@dataclass(frozen=True, kw_only=True)
class Tool:
    """A command as assistants call it."""

    command: str
    description: str  # purpose in a sentence or two
    fixed: tuple[str, ...] = ()  # arguments of every call
    hidden: tuple[str, ...] = ()  # parameters that are not offered, in addition to those for files to write
    required: tuple[str, ...] = ()  # parameters that a call must have
    file: str = ""  # subject of the TOML file that the tool reads; empty if it reads none
    writes: str = ""  # option for the folder that the tool writes; empty if it writes nothing
    forbidden: tuple[str, ...] = ()  # top-level keys that the file must not have


_DIRECTION = ("tilt", "direction", "ring_width")
_MESH = ("element_size", "element", "meshes")

TOOLS: Mapping[str, Tool] = MappingProxyType(
    {
        "press": Tool(
            command="press",
            description="Press a ball into its socket: force, indentation, half angle, pressures, area and stiffness "
            "by one model or several, with the exact result.",
            hidden=("every", *_DIRECTION),
        ),
        "compare": Tool(
            command="press",
            description="Press a ball into its socket by every model of the catalogue, with the deviation of each from "
            "the exact result.",
            fixed=("--all",),
            hidden=("model", "every", *_DIRECTION, *_MESH),
        ),
        "tilt": Tool(
            command="press",
            description="Press a ball by a load at an angle to the cup's axis: contact, rim and largest pressure in "
            "three dimensions.",
            fixed=(f"--model={OFF_AXIS}",),
            hidden=("model", "every", *_MESH),
        ),
        "curve": Tool(command="curve", description="Press a joint by one model in equal steps from zero to a load."),
        "map": Tool(
            command="map",
            description="Compute the smallest and largest results over two parameters of a joint, within limits.",
        ),
        "optimise": Tool(
            command="optimise",
            description="Find the joint with the smallest result within limits, or the Pareto front of two results.",
            required=("vary",),
        ),
        "sensitivity": Tool(
            command="sensitivity",
            description="Compute which parameter's scatter matters most (Sobol indices).",
            required=("spread",),
        ),
        "study": Tool(
            command="study",
            description="Press a joint at every point of a design: axes, samples or a table.",
            file="a study",
            forbidden=("store", "engine"),
        ),
        "wear": Tool(
            command="hip",
            description="Simulate wear, creep and lubricant film of a hip over millions of gait cycles.",
            hidden=("patients",),
            file="a hip in use",
        ),
        "identify": Tool(
            command="identify",
            description="Identify clearance, modulus and other parameters of a joint from measurements, with "
            "uncertainty, and list those that are not identifiable.",
            file="measurements",
        ),
        "evidence": Tool(
            command="evidence",
            description="Write an evidence pack for a computed number: verification, comparison with published results "
            "and uncertainty, in a folder with a page and JSON.",
            file="a question",
            writes="--out",
        ),
        "models": Tool(command="models", description="List contact models with their ranges and sources."),
        "materials": Tool(command="presets", description="List materials and joints by name, with their sources."),
    }
)
"""Tools by name."""

OMITTED = ("as_json", "workers", "scheduler", "units")
"""Parameters that only matter in a terminal, or to the owner of the machine."""

_FILE = "A TOML file about {}, in the folder of the server."
_CONTENT = "Content of that file, in place of its name: text in TOML, or an object with the same tables and keys."


def parameters(tool: Tool, commands: Commands) -> Mapping[str, Parameter]:
    """Return the parameters of a tool's command that are offered, by name."""
    declared = signature(commands[tool.command], eval_str=True).parameters
    offered = {name: declared[name] for name in declared if name not in (*OMITTED, *tool.hidden)}
    return {name: parameter for name, parameter in offered.items() if Path not in _types(parameter)}


def schema(tool: Tool, commands: Commands) -> dict[str, Any]:
    """Return the JSON Schema of a tool's arguments."""
    properties = {name: _property(parameter) for name, parameter in parameters(tool, commands).items()}
    definitions: dict[str, Any] = {}
    if tool.file:
        file = json_schema(file_table(tool.command))
        keys = {key: part for key, part in file["properties"].items() if key not in tool.forbidden}
        content = {"description": _CONTENT, "anyOf": [{"type": "string"}, _object(keys, file["required"])]}
        named = {"type": "string", "description": _FILE.format(tool.file)}
        properties, definitions = {"file": named, "content": content, **properties}, {"$defs": file["$defs"]}
    return {**_object(properties, list(tool.required)), **definitions}


def _object(properties: dict[str, Any], required: list[str]) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _property(parameter: Parameter) -> dict[str, Any]:
    types = _types(parameter)
    kind = next((kind for kind in _SCHEMAS if any(issubclass(type_, kind) for type_ in types)), str)
    description = {"description": option(parameter).help or ""}
    if list in types:
        return {"type": "array", "items": _SCHEMAS[kind], "maxItems": 50, **description}
    return {**_SCHEMAS[kind], **description}


_SCHEMAS: Mapping[type, dict[str, Any]] = {
    bool: {"type": "boolean"},
    int: {"type": "integer"},
    float: {"type": "number"},
    str: {"type": ["string", "number"], "maxLength": 300},
}
"""JSON Schema of each type; text has a unit, or is a number in mm, N, MPa, degrees."""


def option(parameter: Parameter) -> Any:
    """Return typer's description of a parameter."""
    return get_args(parameter.annotation)[1]


def _types(parameter: Parameter) -> tuple[type, ...]:
    return tuple(_flatten(get_args(parameter.annotation)[0]))


def _flatten(kind: Any) -> list[type]:
    """Return the types of a union or list; an enumeration is text."""
    if kind is NoneType:
        return []
    if get_origin(kind) is list:
        return [list, *_flatten(get_args(kind)[0])]
    if isinstance(kind, UnionType):
        return [type_ for part in get_args(kind) for type_ in _flatten(part)]
    return [str] if issubclass(kind, Enum) else [kind]
