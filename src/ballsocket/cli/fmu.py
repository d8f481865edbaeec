"""`fmu`: a joint as a unit for every program that speaks FMI."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .force_elements import ElementWords, checked_out, identifier
from .groups import grouped
from .root import app, complain, echo_path
from .words import JointWords


@app.command()
@grouped
def fmu(
    *,
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    element: ElementWords,
    out: Annotated[Path, typer.Option(help="The unit, NAME.fmu; the files of FMI's cross-check go beside it.")],
    fmi: Annotated[int, typer.Option(help="The version of FMI, 2 or 3.")] = 3,
) -> None:
    """Write a joint as a force element for programs that speak FMI: sources, and a binary for this machine."""
    from ..export.fmu import Fmu, write_cross_check

    path = checked_out(out, ".fmu")
    made = Fmu(element=element.element(words.or_named(joint)), name=identifier(path), version=fmi)
    written = made.write(path)
    echo_path(written.path)
    for beside in write_cross_check(made.element, path):
        echo_path(beside)
    if written.missing:
        complain(written.missing)
