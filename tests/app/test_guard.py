"""Answers of the explorer's server to strangers and hostile messages, and to many people at once."""

import asyncio
import gzip
import itertools
import json
import os
import socket
import struct
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial, wraps
from http.client import HTTPConnection
from pathlib import Path
from threading import Event, Thread
from urllib.parse import quote, urlsplit

import pytest
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

from ballsocket.app import server as serve
from ballsocket.app.channel import Channel
from ballsocket.app.jobs import PageThread, run_in_thread
from ballsocket.app.server import HostNames
from ballsocket.app.state.screen import VIEWS

from ..processes import PATIENCE, wait_until
from .browser import explorer_process

_HANDSHAKE = (
    "GET /socket HTTP/1.1\r\nHost: {0}\r\nOrigin: {1}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
)
TEXT, BINARY, CLOSE = 1, 2, 8


class Wire:
    """Connection to the socket of an explorer."""

    def __init__(self, address, origin=None):
        parts = urlsplit(address)
        self._line = socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE)
        words = _HANDSHAKE.format(parts.netloc, origin or f"http://{parts.netloc}")
        self._line.sendall(words.encode())
        head = b""
        while not head.endswith(b"\r\n\r\n") and (byte := self._line.recv(1)):
            head += byte
        self.status = int(head.split()[1])

    def send(self, content, kind=TEXT):
        size = len(content)
        length = bytes([0x80 | size]) if size < 126 else b"\xff" + struct.pack(">Q", size)
        self._line.sendall(bytes([0x80 | kind]) + length + bytes(4) + content)

    def ask(self, number, action, **words):
        self.send(json.dumps({"n": number, "do": action, **words}).encode())

    def receive(self):
        """Return kind and content of the next frame; None at the end of the connection."""
        head = self._read(2)
        if head is None:
            return None
        size = head[1] & 127
        if size > 125:
            size = int.from_bytes(self._read(2 if size == 126 else 8), "big")
        return head[0] & 15, self._read(size)

    def answer(self, number):
        """Read messages until one answers a request; return all that they say, as one."""
        answer = {}
        while answer.get("n", 0) < number:
            frame = self.receive()
            assert frame is not None, "the server closed the connection"
            assert frame[0] != CLOSE, frame[1]
            if frame[0] == TEXT:  # not a ping
                answer |= json.loads(frame[1])
        return answer

    def is_closed(self):
        """Read until the server closes the connection."""
        with suppress(OSError):
            while (frame := self.receive()) is not None and frame[0] != CLOSE:
                pass
        return True

    def _read(self, size):
        content = b""
        while len(content) < size:
            if not (part := self._line.recv(size - len(content))):
                return None
            content += part
        return content

    def shut(self):
        """End the connection in both directions, also for a thread that waits for it."""
        with suppress(OSError):
            self._line.shutdown(socket.SHUT_RDWR)

    def close(self):
        self.shut()
        self._line.close()


@contextmanager
def opened_wire(address, query=""):
    with closing(Wire(address)) as wire:
        assert wire.status == 101
        wire.ask(1, "open", query=query)
        wire.answer(1)
        yield wire


STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
needs_proc = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from /proc")


def answer(address, path="/", method="GET", host=None, **headers):
    place = urlsplit(address)
    with closing(HTTPConnection(place.hostname, place.port, timeout=PATIENCE)) as connection:
        connection.request(method, path, headers=headers if host is None else {"Host": host, **headers})
        response = connection.getresponse()
        return response, response.read()


@pytest.mark.parametrize("host", ["evil.example", "evil.example:5006", "127.0.0.1.evil.example"])
@pytest.mark.parametrize("path", ["/", "/socket", "/assets/page.js", "/nothing"])
def test_names_that_are_not_ours_are_refused_and_our_own_are_answered(address, path, host):
    response, body = answer(address, path, host=host)
    assert response.status == 403
    assert body == b"this server does not answer to that name; see --origin\n"
    for own in ("localhost", "LOCALHOST:1", "127.0.0.1", "hips.example.org", "hips.example.org:8443"):
        assert answer(address, host=own)[0].status == 200


ANSWERS = ("GET", "/", 200), ("HEAD", "/", 200), ("GET", "/nothing", 404), ("GET", "/assets/page.js", 200)


@pytest.mark.parametrize(("method", "path", "status"), [*ANSWERS, ("GET", "/socket", 400)])
def test_every_answer_bids_browsers_be_strict(address, method, path, status):
    headers = (response := answer(address, path, method)[0]).headers
    assert response.status == status
    assert {name: headers[name] for name in STRICT} == STRICT
    assert "Server" not in headers
    rules = dict(rule.split(" ", 1) for rule in headers["Content-Security-Policy"].split("; "))
    assert rules["default-src"] == rules["base-uri"] == rules["frame-ancestors"] == "'none'"
    assert rules["script-src"] == rules["style-src"] == "'self'"
    assert "unsafe-eval" not in headers["Content-Security-Policy"]


