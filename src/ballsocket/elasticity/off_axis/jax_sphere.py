"""Contacts of `Sphere` in JAX, on processors and GPUs: many loads at once, compiled and differentiable.

Products of matrices run in full precision; on NVIDIA GPUs JAX would round their factors to TF32 by default, and nothing
would converge.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property, partial
from math import pi, radians
from typing import Any, NamedTuple

import numpy

from ...contact.assembly import check_joint
from ...core.arrays import Array
from ...core.checks import check_number, check_numeric, check_shape, check_vectors, needs, require, shown
from ...core.quantities import CUP
from ...core.validity import check_domain
from ...models.kinematics import linear_indentation
from ...problem import Joint, Material
from ...problem.cup import cup_axes
from . import coupled_search as search
from . import patch_measures as measures
from .bore_contact import BoreContact, make_bore_arrays
from .coupled_search import BoreArrays
from .jax_search import Grids, Operators, differentiable_operators, differentiable_search
from .lane_solver import coarser_lanes
from .load_cases import MAX_EQUILIBRIUM_DISPLACEMENT
from .model import Sphere, check_sphere
from .patch_measures import CellArrays, Patches
from .ring_matrices import liner_numbers

_MIN_STEP = radians(2.0)
"""Width of the rings from which the number of steps along a ray follows; wider rings take fewer."""

_MEASURED_CONTACTS = 64  # number of contacts whose outlines are computed together
_DTYPES = ("float32", "float64")  # precisions of the solver


class JaxContacts(NamedTuple):
    """Contacts of many loads as JAX arrays; vectors are in the cup's frame, as those of `OffAxisContact`.

    Attributes
    ----------
    converged : array of bool (loads,)
        True where force and overlaps are within the tolerance and the bore holds the ball: its centre is displaced by a
        quarter of the bore's radius or less. The other numbers are NaN elsewhere.
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
        In N/mm; without derivatives.
    pressure : array (loads, rings, meridians)
        In MPa, in the cells of the bore.
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
    pressure: Array


