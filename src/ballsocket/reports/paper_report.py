"""Page of the recomputed paper with its figures, their numbers, and the accuracy of all models."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.executors.processes import Engine, Serial
from ..core.kinds import Unit
from ..core.quantities import JOINT
from ..core.storage.atomic_files import write_atomically, write_csv, write_text
from ..model_catalogue import JUDGE
from ..models.foundation import HessForsbach
from ..paper.cases import OUTER_RADII, RANGES, RATIOS, THICKNESS
from ..paper.claims import SCALE
from ..paper.curves import FIT, Figure, Map, Panel
from ..paper.plan import ELEMENTS
from . import accuracy_results
from .pages import data_address, render_page
from .style import LEGEND, finish, in_matplotlib, line_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

_SERIAL = Serial()

_VERDICT_STYLES = {"holds": "holds", "holds within": "nearly", "does not hold": "fails"}
"""Style of a verdict on the page."""

_VERDICT_COUNTS = ("hold", "hold within some percent", "fail")
"""Words after the number of each verdict, in the order of `_VERDICT_STYLES`."""

Record = Mapping[str, Any]
PageTable = dict[str, Sequence[Any]]


def write_report(results: Mapping[str, Sequence[Any]], folder: Path, engine: Engine = _SERIAL) -> Path:
    """Write `report.html` and, beside it, its figures as PNG, SVG and CSV and the accuracy as tables.

    Parameters
    ----------
    results : mapping of str to sequence
        Results of the pieces of each part of a `Plan`.
    folder : Path
        Folder that exists.
    engine : Engine
        Executor that draws the figures.

    Returns
    -------
    Path
        Path of the page.
    """
    rows = results["accuracy"][0]
    figures = {name: Figure.joined(map(Figure.of, pieces)) for name, pieces in results.items() if "figure" in name}
    pictures = dict(engine.run(_DrawFigure(tuple(figures.items()), tuple(rows), folder), range(len(figures) + 1)))
    write_text(folder / "accuracy.md", accuracy_results.markdown(rows))
    write_csv(folder / "accuracy.csv", accuracy_results.table(rows))
    write_text(folder / "accuracy.json", json.dumps(rows, indent=1) + "\n")
    sections = {
        "claims": (f"Claims of the paper: {_tally(results['claims'])}", None),
        "elsewhere": ("Results of others", None),
        "given": ("Tables 1 and 2: input data", None),
        "table_3": ("Table 3, fitted again", None),
        "figures": ("Figures 2 to 6", None),
        "accuracy": ("Accuracy of the models", None),
    }
    page = render_page(
        "paper_report.html",
        "Heß & Forsbach 2021, reproduced",
        sections,
        about=results["about"][0],
        claims=results["claims"],
        scale=SCALE,
        elsewhere=results["elsewhere"],
        verdict_styles=_VERDICT_STYLES,
        number=_number_text,
        geometry=_geometry(),
        fits=_fits(results["table_3"]),
        figures=[
            {
                "name": name,
                "title": figure.title,
                "caption": figure.caption,
                "address": data_address(pictures[index]),
            }
            for index, (name, figure) in enumerate(figures.items())
        ],
        accuracy=_accuracy(rows, pictures[len(figures)]),
    )
    return write_text(folder / "report.html", page)


@dataclass(frozen=True)
class _DrawFigure:
    """Callable that draws a figure by its index, or the accuracy after the last; it writes the files of the figure."""

    figures: tuple[tuple[str, Figure], ...]
    rows: tuple[Record, ...]
    folder: Path

    def __call__(self, index: int) -> bytes:
        """Write the figure as PNG, SVG and CSV, and return the PNG."""
        if index == len(self.figures):
            return _write_picture("accuracy", accuracy_results.heat_map(self.rows), self.folder)
        name, figure = self.figures[index]
        write_csv(self.folder / f"{name}.csv", _points(figure))
        return _write_picture(name, draw(figure), self.folder)


def _write_picture(name: str, drawing: Drawing, folder: Path) -> bytes:
    """Write a picture as PNG and SVG, and return the PNG."""
    for suffix in ("png", "svg"):
        with write_atomically(folder / f"{name}.{suffix}") as draft:
            drawing.savefig(draft, dpi=140)
    return (folder / f"{name}.png").read_bytes()


def _points(figure: Figure) -> Iterator[tuple[Any, ...]]:
    """Yield the points of a figure below heads: panel, model, case, x and y with their names; z for maps."""
    yield "panel", "model", "case", "x_name", "x", "y_name", "y", "z"
    for panel in figure.panels:
        for line in panel.lines:
            for x, y in zip(line.x, line.y, strict=True):
                yield panel.title, line.model, line.case, panel.x, x, panel.y, y, ""
    for field in figure.maps:
        for y, row in zip(field.y, field.z, strict=True):
            for x, z in zip(field.x, row, strict=True):
                if z is not None:
                    yield field.title, "", "", field.x_label, x, field.y_label, y, z


def _tally(findings: Iterable[Record]) -> str:
    verdicts = [finding["verdict"] for finding in findings]
    counts = zip(_VERDICT_STYLES, _VERDICT_COUNTS, strict=True)
    return ", ".join(f"{verdicts.count(verdict)} {words}" for verdict, words in counts)


def describe_verdicts(results: Mapping[str, Sequence[Any]]) -> Answer:
    """Describe the verdict on each claim, the scale of the words, and the number of each verdict."""
    findings = [*results["claims"], *results["elsewhere"]]
    columns = [Column.of_words("claim"), Column.of_words("verdict")]
    table = Table("claims", "Claims", columns, [Row((finding["name"], finding["text"])) for finding in findings])
    note = f"Claims of the paper: {_tally(results['claims'])}. {SCALE}"
    return Answer(title="Heß & Forsbach 2021, computed again", tables=[table], notes=[note])


def _number_text(value: float) -> str:
    """Write a number with three digits; a large one in full, with spaces between thousands."""
    return f"{value:,.0f}".replace(",", " ") if abs(value) >= 1e4 else f"{value:.3g}"


def _geometry() -> PageTable:
    """Return Table 1 of the paper: the ranges of the geometry."""
    ranges = {"liner_thickness": THICKNESS, **{name: RANGES[name] for name in JOINT if name in RANGES}}
    return {
        "heads": ("Table 1", *(JOINT[name].label(Unit("")) for name in ranges)),
        "rows": [("range", *(f"{low:g} to {high:g} mm" for low, high in ranges.values()))],
    }


def _fits(columns: Sequence[Record]) -> list[dict[str, Any]]:
    """Return Table 3 by reference: the paper's constants beside those fitted here, and the differences."""
    groups = groupby(columns, key=lambda column: str(column["reference"]))
    return [{"reference": name, **_fit_table(name, list(group))} for name, group in groups]