def test_a_name_in_the_request_cannot_add_a_rule(address):
    response, _ = answer(address, host="localhost:1; script-src *")
    assert response.status in (400, 403)
    assert (response.headers["Content-Security-Policy"] or "").count("script-src") <= 1


def test_no_script_stands_in_the_page(address):
    _, body = answer(address)
    for script in body.decode().split("<script")[1:]:
        assert script.startswith(' type="module" src="assets/')
        assert script.partition(">")[2].startswith("</script>")
    assert b"style=" not in body


def test_files_are_compressed_and_are_sent_once(address):
    response, body = answer(address, "/assets/page.css", **{"Accept-Encoding": "gzip"})
    assert response.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(body) == answer(address, "/assets/page.css")[1]
    again, nothing = answer(address, "/assets/page.css", **{"If-None-Match": response.headers["ETag"]})
    assert (again.status, nothing) == (304, b"")


OTHERS = (
    "/components/this/x //components/this/x /assets/../components/this/x /assets/..%2f..%2fserver.py "
    "/assets/../../server.py /assets/server.py /assets/ /favicon.ico"
)


@pytest.mark.parametrize("path", OTHERS.split())
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_other_addresses_are_refused(address, path, method):
    response, body = answer(address, path, method)
    assert response.status in (404, 405)
    assert b"Traceback" not in body
    assert b"/" not in body


STRANGERS = "http://evil.example http://127.0.0.1:1 https://hips.example.org null http://["


@pytest.mark.parametrize("origin", [None, "https://hips.example.org:8443", *STRANGERS.split()])
def test_a_page_of_another_server_opens_no_socket(address, origin):
    with closing(Wire(address, origin)) as wire:
        assert wire.status == (403 if origin in STRANGERS.split() else 101)


HOSTS = "hips.example.org", "any.example", "hips.example.com", "a.b.example.org"


@pytest.mark.parametrize(("name", "count"), [("*", 4), ("*.example.org:80", 1), ("hips.example.org:*", 1)])
def test_a_star_stands_for_any_part_of_a_name(name, count):
    for host in HOSTS:
        assert HostNames([name]).answer_to(host) == (host in HOSTS[:count])
        assert HostNames([name]).trust(f"http://{host}", "127.0.0.1") == (host in HOSTS[:count])


def moves_load(wire, number=2):
    """Whether a page takes an edit."""
    wire.ask(number, "edit", name="load", value=2900)
    return wire.answer(number)["=load"]["value"] == 2900


@pytest.mark.parametrize(
    "content",
    [
        *b'|[]|{|{"do": 3, "n": 1}|{"do": "edit"}'.split(b"|"),
        b"[" * 100_000,
        b'"' + b"x" * 390_000,
        b'{"n": 2, "do": "edit", "name": "load", "value": ' + b"[" * 50_000 + b"]" * 50_000 + b"}",
        b'{"n": 1e999, "do": "edit"}',
        b'{"n": NaN, "do": "edit", "name": "load", "value": NaN}',
    ],
    ids=lambda content: content[:22].decode(),
)
@pytest.mark.parametrize("kind", [TEXT, BINARY])
def test_what_is_no_request_is_ignored(address, content, kind):
    with opened_wire(address) as wire:
        wire.send(content, kind)
        assert moves_load(wire)


def test_requests_before_the_first_page_are_ignored(address):
    with closing(Wire(address)) as wire:
        wire.ask(1, "edit", name="load", value=2900)
        wire.ask(2, "open", query="")
        assert wire.answer(2)["=load"]["value"] == 3000


@pytest.mark.parametrize("content", [b'"' + b"x" * 500_000 + b'"', b"{" + b" " * 3_000_000, b"\xff\xfe\xfd"])
def test_a_message_that_is_too_large_or_no_text_ends_its_own_connection(address, content):
    with opened_wire(address) as wire, opened_wire(address) as other:
        with suppress(OSError):  # closed while it is sent
            wire.send(content)
        assert wire.is_closed()
        assert moves_load(other)


