"""Strategies for joint files: tables with at most a few faults, and damaged examples."""

from hypothesis import strategies as st

import ballsocket as bs

from ..places import EXAMPLES
from . import words
from .damage import ODD_VALUES, file_of
from .words import mistyped, mostly, odd_text, quoted


def value(usual):
    """One entry as it is written in TOML."""
    return mostly(usual | usual.map(_in_quotes), ODD_VALUES)


def _in_quotes(text):
    return text if text.startswith('"') else words.toml(text)


def table(head, usual):
    """A table with the usual entries, some with other values; at times one is missing and another not known."""
    lines = st.tuples(*(st.builds("{} = {}".format, st.just(key), value(each)) for key, each in usual.items()))
    odd = st.builds("{} = {}".format, mistyped((*usual, *_KEYS)).map(key_of), ODD_VALUES)
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
_written = st.tuples(st.lists(_name, max_size=1), st.tuples(joint, liner, _load), st.lists(_more, max_size=2)).map(
    lambda parts: "\n".join(line for part in parts for line in part).encode("utf-8", "surrogatepass")
)

_EXAMPLES = [path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml"))]
raw = st.one_of(_written, _written, file_of(*_EXAMPLES))
"""Bytes of a joint file."""
