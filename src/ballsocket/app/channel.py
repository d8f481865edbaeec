"""Text connection between a page and its browser, in both directions."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from bokeh.models import CustomJS
from bokeh.models.widgets import TextInput

from .widgets.fields import Field

LONGEST = 300_000
"""Characters of one question: an uploaded joint file is shorter."""


class Channel:
    """Connection to one browser, with hidden text inputs for both directions, that sends only changed values."""

    def __init__(self, handle_request: Callable[[str, Mapping[str, Any]], None]) -> None:
        self._handle_request = handle_request
        self._current: dict[str, Any] = {}
        self._pending: dict[str, Any] = {}
        self._number = self._answered = 0
        self.inbox = TextInput(name="asked", value="", visible=False)
        self.outbox = TextInput(name="shown", value="", visible=False)
        self.inbox.on_change("value", lambda attribute, old, new: self._hear(new))
        self.outbox.js_on_change("value", CustomJS(code="window.ballsocket.hear(cb_obj.value)"))

    def put(self, name: str, value: Any) -> None:
        """Set the value of a part of the page in the next message."""
        if self._current.get(name, "" if name.startswith("#") else None) != value:
            self._current[name] = self._pending[name] = value

    def put_fields(self, fields: Mapping[str, Field]) -> None:
        """Set the inputs of the page."""
        for name, field in fields.items():
            self.put(f"={name}", field)

    def once(self, name: str, value: Any) -> None:
        """Send a value once, even if it was sent before."""
        self._pending[name] = value

    def shown_value(self, name: str) -> Any:
        """Return the current value of a part of the page; None without one."""
        return self._current.get(name)

    def take_pending(self) -> dict[str, Any]:
        """Return and clear the values that wait to be sent."""
        waiting, self._pending = self._pending, {}
        return waiting

    def send(self) -> None:
        """Send all changed values in one message, with the number of the last request."""
        self.outbox.value = json.dumps({"n": self._number, **self.take_pending()}, ensure_ascii=False)
        self._answered = self._number

    def _hear(self, text: str) -> None:
        """Handle one request of a browser; ignore text that is not a request."""
        try:
            words = json.loads(text) if len(text) <= LONGEST else None
        except (ValueError, RecursionError):
            return
        if isinstance(words, dict) and isinstance(words.get("do"), str) and isinstance(words.get("n"), int):
            self._number = words["n"]
            self._handle_request(words["do"], words)
            if self._pending or self._answered != self._number:
                self.send()
