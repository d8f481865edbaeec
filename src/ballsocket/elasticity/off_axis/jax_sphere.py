"""Contacts of `Sphere` in JAX, on processors and GPUs: many loads at once, compiled and differentiable.

The search is that of `coupled_search`: lanes that have converged are masked, not dropped. Products of matrices run in
full precision; on NVIDIA GPUs JAX would round their factors to TF32 by default, and nothing would converge.

Derivatives follow from one Newton step at the solution, in its touching cells. The step is zero there, and its
derivative is that of the solution.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property, partial
from math import pi, radians
from typing import Any, NamedTuple

import numpy

from ...core.arrays import Array
from ...core.checks import check_number, needs, require
from ...models.kinematics import linear_indentation
from ...problem import Joint
from .bore_contact import BoreContact
from .coupled_search import (
    COARSE_ITERATIONS,
    COARSE_ROUNDS,
    COARSE_TOLERANCE,
    SENSITIVITY_ITERATIONS,
    TANGENT_ITERATIONS,
    BoreArrays,
    Lanes,
    Predictor,
    advance_lanes,
    apply_operator,
    compute_force,
    make_predictor,
    measure,
    newton_step,
    refine_fields,
    refine_sensitivity,
    solve_change,
    solve_sensitivity,
    start_coarse,
    start_lanes,
)
from .lane_solver import coarser_lanes, make_bore_arrays
from .model import Sphere
from .patch_measures import (
    CellArrays,
    Patches,
    contact_centres,
    edge_angles,
    edge_loaded,
    edge_margins,
    half_angles,
    largest_pressures,
    make_cell_arrays,
)

_MAX_ITERATIONS = 30

_TOLERANCE_FACTOR = 0.8
"""Fraction of the tolerance to which lanes are iterated, before their residuals are computed anew."""

_MIN_STEP = radians(2.0)
"""Width of the rings from which the number of steps along a ray follows; wider rings take fewer."""

_MEASURED_CONTACTS = 64
"""Number of contacts whose outlines are computed together."""

_NEWTON_ITERATIONS = 20
"""Number of conjugate-gradient iterations in the Newton step that carries derivatives."""


class JaxContacts(NamedTuple):
    """Contacts of many loads as JAX arrays; vectors are in the cup's frame, as those of `OffAxisContact`.

    Attributes
    ----------
    converged : array of bool (loads,)
        True where force and overlaps are within the tolerance; the other numbers are NaN elsewhere.
    error : array (loads,)
        Larger one of both relative residuals.
    displacement, force_vector : array (loads, 3)
        In mm and N.
    indentation : array (loads,)
        Displacement in mm beyond the clearance.
    max_pressure : array (loads,)
        In MPa, infinite where the end of the bore indents the ball.
    half_angle, edge_margin : array (loads,)
        In rad; the margin is 0 where the contact reaches the rim.
    edge_loaded : array of bool (loads,)
        True where the contact reaches the end of the bore.
    stiffness_matrix : array (loads, 3, 3)
        In N/mm.
    """

    converged: Array
    error: Array
    displacement: Array
    force_vector: Array
    indentation: Array
    max_pressure: Array
    half_angle: Array
    edge_margin: Array
    edge_loaded: Array
    stiffness_matrix: Array


class _Bores(NamedTuple):
    """Arrays of the bore in both grids, of its cells, and of the relation between pressure and gap at the edge."""

    fine: BoreArrays
    coarse: BoreArrays
    cells: CellArrays
    edge_compliance: Array
    unbounded: Array
    frame: Array


@dataclass(frozen=True, kw_only=True)
class JaxSphere:
    """`Sphere` for one joint in JAX: presses many loads at once.

    The compliance of the cup is computed by NumPy when the first load is pressed.

    Parameters
    ----------
    model : Sphere
        An elastic surface and `LinearGap`, in rings of 3° or less.
    joint : Joint
        A joint without arrays.
    tolerance : float
        Largest residual of force and overlap, relative to the load and the largest overlap: 2e-5 by default. Single
        precision reaches 1e-5.
    dtype : str
        "float32" (default), or "float64" with `jax_enable_x64`.

    Raises
    ------
    ValueError
        In `press`: a bore without lanes (springs, `CircularGap`, wide rings); a tolerance outside 1e-9 to 1e-2.
    ImportError
        In `press`: JAX or the extra `fem` is not installed.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere
    >>> cup = JaxSphere(model=bs.Sphere(), joint=bs.joints["hip-36"])
    >>> contacts = cup.press([1000.0, 3000.0], [[0.0, 0.0, 1.0], [0.3, 0.0, 0.9]])  # doctest: +SKIP
    >>> contacts.converged.tolist()  # doctest: +SKIP
    [True, True]
    """

    model: Sphere
    joint: Joint
    tolerance: float = 2e-5
    dtype: str = "float32"

    def __post_init__(self) -> None:
        """Validate the tolerance."""
        value = check_number("tolerance", self.tolerance)
        require("tolerance", value, 1e-9 <= value <= 1e-2, "a tolerance is 1e-9 to 1e-2")

    @cached_property
    def _bore(self) -> BoreContact:
        """Ball in the bore."""
        return self.model.bore_contact(self.joint)

    @cached_property
    def _bores(self) -> _Bores:
        """Arrays of the bore on the device."""
        needs("jax", "jax")
        import jax

        coarser = coarser_lanes(self._bore)
        if coarser is None:
            raise ValueError("JaxSphere needs an elastic surface, LinearGap and rings of 3 degrees or less")
        grid = self._bore.compliance.grid
        edges = self.model.surface.edges(self.joint, self.model.cup, grid)
        bores = _Bores(
            fine=make_bore_arrays(self._bore, numpy.float64),
            coarse=make_bore_arrays(coarser, numpy.float64),
            cells=make_cell_arrays(grid, edges.inset),
            edge_compliance=edges.compliance,
            unbounded=numpy.asarray(float(not edges.bounded)),
            frame=numpy.array(self.model.cup.frame),
        )
        return jax.tree.map(partial(jax.numpy.asarray, dtype=self.dtype), bores)

    def press(
        self, force: Array, direction: Array, *, clearance: Array | None = None, depth: Array | None = None
    ) -> JaxContacts:
        """Press the ball by many forces at once.

        Parameters
        ----------
        force : array (loads,)
            Magnitudes in N, above 0.
        direction : array (loads, 3)
            Directions in the body's frame, of any length.
        clearance : array (), optional
            Clearance in mm in the same bore, in place of the joint's.
        depth : array (rings, meridians), optional
            Worn depth in mm of the cells, in place of the model's.

        Returns
        -------
        JaxContacts
            Displacement, force vector, indentation and largest pressure have derivatives by all arguments, of first
            order. `press` may be called inside `jax.jit` and `jax.grad`; what is not used there is not computed.

        Raises
        ------
        ValueError, ImportError
            See the class.
        """
        import jax.numpy as xp

        gap = self._bore.gap
        force = xp.asarray(force, dtype=self.dtype)
        direction = xp.broadcast_to(xp.asarray(direction, dtype=self.dtype), (*force.shape, 3))
        c = xp.asarray(gap.clearance if clearance is None else clearance, dtype=self.dtype)
        worn = xp.asarray(gap.depth if depth is None else depth, dtype=self.dtype)
        modulus = self._bore.compliance.uniform_stiffness
        return _compiled_press()(self._bores, force, direction, c, worn, modulus, self.tolerance)


@cache
def _compiled_press() -> Any:
    """Compile the solver, for each shape on its first call."""
    import jax

    @jax.jit
    def press(*inputs: Any) -> JaxContacts:
        """Press in full precision of the products."""
        with jax.default_matmul_precision("highest"):
            return _press_loads(*inputs)

    return press


def _press_loads(
    bores: _Bores, force: Array, direction: Array, clearance: Array, depth: Array, modulus: Array, tolerance: Array
) -> JaxContacts:
    """Press the ball by forces (loads,) along directions (loads, 3) of the body; see `JaxSphere.press`."""
    import jax
    import jax.numpy as xp

    axes = direction @ bores.frame.T
    axes = axes / xp.linalg.norm(axes, axis=1, keepdims=True)
    load, gap = (axes * force[:, None]).T, (clearance + depth.T)[..., None]
    deepest = xp.maximum(clearance, 0.0) + xp.max(xp.maximum(depth, 0.0))
    radius = xp.sqrt(bores.fine.scale)
    start = axes.T * (deepest + linear_indentation(radius, xp.maximum(clearance, 0.0), modulus, force))
    displacement, pressure = _solver()(bores, load, gap, jax.lax.stop_gradient(start), tolerance)
    measured = measure(bores.fine._replace(gap=gap), load, displacement, pressure)
    lanes = start_lanes(load, force, displacement, pressure, measured)
    fields = pressure.transpose(2, 1, 0)
    outline = jax.lax.stop_gradient((fields, lanes.remaining.transpose(2, 1, 0), axes))
    half_angle, margin = jax.lax.map(
        partial(_measure_outline, bores), outline, batch_size=min(_MEASURED_CONTACTS, len(force))
    )
    tangent = solve_sensitivity(bores.fine, jax.lax.stop_gradient(pressure) > 0, TANGENT_ITERATIONS).tangent
    error, loaded = jax.lax.stop_gradient(lanes.error), edge_loaded(fields)
    largest, _ = largest_pressures(bores.cells, fields, axes)
    contacts = JaxContacts(
        converged=error <= tolerance,
        error=error,
        displacement=displacement.T,
        force_vector=compute_force(bores.fine, pressure).T,
        indentation=xp.sqrt(xp.sum(displacement * displacement, axis=0)) - clearance,
        max_pressure=xp.where(loaded & (bores.unbounded > 0), xp.inf, largest),
        half_angle=half_angle,
        edge_margin=margin,
        edge_loaded=loaded,
        stiffness_matrix=tangent,
    )
    return _mask_unconverged(contacts)


def _mask_unconverged(contacts: JaxContacts) -> JaxContacts:
    """Set the numbers of loads that did not converge to NaN."""
    import jax.numpy as xp

    def mask(values: Array) -> Array:
        """Set the values of unconverged loads to NaN."""
        converged = contacts.converged.reshape(-1, *(1 for _ in values.shape[1:]))
        return xp.where(converged, values, xp.nan)

    numbers = {
        name: mask(values)
        for name, values in contacts._asdict().items()
        if name not in ("converged", "error", "edge_loaded")
    }
    return contacts._replace(**numbers)


def _measure_outline(bores: _Bores, contact: tuple[Array, Array, Array]) -> tuple[Array, Array]:
    """Compute half angle and margin of one contact from its pressures, remaining overlaps and axis."""
    import jax.numpy as xp

    pressure, remaining, axis = contact
    level = xp.where(pressure > 0, pressure * bores.edge_compliance, xp.minimum(remaining, 0.0))
    patches = Patches(pressure=pressure[None], level=level[None], axis=axis[None])
    steps = int(2 * pi / _MIN_STEP)
    edges = edge_angles(bores.cells, patches.level, contact_centres(bores.cells, patches), steps)
    return half_angles(bores.cells, patches, edges)[0], edge_margins(bores.cells, patches)[0]


@cache
def _solver() -> Any:
    """Return the solver of displacements and pressures, with its derivatives by loads and gaps."""
    import jax

    @jax.custom_jvp
    def solve(bores: _Bores, load: Array, gap: Array, start: Array, tolerance: Array) -> tuple[Array, Array]:
        """Solve displacements (3, loads) and pressures (meridians, rings, loads)."""
        return _search(bores, load, gap, start, tolerance)

    @solve.defjvp
    def differentiate(primals: Any, tangents: Any) -> Any:
        """Compute the derivatives of displacements and pressures in the touching cells."""
        bores, _, gap, *_ = primals
        _, load_change, gap_change, *_ = tangents
        displacement, pressure = solve(*primals)
        changes = _differentiate(bores.fine._replace(gap=gap), pressure > 0, load_change, gap_change)
        return (displacement, pressure), changes

    return solve


def _differentiate(bore: BoreArrays, touching: Array, load_change: Array, gap_change: Array) -> tuple[Array, Array]:
    """Compute the changes of displacements and pressures under changes of the loads and the gap."""
    import jax
    import jax.numpy as xp

    sensitivity = solve_sensitivity(bore, touching, _NEWTON_ITERATIONS)
    areas = bore.areas[:, None]

    def deform(change: Array) -> Array:
        """Compute the displacements of touching cells; others are copied."""
        return xp.where(touching, apply_operator(bore, bore.softness, change * touching), change)

    def solve(_: Any, overlap: Array) -> Array:
        """Compute the pressures that displace touching cells; others are copied."""
        change = solve_change(bore, touching, overlap, _NEWTON_ITERATIONS)[0]
        return xp.where(touching, change, overlap)

    def solve_transposed(_: Any, values: Array) -> Array:
        """Solve the transposed system: the compliance is symmetric with the areas of the cells as weights."""
        return areas * solve(_, values / areas)

    fixed = jax.lax.custom_linear_solve(deform, -gap_change * touching, solve, solve_transposed)
    missing = load_change - compute_force(bore, fixed)
    step = xp.sum(xp.linalg.inv(sensitivity.tangent).transpose(1, 2, 0) * missing, axis=1)
    moved = sum(part * step[axis] for axis, part in enumerate(xp.split(sensitivity.pressure, 3, axis=-1)))
    return step, fixed + moved


def _search(bores: _Bores, load: Array, gap: Array, start: Array, tolerance: Array) -> tuple[Array, Array]:
    """Search in wide cells, and in those of the bore."""
    import jax.numpy as xp

    scale = xp.sqrt(xp.sum(load * load, axis=0))
    fine = bores.fine._replace(gap=gap)
    coarse = bores.coarse._replace(gap=_coarsen(fine, gap))
    rough, predictor = _search_wide_cells(coarse, start_coarse(coarse, load, scale, start))
    pressure = refine_fields(fine, rough.pressure)
    predictor = make_predictor(refine_sensitivity(fine, pressure > 0, predictor.sensitivity))
    measured = measure(fine, load, rough.displacement, pressure)
    lanes = start_lanes(load, scale, rough.displacement, pressure, measured)
    lanes = _iterate(fine, lanes, predictor, _TOLERANCE_FACTOR * tolerance, _MAX_ITERATIONS)
    return lanes.displacement, lanes.pressure


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
        """Return True in the first round, and until all lanes have converged."""
        number, lanes, _ = state
        return (number == 0) | ((number < COARSE_ROUNDS) & ~xp.all(lanes.error <= COARSE_TOLERANCE))

    def run_round(state: tuple[Array, Lanes, Predictor]) -> tuple[Array, Lanes, Predictor]:
        """Iterate with a new sensitivity."""
        number, lanes, predictor = state
        kept = (lanes.error <= COARSE_TOLERANCE) & (number > 0)
        renewed = make_predictor(solve_sensitivity(bore, lanes.pressure > 0, SENSITIVITY_ITERATIONS))
        predictor = Predictor(
            sensitivity=xp.where(xp.tile(kept, 3), predictor.sensitivity, renewed.sensitivity),
            inverse_tangent=xp.where(kept[:, None, None], predictor.inverse_tangent, renewed.inverse_tangent),
        )
        measured = measure(bore, lanes.load, lanes.displacement, lanes.pressure)
        fresh = start_lanes(lanes.load, lanes.force_scale, lanes.displacement, lanes.pressure, measured)
        return number + 1, _iterate(bore, fresh, predictor, COARSE_TOLERANCE, COARSE_ITERATIONS), predictor

    meridians, rings, count = lanes.pressure.shape
    empty = Predictor(
        sensitivity=xp.zeros((meridians, rings, 3 * count), lanes.pressure.dtype),
        inverse_tangent=xp.zeros((count, 3, 3), lanes.pressure.dtype),
    )
    _, lanes, predictor = jax.lax.while_loop(is_unfinished, run_round, (0, lanes, empty))
    return lanes, predictor


def _iterate(bore: BoreArrays, lanes: Lanes, predictor: Predictor, tolerance: Array, max_iterations: int) -> Lanes:
    """Iterate until all lanes are within a tolerance; lanes that are stay as they are."""
    import jax
    import jax.numpy as xp

    def is_unfinished(state: tuple[Array, Lanes]) -> Array:
        """Return True until all lanes have converged."""
        number, lanes = state
        return (number < max_iterations) & ~xp.all(lanes.error <= tolerance)

    def advance(state: tuple[Array, Lanes]) -> tuple[Array, Lanes]:
        """Advance the lanes that have not converged."""
        number, lanes = state
        advanced = advance_lanes(bore, newton_step(bore, lanes, predictor), lanes)
        converged = lanes.error <= tolerance
        return number + 1, jax.tree.map(partial(xp.where, converged), lanes, advanced)

    return jax.lax.while_loop(is_unfinished, advance, (0, lanes))[1]
