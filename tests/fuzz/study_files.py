"""Strategies for study files, and for the tables of numbers that they name."""

from hypothesis import strategies as st

from ballsocket.studies.parameters import PARAMETERS

from . import joint_files, words
from .joint_files import key_of, value
from .words import mistyped, mostly, number, odd_text, quoted

TABLE = "points.csv"
_QUICK = ("hess-forsbach", "hertz", "bartel", "tabulated", "refined")
_USUAL = {
    "ball_radius": words.length,
    "clearance": words.clearance,
    "liner_thickness": words.length,
    "liner_young": words.young,
    "liner_poisson": words.poisson,
    **words.LOADS,
}
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
    return st.builds(
        lambda form, low, high: f"{name} = {{{form.format(low, high)}}}", st.sampled_from(_SPREADS), usual, usual
    )


def _table(head, lines):
    return lines.map(lambda each: "\n".join([head, *each]))


_axes = _table("[axes]", _keys.flatmap(lambda names: st.tuples(*map(_axis, names))))
_method = quoted(mistyped(("sobol", "latin-hypercube")))
_head = st.builds("count = {}\nseed = {}\nmethod = {}".format, _count, value(st.just("1")), _method)
_samples = _table(
    "[samples]", st.tuples(_head, _keys.flatmap(lambda names: st.tuples(*map(_spread, names))).map("\n".join))
)
_rows = st.just(f'[table]\npath = "{TABLE}"')
_loaded = st.sampled_from(tuple(words.LOADS)).flatmap(
    lambda kind: words.LOADS[kind].map(lambda load: f"[axes]\n{kind} = {load}")
)
_engine = st.builds(
    "[engine]\nkind = {}\n{} = {}".format,
    quoted(mistyped(("serial",))),
    st.sampled_from(("workers", "address", "kinds")),
    quoted(odd_text) | number,
).filter(lambda text: not text.startswith('[engine]\nkind = "dask"'))
_model = mostly(quoted(st.sampled_from(_QUICK)), quoted(words.odd_text) | st.just('["a"]'))
_names = st.lists(quoted(words.quantity_name), max_size=3).map(lambda each: f"quantities = [{', '.join(each)}]")
_top = st.builds(lambda one, more: [f"model = {one}", *more], _model, st.lists(_names, max_size=1))
_joint = st.one_of(
    mostly(st.just('"hip-28"'), quoted(words.preset)).map(lambda name: ([f"joint = {name}"], [])),
    st.tuples(joint_files.joint, joint_files.liner).map(lambda parts: ([], parts)),
)
_design = st.one_of(
    st.tuples(_loaded, _axes).map(lambda parts: [_merged(*parts)]),
    st.tuples(_samples, _loaded),
    st.tuples(_rows, _loaded),
    st.lists(st.one_of(_axes, _samples, _rows, _engine), max_size=3),
)


def _merged(one, other):
    """Two tables of one name as one."""
    return "\n".join([one, *other.splitlines()[1:]])


def _study(top, joint, design):
    return "\n".join([*top, *joint[0], *joint[1], *design]).encode("utf-8", "surrogatepass")


raw = st.builds(_study, _top, _joint, _design)
"""The bytes of what is called a study file."""

_cell = mostly(words.clearance, number | odd_text | st.just('"'))
_ODD_TABLES = (
    b"clearance\n0.1\n" + b'"' * 999,
    b"a," * 20_000,
    b"clearance\n" + b"1" * 200_000,
    b"clearance\r0.1\r0.2",
    b"PAR1",
    b"\xff\xfe",
)


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
"""The bytes of what is called a table of numbers."""
