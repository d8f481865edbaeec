"""Server of the explorer: the page, its files and its sockets, with limits and protection."""

from __future__ import annotations

import asyncio
import json
import re
import socket
import sys
import time
import webbrowser
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from graphlib import TopologicalSorter
from html import escape
from importlib.resources import files
from ipaddress import ip_address
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from threadpoolctl import threadpool_limits
from tornado.httpserver import HTTPServer
from tornado.ioloop import IOLoop
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from ..core.checks import require, shown
from ..reports.pages import logo_address
from .channel import read_request
from .jobs import PageThread
from .pressing import pressed
from .running import WORKERS
from .session import Page
from .state.screen import START
from .view import FILE_KINDS
from .views.registry import VIEW_CLASSES, view_class
from .widgets.words import alert

_STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; style-src-attr 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self' ws://{host} wss://{host}; form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
)
_SENTENCES = {
    403: "this server does not answer to that name; see --origin\n",
    404: "this server has no such page\n",
    405: "this server does not know this method\n",
}

MAX_SESSIONS = 400  # largest number of open pages. The same number of sockets may be connected without a page.
MAX_PER_ADDRESS = 200  # pages of one network address; all users of a proxy on this machine share its loopback address
_MAX_MESSAGE = 400_000  # bytes; an upload is smaller
_RATE, _BURST = 60.0, 120.0  # requests a second, and at once, that are read from one browser
_SWITCH_INTERVAL = 5e-4  # s until a drawing thread yields to pages; 5 ms is the default
_PING_INTERVAL = 20  # s; a browser that does not answer for as long has gone
_PONG = '{"pong": true}'
LOOPBACK, EVERYWHERE = "127.0.0.1", "0.0.0.0"


class HostNames:
    """Host names under which browsers may reach a server, such as "hips.example.org:8443"; "*" is any part of one."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = [name.lower() for name in names]

    def answer_to(self, host: str) -> bool:
        """Return True for one of the names with any port."""
        return any(_fits(re.sub(r":[\d*]+$", "", name), host) for name in self._names)

    def trust(self, origin: str, host: str) -> bool:
        """Return True if a page of this origin may open a socket: it is from this server, or has one of the names."""
        try:
            address = urlsplit(origin.lower())
        except ValueError:  # malformed, such as "http://["
            return False
        port = {"http": ":80", "https": ":443"}.get(address.scheme, "")
        forms = address.netloc, f"{address.netloc}{port}", address.netloc.removesuffix(port)
        return address.netloc == host.lower() or any(_fits(name, form) for name in self._names for form in forms)


def _fits(name: str, host: str) -> bool:
    """Return True if a star in the name stands for the differing part; a lone star is any host."""
    return name == "*" or re.fullmatch(re.escape(name).replace(r"\*", "[^.]*"), host) is not None


class _Guarded(RequestHandler):
    """Handler that answers to the server's own names, with strict headers and without tracebacks."""

    def set_default_headers(self) -> None:
        self.clear_header("Server")
        for name, value in _STRICT.items():
            self.set_header(name, value)
        self.set_header("Content-Security-Policy", _POLICY.format(host=re.sub(r"[^\w.:\-\[\]]", "", self.request.host)))

    def prepare(self) -> None:
        if not self.settings["names"].answer_to(self.request.host_name):
            raise HTTPError(403)

    def write_error(self, status_code: int, **details: Any) -> None:
        self.set_header("Content-Type", "text/plain; charset=UTF-8")
        self.finish(_SENTENCES.get(status_code, "the server could not handle this request\n"))


class _Missing(_Guarded):
    """Refusal of every other address."""

    def prepare(self) -> None:
        super().prepare()
        raise HTTPError(404)


_KINDS = {".html": "text/html; charset=UTF-8", ".js": "text/javascript; charset=UTF-8", ".css": "text/css"}


def page_files(logo: str = "") -> dict[str, tuple[str, str]]:
    """Read the files of the page, with the logo at an address for clients: kind and content by name."""
    room = files("ballsocket")
    drawing = room / "reports" / "templates" / "drawing.css"  # of the section, which reports have, too
    contents = {file.name: file.read_text(encoding="utf-8") for file in (*(room / "app" / "assets").iterdir(), drawing)}
    contents["style.css"] = "".join(contents.pop(f"{name}.css") for name in ("drawing", "parts", "page", "views"))
    kinds = {name: view_class(name) for name in VIEW_CLASSES}
    modules = {name: contents.pop(name) for name in sorted(contents) if name.endswith(".js")}
    contents["page.js"] = _script(modules)
    parts = {
        "<!--logo-->": f'<img class="logo" alt="" src="{logo}">' if logo else "",
        "<!--views-->": _buttons("view", {name: kind.title for name, kind in kinds.items()}),
        "<!--files-->": _buttons("file", {kind: kind for kind in FILE_KINDS}),
        "<!--sections-->": "".join(
            f'<section class="view" data-view="{name}" aria-label="{kind.title}" hidden>'
            f'<h2 class="unseen">{kind.title}</h2>{kind.body}</section>\n'
            for name, kind in kinds.items()
        ),
    }
    for mark, html in parts.items():
        contents["page.html"] = contents["page.html"].replace(mark, html)
    return {name: (_KINDS[name[name.rindex(".") :]], content) for name, content in contents.items()}


