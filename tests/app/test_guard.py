"""Answers of the explorer's server to requests that are not from its own pages."""

import asyncio
import gzip
import json
from http.client import HTTPConnection
from urllib.parse import urlsplit

import pytest

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from ballsocket.app.server import HostNames

STRICT = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-cache",
}


@pytest.fixture(scope="module")
def place(address):
    return urlsplit(address)


def answer(place, path="/", method="GET", host=None, **headers):
    connection = HTTPConnection(place.hostname, place.port, timeout=60)
    connection.request(method, path, headers=headers if host is None else {"Host": host, **headers})
    found = connection.getresponse()
    body = found.read()
    connection.close()
    return found, body


@pytest.mark.parametrize("host", ["evil.example", "evil.example:5006", "127.0.0.1.evil.example"])
@pytest.mark.parametrize("path", ["/", "/socket", "/assets/page.js", "/nothing"])
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
    [
        ("/", "GET", 200),
        ("/", "HEAD", 405),
        ("/nothing", "GET", 404),
        ("/assets/page.js", "GET", 200),
        ("/socket", "GET", 400),
    ],
)
def test_every_answer_bids_browsers_be_strict(place, path, method, status):
    found, _ = answer(place, path, method)
    assert found.status == status
    assert {name: found.headers[name] for name in STRICT} == STRICT
    assert "Server" not in found.headers
    rules = dict(rule.split(" ", 1) for rule in found.headers["Content-Security-Policy"].split("; "))
    assert rules["default-src"] == rules["base-uri"] == rules["frame-ancestors"] == "'none'"
    assert rules["script-src"] == rules["style-src"] == "'self'"
    assert "unsafe-eval" not in found.headers["Content-Security-Policy"]


def test_a_name_in_the_request_cannot_add_a_rule(place):
    found, _ = answer(place, host="localhost:1; script-src *")
    assert found.status in (400, 403)
    assert (found.headers["Content-Security-Policy"] or "").count("script-src") <= 1


def test_no_script_stands_in_the_page(place):
    _, body = answer(place)
    for script in body.decode().split("<script")[1:]:
        assert script.startswith(' type="module" src="assets/')
        assert script.partition(">")[2].startswith("</script>")
    assert b"style=" not in body


def test_files_are_compressed_and_are_sent_once(place):
    found, body = answer(place, "/assets/page.css", **{"Accept-Encoding": "gzip"})
    assert found.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(body) == answer(place, "/assets/page.css")[1]
    again, nothing = answer(place, "/assets/page.css", **{"If-None-Match": found.headers["ETag"]})
    assert (again.status, nothing) == (304, b"")


@pytest.mark.parametrize(
    "path",
    [
        "/components/ballsocket.__main__/x/y/z",
        "/components/this/x/y/z",
        "/%63omponents/this/x/y/z",
        "//components/this/x/y/z",
        "/assets/../components/this/x/y/z",
        "/assets/..%2f..%2fserver.py",
        "/assets/../../server.py",
        "/assets/server.py",
        "/assets/",
        "/ws",
        "/static/js/bokeh.min.js",
        "/autoload.js",
        "/metadata",
        "/favicon.ico",
    ],
)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_other_addresses_are_refused(place, path, method):
    found, body = answer(place, path, method)
    assert found.status in (404, 405)
    assert b"Traceback" not in body
    assert b"/" not in body
    assert answer(place)[0].status == 200


async def close(connection):
    """Close a connection, and wait until the server has closed it too."""
    connection.close()
    while await connection.read_message() is not None:
        pass


def connect(place, origin=None):
    headers = {"Origin": origin or f"http://{place.netloc}"}
    return websocket_connect(HTTPRequest(f"ws://{place.netloc}/socket", headers=headers))


@pytest.mark.parametrize(
    ("origin", "let"),
    [
        (None, True),
        ("https://hips.example.org:8443", True),
        ("http://evil.example", False),
        ("http://127.0.0.1:1", False),
        ("https://hips.example.org", False),
        ("null", False),
        ("http://[", False),
    ],
)
def test_a_page_of_another_server_opens_no_socket(place, origin, let):
    async def tried():
        await close(await connect(place, origin))

    if let:
        asyncio.run(tried())
    else:
        with pytest.raises(HTTPClientError, match="403"):
            asyncio.run(tried())


def test_an_error_that_is_sent_to_a_browser_shows_no_path(place):
    """A request that no page of ours makes is refused in one sentence, and the page goes on."""
    requests = [
        {"n": 1, "do": "open", "query": ["no text"]},
        {"n": 2, "do": "edit", "name": "load", "value": {"deep": [1e400, None]}},
        {"n": 3, "do": "edit", "name": "cup.pick", "value": "x" * 9000},
        {"n": 4, "do": "upload", "text": None},
        {"n": 5, "do": "save", "kind": "../../etc/passwd"},
        {"n": 6, "do": "leave"},
        {"n": 7, "do": "edit", "name": "load", "value": 2900},
    ]

    async def answered():
        connection = await connect(place)
        texts = []
        for request in requests:
            await connection.write_message(json.dumps(request))
            while not texts or json.loads(texts[-1])["n"] < request["n"]:
                texts.append(await asyncio.wait_for(connection.read_message(), 60))
        await close(connection)
        return texts

    texts = asyncio.run(answered())
    assert "data-value='2900.0'" in texts[-1]
    assert not any(word in text for text in texts for word in ("Traceback", ".py", "site-packages"))


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
        (["hips.example.org:*"], "hips.example.org", True),
    ],
)
def test_a_star_stands_for_any_part_of_a_name(names, host, let):
    assert HostNames(names).answer_to(host) == let
    assert HostNames(names).trust(f"http://{host}", "127.0.0.1") == let
