"""Slopes of answers by JAX, exact to rounding: for models that it can trace."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy

from ..arrays import Numbers
from ..checks import needs
from .answers import Answers
from .unknowns import Scales


def by_tracing(answers: Answers, scales: Scales, places: Numbers) -> tuple[Numbers, Numbers]:
    """Answers and slopes by JAX, compiled for each set of data when first asked, which takes seconds.

    Raises
    ------
    ValueError
        A model that JAX cannot trace.
    ImportError
        JAX is not installed.
    """
    if not answers.model.differentiable:
        raise ValueError(f"{answers.model.name} cannot be traced by JAX: take by_differences")
    needs("jax", "jax")
    import jax

    with jax.enable_x64(True):
        here, slopes = _compiled(answers)(scales.values(places))
    return numpy.asarray(here), numpy.asarray(slopes) * scales.growth(places)


@lru_cache(maxsize=8)
def _compiled(answers: Answers) -> Callable[[Numbers], tuple[Any, Any]]:
    import jax

    def one(values: Any) -> Any:
        return answers.at(values[None, :])[0]

    compiled: Callable[[Numbers], tuple[Any, Any]] = jax.jit(lambda values: (one(values), jax.jacfwd(one)(values)))
    return compiled
