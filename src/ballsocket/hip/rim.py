"""Rim of the cup: distance from the contact to the rim, and microseparation with the ball on the rim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, sin
from types import MappingProxyType
from typing import Any, Protocol

import numpy

from ..core.arrays import Numbers
from ..core.records import Record
from ..elasticity.off_axis.grid import Grid
from .cycle import Cycle, Spring
from .mix import Mix

_BISECTIONS = 60
_BALANCE_TOLERANCE = 1e-6  # tolerance of the ball's displacement on its spring, as a share of the mismatch


class CupLoading(Protocol):
    """Interface of the loads of a cycle in a cup, such as `CupFrame`."""

    @property
    def cycle(self) -> Cycle | Mix:
        """Cycle of load and motion."""

    @property
    def loads(self) -> Numbers:
        """Forces of the loaded steps in N: (loaded, 3)."""

    @property
    def loaded(self) -> Numbers:
        """Indices of the loaded steps: (loaded,)."""


@dataclass(frozen=True, kw_only=True)
class ClosestApproach:
    """Step of a cycle in which the contact is closest to the rim.

    Attributes
    ----------
    distance : float
        Distance to the rim in mm; 0 is edge loading.
    azimuth : float
        Position around the cup's axis in rad from its uppermost point.
    step_description : str
        Phase of the step, in words.
    steps_at_rim : int
        Number of steps in which the contact reaches the rim.
    pressure : float
        Largest pressure in MPa in the outermost ring of cells in any step.
    steps_edge_loaded : int
        Number of steps with edge loading; see `RimDistance.edge_loaded`.
    """

    distance: float
    azimuth: float
    step_description: str
    steps_at_rim: int
    pressure: float = 0.0
    steps_edge_loaded: int = 0

    @property
    def kind(self) -> str:
        """Kind of the contact at the rim: "edge loading", "worn to the rim" or "clear of the rim"."""
        if self.steps_edge_loaded:
            return "edge loading"
        return "worn to the rim" if self.steps_at_rim else "clear of the rim"

    @property
    def location(self) -> str:
        """Time in the cycle and position around the cup in words."""
        return f"{self.step_description}, {abs(degrees(self.azimuth)):.0f}° from the cup's uppermost point"

    def summary(self) -> dict[str, Any]:
        """Return the closest approach as a dictionary for JSON, in mm and degrees."""
        azimuth = degrees(self.azimuth)
        return {
            "distance_mm": self.distance,
            "at": self.step_description,
            "place_deg": azimuth,
            "instants_at_rim": self.steps_at_rim,
            "pressure_at_rim_MPa": self.pressure,
            "kind": self.kind,
            "instants_edge_loaded": self.steps_edge_loaded,
        }


@dataclass(frozen=True, kw_only=True, eq=False)
class RimDistance(Record):
    """Distance of each contact of a cycle from the rim of the cup.

    Attributes
    ----------
    distance : array (loaded,)
        Shortest arc in mm from the contact's edge to the end of the bore; 0 if the contact reaches it.
    azimuth : array (loaded,)
        Position of the shortest distance around the cup's axis, in rad from its uppermost point.
    pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    edge_loaded : array of bool (loaded,), optional
        Contacts that reach the rim and are edge loading, not wear: the unworn bore's contact reaches the rim under the
        same load, or the largest pressure of the cycle is at the rim. None for an unworn bore: all contacts that reach
        the rim.
    """

    distance: Numbers
    azimuth: Numbers
    pressure: Numbers
    edge_loaded: Numbers | None = None

    def closest_index(self, loading: CupLoading) -> int | None:
        """Return the index of the contact closest to the rim; None without loads."""
        if not len(self.distance):
            return None
        closest_indices = numpy.flatnonzero(self.distance <= self.distance.min())
        return int(closest_indices[numpy.linalg.norm(loading.loads[closest_indices], axis=1).argmax()])

    def closest_approach(self, loading: CupLoading) -> ClosestApproach | None:
        """Return the step in which the contact is closest to the rim; None without loads."""
        index = self.closest_index(loading)
        if index is None:
            return None
        return ClosestApproach(
            distance=float(self.distance[index]),
            azimuth=float(self.azimuth[index]),
            step_description=loading.cycle.describe_step(int(loading.loaded[index])),
            steps_at_rim=int((self.distance <= 0).sum()),
            pressure=float(self.pressure.max()),
            steps_edge_loaded=int((self.distance <= 0 if self.edge_loaded is None else self.edge_loaded).sum()),
        )


def mask_edge_loading(worn: RimDistance, unworn: RimDistance, max_pressure: float) -> Numbers:
    """Find the contacts of a worn bore that are edge loading, not wear: (loaded,).

    A worn bore that fits the ball touches it up to the rim in every instant. Edge loading is a contact at the rim for
    one of two reasons. The load points so close to the rim that the contact of the unworn bore reaches it too. Or the
    largest pressure of the cycle, in MPa, is at the rim.
    """
    at_rim = worn.distance <= 0
    largest_at_rim = (worn.pressure > 0) & (worn.pressure >= max_pressure)
    return numpy.asarray(at_rim & ((unworn.distance <= 0) | largest_at_rim))


def rim_distance(grid: Grid, radius: float, field: Numbers, pressure: Numbers, inset: float) -> RimDistance:
    """Compute the distance in mm of each contact from the rim, from a field that is 0 at contact edges.

    The field (loaded, cells) is positive in the contact; the edge is the zero of linear interpolation between two
    cells. `inset` is the distance of the edge inside that zero, as a share of a ring's width. If it is positive,
    pressure in the last ring means a contact that reaches the rim.
    """
    level = field.reshape(len(field), grid.rings, grid.meridians)
    polar_nodes = grid.polar - inset * numpy.diff(grid.edges)
    if inset > 0:
        polar_nodes[-1] = grid.reach
    is_end = (level > 0) & numpy.concatenate([level[:, 1:] <= 0, numpy.ones_like(level[:, :1], dtype=bool)], axis=1)
    next_ring = numpy.concatenate([numpy.arange(1, grid.rings), [grid.rings - 2]])  # extrapolates beyond the last ring
    level_drop = level - level[:, next_ring]
    fraction = numpy.divide(level, level_drop, out=numpy.full_like(level, numpy.inf), where=is_end & (level_drop != 0))
    spacing = (polar_nodes[next_ring] - polar_nodes)[:, None]
    edge_angles = numpy.where(fraction * spacing >= 0, polar_nodes[:, None] + fraction * spacing, grid.reach)
    edge_angle = numpy.where(is_end, numpy.minimum(edge_angles, grid.reach), 0.0).max(axis=1, initial=0.0)
    return RimDistance(
        distance=(grid.reach - edge_angle.max(axis=1, initial=0.0)) * radius,
        azimuth=_edge_azimuth(edge_angle, level[:, -1], grid.azimuth),
        pressure=pressure.reshape(level.shape)[:, -1].max(axis=1, initial=0.0),
    )


def _edge_azimuth(edge_angle: Numbers, last_ring: Numbers, azimuth: Numbers) -> Numbers:
    """Compute the azimuth in rad of the contact edge that is closest to the rim: (loads,)."""
    outermost = edge_angle >= edge_angle.max(axis=1, initial=0.0)[:, None]
    weight = numpy.where(outermost, numpy.maximum(last_ring, 1e-300), 0.0)
    x, y = weight @ numpy.cos(azimuth), weight @ numpy.sin(azimuth)
    return numpy.arctan2(numpy.where(abs(y) < 1e-9 * abs(x), 0.0, y), x)


@dataclass(frozen=True, kw_only=True, eq=False)
class Microseparation:
    """Steps of a cycle in which the ball sits on the rim of the cup.

    Attributes
    ----------
    steps : array (n,)
        Indices of the steps in the cycle.
    displacement : array (n, 3)
        Displacement of the ball's centre from the bore's in mm, in the cup's frame; NaN if the ball is not held.
    azimuth : array (n,)
        Position of the rim contact around the cup's axis, in rad from its uppermost point.
    side : array (3,)
        Medial-lateral direction, in the cup's frame: that of the spring.
    """

    steps: Numbers
    displacement: Numbers
    azimuth: Numbers
    side: Numbers

    @property
    def medial_lateral(self) -> float:
        """Largest medial-lateral separation in mm, which laboratories report as dynamic separation."""
        return float(abs(self.displacement @ self.side).max(initial=0.0))

    @property
    def centre_distance(self) -> float:
        """Largest distance in mm between the centres of ball and socket."""
        return float(numpy.linalg.norm(self.displacement, axis=1).max(initial=0.0))

    def summary(self, cycle: Cycle | Mix) -> dict[str, Any]:
        """Return the microseparation as a dictionary for JSON, in mm and degrees."""
        distances = numpy.diff(self.steps, append=self.steps[0] + cycle.n_steps)
        last = int(distances.argmax())
        azimuth = self.azimuth[int(numpy.linalg.norm(self.displacement, axis=1).argmax())]
        return {
            "from": cycle.describe_step(int(self.steps[(last + 1) % len(distances)])),
            "to": cycle.describe_step(int(self.steps[last])),
            "medial_lateral_mm": self.medial_lateral,
            "centre_distance_mm": self.centre_distance,
            "place_deg": degrees(azimuth),
        }

    def describe(self, cycle: Cycle | Mix) -> str:
        """Describe the microseparation in one sentence for reports."""
        values = self.summary(cycle)
        measured = " and ".join(f"{value} ± {spread} mm" for value, spread in MEASURED_SEPARATIONS.values())
        return (
            f"microseparation from {values['from']} to {values['to']}: the ball sits on the rim, "
            f"{abs(values['place_deg']):.0f}° from the cup's uppermost point; medial-lateral separation up to "
            f"{values['medial_lateral_mm']:.2g} mm, centres up to {values['centre_distance_mm']:.2g} mm apart; Ali et "
            f"al. measured {measured} medial-lateral (36 mm, cup at {' and '.join(MEASURED_SEPARATIONS)}, 4 mm "
            "mismatch): without inertia and friction the model separates further; wear by the contact with the rim is "
            "not included"
        )


MEASURED_SEPARATIONS: Mapping[str, tuple[float, float]] = MappingProxyType({"45°": (0.9, 0.2), "65°": (2.1, 0.5)})
"""Measured medial-lateral separation in mm with its interval, by the inclination of the cup.

