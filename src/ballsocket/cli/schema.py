"""`schema`: the JSON schema of a kind of input file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Annotated

import typer

from ..core.checks import known_name
from ..files.schema import Table
from .root import app

_TABLES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "joint": ("ballsocket.files.joint_file", "JointFileTable"),
        "hip": ("ballsocket.hip.schema", "HipTable"),
        "study": ("ballsocket.studies.file", "StudyTable"),
        "identify": ("ballsocket.identify.file", "IdentifyTable"),
        "evidence": ("ballsocket.evidence.question", "QuestionTable"),
    }
)
"""Module and table of each kind of input file, by the name of its command; only one in use is loaded."""

KINDS = tuple(_TABLES)
"""Kinds of input files."""


def file_table(kind: str) -> type[Table]:
    """Return the table of a kind of input file.

    Raises
    ------
    ValueError
        A kind that is not known; the message suggests the nearest one.
    """
    module, name = _TABLES[known_name("kind of file", kind, KINDS)]
    table: type[Table] = getattr(import_module(module), name)
    return table


@app.command()
def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {', '.join(KINDS)}.")],
) -> None:
    """Print the JSON schema of a kind of input file, for editors that complete and check TOML."""
    from ..files.schema_keys import json_schema

    typer.echo(json.dumps(json_schema(file_table(kind)), indent=2))
