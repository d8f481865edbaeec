"""The tables themselves: where liner, ball and half angle lie on the axes, and the Chebyshev series over them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from math import log, pi, prod, radians
from pathlib import Path
from zipfile import BadZipFile

import numpy

from ....core import arrays
from ....core.arrays import Array, Numbers, cos, exp, log1p, sqrt
from ....core.arrays import log as ln
from ....core.input_files import open_input

LIMIT = radians(85.0)
"""The widest contact of the tables."""

POISSON = (-0.5, 0.4993)
THICKNESS_RATIO = (0.195, 20.5)
"""The ends of the tables: a little more than is answered."""

STIFFEST_SHARE = 0.0275
"""β/(1 + β) of the softest ball in the tables: E/E_ball 0.02 and a little more."""

ANGLE_SCALE, RATIO_SHIFT = 0.8, 0.2
"""Of the axes of ε and R2/L: what is tabulated is smooth in them. Tables belong to the axes they were built with."""

WITH_BALL = {"rigid": "ball", "profile": "profile_ball"}


# The axes: places run from -1 to 1, and what is tabulated is smooth in them.


def poisson_coordinate(poisson: Array) -> Array:
    """ν as ln(1 - 2ν): stiffness falls by decades towards ν = 1/2."""
    near, far = log(1 - 2 * POISSON[1]), log(1 - 2 * POISSON[0])
    return (far + near - 2 * ln(1 - 2 * poisson)) / (far - near)


def thickness_coordinate(ratio: Array) -> Array:
    """R2/L as its shifted logarithm."""
    low, high = (log(end + RATIO_SHIFT) for end in THICKNESS_RATIO)
    return (2 * ln(ratio + RATIO_SHIFT) - low - high) / (high - low)


def angle_coordinate(angle: Array, ratio: Array) -> Array:
    """ε as the root of a logarithm: the root tames ε ln ε at a point contact, the logarithm follows L."""
    return 2 * angle_root(angle, ratio) - 1


def angle_root(angle: Array, ratio: Array) -> Array:
    """The root itself, from 0 to 1; of an angle as small as the rounding of 1 too."""
    near = ANGLE_SCALE * (1 + ratio)
    return sqrt(log1p(near * angle) / log1p(near * LIMIT))


def angle_at(place: Array, ratio: Array) -> Array:
    """ε at a place."""
    near, share = ANGLE_SCALE * (1 + ratio), (1 + place) / 2
    return (exp(share * share * ln(1 + near * LIMIT)) - 1) / near


def ball_scale(poisson: Array, ratio: Array) -> Array:
    """The ball's share of the compliance at which a thin liner begins to notice it."""
    return 1.1 * sqrt(1 - 2 * poisson) / ratio


def ball_coordinate(share: Array, poisson: Array, ratio: Array) -> Array:
    """The ball's share of the compliance, from -1 (rigid) to 1."""
    scale = ball_scale(poisson, ratio)
    return 2 * ln(1 + share / scale) / ln(1 + STIFFEST_SHARE / scale) - 1


def roundness(ball_poisson: Array) -> Array:
    """What matters of the ball's ν: how a uniform pressure shrinks it."""
    return (1 - 2 * ball_poisson) / (1 - ball_poisson * ball_poisson)


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevTable:
    """JointCurves over the half angle, as a sum of products of Chebyshev chebyshev_polynomials of the places of liner and ball.

    Few combinations of the products matter: those of `liner` (combinations, products) and, where there is a ball,
    those of `ball` (combinations, products * combinations of the liner). `curves` (functions * angles, combinations)
    turns them into Chebyshev coefficients. `counts` are the chebyshev_polynomials of ν, R2/L and the ball's two places.
    """

    counts: tuple[int, int, int, int]
    liner: numpy.ndarray
    ball: numpy.ndarray
    curves: numpy.ndarray
    shape: tuple[int, int]

    def of(self, places: list[Array]) -> Array:
        """Chebyshev coefficients (functions, angles, joints) at the places of ν, R2/L and of the ball.

        Places are (joints,), or (1,) where all joints have the same.
        """
        first, second, *ball = (chebyshev_polynomials(*both) for both in zip(places, self.counts, strict=False))
        found = _applied(as_like(self.liner, first), first, second)
        if ball:
            found = _applied(as_like(self.ball, first), *ball, found)
        return arrays.namespace(first).reshape(as_like(self.curves, first) @ found, (*self.shape, -1))

    def of_one(self, places: list[float]) -> numpy.ndarray:
        """Values (functions, angles) of one joint."""
        first, second, *ball = (chebyshev_values(*both) for both in zip(places, self.counts, strict=False))
        found = self.liner @ numpy.outer(first, second).ravel()
        if ball:
            found = self.ball @ numpy.outer(numpy.outer(*ball), found).ravel()
        return (self.curves @ found).reshape(self.shape)


