"""TCP proxy between a browser and the explorer, which delays, stops or cuts connections."""

import asyncio
from contextlib import contextmanager, suppress
from threading import Event, Thread


class Proxy:
    """Proxy on its own port, in a thread of its own; `delay` is the latency in s towards the browser."""

    def __init__(self, target):
        self._target, self._ready = target, Event()
        self._lines, self._tasks = set(), set()
        self.delay = 0.0
        self._thread = Thread(target=lambda: asyncio.run(self._serve()))
        self._thread.start()
        self._ready.wait(timeout=60)

    async def _serve(self):
        self._loop = asyncio.get_running_loop()
        self._open, self._end = asyncio.Event(), asyncio.Event()
        self._open.set()
        server = await asyncio.start_server(self._connect, "127.0.0.1", 0)
        self.address = f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}/"
        self._ready.set()
        await self._end.wait()
        server.close()
        for line in self._lines:
            line.transport.abort()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def _connect(self, reader, writer):
        task = asyncio.ensure_future(self._relay(reader, writer))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _relay(self, reader, writer):
        await self._open.wait()
        try:
            server_reader, server_writer = await asyncio.open_connection("127.0.0.1", self._target)
        except OSError:
            writer.close()
            return
        lines = {writer, server_writer}
        self._lines |= lines
        with suppress(OSError):
            await asyncio.gather(self._copy(reader, server_writer), self._copy(server_reader, writer, late=True))
        self._lines -= lines

    async def _copy(self, reader, writer, late=False):
        """Copy in order; each piece of data to the browser waits for the delay."""
        waiting = asyncio.Queue()

        async def send():
            while (item := await waiting.get()) is not None:
                moment, data = item
                await asyncio.sleep(max(0.0, moment - self._loop.time()))
                await self._open.wait()
                writer.write(data)
                await writer.drain()
            writer.close()

        sender = asyncio.ensure_future(send())
        while data := await reader.read(65536):
            waiting.put_nowait((self._loop.time() + late * self.delay, data))
        waiting.put_nowait(None)
        await sender

    def stop(self):
        """Stop all data without closing a connection, as a network without signal does."""
        self._loop.call_soon_threadsafe(self._open.clear)

    def go_on(self):
        """Let all data pass again."""
        self._loop.call_soon_threadsafe(self._open.set)

    def cut(self):
        """Close all connections; new ones wait until `go_on`."""
        self.stop()
        for line in list(self._lines):
            self._loop.call_soon_threadsafe(line.transport.abort)

    def end(self):
        """Close the port and all connections."""
        self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join()


@contextmanager
def opened_proxy(address):
    """Proxy for the explorer at an address."""
    proxy = Proxy(int(address.rstrip("/").rpartition(":")[2]))
    try:
        yield proxy
    finally:
        proxy.end()
