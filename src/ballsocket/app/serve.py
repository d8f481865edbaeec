"""The server of the explorer: on this machine unless told otherwise, and with limits."""

from __future__ import annotations

import socket
import sys
from collections.abc import Sequence
from html import escape
from secrets import token_bytes
from typing import Any

import panel as pn

from ..core.checks import require, shown
from .guard import OpenPages, forget_closed, guard, hide_tracebacks
from .page import Page
from .pressing import pressed
from .screen import START
from .template import template

LOOPBACK, EVERYWHERE = "127.0.0.1", "0.0.0.0"
MOST_SESSIONS = 200
"""Largest number of connected pages. The same number may wait for their browsers."""

_MESSAGE = 400_000
"""Bytes of one message from a browser: an upload is smaller."""

_IDLE = 60_000  # ms after which a page whose line is broken is forgotten
_TURN = 5e-4  # s for which a drawing keeps pages waiting, many times in an answer; usual are 5 ms
_LOOK = 1_000  # ms between two looks for pages that were closed


def server(port: int = 5006, address: str = LOOPBACK, origins: Sequence[str] = (), show: bool = False) -> Any:
    """The server, not yet started.

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
    sys.setswitchinterval(_TURN)
    pressed(START.file, (START.answered_by, *START.shown))  # what is loaded at the first press is loaded now
    port = port or _free_port(address)
    own = [f"{name}:{port}" for name in dict.fromkeys((LOOPBACK, "localhost", address))]
    served = pn.serve(
        {"/": _session},
        port=port,
        address=address,
        websocket_origin=[*own, *origins],
        sign_sessions=True,  # or whoever made up a session's name could share it with the next one who follows a link
        secret_key=token_bytes(32),
        show=show,
        start=False,
        title="ballsocket",
        websocket_max_message_size=_MESSAGE,
        unused_session_lifetime_milliseconds=_IDLE,
        check_unused_sessions_milliseconds=_LOOK,
        http_server_kwargs={"max_buffer_size": _MESSAGE, "max_body_size": _MESSAGE},
    )
    guard(served._tornado, (*own, *origins))
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
    with socket.socket() as found:
        found.bind((address, 0))
        return int(found.getsockname()[1])


_pages = OpenPages(max_waiting=MOST_SESSIONS)


def _session() -> Any:
    """Make a page for a request, unless too many are open."""
    if len(_pages) >= MOST_SESSIONS:
        return pn.pane.HTML(f"<p>{escape(f'{MOST_SESSIONS} pages are open here already: try again later')}</p>")
    location = pn.state.location
    page = Page((location.search if location is not None else "").lstrip("?"))
    context = pn.state.curdoc.session_context
    _pages.add(context.id, context)

    def left(context: Any) -> None:
        _pages.remove(context.id)
        page.leave()

    pn.state.on_session_destroyed(left)
    return template(page)
