"""A browser, a running explorer, a line that fails, and somebody at the page; without a browser these tests skip."""

import asyncio
import os
import re
import shutil
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from threading import Event, Thread
from urllib.parse import parse_qs, urlsplit

import pytest

import ballsocket as bs

from ..processes import PATIENCE, wait_until

PICTURES = os.environ.get("BALLSOCKET_SCREENSHOTS")
"""Folder for pictures of the pages; None keeps none."""

WIDE, NARROW = 1280, 390
WAIT = 1000 * PATIENCE
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
BROWSERS = ("chromium-headless-shell", "chromium", "google-chrome")  # the first takes a fifth less processor time
NEEDED = os.environ.get("BALLSOCKET_BROWSER") == "needed"
"""Set where a browser must be there: then nothing is skipped."""


def script(name):
    """A function of JavaScript that a page evaluates."""
    return (Path(__file__).parent / "scripts" / name).read_text("utf-8")


def skip_or_fail(reason):
    (pytest.fail if NEEDED else pytest.skip)(reason)


@contextmanager
def opened_browser():
    """A browser; outside of this function the event loop of Playwright does not count as running."""
    try:
        from playwright.sync_api import expect, sync_playwright
    except ImportError:
        skip_or_fail("playwright is not installed: pip install '.[browser]'")
    path = os.environ.get("BALLSOCKET_CHROMIUM") or next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        skip_or_fail("no chromium")
    expect.set_options(timeout=WAIT)
    with sync_playwright() as tools:
        loop = asyncio.get_running_loop()
        browser = tools.chromium.launch(executable_path=path, args=ARGUMENTS, timeout=WAIT)
        yield browser
        asyncio._set_running_loop(loop)
        browser.close()


_SERVE = """
import os, signal, threading
def end_with_tests():
    while os.read(0, 1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)
threading.Thread(target=end_with_tests, daemon=True).start()
from ballsocket.cli import main
main()
"""
"""Command that also ends at the end of its input, thus with the process of the tests, even if that is killed."""


@contextmanager
def explorer_process(*words):
    command = [sys.executable, "-c", _SERVE, "app", "--no-browser", "--port", "0", *words]
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    process = subprocess.Popen(command, **streams, encoding="utf-8")
    try:
        lines = []
        for line in process.stdout:
            lines.append(line)
            if match := re.match(r"(http://\S+/) \(Ctrl-C", line):
                break
        else:
            pytest.fail(f"the explorer did not start: {''.join(lines)}")
        yield match[1], process
    finally:
        process.terminate()
        process.communicate(timeout=PATIENCE)


def pressure(preset="hip-28", force=3000.0, **changes):
    return float(bs.Exact().press(replace(bs.joints[preset], **changes), force=force).max_pressure)


def expect(locator):
    from playwright.sync_api import expect

    return expect(locator)


@contextmanager
def opened_profile(browser, address, width=WIDE, dark=False, **more):
    look = {"viewport": {"width": width, "height": 900}, "color_scheme": "dark" if dark else "light"}
    profile = browser.new_context(**look, accept_downloads=True, **more)
    profile.grant_permissions(["clipboard-read", "clipboard-write"], origin=address)
    profile.set_default_timeout(WAIT)
    yield profile
    profile.close()


