"""The tables of the report as HTML, from the dictionaries that a `Plan` gives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from itertools import groupby
from typing import Any

from ..core.kinds import Unit
from ..core.quantities import JOINT
from ..paper.accuracy import RANGES, THICKNESS
from ..paper.table_3 import RATIOS
from .accuracy_table import HEADS, place, spread

Row = Mapping[str, Any]

_CLASSES = {"holds": "holds", "holds within": "nearly", "does not hold": "fails"}
_MANY = ("hold", "hold within some percent", "fail")


def claims(findings: Sequence[Row]) -> str:
    """What is said, the numbers behind it, and the verdict."""
    return _table(("what is said", "what we find", "verdict"), map(_claim, findings), "text")


def _claim(finding: Row) -> tuple[str, str, str]:
    said = f"{escape(finding['sentence'])}<br><small>{escape(finding['where'])}</small>"
    numbers = "<br>".join(f"{escape(name)}: {_number(value)}" for name, value in finding["numbers"].items())
    verdict = f"<span class='{_CLASSES[finding['verdict']]}'>{escape(finding['text'])}</span>"
    comment = f"<br><small>{escape(finding['comment'])}</small>" if finding["comment"] else ""
    code = f"<br><small><code>{escape(finding['code'])}</code></small>"
    return said, numbers, verdict + comment + code


def _number(value: float) -> str:
    return f"{value:,.0f}".replace(",", " ") if abs(value) >= 1e4 else f"{value:.3g}"


def tally(findings: Iterable[Row]) -> str:
    """How many of each verdict."""
    verdicts = [finding["verdict"] for finding in findings]
    counts = ((verdicts.count(verdict), many) for verdict, many in zip(_CLASSES, _MANY, strict=True))
    return ", ".join(f"{count} {many}" for count, many in counts)


def given() -> str:
    """Tables 1 and 2, which are the paper's input and ours."""
    named = {"liner_thickness": THICKNESS, **{name: RANGES[name] for name in JOINT if name in RANGES}}
    geometry = _table(
        ("Table 1", *(JOINT[name].label(Unit("")) for name in named)),
        [("range", *(f"{low:g} to {high:g} mm" for low, high in named.values()))],
        "",
    )
    material = _table(
        ("Table 2", "elastic modulus", "Poisson's ratio"),
        [("steel head", "230 GPa", "0.3"), ("UHMWPE liner", "1 GPa", "0.4 and 0.45; Table 3 from 0.3 to 0.49")],
        "",
    )
    return geometry + material


def table_3(columns: Sequence[Row]) -> str:
    """The paper's constants beside those of each reference, and how far the moduli and the contacts lie apart."""
    return "".join(
        f"<h3>Fitted to {escape(name)}</h3>" + _refitted(name, list(group))
        for name, group in groupby(columns, key=lambda column: str(column["reference"]))
    )


def _refitted(name: str, columns: Sequence[Row]) -> str:
    heads = ("", *(f"ν {column['poisson']:g}" for column in columns))
    rows: list[tuple[str, ...]] = []
    for i, constant in enumerate(("C1", "C2", "C3")):
        rows.append((f"{constant}, paper", *(f"{column['paper'][i]:.2f}" for column in columns)))
        rows.append((f"{constant}, {escape(name)}", *(f"{column['ours'][i]:.2f}" for column in columns)))
    for i, ratio in enumerate(RATIOS):
        differences = (f"{100 * column['difference'][i]:+.1f} %" for column in columns)
        rows.append((f"the paper's K against ours at R2/L {ratio:g}", *differences))
    for quantity, head in HEADS.items():
        for whose, key in (("the paper's", "paper_error"), ("our", "error")):
            errors = (f"{100 * column[key][quantity]:.1f} %" for column in columns)
            rows.append((f"closed form with {whose} K: {head}, worst", *errors))
    return _table(heads, rows, "")


def accuracy(rows: Iterable[Row]) -> str:
    """Every model and quantity, with the joint that is worst."""
    cells = [
        (
            f"<code>{escape(row['model'])}</code>",
            *(
                f"{escape(spread(row['errors'][name]))}<br><small>{place(row['errors'][name])}</small>"
                for name in HEADS
            ),
            f"{100 * row['answered']:.3g} %",
            f"{100 * row['valid']:.3g} %",
        )
        for row in rows
    ]
    return _table(("model", *HEADS.values(), "answers", "says valid"), cells, "")


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], kind: str) -> str:
    top = "".join(f"<th>{escape(head)}</th>" for head in heads)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<div class='wide'><table class='{kind}'><tr>{top}</tr>{body}</table></div>"
