"""Server of the explorer, with limits and protection."""

from __future__ import annotations

import re
import socket
import sys
from collections.abc import Callable, Iterable, Sequence
from html import escape
from secrets import token_bytes
from typing import Any

import panel as pn
from tornado.httputil import HTTPHeaders
from tornado.web import Application, OutputTransform, RequestHandler

from ..core.checks import require, shown
from .pressing import pressed
from .session import Page, template
from .state.screen import START

_STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
}


class _Strict(OutputTransform):
    """Transform that adds the strict headers to every response."""

    def transform_first_chunk(
        self, status_code: int, headers: HTTPHeaders, chunk: bytes, finishing: bool
    ) -> tuple[int, HTTPHeaders, bytes]:
        headers.update(_STRICT)
        return status_code, headers, chunk


class _Refused(RequestHandler):
    """Response to a host name of another server, such as one that a foreign page points here."""

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
    """Refuse requests for unused routes and for hosts other than `names` ("*" is any), and add strict headers."""
    application.add_transform(_Strict)
    application.add_handlers(".*", [(_UNUSED_ROUTES, _NoPage)])
    hosts = {_host(name) for name in names}
    if "*" not in hosts:
        ours = "|".join(re.escape(host).replace(r"\*", r"[^.]*") for host in sorted(hosts))
        application.add_handlers(rf"(?!(?:{ours})$).*", [(".*", _Refused)])


def _host(name: str) -> str:
    """Return a host name without its port, in lower case."""
    return re.sub(r":[\d*]+$", "", name.lower())


_GONE = 1001
"""Close code of a browser that leaves the page; a broken connection has another, and may return."""


def forget_closed(application: Any) -> None:
    """Remove the session of a page that a browser has closed at the next check of the server."""
    client_lost = application.client_lost

    def leave(connection: Any) -> None:
        session = connection.session
        client_lost(connection)
        if connection._socket.close_code == _GONE:
            session.request_expiration()

    application.client_lost = leave


_UNHANDLED = "the server could not handle this message"


def hide_tracebacks(application: Any) -> None:
    """Remove code and folder names of this machine from error messages to browsers."""

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
        """Count a page when the WebSocket of its browser opens."""

        def count(connection: Any) -> None:
            self._waiting.pop(connection.session.id, None)
            self._connected.add(connection.session.id)

        _change_connections(application, count)


LOOPBACK, EVERYWHERE = "127.0.0.1", "0.0.0.0"
MOST_SESSIONS = 200
"""Largest number of connected pages. The same number may wait for their browsers."""

_MESSAGE = 400_000
"""Bytes of one message from a browser: an upload is smaller."""

_IDLE = 60_000  # ms until a disconnected page is removed
_SWITCH_INTERVAL = 5e-4  # s until a drawing thread yields to pages; 5 ms is the default
_CHECK_INTERVAL = 1_000  # ms between two checks for closed pages


def server(port: int = 5006, address: str = LOOPBACK, origins: Sequence[str] = (), show: bool = False) -> Any:
    """Set up the server without starting it.

    Parameters
    ----------
    port : int
        0 takes any that is free.
    address : str
        Of the interface it listens on; other machines reach it only if this is not the loopback.
    origins : sequence of str
        Hosts under which browsers may reach it, "hips.example.org:5006", beside this machine's own names.
    show : bool
        Open a browser.

    Raises
    ------
    ValueError
        A port or an address that is none.
    OSError
        The port is taken.
    """
    require("port", port, 0 <= port <= 65535, "a port is 0 to 65535")
    _check_address(address)
    pn.extension(notifications=False)
    sys.setswitchinterval(_SWITCH_INTERVAL)
    pressed(START.file, (START.answered_by, *START.shown))  # load at the start what the first press would load
    port = port or _free_port(address)
    own_hosts = [f"{name}:{port}" for name in dict.fromkeys((LOOPBACK, "localhost", address))]
    served = pn.serve(
        {"/": _session},
        port=port,
        address=address,
        websocket_origin=[*own_hosts, *origins],
        sign_sessions=True,  # otherwise an invented session name could be shared with another user
        secret_key=token_bytes(32),
        show=show,
        start=False,
        title="ballsocket",
        websocket_max_message_size=_MESSAGE,
        unused_session_lifetime_milliseconds=_IDLE,
        check_unused_sessions_milliseconds=_CHECK_INTERVAL,
        http_server_kwargs={"max_buffer_size": _MESSAGE, "max_body_size": _MESSAGE},
    )
    guard(served._tornado, (*own_hosts, *origins))
    forget_closed(served._tornado)
    hide_tracebacks(served._tornado)
    _pages.count_connections(served._tornado)
    return served


def _check_address(address: str) -> None:
    try:
        socket.getaddrinfo(address, None)
    except (OSError, UnicodeError) as error:
        raise ValueError(
            f"address = {shown(address)} is not allowed: no interface of this machine is called so"
        ) from error


def _free_port(address: str) -> int:
    with socket.socket() as probe:
        probe.bind((address, 0))
        return int(probe.getsockname()[1])


_pages = OpenPages(max_waiting=MOST_SESSIONS)


def _session() -> Any:
    """Make a page for a request, unless too many are open."""
    if len(_pages) >= MOST_SESSIONS:
        return pn.pane.HTML(f"<p>{escape(f'{MOST_SESSIONS} pages are open here already: try again later')}</p>")
    location = pn.state.location
    page = Page((location.search if location is not None else "").lstrip("?"))
    context = pn.state.curdoc.session_context
    _pages.add(context.id, context)

    def on_destroyed(context: Any) -> None:
        _pages.remove(context.id)
        page.leave()

    pn.state.on_session_destroyed(on_destroyed)
    return template(page)
