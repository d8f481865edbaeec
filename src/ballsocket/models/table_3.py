"""Table 3 of Heß & Forsbach 2021: the constants of Eq. (18), interpolated by monotone cubics in Poisson's ratio."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any, NamedTuple

import numpy

from ..core.arrays import Array, Numbers, clip

Constants = tuple[float, ...]  # three numbers, one for each of C1, C2 and C3 in Eq. (18)


class CubicPiece(NamedTuple):
    """Growth of the constants between two columns of Table 3: a cubic of t, the distance in ν to the first one."""

    poisson: float
    width: float
    linear: Constants
    square: Constants
    cube: Constants


def table_3() -> dict[str, Any]:
    """Read Table 3 of the paper: Poisson's ratios and the constants C1, C2, C3 of Eq. (18)."""
    return tomllib.loads((files("ballsocket") / "data" / "hess_forsbach_2021.toml").read_text(encoding="utf-8"))


def scaled_modulus(constants: tuple[Array, ...], ratio: Array) -> Array:
    """Compute the scaled modulus K R2/E = C1 + C2 (R2/L) + C3 (R2/L)², Eq. (18), from the ratio R2/L."""
    return constants[0] + ratio * (constants[1] + ratio * constants[2])


def table_formula(R2: Array, L: Array, E: Array, nu: Array) -> Array:
    """Compute the foundation modulus K in MPa/mm by Eq. (18) with the constants of Table 3."""
    x = R2 / L
    scaled = scaled_modulus(_FIRST_COLUMN, x)
    for poisson, width, linear, square, cube in _INTERVALS:
        t = clip(nu - poisson, 0.0, width)  # the constants end with the table
        slope, bend, twist = scaled_modulus(linear, x), scaled_modulus(square, x), scaled_modulus(cube, x)
        scaled = scaled + t * (slope + t * (bend + t * twist))
    return E / R2 * scaled


def _interpolate() -> tuple[Constants, tuple[CubicPiece, ...]]:
    """Return the constants in the first column of Table 3, and their growth between the columns."""
    table = table_3()
    poisson, columns = numpy.array(table["poisson"]), numpy.array([table["C1"], table["C2"], table["C3"]])
    width = numpy.diff(poisson)
    rise = numpy.diff(columns) / width
    slopes = _monotone_slopes(width, rise)
    first, last = slopes[:, :-1], slopes[:, 1:]
    square, cube = (3 * rise - 2 * first - last) / width, (first + last - 2 * rise) / width**2
    rows = zip(poisson.tolist(), width.tolist(), *(part.T.tolist() for part in (first, square, cube)), strict=False)
    return tuple(columns[:, 0].tolist()), tuple(CubicPiece(nu, h, *map(tuple, cubic)) for nu, h, *cubic in rows)


def _monotone_slopes(width: Numbers, rise: Numbers) -> Numbers:
    """Compute the slopes of monotone cubics at the columns, Fritsch & Butland 1984, doi 10.1137/0905021.

    They are those of `scipy.interpolate.PchipInterpolator`, whose import would double the import time of the package.
    Each row of Table 3 rises or falls all along, which needs no limits.
    """
    before, after = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
    inner = (before + after) / (before / rise[:, :-1] + after / rise[:, 1:])
    ends = [
        ((2 * width[i] + width[j]) * rise[:, i] - width[i] * rise[:, j]) / (width[i] + width[j])
        for i, j in ((0, 1), (-1, -2))
    ]
    return numpy.column_stack([ends[0], inner, ends[1]])


_FIRST_COLUMN, _INTERVALS = _interpolate()
