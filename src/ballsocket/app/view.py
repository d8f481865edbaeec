"""Protocol of a view, and the files that a page saves of it."""

from __future__ import annotations

import csv
from abc import ABC, abstractmethod
from asyncio import TimerHandle
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from html import escape
from io import StringIO
from typing import TYPE_CHECKING, Any, TypeVar

from ..contact import Contact
from ..core.checks import check_names
from ..core.unit_systems import Units
from ..core.validity import OutsideDomainError
from ..files.joint_file import JointFile
from ..files.joint_toml import toml_of
from ..reports.pages import pdf_of, picture
from ..reports.press_report import joint_report
from .jobs import Outcome, call_later, run_in_thread
from .running import Report
from .state.designs import file_stem
from .state.screen import Screen
from .widgets.blocks import Content, content_html
from .widgets.controls import Control, Reader, by_name, fields_of
from .widgets.words import alert

if TYPE_CHECKING:
    from .long_view import LongWork
    from .session import Page

STRESS_PAUSE = 0.4  # seconds without a change until the stress of the model itself is computed for the checks
T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class Document:
    """Content of the screen for a file.

    `picture` draws it as "png" or "svg"; `rows` are a table with its heading first; `sections` are titles and content
    of a page by their id, below `lede`; `contact` is drawn in the section of the joint.
    """

    picture: Callable[[str], bytes] | None = None
    rows: Callable[[], Sequence[Sequence[Any]]]
    sections: Callable[[], Mapping[str, tuple[str, Content]]]
    lede: Callable[[], str] = str
    contact: Contact | None = None


class View(ABC):
    """View of the screen, made with its page when it is first opened.

    `name` is its key in the registry; the ids in its HTML `body` and the names of its inputs begin with it. `actions`
    are the readers of further events, of its buttons and pictures, by their names.
    """

    name = ""
    title = ""
    body = ""

    def __init__(self, page: Page) -> None:
        self.page, self.channel = page, page.channel
        self.actions: dict[str, Reader] = {}
        self.works: list[LongWork] = []
        self._timer: TimerHandle | None = None
        self.begin()

    def begin(self) -> None:  # noqa: B027  some views have nothing more
        """Set up the actions and the work of the view."""

    @abstractmethod
    def show(self, screen: Screen) -> None:
        """Show the results for a screen."""

    def controls(self, screen: Screen) -> Iterable[Control]:
        """Return the inputs of the view, named without the view, in their order in its element "<view>-inputs".

        Those with an element `data-field` of their name are there.
        """
        return ()

    def named_controls(self, screen: Screen) -> dict[str, Control]:
        """Return the inputs of the view by name."""
        return by_name(self.controls(screen), f"{self.name}.")

    def show_inputs(self, screen: Screen) -> None:
        """Show the inputs of the view."""
        self.channel.put_inputs(f"{self.name}-inputs", fields_of(self.named_controls(screen)))

    def put(self, **parts: Content) -> None:
        """Fill elements of the view with blocks or HTML, by their ids without the view."""
        for element, content in parts.items():
            self.channel.put(f"#{self.name}-{element}", content)

    def expect(self, *elements: str) -> None:
        """Mark elements that show an earlier screen until they are filled."""
        self.channel.expect(f"#{self.name}-{element}" for element in elements)

    def later(self, seconds: float, function: Callable[[], None]) -> None:
        """Call a function later, in place of the last one that still waits; at once without a browser."""
        self._stop_timer()
        self._timer = call_later(seconds, partial(self.page.attempt, function))
        if self._timer is None:
            self.page.attempt(function)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()

    def compute(self, work: Callable[[], T], show: Callable[[T], None]) -> None:
        """Run some work in a thread and show its result, unless the screen has changed."""
        screen = self.page.screen

        def finish(outcome: Outcome) -> None:
            if screen is self.page.screen:
                self.page.attempt(partial(self._show_outcome, outcome, show))

        run_in_thread(lambda: work() if screen is self.page.screen else None, finish)

    def _show_outcome(self, outcome: Outcome, show: Callable[[T], None]) -> None:
        try:
            result = outcome.result()
        except (ValueError, OutsideDomainError) as error:
            self.channel.forget_expected()
            self.fail(str(error))
        else:
            show(result)

    def fail(self, why: str) -> None:
        """Show why a computation has no result."""
        self.put(trouble=alert(why))

    @abstractmethod
    def document(self, screen: Screen) -> Document:
        """Return the content of the screen for a file."""

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        """List the joints and models to press, in the order in which they are needed."""
        return [], ()

    def add(self, work: LongWork) -> LongWork:
        """Let the view have some long work with its button."""
        self.works.append(work)
        self.actions[f"{work.name}.run"] = work.click
        return work

    @property
    def mark(self) -> str:
        """State of the work of the view for its button: "runs", "done" since it was last shown, or empty."""
        return "runs" if any(work.runs for work in self.works) else "done" * any(work.unseen for work in self.works)

    def clear_mark(self) -> None:
        """Forget the mark "done", since the view is open."""
        for work in self.works:
            work.unseen = False

    def leave(self) -> None:
        """Stop all work of a closed page."""
        self._stop_timer()
        for work in self.works:
            work.leave()


