"""Chebyshev series of arrays of any library: points, polynomials, sums with slopes, and series of many parameters."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import pi

import numpy

from . import arrays
from .arrays import Array, Numbers

Pair = tuple[Array, Array]  # two arrays, such as a value and its slope


def chebyshev_points(count: int) -> Numbers:
    """Compute the Chebyshev points of this number between -1 and 1, ascending."""
    return -numpy.cos(pi * (numpy.arange(count) + 0.5) / count)


def chebyshev_coefficients(values: Numbers, axis: int) -> Numbers:
    """Compute the Chebyshev coefficients of the polynomial through values at `chebyshev_points`."""
    count = values.shape[axis]
    angles = pi * (numpy.arange(count) + 0.5) / count
    matrix = numpy.cos(numpy.arange(count)[:, None] * (pi - angles)) * (2 / count)
    matrix[0] /= 2
    return numpy.moveaxis(numpy.tensordot(matrix, values, (1, axis)), 0, axis)


def chebyshev_polynomials(coordinate: Array, count: int) -> Array:
    """Compute the Chebyshev polynomials T_0 ... T_count-1 at coordinates (n,), as rows."""
    xp = arrays.namespace(coordinate)
    if xp is not numpy:
        waves = xp.stack([0.0 * coordinate + 1.0, coordinate])
        while waves.shape[0] < count:  # T_m+j = 2 T_m T_j - T_m-j doubles their number
            waves = xp.concat([waves, 2 * waves[-1, ...] * waves[1:, ...] - xp.flip(waves[:-1, ...], axis=0)])
        return waves[:count, ...]
    twice, rows = 2 * coordinate, numpy.empty((count, *coordinate.shape), dtype=coordinate.dtype)
    rows[0], rows[1:2] = 1.0, coordinate
    for k in range(2, count):
        numpy.multiply(twice, rows[k - 1], out=rows[k])
        rows[k] -= rows[k - 2]
    return rows


@cache
def derivative_matrix(count: int) -> numpy.ndarray:
    """Compute the matrix from the Chebyshev coefficients of a function to those of its derivative."""
    square = numpy.zeros((count, count))
    square[:-1] = numpy.polynomial.chebyshev.chebder(numpy.eye(count))
    return square


def sum_series(coefficients: Array, waves: Array) -> Array:
    """Evaluate Chebyshev series from coefficients (angles, joints or 1) and polynomials (angles, contacts)."""
    xp = arrays.namespace(waves)
    if coefficients.shape[-1] == 1:
        return coefficients[:, 0] @ waves
    return numpy.einsum("ij,ij->j", coefficients, waves) if xp is numpy else xp.sum(coefficients * waves, axis=0)


def series_values(coefficients: Array, x: Array) -> Array:
    """Evaluate a Chebyshev series at x (contacts,), from coefficients (angles, joints or 1)."""
    if arrays.all_true(x == x) is None:
        return traced_series(coefficients, x)[0]
    return sum_series(coefficients, chebyshev_polynomials(x, coefficients.shape[0]))


def traced_series(coefficients: Array, x: Array) -> Pair:
    """Evaluate Chebyshev series (angles, joints or 1) with their slopes at x (..., contacts) in traced code."""
    return (_jax_clenshaw_sum() if arrays.is_jax_array(x) else clenshaw_sum)(coefficients, x)


@cache
def _jax_clenshaw_sum() -> Callable[[Array, Array], Pair]:
    """Return `clenshaw_sum` for JAX, with the derivatives of `stored_series`, which compile faster."""
    import jax

    series = jax.custom_jvp(clenshaw_sum)

    @series.defjvp
    def _series_tangent(values: tuple[Array, Array], tangents: tuple[Array, Array]) -> tuple[Pair, Pair]:
        return series(*values), jax.jvp(stored_series, values, tangents)[1]

    return series


def stored_series(coefficients: Array, x: Array) -> Pair:
    """Evaluate a Chebyshev series and its slope at x from all polynomials; shapes as in `traced_series`."""
    waves, xp = chebyshev_polynomials(x, coefficients.shape[0]), arrays.namespace(x)
    shape = (coefficients.shape[0], *(1 for _ in x.shape[1:]), coefficients.shape[1])
    slopes = arrays.convert_like(derivative_matrix(shape[0]), x) @ coefficients
    value, slope = (xp.sum(xp.reshape(series, shape) * waves, axis=0) for series in (coefficients, slopes))
    return value, slope


def clenshaw_sum(coefficients: Array, x: Array) -> Pair:
    """Evaluate a Chebyshev series and its slope at x by one recurrence of Clenshaw, which stores nothing.

    Compilers fuse it with the formulas around it. `coefficients` has the shape (angles, joints or 1).
    """
    twice = 2 * x
    value = previous = slope = previous_slope = 0.0 * x
    for k in range(coefficients.shape[0] - 1, 0, -1):
        slope, previous_slope = 2 * value + twice * slope - previous_slope, slope
        value, previous = coefficients[k, ...] + twice * value - previous, value
    return coefficients[0, ...] + x * value - previous, value + x * slope - previous_slope


def contract_factors(matrix: Array, *factors: Array) -> Pair:
    """Multiply a matrix (rows, products) by the factors that all joints share; return it and the other products.

    A sweep of one material is three times as fast as with the products of all factors.
    """
    xp = arrays.namespace(matrix)
    cube = xp.reshape(matrix, (-1, *(factor.shape[0] for factor in factors)))
    for axis in reversed(range(len(factors))):
        if factors[axis].shape[1] == 1:
            cube = xp.tensordot(cube, factors[axis][:, 0], axes=((axis + 1,), (0,)))
    varying = [factor for factor in factors if factor.shape[1] != 1]
    if not varying:
        return cube[:, None], xp.ones((1, 1), dtype=matrix.dtype, device=arrays.device(matrix))
    products = varying[0]
    for factor in varying[1:]:
        products = xp.reshape(products[:, None, :] * factor[None, :, :], (-1, products.shape[1]))
    return xp.reshape(cube, (matrix.shape[0], -1)), products
