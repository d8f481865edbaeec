"""Page of one user: its screen, its inputs and its views."""

from __future__ import annotations

import logging
from asyncio import TimerHandle
from base64 import b64encode
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import Any
from urllib.parse import parse_qs

from ..core.checks import check_names, shown
from ..core.unit_systems import Units
from .channel import Channel
from .jobs import Job, call_later, run_in_thread
from .running import RunFinished, RunRefused
from .solving import SlowPresses
from .state.designs import read_upload, session_text
from .state.screen import ANGLES, MAX_LINK_LENGTH, SIZES, START, Screen, check_compared, read_link
from .view import ScreenContent, View, make_file, print_page
from .views.registry import view_class
from .widgets.fields import in_words_of, segments
from .widgets.joint_fields import joint_inputs, joint_words, layer_fields, layers_edited
from .widgets.words import alert

_LOG = logging.getLogger(__name__)
_CHOSEN = ("view", "answered_by", "shown", "painted", "angle", "size", "units")
"""Fields of the screen that the page's own inputs change."""

_UNIT_CHOICES = ("units", "size", "angle")  # fields of the screen on which the meaning of a number depends
_UNITS = ((Units.SI.value, "mm, N, MPa"), (Units.IMPERIAL.value, "in, lbf, psi"))


class Page:
    """Page of one user, for the query of its address; errors in the query are shown on the page.

    `write` sends a message to its browser, and `number` is that of the request that opened it.
    """

    def __init__(
        self, query: str, write: Callable[[str], None] = lambda text: None, number: int = 0, origin: str = ""
    ) -> None:
        self.channel = Channel(self._handle_request, write)
        self.screen = self._read(query)
        self._origin = origin
        self._views: dict[str, View] = {}
        self._handlers: dict[str, Callable[[str, Any], None]] = {
            "behind": lambda key, value: self.ask(file=layers_edited(self.screen.file, key, value)),
            "designs": self._handle_designs,
        }
        self._timers: set[TimerHandle] = set()
        self._slow_presses = SlowPresses(self._refresh)
        self._printing = Job(self._printed)
        self.channel.once("fresh", True)
        self._put_inputs()
        self.channel.send()  # inputs before the first answer, for slow lines
        self.channel.number = number
        self._refresh()

    def _read(self, query: str) -> Screen:
        """Read the screen of a link; return the start if it is invalid."""
        if not query:
            return START
        try:
            if len(query) > 3 * MAX_LINK_LENGTH:  # a character may take three in an address
                raise ValueError(f"it is longer than {MAX_LINK_LENGTH} characters")
            return read_link(parse_qs(query, keep_blank_values=True))
        except ValueError as error:
            self.refuse(f"This link cannot be read: {error}")
            return START

    def refuse(self, sentence: str) -> None:
        """Show why a request failed; an empty sentence clears the message."""
        self.channel.put("#trouble", alert(sentence) if sentence else "")

    def ask(self, **changes: Any) -> None:
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

    def later(self, seconds: float, function: Callable[[], None]) -> Callable[[], None]:
        def due() -> None:
            cancel()
            self.attempt(function)

        def cancel() -> None:
            if timer is not None:
                self._timers.discard(timer)
                timer.cancel()

        timer = call_later(seconds, due)
        if timer is None:
            self.attempt(function)
        else:
            self._timers.add(timer)
        return cancel

    def _handle_request(self, event: str, words: Mapping[str, Any]) -> None:
        """Handle a request of the browser; show why it failed, beside its input if it has one."""
        doings = {
            "open": self._open,
            "edit": self._edit,
            "choose": self._choose,
            "save": lambda words: run_in_thread(partial(make_file, self.seen(), str(words.get("kind"))), self._saved),
            "upload": self._upload,
        }
        try:
            check_names([event], doings, "among what a page does")
            doings[event](words)
        except ValueError as error:
            name = str(words.get("name"))
            field = self.channel.shown_value(f"={name}") if event == "edit" else None
            if field is not None and field["kind"] in ("number", "words"):
                text = words.get("value")
                self.channel.refuse_field(name, text, in_words_of(field, str(error), text))
            else:
                self.refuse(str(error))
            self.channel.once("reset", True)
        except Exception:  # a browser never gets a traceback
            _LOG.exception("a request failed")
            self.refuse("the server could not handle this request")
            self.channel.once("reset", True)

    def listen(self, view: str, handler: Callable[[str, Any], None]) -> None:
        self._handlers[view] = handler

    def _edit(self, words: Mapping[str, Any]) -> None:
        """Change an input; a number that was typed before a choice of units has the units before it."""
        present = {name: getattr(self.screen, name) for name in _UNIT_CHOICES}
        units = words.get("units") or present
        if units == present:
            self._edit_as_shown(words)
            return
        if not isinstance(units, dict) or set(units) != set(present):
            raise ValueError(f"units = {shown(units)} must have {', '.join(_UNIT_CHOICES)}")
        self._change(replace(self.screen, **units))
        try:
            self._edit_as_shown(words)
        finally:
            self._change(replace(self.screen, **present))

    def _edit_as_shown(self, words: Mapping[str, Any]) -> None:
        """Change an input whose number is in the units of the screen."""
        name, value = str(words.get("name")), words.get("value")
        view, _, key = name.partition(".")
        if isinstance(value, str) and value == (self.channel.shown_value(f"={name}") or {}).get("text"):
            self.channel.accept_field(name)  # a rounded number that nobody has changed
        elif key:
            check_names([view], self._handlers, "among the views that have inputs")
            self.refuse("")
            self._handlers[view](key, value)
        else:
            check_names([name], self._joint_inputs, "among the inputs")
            file = self._joint_inputs[name].edit(value)
            self.refuse("")
            self.ask(file=file)
        self.channel.accept_field(name)

    def _choose(self, words: Mapping[str, Any]) -> None:
        name, value = str(words.get("name")), words.get("value")
        check_names([name], _CHOSEN, "among the choices")
        listed = value if name == "shown" else [value]
        if not isinstance(listed, list) or not all(isinstance(item, str) for item in listed):
            raise ValueError(f"{name} takes words")
        self.ask(**{name: tuple(listed) if name == "shown" else value})

    def _saved(self, outcome: Future[tuple[str, bytes]]) -> None:
        try:
            name, content = outcome.result()
        except ValueError as error:
            self.refuse(str(error))
        except Exception as error:
            _LOG.exception("a file failed")
            self.refuse(f"This cannot be saved: {error}")
        else:
            if name.endswith(".pdf"):
                paper = self.screen.reading.units.paper
                self._printing.ask(name, partial(print_page, content.decode("utf-8"), paper))
                return
            self._send_file(name, content)
        self.channel.send()

    def _printed(self, key: Any, news: Any) -> None:
        if isinstance(news, RunRefused):
            self.refuse(news.why)
        elif isinstance(news, RunFinished):
            self._send_file(key, news.value)
        self.channel.send()

    def _upload(self, words: Mapping[str, Any]) -> None:
        """Read a joint file or a session file from the browser, and show its first design."""
        screens = read_upload(str(words.get("text")), self.screen)
        for screen in screens:
            _check_link(screen)
        self.channel.once("designs", [screen.link for screen in screens])
        self.refuse("")
        self._change(screens[0])

    def _handle_designs(self, key: str, links: Any) -> None:
        """Save designs as a session file, or compare them with the one on the screen."""
        check_names([key], ("save", "compare"), "among what is done with designs")
        if not isinstance(links, list) or not all(isinstance(link, str) for link in links):
            raise ValueError("designs are a list of links")
        if key == "save":
            self._send_file("designs.toml", session_text(links).encode("utf-8"))
            return
        check_compared(len(links))
        compared = tuple(read_link(parse_qs(link, keep_blank_values=True)).file for link in links)
        self.ask(beside=compared, view="compare")

    def _send_file(self, name: str, content: bytes) -> None:
        self.channel.once("file", {"name": name, "content": b64encode(content).decode("ascii")})

    def attempt(self, action: Callable[[], None]) -> None:
        try:
            action()
        except Exception as error:  # the page must report every failure
            _LOG.exception("a view failed")
            self.channel.forget_expected()
            self.refuse(f"This cannot be shown: {error}")
        self.channel.send()

    def _refresh(self) -> None:
        self._put_inputs()
        self.attempt(lambda: self.view.show(self.screen))
        self._slow_presses.ask(*self.view.asks(self.screen))

    def _put_inputs(self) -> None:
        screen, joint = self.screen, self.screen.file.joint
        self._joint_inputs = joint_inputs(screen)
        self.inputs = {
            **{name: entry.field for name, entry in self._joint_inputs.items()},
            **layer_fields(joint),
            "units": segments("units", "Units", _UNITS, screen.units),
            "size": segments("size", "Ball size as", SIZES, screen.size),
            "angle": segments("angle", "Angles in", ANGLES, screen.angle),
        }
        self.channel.put_fields(self.inputs)
        self.channel.put("order", list(self.inputs))
        self.channel.put("#behind", joint_words(joint))
        self.channel.put("view", screen.view)
        self.channel.put("link", screen.link)

    @property
    def view(self) -> View:
        """View that is open, made when it is first opened."""
        name = self.screen.view
        if name not in self._views:
            self._views[name] = view_class(name)(self)
        return self._views[name]

    def seen(self) -> ScreenContent:
        """Return the content of the screen for files."""
        return ScreenContent(
            title=self.view.title,
            file=self.screen.file,
            link=f"{self._origin}/?{self.screen.link}",
            document=self.view.document(self.screen),
            units=self.screen.reading.units,
        )

    def leave(self) -> None:
        self._slow_presses.leave()
        self._printing.stop()
        for timer in self._timers:
            timer.cancel()
        for view in self._views.values():
            view.leave()


def _check_link(screen: Screen) -> None:
    if len(screen.link) > MAX_LINK_LENGTH:
        raise ValueError(
            f"a link to this would be longer than {MAX_LINK_LENGTH} characters: shorten the names in the file"
        )
