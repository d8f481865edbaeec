"""Sessions of an explorer without a browser: the messages that its page exchanges with the server."""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections.abc import Iterator
from typing import Any, Protocol

_NUMBER = "data-name='max_pressure'"
_QUERY = "preset=hip-28"
_PATIENCE = 120


class Session(Protocol):
    """One user of an explorer."""

    async def open(self) -> None:
        """Open the page and wait for its numbers."""

    async def move(self, clearance: float) -> float:
        """Change the clearance (mm); return the seconds until the new numbers arrive."""

    async def flood(self, count: int) -> None:
        """Send messages without waiting for an answer."""

    async def connect(self) -> None:
        """Open a connection and send nothing."""

    def close(self) -> None:
        """Close the connection."""


class SocketSession:
    """Session of this explorer: JSON over one WebSocket."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._socket: Any = None
        self._last_request = 0

    async def connect(self) -> None:
        from tornado.httpclient import HTTPRequest
        from tornado.websocket import websocket_connect

        headers = {"Origin": self._address.rstrip("/")}
        request = HTTPRequest(
            f"{self._address.replace('http', 'ws', 1)}socket",
            headers=headers,
            connect_timeout=_PATIENCE,
            request_timeout=_PATIENCE,
        )
        self._socket = await websocket_connect(request)

    async def open(self) -> None:
        await self.connect()
        await self._send("open", query=_QUERY)
        await self._wait_for_number()

    async def move(self, clearance: float) -> float:
        start = time.perf_counter()
        await self._send("edit", name="clearance", value=clearance)
        await self._wait_for_number()
        return time.perf_counter() - start

    async def flood(self, count: int) -> None:
        from tornado.websocket import WebSocketClosedError

        try:
            for number in range(count):
                await self._send("edit", name="clearance", value=0.05 + 0.001 * (number % 100))
        except WebSocketClosedError:
            return  # a server may refuse the rest of a flood

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()

    async def _send(self, action: str, **words: Any) -> None:
        self._last_request += 1
        await self._socket.write_message(json.dumps({"n": self._last_request, "do": action, **words}))

    async def _wait_for_number(self) -> None:
        """Wait for a message that answers the last request with numbers."""
        while True:
            text = await asyncio.wait_for(self._socket.read_message(), _PATIENCE)
            if text is None:
                raise ConnectionError("the server closed a session")
            if _NUMBER in text and json.loads(text)["n"] >= self._last_request:
                return


class PanelSession:
    """Session of the explorer of version 1.0: the protocol of Bokeh over a WebSocket."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._socket: Any = None
        self._inbox, self._last_request = "", 0

    async def connect(self) -> None:
        """Open a TCP connection: a WebSocket of this server needs a page first."""
        host, _, port = self._address.rstrip("/").rpartition("/")[2].partition(":")
        _, self._socket = await asyncio.open_connection(host, int(port))

    async def open(self) -> None:
        from tornado.httpclient import AsyncHTTPClient, HTTPRequest
        from tornado.websocket import websocket_connect

        client = AsyncHTTPClient(max_clients=1000)
        page = await client.fetch(f"{self._address}?{_QUERY}", request_timeout=_PATIENCE)
        tokens = re.findall(r'"token":"([^"]+)"', page.body.decode())
        place, headers = f"{self._address.replace('http', 'ws', 1)}ws", {"Origin": self._address.rstrip("/")}
        request = HTTPRequest(place, headers=headers, connect_timeout=_PATIENCE, request_timeout=_PATIENCE)
        self._socket = await websocket_connect(request, subprotocols=["bokeh", tokens[0]])
        await self._receive()
        await self._send("PULL-DOC-REQ", {})
        while '"doc":' not in (document := await self._receive())[:20]:
            pass
        inboxes = [model["id"] for model in _models(json.loads(document)) if model["attributes"].get("name") == "asked"]
        if not inboxes:
            raise ConnectionError("the server refused a session")
        self._inbox = inboxes[0]
        ready = {"type": "event", "name": "document_ready", "values": {"type": "map"}}
        await self._patch({"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": ready})
        await self._wait_for_number()

    async def move(self, clearance: float) -> float:
        start = time.perf_counter()
        await self._edit(clearance)
        await self._wait_for_number()
        return time.perf_counter() - start

    async def flood(self, count: int) -> None:
        for number in range(count):
            await self._edit(0.05 + 0.001 * (number % 100))

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()

    async def _edit(self, clearance: float) -> None:
        self._last_request += 1
        words = json.dumps({"n": self._last_request, "do": "edit", "name": "clearance", "value": clearance})
        await self._patch({"kind": "ModelChanged", "model": {"id": self._inbox}, "attr": "value", "new": words})

    async def _wait_for_number(self) -> None:
        while _NUMBER not in await self._receive():
            pass

    async def _patch(self, event: dict[str, Any]) -> None:
        await self._send("PATCH-DOC", {"events": [event]})

    async def _send(self, kind: str, content: dict[str, Any]) -> None:
        for part in ({"msgid": str(time.time()), "msgtype": kind}, {}, content):
            await self._socket.write_message(json.dumps(part))

    async def _receive(self) -> str:
        """Return the content of the next message."""
        header = json.loads(await self._part())
        await self._part()
        content = await self._part()
        for _ in range(2 * header.get("num_buffers", 0)):
            await self._socket.read_message()
        return content

    async def _part(self) -> str:
        part = await asyncio.wait_for(self._socket.read_message(), _PATIENCE)
        if part is None:
            raise ConnectionError("the server closed a session")
        return str(part)


def _models(part: Any) -> Iterator[dict[str, Any]]:
    """List all models in a document of Bokeh."""
    if isinstance(part, dict) and isinstance(part.get("attributes"), dict):
        yield part
    for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from _models(inner)
