"""Equilibrium of a ball on radial springs under all loads of a cycle: in NumPy, or in one pass compiled by numba.

Both solve each load by Newton's method from the same start with the same steps. They differ by rounding only.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy

from ..core.arrays import Numbers

MAX_ITERATIONS = 60  # number of Newton steps after which an equilibrium counts as not converged
FORCE_TOLERANCE = 1e-8  # allowed error of the force balance, relative to the load
REGULARISATION = 1e-12  # stiffness added to the tangent stiffness, relative to its trace

_BLOCK_SIZE = 131_072  # values (loads times cells) computed together, which stay in the processor's cache


class SpringContact(NamedTuple):
    """Ball on radial springs under several loads."""

    loads: Numbers  # (loads, 3), forces in N, none of them zero
    # (1 or loads, cells), displacement in mm along the normal at which ball and cell touch: clearance plus worn
    # depth
    closing: Numbers
    normals: Numbers  # (3, cells), mean outward normal of each cell
    areas: Numbers  # (cells,), areas in mm²
    modulus: float  # foundation modulus K in MPa/mm
    lateral_stiffness: Numbers  # (3, 3), stiffness (N/mm) of a spring that unloads the ball as it moves
    approach: float  # step in mm of a ball without contact, along its load


Solver = Callable[[SpringContact, Numbers, Numbers], bool]
"""Function that solves a contact: it updates displacements (loads, 3), writes pressures, and returns convergence."""


def spring_solver() -> Solver:
    """Return the compiled solver if numba is installed, and `solve_in_blocks` otherwise."""
    return solve_in_blocks if find_spec("numba") is None else _compiled_solver()


def newton_step(tangent: tuple[Any, ...], residual: tuple[Any, ...]) -> tuple[Any, ...]:
    """Solve 3 x 3 equations with a positive symmetric matrix (xx, xy, xz, yy, yz, zz) by its factors L D Lᵀ.

    Numbers and arrays of any library are allowed: stiffness in N/mm, unbalanced force in N, displacement in mm.
    """
    xx, xy, xz, yy, yz, zz = tangent
    fx, fy, fz = residual
    y_factor, z_factor = xy / xx, xz / xx
    yy = yy - y_factor * xy
    yz = yz - y_factor * xz
    zy_factor = yz / yy
    zz = zz - z_factor * xz - zy_factor * yz
    fy = fy - y_factor * fx
    z = (fz - z_factor * fx - zy_factor * fy) / zz
    y = fy / yy - zy_factor * z
    return fx / xx - y_factor * y - z_factor * z, y, z


def load_blocks(load_count: int, cell_count: int) -> Iterator[slice]:
    """Split loads into blocks whose arrays (loads, cells) stay in the processor's cache."""
    size = max(_BLOCK_SIZE // max(cell_count, 1), 1)
    return (slice(start, start + size) for start in range(0, load_count, size))


def solve_in_blocks(contact: SpringContact, displacement: Numbers, pressure: Numbers) -> bool:
    """Solve a contact in NumPy, in blocks of loads that stay in the processor's cache; True if all are balanced.

    The initial displacements (loads, 3) in mm are overwritten by the result, and pressures (loads, cells) in MPa
    filled.
    """
    normals, areas = contact.normals, contact.areas
    to_force = (normals * areas).T.copy()
    rows, columns = numpy.triu_indices(3)
    to_stiffness = (contact.modulus * normals[rows] * normals[columns] * areas).T.copy()
    converged = True
    for block in load_blocks(len(contact.loads), len(areas)):
        closing = contact.closing[block] if len(contact.closing) > 1 else contact.closing
        part = contact._replace(loads=contact.loads[block], closing=closing)
        converged &= _solve_block(part, displacement[block], pressure[block], to_force, to_stiffness)
    return converged


def _solve_block(
    contact: SpringContact, displacement: Numbers, pressure: Numbers, to_force: Numbers, to_stiffness: Numbers
) -> bool:
    """Solve a contact in NumPy for a block of loads; a balanced load makes no further steps.

    `to_force` (cells, 3) converts pressures to forces, `to_stiffness` (cells, 6) contact masks to tangent stiffness.
    """
    loads = contact.loads
    magnitude = numpy.linalg.norm(loads, axis=1)
    for _ in range(MAX_ITERATIONS):
        numpy.matmul(displacement, contact.normals, out=pressure)
        numpy.subtract(pressure, contact.closing, out=pressure)
        in_contact = (pressure > 0).astype(float)
        numpy.maximum(pressure, 0.0, out=pressure)
        numpy.multiply(pressure, contact.modulus, out=pressure)
        residual = loads - displacement @ contact.lateral_stiffness - pressure @ to_force
        unbalanced = ~(numpy.linalg.norm(residual, axis=1) <= FORCE_TOLERANCE * magnitude)
        if not unbalanced.any():
            return True
        tangent = in_contact @ to_stiffness
        trace = tangent[:, 0] + tangent[:, 3] + tangent[:, 5]
        separated = trace <= 0
        tangent += contact.lateral_stiffness[numpy.triu_indices(3)]
        tangent[:, [0, 3, 5]] += numpy.where(separated, 1.0, REGULARISATION * trace)[:, None]
        step = numpy.stack(newton_step(tuple(tangent.T), tuple(residual.T)), axis=1)
        # a ball without contact moves along its load towards the bore
        step = numpy.where(separated[:, None], contact.approach * loads / magnitude[:, None], step)
        displacement += numpy.where(unbalanced[:, None], step, 0.0)
    return False


@cache
def _compiled_solver() -> Solver:
    """Compile `_solve_one_by_one` with numba, or load it from numba's cache on the disk."""
    import numba
    from numba.extending import register_jitable

    register_jitable(newton_step)
    # sums in any order, and one rounding of a product with a sum: several cells are then added at once
    options: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract", "nsz", "reassoc"}, "nogil": True}
    try:
        solver: Solver = numba.njit(_solve_one_by_one, cache=True, **options)
    except RuntimeError:  # no folder for the cache is writable
        solver = numba.njit(_solve_one_by_one, **options)
    return solver


def _solve_one_by_one(contact, displacement, pressure):  # type: ignore[no-untyped-def]
    """Solve as `solve_in_blocks`, load by load, in one pass over the cells per Newton step; numba compiles it."""
    K, lateral, areas = contact.modulus, contact.lateral_stiffness, contact.areas
    all_converged = True
    for i in range(len(contact.loads)):
        load, closing = contact.loads[i], contact.closing[i if len(contact.closing) > 1 else 0]
        x, y, z = displacement[i]
        magnitude = math.sqrt(load[0] ** 2 + load[1] ** 2 + load[2] ** 2)
        converged = False
        for _ in range(MAX_ITERATIONS):
            fx = fy = fz = xx = xy = xz = yy = yz = zz = 0.0
            for cell in range(areas.size):
                nx, ny, nz = contact.normals[0, cell], contact.normals[1, cell], contact.normals[2, cell]
                overlap = x * nx + y * ny + z * nz - closing[cell]
                area = areas[cell] if overlap > 0 else 0.0
                fx, fy, fz = fx + area * overlap * nx, fy + area * overlap * ny, fz + area * overlap * nz
                xx, xy, xz = xx + area * nx * nx, xy + area * nx * ny, xz + area * nx * nz
                yy, yz, zz = yy + area * ny * ny, yz + area * ny * nz, zz + area * nz * nz
            fx = load[0] - K * fx - (x * lateral[0, 0] + y * lateral[1, 0] + z * lateral[2, 0])
            fy = load[1] - K * fy - (x * lateral[0, 1] + y * lateral[1, 1] + z * lateral[2, 1])
            fz = load[2] - K * fz - (x * lateral[0, 2] + y * lateral[1, 2] + z * lateral[2, 2])
            converged = math.sqrt(fx**2 + fy**2 + fz**2) <= FORCE_TOLERANCE * magnitude
            if converged:
                break
            trace = K * (xx + yy + zz)
            if trace <= 0:
                factor = contact.approach / magnitude
                step = factor * load[0], factor * load[1], factor * load[2]
            else:
                xx, xy, xz = K * xx + lateral[0, 0], K * xy + lateral[0, 1], K * xz + lateral[0, 2]
                yy, yz, zz = K * yy + lateral[1, 1], K * yz + lateral[1, 2], K * zz + lateral[2, 2]
                softest = REGULARISATION * trace
                step = newton_step((xx + softest, xy, xz, yy + softest, yz, zz + softest), (fx, fy, fz))
            x, y, z = x + step[0], y + step[1], z + step[2]
        all_converged = all_converged and converged
        displacement[i, 0], displacement[i, 1], displacement[i, 2] = x, y, z
        for cell in range(areas.size):
            normals = contact.normals
            overlap = x * normals[0, cell] + y * normals[1, cell] + z * normals[2, cell] - closing[cell]
            pressure[i, cell] = K * max(overlap, 0.0)
    return all_converged
