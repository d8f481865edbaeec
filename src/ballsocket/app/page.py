"""The page: controls beside one view at a time; a change anywhere becomes a new screen, and the screen is shown."""

from __future__ import annotations

import logging
from base64 import b64encode
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import Any
from urllib.parse import parse_qs

import panel as pn

from ..core.checks import check_names
from ..files.joint_file import parse_joint
from ..output.unit_systems import Units
from .beside import beside
from .channel import Channel
from .controls import behind, edited, fields_of
from .fields import Field, segments
from .files import ScreenContent, made
from .layers import layer_fields, layers_edited
from .pressing import pressed
from .screen import ANGLES, LONGEST_LINK, SIZES, START, Screen, link_of, read_link
from .solving import Errand
from .view import View
from .views import KINDS
from .words import alert

_LOG = logging.getLogger(__name__)
_LARGEST = 100_000  # characters of a joint file
_CHOSEN = ("view", "answered_by", "shown", "painted", "angle", "size", "units")
"""Fields of the screen that the page's own inputs change."""

_UNITS = ((Units.SI.value, "mm, N, MPa"), (Units.IMPERIAL.value, "in, lbf, psi"))


class Page:
    """One user's page.

    Parameters
    ----------
    query : str
        The part of the address after the question mark. What is wrong with it is said on the page.
    """

    def __init__(self, query: str) -> None:
        self.channel = Channel(self._asked)
        self.screen = self._read(query)
        self._views: dict[str, View] = {}
        self._ears: dict[str, Callable[[str, Any], None]] = {"behind": self._layered}
        self.main = pn.Column(sizing_mode="stretch_width")
        self._errand = Errand(self._refresh)
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
        self.channel.put("#trouble", alert(sentence) if sentence else "")

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

    def _asked(self, what: str, words: Mapping[str, Any]) -> None:
        """What a browser does; what cannot be done is said, and the inputs show what is meant."""
        doings = {"edit": self._edit, "choose": self._choose, "save": self._save, "upload": self._upload}
        try:
            check_names([what], doings, "among what a page does")
            doings[what](words)
        except ValueError as error:
            self.refuse(str(error))
            self.channel.once("reset", True)

    def listen(self, view: str, told: Callable[[str, Any], None]) -> None:
        """Tell a view of its own inputs, which are named by it and a dot."""
        self._ears[view] = told

    def _edit(self, words: Mapping[str, Any]) -> None:
        view, _, key = str(words.get("name")).partition(".")
        if key:
            check_names([view], self._ears, "among the views that have inputs")
            self.refuse("")
            self._ears[view](key, words.get("value"))
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
        if not isinstance(wanted, tuple if name == "shown" else str) or not all(isinstance(one, str) for one in wanted):
            raise ValueError(f"{name} takes words")
        self.ask(**{name: wanted})

    def _save(self, words: Mapping[str, Any]) -> None:
        """A file, made in a thread; where there is none, the page says why."""
        kind, seen = str(words.get("kind")), self.seen()
        beside(partial(made, seen, kind), self._saved)

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
        """A joint file from the browser, by the reader of files."""
        text = str(words.get("text"))
        if len(text) > _LARGEST:
            raise ValueError(f"the file is longer than {_LARGEST} characters; a joint file is a few lines")
        file = parse_joint(text.encode("utf-8"), "the file")
        self.ask(file=file if file.load else replace(file, load=self.screen.file.load))

    def start(self) -> dict[str, Any]:
        """What the page shows before its first answer: inputs, and what is wrong with its link."""
        self._put()
        return self.channel.taken()

    def fields(self) -> dict[str, Field]:
        """Every input beside the views, by its name."""
        angles = segments("angle", "angles in", [(each, each) for each in ANGLES], self.screen.angle)
        sizes = segments("size", "balls by", [(each, each) for each in SIZES], self.screen.size)
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
            except Exception as error:  # a page must not fall silent, whatever it is
                _LOG.exception("a view failed")
                self.refuse(f"This cannot be shown: {error}")
        self.channel.send()
        self._errand.ask(*seen.asks(self.screen))

    def _put(self) -> None:
        """Have every input show what is on the screen."""
        fields = self.fields()
        self.channel.put_fields(fields)
        self.channel.put("order", list(fields))
        self.channel.put("#behind", behind(self.screen.file.joint))
        self.channel.put("view", self.screen.view)
        self.channel.put("link", link_of(self.screen))

    @property
    def view(self) -> View:
        """The one that is seen, made when it is first looked at."""
        name = self.screen.view
        if name not in self._views:
            self._views[name] = KINDS[name](self)
            if self._views[name].panel is not None:
                self.main.append(self._views[name].panel)
        return self._views[name]

    def seen(self) -> ScreenContent:
        """What is on the screen, for files."""
        return ScreenContent(
            title=self.view.title,
            file=self.screen.file,
            link=f"?{link_of(self.screen)}",
            document=self.view.document(self.screen),
            units=self.screen.reading.units,
        )

    def _same_load(self, kind: str) -> dict[str, float]:
        """The load of another kind that presses as much as now, by the model on top."""
        found = pressed(self.screen.file, (self.screen.answered_by,))
        contact = found.contacts.get(self.screen.answered_by)
        value = float("nan") if contact is None else float(getattr(contact, kind))
        usual = {"force": 3000.0, "indentation": 0.05, "half_angle": 0.7}
        return {kind: float(f"{value:.6g}") if value > 0 else usual[kind]}

    def leave(self) -> None:
        """The page is closed."""
        self._errand.leave()
        for view in self._views.values():
            view.leave()
