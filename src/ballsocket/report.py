"""Results become one page of HTML that needs nothing beside it."""

from __future__ import annotations

import csv
from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

from . import paper_figures
from .paper.curves import Figure
from .version import __version__

_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
img { max-width: 100%; } figure { margin: 1rem 0; } figcaption { color: #555; }
table { border-collapse: collapse; font-size: 0.9rem; } td, th { padding: 0.25rem 0.7rem; text-align: right; }
td:first-child, th:first-child, .text td { text-align: left; vertical-align: top; }
tr { border-bottom: 1px solid #e5e5e5; }
.holds { color: #00684f; font-weight: 600; } .nearly { color: #8a5a00; font-weight: 600; }
.fails { color: #b3261e; font-weight: 600; }
"""
_CLASSES = {"holds": "holds", "holds nearly": "nearly", "does not hold": "fails"}
_LEDE = """<p>The tables, figures and checkable sentences of M. Heß and F. Forsbach, <i>An Analytical Model for
Almost Conformal Spherical Contact Problems</i>, Appl. Sci. 2021, 11, 11170
(<a href="https://doi.org/10.3390/app112311170">doi 10.3390/app112311170</a>), computed again from the
geometry up.</p>"""


def write_report(results: Mapping[str, Any], folder: Path) -> Path:
    """Write `report.html`, and beside it each figure as PNG and SVG and its numbers as CSV.

    `results` are those of the pieces of a `Plan`, by name.
    """
    figures = {name: Figure.of(result) for name, result in results.items() if name.startswith("figure")}
    drawn = {name: _drawn(name, figure, folder) for name, figure in figures.items()}
    parts = [_LEDE, _claims(results["claims"])]
    parts += [_table_3(name, result) for name, result in results.items() if name.startswith("table_3")]
    parts += [_figure(name, figure, drawn[name]) for name, figure in figures.items()]
    parts.append(_accuracy(results["accuracy"]))
    page = (
        f"<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Heß &amp; Forsbach 2021, reproduced</title>"
        f"<meta name='viewport' content='width=device-width'><style>{_STYLE}</style></head><body>"
        f"<h1>Heß &amp; Forsbach 2021, reproduced</h1>{''.join(parts)}<p>ballsocket {__version__}</p></body></html>"
    )
    path = folder / "report.html"
    path.write_text(page, encoding="utf-8")
    return path


def _drawn(name: str, figure: Figure, folder: Path) -> bytes:
    """The figure as PNG; writes its files."""
    drawing = paper_figures.draw(figure)
    picture = BytesIO()
    drawing.savefig(picture, format="png", dpi=140)
    (folder / f"{name}.png").write_bytes(picture.getvalue())
    drawing.savefig(folder / f"{name}.svg")
    (folder / f"{name}.csv").write_text(_csv(figure), encoding="utf-8")
    return picture.getvalue()


def _csv(figure: Figure) -> str:
    """A row a point: panel, model, case, x, y; for maps also z."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("panel", "model", "case", "x", "y", "z"))
    for panel in figure.panels:
        for line in panel.lines:
            writer.writerows(
                (panel.title, line.model, line.case, x, y, "") for x, y in zip(line.x, line.y, strict=True)
            )
    for each in figure.maps:
        for y, row in zip(each.y, each.z, strict=True):
            writer.writerows((each.title, "", "", x, y, z) for x, z in zip(each.x, row, strict=True) if z is not None)
    return text.getvalue()


def _figure(name: str, figure: Figure, picture: bytes) -> str:
    code = b64encode(picture).decode("ascii")
    return (
        f"<h2 id='{name}'>Figure {figure.number}</h2><figure><img alt='Figure {figure.number}' "
        f"src='data:image/png;base64,{code}'><figcaption>{escape(figure.caption)}</figcaption></figure>"
    )


def _claims(findings: Iterable[Mapping[str, Any]]) -> str:
    rows = []
    for finding in findings:
        numbers = "<br>".join(f"{escape(name)}: {value:.4g}" for name, value in finding["numbers"].items())
        said = f"{escape(finding['sentence'])}<br><small>{escape(finding['where'])}</small>"
        verdict = f"<span class='{_CLASSES[finding['verdict']]}'>{finding['verdict']}</span>"
        comment = f"<br><small>{escape(finding['comment'])}</small>" if finding["comment"] else ""
        name = finding["name"].replace("-", "_").replace(".", "_")
        code = f"<br><small><code>paper.claims.{escape(name)}</code></small>"
        rows.append((said, numbers, verdict + comment + code))
    return "<h2 id='claims'>The claims</h2>" + _table(("what the paper says", "numbers", "verdict"), rows, "text")


def _table_3(name: str, columns: Sequence[Mapping[str, Any]]) -> str:
    who = name.removeprefix("table_3_").replace("_", " ")
    heads = ("", *(f"ν {column['poisson']:g}" for column in columns))
    rows: list[tuple[str, ...]] = []
    for i, constant in enumerate(("C1", "C2", "C3")):
        rows.append((f"{constant}, paper", *(f"{column['paper'][i]:.2f}" for column in columns)))
        rows.append((f"{constant}, {who}", *(f"{column['ours'][i]:.2f}" for column in columns)))
    worst = (max(column["difference"], key=abs) for column in columns)
    rows.append(("the paper's K against ours, worst", *(f"{100 * share:+.1f} %" for share in worst)))
    for quantity in ("indentation", "max_pressure", "half_angle", "force"):
        errors = (f"{100 * column['error'][quantity]:.1f} %" for column in columns)
        rows.append((f"closed form with our K: {quantity.replace('_', ' ')}, worst", *errors))
    return f"<h2 id='{name}'>Table 3, refitted to {escape(who)}</h2>" + _table(heads, rows, "")


def _accuracy(rows: Iterable[Mapping[str, Any]]) -> str:
    names = ("indentation", "max_pressure", "half_angle", "force")
    heads = ("model", *(f"{name.replace('_', ' ')} [%]" for name in names), "trusts itself at")
    cells = []
    for row in rows:
        errors = (row["errors"][name] for name in names)
        spreads = (f"{100 * e['median']:.2g} / {100 * e['percentile_95']:.2g} / {100 * e['worst']:.2g}" for e in errors)
        cells.append((escape(row["model"]), *spreads, f"{100 * row['valid']:.0f} %"))
    lede = (
        "<p>Relative errors against the exact answer over joints that fill Table 1 evenly, ν 0.3 to 0.49, 500 to "
        "4000 N: median / 95th percentile / worst. The first three at given force, the force at given indentation.</p>"
    )
    return "<h2 id='accuracy'>How accurate is which model?</h2>" + lede + _table(heads, cells, "")


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], kind: str) -> str:
    top = "".join(f"<th>{escape(head)}</th>" for head in heads)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table class='{kind}'><tr>{top}</tr>{body}</table>"
