"""Curve of the contacts that just touch the end of an unworn bore: the tilt of the load at first rim contact, by load.

A ball is displaced along a direction until its contact just touches the rim. The last ring is kept open, so that
pressures and margin are smooth beyond first touch. The margin then decreases smoothly with the indentation.

With a linear gap all lengths and pressures are proportional to the clearance. A curve is computed for a clearance of
1 mm in a bore of radius 1 mm, and holds for every clearance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy

from ...core.arrays import Numbers
from ...problem.gaps import LinearGap
from . import coupled_search as search
from .bore_contact import BoreContact, GapField, make_bore_arrays
from .compliance import Compliance
from .coupled_search import BoreArrays
from .grid import Grid
from .patch_measures import make_cell_arrays

_POINTS = 9  # number of contacts of a curve

_MIN_RINGS, _MAX_BORE_SHARE, _MAX_RIM_ANGLE = 3.0, 0.95, 1.1
"""Range of angles from the displacement to the rim: three rings, up to a share of the bore, and to 1.1 rad."""

_COARSE_TARGETS, _COARSE_ITERATIONS = (0.15, 0.15, 0.15, 0.15, 0.15), 9
"""Margins in ring widths that are approached in wide cells one after the other, and iterations for each."""

_FINE_TARGETS, _FINE_ITERATIONS = (0.05, 0.02, 0.01, 0.0, 0.0), 12  # the same in the cells of the bore
_FIRST_RATIO = 2.0  # increase of the half angle of a rigid overlap by decrease of the margin, before it is known
_MIN_FACTOR, _MAX_FACTOR = 0.5, 2.5  # limits of the known increase, relative to the first one
_MAX_STEP = 0.5  # largest step of the logarithm of an indentation
_NEGATIVE_FACTOR = 3.0  # factor of negative margins, which change more slowly with the overlap
_FORCE_SCALE = 1e20  # force in N that makes the residual of the force negligible: the displacement is prescribed
_MAX_ERROR = 1e-4  # largest residual of the overlaps of a contact of the curve

_MAX_MARGIN, _MAX_BRACKET = 0.05, 0.15
"""Largest margin in ring widths at the end of a search, and the same if the last two margins have opposite signs."""


class RimPoints(NamedTuple):
    """Contacts of displaced balls near the rim: arrays (contacts,)."""

    rim_angle: Numbers  # angle in rad from the displacement to the rim
    log_indentation: Numbers  # logarithm of the displacement in mm beyond the clearance
    # angle in rad from the edge of the contact to the rim, negative where the open last ring overlaps the ball
    margin: Numbers
    # logarithm of the force in N, and angle in rad from the cup's axis to the force
    log_force: Numbers
    tilt: Numbers

    def extrapolate(self, previous: RimPoints, log_indentation: Numbers) -> RimPoints:
        """Extrapolate linearly from previous contacts and these to other indentations; equal ones stay as they are."""
        change = self.log_indentation - previous.log_indentation
        factor = numpy.where(change == 0, 0.0, (log_indentation - self.log_indentation) / change)
        return RimPoints(*(new + factor * (new - old) for new, old in zip(self, previous, strict=True)))


class _RimCells(NamedTuple):
    """Grid, folded arrays of a bore with and without its last ring, and edges in the rings in rad and mm/MPa."""

    grid: Grid
    bore: BoreArrays
    open_bore: BoreArrays
    edge_nodes: Numbers
    edge_compliance: Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class RimCurve:
    """Tilts of loads at first rim contact."""

    log_load: Numbers  # (n,), logarithms of loads, ascending
    tilt: Numbers  # (n,), tilts of the loads in rad

    def interpolate(self, load: Numbers) -> Numbers:
        """Interpolate the tilts in rad at loads by a spline; NaN beyond the ends of the curve."""
        if len(self.tilt) < 2:
            return numpy.full(len(load), numpy.nan)
        from scipy.interpolate import make_interp_spline  # slow to import

        spline = make_interp_spline(self.log_load, self.tilt, k=min(3, len(self.tilt) - 1))
        return spline(numpy.log(load), extrapolate=False)


CurveFunction = Callable[[RimPoints, float, float, float], RimCurve]
"""Function from contacts, the polar angle of the end of the bore, and clearance and radius in mm to a curve."""


def force_curve(points: RimPoints, reach: float, clearance: float, radius: float) -> RimCurve:
    """Make the curve of the forces in N."""
    del reach
    return RimCurve(log_load=points.log_force + numpy.log(clearance * radius**2), tilt=points.tilt)


def indentation_curve(points: RimPoints, reach: float, clearance: float, radius: float) -> RimCurve:
    """Make the curve of the indentations in mm."""
    del radius
    return RimCurve(log_load=points.log_indentation + numpy.log(clearance), tilt=reach - points.rim_angle)


@lru_cache(maxsize=8)
def cached_rim_points(compliance: Compliance, edge_softness: float, inset: float) -> RimPoints:
    """Solve contacts that just touch the rim, in the order of their loads, from a cache.

    The bore is elastic and has a coarser grid. `edge_softness` is `EdgeRelation.compliance` by a ring's width in rad,
    in mm/MPa. The points hold for a clearance of 1 mm in a bore of radius 1 mm. Loads that fill the bore before they
    touch are left out.
    """
    coarser = compliance.coarser_compliance
    if coarser is None:
        raise ValueError("contacts at the rim need a grid with a coarser one")
    wide, fine = (_make_rim_cells(part, edge_softness, inset) for part in (coarser, compliance))
    grid = compliance.grid
    largest = min(_MAX_BORE_SHARE * grid.reach, _MAX_RIM_ANGLE)
    rim_angle = numpy.linspace(min(_MIN_RINGS * grid.width, largest / 2), largest, _POINTS)
    with numpy.errstate(all="ignore"):  # a contact that diverges is left out
        rim_search = _RimSearch(wide, rim_angle)
        rim_search.approach_rim(_COARSE_TARGETS, _COARSE_ITERATIONS)
        rim_search.cells, rim_search.pressure = fine, search.refine_fields(fine.bore, rim_search.pressure)
        rim_search.approach_rim(_FINE_TARGETS, _FINE_ITERATIONS)
        return rim_search.touching_points()


def _make_rim_cells(compliance: Compliance, edge_softness: float, inset: float) -> _RimCells:
    """Make the arrays of a bore of radius and clearance 1 mm."""
    grid = compliance.grid
    depth = numpy.zeros((grid.rings, grid.meridians))
    gap = GapField(grid=grid, clearance=1.0, socket_radius=1.0, depth=depth, kind=LinearGap)
    bore = search.fold_bore(make_bore_arrays(BoreContact(compliance=compliance, gap=gap)), even=True)
    normals = bore.normals.reshape(-1, grid.rings, 2)
    weights = bore.force_weights.reshape(2, -1, grid.rings)
    open_bore = bore._replace(
        softness=numpy.ascontiguousarray(bore.softness[:, :-1, :-1]),
        stiffness=numpy.ascontiguousarray(bore.stiffness[:, :-1, :-1]),
        normals=normals[:, :-1].reshape(-1, 2),
        gap=bore.gap[:, :-1],
        areas=bore.areas[:-1],
        force_weights=weights[:, :, :-1].reshape(2, -1),
    )
    edge_nodes, widths = make_cell_arrays(grid, inset).edge_nodes, numpy.diff(grid.edges)
    return _RimCells(grid, bore, open_bore, edge_nodes, edge_softness * widths)


class _RimSearch:
    """Search for the indentations at which contacts just touch the rim, by secants of their margins."""

    def __init__(self, cells: _RimCells, rim_angle: Numbers) -> None:
        """Start with the indentations whose rigid overlap ends at the rim."""
        self.cells, self.rim_angle = cells, rim_angle
        cosine, sine = numpy.cos(rim_angle), numpy.sin(rim_angle)
        self.log_indentation = numpy.log(1 / cosine - 1)
        self.first_ratio = _FIRST_RATIO * sine / (cosine * (1 - cosine))
        self.pressure = search.estimate_pressure(cells.bore, self._displacement)
        self.points = self.previous = RimPoints(*(0.0 * rim_angle for _ in RimPoints._fields))

    @property
    def _displacement(self) -> Numbers:
        polar = self.cells.grid.reach - self.rim_angle
        axes = numpy.stack([numpy.sin(polar), numpy.cos(polar)])
        return (axes * (1 + numpy.exp(self.log_indentation))).astype(numpy.float32)

    def approach_rim(self, targets: tuple[float, ...], iterations: int) -> None:
        """Change the indentations towards margins in ring widths, one after the other."""
        ratio = self.first_ratio
        # size of a negative margin from which it no longer changes
        max_overlap = 0.9 * _NEGATIVE_FACTOR * float(self.cells.edge_nodes[-1] - self.cells.edge_nodes[-2])
        for number, target in enumerate(targets):
            self.previous, self.points = self.points, self._press(iterations)
            if number:  # increase of ln indentation by decrease of the margin from the last two contacts
                change = self.points.log_indentation - self.previous.log_indentation
                decrease = self.previous.margin - self.points.margin
                factor = numpy.where(decrease == 0, 1.0, change / decrease / self.first_ratio)
                lowest = numpy.minimum(self.previous.margin, self.points.margin)
                factor = numpy.where(lowest > -max_overlap, factor, 1.0)
                ratio = self.first_ratio * numpy.clip(factor, _MIN_FACTOR, _MAX_FACTOR)
            step = ratio * (self.points.margin - target * self.cells.grid.width)
            self.log_indentation = self.log_indentation + numpy.clip(step, -_MAX_STEP, _MAX_STEP)

    def _press(self, iterations: int) -> RimPoints:
        """Solve the contacts of the displaced balls with the last ring open."""
        displacement, bore = self._displacement, self.cells.open_bore
        no_load, scale = 0.0 * displacement, numpy.full(len(self.rim_angle), _FORCE_SCALE, dtype=numpy.float32)
        pressure = self.pressure[:, :-1]
        lanes = search.start_lanes(bore, no_load, scale, displacement, pressure)
        for _ in range(iterations):
            lanes = search.advance_lanes(bore, no_load, lanes)
        self.pressure = numpy.concatenate([lanes.pressure, 0.0 * lanes.pressure[:, :1]], axis=1)
        remaining = search.balance_contacts(self.cells.bore, no_load, displacement, self.pressure).remaining
        self.error, (x, z) = lanes.error, -lanes.imbalance
        return RimPoints(
            rim_angle=self.rim_angle,
            log_indentation=self.log_indentation,
            margin=self._measure_margin(self.pressure[0], remaining[0]),
            log_force=numpy.log(numpy.hypot(x, z)),
            tilt=numpy.arctan2(x, z),
        )

    def _measure_margin(self, pressure: Numbers, remaining: Numbers) -> Numbers:
        """Compute the margins on one meridian from pressures and overlaps (rings, contacts)."""
        nodes, contacts, rings = self.cells.edge_nodes, numpy.arange(pressure.shape[1]), len(pressure)
        last = numpy.minimum(rings - 1 - (pressure[::-1] > 0).argmax(axis=0), rings - 2)
        inner = pressure[last, contacts] * self.cells.edge_compliance[last]
        outer = remaining[last + 1, contacts]
        fraction = numpy.where(inner > outer, numpy.minimum(inner / (inner - outer), 2.0), 2.0)
        margin = nodes[-1] - nodes[last] - fraction * (nodes[last + 1] - nodes[last])
        return numpy.where(margin < 0, _NEGATIVE_FACTOR * margin, margin)

    def touching_points(self) -> RimPoints:
        """Extrapolate to contacts that touch the rim, and leave out all from the first that is not close to it."""
        touching = self.points.extrapolate(self.previous, self.log_indentation)
        bracketed = self.points.margin * self.previous.margin < 0
        largest = numpy.where(bracketed, _MAX_BRACKET, _MAX_MARGIN) * self.cells.grid.width
        near = (abs(self.points.margin) <= largest) & (self.error <= _MAX_ERROR)
        rising = numpy.diff(touching.log_force, prepend=-numpy.inf) > 0
        count = numpy.append(near & rising, False).argmin()
        return RimPoints(*(values[:count] for values in touching))
