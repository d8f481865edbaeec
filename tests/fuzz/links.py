"""Strategies for links of the explorer: the part after the question mark."""

from urllib.parse import quote_plus

from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.app.state.screen import ANGLES, AXES, MAPPED, QUICK, SIZES, THEMES, VIEWS

from . import words
from .words import mistyped, mostly, number, odd_text, quantity

_axis = st.builds("{}={}..{}".format, mistyped(AXES), number, number)
_SCREEN = {
    "view": mistyped(VIEWS),
    "answered_by": words.model,
    "shown": st.lists(words.model, max_size=4).map(",".join),
    "map_model": mistyped(QUICK),
    "quantity": mistyped(MAPPED),
    "angle": mistyped(ANGLES),
    "size": mistyped(SIZES),
    "theme": mistyped(THEMES),
    "across": _axis,
    "up": _axis,
    "limit": st.builds("{}<={}".format, words.quantity_name, quantity),
    "cup.arc_of_cover": words.half_angle,
    "beside1.preset": st.sampled_from(tuple(bs.joints)),
    "beside2.joint.clearance": words.clearance,
}
_OWN = {
    "joint.ball_radius": words.length,
    "joint.clearance": words.clearance,
    "joint.liner_thickness": words.length,
    "liner.material": st.sampled_from(tuple(bs.materials)),
}
_MORE = {
    "name": odd_text,
    "ball.material": words.material,
    "liner.young": words.young,
    "backing.0.thickness": words.length,
    "backing.0.material": words.material,
    "backing.999.thickness": words.length,
}
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
    return "&".join(f"{_safe(name)}={_safe(value)}" for part in parts for name, value in part)


def _safe(text):
    return quote_plus(text, errors="surrogatepass")


query = st.one_of(
    st.builds(_joined, _some(_SCREEN, 3), _load, st.tuples(_pair("preset", words.preset))),
    st.builds(_joined, _some(_SCREEN, 3), _load, _own, _some(_MORE, 2)),
    st.builds(_joined, _some(_KNOWN, 6)),
    st.text(max_size=60),
    st.just("&" * 9000),
)
"""The part of a link after the question mark."""
