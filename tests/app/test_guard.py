"""Answers of the explorer's server to strangers and hostile messages, and to many people at once."""

import asyncio
import gzip
import itertools
import json
import re
from base64 import b64decode
from contextlib import closing, suppress
from functools import partial, wraps
from http.client import HTTPConnection
from pathlib import Path
from threading import Event
from unittest.mock import Mock
from urllib.parse import urlsplit

import psutil
import pytest
from tornado.httpclient import HTTPRequest
from tornado.websocket import WebSocketClosedError, websocket_connect

from ballsocket.app import server as serve
from ballsocket.app.channel import Channel
from ballsocket.app.jobs import PageThread, run_in_thread
from ballsocket.app.server import HostNames

from ..processes import PATIENCE
from ..refusals import text_tables
from .asking import read_message
from .browser import explorer_process

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
    """One user of a server, as the script of the page would be."""

    def __init__(self, served):
        self.address, self.number, self.shown = f"127.0.0.1:{served.port}", 0, {}

    async def connect(self):
        headers = {"Origin": f"http://{self.address}"}
        self.line = await websocket_connect(HTTPRequest(f"ws://{self.address}/socket", headers=headers))
        LINES.append(self.line)
        return self

    async def open(self):
        await self.connect()
        return await self.asks("open", query="")

    async def opened(self):
        await self.open()
        return self

    async def says(self, what, **words):
        self.number += 1
        await self.line.write_message(json.dumps({"n": self.number, "do": what, **words}))

    async def hears(self):
        text = await asyncio.wait_for(self.line.read_message(), PATIENCE)
        assert text is not None, "the server closed the connection"
        return read_message(text, self.shown)

    async def asks(self, what, **words):
        """Send a request, and return all that the server says until its answer, as one."""
        await self.says(what, **words)
        answer = {}
        while answer.get("n") != self.number:
            answer |= await self.hears()
        return answer

    async def moves_load(self):
        """Whether the page takes an edit."""
        return (await self.asks("edit", name="load", value=2900))["=load"]["value"] == 2900


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


STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}


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


def test_a_logo_is_a_picture_inside_the_page(tmp_path):
    logo = tmp_path / "logo.svg"
    logo.write_text("<svg xmlns='http://www.w3.org/2000/svg' onload='alert(1)'></svg>")
    (content,) = re.findall(r'<img class="logo" alt="" src="data:image/svg\+xml;base64,([^"]*)">', page_of(logo))
    assert b64decode(content) == logo.read_bytes()
    assert "<img" not in page_of(None)
    with pytest.raises(ValueError, match=r"must end in \.png or \.svg"):
        page_of(tmp_path / "logo.html")


def page_of(logo):
    return serve.explorer([], logo).settings["files"]["page.html"][1]


