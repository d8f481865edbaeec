"""States of the contacts of one joint in a batch: one number per contact for each quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ...contact.per_joint import QUANTITIES
from ...core.arrays import Numbers
from . import patch_measures as measures
from .bore_contact import BoreContact, EquilibriumBatch
from .contact_patch import ContactPatch
from .directions import magnitudes_and_directions
from .lane_solver import can_solve_lanes, solve_tangents
from .patch_measures import CellArrays, Patches
from .rim_curve import CurveFunction
from .surfaces import EdgeRelation

_PRESSURE_ERRORS = {"force": 0.3, "indentation": 0.2, "max_pressure": 0.3, "pole_pressure": 0.3}
_PRESSURE_ERRORS |= {"stiffness": 0.7, "energy": 0.4, "pressure_integral": 0.3}
"""Factors of the errors that follow from the pressures and the edge: of (ring width / half angle)²."""

_HALF_ANGLE_ERROR = 0.1
"""Factor of the error of the half angle: of ring width / half angle.

Both were measured against the exact solution. A test repeats this for random contacts.
"""

_MEASURED_CONTACTS = 8  # number of contacts that are measured together
_FRICTION_AXES = 4  # number of axes around the load over which a friction torque is averaged
_MIN_ERROR = 3e-4  # relative error of all quantities that the finite elements of the cup leave

LoadSolver = Callable[[BoreContact, Numbers, Numbers, EdgeRelation], "ContactStates"]
"""Function from a bore contact, loads (contacts,), axes (contacts, 3) and an edge relation to the contacts."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactStates:
    """Solved contacts of one joint, with one number per contact for each quantity."""

    bore: BoreContact
    equilibrium: EquilibriumBatch
    # (contacts, 3), unit vectors of the loads in the cup's frame, at which the pole pressure is read and angles
    # start
    axes: Numbers
    edges: EdgeRelation
    dislocated: Numbers  # bool (contacts,), True where the bore does not hold the ball
    load: Numbers  # (contacts,), prescribed force (N), indentation (mm) or half angle (rad) along the axes
    solve: LoadSolver  # solver of the same kind of load, for other loads and axes
    # maker of the curve of tilts at first rim contact, for this kind of load: see `RimCurve`
    rim_curve: CurveFunction | None = None
    # bool (contacts,), True where no contact in this bore has the prescribed half angle
    too_wide: Numbers | bool = False

    @property
    def converged(self) -> Numbers:
        """True where the iteration converged: (contacts,)."""
        return self.equilibrium.converged

    @property
    def components(self) -> Numbers:
        """Components of the axes of the loads: (3, contacts)."""
        return self.axes.T

    @property
    def loaded_area(self) -> Numbers:
        """Area of the loaded cells on a unit sphere: (contacts,)."""
        return ((self.equilibrium.pressure > 0) * self.bore.compliance.grid.areas).sum(axis=(1, 2))

    @property
    def rim_level(self) -> Numbers:
        """Largest level in mm over the cells of the ring at the rim: (contacts,)."""
        return self.levels[:, -1].max(axis=1)

    @property
    def unconverged(self) -> Numbers:
        """Flag of each contact: 1 if its iteration did not converge, else 0."""
        return (~self.equilibrium.converged & ~self.dislocated).astype(float)

    @property
    def reachable(self) -> Numbers:
        """True where a contact can have the prescribed half angle, and where the ball is dislocated."""
        return numpy.logical_not(self.too_wide) | self.dislocated

    @cached_property
    def patches(self) -> tuple[ContactPatch, ...]:
        """Contact patch of each contact."""
        grid, inset = self.bore.compliance.grid, self.edges.inset
        rows = zip(self.equilibrium.pressure, self.levels, self.axes, strict=True)
        return tuple(
            ContactPatch(grid=grid, pressure=p, level=level, axis=axis, inset=inset) for p, level, axis in rows
        )

    @cached_property
    def _cells(self) -> CellArrays:
        return measures.make_cell_arrays(self.bore.compliance.grid, self.edges.inset)

    def _measure(self, measure: Callable[..., Numbers], *values: Numbers) -> Numbers:
        """Measure all contacts by a function of cells and values, in blocks that fit into the processor's cache."""
        starts = range(0, max(len(self.axes), 1), _MEASURED_CONTACTS)
        blocks = [[array[i : i + _MEASURED_CONTACTS] for array in values] for i in starts]
        with numpy.errstate(all="ignore"):  # rays that miss the rim
            return numpy.concatenate([measure(self._cells, *block) for block in blocks])

    def _measure_patches(self, measure: Callable[..., Numbers], *values: Numbers) -> Numbers:
        """Measure all contacts by a function of cells, patches and values."""
        fields = self.equilibrium.pressure, self.levels, self.axes
        return self._measure(lambda cells, *block: measure(cells, Patches(*block[:3]), *block[3:]), *fields, *values)

    @cached_property
    def levels(self) -> Numbers:
        """Level in mm of every cell: positive in the contact, minus the gap outside: (contacts, rings, meridians)."""

        def block_levels(_cells: CellArrays, pressure: Numbers, displacement: Numbers) -> Numbers:
            deformed = self.bore.compliance.single_precision_softness(pressure)  # suffices for gaps
            return self.edges.levels(pressure, deformed - self.bore.gap.overlap(displacement))

        return self._measure(block_levels, self.equilibrium.pressure, self.equilibrium.displacement)

    @cached_property
    def force_vector(self) -> Numbers:
        """Force on the cup in N, in the cup's frame: (3, contacts)."""
        return self.bore.force(self.equilibrium.pressure).T

    @property
    def displacement(self) -> Numbers:
        """Displacement of the ball's centre from the centre of the bore in mm: (3, contacts)."""
        return self.equilibrium.displacement.T

    def friction_levers(self, axis_angle: float) -> Numbers:
        """Sum pressures times levers about axes at an angle (rad) from the load: (contacts,), in MPa on a unit sphere.

        The levers are means over axes all around the load.
        """
        grid, pressure = self.bore.compliance.grid, self.equilibrium.pressure
        weights, levers = pressure * grid.areas, numpy.zeros(len(pressure))
        for contact, load_axis in enumerate(self.axes):
            cosine = numpy.tensordot(load_axis, grid.centroids, 1)
            first, second = measures.tangents_at(load_axis)
            along_first, along_second = (numpy.tensordot(tangent, grid.centroids, 1) for tangent in (first, second))
            azimuth = numpy.arctan2(along_second, along_first)
            sine = numpy.sqrt(numpy.maximum(1.0 - cosine * cosine, 0.0))
            for turn in numpy.arange(_FRICTION_AXES) * (numpy.pi / _FRICTION_AXES):
                along = cosine * numpy.cos(axis_angle) + sine * numpy.sin(axis_angle) * numpy.cos(azimuth - turn)
                lever = numpy.sqrt(numpy.maximum(1.0 - along * along, 0.0))
                levers[contact] += (weights[contact] * lever).sum() / _FRICTION_AXES
        return levers

    @property
    def force(self) -> Numbers:
        """Magnitude of the force in N; in a preloaded joint its component along the load, negative in tension."""
        if self._preloaded:
            return numpy.einsum("kn,nk->n", self.force_vector, self.axes)
        return numpy.linalg.norm(self.force_vector, axis=0)

    @property
    def indentation(self) -> Numbers:
        """Displacement of the ball in mm beyond the clearance; in a preloaded joint its component along the load."""
        if self._preloaded:
            return numpy.einsum("kn,nk->n", self.displacement, self.axes) - self.bore.gap.clearance
        return numpy.linalg.norm(self.displacement, axis=0) - self.bore.gap.clearance

    @property
    def _preloaded(self) -> bool:
        return self.bore.gap.clearance < 0

    @cached_property
    def tangent(self) -> Numbers:
        """Tangent stiffness matrices in N/mm, (3, 3, contacts), with the edge between cells: see `cell_shares`."""
        share = self._measure_patches(measures.cell_shares, self._edges[:, :3], self._edges[:, 3:])
        if can_solve_lanes(self.bore):
            return numpy.moveaxis(solve_tangents(self.bore, share, self.edges.compliance), 0, -1)
        tangents = [numpy.zeros((0, 3, 3))]
        for block in self.bore.split_into_blocks(numpy.arange(len(share))):
            displacement, compliance = self.equilibrium.displacement[block], self.edges.compliance
            sensitivity = self.bore.pressure_sensitivity(displacement, share[block], None, 1e-6, compliance)
            tangents.append(self.bore.tangent(sensitivity))
        return numpy.moveaxis(numpy.concatenate(tangents), 0, -1)

    @property
    def stiffness(self) -> Numbers:
        """Tangent stiffness in N/mm, the derivative of the force by the indentation."""
        if self._preloaded:
            return numpy.einsum("nk,kln,nl->n", self.axes, self.tangent, self.axes)
        _, force_direction = magnitudes_and_directions(self.force_vector.T)
        _, motion_direction = magnitudes_and_directions(self.displacement.T)
        return numpy.einsum("nk,kln,nl->n", force_direction, self.tangent, motion_direction)

    @cached_property
    def energy(self) -> Numbers:
        """Work of the load in N mm as the ball moves straight from the centre of the bore.

        With a linear gap it is the stored energy of both bodies.
        """
        p = self.equilibrium.pressure
        displacement = self.bore.compliance.softness(p)
        stored = self.bore.area * self.bore.compliance.grid.integrate_product(p, displacement) / 2
        return stored + self.bore.work_beyond_stored_energy(self.equilibrium.displacement)

    @property
    def pressure_integral(self) -> Numbers:
        """Integral of the pressure over the contact area, ∫ p dA, in N."""
        p = self.equilibrium.pressure
        return self.bore.area * self.bore.compliance.grid.integrate_product(p, numpy.ones_like(p))

    @cached_property
    def half_angle(self) -> Numbers:
        """Half angles in rad of round contacts of the same area."""
        return self._measure_patches(measures.half_angles, self._edges[:, 3:])

    @cached_property
    def _edges(self) -> Numbers:
        """Centre of each contact, and the angles in rad from it to the edge along rays: (contacts, 3 + rays)."""
        return self._measure_patches(lambda cells, patches: numpy.column_stack(measures.measure_edges(cells, patches)))

    @property
    def edge_loaded(self) -> Numbers:
        """Flag of each contact: 1 if there is pressure at the end of the bore, else 0."""
        return numpy.asarray(measures.edge_loaded(self.equilibrium.pressure)).astype(float)

    @cached_property
    def edge_margin(self) -> Numbers:
        """Angle in rad from the edge of each contact to the end of the bore; 0 if it reaches the end."""
        return self._measure_patches(measures.edge_margins)

    @property
    def unbounded(self) -> Numbers:
        """Flag of each contact: 1 if the end of the bore indents the ball with an unbounded pressure, else 0."""
        return self.edge_loaded * (not self.edges.bounded)

    @cached_property
    def _largest(self) -> Numbers:
        """Largest pressure of each contact in MPa, and the unit vector to it: (contacts, 4)."""
        return self._measure(
            lambda cells, pressure, axis: numpy.column_stack(measures.largest_pressures(cells, pressure, axis)),
            self.equilibrium.pressure,
            self.axes,
        )

    @property
    def max_pressure(self) -> Numbers:
        """Largest pressure in MPa, infinite where the end of the bore indents the ball."""
        return numpy.where(self.unbounded == 1, numpy.inf, self._largest[:, 0])

    @property
    def max_pressure_at(self) -> Numbers:
        """Unit vectors to the largest pressures: (3, contacts)."""
        return self._largest[:, 1:].T

    @property
    def max_pressure_angle(self) -> Numbers:
        """Angle in rad from the load to the largest pressure."""
        sine = numpy.linalg.norm(numpy.cross(self.max_pressure_at.T, self.axes), axis=1)
        return numpy.arctan2(sine, (self.max_pressure_at.T * self.axes).sum(axis=1))

    @property
    def pole_pressure(self) -> Numbers:
        """Pressure in MPa at the axis of the load."""
        return self._measure(measures.axis_pressures, self.equilibrium.pressure, self.axes)

    def pressure(self, angle: Numbers) -> Numbers:
        """Interpolate the pressure in MPa at angles (..., contacts) in rad from the load towards the rim.

        The angles lie in the plane of the load and the cup's axis.
        """
        columns = [patch.pressure_along(angle[:, i]) for i, patch in enumerate(self.patches)]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)


