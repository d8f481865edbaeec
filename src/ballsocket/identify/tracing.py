"""Slopes of answers by JAX, exact to rounding: for models that it can trace."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from .answers import Answers
from .unknowns import Scales


def by_tracing(answers: Answers, scales: Scales, places: Numbers) -> tuple[Numbers, Numbers]:
    """Compute answers and derivatives by JAX, compiled at the first call for each set of data, which takes seconds.

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

    values = scales.values(places)
    with jax.enable_x64(True):
        rows = [_compiled(answers)(row) for row in values.reshape(-1, values.shape[-1])]
    here, slopes = (numpy.stack([numpy.asarray(row[part]) for row in rows]) for part in (0, 1))
    shape = places.shape[:-1]
    return here.reshape(*shape, -1), slopes.reshape(*shape, -1, places.shape[-1]) * scales.growth(places)[..., None, :]


@lru_cache(maxsize=8)
def _compiled(answers: Answers) -> Callable[[Numbers], tuple[Any, Any]]:
    import jax

    def one(values: Any) -> Any:
        return answers.at(values[None, :])[0]

    compiled: Callable[[Numbers], tuple[Any, Any]] = jax.jit(lambda values: (one(values), jax.jacfwd(one)(values)))
    return compiled
