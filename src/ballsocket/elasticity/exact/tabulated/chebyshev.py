"""Tables of Chebyshev coefficients, and their coordinates for liner, ball and half angle."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial
from importlib.resources import files
from math import log, prod
from pathlib import Path
from zipfile import BadZipFile

import numpy

from ....contact.coordinates import RATIO_SHIFT, angle_root
from ....core import arrays
from ....core.arrays import Array, convert_like, exp, sqrt
from ....core.arrays import log as ln
from ....core.chebyshev import chebyshev_polynomials, contract_factors
from ....core.input_files import open_input

POISSON = (-0.5, 0.4993)  # range of ν in the tables, slightly wider than the model's domain
THICKNESS_RATIO = (0.195, 20.5)  # range of R2/L in the tables, slightly wider than the model's domain
MAX_BALL_SHARE = 0.0275  # ratio β/(1 + β) of the softest ball in the tables: E/E_ball slightly above 0.02

WITH_BALL = {"rigid": "ball", "profile": "profile_ball"}
"""Name of the table for an elastic ball, by that for a rigid one."""


# Coordinates run from -1 to 1; the tabulated functions are smooth in them.


def poisson_coordinate(poisson: Array) -> Array:
    """Compute the table coordinate of Poisson's ratio ν, from -1 to 1.

    It is linear in ln(1 - 2ν), because the compliance varies by decades towards ν = 1/2.
    """
    low, high = log(1 - 2 * POISSON[1]), log(1 - 2 * POISSON[0])
    return (high + low - 2 * ln(1 - 2 * poisson)) / (high - low)


def thickness_coordinate(ratio: Array) -> Array:
    """Compute the table coordinate of the ratio R2/L, from -1 to 1; it is a shifted logarithm."""
    low, high = (log(end + RATIO_SHIFT) for end in THICKNESS_RATIO)
    return (2 * ln(ratio + RATIO_SHIFT) - low - high) / (high - low)


def angle_coordinate(angle: Array, ratio: Array) -> Array:
    """Compute the table coordinate of the half angle ε, from -1 to 1.

    A square root removes the singularity ε ln ε of a point contact, a logarithm scales with the thickness L.
    """
    return 2 * angle_root(angle, ratio) - 1


def thickness_ratio_at(coordinate: Array) -> Array:
    """Compute the ratio R2/L from its table coordinate."""
    low, high = (log(end + RATIO_SHIFT) for end in THICKNESS_RATIO)
    return exp((low + high + coordinate * (high - low)) / 2) - RATIO_SHIFT


def ball_scale(poisson: Array, ratio: Array) -> Array:
    """Compute the share of the compliance above which the ball affects a thin liner."""
    return 1.1 * sqrt(1 - 2 * poisson) / ratio


def ball_coordinate(share: Array, poisson: Array, ratio: Array) -> Array:
    """Compute the table coordinate of the ball's share of the compliance, from -1 (rigid) to 1."""
    scale = ball_scale(poisson, ratio)
    return 2 * ln(1 + share / scale) / ln(1 + MAX_BALL_SHARE / scale) - 1


def ball_shrinkage(ball_poisson: Array) -> Array:
    """Compute the shrinkage of the ball under a uniform pressure, the table parameter for its ν."""
    return (1 - 2 * ball_poisson) / (1 - ball_poisson * ball_poisson)


