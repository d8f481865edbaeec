"""Checks of a design as a table in HTML."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..contact.verdict import bar_text, percent
from ..core.answers import Check as Check
from ..core.quantities import QUANTITIES, Quantity
from ..design_checks import checks_at as checks_at
from ..design_checks import checks_of as checks_of
from ..design_checks import sorted_checks as sorted_checks
from ..design_checks import unchecked_text as unchecked_text
from ..design_checks import verdict_of as verdict_of
from ..design_checks import wear_check as wear_check
from .pages import render_part

Writer = Callable[[Quantity, float], str]
"""Function that writes a number in internal units with its unit: `Units.text_of`, or `Reading.with_unit`."""


def checks_html(rows: Sequence[Check], write: Writer) -> str:
    """Render checks as a table in HTML, with sign, word and style of each result; narrow pages stack its cells."""
    return render_part("parts.html", "checks", [_cells(row, write) for row in rows])


def _cells(row: Check, write: Writer) -> dict[str, Any]:
    quantity, ratio = QUANTITIES[row.quantity], row.ratio
    return {
        "title": row.title,
        "demand": write(quantity, row.demand.value),
        "bar": bar_text(row.demand, lambda value: write(quantity, value)),
        "capacity": "–" if row.capacity is None else f"{write(quantity, row.capacity)} ({row.limit})",
        "ratio": "–" if ratio is None else f"{percent(ratio.value)} %",
        "width": f"{min(100.0, 100 * ratio.value) if ratio else 0.0:.1f}",
        "state": "unknown" if ratio is None else row.verdict.word,
        "result": row.result,
        "source": row.source,
    }