def _fit_table(name: str, columns: Sequence[Record]) -> PageTable:
    """Return the constants fitted to one reference, by Poisson's ratio."""
    rows: list[tuple[str, ...]] = []
    for i, constant in enumerate(("C1", "C2", "C3")):
        rows.append((f"{constant}, paper", *(f"{column['paper'][i]:.2f}" for column in columns)))
        rows.append((f"{constant}, {name}", *(f"{column['ours'][i]:.2f}" for column in columns)))
    for i, ratio in enumerate(RATIOS):
        differences = (f"{100 * column['difference'][i]:+.1f} %" for column in columns)
        rows.append((f"the paper's K against ours at R2/L {ratio:g}", *differences))
    for quantity, head in accuracy_results.HEADS.items():
        for owner, key in (("the paper's", "paper_error"), ("our", "error")):
            errors = (f"{100 * column[key][quantity]:.1f} %" for column in columns)
            rows.append((f"closed form with {owner} K: {head}, worst", *errors))
    return {"heads": ("", *(f"ν {column['poisson']:g}" for column in columns)), "rows": rows}


def _accuracy(rows: Iterable[Record], png: bytes) -> dict[str, Any]:
    heads = accuracy_results.HEADS
    return {
        "address": data_address(png),
        "heads": tuple(heads.values()),
        "rows": [
            {
                "model": row["model"],
                "errors": [
                    (accuracy_results.spread(row["errors"][name]), accuracy_results.place(row["errors"][name]))
                    for name in heads
                ],
                "answered": f"{100 * row['answered']:.3g} %",
                "valid": f"{100 * row['valid']:.3g} %",
            }
            for row in rows
        ],
    }


_MODELS = {ELEMENTS: JUDGE, FIT: HessForsbach().name}
"""Catalogue names of models with another name in the paper's figures."""

_WIDTH = 10.8  # inches: the width of a page, with letters of the size of its text


