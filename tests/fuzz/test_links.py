"""Every link of the explorer shows a screen or is refused in one sentence."""

from urllib.parse import parse_qs

import pytest
from hypothesis import given

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app.session import Page
from ballsocket.app.state.screen import link_of, read_link

from ..app.asking import trouble
from . import links
from .limits import check_sentence, inputs, within_limits


def _read(query):
    return read_link(parse_qs(query, keep_blank_values=True))


@inputs(12)
@given(query=links.query)
def test_links(query):
    """A screen has a link that leads back to it, but for the last digit of an angle."""
    with within_limits():
        try:
            screen = _read(query)
        except ValueError as error:
            check_sentence(" ".join(str(error).split()))
            return
        again = _read(link_of(screen))
        assert _read(link_of(again)) == again


@inputs(1)
@given(query=links.query)
def test_pages(query):
    with within_limits():
        page = Page(query)
        page.leave()
        assert "This cannot be shown" not in trouble(page)
