"""The page: controls beside one view at a time; a change anywhere becomes a new screen, and the screen is shown."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import Any
from urllib.parse import parse_qs

import panel as pn
from bokeh.models import CustomJS
from bokeh.models.widgets import TextInput

from ..io.joint_file import JointFile, parse_joint
from .controls import JointControls
from .downloads import Downloads, Seen
from .pressing import pressed
from .screen import ANGLES, LONGEST_LINK, SIZES, START, Screen, link_of, read_link
from .solving import Errand
from .style import asset, html, inputs
from .view import View
from .views.compare import Compare
from .views.design_map import DesignMap
from .views.judge import Judge
from .views.press import Press
from .words import alert

_KINDS: dict[str, type[Press] | type[DesignMap] | type[Compare] | type[Judge]] = {
    "press": Press,
    "map": DesignMap,
    "compare": Compare,
    "judge": Judge,
}
_LOG = logging.getLogger(__name__)


class Page:
    """One user's page.

    Parameters
    ----------
    query : str
        The part of the address after the question mark. What is wrong with it is said on the page.
    """

    def __init__(self, query: str) -> None:
        self._trouble = html()
        self.screen = self._read(query)
        self._views: dict[str, View] = {}
        self._controls = JointControls(lambda file: self.ask(file=file), self.refuse, self._same_load)
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self._view = pn.widgets.RadioButtonGroup(
            label="view", options={kind.title: name for name, kind in _KINDS.items()}, stylesheets=inputs(), **wide
        )
        self._view.param.watch(lambda event: self.ask(view=event.new), "value")
        self._angle = pn.widgets.RadioButtonGroup(label="angles in", options=list(ANGLES), stylesheets=inputs(), **wide)
        self._size = pn.widgets.RadioButtonGroup(label="balls by", options=list(SIZES), stylesheets=inputs(), **wide)
        self._angle.param.watch(lambda event: self.ask(angle=event.new), "value")
        self._size.param.watch(lambda event: self.ask(size=event.new), "value")
        self._downloads = Downloads(self._seen, self.refuse)
        self._link = TextInput(name="link", value=link_of(self.screen), visible=False)
        self._link.js_on_change("value", CustomJS(code="window.ballsocket.linked(cb_obj.value)"))
        self._upload = TextInput(name="upload", value="", visible=False)
        self._upload.on_change("value", lambda attribute, old, new: self._uploaded(new))
        self.main = pn.Column(**wide)
        self.side = pn.Column(
            self._controls.panel, pn.Column(self._angle, self._size, **wide), self._downloads.panel, **wide
        )
        self.head = pn.Column(self._view, self._trouble, pn.pane.Bokeh(self._link), pn.pane.Bokeh(self._upload), **wide)
        self._errand = Errand(self._refresh)
        self._arrange()
        pn.state.onload(self._refresh)  # whoever only looks at the address makes nothing work

    def _read(self, query: str) -> Screen:
        """The screen of a link; the start where it cannot be read."""
        if not query:
            return START
        try:
            if len(query) > 3 * LONGEST_LINK:  # a character may take three in an address
                raise ValueError(f"it is longer than {LONGEST_LINK} characters")
            return read_link(parse_qs(query, keep_blank_values=True))
        except ValueError as error:
            self.refuse(f"This link cannot be read: {error}")
            return START

    def refuse(self, sentence: str) -> None:
        """Say what cannot be done; an empty sentence says nothing."""
        self._trouble.object = alert(sentence) if sentence else ""

    def ask(self, **changes: Any) -> None:
        """Put other things on the screen, and show it."""
        screen = replace(self.screen, **changes)
        if screen == self.screen:
            return
        if len(link_of(screen)) > LONGEST_LINK:
            self.refuse(f"a link to this would be longer than {LONGEST_LINK} characters: shorten the names in the file")
            return
        self.screen = screen
        self.refuse("")
        self._refresh()

    def _arrange(self) -> View:
        """Every input is what is on the screen, and one view is seen."""
        self._controls.put(self.screen)
        self._view.value, self._angle.value, self._size.value = (
            self.screen.view,
            self.screen.angle,
            self.screen.size,
        )
        seen = self.view
        for view in self._views.values():
            view.panel.visible = view is seen
        return seen

    def _refresh(self) -> None:
        with pn.io.hold():
            seen = self._arrange()
            try:
                seen.show(self.screen)
            except Exception as error:  # a page must not fall silent, whatever it is
                _LOG.exception("a view failed")
                self.refuse(f"This cannot be shown: {error}")
            self._link.value = link_of(self.screen)
        self._errand.ask(*seen.asks(self.screen))

    @property
    def view(self) -> View:
        """The one that is seen, made when it is first looked at."""
        name = self.screen.view
        if name not in self._views:
            self._views[name] = _KINDS[name](self.ask, self.screen)
            self.main.append(self._views[name].panel)
        return self._views[name]

    def _seen(self) -> Seen:
        """What is on the screen, for files."""
        return Seen(
            title=self.view.title,
            file=self.screen.file,
            link=self._whole_link(),
            document=lambda: self.view.document(self.screen),
        )

    def _same_load(self, kind: str) -> dict[str, float]:
        """The load of another kind that presses as much as now, by the model on top."""
        found = pressed(self.screen.file, (self.screen.answered_by,))
        contact = found.contacts.get(self.screen.answered_by)
        value = float("nan") if contact is None else float(getattr(contact, kind))
        usual = {"force": 3000.0, "indentation": 0.05, "half_angle": 0.7}
        return {kind: float(f"{value:.6g}") if value > 0 else usual[kind]}

    def _uploaded(self, text: str) -> None:
        """A joint file from the browser, after a line that makes each upload another; by the reader of files."""
        raw = text.partition("\n")[2].encode("utf-8")
        try:
            file: JointFile = parse_joint(raw, "the file")
        except ValueError as error:
            self.refuse(str(error))
            return
        self.ask(file=file if file.load else replace(file, load=self.screen.file.load))

    def _whole_link(self) -> str:
        """The whole address of what is on the screen."""
        location = pn.state.location
        base = (
            "" if location is None else f"{location.protocol}//{location.hostname}:{location.port}{location.pathname}"
        )
        return f"{base}?{link_of(self.screen)}"

    def leave(self) -> None:
        """The page is closed."""
        self._errand.leave()
        for view in self._views.values():
            view.leave()


class Template(pn.Template):
    """Bokeh looks through a document once when all is in it, and not after every part."""

    def server_doc(self, doc: Any = None, title: str | None = None, location: Any = True) -> Any:
        document = doc or pn.state.curdoc
        with document.models.freeze():
            return super().server_doc(document, title, location)

    def __repr__(self) -> str:
        return "<the explorer's page>"  # Panel asks often, and would write all parts down each time


def template(page: Page) -> Any:
    """The page with its style and script, all of it from here."""
    made = Template(asset("page.html"))
    made.add_variable("style", asset("page.css"))
    made.add_variable("script", asset("page.js"))
    made.add_variable("theme", page.screen.theme)
    made.add_panel("head", page.head)
    made.add_panel("side", page.side)
    made.add_panel("main", page.main)
    return made
