"""Command `schema`: the JSON schema of a kind of input file."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from ..files.schema_keys import json_schema
from ..mcp.file_kinds import FILE_TABLES, file_table
from .root import app


@app.command()
def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {', '.join(FILE_TABLES)}.")],
) -> None:
    """Print the JSON schema of a kind of input file.

    Editors complete and check TOML files with it.
    """
    typer.echo(json.dumps(json_schema(file_table(kind)), indent=2))