@dataclass(frozen=True, kw_only=True, eq=False)
class ChebyshevTable:
    """Functions of the half angle as sums of products of Chebyshev polynomials of liner and ball coordinates.

    Few combinations of the products matter: those of `liner` (combinations, products) and, for an elastic ball, those
    of `ball` (combinations, products * combinations of the liner). `curves` (functions * angles, combinations)
    turns them into Chebyshev coefficients. `counts` are the numbers of polynomials of ν, R2/L and the ball's two
    coordinates.
    """

    counts: tuple[int, int, int, int]
    liner: numpy.ndarray
    ball: numpy.ndarray
    curves: numpy.ndarray
    shape: tuple[int, int]

    def coefficients_at(self, coordinates: list[Array]) -> Array:
        """Compute Chebyshev coefficients (functions, angles, joints) at coordinates of ν, R2/L and the ball.

        Coordinates have the shape (joints,), or (1,) if all joints have the same.
        """
        polynomials = [chebyshev_polynomials(*pair) for pair in zip(coordinates, self.counts, strict=False)]
        return self.coefficients_of_polynomials(polynomials)

    def coefficients_of_polynomials(self, polynomials: list[Array]) -> Array:
        """Compute the coefficients from Chebyshev polynomials (orders or more, joints or 1) of the coordinates."""
        first, second, *ball = (values[:count, ...] for values, count in zip(polynomials, self.counts, strict=False))
        matrix, products = contract_factors(convert_like(self.liner, first), first, second)
        if ball:
            matrix, products = contract_factors(convert_like(self.ball, first), *ball, matrix @ products)
        curves = convert_like(self.curves, first)
        few_products = matrix.shape[1] < matrix.shape[0]  # such as those of R2/L alone: the smaller matrices first
        values = (curves @ matrix) @ products if few_products else curves @ (matrix @ products)
        return arrays.namespace(first).reshape(values, (*self.shape, -1))

    def coefficients_of_one(self, coordinates: list[float]) -> numpy.ndarray:
        """Compute the coefficients (functions, angles) of one joint."""
        first, second, *ball = (chebyshev_values(*pair) for pair in zip(coordinates, self.counts, strict=False))
        combinations = self.liner @ numpy.outer(first, second).ravel()
        if ball:
            combinations = self.ball @ numpy.outer(numpy.outer(*ball), combinations).ravel()
        return (self.curves @ combinations).reshape(self.shape)


def chebyshev_values(coordinate: float, count: int) -> numpy.ndarray:
    """Compute the Chebyshev polynomials T_0 ... T_count-1 at one coordinate."""
    return numpy.cos(_polynomial_orders(count) * math.acos(min(max(coordinate, -1.0), 1.0)))


_polynomial_orders = cache(partial(numpy.arange, dtype=float))


@cache
def load_tables(file: str = "") -> dict[str, ChebyshevTable]:
    """Load the tables of a file by their names, from a cache.

    The names are "rigid" for a rigid ball, "ball" for the change by an elastic one, and "profile" and "profile_ball"
    for the pressure profile.

    Raises ValueError: the file holds no tables.
    Raises OSError: the file cannot be read.
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
    return {name: compress_coefficients(values, angles.get(name, 0)) for name, values in stored.items()}


def compress_coefficients(coefficients: numpy.ndarray, angles: int = 0) -> ChebyshevTable:
    """Compress coefficients (ν, R2/L, ball share, ball ν, function, angle) to a table with at least `angles` angles.

    Negligible singular values are omitted.
    """
    *counts, functions, stored_angles = coefficients.shape
    padded = numpy.pad(coefficients.astype(float), (*[(0, 0)] * 5, (0, max(angles - stored_angles, 0))))
    shape, balls = (functions, padded.shape[-1]), counts[2] * counts[3]
    threshold = 5e-8 if coefficients.dtype == numpy.float64 else 2e-6  # in double, in single precision
    liner, remainder = _truncated_svd(padded.reshape(counts[0] * counts[1], -1), threshold)
    remainder = numpy.moveaxis(remainder.reshape(len(remainder), balls, prod(shape)), 0, 1).reshape(-1, prod(shape))
    ball, curves = _truncated_svd(remainder, threshold) if balls > 1 else (numpy.empty((0, 0)), remainder)
    factors = {"liner": liner, "ball": ball, "curves": curves}
    contiguous = {name: numpy.ascontiguousarray(factor.T) for name, factor in factors.items()}
    return ChebyshevTable(counts=tuple(counts), shape=shape, **contiguous)


def _truncated_svd(matrix: numpy.ndarray, threshold: float) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Factor a matrix into two by its singular values, without those up to the threshold."""
    left, sizes, right = numpy.linalg.svd(matrix, full_matrices=False)
    significant = sizes > threshold
    return left[:, significant] * sizes[significant], right[significant]
