"""Strategies for joint files: tables that are right but for a thing or two, and bytes that were damaged."""

from hypothesis import strategies as st

import ballsocket as bs

from ..places import EXAMPLES
from . import words
from .words import mistyped, mostly, odd_text, quantity, quoted

_ODD_VALUES = st.one_of(
    quoted(quantity),
    words.number,
    quoted(odd_text),
    st.sampled_from(("true", "[]", "{}", "[1, 2]", '["a"]', "{a = 1}", "[[[[1]]]]", "1979-05-27", "'''x\ny'''", "")),
    st.sampled_from((5, 50, 500, 2000, 9000)).map(lambda depth: "[" * depth + "]" * depth),
)


def value(usual):
    """One entry as it is written in TOML."""
    return mostly(usual | usual.map(_in_quotes), _ODD_VALUES)


def _in_quotes(text):
    return text if text.startswith('"') else words.toml(text)


def table(head, usual):
    """A table with the usual entries, some with other values; at times one is missing and another not known."""
    lines = st.tuples(*(st.builds("{} = {}".format, st.just(key), value(each)) for key, each in usual.items()))
    odd = st.builds("{} = {}".format, mistyped((*usual, *_KEYS)).map(key_of), _ODD_VALUES)
    some = st.builds(lambda whole, one: [*whole[1:], one], lines, odd)
    return mostly(lines, some).map(lambda each: "\n".join([head, *each]))


def key_of(name):
    """A key as it stands; what is none between quotes."""
    return name if name.isidentifier() and name.isascii() else words.toml(name)


_KEYS = ("ball_radius", "head_diameter", "socket_radius", "outer_radius", "support", "young", "poisson", "material")
_MATERIAL = {"young": words.young, "poisson": words.poisson}
_NAMED = {"material": quoted(st.sampled_from(tuple(bs.materials)))}
_JOINT = {"ball_radius": words.length, "clearance": words.clearance, "liner_thickness": words.length}
_CUP = {"arc_of_cover": words.half_angle, "chamfer": words.clearance, "interface": quoted(mistyped(("bonded",)))}

joint = table("[joint]", _JOINT)
liner = table("[liner]", _MATERIAL) | table("[liner]", _NAMED)
_load = st.sampled_from(tuple(words.LOADS)).flatmap(lambda kind: table("[load]", {kind: words.LOADS[kind]}))
_more = st.one_of(
    table("[ball]", _MATERIAL),
    table("[ball]", _NAMED),
    table("[[backing]]", {"thickness": words.length, **_MATERIAL}),
    table("[cup]", _CUP),
)
_name = quoted(odd_text).map(lambda text: f"name = {text}")


def _whole(parts, more, names):
    return "\n".join([*names, *parts, *more])


_written = st.builds(
    _whole, st.tuples(joint, liner, _load), st.lists(_more, max_size=2), st.lists(_name, max_size=1)
).map(lambda text: text.encode("utf-8", "surrogatepass"))

_EXAMPLES = tuple(path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml")))
_WOUNDS = (
    *(b"", b"\x00", b"[", b"]]", b"=", b'"""', b".", b"a.b.", b"\r"),
    *(b"\xff", b"\xef\xbb\xbf", b"[" * 3000, b"x." * 9000),
)


def _damaged(whole, place, width, wound):
    place %= len(whole)
    return whole[:place] + wound + whole[place + width :]


_broken = st.builds(
    _damaged,
    st.sampled_from(_EXAMPLES),
    st.integers(0, 2000),
    st.integers(0, 6),
    st.sampled_from(_WOUNDS) | st.binary(max_size=6),
)
raw = st.one_of(_written, _written, _broken, st.binary(max_size=200))
"""The bytes of what is called a joint file."""
