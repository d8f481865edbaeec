"""Protection of the server: strict headers, allowed routes and hosts, and the removal of closed pages."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from typing import Any

from tornado.httputil import HTTPHeaders
from tornado.web import Application, OutputTransform, RequestHandler

_STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
}


class _Strict(OutputTransform):
    """Puts the headers on every answer: pages, scripts, errors."""

    def transform_first_chunk(
        self, status_code: int, headers: HTTPHeaders, chunk: bytes, finishing: bool
    ) -> tuple[int, HTTPHeaders, bytes]:
        headers.update(_STRICT)
        return status_code, headers, chunk


class _Refused(RequestHandler):
    """The answer to a name that is not ours: a page elsewhere may have made it lead here."""

    def prepare(self) -> None:
        self.set_status(403)
        self.finish("this server does not answer to that name; see --origin\n")


class _NoPage(RequestHandler):
    """Refusal of a route that the page does not use, such as the routes by which Panel imports modules."""

    def prepare(self) -> None:
        self.set_status(404)
        self.finish("this server has no such page\n")


_UNUSED_ROUTES = r"(?!(?:/|/ws|/favicon\.ico|/static/.*)$).*"


def guard(application: Application, names: Iterable[str]) -> None:
    """Refuse requests for other hosts and for unused routes, and add strict headers to every response.

    Parameters
    ----------
    application : tornado.web.Application
    names : iterable of str
        Hosts, with a port or without; "*" is any.
    """
    application.add_transform(_Strict)
    application.add_handlers(".*", [(_UNUSED_ROUTES, _NoPage)])
    hosts = {_host(name) for name in names}
    if "*" not in hosts:
        ours = "|".join(re.escape(host).replace(r"\*", r"[^.]*") for host in sorted(hosts))
        application.add_handlers(rf"(?!(?:{ours})$).*", [(".*", _Refused)])


def _host(name: str) -> str:
    """Without the port, in small letters, as requests are matched."""
    return re.sub(r":[\d*]+$", "", name.lower())


_GONE = 1001
"""With which a browser takes leave when its page is closed; a line that breaks says nothing, and may come back."""


def forget_closed(application: Any) -> None:
    """Have what belongs to a page that a browser has closed be forgotten when the server next looks.

    Parameters
    ----------
    application : BokehTornado
    """
    lost = application.client_lost

    def leave(connection: Any) -> None:
        session = connection.session
        lost(connection)
        if connection._socket.close_code == _GONE:
            session.request_expiration()

    application.client_lost = leave


_UNHANDLED = "the server could not handle this message"


def hide_tracebacks(application: Any) -> None:
    """Remove code and folder names of this machine from error messages to browsers.

    Parameters
    ----------
    application : BokehTornado
    """

    def hide(connection: Any) -> None:
        def error(message: Any, text: str) -> Any:
            reply = connection.protocol.create("ERROR", message.header["msgid"], _UNHANDLED)
            reply.content = {"text": _UNHANDLED, "traceback": None}
            return reply

        connection.error = error

    _change_connections(application, hide)


def _change_connections(application: Any, change: Callable[[Any], None]) -> None:
    """Call a function with each new WebSocket connection of a BokehTornado application."""
    connect = application.new_connection

    def connected(*words: Any) -> Any:
        connection = connect(*words)
        change(connection)
        return connection

    application.new_connection = connected


class OpenPages:
    """Pages of a server: connected pages, and pages that wait for their browser.

    A client that only requests the address never connects. The oldest waiting pages are removed.

    Parameters
    ----------
    max_waiting : int
        Pages that may wait at once.
    """

    def __init__(self, max_waiting: int) -> None:
        self.max_waiting = max_waiting
        self._connected: set[str] = set()
        self._waiting: dict[str, Any] = {}

    def __len__(self) -> int:
        """Count the pages to which a browser has connected."""
        return len(self._connected)

    def add(self, name: str, context: Any) -> None:
        """Add a page by the name of its session, and remove the oldest waiting pages beyond the limit."""
        self._waiting[name] = context
        while len(self._waiting) > self.max_waiting:
            oldest = self._waiting.pop(next(iter(self._waiting)))
            if oldest.session is not None:
                oldest.session.request_expiration()

    def remove(self, name: str) -> None:
        """Remove a closed page."""
        self._connected.discard(name)
        self._waiting.pop(name, None)

    def count_connections(self, application: Any) -> None:
        """Count a page when the WebSocket of its browser opens.

        Parameters
        ----------
        application : BokehTornado
        """

        def count(connection: Any) -> None:
            self._waiting.pop(connection.session.id, None)
            self._connected.add(connection.session.id)

        _change_connections(application, count)
