"""Results become one page of HTML that needs nothing beside it."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.executors.processes import Engine, Serial
from ..core.storage.atomic_files import write_atomically, write_text
from ..paper.figure import Figure
from . import accuracy_table, report_tables
from . import html as html_page
from .accuracy_plot import heat_map
from .paper_plots import draw

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

_HERE = Serial()

_LEDE = """<p>The tables, figures and checkable sentences of M. Heß and F. Forsbach, <i>An Analytical Model for
Almost Conformal Spherical Contact Problems</i>, Appl. Sci. 2021, 11, 11170
(<a href="https://doi.org/10.3390/app112311170">doi 10.3390/app112311170</a>), computed again from the
geometry up.</p>"""
_ACCURACY = """<p>Relative errors against the exact answer over joints that fill Table 1 evenly, ν 0.3 to 0.49, 500 to
4000 N: median and 95th percentile / worst in %, the worst also among joints on the ends of the ranges; under each the
joint that is worst (mm). A model is asked here whether it trusts itself or not; the last columns say at how many of
the contacts it answers, and trusts itself.</p>"""


def write_report(results: Mapping[str, Sequence[Any]], folder: Path, engine: Engine = _HERE) -> Path:
    """Write `report.html` and beside it what is in it: figures as PNG, SVG and CSV, the accuracy as a table.

    Parameters
    ----------
    results : mapping of str to sequence
        Of a `Plan`: the results of the pieces of each part.
    folder : Path
        Must be there.
    engine : Engine
        Who draws.

    Returns
    -------
    Path
        Of the page.
    """
    rows = results["accuracy"][0]
    figures = {name: Figure.joined(map(Figure.of, pieces)) for name, pieces in results.items() if "figure" in name}
    pictures = dict(engine.run(_Pictures(tuple(figures.items()), tuple(rows), folder), range(len(figures) + 1)))
    shown = [_figure(name, figure, pictures[number]) for number, (name, figure) in enumerate(figures.items())]
    sections = {
        "claims": (f"What the paper says: {report_tables.tally(results['claims'])}", _claims(results["claims"])),
        "elsewhere": ("What others found", report_tables.claims(results["elsewhere"])),
        "given": ("Tables 1 and 2: what is given", report_tables.given()),
        "table_3": ("Table 3, fitted again", report_tables.table_3(results["table_3"])),
        "figures": ("Figures 2 to 6", "".join(shown)),
        "accuracy": ("How accurate is which model?", _accuracy(rows, folder, pictures[len(figures)])),
    }
    lede = f"{_LEDE}<p>{escape(results['about'][0])}</p>"
    return write_text(folder / "report.html", html_page.page("Heß & Forsbach 2021, reproduced", lede, sections))


def _claims(findings: Sequence[Mapping[str, Any]]) -> str:
    return "<p>Each with the numbers behind it and the function that made them.</p>" + report_tables.claims(findings)


@dataclass(frozen=True)
class _Pictures:
    """Draws a figure, or last the accuracy, writes it as PNG and SVG and the numbers as CSV; returns the PNG."""

    figures: tuple[tuple[str, Figure], ...]
    rows: tuple[Mapping[str, Any], ...]
    folder: Path

    def __call__(self, number: int) -> bytes:
        if number == len(self.figures):
            return _pictured("accuracy", heat_map(self.rows), self.folder)
        name, figure = self.figures[number]
        write_text(self.folder / f"{name}.csv", _csv(figure))
        return _pictured(name, draw(figure), self.folder)


def _figure(name: str, figure: Figure, picture: bytes) -> str:
    caption = f"{escape(figure.caption)} <a href='{name}.csv'>numbers</a>, <a href='{name}.svg'>SVG</a>"
    return f"<h3 id='{name}'>{escape(figure.title)}</h3>{html_page.picture(picture, figure.title, caption)}"


def _accuracy(rows: Sequence[Mapping[str, Any]], folder: Path, picture: bytes) -> str:
    write_text(folder / "accuracy.md", accuracy_table.markdown(rows))
    write_text(folder / "accuracy.csv", accuracy_table.table(rows))
    write_text(folder / "accuracy.json", json.dumps(rows, indent=1) + "\n")
    return _ACCURACY + html_page.picture(picture, "errors of every model") + report_tables.accuracy(rows)


def _pictured(name: str, drawing: Drawing, folder: Path) -> bytes:
    """The picture as PNG; it is written as SVG too."""
    for suffix in ("png", "svg"):
        with write_atomically(folder / f"{name}.{suffix}") as draft:
            drawing.savefig(draft, dpi=140)
    return (folder / f"{name}.png").read_bytes()


def _csv(figure: Figure) -> str:
    """A row a point: panel, model, case, x and y with their names; for maps z, which the panel's title names."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("panel", "model", "case", "x_name", "x", "y_name", "y", "z"))
    for panel in figure.panels:
        for line in panel.lines:
            writer.writerows(
                (panel.title, line.model, line.case, panel.x, x, panel.y, y, "")
                for x, y in zip(line.x, line.y, strict=True)
            )
    for each in figure.maps:
        for y, row in zip(each.y, each.z, strict=True):
            names = (each.title, "", "", each.x_label)
            known = ((x, z) for x, z in zip(each.x, row, strict=True) if z is not None)
            writer.writerows((*names, x, each.y_label, y, z) for x, z in known)
    return text.getvalue()
