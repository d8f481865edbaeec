"""What a view is, and what can be taken away from it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from ..contact import Contact
from ..files.joint_file import JointFile
from .channel import Channel
from .screen import Screen


@dataclass(frozen=True, kw_only=True)
class Document:
    """What is on the screen, for a file.

    Each is made when it is asked for. `picture` draws it as "png" or "svg" with the figures of the command line, where
    there is something to draw; `rows` are a table with its head first; `sections` are the parts of a page of HTML, a
    title and HTML by their id, and `lede` what stands above them; `contact` is painted on the page's drawing.
    """

    picture: Callable[[str], bytes] | None = None
    rows: Callable[[], Sequence[Sequence[Any]]]
    sections: Callable[[], Mapping[str, tuple[str, str]]]
    lede: Callable[[], str] = str
    contact: Contact | None = None


class Host(Protocol):
    """What a view knows of its page."""

    channel: Channel
    screen: Screen

    def ask(self, **changes: Any) -> None:
        """Change the screen: called with fields of `Screen` by name."""
        ...

    def listen(self, view: str, told: Callable[[str, Any], None]) -> None:
        """Tell a view of its own inputs, which are named by it and a dot."""
        ...


class View(Protocol):
    """One question, answered for the screen; made with its `Host` when it is first looked at.

    Attributes
    ----------
    title : str
    panel : Viewable or None
        Its parts as Panel makes them; None where they stand in the page itself, which `Host.channel` fills.
    """

    title: str
    panel: Any

    def show(self, screen: Screen) -> None:
        """Answer for what is on the screen now."""
        ...

    def document(self, screen: Screen) -> Document:
        """What is on the screen, made for a file."""
        ...

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        """The joints that it presses by which models, those first that are seen first: what takes long is sent for."""
        ...

    def leave(self) -> None:
        """The page is closed: stop what is running."""
        ...
