"""`export`: a joint in the words of another program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..core.checks import known_name
from ..export.target import ExportJob
from ..export.targets import TARGETS
from .force_elements import ElementWords, identifier
from .groups import grouped
from .root import app, complain, echo_path
from .words import JointWords


@app.command()
@grouped
def export(
    *,
    target: Annotated[str, typer.Argument(help=f"Program: {', '.join(TARGETS)}.")],
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    element: ElementWords,
    out: Annotated[
        Path, typer.Option(help="Output folder. Its name is also that of the files. Missing folders are created.")
    ],
) -> None:
    """Write a joint as a force element for another program, with what that needs around it."""
    from ..export.law_fit import fit_depth

    chosen = TARGETS[known_name("target", target, TARGETS)]
    nearest = next(path for path in (out, *out.parents, Path()) if path.exists())
    if not nearest.is_dir():
        raise ValueError(f"{str(nearest)!r} is a file; a folder is needed")
    file = words.or_named(joint)
    made = element.element(file)
    job = ExportJob(element=made, name=identifier(out), depth=fit_depth(made, file.load))
    paths, missing = chosen.write(job, out)
    echo_path(out, f": {', '.join(path.relative_to(out).as_posix() for path in paths)}")
    if missing:
        complain(missing)
