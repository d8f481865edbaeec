"""Press: one joint under one load; every model beside the exact answer."""

from __future__ import annotations

import time
from html import escape
from typing import Any

import panel as pn

from ...catalogue import catalogue
from ...compare import Comparison, answered
from ...io.joint_file import JointFile
from ...output import html as page
from ...output.press_plot import press_figure
from ...output.press_report import press_lede, press_sections
from ...output.style import line_of
from ...studies.around import Around, around
from ..chart import swatch
from ..drawing import section
from ..fields import choice, several
from ..press_charts import press_charts
from ..pressing import fine_curves, pressed
from ..screen import Screen
from ..view import Document, Host
from ..words import headline, models_table, number_rows

_EVERY = tuple(catalogue)
_PATIENCE = 300  # ms until the table of all models follows
_LATE, _WAITS = 0.05, 10  # s: a server that comes so late has others to answer first; how often it may


class Press:
    """Numbers, drawing and curves at once; the table of all models when the slider rests."""

    title = "Press"
    panel = None

    def __init__(self, page: Host) -> None:
        self._channel = page.channel
        self._later: Any = None

    def show(self, screen: Screen) -> None:
        names = tuple(dict.fromkeys((screen.answered_by, *screen.shown)))
        found = pressed(screen.file, names)
        by = found.contacts.get(screen.answered_by)
        if by is None:
            numbers = f"<p class='trust no'>✗ {escape(found.missing[screen.answered_by])}</p>"
        else:
            numbers = headline(by, screen.angle)
        drawn = {name: found[name] for name in screen.shown if name in answered(found)}
        lines = {name: line_of(name) for name in drawn}
        self._channel.put("#press-numbers", numbers)
        self._channel.put("#press-section", section(screen.file, None if by is None or by.status.failed else by))
        self._channel.put("#press-charts", press_charts(drawn, lines, screen.angle))
        self._channel.put_fields(_fields(screen))
        self._fill_later(screen)

    def _fill_later(self, screen: Screen, waits: int = _WAITS) -> None:
        """The table of all models follows when nothing has moved for a while, and others need not wait for it."""
        document = pn.state.curdoc
        if document is None:
            self._fill(screen)
            return
        if self._later is not None:
            document.remove_timeout_callback(self._later)
        due = time.monotonic() + _PATIENCE / 1e3
        self._later = document.add_timeout_callback(lambda: self._due(screen, due, waits), _PATIENCE)

    def _due(self, screen: Screen, due: float, waits: int) -> None:
        self._later = None
        if waits and time.monotonic() - due > _LATE:
            self._fill_later(screen, waits - 1)
            return
        self._fill(screen)
        self._channel.send()

    def _fill(self, screen: Screen) -> None:
        self._channel.put("#press-table", models_table(pressed(screen.file, _EVERY), screen.angle))

    def document(self, screen: Screen) -> Document:
        found = pressed(screen.file, _EVERY)
        by = found.contacts.get(screen.answered_by)
        drawn = {name: found[name] for name in screen.shown if name in answered(found)}
        return Document(
            picture=(lambda form: page.drawn(press_figure(drawn, fine_curves(drawn, catalogue)), form))
            if drawn
            else None,
            rows=lambda: _rows(found),
            sections=lambda: press_sections(found, surroundings=_around(screen.file)),
            lede=lambda: "" if by is None else press_lede(by),
            contact=by,
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        first = (screen.answered_by, *screen.shown)
        return [screen.file], tuple(dict.fromkeys((*first, *_EVERY)))

    def leave(self) -> None:
        """Nothing runs on."""


def _fields(screen: Screen) -> dict[str, Any]:
    names = [(name, name) for name in _EVERY]
    pieces = {name: swatch(line_of(name)) for name in _EVERY}
    return {
        "answered_by": choice("answered_by", "Answered by", names, screen.answered_by),
        "shown": several("shown", "Curves of", names, screen.shown, pieces),
    }


def _rows(found: Comparison) -> list[list[Any]]:
    """With why a model is not to be trusted."""
    heads, *rows = number_rows("model", found)
    return [[*heads, "notes"], *([*row, "; ".join(found[row[0]].notes)] for row in rows)]


def _around(file: JointFile) -> Around | None:
    """What a percent of each number does; without a load nothing."""
    pressing = any(float(load) > 0 for load in file.load.values())
    return around(file.joint, file.cup, file.load, {}) if pressing else None
