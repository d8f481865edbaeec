"""One server and one browser for all tests of a process; people who use them."""

import asyncio
from types import SimpleNamespace
from urllib.parse import urlsplit

import pytest

from .browser import WIDE, User, explorer_process, opened_browser, opened_profile

_LOOP = pytest.StashKey()


def pytest_pycollect_makemodule():
    """Skip the room where the explorer cannot be imported."""
    for package in ("tornado", "tomli_w", "xarray", "skfem"):
        pytest.importorskip(package, reason="the explorer's extra is not installed")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Let the event loop of Playwright count as running only in tests that name a fixture with a browser."""
    if "browser" not in item.fixturenames:
        return (yield)
    asyncio._set_running_loop(item.config.stash.get(_LOOP, None))
    result = yield  # a run that is stopped here ends the browser next: its loop stays
    item.config.stash[_LOOP] = asyncio._get_running_loop()
    asyncio._set_running_loop(None)
    return result


@pytest.fixture(scope="session")
def browser():
    with opened_browser() as opened:
        yield opened


@pytest.fixture(scope="session")
def address():
    with explorer_process("--origin", "hips.example.org:8443") as (served, _):
        yield served


@pytest.fixture(scope="session")
def profile(browser, address):
    """One for all tests of a single user: it reads the scripts of the page once, and ends with the browser."""
    return opened_profile(browser, address).__enter__()


@pytest.fixture
def user(profile, address):
    someone = User(profile, address)
    yield someone
    assert not someone.errors
    assert all(urlsplit(url).hostname == "127.0.0.1" for url in someone.requests if url.startswith(("http", "ws")))
    if someone.requests:
        someone.page.evaluate("localStorage.clear()")
    someone.page.close()


@pytest.fixture(scope="session")
def open_page(profile, address):
    return User(profile, address)


@pytest.fixture
def reader(open_page):
    """One page for several tests that need no history: a page of its own costs a process of the browser."""
    open_page.page.set_viewport_size({"width": WIDE, "height": 900})
    yield open_page
    assert not open_page.errors
    open_page.page.evaluate("localStorage.clear()")


@pytest.fixture(scope="session")
def examined_page(browser, address):
    """Scripts of a test run in it, against the policy of the page; it ends with the browser."""
    return User(opened_profile(browser, address, bypass_csp=True).__enter__(), address)


@pytest.fixture
def at_once(monkeypatch):
    """Work of a process is done here and now, except that of the functions in `left`; keys and news of all work."""
    from ballsocket.app import jobs

    works = SimpleNamespace(asked=[], news=[], left={"simulate_film", "map_orientations"})

    def ask(self, key, work):
        works.asked.append(key)
        if work.func.__name__ in works.left:
            return
        try:
            self._heard(key, jobs.RunFinished(work(lambda news: works.news.append(news) or self._heard(key, news))))
        except ValueError as error:
            self._heard(key, jobs.RunRefused(why=str(error)))

    monkeypatch.setattr(jobs.Job, "ask", ask)
    return works


@pytest.fixture
def asked(monkeypatch):
    """Keys of the work that was asked for, none of which is done."""
    from ballsocket.app.jobs import Job

    keys = []
    monkeypatch.setattr(Job, "ask", lambda self, key, work: keys.append(key))
    return keys


@pytest.fixture
def served():
    """A server in this process, whose loop turns while it is asked."""
    from ballsocket.app import server as serve

    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    one = serve.server(0)
    one.start()
    yield one
    one.stop()
    loop.close()
    asyncio.set_event_loop(None)
