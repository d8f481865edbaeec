"""Points of Sobol's sequence and of Latin hypercubes, drawn in chunks that need no other points."""

from __future__ import annotations

import warnings
from functools import lru_cache
from threading import get_ident
from typing import TYPE_CHECKING

import numpy

from ..core.arrays import Numbers
from ..core.kinds import Choice

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol

CHUNK_SIZE = 1 << 16
"""Number of points of a chunk."""

MAX_SOBOL_COUNT = 1 << 30
"""Number of points of SciPy's Sobol sequence."""

_MAX_SCIPY_COUNT = 1 << 20  # number of points up to which SciPy draws a Latin hypercube, all points at once
_N_ROUNDS = 8  # rounds of the Feistel network
_MULTIPLIERS = (0xFF51AFD7ED558CCD, 0xC4CEB9FE1A85EC53)  # of MurmurHash3's 64-bit finaliser (Appleby 2011)


class Method(Choice):
    """Methods of sampling."""

    SOBOL = "sobol"
    LATIN_HYPERCUBE = "latin-hypercube"


def draw_chunk(method: Method, count: int, dimension: int, seed: int, number: int) -> Numbers:
    """Draw chunk `number` of a design of `count` uniform points in the unit cube: (dimension, points of the chunk)."""
    start, stop = number * CHUNK_SIZE, min(count, (number + 1) * CHUNK_SIZE)
    if method is Method.SOBOL:
        engine = _sobol_engine(dimension, seed, get_ident())
        if engine.num_generated > start:
            engine.reset()
        if engine.num_generated < start:
            engine.fast_forward(start - engine.num_generated)
        return draw_points(engine, stop - start).T
    if count > _MAX_SCIPY_COUNT:
        return _draw_latin_hypercube(count, dimension, seed, start, stop).T
    return _scipy_hypercube(count, dimension, seed)[start:stop].T


def draw_points(engine: Sobol, count: int) -> Numbers:
    """Draw the next points of a Sobol sequence, shape (count, dimension)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # SciPy warns of counts other than powers of two
        points: Numbers = engine.random(count)
    return points


@lru_cache(maxsize=32)
def _sobol_engine(dimension: int, seed: int, thread: int) -> Sobol:
    """Create the engine of a sequence for one thread; its position moves on with each draw."""
    from scipy.stats.qmc import Sobol

    return Sobol(dimension, rng=seed)


@lru_cache(maxsize=1)
def _scipy_hypercube(count: int, dimension: int, seed: int) -> Numbers:
    from scipy.stats.qmc import LatinHypercube

    points: Numbers = LatinHypercube(dimension, rng=seed).random(count)
    return points


def _draw_latin_hypercube(count: int, dimension: int, seed: int, start: int, stop: int) -> Numbers:
    """Draw the points of a section of a Latin hypercube.

    Point i lies in the stratum π(i) of `count` strata, at a random position in it. The permutation π of each dimension
    is a function of i, so that no other points are needed.
    """
    bits = numpy.random.PCG64(seed).advance(start * dimension)
    positions = numpy.random.Generator(bits).random((stop - start, dimension))
    keys = numpy.random.SeedSequence(seed).spawn(1)[0].generate_state(dimension * _N_ROUNDS, numpy.uint64)
    indices = numpy.arange(start, stop, dtype=numpy.uint64)
    strata = [permute(indices, count, column) for column in keys.reshape(dimension, _N_ROUNDS)]
    return (numpy.stack(strata, axis=1) + 1.0 - positions) / count


def permute(indices: Numbers, count: int, keys: Numbers) -> Numbers:
    """Compute a random permutation of the numbers below `count`, for some of them.

    A Feistel network, with one key for each round, permutes the numbers below the next power of four. Results of
    `count` or more are permuted again until they are below: "cycle walking", Black & Rogaway 2002, Ciphers with
    arbitrary finite domains. Indices and keys are arrays of uint64.

    Examples
    --------
    >>> keys = numpy.arange(8, dtype=numpy.uint64)
    >>> sorted(permute(numpy.arange(10, dtype=numpy.uint64), 10, keys).tolist())
    [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]
    """
    half_bits = numpy.uint64(max(1, -(-(count - 1).bit_length() // 2)))
    permuted = _feistel(indices, half_bits, keys)
    outside = permuted >= count
    while outside.any():
        permuted[outside] = _feistel(permuted[outside], half_bits, keys)
        outside = permuted >= count
    return permuted


def _feistel(values: Numbers, half_bits: numpy.uint64, keys: Numbers) -> Numbers:
    """Permute numbers of 2 `half_bits` bits by a Feistel network, with the finaliser of MurmurHash3 in each round."""
    mask = (numpy.uint64(1) << half_bits) - numpy.uint64(1)
    left, right = values >> half_bits, values & mask
    shift = numpy.uint64(33)
    for key in keys:
        mixed = right ^ key
        for multiplier in _MULTIPLIERS:
            mixed = (mixed ^ (mixed >> shift)) * numpy.uint64(multiplier)
        mixed = mixed ^ (mixed >> shift)
        left, right = right, left ^ (mixed & mask)
    return (left << half_bits) | right
