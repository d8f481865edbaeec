"""Compiled evaluation of the curve of a joint at many loads."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy

from ..contact.octave_curve import OctaveCurve
from ..core.arrays import Numbers
from .overloads import compile_loop, frexp


def evaluate_curve(curve: OctaveCurve, x: Numbers) -> Numbers:
    """Evaluate all quantities of a curve (quantities, n) at numbers (n,) between both ends."""
    quantities, terms, _ = curve.coefficients.shape
    values = numpy.empty((quantities, len(x)))
    rows = numpy.ascontiguousarray(curve.coefficients.transpose(2, 0, 1))
    _curve_loop(quantities, terms)(x, curve.first, curve.density, curve.origins, rows, values)
    return values


@cache
def _curve_loop(quantities: int, terms: int) -> Any:
    """Return the compiled loop over numbers; the counts are constants of it, so that inner loops are unrolled."""

    def evaluate(x, first, density, origins, rows, values):  # type: ignore[no-untyped-def]
        """Evaluate the polynomials of the piece of each number."""
        for j in range(len(x)):
            mantissa, exponent = frexp(x[j])
            piece = min(int(2 * density * mantissa) + density * exponent - first, len(origins) - 1)
            offset = x[j] - origins[piece]
            for row in range(quantities):
                total = rows[piece, row, 0]
                for term in range(1, terms):
                    total = total * offset + rows[piece, row, term]
                values[row, j] = total

    return compile_loop(evaluate)