@pytest.mark.parametrize(
    "words",
    [
        {"do": "__init__"},
        {"do": "edit", "name": "__class__", "value": "x"},
        {"do": "leave"},
        {"do": "edit", "name": "theme", "value": "dark"},
        {"do": "edit", "name": "press.shown", "value": "exact"},
        {"do": "view", "value": ["press"]},
        {"do": "edit", "name": "load.__class__", "value": 1},
        {"do": "edit", "name": "cup." + "x" * 10_000, "value": 1},
        {"do": "edit", "name": "load", "value": {"deep": [1e400, None]}},
        {"do": "edit", "name": "load", "value": 1e308},
        {"do": "edit", "name": ["load"], "value": 1},
        {"do": "edit", "name": "load", "value": "\ud800"},
        {"do": "edit", "name": "\ud800", "value": 1},
        {"do": "edit", "name": "layer" + "9" * 5000, "value": 1},
        {"do": "upload", "text": 3},
        {"do": "upload", "text": "a=" + "[" * 90_000},
        {"do": "open", "query": "x" * 100_000},
        {"do": "open", "query": ["no text"]},
        {"do": "save", "kind": "../../etc/passwd"},
    ],
    ids=lambda words: f"{words['do']} {str(words.get('name', ''))[:12]}",
)
def test_unknown_actions_and_values_get_a_sentence_that_shows_no_path(address, words):
    with opened_wire(address) as wire:
        wire.send(json.dumps({"n": 2, **words}).encode())
        texts = wire.answer(2)
        while not (sentence := texts.get("#trouble") or texts.get("=load", {}).get("error")):
            texts |= json.loads(wire.receive()[1])
        assert "<p" in sentence or "stays in use" in sentence
        assert not any(word in sentence for word in ("Traceback", ".py", "site-packages"))
        assert moves_load(wire, 3)


def megabytes(process="self"):
    return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


@pytest.mark.long
@needs_proc
def test_a_client_that_never_reads_does_not_grow_the_server():
    """Answers of the edits are many times the memory that the server may gain, and another user goes on."""
    sent = []

    def edit(wire, number):
        wire.ask(number, "edit", name="clearance", value=0.05 + 0.001 * (number % 100))

    def edit_often():
        with suppress(OSError):  # the connection ends
            for number in range(2, 3002):
                edit(deaf, number)
                sent.append(number)

    def edit_with_answers(numbers):
        for number in numbers:
            edit(user, number)
            user.answer(number)

    def takes_no_more():
        """Whether none of the edits was taken while another user had ten answers."""
        before, first = len(sent), next(tens)
        edit_with_answers(range(first, first + 10))
        return before == len(sent) > 0

    with explorer_process() as (address, process), opened_wire(address) as user, opened_wire(address) as deaf:
        edit_with_answers(range(2, 102))  # caches fill first
        before, tens = megabytes(process.pid), itertools.count(102, 10)
        sender = Thread(target=edit_often)
        sender.start()
        wait_until(takes_no_more)
        assert moves_load(user, next(tens))
        assert megabytes(process.pid) - before < 15
        deaf.shut()
        sender.join()


@pytest.mark.long
def test_a_thousand_idle_connections_leave_room_for_a_user(address):
    with ExitStack() as stack:
        for _ in range(1000):
            stack.callback(Wire(address).close)
        assert moves_load(stack.enter_context(opened_wire(address)))


_SCRIPT = "<img src=x onerror='window.ran=1'><script>window.ran=1</script>"


@pytest.mark.long
@pytest.mark.parametrize("view", VIEWS)
def test_script_in_names_is_text_in_every_view(examiner, view):
    joint = f"name={quote(_SCRIPT)}&joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=pom"
    other = "&".join(f"beside1.{part}" for part in joint.split("&"))
    page = examiner.open(f"?view={view}&{joint}&{other}").page
    assert page.evaluate("window.ran") is None
    assert page.locator("img[src=x]").count() == 0


LINES = []
"""Open connections of a test."""


def in_loop(test):
    """Run a test in the loop of the server, and close the connections of its users."""

    @wraps(test)
    def run(served, **fixtures):
        try:
            served.io_loop.run_sync(partial(test, served, **fixtures), timeout=PATIENCE)
        finally:
            while LINES:
                served.io_loop.run_sync(partial(close, LINES.pop()), timeout=PATIENCE)

    return run


class Someone:
    """One user, as the script of the page would be."""

    def __init__(self, served):
        self.address, self.number = f"127.0.0.1:{served.port}", 0

    async def connect(self):
        headers = {"Origin": f"http://{self.address}"}
        self.line = await websocket_connect(HTTPRequest(f"ws://{self.address}/socket", headers=headers))
        LINES.append(self.line)
        return self

    async def open(self):
        await self.connect()
        return await self.asks("open", query="")

    async def says(self, what, **words):
        self.number += 1
        await self.line.write_message(json.dumps({"n": self.number, "do": what, **words}))

    async def asks(self, what, **words):
        await self.says(what, **words)
        while True:
            text = await asyncio.wait_for(self.line.read_message(), PATIENCE)
            assert text is not None, "the server closed the connection"
            message = json.loads(text)
            if message.get("n") == self.number:
                return message


