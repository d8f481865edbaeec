"""Table 3 of Heß & Forsbach 2021: constants of Eq. (18), interpolated by monotone cubics in Poisson's ratio."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any

import numpy

from ..core.arrays import Array, Numbers, clip


def table_3() -> dict[str, Any]:
    """Read Table 3 of the paper: Poisson's ratios and the constants C1, C2, C3 of Eq. (18)."""
    return tomllib.loads((files("ballsocket") / "data" / "hess_forsbach_2021.toml").read_text(encoding="utf-8"))


def _monotone_slopes(x: Numbers, y: Numbers) -> Numbers:
    """Compute the knot slopes of the monotone cubic interpolation of Fritsch & Butland 1984, for rows of y.

    They equal those of `scipy.interpolate.PchipInterpolator`, whose import would double the import time of the package
    (doi 10.1137/0905021).
    """
    width = numpy.diff(x)
    rise = numpy.diff(y) / width
    first, last = width[1:] + 2 * width[:-1], 2 * width[1:] + width[:-1]
    with numpy.errstate(divide="ignore"):
        inner = (last + first) / (last / rise[:, :-1] + first / rise[:, 1:])
    inner = numpy.where(rise[:, :-1] * rise[:, 1:] > 0, inner, 0.0)
    ends = []
    for (h0, h1), (m0, m1) in (((width[0], width[1]), rise[:, :2].T), ((width[-1], width[-2]), rise[:, :-3:-1].T)):
        end = ((2 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
        end = numpy.where(end * m0 <= 0, 0.0, end)
        ends.append(numpy.where((m0 * m1 < 0) & (abs(end) > 3 * abs(m0)), 3 * m0, end))
    return numpy.column_stack([ends[0], inner, ends[1]])


Row = tuple[float, ...]
"""Row of numbers."""


def _interpolate_constants() -> tuple[Row, Row, Row, Any]:
    """Compute the monotone cubics in ν that interpolate Table 3.

    Returns knots, widths, (C1, C2, C3) at the first knot, and for each interval and constant the coefficients of the
    distance to its first knot, of its square and of its cube.
    """
    table = table_3()
    knots = numpy.array(table["poisson"])
    values = numpy.array([table["C1"], table["C2"], table["C3"]])
    width, rise = numpy.diff(knots), numpy.diff(values) / numpy.diff(knots)
    slopes = _monotone_slopes(knots, values)
    second = (3 * rise - 2 * slopes[:, :-1] - slopes[:, 1:]) / width
    third = (slopes[:, :-1] + slopes[:, 1:] - 2 * rise) / width**2
    rows = [[_float_tuple(part[:, i]) for part in (slopes, second, third)] for i in range(len(width))]
    return _float_tuple(knots), _float_tuple(width), _float_tuple(values[:, 0]), tuple(map(tuple, rows))


def _float_tuple(values: Numbers) -> Row:
    """Convert an array to a tuple of floats."""
    return tuple(map(float, values))


(_X1, _X2, _X3, _X4, _), (_W1, _W2, _W3, _W4), _START, _CUBICS = _interpolate_constants()
(_A1, _B1, _C1), (_A2, _B2, _C2), (_A3, _B3, _C3), (_A4, _B4, _C4) = _CUBICS


def scaled_modulus(constants: tuple[Array, ...], ratio: Array) -> Array:
    """Compute the scaled foundation modulus K R2/E from the thickness ratio R2/L by Eq. (18) of the paper."""
    return constants[0] + ratio * (constants[1] + ratio * constants[2])


def table_formula(R2: Array, L: Array, E: Array, nu: Array) -> Array:
    """Compute the foundation modulus K in MPa/mm by Eq. (18) with the constants of Table 3."""
    # Eq. (18) with the constants of Table 3, constant outside its columns. The increment over each interval is a
    # cubic in the distance to its first knot, clipped to the interval: no branch, any array library
    x = R2 / L
    t1, t2 = clip(nu - _X1, 0.0, _W1), clip(nu - _X2, 0.0, _W2)
    t3, t4 = clip(nu - _X3, 0.0, _W3), clip(nu - _X4, 0.0, _W4)
    scaled = scaled_modulus(_START, x)
    scaled = scaled + t1 * (scaled_modulus(_A1, x) + t1 * (scaled_modulus(_B1, x) + t1 * scaled_modulus(_C1, x)))
    scaled = scaled + t2 * (scaled_modulus(_A2, x) + t2 * (scaled_modulus(_B2, x) + t2 * scaled_modulus(_C2, x)))
    scaled = scaled + t3 * (scaled_modulus(_A3, x) + t3 * (scaled_modulus(_B3, x) + t3 * scaled_modulus(_C3, x)))
    scaled = scaled + t4 * (scaled_modulus(_A4, x) + t4 * (scaled_modulus(_B4, x) + t4 * scaled_modulus(_C4, x)))
    return E / R2 * scaled
