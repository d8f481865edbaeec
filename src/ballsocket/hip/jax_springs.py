"""Equilibrium of balls on radial springs for many patients at once in JAX, for GPUs.

On a processor the compiled pass of `spring_equilibrium` is faster.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy

from ..core.arrays import Array, Numbers
from ..core.checks import check_shape, needs, require, shown
from .spring_equilibrium import FORCE_TOLERANCE, MAX_ITERATIONS, REGULARISATION, SpringContact, newton_step

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
        return PatientEquilibria(*_compiled_solver()(contacts, start))


@cache
def _compiled_solver() -> Any:
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
