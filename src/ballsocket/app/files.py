"""What is on the screen as files: a picture, numbers, a page, a joint file."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from io import StringIO
from typing import Any

from ..core.checks import check_names
from ..files.joint_file import JointFile
from ..files.joint_toml import toml_of
from ..reports.pages import picture
from ..reports.press_report import joint_report
from ..reports.unit_systems import Units
from .view import Document


@dataclass(frozen=True, kw_only=True)
class ScreenContent:
    """What is on the screen: the view's title, the joint, the words of its address, the view as a document, units."""

    title: str
    file: JointFile
    link: str
    document: Document
    units: Units = Units.SI


def made(seen: ScreenContent, kind: str) -> tuple[str, bytes]:
    """A file of that kind, one of `KINDS`: its name, and what is in it.

    Raises
    ------
    ValueError
        There is nothing to put into it, and why.
    """
    check_names([kind], KINDS, "among the files")
    name, make = _KINDS[kind]
    return name, make(seen)


def _picture(seen: ScreenContent, form: str) -> bytes:
    if seen.document.picture is None:
        raise ValueError("there is nothing to draw: no model has an answer")
    return seen.document.picture(form)


def _numbers(seen: ScreenContent) -> bytes:
    stream = StringIO()
    csv.writer(stream, lineterminator="\n").writerows(_safe(row) for row in seen.document.rows())
    return stream.getvalue().encode("utf-8")


def _report(seen: ScreenContent) -> bytes:
    """One page: the joint and its inputs, the figure, the numbers, and the words of the address that lead back."""
    document, joint = seen.document, seen.file.joint
    title = f"{seen.title}: {joint.name or 'a joint'}"
    figure = "" if document.picture is None else picture(document.picture("png"), title)
    lede = f"{document.lede()}<p class='quiet'>In the explorer: <code>{escape(seen.link)}</code></p>"
    sections = {"figure": ("Figure", figure), **document.sections()}
    return joint_report(seen.file, sections, lede, seen.units, contact=document.contact, title=title).encode("utf-8")


def _safe(row: Sequence[Any]) -> list[Any]:
    """Text that a spreadsheet would take for a formula is marked as text."""
    return [f"'{cell}" if isinstance(cell, str) and cell[:1] in ("=", "+", "-", "@") else cell for cell in row]


_KINDS: dict[str, tuple[str, Callable[[ScreenContent], bytes]]] = {
    "PNG": ("ballsocket.png", lambda seen: _picture(seen, "png")),
    "SVG": ("ballsocket.svg", lambda seen: _picture(seen, "svg")),
    "CSV": ("ballsocket.csv", _numbers),
    "HTML": ("ballsocket.html", _report),
    "TOML": ("joint.toml", lambda seen: toml_of(seen.file).encode("utf-8")),
}
KINDS = tuple(_KINDS)
"""Pictures, numbers, a report, a joint file."""