def _applied(matrix: Array, *factors: Array) -> Array:
    """matrix (rows, products) times all products of the rows of the factors (each its rows, joints or 1).

    What is the same for all joints is taken into the matrix first: a sweep of one material costs a third.
    """
    xp = arrays.namespace(matrix)
    cube = xp.reshape(matrix, (-1, *(factor.shape[0] for factor in factors)))
    for axis in reversed(range(len(factors))):
        if factors[axis].shape[1] == 1:
            cube = xp.tensordot(cube, factors[axis][:, 0], axes=((axis + 1,), (0,)))
    varying = [factor for factor in factors if factor.shape[1] > 1]
    if not varying:
        return cube[:, None]
    rows = varying[0]
    for factor in varying[1:]:
        rows = xp.reshape(rows[:, None, :] * factor[None, :, :], (-1, rows.shape[1]))
    return xp.reshape(cube, (matrix.shape[0], -1)) @ rows


def chebyshev_polynomials(place: Array, count: int) -> Array:
    """T_0 ... T_count-1 at places (n,), as rows: by recurrence in NumPy, in few steps to compile elsewhere."""
    xp = arrays.namespace(place)
    if xp is not numpy:
        return cos(as_like(numpy.arange(count, dtype=float), place)[:, None] * xp.acos(place))
    twice, rows = 2 * place, numpy.empty((count, *place.shape), dtype=place.dtype)
    rows[0], rows[1:2] = 1.0, place
    for k in range(2, count):
        numpy.multiply(twice, rows[k - 1], out=rows[k])
        rows[k] -= rows[k - 2]
    return rows


def chebyshev_points(count: int) -> Numbers:
    """Chebyshev points from -1 to 1."""
    return -numpy.cos(pi * (numpy.arange(count) + 0.5) / count)


def coefficients(values: Numbers, axis: int) -> Numbers:
    """Coefficients of the polynomial through values at `places`."""
    count = values.shape[axis]
    turn = pi * (numpy.arange(count) + 0.5) / count
    matrix = numpy.cos(numpy.arange(count)[:, None] * (pi - turn)) * (2 / count)
    matrix[0] /= 2
    return numpy.moveaxis(numpy.tensordot(matrix, values, (1, axis)), 0, axis)


def chebyshev_values(place: float, count: int) -> numpy.ndarray:
    """T_0 ... T_count-1 at one place."""
    return numpy.cos(_orders(count) * math.acos(min(max(place, -1.0), 1.0)))


@cache
def _orders(count: int) -> numpy.ndarray:
    return numpy.arange(count, dtype=float)


def as_like(values: numpy.ndarray, like: Array) -> Array:
    """A table in the library, dtype and device of the caller."""
    xp = arrays.namespace(like)
    if xp is numpy and like.dtype == values.dtype:
        return values
    return xp.asarray(values, dtype=like.dtype, device=arrays.device(like))


@cache
def tables(file: str = "") -> dict[str, ChebyshevTable]:
    """The tables in a file, read when first asked for: "rigid", its "profile", and what a "ball" adds to each.

    Raises
    ------
    ValueError
        Another file.
    OSError
        It cannot be read.
    """
    shipped = files("ballsocket") / "data" / "exact_tables.npz"
    with open_input(Path(file)) if file else shipped.open("rb") as stream:
        try:
            stored = dict(numpy.load(stream))
        except (ValueError, TypeError, EOFError, BadZipFile) as error:
            raise ValueError(f"{file} holds no tables") from error
    if set(stored) != {*WITH_BALL, *WITH_BALL.values()}:
        raise ValueError(f"{file} holds no tables")
    angles = {ball: stored[name].shape[-1] for name, ball in WITH_BALL.items()}
    return {name: compress(values, angles.get(name, 0)) for name, values in stored.items()}


def compress(coefficients: numpy.ndarray, angles: int = 0) -> ChebyshevTable:
    """A table from coefficients (ν, R2/L, share, roundness, function, angle), with room for more `angles`.

    Singular values that do not count are left out.
    """
    *counts, functions, given = coefficients.shape
    whole = numpy.pad(coefficients.astype(float), (*[(0, 0)] * 5, (0, max(angles - given, 0))))
    shape, balls = (functions, whole.shape[-1]), counts[2] * counts[3]
    least = 5e-8 if coefficients.dtype == numpy.float64 else 2e-6  # in double, in single precision
    liner, rest = _combined(whole.reshape(counts[0] * counts[1], -1), least)
    rest = numpy.moveaxis(rest.reshape(len(rest), balls, prod(shape)), 0, 1).reshape(-1, prod(shape))
    ball, curves = _combined(rest, least) if balls > 1 else (numpy.empty((0, 0)), rest)
    factors = (numpy.ascontiguousarray(factor.T) for factor in (liner, ball, curves))
    return ChebyshevTable(
        counts=tuple(counts), shape=shape, **dict(zip(("liner", "ball", "curves"), factors, strict=True))
    )


def _combined(matrix: numpy.ndarray, least: float) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Two factors of a matrix, narrow where its singular values allow."""
    left, sizes, right = numpy.linalg.svd(matrix, full_matrices=False)
    kept = sizes > least
    return left[:, kept] * sizes[kept], right[kept]
