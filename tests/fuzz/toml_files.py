"""Strategies for joint files, study files and the tables of numbers that these name: few faults, damaged examples."""

from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.studies.parameters import PARAMETERS

from ..places import EXAMPLES
from . import words
from .damage import ODD_VALUES, file_of
from .words import mistyped, mostly, number, odd_text, quoted


def value(usual):
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

joints = st.one_of(_written, _written, file_of(*(path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml")))))

TABLE = "points.csv"
_QUICK = ("hess-forsbach", "hertz", "bartel", "tabulated", "refined")
_USUAL = {**_JOINT, "liner_young": words.young, "liner_poisson": words.poisson, **words.LOADS}
_count = mostly(st.sampled_from(("2", "4", "8")), st.sampled_from(("0", "-1", "1", "1e15", "2.5", "true", "9" * 30)))
_key = mostly(st.sampled_from(tuple(_USUAL)), mistyped(PARAMETERS).map(key_of))
_keys = st.lists(_key, min_size=1, max_size=2, unique=True)
_SPREADS = ("low = {}, high = {}", "mean = {}, deviation = {}", "nominal = {}, plus_minus = {}", "low = {}, mean = {}")


def _axis(name):
    usual = _USUAL.get(name, number)
    several = st.lists(usual, max_size=4).map(lambda each: f"[{', '.join(each)}]")
    span = st.builds("{{from = {}, to = {}, count = {}}}".format, usual, usual, _count)
    return (value(usual) | several | span).map(lambda each: f"{name} = {each}")


def _spread(name):
    usual = _USUAL.get(name, number)
    form = st.sampled_from(_SPREADS).map(lambda each: f"{name} = {{{{{each}}}}}")
    return st.builds(str.format, form, usual, usual)


def _table(head, lines):
    return lines.map(lambda each: "\n".join([head, *each]))


_axes = _table("[axes]", _keys.flatmap(lambda names: st.tuples(*map(_axis, names))))
_method = quoted(mistyped(("sobol", "latin-hypercube")))
_head = st.builds("count = {}\nseed = {}\nmethod = {}".format, _count, value(st.just("1")), _method)
_scatter = _keys.flatmap(lambda names: st.tuples(*map(_spread, names))).map("\n".join)
_samples = _table("[samples]", st.tuples(_head, _scatter))
_rows = st.just(f'[table]\npath = "{TABLE}"')
_loaded = st.one_of(words.LOADS[kind].map(f"[axes]\n{kind} = {{}}".format) for kind in words.LOADS)
_key_of_engine = st.sampled_from(("workers", "address", "kinds"))
_kind = quoted(mistyped(("serial",))).filter(lambda text: text != '"dask"')
_engine = st.builds("[engine]\nkind = {}\n{} = {}".format, _kind, _key_of_engine, quoted(odd_text) | number)
_model = mostly(quoted(st.sampled_from(_QUICK)), quoted(words.odd_text) | st.just('["a"]'))
_names = st.lists(quoted(words.quantity_name), max_size=3).map(lambda each: f"quantities = [{', '.join(each)}]")
_top = st.builds(lambda one, more: [f"model = {one}", *more], _model, st.lists(_names, max_size=1))
_joint = st.one_of(
    mostly(st.just('"hip-28"'), quoted(words.preset)).map(lambda name: ([f"joint = {name}"], [])),
    st.tuples(joint, liner).map(lambda parts: ([], parts)),
)
_design = st.one_of(
    st.builds(lambda load, axes: ["\n".join([load, *axes.splitlines()[1:]])], _loaded, _axes),
    st.tuples(_samples, _loaded),
    st.tuples(_rows, _loaded),
    st.lists(st.one_of(_axes, _samples, _rows, _engine), max_size=3),
)


def _study(top, joint, design):
    return "\n".join([*top, *joint[0], *joint[1], *design]).encode("utf-8", "surrogatepass")


studies = st.builds(_study, _top, _joint, _design)

_cell = mostly(words.clearance, number | odd_text | st.just('"'))
_ODD_TABLES = (b"clearance\n0.1\n" + b'"' * 999, b"a," * 20_000, b"clearance\n" + b"1" * 200_000)
_ODD_TABLES += (b"clearance\r0.1\r0.2", b"PAR1", b"\xff\xfe")


def _csv(heads, rows):
    return "\n".join([",".join(heads), *(",".join(row) for row in rows)]).encode("utf-8", "surrogatepass")


def _under(heads):
    row = mostly(st.tuples(*(_USUAL.get(head, _cell) for head in heads)), st.lists(_cell, max_size=5))
    return st.lists(row, max_size=6).map(lambda rows: _csv(heads, rows))


_heads = st.lists(st.sampled_from(tuple(_USUAL)), min_size=1, max_size=3, unique=True)
csv = st.one_of(
    _heads.flatmap(_under),
    mostly(_heads, st.lists(words.quantity_name, max_size=3)).flatmap(_under),
    st.sampled_from(_ODD_TABLES),
    st.binary(max_size=80),
)