_IMPORT = re.compile(r'^import (?:(\{.*\}) from )?"\./(\w+)\.js";', re.MULTILINE)
_EXPORT = re.compile(r"^export (function|const) (\w+)", re.MULTILINE)


def _script(modules: Mapping[str, str]) -> str:
    """Join modules to one script: each is a function that returns its exports, after those that it imports."""
    imports = {name: [f"{other}.js" for _, other in _IMPORT.findall(text)] for name, text in modules.items()}
    parts = []
    for name in TopologicalSorter(imports).static_order():
        text = _IMPORT.sub(lambda found: f"const {found[1] or '{}'} = module_{found[2]};", modules[name])
        text = _EXPORT.sub(r"\1 \2", text)
        exports = ", ".join(name for _, name in _EXPORT.findall(modules[name]))
        parts.append(f"const module_{name.removesuffix('.js')} = (() => {{\n{text}return {{ {exports} }};\n}})();\n")
    return "".join(parts)


def _buttons(kind: str, words: dict[str, str]) -> str:
    return "".join(
        f'<button type="button" data-{kind}="{escape(name)}">{escape(label)}</button>' for name, label in words.items()
    )


class _File(_Guarded):
    """Page, or a file of it."""

    def get(self, name: str = "page.html") -> None:
        files = self.settings["files"]
        if name not in files:
            raise HTTPError(404)
        kind, content = files[name]
        self.set_header("Content-Type", kind)
        self.write(content)

    head = get


class PageSockets:
    """Sockets of a server: those with a page, and those that wait for one, oldest first."""

    def __init__(self) -> None:
        self.pages: set[PageSocket] = set()
        self._waiting: dict[PageSocket, None] = {}

    def connect(self, connection: PageSocket) -> None:
        """Add a socket without a page, and close the oldest beyond the limit."""
        self._waiting[connection] = None
        if len(self._waiting) > MAX_SESSIONS:
            oldest = next(iter(self._waiting))
            del self._waiting[oldest]
            oldest.close()

    def admit(self, connection: PageSocket) -> bool:
        """Count the page of a socket; return False if too many are open, of all or of its network address.

        The loopback address, of this machine and of a proxy on it, may hold all of them.
        """
        address = str(connection.request.remote_ip)
        same = sum(page.request.remote_ip == address for page in self.pages)
        most = MAX_SESSIONS if ip_address(address).is_loopback else MAX_PER_ADDRESS
        if len(self.pages) >= MAX_SESSIONS or same >= most:
            return False
        self._waiting.pop(connection, None)
        self.pages.add(connection)
        return True

    def leave(self, connection: PageSocket) -> None:
        """Forget a closed socket."""
        self._waiting.pop(connection, None)
        self.pages.discard(connection)


class PageSocket(_Guarded, WebSocketHandler):
    """Connection of one browser, and its page from the first request to the end of the connection."""

    page: Page | None = None

    def open(self, *args: str, **kwargs: str) -> None:
        self._credit, self._last, self._thread = _BURST, time.monotonic(), PageThread()
        self._sent: asyncio.Future[None] | None = None
        self.settings["sockets"].connect(self)

    def prepare(self) -> None:
        super().prepare()
        if not self.check_origin(self.request.headers.get("Origin", f"//{self.request.host}")):
            raise HTTPError(403)  # before Tornado reads it, which fails for a malformed origin

    def check_origin(self, origin: str) -> bool:
        return self.settings["names"].trust(origin, self.request.host)

    def get_compression_options(self) -> dict[str, Any]:
        return {"compression_level": 1, "mem_level": 5}  # of little time and memory

    async def on_message(self, message: str | bytes) -> None:
        """Handle one request; the next is not read before, so that a flood waits in its own browser."""
        await self._wait_for_turn()
        request = read_request(message)
        if request is None or self.close_code is not None:
            return
        PageThread.current.set(self._thread)
        if request["do"] == "ping":
            self._write(_PONG)
        elif self.page is not None:
            self.page.channel.receive(request)
        elif request["do"] == "open":
            self._open_page(request)

    def _open_page(self, request: dict[str, Any]) -> None:
        if not self.settings["sockets"].admit(self):
            words = f"{len(self.settings['sockets'].pages)} pages are open here already: try again later"
            self._write(json.dumps({"n": request["n"], "question": 0, "#trouble": alert(words)}))
            return
        origin = self.request.headers.get("Origin", "")  # `check_origin` knows this name
        self.page = Page(str(request.get("query", "")), self._write, request["n"], origin, self.settings["logo"])

    async def _wait_for_turn(self) -> None:
        """Wait until this browser has read its last answer and its rate is within the limit; let others go first."""
        now = time.monotonic()
        self._credit = min(_BURST, self._credit + _RATE * (now - self._last)) - 1.0
        self._last = now
        await asyncio.sleep(max(0.0, -self._credit / _RATE))
        if self._sent is not None:
            with suppress(WebSocketClosedError):
                await self._sent

    def _write(self, text: str) -> None:
        with suppress(WebSocketClosedError):
            self._sent = self.write_message(text)
            self._sent.add_done_callback(lambda sent: sent.cancelled() or sent.exception())

    def on_close(self) -> None:
        self.settings["sockets"].leave(self)
        self._thread.close()
        if self.page is not None:
            self.page.leave()