def test_files_are_compressed_and_are_sent_once(address):
    response, body = answer(address, "/assets/style.css", **{"Accept-Encoding": "gzip"})
    assert response.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(body) == answer(address, "/assets/style.css")[1]
    again, nothing = answer(address, "/assets/style.css", **{"If-None-Match": response.headers["ETag"]})
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
    upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Origin": origin or address.rstrip("/")}
    upgrade |= {"Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}
    status = answer(address, "/socket", **upgrade)[0].status
    assert status == (403 if origin in STRANGERS.split() else 101)


HOSTS = "hips.example.org", "any.example", "hips.example.com", "a.b.example.org"


@pytest.mark.parametrize(("name", "count"), [("*", 4), ("*.example.org:80", 1), ("hips.example.org:*", 1)])
def test_a_star_stands_for_any_part_of_a_name(name, count):
    for host in HOSTS:
        assert HostNames([name]).answer_to(host) == (host in HOSTS[:count])
        assert HostNames([name]).trust(f"http://{host}", "127.0.0.1") == (host in HOSTS[:count])


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
@pytest.mark.parametrize("binary", [False, True])
@in_loop
async def test_what_is_no_request_is_ignored(served, content, binary):
    user = await Someone(served).opened()
    await user.line.write_message(content, binary)
    assert await user.moves_load()


@in_loop
async def test_requests_before_the_first_page_are_ignored(served):
    user = await Someone(served).connect()
    await user.says("edit", name="load", value=2900)
    assert (await user.asks("open", query=""))["=load"]["value"] == 3000


@pytest.mark.parametrize("content", [b'"' + b"x" * 500_000 + b'"', b"{" + b" " * 3_000_000, b"\xff\xfe\xfd"])
@in_loop
async def test_a_message_that_is_too_large_or_no_text_ends_its_own_connection(served, content):
    user, other = await Someone(served).opened(), await Someone(served).opened()
    with suppress(WebSocketClosedError):  # closed while it is sent
        await user.line.protocol._write_frame(True, 1, content)  # as text, which need not be UTF-8
    while await asyncio.wait_for(user.line.read_message(), PATIENCE) is not None:
        pass
    assert await other.moves_load()


*_, REQUESTS = text_tables(Path(__file__).parent / "refused.txt")
REQUESTS = [json.loads(text) for (text,) in REQUESTS]
REQUESTS += [{"do": "edit", "name": name, "value": 1} for name in ("cup." + "x" * 10_000, "layer" + "9" * 5000)]
REQUESTS += [{"do": "upload", "text": "a=" + "[" * 90_000}, {"do": "open", "query": "x" * 100_000}]


@pytest.mark.parametrize("words", REQUESTS, ids=lambda words: f"{words['do']} {str(words.get('name', ''))[:12]}")
@in_loop
async def test_unknown_actions_and_values_get_a_sentence_that_shows_no_path(served, words):
    user = await Someone(served).opened()
    texts = await user.asks(words["do"], **{name: value for name, value in words.items() if name != "do"})
    while not (sentence := texts.get("#trouble") or texts.get("=load", {}).get("error")):
        texts |= await user.hears()
    assert "<p" in sentence or "stays in use" in sentence
    assert not any(word in sentence for word in ("Traceback", ".py", "site-packages"))
    assert await user.moves_load()


def megabytes(process=None):
    return psutil.Process(process).memory_info().rss / 1e6


@pytest.mark.long
def test_a_client_that_never_reads_does_not_grow_the_server():
    """Answers of the edits are many times the memory that the server may gain, and another user goes on."""
    with explorer_process() as (address, process):
        try:
            asyncio.run(edit_without_reading(urlsplit(address), process.pid))
        finally:
            LINES.clear()  # they end with this loop


async def edit_without_reading(parts, process):
    user, deaf, sent = await Someone(parts).opened(), await Someone(parts).opened(), []

    async def edit_often():
        for number in itertools.count():
            await deaf.says("edit", name="clearance", value=0.05 + 0.001 * (number % 100))
            sent.append(number)

    async def taken_during_ten_answers(first=0):
        before = len(sent)
        for number in range(first, first + 10):
            await user.asks("edit", name="clearance", value=0.05 + 0.001 * number)
        return len(sent) - before

    for first in range(0, 100, 10):
        await taken_during_ten_answers(first)  # caches fill first
    before, sender = megabytes(process), asyncio.ensure_future(edit_often())
    async with asyncio.timeout(PATIENCE):  # until the server takes no more, as all buffers on the way are full
        while not sent or await taken_during_ten_answers():
            await asyncio.sleep(0)
    assert await user.moves_load()
    assert megabytes(process) - before < 15
    sender.cancel()
    while LINES:
        line = LINES.pop()
        stream = line.protocol.stream
        line.close()
        stream.close()  # the deaf one waits for no farewell
    await asyncio.sleep(0.1)


@pytest.mark.long
@in_loop
async def test_a_thousand_idle_connections_leave_room_for_a_user(served):
    for _ in range(1000):
        await Someone(served).connect()
    assert await (await Someone(served).opened()).moves_load()


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
async def test_one_address_does_not_hold_all_pages_unless_it_is_this_machine(served, monkeypatch):
    monkeypatch.setattr(serve, "MAX_PER_ADDRESS", 1)
    assert "#press-numbers" in await Someone(served).open()
    assert "#press-numbers" in await Someone(served).open()
    sockets = serve.PageSockets()
    addresses = ("192.0.2.1", "192.0.2.1", "2001:db8::1", "127.0.0.2", "127.0.0.2", "::1", "::1")
    from_there = [Mock(**{"request.remote_ip": address}) for address in addresses]
    assert [sockets.admit(one) for one in from_there] == [True, False, *5 * [True]]


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
@in_loop
async def test_further_pages_take_little_memory(served):
    """300 pages may take at most 100 MB more than the first."""
    for _ in range(3):
        await Someone(served).open()
    before = megabytes()
    for _ in range(60):
        await Someone(served).open()
    assert megabytes() - before < 100 * 60 / 300
