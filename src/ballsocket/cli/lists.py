"""`models`, `presets` and `cite`: what there is, and where it comes from."""

from __future__ import annotations

from typing import Annotated

import typer

import ballsocket as bs

from ..catalogue import theories
from ..checks import nearest
from ..output.list_terminal import print_models, print_presets
from .root import app


@app.command()
def models() -> None:
    """The catalogue: every model, where it can be trusted, and where it comes from."""
    print_models(theories.values())


@app.command()
def presets() -> None:
    """Materials and joints by name, with the sources of their numbers."""
    print_presets()


@app.command()
def cite(
    names: Annotated[list[str] | None, typer.Argument(help="Models by name; all of them if none is given.")] = None,
) -> None:
    """BibTeX of what a model is made of."""
    for name in names or []:
        if name not in theories:
            raise ValueError(f"model {name!r} is not known{nearest(name, theories)}")
    typer.echo(bs.cite(*(theories[name] for name in names or theories)))
