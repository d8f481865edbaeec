"""Every link of the explorer shows a screen or is refused in one sentence."""

from urllib.parse import parse_qs, quote_plus

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
import ballsocket as bs
from ballsocket.app.session import Page
from ballsocket.app.state.screen import ANGLES, AXES, MAPPED, QUICK, SIZES, THEMES, VIEWS, link_of, read_link

from ..app.asking import trouble
from . import words
from .limits import check_sentence, inputs, within_limits
from .words import mistyped, mostly, number, odd_text, quantity

_axis = st.builds("{}={}..{}".format, mistyped(AXES), number, number)
_CHOICES = {"view": VIEWS, "map_model": QUICK, "quantity": MAPPED, "angle": ANGLES, "size": SIZES, "theme": THEMES}
_SCREEN = {
    **{name: mistyped(values) for name, values in _CHOICES.items()},
    "answered_by": words.model,
    "shown": st.lists(words.model, max_size=4).map(",".join),
    **dict.fromkeys(("across", "up"), _axis),
    "limit": st.builds("{}<={}".format, words.quantity_name, quantity),
    "cup.arc_of_cover": words.half_angle,
    "beside1.preset": st.sampled_from(tuple(bs.joints)),
    "beside2.joint.clearance": words.clearance,
}
_OWN = dict.fromkeys(("joint.ball_radius", "joint.liner_thickness"), words.length)
_OWN |= {"joint.clearance": words.clearance, "liner.material": st.sampled_from(tuple(bs.materials))}
_MORE = dict.fromkeys(("backing.0.thickness", "backing.999.thickness"), words.length)
_MORE |= dict.fromkeys(("ball.material", "backing.0.material"), words.material)
_MORE |= {"name": odd_text, "liner.young": words.young}
_KNOWN = {**_SCREEN, **_OWN, **_MORE}


def _some(known, most):
    """A few names, each once, with their values; now and then with others, or names that are not known."""
    names = st.lists(st.sampled_from(tuple(known)), max_size=most, unique=True)
    usual = names.flatmap(lambda each: st.tuples(*(_pair(name, known[name]) for name in each)))
    odd = st.tuples(mistyped(_KNOWN) | st.just("a." * 3000), odd_text | quantity)
    return mostly(usual, st.lists(odd, max_size=2))


def _pair(name, value):
    return st.tuples(st.just(name), mostly(value, quantity | odd_text))


_own = st.tuples(*(_pair(name, value) for name, value in _OWN.items()))
_load = st.sampled_from(tuple(words.LOADS)).flatmap(lambda kind: st.tuples(_pair(f"load.{kind}", words.LOADS[kind])))


def _joined(*parts):
    pairs = ([quote_plus(text, errors="surrogatepass") for text in pair] for part in parts for pair in part)
    return "&".join(map("=".join, pairs))


QUERIES = st.one_of(
    st.builds(_joined, _some(_SCREEN, 3), _load, st.tuples(_pair("preset", words.preset))),
    st.builds(_joined, _some(_SCREEN, 3), _load, _own, _some(_MORE, 2)),
    st.builds(_joined, _some(_KNOWN, 6)),
    st.text(max_size=60),
    st.just("&" * 9000),
)


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
