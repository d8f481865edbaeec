"""What the explorer's server says to requests that are not from its own pages."""

import asyncio
import json
import re
from http.client import HTTPConnection
from urllib.parse import urlsplit

import pytest

pytest.importorskip("panel", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from tornado.httpclient import HTTPRequest
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine
from tornado.web import Application, RequestHandler
from tornado.websocket import websocket_connect

from ballsocket.app.server import guard

from .browser import served_explorer

pytestmark = pytest.mark.xdist_group("browser")
STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Content-Security-Policy": "frame-ancestors 'none'",
}


@pytest.fixture(scope="module")
def place():
    with served_explorer("--origin", "hips.example.org:8443") as address:
        yield urlsplit(address)


def answer(place, path="/", method="GET", host=None):
    connection = HTTPConnection(place.hostname, place.port, timeout=60)
    connection.request(method, path, headers={} if host is None else {"Host": host})
    found = connection.getresponse()
    body = found.read()
    connection.close()
    return found, body


@pytest.mark.parametrize("host", ["evil.example", "evil.example:5006", "127.0.0.1.evil.example"])
@pytest.mark.parametrize("path", ["/", "/ws", "/static/js/bokeh.min.js"])
def test_names_that_are_not_ours_are_refused(place, path, host):
    """A page elsewhere whose name leads to this machine reads nothing from it."""
    found, body = answer(place, path, host=host)
    assert found.status == 403
    assert body == b"this server does not answer to that name; see --origin\n"


@pytest.mark.parametrize("host", ["localhost", "LOCALHOST:1", "127.0.0.1", "hips.example.org", "hips.example.org:8443"])
def test_our_own_names_are_answered(place, host):
    assert answer(place, host=host)[0].status == 200


@pytest.mark.parametrize(
    ("path", "method", "status"),
    [("/", "GET", 200), ("/", "HEAD", 405), ("/nothing", "GET", 404), ("/static/js/bokeh.min.js", "GET", 200)],
)
def test_every_answer_bids_browsers_be_strict(place, path, method, status):
    found, _ = answer(place, path, method)
    assert found.status == status
    assert {name: found.headers[name] for name in STRICT} == STRICT


@pytest.mark.parametrize(
    "path",
    [
        "/components/ballsocket.__main__/x/y/z",
        "/components/this/x/y/z",
        "/%63omponents/this/x/y/z",
        "//components/this/x/y/z",
        "/static/../components/this/x/y/z",
        "/autoload.js",
        "/metadata",
        "/liveness",
        "/session_keep_alive",
        "/static/extensions/panel/../../../../pyproject.toml",
    ],
)
def test_routes_that_the_page_does_not_use_are_refused(place, path):
    """One of these routes makes Panel import any module, and a program module ends the server."""
    found, body = answer(place, path)
    assert found.status in (403, 404)
    assert b"Traceback" not in body
    assert answer(place)[0].status == 200


def test_an_error_that_is_sent_to_a_browser_shows_no_path(place):
    _, page = answer(place)
    token = re.findall('"token":"([^"]+)"', page.decode())[0]
    patch = {"events": [{"kind": "ModelChanged", "model": {"id": "p1"}, "attr": "x", "new": 1}]}
    frames = [{"msgid": "1", "msgtype": "PATCH-DOC"}, {}, patch]

    async def answered():
        request = HTTPRequest(f"ws://{place.netloc}/ws", headers={"Origin": f"http://{place.netloc}"})
        line = await websocket_connect(request, subprotocols=["bokeh", token])
        acknowledgement = [json.loads(await line.read_message()) for _ in range(3)]
        for frame in frames:
            await line.write_message(json.dumps(frame))
        reply = [json.loads(await line.read_message()) for _ in range(3)]
        line.close()
        while await line.read_message() is not None:
            pass
        return acknowledgement[0]["msgtype"], reply[0]["msgtype"], reply[2]

    acknowledged, kind, content = asyncio.run(answered())
    assert (acknowledged, kind) == ("ACK", "ERROR")
    assert content == {"text": "the server could not handle this message", "traceback": None}


def test_importing_the_module_of_the_command_runs_nothing(capsys):
    import ballsocket.__main__

    assert callable(ballsocket.__main__.main)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("names", "host", "let"),
    [
        (["*"], "any.example", True),
        (["*.example.org:80"], "hips.example.org", True),
        (["*.example.org:80"], "hips.example.com", False),
        (["*.example.org:80"], "a.b.example.org", False),
        (["hips.example.org:*"], "hips.example.org:99", True),
    ],
)
def test_a_star_stands_for_any_part_of_a_name(names, host, let):
    application = Application([("/", RequestHandler)])
    guard(application, names)
    request = HTTPServerRequest(
        headers=HTTPHeaders({"Host": host}), start_line=RequestStartLine("GET", "/", "HTTP/1.1")
    )
    assert (application.find_handler(request).handler_class is RequestHandler) == let
