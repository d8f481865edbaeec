"""Lubricant film between ball and socket over a cycle, and friction: moment, power, heat.

Method "hamrock-dowson" has a formula for each instant alone; it is fitted to bodies of low conformity. Method "wave"
carries the film over the dry contacts from instant to instant.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any, Protocol

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name
from ..elasticity.off_axis.grid import Grid
from ..lubrication import Lubricant
from ..lubrication.cycle_film import CycleInstant, carry_over_cycle
from ..lubrication.inlet import Edge, ElasticEdge, SpringEdge
from ..lubrication.mesh import polar_mesh, thinned_meridians
from ..problem import Joint, Material
from .cycle import Cycle
from .kinematics import SurfaceSliding
from .mix import Mix
from .socket_foundation import CycleEquilibrium, SocketFoundation

CONFORMITY_NOTE = (
    "Hamrock and Dowson's formulas hold for bodies of low conformity: here they give a regime, not a thickness"
)
"""Note on the film thickness of a conforming joint."""

WAVE_NOTE = "Film carried over the dry contacts from instant to instant"
"""Note on the film thickness by the kinematic wave."""

METHODS = ("hamrock-dowson", "wave")
"""Names of the methods; the first is the default."""

_SMALL_SHARE = 0.01
"""Share of a contact without fresh lubricant up to which it is not noted."""

_MAX_ERROR = 0.1
"""Largest estimated error of a valid film."""

_MIXED_RATIO, _FULL_RATIO = 1.0, 3.0
"""Film ratios at which mixed and full-film lubrication begin."""


def film_thickness(joint: Joint, force: Numbers, spin: Numbers, viscosity: float) -> tuple[Numbers, Numbers]:
    """Compute the minimum and central film thickness in mm by the formulas of Hamrock and Dowson.

    Parameters
    ----------
    joint : Joint
    force : array
        Load in N.
    spin : array
        Rotation rate of the ball perpendicular to the load, in rad/s.
    viscosity : float
        Viscosity in Pa s.

    Returns
    -------
    pair of arrays
        Thicknesses; NaN without clearance, where no equivalent sphere exists.
    """
    if float(joint.clearance) == 0:
        return numpy.full_like(force, numpy.nan), numpy.full_like(force, numpy.nan)
    # h_min = 2.80 R* U^.65 W^-.21, h_cen = 3.34 R* U^.64 W^-.22, U = ηu/(E'R*), W = F/(E'R*²), u = ωR1/2
    effective_radius = float(joint.ball_radius * joint.socket_radius / joint.clearance)
    ball_compliance = 0.0 if joint.ball is None else _plane_strain_compliance(joint.ball)
    modulus = 2 / (_plane_strain_compliance(joint.liner) + ball_compliance)
    speed_parameter = 1e-6 * viscosity * spin * float(joint.ball_radius) / 2 / (modulus * effective_radius)
    load_parameter = force / (modulus * effective_radius**2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        minimum, central = (
            2.80 * effective_radius * speed_parameter**0.65 * load_parameter**-0.21,
            3.34 * effective_radius * speed_parameter**0.64 * load_parameter**-0.22,
        )
    return minimum, central


def _plane_strain_compliance(material: Material) -> float:
    """Compute the plane-strain compliance (1 - ν²)/E of a material in 1/MPa."""
    return float((1 - material.poisson**2) / material.young)


@dataclass(frozen=True, kw_only=True, eq=False)
class Film:
    """Lubricant film and friction in the loaded instants of a cycle.

    Attributes
    ----------
    phases : array (instants,)
        Phases of the cycle, 0 to 1.
    least, central : array (instants,)
        Minimum and central thickness in mm.
    ratio : array (instants,)
        Film ratio λ: minimum thickness over the combined roughness.
    moment : array (instants, 3)
        Friction moment on the cup about its centre in N mm, in the cup's frame; the moment on the ball is opposite.
    power : array (instants,)
        Friction power in W.
    heat : float
        Friction heat of a cycle in J.
    duration : float
        Duration of a cycle in s.
    method : str
        "wave" or "hamrock-dowson".
    comparison : array (instants,)
        Minimum thickness in mm by Hamrock and Dowson's formula.
    thickness : array (instants, cells), optional
        Film thickness in mm by the wave on the cells of the bore; NaN outside the contacts.
    error : array (instants,), optional
        Estimated relative error of the wave.
    unreached : float
        Largest share of a contact that fresh lubricant does not reach; its film falls with the root of time.
    converged : bool
        True unless the wave did not repeat.
    """

    phases: Numbers
    least: Numbers
    central: Numbers
    ratio: Numbers
    moment: Numbers
    power: Numbers
    heat: float
    duration: float
    method: str = "hamrock-dowson"
    comparison: Numbers
    thickness: Numbers | None = None
    error: Numbers | None = None
    unreached: float = 0.0
    converged: bool = True

    @property
    def valid(self) -> bool:
        """True if the wave repeats, fresh lubricant reaches the contacts, and the estimated error is at most 10 %.

        A formula for other bodies is not valid.
        """
        refreshed = self.converged and self.unreached < _SMALL_SHARE
        return self.error is not None and refreshed and bool((self.error <= _MAX_ERROR).all())

    @property
    def note(self) -> str:
        """Sentence on the method of the film thickness."""
        if self.error is None:
            return CONFORMITY_NOTE
        if not self.converged:
            return f"{WAVE_NOTE}; it did not repeat, and this is the last cycle"
        error = f"{WAVE_NOTE}; estimated error of a steady film up to {100 * self.error.max(initial=0.0):.0f} %"
        if self.unreached < _SMALL_SHARE:
            return error
        share = f"{100 * self.unreached:.0f} % of the contact"
        unsettled = "its film falls without limit, here after about 100 cycles"
        return f"{error}; fresh lubricant does not reach {share}: {unsettled}"

    @property
    def regime(self) -> str:
        """Lubrication regime at the thickest film: "boundary", "mixed" or "full"; "unknown" without clearance."""
        largest = float(self.ratio.max(initial=0.0))
        if numpy.isnan(largest):
            return "unknown"
        return "boundary" if largest < _MIXED_RATIO else "mixed" if largest < _FULL_RATIO else "full"

    def summary(self) -> dict[str, Any]:
        """Return film and friction as a dictionary for JSON, with thicknesses in nm."""
        if not len(self.phases):
            return {}
        moment_magnitudes = numpy.linalg.norm(self.moment, axis=1)
        values = {
            "least_nm": 1e6 * self.least.min(),
            "largest_nm": 1e6 * self.least.max(),
            "lambda_least": self.ratio.min(),
            "lambda_largest": self.ratio.max(),
            "moment_Nmm": moment_magnitudes.max(),
            "power_W": self.heat / self.duration,
            "heat_J_per_cycle": self.heat,
        }
        finite_values = {name: float(value) if numpy.isfinite(value) else None for name, value in values.items()}
        largest_moment = [float(component) for component in self.moment[moment_magnitudes.argmax()]]
        return {
            **finite_values,
            "moment_on_cup_Nmm": largest_moment,
            "regime": self.regime,
            "note": self.note,
            "method": self.method,
            "valid": self.valid,
            "error": None if self.error is None else float(self.error.max(initial=0.0)),
        }


class LoadedCycle(Protocol):
    """Interface of the loads and rotations of a cycle in the cup's frame, such as `CupFrame`."""

    @property
    def joint(self) -> Joint:
        """Joint of single numbers."""
        ...

    @property
    def cycle(self) -> Cycle | Mix:
        """Cycle of loads and rotations."""
        ...

    @property
    def loaded(self) -> Numbers:
        """Indices of the loaded instants: (loaded,)."""
        ...

    @property
    def activities(self) -> tuple[tuple[str, Numbers], ...]:
        """Name of each activity, and indices of its loads among the loaded instants."""
        ...

    @property
    def rotation_increments(self) -> Numbers:
        """Rotation vectors of the ball in the loaded instants in rad: (loaded, 3)."""
        ...

    def socket_forces(self, displacement: Numbers) -> Numbers:
        """Compute the forces on the socket in N for displacements (loaded, 3) of the ball in mm."""
        ...


