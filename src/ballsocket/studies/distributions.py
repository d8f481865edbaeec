"""Distributions of scattered parameters, tolerances of drawings, rank correlations, and the points of their samples."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf, log, pi
from threading import get_ident
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require
from ..core.kinds import Choice, Unit

if TYPE_CHECKING:
    from scipy.stats.qmc import Sobol


@dataclass(frozen=True, kw_only=True)
class Rectangular:
    """Uniform distribution from `low` to `high`.

    Raises ValueError: an end that is not finite, or `low` not below `high`.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        require("low", self.low, -inf < self.low < self.high, f"it is finite and below high = {self.high:g}")
        require("high", self.high, self.high < inf, "it is finite")

    @property
    def frozen(self) -> Any:
        """Distribution of `scipy.stats`."""
        from scipy.stats import uniform

        return uniform(self.low, self.high - self.low)


@dataclass(frozen=True, kw_only=True)
class Normal:
    """Normal distribution, truncated at `low` and `high` as by an inspection of parts.

    Parameters
    ----------
    mean, deviation : float
        Mean and standard deviation before truncation; the deviation is positive.
    low, high : float
        Ends of the truncated distribution; infinite by default.

    Raises
    ------
    ValueError
        A number is not allowed; the message has its name and value.
    """

    mean: float
    deviation: float
    low: float = -inf
    high: float = inf

    def __post_init__(self) -> None:
        require("mean", self.mean, abs(self.mean) < inf, "it is finite")
        require("deviation", self.deviation, 0 < self.deviation < inf, "a standard deviation is above 0 and finite")
        require("low", self.low, self.low < self.high, f"it is below high = {self.high:g}")

    @property
    def frozen(self) -> Any:
        """Distribution of `scipy.stats`."""
        from scipy.stats import norm, truncnorm

        if (self.low, self.high) == (-inf, inf):
            return norm(self.mean, self.deviation)
        ends = ((end - self.mean) / self.deviation for end in (self.low, self.high))
        return truncnorm(*ends, loc=self.mean, scale=self.deviation)


@dataclass(frozen=True, kw_only=True)
class LogNormal:
    """Log-normal distribution, for numbers that scatter by a factor, such as wear coefficients.

    Parameters
    ----------
    median : float
        Positive median.
    factor : float
        Factor of one standard deviation, above 1: 68 % of the values lie between median / factor and median · factor.

    Raises
    ------
    ValueError
        A number is not allowed; the message has its name and value.

    Examples
    --------
    >>> round(float(LogNormal(median=1e-6, factor=1.5).frozen.ppf(0.975)), 9)
    2.214e-06
    """

    median: float
    factor: float

    def __post_init__(self) -> None:
        require("median", self.median, 0 < self.median < inf, "it is positive and finite")
        require(
            "factor", self.factor, 1 < self.factor < inf, "a factor of one standard deviation is above 1 and finite"
        )

    @property
    def frozen(self) -> Any:
        """Distribution of `scipy.stats`."""
        from scipy.stats import lognorm

        return lognorm(log(self.factor), scale=self.median)


Distribution = Rectangular | Normal | LogNormal
"""Any of the distributions."""

_TAIL_PROBABILITY = 1e-3  # tail probability at which an unbounded distribution is cut for the check of a nominal value
_ROUNDING = 1e-9  # rounding error of a nominal value relative to the ends of its distribution


def check_nominal(name: str, nominal: float, distribution: Distribution, unit: Unit) -> None:
    """Check that a nominal value lies in the distribution of its quantity; otherwise its result lies outside the band.

    Raises ValueError: the value lies outside; the message shows it in `unit`.
    """
    bounded = all(abs(float(end)) < inf for end in distribution.frozen.support())
    probabilities = (0.0, 1.0) if bounded else (_TAIL_PROBABILITY, 1 - _TAIL_PROBABILITY)
    low, high = (float(distribution.frozen.ppf(probability)) for probability in probabilities)
    slack = _ROUNDING * max(abs(low), abs(high))
    if not low - slack <= nominal <= high + slack:
        value, lowest, highest = (f"{number * unit.factor:.6g}" for number in (nominal, low, high))
        text = f" {unit.text}".rstrip()
        raise ValueError(
            f"{name} = {value}{text} lies outside its tolerance of {lowest} to {highest}{text}: change one of them"
        )


