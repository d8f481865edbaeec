"""`schema`: the JSON schema of a kind of input file."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated

import typer

from ..core.checks import known_name
from ..evidence.question import QuestionTable
from ..files.joint_file import JointFileTable
from ..files.schema import Table, json_schema
from ..hip.schema import HipTable
from ..identify.file import IdentifyTable
from ..studies.file import StudyTable
from .root import app
from .words import echo_json

KINDS: Mapping[str, type[Table]] = MappingProxyType(
    {
        "joint": JointFileTable,
        "hip": HipTable,
        "study": StudyTable,
        "identify": IdentifyTable,
        "evidence": QuestionTable,
    }
)
"""Kinds of input files by the names of their commands."""


@app.command()
def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {', '.join(KINDS)}.")],
) -> None:
    """Print the JSON schema of a kind of input file, for editors that complete and check TOML."""
    echo_json(json_schema(KINDS[known_name("kind of file", kind, KINDS)], f"ballsocket {kind} file"))
