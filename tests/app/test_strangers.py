"""What the explorer's server says to strangers."""

from urllib.parse import urlsplit

import pytest

pytestmark = pytest.mark.xdist_group("browser")  # the server of the tests in a browser


def test_nobody_can_choose_the_name_of_anothers_session(address):
    from urllib.error import HTTPError
    from urllib.request import urlopen

    with pytest.raises(HTTPError, match="403"):
        urlopen(f"{address}?bokeh-session-id=chosen")


def test_other_machines_names_do_not_reach_it(address):
    """A page of somebody else's that resolves to this machine is refused by its name."""
    from http.client import HTTPConnection

    parts = urlsplit(address)
    connection = HTTPConnection(parts.hostname, parts.port)
    handshake = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        "Origin": "http://evil.example",
    }
    connection.request("GET", "/ws", headers=handshake)
    assert connection.getresponse().status == 403
    connection.close()
