"""`models`, `presets` and `cite`: what there is, and where it comes from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

import ballsocket as bs

from ..catalogue import listed_models
from ..core.checks import known_name
from ..problem import Joint, Material
from ..problem.presets import joints, materials
from ..reports.catalogue_lists import (
    model_summary,
    preset_summary,
    print_model,
    print_models,
    print_preset,
    print_presets,
)
from .root import app
from .words import AsJson, echo_json

ModelName = Annotated[str | None, typer.Argument(help="One of them, in full.")]
PresetName = Annotated[str | None, typer.Argument(help="A joint or material, in full.")]


@app.command()
def models(name: ModelName = None, *, as_json: AsJson = False) -> None:
    """The catalogue: every model, where it can be trusted, and where it comes from."""
    chosen = list(listed_models.values()) if name is None else [listed_models[known_name("model", name, listed_models)]]
    if as_json:
        echo_json({"version": bs.__version__, "models": list(map(model_summary, chosen))})
    elif name is None:
        print_models(chosen)
    else:
        print_model(chosen[0])


@app.command()
def presets(name: PresetName = None, *, as_json: AsJson = False) -> None:
    """Materials and joints by name, with the sources of their numbers."""
    known = [*materials, *joints]
    names = known if name is None else [known_name("preset", name, known)]
    if as_json:
        kinds: dict[str, Mapping[str, Material | Joint]] = {"materials": materials, "joints": joints}
        listed = {
            kind: {each: preset_summary(thing) for each, thing in things.items() if each in names}
            for kind, things in kinds.items()
        }
        echo_json({"version": bs.__version__, **listed})
    elif name is None:
        print_presets()
    else:
        print_preset(names[0])


@app.command()
def cite(
    names: Annotated[list[str] | None, typer.Argument(help="Models by name; all of them if none is given.")] = None,
) -> None:
    """BibTeX of what a model is made of."""
    chosen = [known_name("model", name, listed_models) for name in names or listed_models]
    typer.echo(bs.cite(*(listed_models[name] for name in chosen)))