def tolerance(nominal: float, plus_minus: float) -> Normal:
    """Create the truncated normal distribution of a tolerance, such as 0.10 ± 0.05 mm.

    Each limit is three standard deviations from the nominal value. No value lies beyond the limits.

    Examples
    --------
    >>> tolerance(0.10, 0.06).deviation
    0.02
    """
    require("plus_minus", plus_minus, 0 < plus_minus < inf, "a tolerance is above 0 and finite")
    low, high = nominal - plus_minus, nominal + plus_minus
    return Normal(mean=nominal, deviation=plus_minus / 3, low=low, high=high)


Correlation = Mapping[tuple[str, str], float]
"""Rank correlations (Spearman) of pairs of parameters by their names; other pairs are independent."""


def copula_matrix(names: Sequence[str], correlation: Correlation) -> Numbers:
    """Compute the correlation matrix of the normal variables of a Gaussian copula, for rank correlations of pairs.

    The rank correlation ρ of two parameters, whatever their distributions, needs the correlation 2 sin(π ρ/6) of their
    normal variables.

    Parameters
    ----------
    names : sequence of str
        Names of the parameters.
    correlation : mapping of (str, str) to float
        Rank correlations between -1 and 1.

    Returns
    -------
    array of shape (len(names), len(names))

    Raises
    ------
    ValueError
        An unknown name, a pair that occurs twice, a correlation that is not between -1 and 1, or correlations that no
        joint distribution has.

    References
    ----------
    Pearson 1907, Drapers' Company Research Memoirs, Biometric Series IV.

    Examples
    --------
    >>> copula_matrix(["clearance", "liner_young"], {("clearance", "liner_young"): 0.5}).round(4)
    array([[1.    , 0.5176],
           [0.5176, 1.    ]])
    """
    matrix = numpy.eye(len(names))
    for (one, other), rank in correlation.items():
        check_names([one, other], names, "among the correlated parameters")
        label = f"correlation of {one} and {other}"
        if one == other:
            raise ValueError(f"{label} needs two parameters")
        require(label, rank, -1 < rank < 1, "a rank correlation is between -1 and 1")
        i, j = names.index(one), names.index(other)
        if matrix[i, j]:
            raise ValueError(f"the {label} is given twice; one is needed")
        matrix[i, j] = matrix[j, i] = 2 * numpy.sin(pi * rank / 6)
    if numpy.linalg.eigvalsh(matrix)[0] < _SMALLEST_EIGENVALUE:
        raise ValueError(f"no joint distribution has the correlations {correlation_text(correlation)}: reduce them")
    return matrix


def correlation_text(correlation: Correlation) -> str:
    """Format rank correlations, such as "clearance, liner_young = 0.5"."""
    return "; ".join(f"{one}, {other} = {rank:g}" for (one, other), rank in correlation.items())


_SMALLEST_EIGENVALUE = 1e-6  # smallest eigenvalue of a matrix of correlations that can be sampled
_SMALLEST_PROBABILITY = 1e-16  # probability at which normal quantiles are cut, so that they are finite


def correlate(probabilities: Numbers, matrix: Numbers) -> Numbers:
    """Correlate independent uniform samples, shape (n_parameters, n_points), by a Gaussian copula."""
    from scipy.special import ndtr

    correlated: Numbers = ndtr(numpy.linalg.cholesky(matrix) @ normal_quantiles(probabilities))
    return correlated


def normal_quantiles(probabilities: Numbers) -> Numbers:
    """Compute finite quantiles of the standard normal distribution."""
    from scipy.special import ndtri

    cut = numpy.clip(probabilities, _SMALLEST_PROBABILITY, 1 - _SMALLEST_PROBABILITY)
    quantiles: Numbers = ndtri(cut)
    return quantiles


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
