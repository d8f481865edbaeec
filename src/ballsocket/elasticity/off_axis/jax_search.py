"""Search for the equilibrium of many balls in JAX, compiled, with derivatives by loads, gaps and the liner.

The search is that of `coupled_search`. Lanes that have converged are masked until a quarter is left, which continues
in arrays of its own. Derivatives follow from one Newton step at the solution, in its touching cells. The step is zero
there, and its derivative is that of the solution. NumPy computes the compliance of a liner and its derivatives; JAX
calls NumPy for them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache, partial
from typing import Any, NamedTuple

import numpy

from ...core.arrays import Array, Numbers
from ...problem import Joint
from ...problem.cup import Cup
from . import coupled_search as search
from .compliance import cached_compliance
from .coupled_search import BoreArrays, Lanes, Predictor
from .ring_matrices import liner_numbers, vary_liner
from .surfaces import Surface

_MAX_ITERATIONS = 30
_TOLERANCE_FACTOR = 0.8  # of the tolerance to which lanes are iterated, before their residuals are computed anew
_NEWTON_ITERATIONS = 20  # number of conjugate-gradient iterations in the Newton step that carries derivatives
_REMAINING_FRACTION = 4  # lanes are iterated together until one in so many has not converged


class Grids(NamedTuple):
    """Arrays of the bore in its own cells, and in cells twice as wide."""

    fine: BoreArrays
    coarse: BoreArrays


@cache
def differentiable_search() -> Any:
    """Return the solver of displacements and pressures, with derivatives by loads, gaps and compliance.

    Its arguments are `Grids`, loads (3, loads) in N, gaps (meridians, rings, 1) in mm, initial displacements (3, loads)
    in mm, and the tolerance. It returns displacements (3, loads) and pressures (meridians, rings, loads).
    """
    import jax
    import jax.numpy as xp

    @jax.custom_jvp
    def solve(grids: Grids, load: Array, gap: Array, start: Array, tolerance: Array) -> tuple[Array, Array]:
        scale = xp.sqrt(xp.sum(load * load, axis=0))
        fine = grids.fine._replace(gap=gap)
        coarse = grids.coarse._replace(gap=_coarsen(fine, gap))
        rough, predictor = _search_wide_cells(coarse, search.start_coarse(coarse, load, scale, start))
        pressure = search.refine_fields(fine, rough.pressure)
        predictor = search.make_predictor(search.refine_sensitivity(fine, pressure > 0, predictor.sensitivity))
        lanes = search.start_lanes(fine, load, scale, rough.displacement, pressure)
        lanes = _iterate_in_stages(fine, lanes, predictor, _TOLERANCE_FACTOR * tolerance)
        return lanes.displacement, lanes.pressure

    @solve.defjvp
    def differentiate(primals: Any, tangents: Any) -> Any:
        grids, _, gap, *_ = primals
        grids_change, load_change, gap_change, *_ = tangents
        displacement, pressure = solve(*primals)
        overlap_change = -gap_change - search.apply_operator(grids.fine, grids_change.fine.softness, pressure)
        changes = _differentiate(grids.fine._replace(gap=gap), pressure > 0, load_change, overlap_change)
        return (displacement, pressure), changes

    return solve


def _differentiate(bore: BoreArrays, touching: Array, load_change: Array, overlap_change: Array) -> tuple[Array, Array]:
    """Compute the changes of displacements and pressures under changes of loads, and of overlaps of a fixed ball."""
    import jax
    import jax.numpy as xp

    sensitivity = search.solve_sensitivity(bore, touching, _NEWTON_ITERATIONS)
    areas = bore.areas[:, None]

    def deform(change: Array) -> Array:
        """Compute the displacements of touching cells; others are copied."""
        return xp.where(touching, search.apply_operator(bore, bore.softness, change * touching), change)

    def solve(_: Any, overlap: Array) -> Array:
        change = search.solve_change(bore, touching, overlap, _NEWTON_ITERATIONS)[0]
        return xp.where(touching, change, overlap)

    def solve_transposed(_: Any, values: Array) -> Array:
        return areas * solve(_, values / areas)

    fixed = jax.lax.custom_linear_solve(deform, overlap_change * touching, solve, solve_transposed)
    missing = load_change - search.compute_force(bore, fixed)
    step = xp.sum(xp.linalg.inv(sensitivity.tangent).transpose(1, 2, 0) * missing, axis=1)
    moved = sum(part * step[axis] for axis, part in enumerate(xp.split(sensitivity.pressure, 3, axis=-1)))
    return step, fixed + moved


def _coarsen(bore: BoreArrays, gap: Array) -> Array:
    """Compute the means of gaps (meridians, rings, 1) over cells twice as wide; the last ring may stay alone."""
    import jax.numpy as xp

    odd = gap.shape[1] % 2
    weights = xp.pad(bore.areas, (0, odd)).reshape(-1, 2)
    pairs = xp.pad(gap[..., 0], ((0, 0), (0, odd))).reshape(gap.shape[0] // 2, 2, -1, 2).mean(axis=1)
    return ((pairs * weights).sum(axis=-1) / weights.sum(axis=-1))[..., None]


def _search_wide_cells(bore: BoreArrays, lanes: Lanes) -> tuple[Lanes, Predictor]:
    """Search in wide cells, in rounds with a new sensitivity for the lanes that have not converged."""
    import jax
    import jax.numpy as xp

    def is_unfinished(state: tuple[Array, Lanes, Predictor]) -> Array:
        number, lanes, _ = state
        return (number == 0) | ((number < search.COARSE_ROUNDS) & ~xp.all(lanes.error <= search.COARSE_TOLERANCE))

    def run_round(state: tuple[Array, Lanes, Predictor]) -> tuple[Array, Lanes, Predictor]:
        number, lanes, predictor = state
        kept = (lanes.error <= search.COARSE_TOLERANCE) & (number > 0)
        renewed = search.make_predictor(
            search.solve_sensitivity(bore, lanes.pressure > 0, search.SENSITIVITY_ITERATIONS)
        )
        predictor = Predictor(
            sensitivity=xp.where(xp.tile(kept, 3), predictor.sensitivity, renewed.sensitivity),
            inverse_tangent=xp.where(kept[:, None, None], predictor.inverse_tangent, renewed.inverse_tangent),
        )
        fresh = search.start_lanes(bore, lanes.load, lanes.force_scale, lanes.displacement, lanes.pressure)
        lanes, _ = _iterate(bore, fresh, predictor, search.COARSE_TOLERANCE, search.COARSE_ITERATIONS)
        return number + 1, lanes, predictor

    meridians, rings, count = lanes.pressure.shape
    empty = Predictor(
        sensitivity=xp.zeros((meridians, rings, 3 * count), lanes.pressure.dtype),
        inverse_tangent=xp.zeros((count, 3, 3), lanes.pressure.dtype),
    )
    _, lanes, predictor = jax.lax.while_loop(is_unfinished, run_round, (0, lanes, empty))
    return lanes, predictor


def _iterate_in_stages(bore: BoreArrays, lanes: Lanes, predictor: Predictor, tolerance: Array) -> Lanes:
    """Iterate all lanes until few have not converged, and these without the others."""
    import jax

    few = len(lanes.error) // _REMAINING_FRACTION
    lanes, number = _iterate(bore, lanes, predictor, tolerance, _MAX_ITERATIONS, few)
    if few == 0:
        return lanes
    unconverged = ~(lanes.error <= tolerance)
    _, indices = jax.lax.top_k(unconverged.astype(lanes.error.dtype), few)
    part = jax.tree.map(lambda array: array[..., indices], lanes)
    part, _ = _iterate(bore, part, predictor.take(indices), tolerance, _MAX_ITERATIONS - number)
    return jax.tree.map(lambda array, solved: array.at[..., indices].set(solved), lanes, part)


def _iterate(
    bore: BoreArrays, lanes: Lanes, predictor: Predictor, tolerance: Array, max_iterations: Array, few: int = 0
) -> tuple[Lanes, Array]:
    """Iterate until at most `few` lanes are not within a tolerance; return lanes and number of iterations."""
    import jax
    import jax.numpy as xp

    def is_unfinished(state: tuple[Array, Lanes]) -> Array:
        number, lanes = state
        unconverged = ~(lanes.error <= tolerance)
        return (number < max_iterations) & (unconverged.sum() > few)

    def advance(state: tuple[Array, Lanes]) -> tuple[Array, Lanes]:
        number, lanes = state
        advanced = search.advance_lanes(bore, search.newton_step(bore, lanes, predictor), lanes)
        converged = lanes.error <= tolerance
        return number + 1, jax.tree.map(partial(xp.where, converged), lanes, advanced)

    number, lanes = jax.lax.while_loop(is_unfinished, advance, (0, lanes))
    return lanes, number


class Operators(NamedTuple):
    """Matrices (m, rings, rings) of a bore and of the same in cells twice as wide: see `Compliance`."""

    softness: Array
    stiffness: Array
    coarse_softness: Array
    coarse_stiffness: Array


@lru_cache(maxsize=2)
def _softness_slopes(surface: Surface, joint: Joint, cup: Cup, width: float) -> tuple[Numbers, Numbers]:
    """Compute the derivatives of both softnesses by the three numbers of the liner: (3, m, rings, rings)."""
    grid = cached_compliance(surface, joint, cup, width).grid
    slopes = surface.ring_slopes(joint, cup, grid)
    return slopes, numpy.stack([grid.coarsen_matrices(slope) for slope in slopes])


def differentiable_operators(
    surface: Surface, joint: Joint, cup: Cup, ring_width: float, dtype: str
) -> Callable[[Array], Operators]:
    """Return a function of JAX from the numbers of a liner (3,) to `Operators`, with derivatives of first order.

    The numbers are Young's modulus in MPa, Poisson's ratio and thickness in mm; the bore of the joint stays the same.
    The stiffnesses have no derivatives: they only precondition the iteration.
    """
    import jax

    def joint_with(liner: Numbers) -> Joint:
        return vary_liner(joint, tuple(map(float, liner)))

    def compute_operators(liner: Numbers) -> Operators:
        compliance = cached_compliance(surface, joint_with(liner), cup, ring_width)
        coarser = compliance.coarser_compliance
        if coarser is None:
            raise ValueError("the compliance of a liner needs rings of 3 degrees or less")
        operators: tuple[Any, ...] = (compliance.softness, compliance.stiffness, coarser.softness, coarser.stiffness)
        return Operators(*(operator.matrices for operator in operators))

    def compute_slopes(liner: Numbers) -> tuple[Numbers, Numbers]:
        return _softness_slopes(surface, joint_with(liner), cup, ring_width)

    def shapes_of(values: Any) -> Any:
        return jax.tree.map(lambda array: jax.ShapeDtypeStruct(array.shape, dtype), values)

    def convert(compute: Callable[[Numbers], Any], liner: Array) -> Any:
        return jax.tree.map(partial(numpy.asarray, dtype=dtype), compute(numpy.asarray(liner, dtype=float)))

    nominal = compute_operators(liner_numbers(joint))
    operator_shapes = shapes_of(nominal)
    slope_shapes = tuple(
        jax.ShapeDtypeStruct((3, *matrices.shape), dtype) for matrices in (nominal.softness, nominal.coarse_softness)
    )

    @jax.custom_jvp
    def operators(liner: Array) -> Operators:
        matrices: Operators = jax.pure_callback(
            partial(convert, compute_operators), operator_shapes, liner, vmap_method="sequential"
        )
        return matrices

    @operators.defjvp
    def differentiate(primals: Any, tangents: Any) -> Any:
        (liner,), (change,) = primals, tangents
        slopes = jax.pure_callback(partial(convert, compute_slopes), slope_shapes, liner, vmap_method="sequential")
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
