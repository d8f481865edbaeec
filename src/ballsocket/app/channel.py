"""The line between a page and its browser: what the browser asks for, and what the page shows, as text both ways."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from bokeh.models import CustomJS
from bokeh.models.widgets import TextInput

from .fields import Field

LONGEST = 300_000
"""Characters of one question: an uploaded joint file is shorter."""


class Channel:
    """Sends only what has changed since it was last said.

    Parameters
    ----------
    asked : callable
        Told what a browser does: its word, and a mapping of the rest.

    Attributes
    ----------
    ears, mouth : TextInput
        Hidden, for the page: the browser writes into one, the server into the other.
    """

    def __init__(self, asked: Callable[[str, Mapping[str, Any]], None]) -> None:
        self._asked = asked
        self._said: dict[str, Any] = {}
        self._waiting: dict[str, Any] = {}
        self._number = self._answered = 0
        self.ears = TextInput(name="asked", value="", visible=False)
        self.mouth = TextInput(name="shown", value="", visible=False)
        self.ears.on_change("value", lambda attribute, old, new: self._hear(new))
        self.mouth.js_on_change("value", CustomJS(code="window.ballsocket.hear(cb_obj.value)"))

    def put(self, name: str, value: Any) -> None:
        """Have a part of the page show a value, when the next message is sent."""
        if self._said.get(name, "" if name.startswith("#") else None) != value:
            self._said[name] = self._waiting[name] = value

    def put_fields(self, fields: Mapping[str, Field]) -> None:
        """Have inputs be like this."""
        for name, field in fields.items():
            self.put(f"={name}", field)

    def once(self, name: str, value: Any) -> None:
        """Have something done once: it is sent though it may have been sent before."""
        self._waiting[name] = value

    def told(self, name: str) -> Any:
        """What a part of the page shows; None where it shows nothing yet."""
        return self._said.get(name)

    def taken(self) -> dict[str, Any]:
        """What waits to be sent, for somebody who brings it there otherwise."""
        waiting, self._waiting = self._waiting, {}
        return waiting

    def send(self) -> None:
        """One message with all that is new; it also says which question was the last."""
        self.mouth.value = json.dumps({"n": self._number, **self.taken()}, ensure_ascii=False)
        self._answered = self._number

    def _hear(self, text: str) -> None:
        """One question from a browser; what is none came from no page of ours."""
        try:
            words = json.loads(text) if len(text) <= LONGEST else None
        except (ValueError, RecursionError):
            return
        if isinstance(words, dict) and isinstance(words.get("do"), str) and isinstance(words.get("n"), int):
            self._number = words["n"]
            self._asked(words["do"], words)
            if self._waiting or self._answered != self._number:
                self.send()
