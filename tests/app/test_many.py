"""Many people at once: what takes its time is done beside the server, and nothing is kept of those who left."""

import asyncio
import re
from threading import Event

import pytest

pytest.importorskip("panel", reason="the explorer's extra is not installed")
from panel.io.state import set_curdoc
from tornado.httpclient import AsyncHTTPClient, HTTPRequest
from tornado.websocket import websocket_connect

from ballsocket.app import server as serve
from ballsocket.app.jobs import run_in_thread
from ballsocket.app.server import OpenPages


async def session_of(served):
    """A page that a browser has asked for, and the token that its script would take leave with."""
    page = await AsyncHTTPClient().fetch(f"http://127.0.0.1:{served.port}/", request_timeout=100)
    (session,) = served.get_sessions("/")
    return session, re.findall('"token":"([^"]+)"', page.body.decode())[0]


def test_what_takes_long_does_not_hold_the_server(served):
    """Work that waits for the server to go on comes to its end."""
    went_on, found = Event(), []

    async def whole():
        session, _ = await session_of(served)
        with set_curdoc(session.document):
            run_in_thread(lambda: went_on.wait(60), lambda outcome: found.append(outcome.result()))
        await asyncio.sleep(0)
        went_on.set()
        while not found:
            await asyncio.sleep(0.01)

    served.io_loop.run_sync(whole, timeout=100)
    assert found == [True]


def test_work_for_a_page_that_was_closed_meanwhile_is_told_to_nobody(served):
    closed, found = Event(), []

    async def whole():
        session, _ = await session_of(served)
        with set_curdoc(session.document):
            run_in_thread(closed.wait, found.append)
            session.destroy()
            closed.set()
        await asyncio.sleep(0.1)

    served.io_loop.run_sync(whole, timeout=100)
    assert found == []


@pytest.mark.parametrize(("code", "kept"), [(1001, 0), (None, 1)])
def test_a_closed_page_is_forgotten_at_once_and_a_broken_line_is_waited_for(served, code, kept):
    async def whole():
        _, token = await session_of(served)
        request = HTTPRequest(f"ws://127.0.0.1:{served.port}/ws", headers={"Origin": f"http://127.0.0.1:{served.port}"})
        line = await websocket_connect(request, subprotocols=["bokeh", token])
        await line.read_message()
        if code is None:
            line.protocol.stream.close()
        line.close(code)
        for _ in range(130):
            await asyncio.sleep(0.01)
            if not served.get_sessions("/"):
                break

    served.io_loop.run_sync(whole, timeout=100)
    assert len(served.get_sessions("/")) == kept


def test_a_page_counts_when_its_browser_connects(served, monkeypatch):
    """A client without a WebSocket does not count as an open page."""
    before = len(serve._pages)  # of servers of other tests
    monkeypatch.setattr(serve, "MOST_SESSIONS", before + 1)
    monkeypatch.setattr(serve._pages, "max_waiting", 2)

    async def got():
        """Request a page; return it, and True for a refusal."""
        page = await AsyncHTTPClient().fetch(f"http://127.0.0.1:{served.port}/", request_timeout=100)
        shown = str(served.get_sessions("/")[-1].document.to_json())
        return page.body.decode(), f"{before + 1} pages are open here already" in shown

    async def whole():
        pages = [await got() for _ in range(4)]
        assert not any(refused for _, refused in pages)
        request = HTTPRequest(f"ws://127.0.0.1:{served.port}/ws", headers={"Origin": f"http://127.0.0.1:{served.port}"})
        line = await websocket_connect(
            request, subprotocols=["bokeh", *re.findall('"token":"([^"]+)"', pages[-1][0])[:1]]
        )
        await line.read_message()
        assert len(serve._pages) == before + 1
        assert (await got())[1]
        line.close(1001)
        for _ in range(300):
            await asyncio.sleep(0.01)
            if len(serve._pages) == before and len(served.get_sessions("/")) <= 3:
                break
        assert len(serve._pages) == before
        assert len(served.get_sessions("/")) <= 3  # of five, two wait still, beside the refusal

    served.io_loop.run_sync(whole, timeout=100)


def test_the_oldest_page_that_waits_is_forgotten_first():
    class Waiting:
        expired = False
        session = property(lambda self: self)

        def request_expiration(self):
            self.expired = True

    pages, contexts = OpenPages(max_waiting=2), [Waiting() for _ in range(3)]
    for number, context in enumerate(contexts):
        pages.add(str(number), context)
    assert [each.expired for each in contexts] == [True, False, False]
    assert len(pages) == 0
