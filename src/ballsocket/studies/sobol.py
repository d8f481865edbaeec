"""Sobol indices: the shares that numbers have in the variance of answers, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from warnings import catch_warnings

import numpy

from ..core.arrays import Numbers
from .distributions import Distribution

Answers = Callable[[Numbers], Numbers]
"""From samples (numbers, points) to answers (quantities, points)."""


def sobol(
    answers: Answers, distributions: Sequence[Distribution], count: int, seed: int, confidence: float
) -> dict[str, Numbers]:
    """Indices of first and total order with the ends of their bootstrap intervals, (quantities, numbers) each, by name.

    References
    ----------
    Saltelli et al. 2010, Comput. Phys. Commun. 181, 259; `scipy.stats.sobol_indices`.
    """
    from scipy.stats import sobol_indices

    frozen = [one.frozen for one in distributions]
    with _seeded(seed), numpy.errstate(all="ignore"), catch_warnings(action="ignore"):  # too few samples: NaN
        indices = sobol_indices(func=answers, n=count, dists=frozen, rng=numpy.random.default_rng(seed))
        interval = indices.bootstrap(confidence_level=confidence)
    found: dict[str, Numbers] = {}
    for order in ("first_order", "total_order"):
        ends = getattr(interval, order).confidence_interval
        found |= {order: getattr(indices, order), f"{order}_low": ends.low, f"{order}_high": ends.high}
    return {name: numpy.reshape(values, (-1, len(frozen))) for name, values in found.items()}


@contextmanager
def _seeded(seed: int) -> Iterator[None]:
    """SciPy's bootstrap of these indices draws from NumPy's global stream: seeded here, and left as it was."""
    state = numpy.random.get_state()  # noqa: NPY002
    numpy.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        numpy.random.set_state(state)  # noqa: NPY002
