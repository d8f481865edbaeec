"""Models and presets as dictionaries for JSON and as lists in a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any

from rich.table import Table
from rich.text import Text

from ..contact.outcome import ModelInfo
from ..core.quantities import JOINT, MATERIAL, QUANTITIES, STRESS_LIMITS, Quantity
from ..core.validity import Range
from ..problem import Joint, Material
from ..problem.presets import joints, materials
from .terminal import Terminal, print_folded

if TYPE_CHECKING:
    from ..hip.wear_laws import WearFactor


def model_summary(model: ModelInfo) -> dict[str, Any]:
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


def preset_summary(preset: Material | Joint) -> dict[str, Any]:
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


_NARROW = 72  # columns: lists are paragraphs below


def print_models(models: Iterable[ModelInfo]) -> None:
    """Print the catalogue of models with validity and sources."""
    rows = []
    for model in models:
        promised = [] if model.promise is None else [f"{model.promise}:"]
        rows.append((model.name, model.title, "\n".join([*promised, *map(str, model.validity)]), _sources(model)))
    _print_rows(("model", "title", "valid for", "source"), rows, gap=1)


def print_presets() -> None:
    """Print materials and joints with the sources of their numbers."""
    for title, presets in (("materials", materials), ("joints", joints)):
        rows = [(name, _preset_numbers(preset), preset.source) for name, preset in presets.items()]
        _print_rows((title, "numbers", "source"), rows, gap=0)
        Terminal().print()


def print_model(model: ModelInfo) -> None:
    """Print one model: title, promised accuracy, range of validity with reasons, sources."""
    terminal = Terminal()
    print_folded(terminal, f"{model.name}: {model.title}", "bold")
    promise = "" if model.promise is None else f"{model.promise} of the elastic answer, "
    print_folded(terminal, f"{promise}valid for", "")
    for limit in model.validity:
        print_folded(terminal, f"  {limit}: {limit.why}", "")
    if model.reach:
        print_folded(terminal, model.reach, "")
    for source in model.sources:
        print_folded(terminal, f"source: {source}{f', doi {source.doi}' if source.doi else ''}", "")


def print_preset(name: str) -> None:
    """Print one material or joint with all its numbers, and the wear factor of a material that has one."""
    terminal = Terminal()
    preset: Material | Joint = materials[name] if name in materials else joints[name]
    print_folded(terminal, name, "bold")
    rows, factor = [*_titled_numbers(preset), ("source", preset.source)], _wear_factor(preset)
    if factor is not None:
        numbers = f"{factor.value:g} mm³/(N m), range {factor.low:g} to {factor.high:g}"
        rows += [("wear factor", numbers), ("its source", factor.source)]
    for title, text in rows:
        print_folded(terminal, f"  {title:<22}{text}", "")


def _titled_numbers(preset: Material | Joint) -> list[tuple[str, str]]:
    if isinstance(preset, Material):
        return [
            ("name", preset.name),
            *_quantities(preset, {name: QUANTITIES[name] for name in (*MATERIAL, *preset.stress_limits)}),
        ]
    ball = "rigid" if preset.ball is None else str(preset.ball)
    return [*_quantities(preset, JOINT), ("liner", str(preset.liner)), ("ball", ball)]


def _quantities(preset: Material | Joint, named: Mapping[str, Quantity]) -> list[tuple[str, str]]:
    return [
        (quantity.title, f"{float(getattr(preset, name)):g} {quantity.written.text}".strip())
        for name, quantity in named.items()
    ]


def _sources(model: ModelInfo) -> str:
    """List the publications of a model, one in a line with all cited equations and sections."""
    citations: dict[str, list[str]] = {}
    for source in model.sources:
        citations.setdefault(source.authors_and_year, []).extend([source.place] if source.place else [])
    return "\n".join(", ".join([short, *citation]) for short, citation in citations.items())


def _preset_numbers(preset: Material | Joint) -> str:
    text = str(preset).removeprefix(preset.name)
    if isinstance(preset, Joint):
        return text.removeprefix(": ")
    limits = (f"{STRESS_LIMITS[name].title} {value:g} MPa" for name, value in preset.stress_limits.items())
    return ", ".join([text.strip(" ()"), *limits])


def _print_rows(heads: Sequence[str], rows: Sequence[Sequence[str]], gap: int) -> None:
    """Print a table with `gap` empty lines between rows; in a narrow terminal a paragraph for each row."""
    terminal = Terminal()
    if terminal.width < _NARROW:
        for name, *texts in rows:
            terminal.print(Text(name, style="bold"))
            for text in texts:
                print_folded(terminal, f"  {text.replace(chr(10), '; ')}", "")
        return
    table = Table(box=None, pad_edge=False, header_style="bold", padding=(0, 2, gap, 0))
    for head in heads:
        table.add_column(head, overflow="fold", no_wrap=head == heads[0])
    for name, *texts in rows:
        table.add_row(Text(name, style="bold"), *map(Text, texts))
    terminal.print(table)
