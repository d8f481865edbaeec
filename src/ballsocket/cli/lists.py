"""Commands `models`, `presets`, `cite` and `schema`: lists of what the package contains, and of the keys of files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import isfinite
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..contact.outcome import ModelInfo
from ..core.answers import Answer, Column, Row, Table
from ..core.checks import known_name
from ..core.kinds import MEGAPASCALS, Unit
from ..core.quantities import JOINT, MATERIAL, QUANTITIES, STRESS_LIMITS
from ..core.sources import cite as bibtex_of
from ..core.unit_systems import Amount, Sentence, Units
from ..core.validity import Range
from ..files.tables import json_schema
from ..mcp.tools import FILE_TABLES, file_table
from ..model_catalogue import listed_models
from ..problem import Joint, Material
from ..problem.presets import find_material, joints, materials
from .options import AsJson, UnitSystem, print_result
from .root import app

if TYPE_CHECKING:
    from ..hip.wear_laws import WearFactor


@app.command()
def models(
    name: Annotated[str | None, typer.Argument(help="Name of one model, for all details. Default: all.")] = None,
    *,
    as_json: AsJson = False,
) -> None:
    """List contact models with their ranges and sources."""
    chosen = list(listed_models.values()) if name is None else [listed_models[known_name("model", name, listed_models)]]
    print_result(
        lambda: {"models": list(map(_model_summary, chosen))},
        lambda: _describe_models(chosen) if name is None else _describe_model(chosen[0]),
        Units.SI,
        as_json,
    )


@app.command()
def presets(
    name: Annotated[
        str | None, typer.Argument(help="Name of one joint or material, for all details. Default: all.")
    ] = None,
    *,
    units: UnitSystem = Units.SI,
    as_json: AsJson = False,
) -> None:
    """List materials and joints by name, with their sources."""
    known = [*materials, *joints]
    names = known if name is None else [find_material(name) or known_name("preset", name, known)]
    print_result(
        lambda: {
            title: {key: _preset_summary(preset) for key, preset in presets.items() if key in names}
            for title, presets in _PRESETS.items()
        },
        lambda: _describe_presets() if name is None else _describe_preset(names[0]),
        units,
        as_json,
    )


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


_PRESETS: Mapping[str, Mapping[str, Material | Joint]] = {"materials": materials, "joints": joints}


def _model_summary(model: ModelInfo) -> dict[str, Any]:
    """Summarise a model: promised accuracy, range of validity, sources; angles are in rad, an open end is null."""
    promise = model.promise
    return {
        "name": model.name,
        "title": model.title,
        "promise": None if promise is None else {"within": promise.within, "quantities": list(promise.quantities)},
        "validity": list(map(_range, model.validity)),
        "reach": model.reach,
        "sources": [source.summary() for source in model.sources],
    }


def _preset_summary(preset: Material | Joint) -> dict[str, Any]:
    """Summarise a material or joint with its source, and the wear factor of a material that has one."""
    summary = {**preset.summary(), "source": preset.source}
    factor = _wear_factor(preset)
    if factor is not None:
        numbers = {"value": factor.value, "low": factor.low, "high": factor.high}
        summary["wear_factor"] = {**numbers, "unit": "mm³/(N m)", "source": factor.source}
    return summary


def _wear_factor(preset: Material | Joint) -> WearFactor | None:
    """Return the published wear factor of a preset; None if none is known."""
    from ..hip.wear_laws import WEAR_FACTORS  # imported on use: the room of hips is slow to import

    return next((factor for name, factor in WEAR_FACTORS.items() if materials[name] is preset), None)


def _range(limit: Range) -> dict[str, Any]:
    """Summarise a range of validity; an open end is None."""
    low, high = (end if isfinite(end) else None for end in (limit.low, limit.high))
    name = limit.quantity if isinstance(limit.quantity, str) else None
    return {"quantity": name, "text": str(limit), "low": low, "high": high, "why": limit.why}


def _describe_models(models: Iterable[ModelInfo]) -> Answer:
    """List the catalogue of models with validity and sources."""
    columns = [Column.of_words(head) for head in ("model", "title", "valid for", "source")]
    rows = []
    for model in models:
        promised = [] if model.promise is None else [f"{model.promise}:"]
        validity = "\n".join([*promised, *map(str, model.validity)])
        rows.append(Row((model.name, model.title, validity, _sources(model)), below=[("",) * 4]))
    return Answer(title="models of a contact", tables=[Table("models", "Models", columns, rows)])


def _describe_presets() -> Answer:
    """List materials and joints with the sources of their numbers."""
    tables = []
    for title, presets in _PRESETS.items():
        columns = [Column.of_words(head) for head in (title, "numbers", "source")]
        rows = [Row((name, _preset_numbers(preset), preset.source)) for name, preset in presets.items()]
        tables.append(Table(title, title, columns, [*rows[:-1], rows[-1]._replace(below=[("",) * 3])]))
    return Answer(title="presets", tables=tables)


def _describe_model(model: ModelInfo) -> Answer:
    """List promised accuracy, range of validity with reasons, and sources of a model."""
    columns = [Column.of_words(head) for head in ("valid for", "reason")]
    rows = [Row((str(limit), limit.why)) for limit in model.validity]
    sources = [f"source: {source}{f', doi {source.doi}' if source.doi else ''}" for source in model.sources]
    return Answer(
        title=f"{model.name}: {model.title}",
        lines=[] if model.promise is None else [f"{model.promise} of the elastic answer"],
        tables=[Table("validity", "Validity", columns, rows, [model.reach] if model.reach else [])],
        notes=sources,
    )


def _describe_preset(name: str) -> Answer:
    """List all numbers of a material or joint, and the wear factor of a material that has one."""
    preset: Material | Joint = materials[name] if name in materials else joints[name]
    if isinstance(preset, Material):
        numbers = (*MATERIAL, *preset.stress_limits)
        rows = [("name", preset.name), *((QUANTITIES[key].title, _number(preset, key)) for key in numbers)]
    else:
        rows = [(quantity.title, _number(preset, key)) for key, quantity in JOINT.items()]
        rows += [("liner", str(preset.liner)), ("ball", "rigid" if preset.ball is None else str(preset.ball))]
    rows.append(("source", preset.source))
    factor = _wear_factor(preset)
    if factor is not None:
        value, low, high = (Amount(number, _WEAR_FACTOR) for number in (factor.value, factor.low, factor.high))
        rows += [
            ("wear factor", Sentence("{}, range {} to {}", value, low, high)),
            ("its source", factor.source),
        ]
    columns = [Column.of_words("quantity"), Column.of_words("value")]
    return Answer(title=name, tables=[Table("preset", "Preset", columns, list(map(Row, rows)))])


_WEAR_FACTOR = Unit("mm³/(N m)")


def _number(preset: Material | Joint, name: str) -> Sentence:
    return Sentence("{}", Amount(float(getattr(preset, name)), QUANTITIES[name].written, 6))


def _sources(model: ModelInfo) -> str:
    """List the publications of a model, one in a line with all cited equations and sections."""
    citations: dict[str, list[str]] = {}
    for source in model.sources:
        citations.setdefault(source.authors_and_year, []).extend([source.place] if source.place else [])
    return "\n".join(", ".join([short, *citation]) for short, citation in citations.items())


def _preset_numbers(preset: Material | Joint) -> str:
    unnamed = str(replace(preset, name=""))
    if isinstance(preset, Joint):
        return unnamed
    limits = preset.stress_limits
    template = ", ".join(["{}", *(f"{STRESS_LIMITS[name].title} {{}}" for name in limits)])
    return Sentence(template, unnamed, *(Amount(value, MEGAPASCALS) for value in limits.values()))
