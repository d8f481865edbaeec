"""Derivatives by JAX, exact to rounding, for models that it can trace."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from .forward_model import ForwardModel
from .unknowns import ParameterTransform


def by_tracing(forward: ForwardModel, transform: ParameterTransform, theta: Numbers) -> tuple[Numbers, Numbers]:
    """Compute model results and their derivatives with respect to theta by JAX.

    The first call for a set of data compiles the model, which takes seconds.

    Parameters
    ----------
    forward : ForwardModel
    transform : ParameterTransform
    theta : array (..., unknowns)
        Scaled parameters.

    Returns
    -------
    results : array (..., data)
    derivatives : array (..., data, unknowns)
        Derivatives with respect to theta.

    Raises
    ------
    ValueError
        A model that JAX cannot trace.
    ImportError
        JAX is not installed.
    """
    if not forward.model.differentiable:
        raise ValueError(f"{forward.model.name} cannot be traced by JAX: use by_differences")
    needs("jax", "jax")
    import jax

    values = transform.to_values(theta)
    with jax.enable_x64(True):
        results_and_slopes = [
            _compile_forward_model(forward)(point_values) for point_values in values.reshape(-1, values.shape[-1])
        ]
    results, slopes = (
        numpy.stack([numpy.asarray(point_result[index]) for point_result in results_and_slopes]) for index in (0, 1)
    )
    shape = theta.shape[:-1]
    slopes = slopes.reshape(*shape, -1, theta.shape[-1])
    return results.reshape(*shape, -1), slopes * transform.derivatives(theta)[..., None, :]


@lru_cache(maxsize=8)
def _compile_forward_model(forward: ForwardModel) -> Callable[[Numbers], tuple[Any, Any]]:
    """Compile the results of a forward model and their derivatives with JAX."""
    import jax

    def results_of_point(values: Any) -> Any:
        """Compute the model results (data,) for one set of values of the unknowns."""
        return forward.results_at(values[None, :])[0]

    compiled: Callable[[Numbers], tuple[Any, Any]] = jax.jit(
        lambda values: (results_of_point(values), jax.jacfwd(results_of_point)(values))
    )
    return compiled
