"""Protocol of a view, and the files that a page saves of it."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from io import StringIO
from typing import Any, Protocol

from ..contact import Contact
from ..core.checks import check_names
from ..files.joint_file import JointFile
from ..files.joint_toml import toml_of
from ..reports.pages import picture
from ..reports.press_report import joint_report
from ..reports.unit_systems import Units
from .channel import Channel
from .state.screen import Screen


@dataclass(frozen=True, kw_only=True)
class Document:
    """Content of the screen for a file.

    `picture` draws it as "png" or "svg"; `rows` are a table with its heading first; `sections` are titles and HTML of a
    page by their id, below `lede`; `contact` is drawn in the section of the joint.
    """

    picture: Callable[[str], bytes] | None = None
    rows: Callable[[], Sequence[Sequence[Any]]]
    sections: Callable[[], Mapping[str, tuple[str, str]]]
    lede: Callable[[], str] = str
    contact: Contact | None = None


class Host(Protocol):
    """Interface of the page for a view."""

    channel: Channel
    screen: Screen

    def ask(self, **changes: Any) -> None:
        """Change fields of the screen by name."""
        ...

    def listen(self, view: str, handler: Callable[[str, Any], None]) -> None:
        """Register the handler of a view's inputs, whose names start with the view and a dot."""
        ...


class View:
    """View of the screen, made with its page when it is first opened.

    `body` is HTML of the page that `Host.channel` fills; `panel` holds the parts of a view that Panel makes.
    """

    title = ""
    body = ""
    panel: Any = None

    def __init__(self, page: Host) -> None:
        raise NotImplementedError

    def show(self, screen: Screen) -> None:
        """Show the results for a screen."""
        raise NotImplementedError

    def document(self, screen: Screen) -> Document:
        """Return the content of the screen for a file."""
        raise NotImplementedError

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        """List the joints and models to press, in the order in which they are needed."""
        return [], ()

    def leave(self) -> None:
        """Stop all work of a closed page."""


@dataclass(frozen=True, kw_only=True)
class ScreenContent:
    """Title of the view, joint, link, document and units on the screen."""

    title: str
    file: JointFile
    link: str
    document: Document
    units: Units = Units.SI


def make_file(content: ScreenContent, kind: str) -> tuple[str, bytes]:
    """Make a file of a kind in `FILE_KINDS`: its name and content."""
    check_names([kind], FILE_KINDS, "among the files")
    name, make = _FILE_WRITERS[kind]
    return name, make(content)


def _picture(content: ScreenContent, form: str) -> bytes:
    if content.document.picture is None:
        raise ValueError("there is nothing to draw: no model has an answer")
    return content.document.picture(form)


def _numbers(content: ScreenContent) -> bytes:
    stream = StringIO()
    csv.writer(stream, lineterminator="\n").writerows(_without_formulas(row) for row in content.document.rows())
    return stream.getvalue().encode("utf-8")


def _report(content: ScreenContent) -> bytes:
    """Write one page with joint, inputs, figure, numbers and the link to the explorer."""
    document, joint = content.document, content.file.joint
    title = f"{content.title}: {joint.name or 'a joint'}"
    figure = "" if document.picture is None else picture(document.picture("png"), title)
    lede = f"{document.lede()}<p class='quiet'>In the explorer: <code>{escape(content.link)}</code></p>"
    sections = {"figure": ("Figure", figure), **document.sections()}
    return joint_report(content.file, sections, lede, content.units, contact=document.contact, title=title).encode(
        "utf-8"
    )


def _without_formulas(row: Sequence[Any]) -> list[Any]:
    """Text that a spreadsheet would take for a formula is marked as text."""
    return [f"'{cell}" if isinstance(cell, str) and cell[:1] in ("=", "+", "-", "@") else cell for cell in row]


_FILE_WRITERS: dict[str, tuple[str, Callable[[ScreenContent], bytes]]] = {
    "PNG": ("ballsocket.png", lambda content: _picture(content, "png")),
    "SVG": ("ballsocket.svg", lambda content: _picture(content, "svg")),
    "CSV": ("ballsocket.csv", _numbers),
    "HTML": ("ballsocket.html", _report),
    "TOML": ("joint.toml", lambda content: toml_of(content.file).encode("utf-8")),
}
FILE_KINDS = tuple(_FILE_WRITERS)
"""Pictures, numbers, a report, a joint file."""
