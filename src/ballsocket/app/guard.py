"""What the server says to strangers, and to those who leave: strict answers, and nothing kept of a closed page."""

from __future__ import annotations

import re
from collections.abc import Iterable
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


def guard(application: Application, names: Iterable[str]) -> None:
    """Refuse requests for other hosts than these, and mark every answer.

    Parameters
    ----------
    application : tornado.web.Application
    names : iterable of str
        Hosts, with a port or without; "*" is any.
    """
    application.add_transform(_Strict)
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
