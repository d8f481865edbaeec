"""A browser and a running explorer for tests; on a machine without a browser these tests skip with a word."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
NEEDED = os.environ.get("BALLSOCKET_BROWSER") == "needed"
"""Set where a browser must be there: then nothing is skipped."""


def chromium() -> str:
    """The path of a browser, or the reason why there is none."""
    path = os.environ.get("BALLSOCKET_CHROMIUM") or shutil.which("chromium") or shutil.which("google-chrome")
    if path is not None:
        return path
    if NEEDED:
        pytest.fail("no chromium is installed, and it is needed here")
    pytest.skip("no chromium is installed: the pages are not opened")


@contextmanager
def opened_browser() -> Iterator[Any]:
    if not NEEDED:
        pytest.importorskip("playwright", reason="playwright is not installed: the pages are not opened")
    from playwright.sync_api import sync_playwright

    path = chromium()
    with sync_playwright() as tools:
        browser = tools.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield browser
        browser.close()


@contextmanager
def served_explorer(*words: str) -> Iterator[str]:
    """The address of an explorer in a process of its own."""
    with explorer_process(*words) as (address, _):
        yield address


@contextmanager
def explorer_process(*words: str) -> Iterator[tuple[str, Any]]:
    """The address of an explorer, and its process."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ballsocket", "app", "--no-browser", "--port", "0", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
    )
    assert process.stdout is not None
    try:
        lines = []
        for line in process.stdout:
            lines.append(line)
            found = re.match(r"(http://\S+/) \(Ctrl-C", line)
            if found:
                break
        else:
            pytest.fail(f"the explorer did not start: {''.join(lines)}")
        yield found[1], process
    finally:
        process.terminate()
        process.communicate(timeout=90)  # a slow machine may take its time