def explorer(names: Iterable[str], logo: Path | None = None) -> Application:
    """Return the application that answers to the given host names; its client view and its reports have the logo."""
    address = "" if logo is None else logo_address(logo)
    return Application(
        [("/", _File), (r"/assets/([\w.]+)", _File), ("/socket", PageSocket)],
        default_handler_class=_Missing,
        names=HostNames(names),
        files=page_files(address),
        logo=address,
        sockets=PageSockets(),
        compress_response=True,
        log_function=lambda handler: None,  # an address holds a joint
        websocket_max_message_size=_MAX_MESSAGE,
        websocket_ping_interval=_PING_INTERVAL,
        websocket_ping_timeout=_PING_INTERVAL,
    )


class ExplorerServer:
    """HTTP server of an application, bound to its port."""

    def __init__(self, application: Application, sockets: list[socket.socket], show: bool, link: str) -> None:
        self.io_loop: Any = IOLoop.current()
        self.port = int(sockets[0].getsockname()[1])
        self.application = application
        self._sockets, self._show, self._link = sockets, show, link
        self._server = HTTPServer(
            application, max_buffer_size=_MAX_MESSAGE, max_body_size=_MAX_MESSAGE, idle_connection_timeout=60.0
        )

    @property
    def pages(self) -> list[Page]:
        return [connection.page for connection in self.application.settings["sockets"].pages if connection.page]

    def start(self) -> None:
        """Accept connections while the loop runs."""
        self._server.add_sockets(self._sockets)
        if self._show:
            webbrowser.open(f"http://{LOOPBACK}:{self.port}/{self._link}")

    def stop(self) -> None:
        """Close the port and the pages."""
        self._server.stop()
        for connection in list(self.application.settings["sockets"].pages):
            connection.on_close()
        WORKERS.close()


def server(
    port: int = 5006,
    address: str = LOOPBACK,
    origins: Sequence[str] = (),
    show: bool = False,
    link: str = "",
    logo: Path | None = None,
) -> ExplorerServer:
    """Set up the server without starting it; port 0 takes a free one.

    Other machines reach it only if `address` is not the loopback. `origins` are hosts under which browsers may reach
    it, such as "hips.example.org:5006", beside this machine's own names. `show` opens a browser at the query `link`,
    "?...". `logo` is a picture, PNG or SVG, on top of the client view and of reports. Raises ValueError for an invalid
    port, address or logo, and OSError if the port is taken or the logo cannot be read.
    """
    require("port", port, 0 <= port <= 65535, "a port is 0 to 65535")
    try:
        socket.getaddrinfo(address, None)
    except (OSError, UnicodeError) as error:
        rule = "this machine has no interface with this address"
        raise ValueError(f"address = {shown(address)} is not allowed: {rule}") from error
    sys.setswitchinterval(_SWITCH_INTERVAL)
    threadpool_limits(1)  # a press has small matrices: threads cost more time than they save
    _allow_many_connections()
    sockets = bind_sockets(port, address)
    pressed(START.file, (START.answered_by, *START.shown))  # load at the start what the first press would load
    port = int(sockets[0].getsockname()[1])
    own_hosts = [f"{name}:{port}" for name in dict.fromkeys((LOOPBACK, "localhost", address))]
    return ExplorerServer(explorer((*own_hosts, *origins), logo), sockets, show, link)


def _allow_many_connections() -> None:
    """Raise the limit of open files as far as this user may: each connection is one."""
    try:
        import resource
    except ImportError:  # no such limit on this system
        return
    _, hard_limit = resource.getrlimit(resource.RLIMIT_NOFILE)
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard_limit, hard_limit))
