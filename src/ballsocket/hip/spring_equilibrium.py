"""Equilibrium of a ball on radial springs under all loads of a cycle: in NumPy, compiled by numba, or in JAX.

NumPy and numba solve each load by Newton's method from the same start with the same steps. They differ by rounding
only. JAX solves many patients at once, for GPUs; on a processor the compiled pass is faster.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import find_spec
from typing import Any, NamedTuple

import numpy

from ..core.arrays import Array, Numbers
from ..core.checks import check_shape, needs, require, shown

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


_TRIANGLE = numpy.triu_indices(3)  # rows and columns of the matrix entries xx, xy, xz, yy, yz, zz
_DIAGONAL = numpy.array([0, 3, 5])  # indices of xx, yy and zz among these entries


class PatientEquilibria(NamedTuple):
    """Contacts of several patients under all loads of a cycle, as arrays of JAX in double precision."""

    displacement: Array  # (patients, loads, 3), displacement of the ball's centre in mm
    pressure: Array  # (patients, loads, cells), pressure in MPa
    converged: Array  # (patients,), True where every load is balanced


def join_contacts(contacts: list[SpringContact]) -> SpringContact:
    """Join the contacts of several patients to one with arrays (patients, ...), as `solve_patients` takes.

    Raises ValueError: no contact, or contacts with different numbers of loads or cells.
    Raises TypeError: another type than a list of `SpringContact`.
    """
    if not isinstance(contacts, list) or not all(isinstance(contact, SpringContact) for contact in contacts):
        raise TypeError(f"contacts must be a list of SpringContact, got {shown(contacts)}")
    require("number of contacts", len(contacts), len(contacts) > 0, "at least one patient is solved")
    sizes = {(len(contact.loads), contact.normals.shape[1]) for contact in contacts}
    if len(sizes) > 1:
        texts = ", ".join(f"{loads} loads on {cells} cells" for loads, cells in sorted(sizes))
        raise ValueError(f"patients in one block need the same numbers of loads and cells, got {texts}")
    if len({len(contact.closing) for contact in contacts}) > 1:
        raise ValueError("patients in one block need a depth under each load, or one depth, but not both")
    return SpringContact._make(numpy.stack(numbers) for numbers in zip(*contacts, strict=True))


def solve_patients(contacts: SpringContact, start: Numbers) -> PatientEquilibria:
    """Solve the contacts of many patients under all loads of a cycle by Newton's method.

    All loads of all patients are lanes of one loop. A lane whose load is balanced stays as it is. Each lane makes the
    steps of `spring_equilibrium.solve_in_blocks`, in double precision: results differ by rounding only.

    Parameters
    ----------
    contacts : SpringContact
        Contacts with a first axis of patients; see `join_contacts`.
    start : array (patients, loads, 3)
        Initial displacements in mm.

    Raises
    ------
    ImportError
        JAX is not installed; the message has the command.
    TypeError
        Contacts that are not joined.
    ValueError
        Initial displacements of another shape than the loads.

    Examples
    --------
    Three patients of different weights, in the first cycle of a simulation `use`:

    >>> springs, unworn = use.foundation, numpy.zeros(len(use.foundation.areas))  # doctest: +SKIP
    >>> weights = [springs.contact(factor * use.frame.loads, unworn) for factor in (0.8, 1.0, 1.2)]  # doctest: +SKIP
    >>> start = numpy.stack(3 * [use.unworn.displacement])  # doctest: +SKIP
    >>> solve_patients(join_contacts(weights), start).converged.tolist()  # doctest: +SKIP
    [True, True, True]
    """
    needs("jax", "jax")
    import jax

    if not isinstance(contacts, SpringContact) or numpy.ndim(contacts.loads) != 3:
        raise TypeError(f"contacts must be those of join_contacts, with an axis of patients; got {shown(contacts)}")
    check_shape("start", start, (numpy.shape(contacts.loads),))
    with jax.enable_x64(True):
        return PatientEquilibria(*_jax_solver()(contacts, start))


@cache
def _jax_solver() -> Any:
    import jax
    import jax.numpy as xp

    of_loads: Any = SpringContact._make((0, 0, None, None, None, None, None))
    solve_loads = jax.vmap(_solve_load, in_axes=(of_loads, 0))

    def solve_patient(contact: SpringContact, start: Array) -> tuple[Array, Array, Array]:
        closing: Any = xp.broadcast_to(contact.closing, (len(contact.loads), contact.closing.shape[1]))
        displacement, pressure, converged = solve_loads(contact._replace(closing=closing), start)
        return displacement, pressure, converged.all()

    return jax.jit(jax.vmap(solve_patient))


class _Lane(NamedTuple):
    """Ball under one load in an iteration: steps so far, displacement, unbalanced force and tangent stiffness."""

    iterations: Array | int
    displacement: Array
    residual: Array
    tangent: Array


def _solve_load(contact: SpringContact, start: Array) -> tuple[Array, Array, Array]:
    """Solve the contact under one load: loads (3,) and closing (cells,); return displacement, pressure, convergence."""
    import jax
    import jax.numpy as xp

    magnitude = _length(contact.loads)

    def is_unfinished(lane: _Lane) -> Array:
        return (lane.iterations < MAX_ITERATIONS) & ~(_length(lane.residual) <= FORCE_TOLERANCE * magnitude)

    def advance(lane: _Lane) -> _Lane:
        """Advance the ball by a Newton step; a ball without contact moves along its load."""
        trace = lane.tangent[_DIAGONAL].sum()
        stiffness = lane.tangent + contact.lateral_stiffness[_TRIANGLE]
        stiffness = stiffness.at[_DIAGONAL].add(xp.where(trace > 0, REGULARISATION * trace, 1.0))
        newton = xp.stack(newton_step(tuple(stiffness), tuple(lane.residual)))
        step = xp.where(trace > 0, newton, contact.approach / magnitude * contact.loads)
        return _make_lane(contact, lane.iterations + 1, lane.displacement + step)

    lane = jax.lax.while_loop(is_unfinished, advance, _make_lane(contact, 0, start))
    pressure = contact.modulus * xp.maximum(lane.displacement @ contact.normals - contact.closing, 0.0)
    return lane.displacement, pressure, _length(lane.residual) <= FORCE_TOLERANCE * magnitude


def _make_lane(contact: SpringContact, iterations: Array | int, displacement: Array) -> _Lane:
    """Compute unbalanced force and tangent stiffness of a displaced ball."""
    import jax.numpy as xp

    normals, overlap = contact.normals, displacement @ contact.normals - contact.closing
    stiffness = xp.where(overlap > 0, contact.modulus * contact.areas, 0.0)
    rows, columns = _TRIANGLE
    return _Lane(
        iterations=iterations,
        displacement=displacement,
        residual=contact.loads - displacement @ contact.lateral_stiffness - normals @ (stiffness * overlap),
        tangent=(normals[rows] * normals[columns]) @ stiffness,
    )


def _length(vector: Array) -> Array:
    return (vector * vector).sum() ** 0.5
