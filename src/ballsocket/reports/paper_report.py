"""Page of the recomputed paper, and the files beside it: figures, their numbers, and the accuracy of all models."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from io import StringIO
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.executors.processes import Engine, Serial
from ..core.kinds import Unit
from ..core.quantities import JOINT
from ..core.storage.atomic_files import write_atomically, write_text
from ..paper.accuracy import RANGES, THICKNESS
from ..paper.figure import Figure
from ..paper.table_3 import RATIOS
from . import accuracy_table
from .pages import data_address, render_page
from .paper_plots import draw, heat_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_SERIAL = Serial()

_VERDICT_STYLES = {"holds": "holds", "holds within": "nearly", "does not hold": "fails"}
"""Style of a verdict on the page."""

_VERDICT_COUNTS = ("hold", "hold within some percent", "fail")
"""Words after the number of each verdict, in the order of `_VERDICT_STYLES`."""

Row = Mapping[str, Any]
Table = dict[str, Sequence[Any]]


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
    _write_accuracy(rows, folder)
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
    rows: tuple[Row, ...]
    folder: Path

    def __call__(self, index: int) -> bytes:
        """Write the figure as PNG, SVG and CSV, and return the PNG."""
        if index == len(self.figures):
            return _write_picture("accuracy", heat_map(self.rows), self.folder)
        name, figure = self.figures[index]
        write_text(self.folder / f"{name}.csv", _csv_text(figure))
        return _write_picture(name, draw(figure), self.folder)


def _write_picture(name: str, drawing: Drawing, folder: Path) -> bytes:
    """Write a picture as PNG and SVG, and return the PNG."""
    for suffix in ("png", "svg"):
        with write_atomically(folder / f"{name}.{suffix}") as draft:
            drawing.savefig(draft, dpi=140)
    return (folder / f"{name}.png").read_bytes()


def _csv_text(figure: Figure) -> str:
    """Write the points of a figure as CSV: panel, model, case, x and y with their names; z for maps."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("panel", "model", "case", "x_name", "x", "y_name", "y", "z"))
    for panel in figure.panels:
        for line in panel.lines:
            writer.writerows(
                (panel.title, line.model, line.case, panel.x, x, panel.y, y, "")
                for x, y in zip(line.x, line.y, strict=True)
            )
    for field in figure.maps:
        for y, row in zip(field.y, field.z, strict=True):
            names = (field.title, "", "", field.x_label)
            known = ((x, z) for x, z in zip(field.x, row, strict=True) if z is not None)
            writer.writerows((*names, x, field.y_label, y, z) for x, z in known)
    return text.getvalue()


def _write_accuracy(rows: Sequence[Row], folder: Path) -> None:
    """Write the accuracy of all models as Markdown, CSV and JSON."""
    write_text(folder / "accuracy.md", accuracy_table.markdown(rows))
    write_text(folder / "accuracy.csv", accuracy_table.table(rows))
    write_text(folder / "accuracy.json", json.dumps(rows, indent=1) + "\n")


def _tally(findings: Iterable[Row]) -> str:
    """Count the verdicts."""
    verdicts = [finding["verdict"] for finding in findings]
    counts = zip(_VERDICT_STYLES, _VERDICT_COUNTS, strict=True)
    return ", ".join(f"{verdicts.count(verdict)} {words}" for verdict, words in counts)


def _number_text(value: float) -> str:
    """Write a number with three digits; a large one in full, with spaces between thousands."""
    return f"{value:,.0f}".replace(",", " ") if abs(value) >= 1e4 else f"{value:.3g}"


def _geometry() -> Table:
    """Return Table 1 of the paper: the ranges of the geometry."""
    ranges = {"liner_thickness": THICKNESS, **{name: RANGES[name] for name in JOINT if name in RANGES}}
    return {
        "heads": ("Table 1", *(JOINT[name].label(Unit("")) for name in ranges)),
        "rows": [("range", *(f"{low:g} to {high:g} mm" for low, high in ranges.values()))],
    }


def _fits(columns: Sequence[Row]) -> list[dict[str, Any]]:
    """Return Table 3 by reference: the paper's constants beside those fitted here, and the differences."""
    groups = groupby(columns, key=lambda column: str(column["reference"]))
    return [{"reference": name, **_fit_table(name, list(group))} for name, group in groups]


def _fit_table(name: str, columns: Sequence[Row]) -> Table:
    """Return the constants fitted to one reference, by Poisson's ratio."""
    rows: list[tuple[str, ...]] = []
    for i, constant in enumerate(("C1", "C2", "C3")):
        rows.append((f"{constant}, paper", *(f"{column['paper'][i]:.2f}" for column in columns)))
        rows.append((f"{constant}, {name}", *(f"{column['ours'][i]:.2f}" for column in columns)))
    for i, ratio in enumerate(RATIOS):
        differences = (f"{100 * column['difference'][i]:+.1f} %" for column in columns)
        rows.append((f"the paper's K against ours at R2/L {ratio:g}", *differences))
    for quantity, head in accuracy_table.HEADS.items():
        for owner, key in (("the paper's", "paper_error"), ("our", "error")):
            errors = (f"{100 * column[key][quantity]:.1f} %" for column in columns)
            rows.append((f"closed form with {owner} K: {head}, worst", *errors))
    return {"heads": ("", *(f"ν {column['poisson']:g}" for column in columns)), "rows": rows}


def _accuracy(rows: Iterable[Row], png: bytes) -> dict[str, Any]:
    """Return the accuracy of every model and quantity, with the joint of the largest error."""
    heads = accuracy_table.HEADS
    return {
        "address": data_address(png),
        "heads": tuple(heads.values()),
        "rows": [
            {
                "model": row["model"],
                "errors": [
                    (accuracy_table.spread(row["errors"][name]), accuracy_table.place(row["errors"][name]))
                    for name in heads
                ],
                "answered": f"{100 * row['answered']:.3g} %",
                "valid": f"{100 * row['valid']:.3g} %",
            }
            for row in rows
        ],
    }
