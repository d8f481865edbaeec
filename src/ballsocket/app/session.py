"""Page of one user: its screen, its inputs and its HTML."""

from __future__ import annotations

import json
import logging
from base64 import b64encode
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from html import escape
from typing import Any
from urllib.parse import parse_qs

import panel as pn
from markupsafe import Markup

from ..core.checks import check_names
from ..files.joint_file import parse_joint
from ..reports.unit_systems import Units
from .channel import Channel
from .jobs import run_in_thread
from .pressing import pressed
from .solving import Errand
from .state.screen import ANGLES, LONGEST_LINK, SIZES, START, Screen, link_of, read_link
from .style import asset
from .view import FILE_KINDS, ScreenContent, View, make_file
from .views.registry import KINDS
from .widgets.fields import Field, segments
from .widgets.joint_fields import behind, edited, fields_of, layer_fields, layers_edited
from .widgets.words import alert

_LOG = logging.getLogger(__name__)
_LARGEST = 100_000  # characters of a joint file
_CHOSEN = ("view", "answered_by", "shown", "painted", "angle", "size", "units")
"""Fields of the screen that the page's own inputs change."""

_UNITS = ((Units.SI.value, "mm, N, MPa"), (Units.IMPERIAL.value, "in, lbf, psi"))


class Page:
    """Page of one user, for the query of its address; errors in the query are shown on the page."""

    def __init__(self, query: str) -> None:
        self.channel = Channel(self._handle_request)
        self.screen = self._read(query)
        self._views: dict[str, View] = {}
        self._handlers: dict[str, Callable[[str, Any], None]] = {"behind": self._layered}
        self.main = pn.Column(sizing_mode="stretch_width")
        self._errand = Errand(self._refresh)
        pn.state.onload(self._refresh)  # a client that never connects causes no work

    def _read(self, query: str) -> Screen:
        """Read the screen of a link; return the start if it is invalid."""
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
        """Show why a request failed; an empty sentence clears the message."""
        self.channel.put("#trouble", alert(sentence) if sentence else "")

    def ask(self, **changes: Any) -> None:
        """Change the screen and show it."""
        screen = replace(self.screen, **changes)
        if screen == self.screen:
            return
        if len(link_of(screen)) > LONGEST_LINK:
            self.refuse(f"a link to this would be longer than {LONGEST_LINK} characters: shorten the names in the file")
            return
        self.screen = screen
        self.refuse("")
        self._refresh()

    def _handle_request(self, event: str, words: Mapping[str, Any]) -> None:
        """Handle a request of the browser; show why it failed, and reset the inputs."""
        doings = {"edit": self._edit, "choose": self._choose, "save": self._save, "upload": self._upload}
        try:
            check_names([event], doings, "among what a page does")
            doings[event](words)
        except ValueError as error:
            self.refuse(str(error))
            self.channel.once("reset", True)

    def listen(self, view: str, handler: Callable[[str, Any], None]) -> None:
        """Register the handler of a view's inputs, whose names start with the view and a dot."""
        self._handlers[view] = handler

    def _edit(self, words: Mapping[str, Any]) -> None:
        view, _, key = str(words.get("name")).partition(".")
        if key:
            check_names([view], self._handlers, "among the views that have inputs")
            self.refuse("")
            self._handlers[view](key, words.get("value"))
            return
        file = edited(self.screen, str(words.get("name")), words.get("value"), self._same_load)
        self.refuse("")
        self.ask(file=file)

    def _layered(self, key: str, value: Any) -> None:
        self.ask(file=layers_edited(self.screen.file, key, value))

    def _choose(self, words: Mapping[str, Any]) -> None:
        name, value = str(words.get("name")), words.get("value")
        check_names([name], _CHOSEN, "among the choices")
        wanted = tuple(value) if isinstance(value, list) else value
        if not isinstance(wanted, tuple if name == "shown" else str) or not all(
            isinstance(item, str) for item in wanted
        ):
            raise ValueError(f"{name} takes words")
        self.ask(**{name: wanted})

    def _save(self, words: Mapping[str, Any]) -> None:
        """Make a file in a thread, or show why it cannot be made."""
        kind, seen = str(words.get("kind")), self.seen()
        run_in_thread(partial(make_file, seen, kind), self._saved)

    def _saved(self, outcome: Future[tuple[str, bytes]]) -> None:
        try:
            name, content = outcome.result()
        except ValueError as error:
            self.refuse(str(error))
        except Exception as error:
            _LOG.exception("a file failed")
            self.refuse(f"This cannot be saved: {error}")
        else:
            self.channel.once("file", {"name": name, "content": b64encode(content).decode("ascii")})
        self.channel.send()

    def _upload(self, words: Mapping[str, Any]) -> None:
        """Read a joint file from the browser."""
        text = str(words.get("text"))
        if len(text) > _LARGEST:
            raise ValueError(f"the file is longer than {_LARGEST} characters; a joint file is a few lines")
        file = parse_joint(text.encode("utf-8"), "the file")
        self.ask(file=file if file.load else replace(file, load=self.screen.file.load))

    def start(self) -> dict[str, Any]:
        """Return the initial content of the page: inputs, and errors of its link."""
        self._put()
        return self.channel.take_pending()

    def fields(self) -> dict[str, Field]:
        """Return every input beside the views by name."""
        angles = segments("angle", "angles in", [(option, option) for option in ANGLES], self.screen.angle)
        sizes = segments("size", "balls by", [(option, option) for option in SIZES], self.screen.size)
        units = segments("units", "units", _UNITS, self.screen.units)
        joint = {**fields_of(self.screen), **layer_fields(self.screen.file.joint)}
        return {**joint, "units": units, "size": sizes, "angle": angles}

    def _refresh(self) -> None:
        with pn.io.hold():
            seen = self.view
            for view in self._views.values():
                if view.panel is not None:
                    view.panel.visible = view is seen
            self._put()
            try:
                seen.show(self.screen)
            except Exception as error:  # the page must report every failure
                _LOG.exception("a view failed")
                self.refuse(f"This cannot be shown: {error}")
        self.channel.send()
        self._errand.ask(*seen.asks(self.screen))

    def _put(self) -> None:
        """Set every input to the state of the screen."""
        fields = self.fields()
        self.channel.put_fields(fields)
        self.channel.put("order", list(fields))
        self.channel.put("#behind", behind(self.screen.file.joint))
        self.channel.put("view", self.screen.view)
        self.channel.put("link", link_of(self.screen))

    @property
    def view(self) -> View:
        """View that is open, made when it is first opened."""
        name = self.screen.view
        if name not in self._views:
            self._views[name] = KINDS[name](self)
            if self._views[name].panel is not None:
                self.main.append(self._views[name].panel)
        return self._views[name]

    def seen(self) -> ScreenContent:
        """Return the content of the screen for files."""
        return ScreenContent(
            title=self.view.title,
            file=self.screen.file,
            link=f"?{link_of(self.screen)}",
            document=self.view.document(self.screen),
            units=self.screen.reading.units,
        )

    def _same_load(self, kind: str) -> dict[str, float]:
        """Return a load of another kind that presses equally, by the model on top."""
        comparison = pressed(self.screen.file, (self.screen.answered_by,))
        contact = comparison.contacts.get(self.screen.answered_by)
        value = float("nan") if contact is None else float(getattr(contact, kind))
        defaults = {"force": 3000.0, "indentation": 0.05, "half_angle": 0.7}
        return {kind: float(f"{value:.6g}") if value > 0 else defaults[kind]}

    def leave(self) -> None:
        """Stop all work of a closed page."""
        self._errand.leave()
        for view in self._views.values():
            view.leave()


