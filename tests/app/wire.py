"""WebSocket client of a few lines, which sends what no browser would, and reads only when told to."""

import json
import socket
import struct
from contextlib import closing, contextmanager, suppress
from urllib.parse import urlsplit

_HANDSHAKE = (
    "GET /socket HTTP/1.1\r\nHost: {0}\r\nOrigin: {1}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
)
TEXT, BINARY, CLOSE = 1, 2, 8


class Wire:
    """Connection to the socket of an explorer."""

    def __init__(self, address, origin=None):
        parts = urlsplit(address)
        self._line = socket.create_connection((parts.hostname, parts.port), timeout=60)
        words = _HANDSHAKE.format(parts.netloc, origin or f"http://{parts.netloc}")
        self._line.sendall(words.encode())
        head = b""
        while not head.endswith(b"\r\n\r\n") and (byte := self._line.recv(1)):
            head += byte
        self.status = int(head.split()[1])

    def send(self, content, kind=TEXT):
        """Send one frame."""
        size = len(content)
        length = bytes([0x80 | size]) if size < 126 else b"\xff" + struct.pack(">Q", size)
        self._line.sendall(bytes([0x80 | kind]) + length + bytes(4) + content)

    def ask(self, number, action, **words):
        """Send one request of a page."""
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
    """Connection with an open page."""
    with closing(Wire(address)) as wire:
        assert wire.status == 101
        wire.ask(1, "open", query=query)
        wire.answer(1)
        yield wire
