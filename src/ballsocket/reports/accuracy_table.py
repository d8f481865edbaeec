"""Accuracy of all models as text: Markdown for readers, CSV for programs.

Rows are the dictionaries of `Accuracy.summary()`.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping
from io import StringIO
from typing import Any

from ..core.quantities import CONTACT, QUANTITIES

_LOADS = {"indentation": "force", "max_pressure": "force", "half_angle": "force", "force": "indentation"}
HEADS = {name: f"{CONTACT[name].symbol} at given {CONTACT[load].symbol}" for name, load in _LOADS.items()}
"""Heads of the columns by quantity."""

Row = Mapping[str, Any]


def markdown(rows: Iterable[Row]) -> str:
    """Write a Markdown table: median, 95th percentile and worst error in percent, and the joint of the worst error."""
    lines = [
        f"| model | {' | '.join(HEADS.values())} | worst joint |",
        "|---|" + "---:|" * len(HEADS) + "---|",
    ]
    for row in rows:
        cells = (spread(row["errors"][name]) for name in HEADS)
        lines.append(f"| `{row['model']}` | {' | '.join(cells)} | {worst_joint(row)} |")
    return "\n".join(lines) + "\n"


def spread(error: Row) -> str:
    """Write median, 95th percentile and worst error in percent; one number if they are equal."""
    errors = [percent(error[name]) for name in ("median", "percentile_95", "worst")]
    return errors[0] if len(set(errors)) == 1 else " / ".join(errors)


def percent(share: float) -> str:
    """Write a share in percent with two digits: 0.74, 12, 160; `<0.001` below."""
    value = 100 * share
    if value < 0.001:
        return "<0.001"
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def worst_joint(row: Row) -> str:
    """Describe the joint of the largest error of a model, after the symbol of its quantity."""
    name = max(HEADS, key=lambda quantity: float(row["errors"][quantity]["worst"]))
    return f"{CONTACT[name].symbol}: {place(row['errors'][name])}"


def place(error: Row) -> str:
    """Describe the joint and the load of a worst error."""
    at = _numbers(error)
    digits = {"ball_radius": 3, "clearance": 2, "liner_thickness": 3, "poisson": 2}
    joint = ", ".join(f"{QUANTITIES[name].symbol} {at[name]:.{count}g}" for name, count in digits.items())
    return f"{joint}, {at['force']:g} {CONTACT['force'].unit}"


def table(rows: Iterable[Row]) -> str:
    """Write CSV with one row for each model and quantity; errors as shares, lengths in mm, forces in N."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow((*_COLUMNS, "ball_radius", "clearance", "liner_thickness", "poisson", "force"))
    for row in rows:
        for name, error in row["errors"].items():
            errors = (error[statistic] for statistic in ("median", "percentile_95", "worst"))
            writer.writerow((row["model"], name, *errors, row["answered"], row["valid"], *_numbers(error).values()))
    return text.getvalue()


_COLUMNS = ("model", "quantity", "median", "percentile_95", "worst", "answered", "valid")


def _numbers(error: Row) -> dict[str, float]:
    """Return the lengths (mm), Poisson's ratio and force (N) of a worst error by name."""
    return dict(_joint_numbers(error["worst_at"]))


def _joint_numbers(at: Row) -> Iterator[tuple[str, float]]:
    """Yield name and value of the numbers of a worst joint."""
    joint = at["joint"]
    for name in ("ball_radius", "clearance", "liner_thickness"):
        yield name, joint[name]
    yield "poisson", joint["liner"]["poisson"]
    yield "force", at["force"]
