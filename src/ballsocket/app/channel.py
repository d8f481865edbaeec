"""Messages between a page and its browser, in both directions."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from .widgets.controls import Field

MAX_REQUEST_LENGTH = 300_000  # characters of one request: an uploaded joint file is shorter


def read_request(text: str | bytes) -> dict[str, Any] | None:
    """Read one request of a browser; return None for text that is not a request.

    Halves of surrogate pairs, which no message can carry, become question marks.
    """
    try:
        words = json.loads(text) if len(text) <= MAX_REQUEST_LENGTH else None
    except (ValueError, RecursionError):
        return None
    if not (isinstance(words, dict) and isinstance(words.get("do"), str) and isinstance(words.get("n"), int)):
        return None
    return dict(json.loads(json.dumps(words, ensure_ascii=False).encode(errors="replace")))


def difference(old: Any, new: Any) -> Any:
    """Return the changes from one plain value to another: `[new]`, or changes by key or index where both have the same.

    A list or dict of which more than half is new is replaced.

    Examples
    --------
    >>> difference({"unit": "N", "points": [0.0, 1.25, 2.5]}, {"unit": "N", "points": [0.0, 1.5, 2.5]})
    {'points': {1: [1.5]}}
    >>> difference([0, 1, 2], [5, 6, 2])
    [[5, 6, 2]]
    """
    if isinstance(old, dict) and isinstance(new, dict) and old.keys() == new.keys():
        keys: Iterable[Any] = new
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        keys = range(len(new))
    else:
        return [new]
    inside = {key: difference(old[key], new[key]) for key in keys if old[key] != new[key]}
    is_new = 2 * len(inside) > len(new) and all(isinstance(change, list) for change in inside.values())
    return [new] if is_new else inside


class Channel:
    """Connection to one browser that sends only what has changed since the last message.

    `question` numbers the screens: each message carries the number of the screen that its values belong to. `number` is
    that of the last request.
    """

    def __init__(self, handle_request: Callable[[str, Mapping[str, Any]], None], write: Callable[[str], None]) -> None:
        self._handle_request, self.write = handle_request, write
        self._current: dict[str, Any] = {}
        self._pending: dict[str, Any] = {}
        self._sent: dict[str, Any] = {}
        self._expected: set[str] = set()
        self._refused: dict[str, tuple[Any, Field]] = {}
        self.number = self._answered = self.question = 0

    def put(self, name: str, value: Any) -> None:
        """Set the value of a part of the page in the next message."""
        self._expected.discard(name)
        if self._current.get(name, "" if name.startswith("#") else None) != value:
            self._current[name] = self._pending[name] = value

    def put_inputs(self, element: str, fields: Mapping[str, Field]) -> None:
        """Set inputs and their order in an element, by its id."""
        self.put_fields(fields)
        self.put(f"@{element}", list(fields))

    def put_fields(self, fields: Mapping[str, Field]) -> None:
        for name, field in fields.items():
            value, refusal = self._refused.get(name, (None, {}))
            if refusal and value != _shown_in(field):
                del self._refused[name]
            self.put(f"={name}", {**field, **refusal} if name in self._refused else field)

    def refuse_field(self, name: str, refusal: Field) -> None:
        """State beside an input why its text was refused, until its value changes or another edit is accepted.

        `refusal` are entries of the field: the sentence `error`, and what is `refused`.
        """
        self.accept_field(name)
        field = self._current[f"={name}"]
        self._refused[name] = _shown_in(field), refusal
        self.put_fields({name: field})

    def accept_field(self, name: str) -> None:
        """Remove the sentence and the text of a refused edit."""
        if name in self._refused:
            _, refusal = self._refused.pop(name)
            field = self._current[f"={name}"]
            self.put_fields({name: {key: field[key] for key in field if key not in refusal}})

    def accept_fields(self) -> None:
        """Remove the sentences and the texts of all refused edits."""
        for name in list(self._refused):
            self.accept_field(name)

    def expect(self, names: Iterable[str]) -> None:
        """Mark parts of the page that still show an earlier screen, until they are put."""
        self._expected.update(name for name in names if self._current.get(name))

    def forget_expected(self) -> None:
        """Empty the parts that still show an earlier screen, as nothing will follow."""
        for name in sorted(self._expected):
            self.put(name, "")

    def once(self, name: str, value: Any) -> None:
        """Send a value once, even if it was sent before."""
        self._pending[name] = value

    def shown_value(self, name: str) -> Any:
        """Return the current value of a part of the page; None without one."""
        return self._current.get(name)

    def send(self) -> None:
        """Send all changed values in one message, with the number of the last request; nothing if it has no news.

        Those that were sent before are in `changes`, as their differences.
        """
        self.put("expected", sorted(self._expected) or None)
        if not self._pending and self._answered == self.number:
            return
        news, self._pending = self._pending, {}
        self._answered = self.number
        changes = {name: difference(self._sent[name], news.pop(name)) for name in [*news] if name in self._sent}
        self._sent |= {name: value for name, value in self._current.items() if name in news or name in changes}
        message = {"n": self.number, "question": self.question, **news, **({"changes": changes} if changes else {})}
        self.write(json.dumps(message, ensure_ascii=False, separators=(",", ":")))

    def receive(self, request: Mapping[str, Any]) -> None:
        """Handle one request of the browser, and answer it."""
        self.number = request["n"]
        self._handle_request(request["do"], request)
        self.send()


def _shown_in(field: Field) -> Any:
    """Return the text of a number, or the value of another input."""
    return field.get("text", field["value"])
