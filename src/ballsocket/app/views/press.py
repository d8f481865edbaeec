"""Press: one joint under one load; every model beside the exact answer."""

from __future__ import annotations

from html import escape
from typing import Any

import panel as pn

from ...catalogue import catalogue
from ...compare import HEADS, Comparison, answered
from ...io.joint_file import JointFile
from ...output import html as page
from ...output.press_plot import press_figure
from ...output.style import line_of
from ..drawing import SectionDrawing
from ..look import PALETTES
from ..press_charts import PressCharts
from ..pressing import fine_curves, pressed
from ..screen import Screen
from ..style import html, inputs
from ..view import Ask, Document
from ..words import headline, models_table, number_rows

_EVERY = tuple(catalogue)
_WRAPPED = ".bk-input-group.bk-inline { flex-wrap: wrap; gap: 2px 14px; }"
_PATIENCE = 300  # ms until the table of all models follows


class Press:
    """Numbers, drawing and curves at once; the table of all models when the slider rests."""

    title = "Press"

    def __init__(self, ask: Ask, screen: Screen) -> None:
        self._palette = PALETTES[screen.theme]
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self._by = pn.widgets.Select(
            label="Answered by", options=list(_EVERY), value=screen.answered_by, width=220, stylesheets=inputs()
        )
        self._shown = pn.widgets.CheckBoxGroup(
            label="drawn", options=list(_EVERY), value=list(screen.shown), inline=True, stylesheets=[_WRAPPED], **wide
        )
        self._by.param.watch(lambda event: ask(answered_by=event.new), "value")
        self._shown.param.watch(lambda event: ask(shown=tuple(event.new)), "value")
        self._numbers, self._table = html(), html()
        self._drawing = SectionDrawing(self._palette)
        self._charts = PressCharts(self._palette)
        self.panel = pn.Column(
            self._by,
            self._numbers,
            pn.FlexBox(
                *(
                    pn.Column(pn.pane.Bokeh(chart, **wide), min_width=280, styles={"flex": "1 1 280px"})
                    for chart in (self._drawing.figure, *self._charts.figures)
                ),
                gap="8px",
                **wide,
            ),
            html("<span class='label'>Drawn beside it:</span>"),
            self._shown,
            self._table,
            **wide,
        )
        self._later: Any = None

    def show(self, screen: Screen) -> None:
        names = tuple(dict.fromkeys((screen.answered_by, *screen.shown)))
        found = pressed(screen.file, names)
        by = found.contacts.get(screen.answered_by)
        if by is None:
            self._numbers.object = f"<p class='trust no'>✗ {escape(found.missing[screen.answered_by])}</p>"
        else:
            self._numbers.object = headline(by, screen.angle)
        self._drawing.show(screen.file, None if by is None or by.status.failed else by)
        drawn = {name: found[name] for name in screen.shown if name in answered(found)}
        self._charts.show(drawn, {name: line_of(name) for name in drawn}, screen.angle)
        self._fill_later(screen)

    def _fill_later(self, screen: Screen) -> None:
        """The table of all models follows when nothing has moved for a while."""
        document = pn.state.curdoc
        if document is None:
            self._fill(screen)
            return
        if self._later is not None:
            document.remove_timeout_callback(self._later)
        self._later = document.add_timeout_callback(lambda: self._fill(screen), _PATIENCE)

    def _fill(self, screen: Screen) -> None:
        self._later = None
        self._table.object = models_table(pressed(screen.file, _EVERY), self._palette, screen.angle)

    def document(self, screen: Screen) -> Document:
        found = pressed(screen.file, _EVERY)
        drawn = {name: found[name] for name in screen.shown if name in answered(found)}
        return Document(
            picture=(lambda form: page.drawn(press_figure(drawn, fine_curves(drawn, catalogue)), form))
            if drawn
            else None,
            rows=lambda: _rows(found),
            sections=lambda: {"models": ("Every model", page.table(HEADS, found.rows()) + _notes(found))},
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        first = (screen.answered_by, *screen.shown)
        return [screen.file], tuple(dict.fromkeys((*first, *_EVERY)))

    def leave(self) -> None:
        """Nothing runs on."""


def _rows(found: Comparison) -> list[list[Any]]:
    """With why a model is not to be trusted."""
    heads, *rows = number_rows("model", found)
    return [[*heads, "notes"], *([*row, "; ".join(found[row[0]].notes)] for row in rows)]


def _notes(found: Comparison) -> str:
    return "".join(f"<p class='quiet'>{escape(note)}</p>" for note in found.notes())
