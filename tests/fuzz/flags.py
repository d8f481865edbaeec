"""Strategies for command lines: a command, a joint, and flags with values that belong to them or to others."""

from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.core.quantities import CONTACT
from ballsocket.studies.limits import LIMITED_NAMES as LIMITED
from ballsocket.studies.parameters import PARAMETERS

from . import words
from .words import mistyped, mostly, number, odd_text, quantity

_QUICK = ("tabulated", "hess-forsbach", "vessel", "bartel", "hertz", "refined")
_model = mostly(st.sampled_from(_QUICK), words.model.filter(lambda name: name.lower() != "fem"))
_count = mostly(st.sampled_from(("2", "3", "5", "8")), st.sampled_from(("0", "-1", "1", "1e3", "x", "9" * 25)))
_size = mostly(st.sampled_from(("1", "2 mm")), st.sampled_from(("0", "-1", "1e-9", "x", "99 mm", "inf")))
_signs = st.sampled_from(("..", "+-", "±", "+/-", ".", "-", ""))
_compared = st.sampled_from(("<=", ">=", "≤", "<", "=", ""))
_ENDS = ("ball_radius=8..20", "clearance=0.02..0.4 mm", "liner_thickness=3..12", "liner_young=0.3..3 GPa")
_range = mostly(st.sampled_from(_ENDS), st.builds("{}={}{}{}".format, mistyped(PARAMETERS), number, _signs, quantity))
_limited = mostly(st.sampled_from(("20", "26 mm", "10 MPa")), quantity)
_limit = st.builds("{}{}{}".format, mistyped(LIMITED), _compared, _limited)
_scatter = mostly(words.clearance, quantity)
_spread = st.builds("{}={}{}{}".format, mistyped(PARAMETERS), words.clearance, _signs, _scatter)
_correlation = st.builds("{}, {} = {}".format, mistyped(PARAMETERS), mistyped(PARAMETERS), quantity)
_OWN = dict.fromkeys(("--ball-radius", "--liner-thickness"), words.length)
_OWN |= {"--clearance": words.clearance, "--young": words.young, "--poisson": words.poisson}
_OTHERS = dict.fromkeys(("--head-diameter", "--outer-radius", "--outer-diameter"), words.length)
_OTHERS |= dict.fromkeys(("--diametral-clearance", "--chamfer"), words.clearance)
_OTHERS |= dict.fromkeys(("--liner", "--ball"), words.material)
_OTHERS |= {"--ball-young": words.young, "--ball-poisson": words.poisson, "--arc-of-cover": words.half_angle}
_OTHERS |= {"--interface": mistyped(("bonded",))}
_LOADS = {"--force": words.force, "--indentation": words.indentation, "--half-angle": words.half_angle}
_STUDY = {"--force": words.force, "--indentation": words.indentation, "--limit": _limit, "--points": _count}
_SPREADS = {"--spread": _spread, "--correlation": _correlation, "--of": mistyped(CONTACT)}
_SPREADS |= {"--force": words.force, "--count": _count, "--intervals": mistyped(("none", "bootstrap"))}
_FORMS = mistyped(("constant", "polynomial"))
_FLAGS = {
    "press": {**_OWN, **_OTHERS, **_LOADS},
    "map": {**_STUDY, "--x": _range, "--y": _range},
    "optimise": {**_STUDY, "--vary": _range, "--minimise": mistyped(CONTACT)},
    "sensitivity": _SPREADS,
    "deck": {**_LOADS, "--steps": _count, "--scale": number, "--element-size": _size, "--element": odd_text},
    "calibrate": {"--force": words.force, "--thickness": words.length, "--form": _FORMS},
}
_ALWAYS = {
    "press": ("--force", "--model"),
    "map": ("--force", "--points", "--model"),
    "optimise": ("--force", "--vary", "--model"),
    "sensitivity": ("--force", "--spread", "--count", "--model"),
    "deck": ("--force", "--element-size"),
    "calibrate": ("--force",),
}
_LAST = ([], [], [], ["--json"], ["--help"], ["--all"], ["--forse", "1"], ["--"], ["x" * 3000])


def _given(flags, names):
    pairs = [st.tuples(st.just(name), mostly(flags[name], quantity | odd_text)) for name in names]
    return st.tuples(*pairs).map(lambda each: [word for pair in each for word in pair])


def _line(command):
    flags = {**_FLAGS[command], "--model": _model}
    some = st.lists(st.sampled_from(tuple(_FLAGS[command])), max_size=2).flatmap(lambda names: _given(flags, names))
    joint = mostly(st.sampled_from(tuple(bs.joints)), words.preset).map(lambda name: [name])
    if command == "press":
        joint |= _given(flags, _OWN)
    out = st.just(["--out", "out"] if command == "deck" else [])
    parts = (joint, _given(flags, _ALWAYS[command]), some, out, st.sampled_from(_LAST))
    return st.tuples(*parts).map(lambda each: [command, *(word for part in each for word in part)])


_OTHER = ("cite", "models", "presets", "pres", "Press", "--versio", "-h", "x" * 3000)
line = st.one_of(
    _line("press"), *(_line(command) for command in _FLAGS), st.tuples(st.sampled_from(_OTHER), _model).map(list)
)
"""The words after `ballsocket`."""
