"""A browser and a running explorer for tests; on a machine without a browser these tests skip."""

import asyncio
import os
import re
import shutil
import subprocess
import sys
from contextlib import contextmanager

import pytest

from .user import WAIT

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
NEEDED = os.environ.get("BALLSOCKET_BROWSER") == "needed"
"""Set where a browser must be there: then nothing is skipped."""


def skip_or_fail(reason):
    """Skip a test for want of a program; fail where the program is needed."""
    (pytest.fail if NEEDED else pytest.skip)(reason)


@contextmanager
def opened_browser():
    """A browser; outside of this function the event loop of Playwright does not count as running."""
    try:
        from playwright.sync_api import expect, sync_playwright
    except ImportError:
        skip_or_fail("playwright is not installed: pip install '.[browser]'")
    path = os.environ.get("BALLSOCKET_CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    if path is None:
        skip_or_fail("no chromium")
    expect.set_options(timeout=WAIT)
    with sync_playwright() as tools:
        loop = asyncio.get_running_loop()
        browser = tools.chromium.launch(executable_path=path, args=ARGUMENTS)
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
def served_explorer(*words):
    """The address of an explorer in a process of its own."""
    with explorer_process(*words) as (address, _):
        yield address


@contextmanager
def explorer_process(*words):
    """The address of an explorer, and its process."""
    process = subprocess.Popen(
        [sys.executable, "-c", _SERVE, "app", "--no-browser", "--port", "0", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
    )
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
        process.communicate(timeout=90)  # a slow machine may take its time