def film(
    frame: LoadedCycle,
    foundation: SocketFoundation,
    sliding: SurfaceSliding,
    equilibrium: CycleEquilibrium,
    lubricant: Lubricant,
    grid: Grid,
    method: str = METHODS[0],
) -> Film:
    """Compute film thickness, friction moment, power and heat of a cycle from its contacts and sliding.

    Raises
    ------
    ValueError
        An unknown method.
    """
    name = known_name("method", method, METHODS)
    durations = frame.cycle.seconds[frame.loaded]
    forces = frame.socket_forces(equilibrium.displacement)
    force_magnitudes = numpy.linalg.norm(forces, axis=1)
    spin = numpy.linalg.norm(numpy.cross(frame.rotation_increments, forces), axis=1) / numpy.where(
        force_magnitudes > 0, force_magnitudes, 1.0
    )
    formula = film_thickness(frame.joint, force_magnitudes, spin / durations, lubricant.viscosity)
    thickness: dict[str, Any] = {"least": formula[0], "central": formula[1]}
    if name == "wave" and foundation.clearance > 0 and len(forces):
        thickness = _carry_film(frame, foundation, equilibrium, lubricant.viscosity_mpa, grid)
    roughness = lubricant.roughness
    work = lubricant.friction * numpy.einsum("tp,tp,p->t", equilibrium.pressure, sliding.distances, foundation.areas)
    least = thickness["least"]
    return Film(
        phases=frame.cycle.phases[frame.loaded],
        ratio=least / roughness if roughness > 0 else numpy.full_like(least, inf),
        moment=lubricant.friction * _moment_at_unit_friction(foundation, sliding, equilibrium.pressure),
        power=1e-3 * work / durations,
        heat=1e-3 * float(work.sum()),
        duration=frame.cycle.duration,
        method=name,
        comparison=formula[0],
        **thickness,
    )


