"""Hostile messages, names and links: the server goes on, and nothing in a name is run."""

import json
import os
import time
from contextlib import ExitStack, suppress
from pathlib import Path
from threading import Thread
from urllib.parse import quote

import pytest

from ..extent import some
from .asking import trouble
from .browser import explorer_process
from .user import User, opened_profile
from .wire import BINARY, Wire, opened_wire

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
from ballsocket.app.session import Page
from ballsocket.app.state.screen import VIEWS


def still_answers(address):
    with opened_wire(address) as wire:
        wire.ask(2, "edit", name="load", value=2900)
        return wire.answer(2)["=load"]["value"] == 2900


_NO_REQUESTS = {
    "deep value": b'{"n": 2, "do": "edit", "name": "load", "value": ' + b"[" * 50_000 + b"]" * 50_000 + b"}",
    "no text": b"\xff\xfe\xfd",
    "huge number": b'{"n": 1e999, "do": "edit"}',
    "not a number": b'{"n": NaN, "do": "edit", "name": "load", "value": NaN}',
    "surrogate": b'{"n": 2, "do": "edit", "name": "\\ud800", "value": "\\udfff"}',
}


@pytest.mark.parametrize("name", some(_NO_REQUESTS, 3))
def test_what_is_no_request_is_ignored_or_refused(address, name):
    with opened_wire(address) as wire:
        wire.send(_NO_REQUESTS[name])
        assert still_answers(address)


def test_requests_before_the_first_page_are_ignored(address):
    wire = Wire(address)
    wire.ask(1, "edit", name="load", value=2900)
    wire.ask(2, "open", query="")
    assert wire.answer(2)["=load"]["value"] == 3000
    wire.close()


@pytest.mark.parametrize("content", [b'"' + b"x" * 500_000 + b'"', b"{" + b" " * 3_000_000])
def test_a_message_that_is_too_large_ends_its_own_connection(address, content):
    with opened_wire(address) as wire:
        wire.send(content)
        assert wire.is_closed()
    assert still_answers(address)


def test_binary_messages_do_no_harm(address):
    with opened_wire(address) as wire:
        wire.send(bytes(range(256)) * 100, BINARY)
        wire.send(json.dumps({"n": 2, "do": "edit", "name": "load", "value": 2900}).encode(), BINARY)
        assert still_answers(address)


@pytest.mark.parametrize(
    "words",
    [
        {"do": "__init__"},
        {"do": "choose", "name": "__class__", "value": "x"},
        {"do": "choose", "name": "file", "value": "x"},
        {"do": "choose", "name": "view", "value": ["press"]},
        {"do": "edit", "name": "load.__class__", "value": 1},
        {"do": "edit", "name": "cup." + "x" * 10_000, "value": 1},
        {"do": "edit", "name": "load", "value": {"a": 1}},
        {"do": "edit", "name": "load", "value": 1e308},
        {"do": "edit", "name": ["load"], "value": 1},
        {"do": "edit", "name": "load", "value": "\ud800"},
        {"do": "edit", "name": "\ud800", "value": 1},
        {"do": "edit", "name": "layer" + "9" * 5000, "value": 1},
        {"do": "edit", "name": "compare.x", "value": 1},
        {"do": "upload", "text": 3},
        {"do": "upload", "text": "a=" + "[" * 90_000},
        {"do": "open", "query": "x" * 100_000},
    ],
    ids=lambda words: f"{words['do']} {str(words.get('name', ''))[:12]}",
)
def test_unknown_actions_and_values_get_a_sentence(address, words):
    with opened_wire(address) as wire:
        wire.ask(2, words["do"], **{key: value for key, value in words.items() if key != "do"})
        answer = wire.answer(2)
        for _ in range(50):
            sentence = answer.get("#trouble") or answer.get("=load", {}).get("error")
            if sentence:
                break
            answer |= json.loads(wire.receive()[1])
        assert "<p" in sentence or "stays in use" in sentence
        assert "Traceback" not in sentence
        wire.ask(3, "edit", name="load", value=2900)
        assert wire.answer(3)["=load"]["value"] == 2900


def test_the_smallest_load_that_a_link_can_state_is_shown(caplog):
    page = Page("load.force=1e-320")
    assert trouble(page) == ""
    assert page.channel.shown_value("#press-charts")
    assert not caplog.records


def memory_of(process):
    """Resident memory of a process in MB."""
    pages = int(Path(f"/proc/{process.pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="the memory of a process is read from /proc")
def test_a_client_that_never_reads_does_not_grow_the_server():
    """Answers of the edits are many times the memory that the server may gain, and another user goes on."""
    with explorer_process() as (address, process), opened_wire(address) as user, opened_wire(address) as deaf:
        for number in range(2, 102):  # caches fill first
            user.ask(number, "edit", name="clearance", value=clearance_of(number))
            user.answer(number)
        before = memory_of(process)
        sender = Thread(target=edit_often, args=(deaf, 3000))
        sender.start()
        time.sleep(3)
        user.ask(102, "edit", name="load", value=2800)
        assert user.answer(102)["=load"]["value"] == 2800
        assert memory_of(process) - before < 15
        deaf.shut()
        sender.join()


def edit_often(wire, count):
    """Send edits without reading answers, until the connection ends."""
    with suppress(OSError):
        for number in range(count):
            wire.ask(number + 2, "edit", name="clearance", value=clearance_of(number))


def clearance_of(number):
    """One of a hundred clearances in mm."""
    return 0.05 + 0.001 * (number % 100)


@pytest.mark.long
def test_a_thousand_idle_connections_leave_room_for_a_user(address):
    with ExitStack() as stack:
        for _ in range(1000):
            stack.callback(Wire(address).close)
        assert still_answers(address)


_SCRIPT = "<img src=x onerror='window.ran=1'><script>window.ran=1</script>"


@pytest.mark.long
@pytest.mark.parametrize("view", VIEWS)
def test_script_in_names_is_text_in_every_view(browser, address, view):
    name = quote(_SCRIPT)
    joint = f"name={name}&joint.ball_radius=14&joint.clearance=.1&joint.liner_thickness=5&liner.material=uhmwpe"
    other = "&".join(f"beside1.{part}" for part in joint.split("&"))
    with opened_profile(browser, address, bypass_csp=True) as profile:
        user = User(profile, address).open(f"?view={view}&{joint}&{other}")
        user.page.wait_for_timeout(500)
        assert user.page.evaluate("window.ran") is None
        assert user.page.locator("img[src=x]").count() == 0