_SUMMARY_QUANTITIES = (
    *("load", "components", "dislocated", "converged", "unconverged", "reachable", "force_vector", "displacement"),
    *("force", "indentation", "half_angle", "loaded_area", "max_pressure", "max_pressure_at", "max_pressure_angle"),
    *("pole_pressure", "tangent", "stiffness", "energy", "pressure_integral", "edge_loaded", "unbounded"),
    *("edge_margin", "rim_level"),
)


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactSummaries:
    """Quantities of `ContactStates` by their names, without the fields; arrays have a last axis of contacts."""

    bore: BoreContact
    edges: EdgeRelation
    solve: LoadSolver
    rim_curve: CurveFunction | None
    quantities: dict[str, Numbers]  # by the names of `_SUMMARY_QUANTITIES`

    @property
    def axes(self) -> Numbers:
        """Unit vectors of the loads in the cup's frame: (contacts, 3)."""
        return self.components.T

    def __getattr__(self, name: str) -> Any:
        """Return a quantity; raise ValueError for what needs the pressure fields."""
        if name in _SUMMARY_QUANTITIES:
            return self.quantities[name]
        if hasattr(ContactStates, name) or name == "equilibrium":
            raise ValueError(
                f'a summary has no {name}: profiles, maps and outlines need pressure fields; press with keep="fields"'
            )
        raise AttributeError(name)


