"""Wear: a design over millions of cycles, or two beside each other: depth, penetration with its band, numbers."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from html import escape
from math import nan
from typing import Any

from ...comparison import relative_deviation
from ...core.kinds import Unit
from ...core.quantities import CONTACT, DERIVED
from ...files.joint_file import JointFile
from ...hip.law_fields import LawField
from ...hip.wear_law import COEFFICIENT
from ...hip.wear_laws import WEAR_LAWS
from ...problem.presets import joints
from ...reports.pages import picture
from ...reports.style import BLUE, VERMILLION, LineStyle
from ..long_view import LongView, long_body
from ..pictures.bore import CELLS_EDGE, METRIC, BoreField, bore_map, grid_field
from ..pictures.chart import Curve, chart, charts
from ..pressing import axis_end
from ..results import RESULTS
from ..running import Work
from ..state.screen import Screen
from ..state.use import CHOICES, CREEP_INPUTS, LAW_INPUTS, WEAR_INPUTS, Use
from ..view import Document
from ..widgets.blocks import Content, notes_list, sentence, table
from ..widgets.controls import (
    Changes,
    Control,
    amount,
    capital,
    choice,
    chosen,
    cycle_controls,
    number,
    segments,
)
from ..widgets.reading import Reading
from ..widgets.words import checked, doubt, number_text, percent, unit_of_files
from .hip_runs import WEAR_SECONDS, WearResult, simulate_designs, wear_key

_ALONE, _NOW, _AS_COMPARED = "", "as it is now", "as added"
_DEPTH, _PRESSURE = CONTACT["indentation"], CONTACT["max_pressure"]  # quantities whose units depths and pressures have
_LAWS = [(name, capital(law.title)) for name, law in WEAR_LAWS.items()]
_DESIGN_LINES = (LineStyle(BLUE), LineStyle(VERMILLION, (6.0, 2.0)))


def _beside(screen: Screen) -> Control:
    present = {_ALONE: (), _NOW: (screen.file,), _AS_COMPARED: screen.beside}
    compared = [(_AS_COMPARED, f"{screen.beside[0].joint.name or 'a joint'}, {_AS_COMPARED}")] if screen.beside else []
    options = [(_ALONE, "– nothing –"), *compared, (_NOW, f"this design {_NOW}"), *joints]

    def read(name: str) -> Changes:
        return {"beside": present[name] if name in present else (replace(screen.file, joint=joints[name]),)}

    return Control(choice("beside", "Compare with", options, _AS_COMPARED if screen.beside else _ALONE), read)


def _law_numbers(screen: Screen, keys: Iterable[str]) -> Iterator[Control]:
    """Yield the inputs of those numbers of `LAW_INPUTS` that the chosen laws have."""
    use = screen.use
    for key in (key for key in keys if key in use.used_inputs):
        edit, part = partial(use.with_law_number, key), LAW_INPUTS[key]
        yield _law_number(key, part, capital(part.meaning), use.law_number(key), edit)


def _law_number(key: str, part: LawField, title: str, value: float, edit: Callable[[float], Use]) -> Control:
    """Return the input of a number of a law, over three decades around its example.

    A typed number has a decimal point or comma, with or without its unit.
    """
    unit = f" [{part.unit.text}]".replace("(N m)", "(N\N{NO-BREAK SPACE}m)") if part.unit.text else ""
    step = part.example / 100 or 0.01

    def read(text: Any) -> Changes:
        plain = text.strip().replace(",", ".") if isinstance(text, str) else text
        return {"use": edit(float(part.unit.read(key, plain)))}

    return Control(number(key, f"{title}{unit}", Unit(""), (step, 1000 * step), step, value), read)


class Wear(LongView):
    """View of wear over millions of cycles, which shows stored results at once."""

    title, name, run_label, longest = "Wear", "wear", "Run the wear", WEAR_SECONDS
    body = long_body(
        "wear",
        '<div id="wear-curve"></div><div class="beside" id="wear-maps"></div><div id="wear-numbers"></div>',
    )

    def controls(self, screen: Screen) -> list[Control]:
        use, part = screen.use, screen.use.coefficient_field

        def wearing(value: float) -> Use:
            return replace(use, coefficient=value)

        return [
            *cycle_controls(screen),
            chosen(screen, "use.law", "Wear law", _LAWS),
            *([_law_number(COEFFICIENT, part, "Coefficient", use.coefficient, wearing)] if part is not None else []),
            *_law_numbers(screen, WEAR_INPUTS),
            amount(screen, "use.spread", "Patient-to-patient factor", (1.0, 3.0), 0.1),
            amount(screen, "use.millions", "Million cycles", (0.5, 20.0), 0.5),
            chosen(screen, "use.creep", "Include creep", CHOICES["creep"], segments),
            *_law_numbers(screen, CREEP_INPUTS),
            _beside(screen),
        ]

    def question_of(self, screen: Screen) -> Hashable:
        return tuple(_files_by_key(screen))

    def work(self, screen: Screen) -> Work:
        files = _files_by_key(screen)
        singles = {key: RESULTS.get((self.name, (key,))) for key in files}
        known = {key: result[key] for key, result in singles.items() if result is not None}
        return partial(simulate_designs, files, screen.use, known)

    def show_result(self, screen: Screen, result: dict[Hashable, WearResult] | None) -> None:
        parts: dict[str, Content] = {
            "numbers": _NOTHING,
            "curve": empty_chart(screen.use.millions, screen.reading),
            "maps": "",
        }
        if result is not None:
            named = _named(screen, result)
            parts = {
                "numbers": wear_numbers(named, screen.reading),
                "curve": penetration_chart(named, screen.reading),
                "maps": depth_maps(named, screen.reading),
            }
            for key, single in result.items():
                RESULTS.put((self.name, (key,)), {key: single})
        self.put(**parts)

    def document(self, screen: Screen) -> Document:
        named = _named(screen, self.result(screen))
        unit = unit_of_files(CONTACT["indentation"], screen.reading)
        depths = [f"{name}{unit.text_in_brackets}" for name in ("penetration", "low", "high", "deepest")]
        rows = [
            [name, float(cycles), *(unit.factor * float(depth) for depth in row), float(volume)]
            for name, design in named.items()
            for cycles, *row, volume in zip(
                design.cycles, design.penetration, design.low, design.high, design.deepest, design.volume, strict=True
            )
        ]
        units = screen.reading.units
        pictures = "".join(picture(run.figures[units], f"penetration of {name}") for name, run in named.items())
        return Document(
            rows=lambda: [["design", "million cycles", *depths, "volume [mm3]"], *rows],
            sections=lambda: {"wear": ("Wear", [*wear_numbers(named, screen.reading), pictures])},
        )


_NOTHING = (
    "<p class='quiet'>A run of springs takes some seconds, of a real cup a minute. Patients with a new hip walk one to "
    "two million cycles a year.</p>"
)


def _files_by_key(screen: Screen) -> dict[Hashable, JointFile]:
    """Return the designs on the screen by the inputs of their wear; equal designs are one."""
    return {wear_key(file, screen.use): file for file in designs(screen).values()}


def _named(screen: Screen, result: dict[Hashable, WearResult]) -> dict[str, WearResult]:
    """Name the results by the designs on the screen, or by numbers if they belong to earlier designs."""
    keys = {name: wear_key(file, screen.use) for name, file in designs(screen).items()}
    if all(key in result for key in keys.values()):
        return {name: result[key] for name, key in keys.items()}
    return {f"earlier design {number}": design for number, design in enumerate(result.values(), 1)}


def designs(screen: Screen) -> dict[str, JointFile]:
    """Return the design on the screen and the first compared one, by name."""
    named = {screen.file.joint.name or "this design": screen.file}
    for file in screen.beside[:1]:
        name = file.joint.name or "the other"
        named[f"{name}, beside" if name in named else name] = file
    return named


def wear_numbers(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> list[Any]:
    """Tabulate the final wear of each design, with the difference from the first."""
    columns = [_final_values(design, reading) for design in designs.values()]
    rows = []
    for name, base in columns[0].items():
        others = [column[name] for column in columns[1:]]
        apart = [percent(float(relative_deviation(value, base)), "+") if base else "" for value in others]
        cells = [number_text(value) + f" ({share})" * bool(share) for value, share in zip(others, apart, strict=True)]
        rows.append([name, number_text(base), *cells])
    content: list[Any] = [table(["after the last cycle", *designs], rows)]
    for name, entry in designs.items():
        content += [f"<h3>{escape(name)} after the last cycle</h3>", *checked(entry.checks, reading)]
    for name, entry in designs.items():
        band = sentence(f"{name}: {entry.band}")
        content += [*doubt(entry.summary["contact"]["valid"], name), band, notes_list(entry.notes, reading)]
    return content


def _final_values(worn: WearResult, reading: Reading) -> dict[str, float]:
    last, values = worn.summary["history"][-1], {"worn volume [mm³]": float(worn.volume[-1])}
    edge = nan if last["edge_distance"] is None else last["edge_distance"]
    for name, quantity, value in (
        ("deepest wear", _DEPTH, float(worn.deepest[-1])),
        ("penetration", _DEPTH, float(worn.penetration[-1])),
        ("penetration by creep alone", _DEPTH, last["penetration_of_creep"]),
        ("largest pressure, new", _PRESSURE, worn.summary["cycle"]["peaks"]["max_pressure_MPa"]),
        ("largest pressure, worn", _PRESSURE, last["max_pressure"]),
        ("smallest distance to the rim, worn", DERIVED["edge_distance"], edge),
    ):
        unit = reading.unit(quantity)
        values[f"{name}{unit.text_in_brackets}"] = value * unit.factor
    for state, checks in (("new", worn.summary["contact"]["unworn"]), ("worn", last["contact"])):
        used = (check["utilisation"] for check in checks if check["utilisation"] is not None)
        values[f"utilisation σv/σy, {state}"] = max(used, default=nan)
    return values


def penetration_chart(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> Content:
    """Draw the penetration of each design over the cycles, with its band."""
    lines = dict(zip(designs, _DESIGN_LINES, strict=False))
    unit = reading.unit(_DEPTH)
    curves = {
        name: Curve(
            design.cycles,
            unit.factor * design.penetration,
            lines[name],
            band=(unit.factor * design.low, unit.factor * design.high),
        )
        for name, design in designs.items()
    }
    end = max(float(design.cycles[-1]) for design in designs.values())
    highest = axis_end(unit.factor * max(float(design.high.max()) for design in designs.values()))
    sentences = []
    for name, design in designs.items():
        last, low, high = (
            reading.with_unit(_DEPTH, float(values[-1])) for values in (design.penetration, design.low, design.high)
        )
        sentences.append(f"{name}: {last} after {design.cycles[-1]:g} million cycles, {low} to {high}")
    label, up = f"penetration: {'; '.join(sentences)}", f"penetration{unit.text_in_brackets}"
    drawn = chart(label, "million cycles", up, curves, (end, highest))
    bands = dict.fromkeys(design.band.removeprefix("band: ") for design in designs.values())
    return [charts(drawn, legend=[f"shaded: {'; '.join(bands)}"])]


def empty_chart(millions: float, reading: Reading) -> Content:
    """Draw the axes of the penetration over the cycles, for a design without a result."""
    unit, label = reading.unit(_DEPTH), "penetration over the cycles, not computed yet"
    up = f"penetration{unit.text_in_brackets}"
    return [charts(chart(label, "million cycles", up, {}, (millions, 0.1 * unit.factor)))]


def depth_maps(designs: Mapping[str, WearResult], reading: Reading = METRIC) -> str:
    """Draw the worn depth of each bore in one colour scale."""
    unit, figures = reading.unit(_DEPTH), []
    deepest = {name: float(worn.depth.max()) for name, worn in designs.items()}
    for index, (name, worn) in enumerate(designs.items()):
        field = BoreField(
            name=f"wear{index}",
            at=grid_field(worn.grid, unit.factor * worn.depth),
            highest=unit.factor * (max(deepest.values()) or 1.0),
            label=f"worn depth{unit.text_in_brackets}",
            reach=worn.grid.reach,
            cup=worn.cup,
            least=CELLS_EDGE,
        )
        label = f"worn depth of {name} seen from its opening, up to {reading.with_unit(_DEPTH, deepest[name])}"
        bore = bore_map(label, field, worn.load)
        figures.append(f"<figure><figcaption>{escape(name)}</figcaption>{bore}</figure>")
    return "".join(figures)
