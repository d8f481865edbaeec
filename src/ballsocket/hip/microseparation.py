"""Microseparation: a ball that a lateral spring pulls onto the rim of the cup."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, sin
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.kinds import MILLIMETRES
from ..core.unit_systems import Amount, Sentence
from .cycle import Cycle, Spring
from .mix import Mix

_BISECTIONS = 60
_BALANCE_TOLERANCE = 1e-6  # tolerance of the ball's displacement on its spring, as a share of the mismatch


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
        measured = [Amount(length, MILLIMETRES) for pair in MEASURED_SEPARATIONS.values() for length in pair]
        return Sentence(
            "microseparation from {} to {}: the ball sits on the rim, {} from the cup's uppermost point; "
            "medial-lateral separation up to {}, centres up to {} apart; Ali et al. measured {} ± {} and {} ± {} "
            "medial-lateral ({}, cup at {}, {} mismatch): without inertia and friction the model separates further; "
            "wear by the contact with the rim is not included",
            str(values["from"]),
            str(values["to"]),
            f"{abs(values['place_deg']):.0f}°",
            Amount(values["medial_lateral_mm"], MILLIMETRES, 2),
            Amount(values["centre_distance_mm"], MILLIMETRES, 2),
            *measured,
            Amount(36.0, MILLIMETRES),
            " and ".join(MEASURED_SEPARATIONS),
            Amount(4.0, MILLIMETRES),
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

        It stays if its displacement within the clearance reduces the spring force enough.
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
