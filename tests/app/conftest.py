"""One server and one browser for all tests of a worker; people who use them."""

import asyncio
from urllib.parse import urlsplit

import pytest

from .browser import opened_browser, served_explorer
from .user import NARROW, WAIT, User, opened_profile


@pytest.fixture(scope="module")  # not longer: its loop is in the way of those of other tests
def browser():
    pytest.importorskip("playwright.sync_api", reason="playwright is not installed").expect.set_options(timeout=WAIT)
    with opened_browser() as opened:
        yield opened


@pytest.fixture(scope="session")
def address():
    pytest.importorskip("tornado", reason="the explorer's extra is not installed")
    with served_explorer() as served:
        yield served


@pytest.fixture(scope="module")
def profile(browser, address):
    """One for all tests of a single user: it reads the scripts of the page once."""
    with opened_profile(browser, address) as one:
        yield one


@pytest.fixture
def other(browser, address):
    """Somebody else, on another machine as far as the explorer can tell."""
    with opened_profile(browser, address) as one:
        yield User(one, address)


@pytest.fixture
def reader(browser, address):
    """Whoever holds a telephone, in the dark."""
    with opened_profile(browser, address, NARROW, dark=True) as one:
        yield User(one, address)


@pytest.fixture
def user(profile, address):
    someone = User(profile, address)
    yield someone
    assert not someone.errors
    assert all(urlsplit(url).hostname == "127.0.0.1" for url in someone.requests if url.startswith(("http", "ws")))
    someone.page.close()


@pytest.fixture
def served():
    """A server in this process, whose loop turns while it is asked."""
    pytest.importorskip("tornado", reason="the explorer's extra is not installed")
    from ballsocket.app import server as serve

    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    one = serve.server(0)
    one.start()
    yield one
    one.stop()
    loop.close()
    asyncio.set_event_loop(None)
