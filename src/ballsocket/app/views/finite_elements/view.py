"""Judge: the joint on the screen by finite elements, with its rim and support, beside the exact answer."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from html import escape
from math import degrees
from typing import Any

import panel as pn

from ....compare import relative_deviation
from ....core.quantities import CONTACT, CUP
from ....files.joint_file import JointFile, read_cup
from ....files.joint_toml import cup_table
from ....problem.cup import Interface
from ....reports.pages import picture, table
from ...running import LONGEST, Reached, Run, RunFinished, RunRefused, looked_at
from ...state.screen import Screen
from ...style import html, inputs
from ...view import Document, Host, View
from ...widgets.reading import number_text
from ...widgets.words import alert, notes_list, percent
from .worker import Judged, judged

_EVERY = 150  # ms between two questions for news


class Judge(View):
    """View that runs finite elements on request and notes if the joint has changed since."""

    title = "Judge"

    def __init__(self, page: Host) -> None:
        self._ask, self._screen, self._putting = page.ask, page.screen, False
        self._run: Run | None = None
        self._asked = page.screen.file
        self._asking: Any = None
        self._found: tuple[JointFile, Judged] | None = None
        self._go = pn.widgets.Button(label="Run finite elements", color="primary", width=180)
        self._halt = pn.widgets.Button(label="Stop", width=90, disabled=True)
        self._bar = pn.indicators.Progress(value=0, max=100, width=220, visible=False)
        self._arc = pn.widgets.FloatInput(
            label=CUP["arc_of_cover"].input_label(), step=5, width=140, stylesheets=inputs()
        )
        self._chamfer = pn.widgets.FloatInput(
            label=CUP["chamfer"].input_label(), step=0.5, width=120, stylesheets=inputs()
        )
        self._interface = pn.widgets.Select(
            label="Liner on its backing",
            options=[interface.value for interface in Interface],
            width=160,
            stylesheets=inputs(),
        )
        self._trouble, self._said, self._numbers, self._picture = html(), html(), html(), html()
        self._go.on_click(lambda event: self._begin())
        self._halt.on_click(lambda event: self._stopped())
        for widget, key in ((self._arc, "arc_of_cover"), (self._chamfer, "chamfer"), (self._interface, "interface")):
            widget.param.watch(lambda event, key=key: self._cup(key, event.new), "value")
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self.panel = pn.Column(
            pn.FlexBox(self._arc, self._chamfer, self._interface, align_items="end", gap="12px", **wide),
            pn.FlexBox(self._go, self._halt, self._bar, align_items="center", gap="12px", **wide),
            self._trouble,
            self._said,
            self._numbers,
            self._picture,
            **wide,
        )
        self._put(page.screen)  # before the page is shown, so that typed values are not overwritten

    def show(self, screen: Screen) -> None:
        if screen != self._screen:  # a refusal remains until the screen changes
            self._refuse("")
        self._screen = screen
        self._put(screen)
        if self._run is None:
            self._say(self._state())
        if self._found is not None:
            self._numbers.object = _numbers(self._found[1], screen)

    def _put(self, screen: Screen) -> None:
        """Set the cup's inputs without triggering their handlers."""
        self._putting, cup = True, screen.file.cup
        self._arc.value, self._chamfer.value = round(degrees(cup.arc_of_cover), 9), cup.chamfer
        self._interface.value = cup.interface.value
        self._putting = False

    def _state(self) -> str:
        if self._found is None:
            return f"Nothing has run yet. A run takes a second or two, at most {LONGEST:g} s."
        if self._found[0] != self._screen.file:
            return "The joint has changed since this run."
        return ""

    def _say(self, words: str) -> None:
        self._said.object = f"<p class='quiet' role='status'>{escape(words)}</p>" if words else ""

    def _refuse(self, why: str) -> None:
        self._trouble.object = alert(why) if why else ""

    def _cup(self, key: str, value: Any) -> None:
        if self._putting:
            return
        try:
            cup = read_cup({**cup_table(self._screen.file.cup), key: value})
        except ValueError as error:
            self._put(self._screen)
            self._refuse(str(error))
            return
        self._ask(file=replace(self._screen.file, cup=cup))

    def _begin(self) -> None:
        if self._run is not None:
            return
        self._refuse("")
        self._asked = self._screen.file
        self._run = Run(partial(judged, self._asked))
        self._go.disabled, self._halt.disabled = True, False
        self._bar.visible, self._bar.value = True, 0
        self._asking = pn.state.add_periodic_callback(self._hear, period=_EVERY)

    def _hear(self) -> None:
        if self._run is None:
            return
        if not looked_at():
            self._ended()
            return
        news = self._run.news()
        if isinstance(news, Reached):
            self._bar.value = int(100 * news.share)
            self._say(news.words)
        elif isinstance(news, RunRefused):
            self._ended()
            self._say("")
            self._refuse(news.why)
        elif isinstance(news, RunFinished):
            self._found = (self._asked, news.value)
            self._ended()
            self._numbers.object = _numbers(news.value, self._screen)
            self._picture.object = picture(news.value.png, "mesh, von Mises stress, and pressure beside the exact one")
            self._say(self._state())

    def _stopped(self) -> None:
        self._ended()
        self._say("Stopped.")

    def _ended(self) -> None:
        if self._asking is not None:
            self._asking.stop()
        if self._run is not None:
            self._run.stop()
        self._run = self._asking = None
        self._go.disabled, self._halt.disabled, self._bar.visible = False, True, False

    def document(self, screen: Screen) -> Document:
        if self._found is None:
            raise ValueError("nothing has run yet: run the finite elements first")
        _, judged = self._found
        heads = ["quantity", "finite elements", "error of the mesh", "exact"]
        rows = [
            [name, judged.numbers[name], judged.error.get(quantity.name, ""), (judged.exact or {}).get(name, "")]
            for name, quantity in ((item.key, item) for item in CONTACT.values())
            if isinstance(judged.numbers[name], float)
        ]
        body = table(heads, [[str(cell) for cell in row] for row in rows])
        shown = picture(judged.png, "mesh, von Mises stress, and pressure beside the exact one")
        return Document(
            picture=lambda form: judged.svg if form == "svg" else judged.png,
            rows=lambda: [heads, *rows],
            sections=lambda: {"judge": ("Finite elements", body + shown)},
        )

    def leave(self) -> None:
        self._ended()


def _numbers(judged: Judged, screen: Screen) -> str:
    """Tabulate the numbers with mesh errors beside the exact ones."""
    rows = []
    for column in screen.reading.columns:
        factor = column.factor / column.quantity.written.factor  # the numbers are those of JSON
        value = judged.numbers[column.name] * factor
        bar = judged.error.get(column.attribute)
        row = [column.label, number_text(value), f"± {percent(bar)}" if bar else "–"]
        if judged.exact is None:
            row += ["–", "–"]
        else:
            exact = judged.exact[column.name] * factor
            row += [number_text(exact), percent(float(relative_deviation(value, exact)), "+")]
        rows.append(row)
    heads = ["", "finite elements", "error of the mesh", "exact, a whole shell", "difference"]
    return (
        f"{table(heads, rows)}<p class='quiet'>{judged.elements} elements, {judged.seconds:.2g} s."
        f"</p>{notes_list(judged.notes)}"
    )
