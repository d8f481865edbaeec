"""The page as HTML, with its style and script, all of it from here."""

from __future__ import annotations

import json
from html import escape
from typing import Any

import panel as pn
from markupsafe import Markup

from .files import KINDS as FILES
from .page import Page
from .style import asset
from .views import KINDS as VIEWS

_SCRIPTS = ("fields.js", "page.js", "charts.js", "drag.js", "bowl.js", "player.js", "views.js")


class Template(pn.Template):
    """Bokeh looks through a document once when all is in it, and not after every part."""

    def server_doc(self, doc: Any = None, title: str | None = None, location: Any = True) -> Any:
        document = doc or pn.state.curdoc
        with document.models.freeze():
            return super().server_doc(document, title, location)

    def __repr__(self) -> str:
        return "<the explorer's page>"  # Panel asks often, and would write all parts down each time


def template(page: Page) -> Any:
    """The page before its first answer: every input is there, and none can be used."""
    made = Template(asset("page.html"))
    made.add_variable("style", asset("parts.css").replace(":host {", ".app {") + asset("page.css") + asset("views.css"))
    made.add_variable("script", "\n".join(asset(name) for name in _SCRIPTS))
    made.add_variable("theme", page.screen.theme)
    made.add_variable("views", _buttons({name: kind.title for name, kind in VIEWS.items()}, "view"))
    made.add_variable("sections", _sections())
    made.add_variable("files", _buttons({kind: kind for kind in FILES}, "file"))
    made.add_variable("start", _safe(json.dumps(page.start())))
    made.add_panel("ears", pn.pane.Bokeh(page.channel.ears))
    made.add_panel("mouth", pn.pane.Bokeh(page.channel.mouth))
    made.add_panel("main", page.main)
    return made


def _buttons(words: dict[str, str], kind: str) -> Markup:
    return Markup(
        "".join(
            f'<button type="button" data-{kind}="{escape(name)}">{escape(said)}</button>'
            for name, said in words.items()
        )
    )


def _sections() -> Markup:
    """The places of those views that the page itself shows."""
    bodies = {name: (kind.title, kind.body) for name, kind in VIEWS.items() if hasattr(kind, "body")}
    return Markup(
        "".join(
            f'<section class="view" data-view="{name}" aria-label="{title}" hidden>{body}</section>'
            for name, (title, body) in bodies.items()
        )
    )


def _safe(text: str) -> Markup:
    """JSON inside a script: no end of it can be written in a name."""
    return Markup(text.replace("<", "\\u003c"))
