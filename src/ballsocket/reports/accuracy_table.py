"""The accuracy of the catalogue as text: Markdown for readers, CSV for programs. Nothing is computed here.

Rows are the dictionaries of `Accuracy.summary()`.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping
from io import StringIO
from typing import Any

from ..core.quantities import CONTACT, QUANTITIES

_GIVEN = {"indentation": "force", "max_pressure": "force", "half_angle": "force", "force": "indentation"}
HEADS = {name: f"{CONTACT[name].symbol} at given {CONTACT[load].symbol}" for name, load in _GIVEN.items()}
"""The quantities, as a reader names them."""

Row = Mapping[str, Any]


def markdown(rows: Iterable[Row]) -> str:
    """One table: median, 95th percentile and worst error in percent, and the joint that is worst of all."""
    lines = [
        f"| model | {' | '.join(HEADS.values())} | worst joint |",
        "|---|" + "---:|" * len(HEADS) + "---|",
    ]
    for row in rows:
        cells = (spread(row["errors"][name]) for name in HEADS)
        lines.append(f"| `{row['model']}` | {' | '.join(cells)} | {worst_joint(row)} |")
    return "\n".join(lines) + "\n"


def spread(error: Row) -> str:
    """Median / 95th percentile / worst in percent."""
    shares = [percent(error[name]) for name in ("median", "percentile_95", "worst")]
    return shares[0] if len(set(shares)) == 1 else " / ".join(shares)


def percent(share: float) -> str:
    """To two digits: 0.74, 12, 160; `<0.001` below."""
    value = 100 * share
    if value < 0.001:
        return "<0.001"
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def worst_joint(row: Row) -> str:
    """Where the largest of all errors of a model lies."""
    name = max(HEADS, key=lambda each: float(row["errors"][each]["worst"]))
    return f"{CONTACT[name].symbol}: {place(row['errors'][name])}"


def place(error: Row) -> str:
    """The joint and the load of a worst error."""
    at = _numbers(error)
    digits = {"ball_radius": 3, "clearance": 2, "liner_thickness": 3, "poisson": 2}
    joint = ", ".join(f"{QUANTITIES[name].symbol} {at[name]:.{count}g}" for name, count in digits.items())
    return f"{joint}, {at['force']:g} {CONTACT['force'].unit}"


def table(rows: Iterable[Row]) -> str:
    """CSV, a row a model and quantity; errors as shares, lengths in mm, forces in N."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow((*_COLUMNS, "ball_radius", "clearance", "liner_thickness", "poisson", "force"))
    for row in rows:
        for name, error in row["errors"].items():
            shares = (error[each] for each in ("median", "percentile_95", "worst"))
            writer.writerow((row["model"], name, *shares, row["answered"], row["valid"], *_numbers(error).values()))
    return text.getvalue()


_COLUMNS = ("model", "quantity", "median", "percentile_95", "worst", "answered", "valid")


def _numbers(error: Row) -> dict[str, float]:
    return dict(_named(error["worst_at"]))


def _named(at: Row) -> Iterator[tuple[str, float]]:
    joint = at["joint"]
    for name in ("ball_radius", "clearance", "liner_thickness"):
        yield name, joint[name]
    yield "poisson", joint["liner"]["poisson"]
    yield "force", at["force"]
