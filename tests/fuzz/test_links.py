"""Every link of the explorer shows a screen or is refused in one sentence."""

from urllib.parse import parse_qs, quote_plus

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app.session import Page
from ballsocket.app.state.screen import link_of, read_link

from ..app.asking import trouble
from . import damage
from .limits import check_sentence, inputs, within_limits
from .words import values

LINES = """
preset=hip-28 load.force=3000 view=press shown=exact,hertz answered_by=tabulated theme=dark units=imperial
preset=hip-28 load.force=3000 view=map quantity=area angle=radians size=radius sizes=catalogue
preset=hip-36 load.indentation=0.04 view=map map_model=hertz across=clearance=0.05..0.2 up=ball_radius=12..16
preset=hip-28 load.half_angle=30 view=map limit=outer_radius<=26 limit=max_pressure<=12 picked=15,6
preset=hip-28 load.force=900 view=compare beside1.preset=hip-36 beside2.joint.clearance=0.2 base=1
joint.ball_radius=14 joint.clearance=0.1 joint.liner_thickness=5 liner.material=pom load.force=3000 name=a
joint.ball_radius=14 joint.clearance=0.1 joint.liner_thickness=5 liner.young=900 liner.poisson=0.4 load.force=2kN
backing.0.thickness=3 backing.0.material=titanium backing.999.thickness=2 ball.material=cocr cup.arc_of_cover=160
"""
LINKS = [line.split() for line in [*LINES.strip().splitlines(), "a." * 3000 + "=1"]]
PAIRS = damage.lines_of(LINKS, damage.value_after("=", values))


def _joined(pairs):
    parts = ([quote_plus(text, errors="surrogatepass") for text in pair.split("=", 1)] for pair in pairs)
    return "&".join(map("=".join, parts))


QUERIES = st.one_of(*3 * (PAIRS.map(_joined),), st.text(max_size=60), st.just("&" * 9000))


def _read(query):
    return read_link(parse_qs(query, keep_blank_values=True))


@inputs(12)
@given(query=QUERIES)
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
@given(query=QUERIES)
def test_pages(query):
    with within_limits():
        page = Page(query)
        page.leave()
        assert "This cannot be shown" not in trouble(page)