class User:
    """One browser window, which notes every request and every error of the page."""

    def __init__(self, profile, address):
        self.page, self.address = profile.new_page(), address
        self.requests, self.errors = [], []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))

    def open(self, query=""):
        self.page.goto(self.address + query)
        return self.answered()

    def answered(self):
        """Wait until the page is complete, and nothing that was asked is on its way."""
        self.page.locator(".app[data-idle=yes][data-shown]:not([data-lost], :has([data-expected]))").wait_for()
        return self

    def number(self, name):
        return float(self.page.locator(f"dd[data-name='{name}']").get_attribute("data-value"))

    def shows(self, name, value):
        return wait_until(lambda: self.number(name) == pytest.approx(value, rel=1e-9))

    def until(self, condition):
        """Wait until an expression in the page is true; the page's own policy forbids to evaluate text inside it."""
        wait_until(lambda: self.page.evaluate(condition))

    def nudge(self, slider, key="ArrowRight", times=1):
        handle = self.page.locator(f"[data-name='{slider}'] input[type=range]")
        handle.focus()
        for _ in range(times):
            handle.press(key)

    def drags(self, handle, *moves):
        """Drag a handle from its middle over some points, each relative to the one before."""
        box = self.page.locator(handle).bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        for across, down in moves:
            x, y = x + across, y + down
            self.page.mouse.move(x, y, steps=4)
        self.page.mouse.up()
        return self.answered()

    def view(self, title):
        self.page.locator("nav button", has_text=title).click()
        self.answered()

    def types(self, name, text):
        box = self.page.locator(f"[data-name='{name}'] input[type=text]")
        box.fill(text)
        box.press("Enter")
        return box

    def enters(self, name, text):
        box = self.types(name, text)
        self.answered()
        return box

    def says(self, words):
        self.page.locator(f"text={words}").first.wait_for()
        return True

    def link(self):
        query = parse_qs(urlsplit(self.page.url).query, keep_blank_values=True)
        return {name: values[0] for name, values in query.items()}

    def saves(self, button, path):
        """Take the file that a button offers under the name of a path."""
        with self.page.expect_download() as coming:
            self.page.locator(button).click()
        assert coming.value.suggested_filename == path.name
        coming.value.save_as(path)


AT_REST = script("at_rest.js")
"""The width of what is on the page, once nothing was asked or changed for twenty frames."""


class Proxy:
    """Proxy on its own port, with threads of its own; `delay` is the latency in s towards the browser."""

    def __init__(self, target):
        self._target, self._lines, self.delay = target, set(), 0.0
        self._open = Event()
        self._open.set()
        self._port = socket.create_server(("127.0.0.1", 0))
        self.address = f"http://127.0.0.1:{self._port.getsockname()[1]}/"
        Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        with suppress(OSError):  # at its end
            while True:
                Thread(target=self._connect, args=self._port.accept()[:1], daemon=True).start()

    def _connect(self, browser):
        self._open.wait()
        try:
            server = socket.create_connection(("127.0.0.1", self._target))
        except OSError:
            browser.close()
            return
        self._lines |= {browser, server}
        Thread(target=self._copy, args=(browser, server, False), daemon=True).start()
        self._copy(server, browser, True)

    def _copy(self, source, sink, late):
        with suppress(OSError):  # of a line that is cut
            while data := source.recv(65536):
                time.sleep(late * self.delay)
                self._open.wait()
                sink.sendall(data)
        self._shut(sink)

    @staticmethod
    def _shut(line):
        with suppress(OSError):
            line.shutdown(socket.SHUT_RDWR)

    def stop(self):
        """Stop all data without closing a connection, as a network without signal does."""
        self._open.clear()

    def go_on(self):
        self._open.set()

    def cut(self):
        """Close all connections; new ones wait until `go_on`."""
        self.stop()
        for line in list(self._lines):
            self._shut(line)

    def end(self):
        """Close the port and all connections."""
        self._shut(self._port)
        self.cut()
        self.go_on()
        for line in (self._port, *self._lines):
            line.close()


@contextmanager
def opened_proxy(address):
    proxy = Proxy(int(address.rstrip("/").rpartition(":")[2]))
    try:
        yield proxy
    finally:
        proxy.end()


@contextmanager
def opened_line(browser, address):
    """Somebody with an open page, behind a proxy of their own; the page has no error."""
    with opened_proxy(address) as proxy, opened_profile(browser, proxy.address) as profile:
        user = User(profile, proxy.address).open()
        yield proxy, user
        assert not user.errors