def summarise(blocks: Iterable[ContactStates]) -> ContactSummaries:
    """Compute the summaries of blocks of contacts, one block after the other."""
    parts: dict[str, list[Numbers]] = {name: [] for name in _SUMMARY_QUANTITIES}
    for states in blocks:
        for name, values in parts.items():
            values.append(getattr(states, name))
    return ContactSummaries(
        bore=states.bore,
        edges=states.edges,
        solve=states.solve,
        rim_curve=states.rim_curve,
        quantities={name: numpy.concatenate(values, axis=-1) for name, values in parts.items()},
    )


def estimate_errors(states: ContactStates | ContactSummaries, load_kind: str) -> dict[str, Numbers]:
    """Estimate the relative error of each quantity from the width of the contact in rings.

    The prescribed quantity, `load_kind`, is exact. A prescribed half angle propagates its own error.
    """
    grid = states.bore.compliance.grid
    square = grid.width**2 * numpy.pi / numpy.maximum(states.loaded_area, grid.areas.min())  # (width / half angle)²
    errors = {name: _MIN_ERROR + factor * square for name, factor in _PRESSURE_ERRORS.items()}
    errors["half_angle"] = _MIN_ERROR + _HALF_ANGLE_ERROR * numpy.sqrt(square)
    if load_kind == "half_angle":
        # logarithmic derivatives by the half angle on springs, where the indentation grows as 1/cos ε - 1
        angle = numpy.minimum(states.half_angle, 1.5)
        x = numpy.cos(angle)
        growth = angle / numpy.tan(angle / 2) / x
        exponents = dict.fromkeys(QUANTITIES, growth)
        exponents |= {"force": (2 - 2 * (1 - x) * (1 + x) / (2 + x)) * growth, "energy": (2 + x) * growth}
        exponents |= {"pressure_integral": (1 + x) * growth, "half_angle": 0.0 * x}
        return {name: errors[name] + exponent * errors[load_kind] for name, exponent in exponents.items()}
    errors[load_kind] = 0.0 * square
    return {name: errors[name] for name in QUANTITIES}