async def close(line):
    """Close a connection, and wait until its socket is closed; one that a test has closed has no protocol."""
    if line.protocol is not None:
        stream = line.protocol.stream
        line.close()
        await until(stream.closed)


async def until(condition):
    async with asyncio.timeout(PATIENCE):
        while not condition():
            await asyncio.sleep(0.01)


@in_loop
async def test_work_in_a_thread_does_not_hold_the_server(served):
    went_on, found = Event(), []
    PageThread.current.set(PageThread())
    run_in_thread(lambda: went_on.wait(), lambda outcome: found.append(outcome.result()))
    await asyncio.sleep(0)
    went_on.set()
    await until(lambda: found)
    assert found == [True]


@in_loop
async def test_work_for_a_page_that_was_closed_meanwhile_is_dropped(served):
    closed, found, thread = Event(), [], PageThread()
    PageThread.current.set(thread)
    for _ in range(3):
        run_in_thread(closed.wait, found.append)
    thread.close()
    closed.set()
    PageThread.current.set(PageThread())
    run_in_thread(lambda: None, found.append)  # later than the others, in the same thread
    await until(lambda: found)
    assert len(found) == 1


@in_loop
async def test_pages_take_turns_in_the_thread(served):
    """A page with much to draw lets another page draw after one of its drawings."""
    order, begin = [], Event()
    for name, count in (("many", 8), ("one", 1)):
        PageThread.current.set(PageThread())
        for _ in range(count):
            run_in_thread(lambda name=name: begin.wait() and order.append(name), lambda outcome: None)
    for _ in range(8):
        run_in_thread(lambda: None, lambda outcome: None)
    with pytest.raises(ValueError, match="8 drawings of this page wait already"):
        run_in_thread(lambda: None, lambda outcome: None)
    begin.set()
    await until(lambda: len(order) >= 9)
    assert order[:2] == ["many", "one"]


@pytest.mark.parametrize("broken", [False, True])
@in_loop
async def test_a_closed_page_is_forgotten_at_once(served, broken):
    user, stopped = Someone(served), []
    await user.open()
    assert len(served.pages) == 1
    served.pages[0].view.leave = lambda: stopped.append(True)
    (user.line.protocol.stream if broken else user.line).close()
    await until(lambda: not served.pages)
    assert stopped == [True]


@in_loop
async def test_a_page_counts_when_its_browser_asks_for_it(served, monkeypatch):
    monkeypatch.setattr(serve, "MAX_SESSIONS", 2)
    silent = [await Someone(served).connect() for _ in range(4)]
    assert [await asyncio.wait_for(one.line.read_message(), PATIENCE) for one in silent[:2]] == [None, None]
    for user in silent[2:]:
        assert "#press-numbers" in await user.asks("open", query="")
    assert "2 pages are open here already: try again later" in (await Someone(served).open())["#trouble"]
    assert len(served.pages) == 2
    silent[2].line.close()
    await until(lambda: len(served.pages) == 1)
    assert "#press-numbers" in await Someone(served).open()


@in_loop
async def test_a_flood_of_requests_holds_up_its_sender_alone(served, monkeypatch):
    """While 2000 requests of one browser and many silent sockets wait, another user's request is among the next."""
    handled, before = [], []
    receive = Channel.receive
    monkeypatch.setattr(Channel, "receive", lambda self, words: handled.append(words["n"]) or receive(self, words))
    flooder, user = Someone(served), Someone(served)
    await flooder.open()
    await user.open()
    for _ in range(15):
        await Someone(served).connect()

    async def flood():
        for number in range(2000):
            await flooder.says("edit", name="load", value=1000 + number)
            await asyncio.sleep(0)  # both ends share this loop

    task = asyncio.ensure_future(flood())
    await until(lambda: len(handled) > 5)
    for force in range(2000, 2006):
        before.append(len(handled))
        await user.asks("edit", name="load", value=force)
        before[-1] = len(handled) - before[-1]
    task.cancel()
    flooder.line.close()
    assert max(before) <= 4


@pytest.mark.long
@needs_proc
@in_loop
async def test_further_pages_take_little_memory(served):
    """300 pages may take at most 100 MB more than the first."""
    for _ in range(3):
        await Someone(served).open()
    before = megabytes()
    for _ in range(60):
        await Someone(served).open()
    assert megabytes() - before < 100 * 60 / 300
