"""Equilibrium of many balls in NumPy by the coupled search: blocks of lanes in single precision, checked in double.

Equations (1) to (3) of `coupled_search` are solved in three stages: in cells twice as wide, from rough pressures and in
rounds with a new sensitivity q; in the cells of the bore, with q transferred to them; and again after a check in double
precision that fails. Balls that have converged leave a block. The search takes elastic bores with a linear gap.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy

from ...core.arrays import Numbers
from ...problem.gaps import LinearGap
from . import coupled_search as search
from .bore_contact import BoreContact, EquilibriumBatch, make_bore_arrays
from .compliance import AxisymmetricOperator
from .coupled_search import BoreArrays, ContactBalance, Lanes, Predictor

_BLOCK_CELLS = 142_000  # number of cells that are solved together: more exceed the processor's cache

_MAX_ITERATIONS = 30

_SINGLE_FACTOR = 0.8
"""Fraction of the tolerance to which lanes are solved in single precision, before their check in double."""

_MAX_CHECKS = 3  # number of checks in double precision; the search continues after a failed one
_SYMMETRY = 1e-6  # largest difference of the shares of two cells of a symmetric contact, by rounding
_DROPPED_FRACTION = 0.25  # fraction of converged lanes from which the others continue without them


def can_solve_lanes(bore: BoreContact) -> bool:
    """Return True for an elastic bore with a linear gap."""
    return isinstance(bore.compliance.softness, AxisymmetricOperator) and bore.gap.kind is LinearGap


def coarser_lanes(bore: BoreContact) -> BoreContact | None:
    """Return the bore in wide cells if the coupled search solves it: elastic, with a linear gap and a coarser grid."""
    return bore.coarser_bore if can_solve_lanes(bore) else None


def solve_tangents(bore: BoreContact, share: Numbers, edge_compliance: Numbers) -> Numbers:
    """Compute the tangent stiffness in N/mm, (batch, 3, 3), of contacts with shares (batch, rings, meridians).

    In a contact that is symmetric about the plane of φ = 0, motions in the plane and across it are solved separately.
    See `solve_change` for shares and edge compliance.
    """
    bore_arrays = make_bore_arrays(bore)
    even, odd = (search.fold_bore(bore_arrays, even=parity) for parity in (True, False))
    symmetric = (abs(share - share[..., ::-1]) < _SYMMETRY).all(axis=(1, 2))
    tangents = numpy.tile(bore.tether, (len(share), 1, 1))
    half = share[symmetric][..., : len(even.gap)]
    plane = numpy.ix_(numpy.flatnonzero(symmetric), _PLANE, _PLANE)
    tangents[plane] = _solve_block_tangents(even, half, edge_compliance)
    tangents[symmetric, 1, 1] = _solve_block_tangents(odd, half, edge_compliance)[:, 0, 0]
    tangents[~symmetric] = _solve_block_tangents(bore_arrays, share[~symmetric], edge_compliance)
    return tangents


def _solve_block_tangents(bore: BoreArrays, share: Numbers, edge_compliance: Numbers) -> Numbers:
    """Compute the tangents (batch, components, components) of shares (batch, rings, meridians), in blocks."""
    components, dtype = len(bore.tether), bore.gap.dtype
    size = max(_BLOCK_CELLS // (components * share[0].size), 1) if len(share) else 1
    blocks = [share[i : i + size].T.astype(dtype) for i in range(0, len(share), size)]
    compliance = edge_compliance.astype(dtype)
    tangents = [
        search.solve_sensitivity(bore, block, search.TANGENT_ITERATIONS, compliance).tangent for block in blocks
    ]
    return numpy.concatenate([numpy.zeros((0, components, components)), *tangents])


def solve_lanes(
    bore: BoreContact, coarser: BoreContact, load: Numbers, force_scale: Numbers, start: Numbers, tolerance: float
) -> EquilibriumBatch:
    """Solve the displacements and pressures of balls in equilibrium with their loads (batch, 3) in N.

    `coarser` is the bore in wide cells, see `coarser_lanes`. Initial displacements (batch, 3) in mm touch the bore. The
    tolerance limits the residuals of force and overlap, relative to the force scale (batch,) in N and the largest
    overlap.
    """
    solution = bore.unsolved_batch(start)
    symmetric = _are_symmetric(bore, load) & _are_symmetric(bore, start)
    for components, lanes in ((_PLANE, symmetric), (numpy.arange(3), ~symmetric)):
        if not lanes.any():
            continue
        unfolded = make_bore_arrays(bore, numpy.float64), make_bore_arrays(bore), make_bore_arrays(coarser)
        bores = [search.fold_bore(part, even=True) if components is _PLANE else part for part in unfolded]
        indices, size = numpy.flatnonzero(lanes), max(_BLOCK_CELLS // bores[1].gap.size, 1)
        for block in (indices[i : i + size] for i in range(0, len(indices), size)):
            row = numpy.ix_(block, components)
            with numpy.errstate(all="ignore"):  # a lane that diverges is reported as unconverged
                solved = _solve_block(bores, load[row].T, force_scale[block], start[row].T, tolerance)
            solution.displacement[row] = solved.displacement.T
            pressure = search.unfold_fields(solved.pressure) if components is _PLANE else solved.pressure
            solution.pressure[block] = pressure.T
            solution.converged[block] = solved.error <= tolerance
    return solution


_PLANE = numpy.array([0, 2])  # components x and z of vectors in the plane of φ = 0

_PLANE_TOLERANCE = 1e-9
"""Component of a vector across the plane of φ = 0, relative to its length, below which it lies in the plane."""


def _are_symmetric(bore: BoreContact, vectors: Numbers) -> Numbers:
    """Return True for vectors (batch, 3) in the plane of φ = 0, if bore and tether are symmetric about this plane."""
    depth, tether = bore.gap.depth, bore.tether
    if not numpy.array_equal(depth, depth[:, ::-1]) or tether[1, [0, 2]].any() or tether[[0, 2], 1].any():
        return numpy.zeros(len(vectors), dtype=bool)
    return abs(vectors[:, 1]) <= _PLANE_TOLERANCE * numpy.linalg.norm(vectors, axis=1)


class _Solution(NamedTuple):
    """Displacements (3, lanes), pressures (meridians, rings, lanes) and residuals (lanes,) of a search."""

    displacement: Numbers
    pressure: Numbers
    error: Numbers


def _solve_block(
    bores: list[BoreArrays], load: Numbers, force_scale: Numbers, start: Numbers, tolerance: float
) -> _Solution:
    """Solve one block of lanes: in wide cells, in the cells of the bore, and again after failed checks.

    The arrays of the bore are in double and in single precision, and in single precision of wide cells.
    """
    double, single, coarse = bores
    single_load, single_scale = load.astype(numpy.float32), force_scale.astype(numpy.float32)
    solved, predictor = _solve_coarse(coarse, single_load, single_scale, start.astype(numpy.float32))
    pressure = search.refine_fields(single, solved.pressure)
    predictor = search.make_predictor(search.refine_sensitivity(single, pressure > 0, predictor.sensitivity))
    displacement = solved.displacement.astype(float)
    for number in range(_MAX_CHECKS + 1):
        balance = search.balance_contacts(double, load, displacement, pressure)
        single_balance = ContactBalance(*(array.astype(numpy.float32) for array in balance))
        lanes = search.make_lanes(single_load, single_scale, displacement, pressure, single_balance)
        if (lanes.error <= tolerance).all() or number == _MAX_CHECKS:
            break
        displacement, pressure, _ = _iterate(single, lanes, predictor, _SINGLE_FACTOR * tolerance, _MAX_ITERATIONS)
    return _Solution(displacement, pressure, lanes.error)


def _solve_coarse(bore: BoreArrays, load: Numbers, force_scale: Numbers, start: Numbers) -> tuple[_Solution, Predictor]:
    lanes = search.start_coarse(bore, load, force_scale, start)
    predictor = search.make_predictor(search.solve_sensitivity(bore, lanes.pressure > 0, search.SENSITIVITY_ITERATIONS))
    solved = _iterate(bore, lanes, predictor, search.COARSE_TOLERANCE, search.COARSE_ITERATIONS)
    for _ in range(search.COARSE_ROUNDS - 1):
        unsolved = numpy.flatnonzero(~(solved.error <= search.COARSE_TOLERANCE))
        if not len(unsolved):
            break
        displacement, pressure = solved.displacement[:, unsolved], solved.pressure[..., unsolved]
        lanes = search.start_lanes(bore, load[:, unsolved], force_scale[unsolved], displacement, pressure)
        renewed = search.make_predictor(search.solve_sensitivity(bore, pressure > 0, search.SENSITIVITY_ITERATIONS))
        predictor.store(unsolved, renewed)
        again = _iterate(bore, lanes, renewed, search.COARSE_TOLERANCE, search.COARSE_ITERATIONS)
        for total, part in zip(solved, again, strict=True):
            total[..., unsolved] = part
    return solved, predictor


def _iterate(bore: BoreArrays, lanes: Lanes, predictor: Predictor, tolerance: float, max_iterations: int) -> _Solution:
    result = _Solution(lanes.displacement.copy(), lanes.pressure.copy(), lanes.error.copy())
    indices = numpy.arange(len(lanes.error))
    for number in range(max_iterations + 1):
        active = ~(lanes.error <= tolerance) & (number < max_iterations)
        if active.mean() <= 1 - _DROPPED_FRACTION:
            for name, total in result._asdict().items():
                total[..., indices] = getattr(lanes, name)
            indices = indices[active]
            lanes = Lanes(*(numpy.ascontiguousarray(array[..., active]) for array in lanes))
            predictor = predictor.take(numpy.flatnonzero(active))
        if not len(indices):
            break
        lanes = search.advance_lanes(bore, search.newton_step(bore, lanes, predictor), lanes)
    return result