def _carry_film(
    frame: LoadedCycle, foundation: SocketFoundation, equilibrium: CycleEquilibrium, viscosity: float, grid: Grid
) -> dict[str, Any]:
    """Carry the film over each activity until it repeats, on cells of the grid merged near the pole."""
    meridians = thinned_meridians(grid.edges, grid.meridians)
    mesh = polar_mesh(foundation.socket_radius, grid.edges, meridians)
    merged = _merged_cells(grid, meridians)
    instants = _instants(frame, foundation, equilibrium, grid, merged)
    films = [carry_over_cycle(mesh, viscosity, [instants[index] for index in loads]) for _, loads in frame.activities]
    return {
        "least": numpy.concatenate([film.minimum for film in films]),
        "central": numpy.concatenate([film.central for film in films]),
        "thickness": numpy.concatenate([film.thickness for film in films])[:, merged],
        "error": numpy.concatenate([film.error for film in films]),
        "unreached": max(film.unreached for film in films),
        "converged": all(film.converged for film in films),
    }


def _merged_cells(grid: Grid, meridians: Numbers) -> Numbers:
    """Return the number of the merged cell of each cell of a grid: (rings * meridians,)."""
    starts = numpy.concatenate([[0], numpy.cumsum(meridians)[:-1]])
    column = numpy.arange(grid.meridians)
    merged: Numbers = starts[:, None] + column * meridians[:, None] // grid.meridians
    return merged.ravel()


def _instants(
    frame: LoadedCycle, foundation: SocketFoundation, equilibrium: CycleEquilibrium, grid: Grid, merged: Numbers
) -> list[CycleInstant]:
    """Collect pressure, edge and motion of the loaded instants."""
    pressure = numpy.stack([numpy.bincount(merged, row) for row in equilibrium.pressure]) / numpy.bincount(merged)
    forces = frame.socket_forces(equilibrium.displacement)
    axes = forces / numpy.linalg.norm(forces, axis=1)[:, None]
    durations = frame.cycle.seconds[frame.loaded]
    spins = frame.rotation_increments / durations[:, None]
    edges = _edges(frame, foundation, equilibrium, grid, axes)
    gaps = numpy.diff(frame.loaded, prepend=frame.loaded[-1] - frame.cycle.n_steps)
    return [
        CycleInstant(
            pressure=pressure[index],
            axis=axes[index],
            edge=edges[index],
            spin=spins[index],
            duration=float(durations[index]),
            interrupted=bool(gaps[index] != 1),
        )
        for index in range(len(axes))
    ]


def _edges(
    frame: LoadedCycle, foundation: SocketFoundation, equilibrium: CycleEquilibrium, grid: Grid, axes: Numbers
) -> list[Edge]:
    """Find the edge of the contact at each instant; contacts of few rings have the median of the others."""
    from ..elasticity.off_axis.contact_patch import ContactPatch  # slow to import

    exponent, radius = foundation.edge_exponent, foundation.socket_radius
    levels = foundation.edge_field(equilibrium, numpy.zeros(len(foundation.areas)))
    shape = (len(axes), grid.rings, grid.meridians)
    rows = zip(equilibrium.pressure.reshape(shape), levels.reshape(shape), axes, strict=True)
    inset = foundation.edge_inset
    constants = numpy.array(
        [
            ContactPatch(grid=grid, pressure=pressure, level=level, axis=axis, inset=inset).edge_constant(exponent)
            for pressure, level, axis in rows
        ]
    )
    known = constants[numpy.isfinite(constants) & (constants > 0)]
    median = float(numpy.median(known)) if len(known) else float(equilibrium.pressure.max())
    values = numpy.where(numpy.isfinite(constants) & (constants > 0), constants, median) / radius**exponent
    if exponent == 1:
        return [SpringEdge(slope=float(value), modulus=foundation.max_stiffness) for value in values]
    modulus = float(frame.joint.effective_modulus)
    return [ElasticEdge(coefficient=float(value), modulus=modulus) for value in values]


def _moment_at_unit_friction(foundation: SocketFoundation, sliding: SurfaceSliding, pressure: Numbers) -> Numbers:
    """Compute the friction moment on the cup in N mm for a coefficient of friction of 1: (instants, 3).

    It is ∫ R n × v/abs(v) p dA with v = R ω × n, and n × (ω × n) = ω - (ω·n) n.
    """
    directions, rotations, distances = foundation.directions, sliding.rotation_increments, sliding.distances
    pressure_weight = numpy.divide(
        pressure * foundation.areas * sliding.radius**2,
        distances,
        out=numpy.zeros_like(distances),
        where=distances > 0,
    )
    normal_part = pressure_weight * (rotations @ directions)
    return rotations * pressure_weight.sum(axis=1)[:, None] - normal_part @ directions.T
