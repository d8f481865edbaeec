"""Page of one user: its screen, its inputs and its views."""

from __future__ import annotations

import logging
from base64 import b64encode
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from ..core.checks import check_names, shown
from ..core.unit_systems import Units
from .channel import Channel
from .jobs import Job, Outcome, run_in_thread
from .running import RunFinished, RunRefused
from .solving import SlowPresses
from .state.designs import read_upload, session_text
from .state.screen import ANGLES, MAX_LINK_LENGTH, SIZES, START, Screen, check_compared, read_query
from .view import ScreenContent, View, make_file, print_page
from .views.registry import view_class
from .widgets.controls import Changes, Control, Reader, by_name, chosen, fields_of, refusal_of, segments
from .widgets.joint_controls import joint_controls, joint_words, layer_controls
from .widgets.words import alert

_LOG = logging.getLogger(__name__)
_UNIT_CHOICES = ("units", "size", "angle")  # fields of the screen on which the meaning of a number depends
_UNITS = ((Units.SI.value, "mm, N, MPa"), (Units.IMPERIAL.value, "in, lbf, psi"))


class Page:
    """Page of one user, for the query of its address; errors in the query are shown on the page.

    `write` sends a message to its browser, and `number` is that of the request that opened it. Reports have the `logo`
    at an address.
    """

    def __init__(
        self,
        query: str,
        write: Callable[[str], None] = lambda text: None,
        number: int = 0,
        origin: str = "",
        logo: str = "",
    ) -> None:
        self.channel = Channel(self._handle_request, write)
        self._substitute: Screen | None = None  # shown in place of a link that cannot be read
        self.screen = self._read(query)
        self._origin, self._logo = origin, logo
        self._views: dict[str, View] = {}
        self._actions: dict[str, Reader] = {
            "designs.save": lambda links: self.send_file("designs.toml", session_text(_links(links)).encode("utf-8")),
            "designs.compare": self._compare_designs,
        }
        self._slow_presses = SlowPresses(self._refresh)
        self._printing = Job(self._printed)
        self.channel.once("fresh", True)
        self._put_inputs()
        self.channel.send()  # inputs before the first answer, for slow lines
        self.channel.number = number
        self._refresh()

    def _read(self, query: str) -> Screen:
        """Read the screen of a link; return a copy of the start if it is invalid, which leaves the address as it is."""
        if not query:
            return START
        try:
            if len(query) > 3 * MAX_LINK_LENGTH:  # a character may take three in an address
                raise ValueError(f"it is longer than {MAX_LINK_LENGTH} characters")
            return read_query(query)
        except ValueError as error:
            self.refuse(f"This link cannot be read: {error}. These are the numbers of another joint.")
            self._substitute = replace(START)
            return self._substitute

    def refuse(self, sentence: str) -> None:
        """Show why a request failed; an empty sentence clears the message."""
        self.channel.put("#trouble", alert(sentence) if sentence else "")

    def ask(self, **changes: Any) -> None:
        """Change fields of the screen by name."""
        screen = replace(self.screen, **changes)
        if screen == self.screen and screen.link == self.screen.link:  # a default and the same number typed are equal
            return
        _check_link(screen)
        self.refuse("")
        self._change(screen)

    def _change(self, screen: Screen) -> None:
        self.screen = screen
        self.channel.question += 1
        self._refresh()

    def _open(self, words: Mapping[str, Any]) -> None:
        """Show the screen of another link, requested by the browser's history."""
        self.refuse("")
        self.channel.accept_fields()
        self._change(self._read(str(words.get("query"))))

    def _handle_request(self, event: str, words: Mapping[str, Any]) -> None:
        """Handle a request of the browser; show why it failed, beside its input if it has one."""
        doings = {
            "open": self._open,
            "edit": self._edit,
            "view": lambda words: self.ask(view=words.get("value")),
            "save": lambda words: run_in_thread(partial(make_file, self.seen(), str(words.get("kind"))), self._saved),
            "upload": self._upload,
        }
        try:
            check_names([event], doings, "among what a page does")
            doings[event](words)
        except ValueError as error:
            name = str(words.get("name"))
            field = self.channel.shown_value(f"={name}") if event == "edit" else None
            refusal = None if field is None else refusal_of(field, error, words.get("value"))
            if refusal is not None:
                self.channel.refuse_field(name, refusal)
            else:
                self.refuse(str(error))
            self.channel.once("reset", True)
        except Exception:  # a browser never gets a traceback
            _LOG.exception("a request failed")
            self.refuse("the server could not handle this request")
            self.channel.once("reset", True)

    def _edit(self, words: Mapping[str, Any]) -> None:
        """Change an input; a number that was typed before a choice of units has the units before it."""
        name, value = str(words.get("name")), words.get("value")
        if value is not None:  # None forgets a refused text
            changes = self._reader(name, words.get("units") or {})(value)
            self.refuse("")
            self.ask(**(changes or {}))
        self.channel.accept_field(name)

    def _reader(self, name: str, units: Any) -> Reader:
        """Return the reader of an input in these units of the page, or of another event."""
        screen = self.screen
        if not isinstance(units, dict) or set(units) not in (set(), set(_UNIT_CHOICES)):
            raise ValueError(f"units = {shown(units)} must have {', '.join(_UNIT_CHOICES)}")
        if name not in _UNIT_CHOICES and any(getattr(screen, choice) != value for choice, value in units.items()):
            screen = replace(screen, **units)
        view = self._views.get(name.partition(".")[0])
        beside = self.controls if screen is self.screen else page_controls(screen)
        controls = beside if view is None else view.named_controls(screen)
        readers: dict[str, Reader] = {**self._actions, **{name: control.take for name, control in controls.items()}}
        check_names([name], readers, "among the inputs")
        return readers[name]

    def _saved(self, outcome: Outcome) -> None:
        try:
            name, content = outcome.result()
        except ValueError as error:
            self.refuse(str(error))
        except Exception as error:
            _LOG.exception("a file failed")
            self.refuse(f"This cannot be saved: {error}")
        else:
            if name.endswith(".pdf"):
                page, paper = content.decode("utf-8"), self.screen.reading.units.paper
                self._printing.ask((name, page, paper), partial(print_page, page, paper))
                return
            self.send_file(name, content)
        self.channel.send()

    def _printed(self, key: Any, news: Any) -> None:
        if isinstance(news, RunRefused):
            self.refuse(news.why)
        elif isinstance(news, RunFinished):
            self.send_file(key[0], news.value)
        self.channel.send()

    def _upload(self, words: Mapping[str, Any]) -> None:
        """Read a joint file or a session file from the browser, and show its first design."""
        screens = read_upload(str(words.get("text")), self.screen)
        for screen in screens:
            _check_link(screen)
        self.channel.once("designs", [screen.link for screen in screens])
        self.refuse("")
        self._change(screens[0])

    def _compare_designs(self, links: Any) -> Changes:
        """Compare designs with the one on the screen."""
        check_compared(len(_links(links)))
        return {"beside": tuple(read_query(link).file for link in links), "view": "compare"}

    def send_file(self, name: str, content: bytes) -> None:
        """Let the browser save a file."""
        self.channel.once("file", {"name": name, "content": b64encode(content).decode("ascii")})

    def attempt(self, action: Callable[[], None]) -> None:
        """Run an action outside a request and send its changes; a failure becomes a sentence on an idle page."""
        try:
            action()
        except Exception as error:  # the page must report every failure
            _LOG.exception("a view failed")
            self.channel.forget_expected()
            self.refuse(f"This cannot be shown: {error}")
        if self.screen.view in self._views:
            self.view.clear_mark()
        marks = {name: view.mark for name, view in self._views.items() if view.mark and name != self.screen.view}
        self.channel.put("works", marks or None)
        self.channel.send()

    def _refresh(self) -> None:
        self._put_inputs()
        self.attempt(self._show_view)
        self._slow_presses.ask(*self.view.asks(self.screen))

    def _show_view(self) -> None:
        self.view.show_inputs(self.screen)
        self.view.show(self.screen)

    def _put_inputs(self) -> None:
        screen = self.screen
        self.controls = page_controls(screen)
        self.channel.put_inputs("controls", fields_of(self.controls))
        self.channel.put("#behind", joint_words(screen.file.joint))
        self.channel.put("view", screen.view)
        self.channel.put("link", "" if screen is self._substitute else screen.link)

    @property
    def view(self) -> View:
        """View that is open, made when it is first opened."""
        name = self.screen.view
        if name not in self._views:
            self._views[name] = view_class(name)(self)
            self._actions |= self._views[name].actions
        return self._views[name]

    def seen(self) -> ScreenContent:
        """Return the content of the screen for files."""
        return ScreenContent(
            title=self.view.title,
            file=self.screen.file,
            link=f"{self._origin}/?{self.screen.link}",
            document=self.view.document(self.screen),
            units=self.screen.reading.units,
            logo=self._logo,
        )

    def leave(self) -> None:
        self._slow_presses.leave()
        self._printing.stop()
        for view in self._views.values():
            view.leave()


def page_controls(screen: Screen) -> dict[str, Control]:
    """Return the inputs beside all views by name: of the joint and its load, and of the units."""
    return by_name(
        [
            *joint_controls(screen),
            *layer_controls(screen),
            chosen(screen, "units", "Units", _UNITS, segments),
            chosen(screen, "size", "Ball size as", SIZES, segments),
            chosen(screen, "angle", "Angles in", ANGLES, segments),
        ]
    )


def _links(value: Any) -> list[str]:
    if not isinstance(value, list) or not all(isinstance(link, str) for link in value):
        raise ValueError("designs are a list of links")
    return value


def _check_link(screen: Screen) -> None:
    if len(screen.link) > MAX_LINK_LENGTH:
        raise ValueError(
            f"a link to this would be longer than {MAX_LINK_LENGTH} characters: shorten the names in the file"
        )
