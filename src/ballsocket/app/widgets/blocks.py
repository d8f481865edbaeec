"""Blocks of an answer as plain data, which the page renders by a script and reports by a template."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ...core.answers import Check, Table, grid
from ...core.unit_systems import Units
from ...reports.pages import check_cells, render_part
from ...reports.style import INK, THICK, LineStyle
from .reading import Reading

Block = dict[str, Any]  # its kind, and the arguments of the macro and of the function of that name
Content = str | list[Any]  # HTML, or blocks and pieces of HTML
Cell = str | list[Any]  # text, or a list of it, a remark below it, and a style


def sentence(text: str, style: str = "quiet") -> Block:
    """Return a sentence in a style of the page: by default grey."""
    return {"kind": "sentence", "text": text, "style": style}


def notes_list(notes: Iterable[str], reading: Reading) -> Block:
    """List the notes of a model."""
    return {"kind": "items", "texts": [reading.units.sentence(note) for note in notes], "style": "notes"}


def checks_table(rows: Iterable[Check], reading: Reading) -> Block:
    """Tabulate checks with their texts and the length of their bars."""
    return {"kind": "checks", "rows": [check_cells(row, reading.with_unit) for row in rows]}


def table(heads: Sequence[Cell], rows: Iterable[Any], style: str = "") -> Block:
    """Return a table of rows, each a list of cells or a `styled_row`.

    `style` is "text" or "words" for sentences, which begin at the left.
    """
    return {"kind": "table", "heads": list(heads), "rows": list(rows), "style": style}


def styled_row(cells: Sequence[Cell], style: str = "", line: LineStyle | None = None) -> dict[str, Any]:
    """Return a row whose first cell is its head, behind a piece of a line; the last cell reaches to the end."""
    return {"style": style, "line": line and plain_line(line), "cells": list(cells)}


def answer_blocks(part: Table, units: Units) -> list[Block]:
    """Return the sentences of a described table, and the table."""
    written = grid(part, units)
    lines = [sentence(units.sentence(line), "") for line in part.lines]
    return [*lines, table(written.heads_with_units, written.rows)] if written.rows else lines


def numbers(rows: Iterable[Sequence[Any]], style: str = "tiles") -> Block:
    """Return numbers in the rows of `number_cell`."""
    return {"kind": "numbers", "rows": [list(row) for row in rows], "style": style}


def plain_line(line: LineStyle) -> list[str]:
    """Return the CSS colour of a line, where ink follows the theme, and its dashes in pixels: empty if solid."""
    colour = "var(--text)" if line.colour == INK else line.colour
    return [colour, " ".join(f"{THICK * length:g}" for length in line.dash)]


def content_html(content: Content) -> str:
    """Render sentences, lists, checks and tables as HTML for a report."""
    if isinstance(content, str):
        return content
    return "".join(part if isinstance(part, str) else render_part("parts.html", **part) for part in content)
