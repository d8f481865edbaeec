"""Strategies for single values: numbers, units, names and text as people mean them, mistype them, or attack with."""

import json

from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.core.quantities import QUANTITIES

ODD_NUMBERS = (
    "0", "-0", "-1", "1e-320", "1e-200", "1e-9", "1e9", "1e200", "1e308", "1e999", "-1e999", "nan", "inf", "-inf",
    "infinity", "1_000", "0x10", "1e", ".", "+", "1,5", "1.5.2", "9" * 400, "1" * 20_000, "٣", "½", "1e-5000",
)  # fmt: skip
ODD_UNITS = (
    "", "mm", "um", "µm", "m", "km", "in", "N", "kN", "GPa", "MPa", "psi", "lbf", "deg", "rad", "°", "mm²", "mm^2",
    "parsec", "dBm*m", "N**0", "N**9", "N*m/m*m/m*m/m", "degC", "delta_degC", "percent", "mm mm", "/mm", "mm/", "%",
    "N" * 300, "mm**" * 60, "__class__", "\u2126", "kg*m/s**2",
)  # fmt: skip
ODD_TEXT = (
    "", " ", ".", "..", "/", "\x1b[31m", "\x1b]0;title\x07", "\r", "\x00", "\u202e", "\U0001f600", "%s", "{0}", "[x]",
    "[bold]", "$\\frac{", "../../etc/passwd", "a" * 5000, "é" * 40, "null", "-", "--", "'", '"', "\\", "\n", "=1+1",
)  # fmt: skip
QUICK = ("tabulated", "hess-forsbach", "vessel", "bartel", "hertz", "refined")
"""Models that answer many points within the limit of time."""

odd_text = st.sampled_from(ODD_TEXT) | st.text(max_size=12)
_integer = st.integers(-(10**30), 10**30).map(str)
plain_number = st.floats(0.01, 100.0).map("{:.4g}".format)
number = st.sampled_from(ODD_NUMBERS) | st.floats().map(repr) | _integer | plain_number
quantity = st.builds("{}{}{}".format, number, st.sampled_from(("", " ", "  ")), st.sampled_from(ODD_UNITS))


def mistyped(names):
    """One of some names, whole or with letters lost, doubled or swapped."""
    name = st.sampled_from(tuple(names))
    lost = st.builds(
        lambda name, place: name[: place % len(name)] + name[place % len(name) + 1 :], name, st.integers(0, 30)
    )
    return st.one_of(name, lost, name.map(str.upper), odd_text)


values = st.one_of(plain_number, number, quantity, odd_text, mistyped((*bs.joints, *bs.materials, *QUICK, *QUANTITIES)))
"""Values of options and of links."""


def toml(value):
    """As TOML writes it: text between quotes, everything else as it is."""
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else str(value)