_SCRIPTS = ("fields.js", "page.js", "charts.js", "drag.js", "bowl.js", "player.js", "views.js")


class Template(pn.Template):
    """Bokeh looks through a document once when all is in it, and not after every part."""

    def server_doc(self, doc: Any = None, title: str | None = None, location: Any = True) -> Any:
        document = doc or pn.state.curdoc
        with document.models.freeze():
            return super().server_doc(document, title, location)

    def __repr__(self) -> str:
        return "<the explorer's page>"  # short, because Panel formats it often


def template(page: Page) -> Any:
    """Return the HTML of the page before its first result, with disabled inputs."""
    html_page = Template(asset("page.html"))
    html_page.add_variable(
        "style", asset("parts.css").replace(":host {", ".app {") + asset("page.css") + asset("views.css")
    )
    html_page.add_variable("script", "\n".join(asset(name) for name in _SCRIPTS))
    html_page.add_variable("theme", page.screen.theme)
    html_page.add_variable("views", _buttons({name: kind.title for name, kind in KINDS.items()}, "view"))
    html_page.add_variable("sections", _sections())
    html_page.add_variable("files", _buttons({kind: kind for kind in FILE_KINDS}, "file"))
    html_page.add_variable("start", _script_json(json.dumps(page.start())))
    html_page.add_panel("inbox", pn.pane.Bokeh(page.channel.inbox))
    html_page.add_panel("outbox", pn.pane.Bokeh(page.channel.outbox))
    html_page.add_panel("main", page.main)
    return html_page


def _buttons(words: dict[str, str], kind: str) -> Markup:
    return Markup(
        "".join(
            f'<button type="button" data-{kind}="{escape(name)}">{escape(label)}</button>'
            for name, label in words.items()
        )
    )


def _sections() -> Markup:
    """Return the sections of the views that the page itself shows."""
    bodies = {name: (kind.title, kind.body) for name, kind in KINDS.items() if kind.body}
    return Markup(
        "".join(
            f'<section class="view" data-view="{name}" aria-label="{title}" hidden>{body}</section>'
            for name, (title, body) in bodies.items()
        )
    )


def _script_json(text: str) -> Markup:
    """JSON inside a script: no end of it can be written in a name."""
    return Markup(text.replace("<", "\\u003c"))
