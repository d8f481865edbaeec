"""Many people at once: long work leaves the server free, and nothing is kept of those who left."""

import asyncio
import json
import os
from functools import partial, wraps
from pathlib import Path
from threading import Event

import pytest
from tornado.httpclient import HTTPRequest
from tornado.websocket import websocket_connect

from ballsocket.app import server as serve
from ballsocket.app.channel import Channel
from ballsocket.app.jobs import PageThread, run_in_thread

LINES = []
"""Open connections of a test."""


def in_loop(test):
    """Run a test in the loop of the server, and close the connections of its users."""

    @wraps(test)
    def run(served, **fixtures):
        try:
            served.io_loop.run_sync(partial(test, served, **fixtures), timeout=100)
        finally:
            while LINES:
                served.io_loop.run_sync(partial(close, LINES.pop()), timeout=100)

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
        """Ask, and return the answer."""
        await self.says(what, **words)
        while True:
            text = await asyncio.wait_for(self.line.read_message(), 100)
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
    for _ in range(6000):  # a minute: a machine may be slow
        if condition():
            return
        await asyncio.sleep(0.01)
    pytest.fail("it did not happen")


@in_loop
async def test_work_in_a_thread_does_not_hold_the_server(served):
    """Work that waits for the server to go on comes to its end."""
    went_on, found = Event(), []
    PageThread.current.set(PageThread())
    run_in_thread(lambda: went_on.wait(60), lambda outcome: found.append(outcome.result()))
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
    await asyncio.sleep(0.1)
    assert found == []


@in_loop
async def test_pages_take_turns_in_the_thread(served):
    """A page with much to draw lets another page draw after one of its drawings."""
    order, begin = [], Event()
    for name, count in (("many", 8), ("one", 1)):
        PageThread.current.set(PageThread())
        for _ in range(count):
            run_in_thread(lambda name=name: begin.wait(60) and order.append(name), lambda outcome: None)
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
    """Sockets that ask for nothing are not pages, and the oldest of them are closed when there are too many."""
    monkeypatch.setattr(serve, "MAX_SESSIONS", 2)
    silent = [await Someone(served).connect() for _ in range(4)]
    assert [await asyncio.wait_for(one.line.read_message(), 10) for one in silent[:2]] == [None, None]
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
    for _ in range(100):
        await Someone(served).connect()

    async def flood():
        for number in range(2000):
            await flooder.says("edit", name="load", value=1000 + number)
            await asyncio.sleep(0)  # both ends share this loop

    task = asyncio.ensure_future(flood())
    await until(lambda: len(handled) > 5)
    for force in range(2000, 2010):
        before.append(len(handled))
        await user.asks("edit", name="load", value=force)
        before[-1] = len(handled) - before[-1]
    task.cancel()
    flooder.line.close()
    assert max(before) <= 4


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the memory of a process is read from /proc")
@in_loop
async def test_further_pages_take_little_memory(served):
    """300 pages may take at most 100 MB more than the first."""

    def megabytes():
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

    for _ in range(3):
        await Someone(served).open()
    before = megabytes()
    for _ in range(60):
        await Someone(served).open()
    assert megabytes() - before < 100 * 60 / 300