Source: Ali et al., Bone Joint J Orthop Proc, abstract; 36 mm and a mismatch of 4 mm.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringLoadedBall:
    """Model of a rigid ball that a spring pulls over the edge of a rigid rim without friction.

    The load points from the ball's centre to the edge that it rests on: c = R2 r - R1 f. The spring force decreases
    with the displacement of the ball.
    """

    spring: Spring  # lateral spring
    side: Numbers  # (3,), unit vector to the spring's right, in the cup's frame
    reach: float  # polar angle of the end of the bore in rad
    # radii in mm
    socket_radius: float
    ball_radius: float

    @cached_property
    def _spring_force_direction(self) -> Numbers:
        """Direction of the spring force on an undisplaced ball, a unit vector: (3,)."""
        return numpy.sign(self.spring.mismatch) * self.side

    def leaves_bore(self, forces: Numbers) -> Numbers:
        """Check if the ball leaves the bore, for each force (n, 3) in N that points beyond the rim.

        The ball stays in the bore if its displacement within the clearance reduces the spring force enough.
        """
        undisplaced = numpy.zeros(len(forces))
        leaves: Numbers = self._ball_centre_on_rim(forces, undisplaced) @ self._spring_force_direction <= undisplaced
        return leaves

    def solve_separation(self, forces: Numbers, steps: Numbers) -> Microseparation:
        """Solve for the ball on the rim under each force (n, 3) in N, which includes the undisplaced spring."""
        mismatch = abs(self.spring.mismatch)
        low, high = numpy.zeros(len(forces)), numpy.full(len(forces), mismatch)
        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            is_beyond = self._ball_centre_on_rim(forces, middle) @ self._spring_force_direction > middle
            low, high = numpy.where(is_beyond, low, middle), numpy.where(is_beyond, middle, high)
        ball_centre = self._ball_centre_on_rim(forces, high)
        is_balanced = abs(ball_centre @ self._spring_force_direction - high) <= _BALANCE_TOLERANCE * mismatch
        loads = self._loads_after_displacement(forces, high)
        return Microseparation(
            steps=steps,
            displacement=numpy.where(is_balanced[:, None], ball_centre, numpy.nan),
            side=self.side,
            azimuth=numpy.arctan2(loads[:, 1], loads[:, 0]),
        )

    def _loads_after_displacement(self, forces: Numbers, displacement: Numbers) -> Numbers:
        """Compute the loads (n, 3) in N: forces minus the spring force at displacements (n,) in mm."""
        return forces - self.spring.stiffness * displacement[:, None] * self._spring_force_direction

    def _ball_centre_on_rim(self, forces: Numbers, displacement: Numbers) -> Numbers:
        """Compute the position (n, 3) in mm of the ball's centre on the rim, after a displacement in mm."""
        loads = self._loads_after_displacement(forces, displacement)
        load_direction = loads / numpy.linalg.norm(loads, axis=1)[:, None]
        radial_direction = loads[:, :2] / numpy.linalg.norm(loads[:, :2], axis=1)[:, None]
        edge_direction = numpy.column_stack(
            [sin(self.reach) * radial_direction, numpy.full(len(loads), cos(self.reach))]
        )
        return self.socket_radius * edge_direction - self.ball_radius * load_direction
