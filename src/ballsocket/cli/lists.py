"""Commands `models`, `presets`, `cite` and `schema`: lists of what the package contains, and of the keys of files."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from ..core.checks import known_name
from ..core.sources import cite as bibtex_of
from ..files.inputs import json_schema
from ..mcp.tools import FILE_TABLES, file_table
from ..model_catalogue import listed_models
from ..problem.presets import find_material, joints, materials
from ..reports.catalogue_lists import (
    model_summary,
    preset_summary,
    print_model,
    print_models,
    print_preset,
    print_presets,
)
from ..version import __version__
from .json_answers import echo_json
from .options import AsJson
from .root import app


@app.command()
def models(
    name: Annotated[str | None, typer.Argument(help="Name of one model, for all details. Default: all.")] = None,
    *,
    as_json: AsJson = False,
) -> None:
    """List contact models with their ranges and sources."""
    chosen = list(listed_models.values()) if name is None else [listed_models[known_name("model", name, listed_models)]]
    if as_json:
        echo_json({"version": __version__, "models": list(map(model_summary, chosen))})
    elif name is None:
        print_models(chosen)
    else:
        print_model(chosen[0])


@app.command()
def presets(
    name: Annotated[
        str | None, typer.Argument(help="Name of one joint or material, for all details. Default: all.")
    ] = None,
    *,
    as_json: AsJson = False,
) -> None:
    """List materials and joints by name, with their sources."""
    known = [*materials, *joints]
    names = known if name is None else [find_material(name) or known_name("preset", name, known)]
    if as_json:
        chosen_materials = {key: preset_summary(preset) for key, preset in materials.items() if key in names}
        chosen_joints = {key: preset_summary(preset) for key, preset in joints.items() if key in names}
        echo_json({"version": __version__, "materials": chosen_materials, "joints": chosen_joints})
    elif name is None:
        print_presets()
    else:
        print_preset(names[0])


@app.command()
def cite(
    names: Annotated[
        list[str] | None, typer.Argument(help="Names of models, materials or joints. Default: all models.")
    ] = None,
) -> None:
    """Print the BibTeX references of models, materials or joints."""
    citable = {**joints, **materials, **listed_models}
    chosen = [known_name("model, material or joint", name, citable) for name in names or listed_models]
    try:
        typer.echo(bibtex_of(*(citable[name] for name in chosen)))
    except TypeError as error:  # the source of a material or joint names no publication
        raise ValueError(str(error)) from error


@app.command()
def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {', '.join(FILE_TABLES)}.")],
) -> None:
    """Print the JSON schema of a kind of input file.

    Editors complete and check TOML files with it.
    """
    typer.echo(json.dumps(json_schema(file_table(kind)), indent=2))