class _Bores(NamedTuple):
    """Arrays of the bore in both grids, of its cells, and of the relation between pressure and gap at the edge."""

    grids: Grids
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
        `LinearGap`, and rings of 3° or less.
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
        A joint outside the domain of `Sphere`, another precision, a tolerance outside 1e-9 to 1e-2. In `press`:
        `CircularGap`, rings wider than 3°, or double precision without `jax_enable_x64`.
    TypeError
        Another type than `Sphere`, another than `Joint`, or a joint with arrays.
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
        _check_bore(self.model, self.joint)
        if not (isinstance(self.dtype, str) and self.dtype in _DTYPES):
            raise ValueError(f"dtype = {shown(self.dtype)} is not allowed: it is {' or '.join(map(repr, _DTYPES))}")
        value = check_number("tolerance", self.tolerance)
        require("tolerance", value, 1e-9 <= value <= 1e-2, "a tolerance is 1e-9 to 1e-2")

    @cached_property
    def _bore(self) -> BoreContact:
        return self.model.bore_contact(self.joint)

    @cached_property
    def _bores(self) -> _Bores:
        needs("jax", "jax")
        import jax

        coarser = coarser_lanes(self._bore)
        if coarser is None:
            raise ValueError("JaxSphere needs LinearGap and rings of 3 degrees or less")
        grid = self._bore.compliance.grid
        edges = self.model.surface.edges(self.joint, self.model.cup, grid)
        fine, coarse = (make_bore_arrays(bore, numpy.float64) for bore in (self._bore, coarser))
        bores = _Bores(
            grids=Grids(fine=fine, coarse=coarse),
            cells=measures.make_cell_arrays(grid, edges.inset),
            edge_compliance=edges.compliance,
            unbounded=numpy.asarray(float(not edges.bounded)),
            frame=numpy.array(self.model.cup.frame),
        )
        with jax.ensure_compile_time_eval():  # the first press may be traced; the cached arrays must not be
            return jax.tree.map(partial(jax.numpy.asarray, dtype=self.dtype), bores)

    @cached_property
    def _operators(self) -> Callable[[Array], Operators]:
        """Function from the numbers of a liner to the matrices of the bore."""
        surface, cup, width = self.model.surface, self.model.cup, self.model.ring_width
        return differentiable_operators(surface, self.joint, cup, width, self.dtype)

    def press(
        self,
        force: Array,
        direction: Array,
        *,
        clearance: Array | None = None,
        depth: Array | None = None,
        young: Array | None = None,
        poisson: Array | None = None,
        liner_thickness: Array | None = None,
        inclination: Array | None = None,
        anteversion: Array | None = None,
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
        young, poisson, liner_thickness : array (), optional
            Young's modulus in MPa, Poisson's ratio and thickness in mm of the liner, in place of the joint's. NumPy
            computes the compliance of another liner, in about a second, and its derivatives in a few.
        inclination, anteversion : array (), optional
            Orientation of the cup in rad, in place of the model's.

        Returns
        -------
        JaxContacts
            All numbers except `error` and `stiffness_matrix` have first-order derivatives by all arguments, with fixed
            cells in contact. `press` may be called inside `jax.jit` and `jax.grad`; unused results are not computed
            there.

        Raises
        ------
        ValueError, ImportError
            See the class; loads of another shape; a number of the liner or an angle outside its range, unless JAX
            traces it.
        TypeError
            Loads that are not real numbers.
        """
        needs("jax", "jax")
        import jax
        import jax.numpy as xp

        if jax.dtypes.canonicalize_dtype(self.dtype) != self.dtype:
            raise ValueError(
                'dtype = "float64" needs jax.config.update("jax_enable_x64", True) first: the default of JAX is single'
            )
        gap, force = self._bore.gap, check_numeric("force", force)
        shape = numpy.shape(force)
        if len(shape) != 1 or 0 in shape:
            raise ValueError(f"force of shape {shape} is not allowed: it is a row (loads,) of one or more forces")
        direction = check_vectors("direction", direction, "x, y, z")
        check_shape("direction", direction, ((3,), (1, 3), (*shape, 3)))
        force = xp.asarray(force, dtype=self.dtype)
        direction = xp.broadcast_to(xp.asarray(direction, dtype=self.dtype), (*force.shape, 3))
        c = self._replace("clearance", gap.clearance, clearance)
        worn = self._replace("depth", gap.depth, depth)
        bores = self._bores
        if not (young is None and poisson is None and liner_thickness is None):
            bores = self._replace_liner((young, poisson, liner_thickness))
        if not (inclination is None and anteversion is None):
            bores = bores._replace(frame=self._orient(inclination, anteversion))
        return _compiled_press()(bores, force, direction, c, worn, self.tolerance)

    def _replace(self, name: str, own: Array, value: Array | None) -> Array:
        """Return a value of the same shape in place of the model's or the joint's, which None keeps."""
        import jax.numpy as xp

        return xp.asarray(own if value is None else check_shape(name, value, (numpy.shape(own),)), dtype=self.dtype)

    def _orient(self, inclination: Array | None, anteversion: Array | None) -> Array:
        """Compute the frame (3, 3) of the cup in another orientation; None is the angle of the model."""
        import jax.numpy as xp

        cup, angles = self.model.cup, {"inclination": inclination, "anteversion": anteversion}
        first, second = (
            self._replace(name, getattr(cup, name), None if angle is None else CUP[name].check(angle))
            for name, angle in angles.items()
        )
        return xp.stack([xp.stack(axis) for axis in cup_axes(first, second, cup.side)])

    def _replace_liner(self, numbers: tuple[Array | None, ...]) -> _Bores:
        """Return the arrays of the bore with another liner; None is the number of the joint."""
        import jax.numpy as xp

        own, names = liner_numbers(self.joint), ("young", "poisson", "liner_thickness")
        young, poisson, thickness = map(self._replace, names, own, numbers)
        varied = self.joint.replace(
            liner=Material(young=young, poisson=poisson, name=self.joint.liner.name), liner_thickness=thickness
        )
        check_domain(self.model.domain, varied, self.model.name)
        operators = self._operators(xp.stack([young, poisson, thickness]))
        softening = self.joint.effective_modulus / varied.effective_modulus
        fine, coarse = self._bores.grids
        grids = Grids(
            fine=fine._replace(softness=operators.softness, stiffness=operators.stiffness),
            coarse=coarse._replace(softness=operators.coarse_softness, stiffness=operators.coarse_stiffness),
        )
        return self._bores._replace(grids=grids, edge_compliance=self._bores.edge_compliance * softening)


def _check_bore(model: Any, joint: Any) -> None:
    """Check that model and joint describe one bore that `Sphere` solves."""
    check_sphere(model)
    check_joint(joint)
    if any(numpy.shape(number) for number in joint.numbers()):
        raise TypeError("joint must have plain numbers, got arrays: one JaxSphere presses one joint")
    check_domain(model.domain, joint, model.name)


@cache
def _compiled_press() -> Any:
    import jax

    @jax.jit
    def press(*inputs: Any) -> JaxContacts:
        with jax.default_matmul_precision("highest"):
            return _press_loads(*inputs)

    return press


def _press_loads(
    bores: _Bores, force: Array, direction: Array, clearance: Array, depth: Array, tolerance: Array
) -> JaxContacts:
    import jax
    import jax.numpy as xp

    largest_component = xp.max(abs(jax.lax.stop_gradient(direction)), axis=1, keepdims=True)
    axes = direction / largest_component @ bores.frame.T  # squares of large and small components would overflow
    axes = axes / xp.linalg.norm(axes, axis=1, keepdims=True)
    load, gap = (axes * force[:, None]).T, (clearance + depth.T)[..., None]
    fine = bores.grids.fine._replace(gap=gap)
    start = jax.lax.stop_gradient(_initial_displacement(fine, axes, force, clearance, depth))
    displacement, pressure = differentiable_search()(bores.grids, load, gap, start, tolerance)
    lanes = search.start_lanes(fine, load, force, displacement, pressure)
    fields = pressure.transpose(2, 1, 0)
    half_angle, margin, share = jax.lax.map(
        partial(_measure_outline, bores),
        (fields, lanes.remaining.transpose(2, 1, 0), axes),
        batch_size=min(_MEASURED_CONTACTS, len(force)),
    )
    touching, error, share = jax.lax.stop_gradient((pressure > 0, lanes.error, share.transpose(2, 1, 0)))
    fixed, edge_compliance = jax.lax.stop_gradient((fine, bores.edge_compliance))
    loaded, largest = measures.edge_loaded(fields), measures.largest_pressures(bores.cells, fields, axes)[0]
    # the limit of `Sphere` for the displacement of a ball in its bore
    held = xp.linalg.norm(displacement, axis=0) <= MAX_EQUILIBRIUM_DISPLACEMENT * xp.sqrt(fine.scale)
    contacts = JaxContacts(
        converged=(error <= tolerance) & touching.any(axis=(0, 1)) & held,
        error=error,
        displacement=displacement.T,
        force_vector=search.compute_force(fine, pressure).T,
        indentation=xp.sqrt(xp.sum(displacement * displacement, axis=0)) - clearance,
        max_pressure=xp.where(loaded & (bores.unbounded > 0), xp.inf, largest),
        half_angle=half_angle,
        edge_margin=margin,
        edge_loaded=loaded,
        stiffness_matrix=search.solve_sensitivity(fixed, share, search.TANGENT_ITERATIONS, edge_compliance).tangent,
        pressure=fields,
    )
    masked = {}  # the numbers of loads that did not converge are NaN
    for name, values in contacts._asdict().items():
        if name not in ("converged", "error", "edge_loaded"):
            converged = contacts.converged.reshape(-1, *(1 for _ in values.shape[1:]))
            masked[name] = xp.where(converged, values, xp.nan)
    return contacts._replace(**masked)


def _initial_displacement(bore: BoreArrays, axes: Array, force: Array, clearance: Array, depth: Array) -> Array:
    """Estimate displacements (3, loads) in mm along the loads, as `surfaces.initial_displacement`."""
    import jax.numpy as xp

    modulus = bore.areas @ bore.stiffness[0].sum(axis=1) / bore.areas.sum()  # under a uniform displacement
    positive = xp.maximum(clearance, 0.0)
    indentation = linear_indentation(xp.sqrt(bore.scale), positive, modulus, force)
    return axes.T * (positive + xp.max(xp.maximum(depth, 0.0)) + indentation)


def _measure_outline(bores: _Bores, contact: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
    """Compute half angle, margin and `cell_shares` of one contact from its pressures, remaining overlaps and axis."""
    import jax
    import jax.numpy as xp

    pressure, remaining, axis = contact
    level = xp.where(pressure > 0, pressure * bores.edge_compliance, xp.minimum(remaining, 0.0))
    patches = Patches(pressure=pressure[None], level=level[None], axis=axis[None])
    centres, steps = measures.contact_centres(bores.cells, patches), range(1, int(2 * pi / _MIN_STEP) + 1)
    fixed_level, fixed_centres = jax.lax.stop_gradient((patches.level, centres))
    edges = measures.edge_angles(bores.cells, fixed_level, fixed_centres, steps)
    share = measures.cell_shares(bores.cells, patches, fixed_centres, edges)[0]
    edges = _differentiable_edges(bores.cells, patches.level, centres, edges)
    return measures.half_angles(bores.cells, patches, edges)[0], measures.edge_margins(bores.cells, patches)[0], share


def _differentiable_edges(cells: CellArrays, level: Array, centres: Array, edges: Array) -> Array:
    """Attach derivatives by the level and by the centres to edge angles (contacts, rays), at which the level is 0.

    A Newton step of size 0 carries them. Edges at the end of the bore do not move.
    """
    import jax
    import jax.numpy as xp

    table, azimuths = measures.level_table(level), measures.ray_azimuths(level)

    def level_at(angle: Array) -> Array:
        return measures.interpolate(cells, table, measures.ray_directions(centres[:, None], angle, azimuths))

    value, slope = jax.jvp(level_at, (edges + cells.inset,), (xp.ones_like(edges),))
    fixed_value, fixed_slope = jax.lax.stop_gradient((value, slope))
    rim = measures.rim_angles(cells, centres)
    moves = (edges < rim) & (edges > 0) & (fixed_slope < 0)
    moved = edges - xp.where(moves, (value - fixed_value) / xp.where(moves, fixed_slope, 1.0), 0.0)
    return xp.where(edges < rim, moved, rim)