def draw(figure: Figure) -> Drawing:
    """Draw one of the paper's figures."""
    from matplotlib.figure import Figure as Drawing

    parts: list[Panel | Map] = [*figure.panels, *figure.maps]
    rows = -(-len(parts) // figure.columns)
    drawing = Drawing()
    for axes, part in zip(
        _grid(drawing, rows, figure.columns, bottom_margin=0.95 if figure.panels else 0.55), parts, strict=False
    ):
        axes.set_visible(True)
        if isinstance(part, Map):
            _draw_map(axes, part)
            continue
        _draw_panel(axes, part)
        if not _have_same_cases(figure.panels):
            _name_cases(axes, part)
    _name_models(drawing, figure)
    return drawing


def _grid(drawing: Drawing, rows: int, columns: int, bottom_margin: float) -> Iterator[Axes]:
    """Yield hidden axes of equal size; fixed margins save the seconds of a layout engine."""
    left_margin, column_gap, right_margin, top_margin, row_gap = 0.75, 0.75, 0.15, 0.35, 0.85
    width = (_WIDTH - left_margin - right_margin - (columns - 1) * column_gap) / columns
    height = 0.72 * width
    height_of_figure = top_margin + rows * height + (rows - 1) * row_gap + bottom_margin
    drawing.set_size_inches(_WIDTH, height_of_figure)
    drawing.subplots_adjust(
        left=left_margin / _WIDTH,
        right=1 - right_margin / _WIDTH,
        top=1 - top_margin / height_of_figure,
        bottom=bottom_margin / height_of_figure,
        wspace=column_gap / width,
        hspace=row_gap / height,
    )
    for axes in drawing.subplots(rows, columns, squeeze=False).ravel():
        axes.set_visible(False)
        yield axes


def _name_models(drawing: Drawing, figure: Figure) -> None:
    """Add a legend of the models below, and of the cases if all panels have the same."""
    from matplotlib.lines import Line2D

    lines = [line for panel in figure.panels for line in panel.lines]
    if not lines:
        return
    models, cases = (
        list(dict.fromkeys(names)) for names in zip(*((line.model, line.case) for line in lines), strict=True)
    )
    styles = {model: _style(model) if len(cases) == 1 else {**_style(model), "color": "0.3"} for model in models}
    if len(cases) > 1 and _have_same_cases(figure.panels):
        styles |= {case: {"color": colour, "linewidth": 4.0} for case, colour in _case_colours(cases).items()}
    handles = [Line2D([], [], label=name, **style) for name, style in styles.items()]
    drawing.legend(handles=handles, loc="lower center", ncols=min(len(handles), 8), **LEGEND)


def _have_same_cases(panels: Sequence[Panel]) -> bool:
    return len({frozenset(line.case for line in panel.lines) for panel in panels}) == 1


def _draw_panel(axes: Axes, panel: Panel) -> None:
    cases = list(dict.fromkeys(line.case for line in panel.lines))
    for line in panel.lines:
        colour = {} if len(cases) == 1 else {"color": _case_colours(cases)[line.case]}
        axes.plot(line.x, line.y, **{**_style(line.model), **colour})
    finish(axes, panel.x, panel.y)
    axes.locator_params(nbins=5)
    axes.set_title(panel.title, fontsize=10)
    _limit(axes, panel)


def _limit(axes: Axes, panel: Panel) -> None:
    """Start axes at zero where the lines nearly do, and cut off values beyond the panel."""
    lines = [line for line in panel.lines if line.model != "hertz"]
    longest = max(line.x[-1] for line in lines)
    if min(line.x[0] for line in panel.lines) < 0.1 * longest:
        axes.set_xlim(left=0.0)
    if panel.highest is not None:
        axes.set_ylim(0.0, panel.highest)
        axes.set_xlim(0.0, 1.15 * longest)
    else:
        axes.set_ylim(0.0, 1.1 * max(max(line.y) for line in lines))


def _name_cases(axes: Axes, panel: Panel) -> None:
    from matplotlib.lines import Line2D

    cases = dict.fromkeys(line.case for line in panel.lines)
    handles = [Line2D([], [], label=case, color=colour) for case, colour in _case_colours(list(cases)).items()]
    axes.legend(handles=handles, frameon=False, fontsize=8)


def _case_colours(cases: Sequence[str]) -> dict[str, Any]:
    """Return a colour for each case, from dark to light, distinguishable in grey."""
    from matplotlib import colormaps

    return dict(zip(cases, colormaps["viridis"](numpy.linspace(0.0, 0.82, len(cases))), strict=True))


def _style(model: str) -> dict[str, Any]:
    """Return the line style of a model; circles for the finite elements, which coincide with other lines."""
    style = in_matplotlib(line_of(_MODELS.get(model, model)), 1.6)
    if model != ELEMENTS:
        return style
    return {**style, "linestyle": "", "marker": "o", "markersize": 3.5, "markerfacecolor": "none", "markevery": 3}


def _draw_map(axes: Axes, field: Map) -> None:
    """Draw filled contours of a map with numbers on its lines."""
    values = numpy.array([[numpy.nan if value is None else value for value in row] for row in field.z], dtype=float)
    colours = _about_zero() if field.about_zero else {"cmap": "viridis", "levels": 9}
    filled = axes.contourf(field.x, field.y, values, **colours)
    lines = axes.contour(field.x, field.y, values, levels=filled.levels, colors="black", linewidths=0.5, linestyles="-")
    for text in axes.clabel(lines, fontsize=7):
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.6})
    radius = numpy.array(field.x)
    for outer in OUTER_RADII:
        (limit,) = axes.plot(radius, outer - radius, color="black", linestyle=":", linewidth=1.5)
    label = f"outer radius {OUTER_RADII[0]:g}, {OUTER_RADII[1]:g} mm"
    axes.legend(handles=[limit], labels=[label], loc="upper right", **LEGEND)
    axes.set_ylim(field.y[0], field.y[-1])
    axes.set(xlabel=field.x_label, ylabel=field.y_label)
    axes.set_title(field.title, fontsize=10)


_ENDS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_LEVELS = (*(-end for end in reversed(_ENDS)), *_ENDS)


def _about_zero() -> dict[str, Any]:
    """Return contour levels that all maps share, so that a colour means the same error in each."""
    from matplotlib.colors import SymLogNorm

    norm = SymLogNorm(linthresh=1.0, vmin=-300.0, vmax=300.0)
    return {"levels": _LEVELS, "cmap": "RdBu_r", "norm": norm, "extend": "both"}
