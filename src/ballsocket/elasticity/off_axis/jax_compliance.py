"""Compliance of a bore in JAX as a function of its liner: Young's modulus, Poisson's ratio and thickness.

NumPy computes the matrices and their derivatives; JAX calls NumPy for them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any, NamedTuple

import numpy

from ...core.arrays import Array, Numbers
from ...problem import Joint
from ...problem.cup import Cup
from .compliance import cached_compliance
from .jax_search import Grids
from .ring_matrices import liner_numbers, vary_liner
from .surfaces import Surface


class Operators(NamedTuple):
    """Matrices (m, rings, rings) of a bore and of the same in cells twice as wide: see `Compliance`."""

    softness: Array
    stiffness: Array
    coarse_softness: Array
    coarse_stiffness: Array

    def replace_in(self, grids: Grids) -> Grids:
        """Return the arrays of a bore with these matrices."""
        return Grids(
            fine=grids.fine._replace(softness=self.softness, stiffness=self.stiffness),
            coarse=grids.coarse._replace(softness=self.coarse_softness, stiffness=self.coarse_stiffness),
        )


@dataclass(frozen=True, kw_only=True)
class LinerCompliance:
    """Compliance matrices of one joint for any liner."""

    surface: Any
    joint: Joint  # a joint without arrays. Its bore stays the same.
    cup: Cup
    ring_width: float  # in rad, 3° or less

    def operators(self, liner: Numbers) -> Operators:
        """Compute the matrices for Young's modulus in MPa, Poisson's ratio and thickness in mm of the liner."""
        compliance = cached_compliance(self.surface, self._vary(liner), self.cup, self.ring_width)
        coarser = compliance.coarser_compliance
        if coarser is None:
            raise ValueError("the compliance of a liner needs rings of 3 degrees or less")
        operators: tuple[Any, ...] = (compliance.softness, compliance.stiffness, coarser.softness, coarser.stiffness)
        return Operators(*(operator.matrices for operator in operators))

    def softness_slopes(self, liner: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the derivatives of both softnesses by the three numbers of the liner: (3, m, rings, rings)."""
        return _softness_slopes(self.surface, self._vary(liner), self.cup, self.ring_width)

    def _vary(self, liner: Numbers) -> Joint:
        return vary_liner(self.joint, tuple(map(float, liner)))


@lru_cache(maxsize=2)
def _softness_slopes(surface: Surface, joint: Joint, cup: Cup, width: float) -> tuple[Numbers, Numbers]:
    grid = cached_compliance(surface, joint, cup, width).grid
    slopes = surface.ring_slopes(joint, cup, grid)
    return slopes, numpy.stack([grid.coarsen_matrices(slope) for slope in slopes])


def differentiable_operators(bore: LinerCompliance, dtype: str) -> Callable[[Array], Operators]:
    """Return a function of JAX from the numbers of a liner (3,) to `Operators`, with derivatives of first order.

    The stiffnesses have no derivatives: they only precondition the iteration.
    """
    import jax

    def shapes_of(values: Any) -> Any:
        return jax.tree.map(lambda array: jax.ShapeDtypeStruct(array.shape, dtype), values)

    def convert(compute: Callable[[Numbers], Any], liner: Array) -> Any:
        """Compute arrays on the host in the precision of the device."""
        return jax.tree.map(partial(numpy.asarray, dtype=dtype), compute(numpy.asarray(liner, dtype=float)))

    nominal = bore.operators(liner_numbers(bore.joint))
    operator_shapes = shapes_of(nominal)
    slope_shapes = tuple(
        jax.ShapeDtypeStruct((3, *matrices.shape), dtype) for matrices in (nominal.softness, nominal.coarse_softness)
    )

    @jax.custom_jvp
    def operators(liner: Array) -> Operators:
        matrices: Operators = jax.pure_callback(
            partial(convert, bore.operators), operator_shapes, liner, vmap_method="sequential"
        )
        return matrices

    @operators.defjvp
    def differentiate(primals: Any, tangents: Any) -> Any:
        (liner,), (change,) = primals, tangents
        slopes = jax.pure_callback(
            partial(convert, bore.softness_slopes), slope_shapes, liner, vmap_method="sequential"
        )
        matrices = operators(liner)
        softness, coarse_softness = (jax.numpy.tensordot(change, slope, 1) for slope in slopes)
        changes = Operators(
            softness=softness,
            stiffness=0.0 * matrices.stiffness,
            coarse_softness=coarse_softness,
            coarse_stiffness=0.0 * matrices.coarse_stiffness,
        )
        return matrices, changes

    return operators