@dataclass(frozen=True, kw_only=True)
class ScreenContent:
    """Title of the view, joint, link, document, units and the address of the logo on the screen."""

    title: str
    file: JointFile
    link: str
    document: Document
    units: Units = Units.SI
    logo: str = ""


def make_file(content: ScreenContent, kind: str) -> tuple[str, bytes]:
    """Make a file of a kind in `FILE_KINDS`: its name and content."""
    check_names([kind], FILE_KINDS, "among the files")
    return f"{file_stem(content.file.joint.name)}.{kind.lower()}", _FILE_WRITERS[kind](content)


def _picture(content: ScreenContent, form: str) -> bytes:
    if content.document.picture is None:
        raise ValueError("there is nothing to draw: no model has a result")
    return content.document.picture(form)


def _numbers(content: ScreenContent) -> bytes:
    """Write the table as CSV; text that a spreadsheet would take for a formula is marked."""
    stream = StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    for row in content.document.rows():
        writer.writerow(f"'{cell}" if isinstance(cell, str) and cell[:1] in tuple("=+-@") else cell for cell in row)
    return stream.getvalue().encode("utf-8")


def _report(content: ScreenContent) -> bytes:
    """Write one page with joint, inputs, figure, numbers and the link to the explorer."""
    document, joint = content.document, content.file.joint
    title = f"{content.title}: {joint.name or 'a joint'}"
    figure = "" if document.picture is None else picture(document.picture("png"), title)
    lede = f"{document.lede()}<p class='quiet'>In the explorer: <code>{escape(content.link)}</code></p>"
    written = {name: (head, content_html(content)) for name, (head, content) in document.sections().items()}
    sections = {**({"figure": ("Figure", figure)} if figure else {}), **written}
    page = joint_report(
        content.file, sections, lede, content.units, contact=document.contact, title=title, logo=content.logo
    )
    return page.encode("utf-8")


def print_page(page: str, paper: str, report: Report) -> bytes:
    """Print a report as PDF, in a separate process with limits of time and memory."""
    return pdf_of(page, paper)


_FILE_WRITERS: dict[str, Callable[[ScreenContent], bytes]] = {
    "PNG": lambda content: _picture(content, "png"),
    "SVG": lambda content: _picture(content, "svg"),
    "CSV": _numbers,
    "HTML": _report,
    "PDF": _report,  # printed by `print_page`
    "TOML": lambda content: toml_of(content.file).encode("utf-8"),
}
FILE_KINDS = tuple(_FILE_WRITERS)  # pictures, numbers, a report, a joint file
