"""Loads and rotations of a cycle in the frame of a cup."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees, pi

import numpy

from ..core.arrays import Numbers
from ..core.display import counted
from ..core.records import cached_array
from ..problem import Joint
from ..problem.cup import Cup, Side
from .cycle import Cycle, Frame
from .kinematics import sliding_distance
from .microseparation import Microseparation, SpringLoadedBall
from .mix import Mix

ANGLES = ("inclination", "anteversion", "tilt")
"""Names of the angles that orient a cup, in rad; summaries and tables show them in degrees."""

_MIN_RELATIVE_FORCE = 1e-6  # force below which the ball counts as unloaded, relative to the largest force


_REVERSED_NOTE = "; if the force acts on the other body, socket or ball, state this by force_on in [cycle]"
"""Advice for a load that points out of the cup."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CupFrame:
    """Loads and rotations of a cycle in the frame of a cup.

    The axis x points upwards along the rim's plane, z to the dome's pole.

    Raises ValueError: a load that pushes the ball over the rim, unless a spring balances the load there.
    """

    joint: Joint  # joint of single numbers
    cycle: Cycle | Mix  # loads and rotations in the body's frame, for the right side of the body
    # arc of cover and orientation. A cup without a given orientation takes the tilt of the cycle's standard.
    cup: Cup = Cup()  # noqa: RUF009 (frozen)

    def __post_init__(self) -> None:
        dislocated = self._instants_beyond_rim
        if self.separation is not None:
            dislocated = dislocated[numpy.isnan(self.separation.displacement[:, 0])]
        if len(dislocated):
            first_dislocated = dislocated[0]
            reversed_load = pi - self._force_angles[first_dislocated] < self.reach
            raise ValueError(
                f"dislocated at {self.cycle.describe_step(first_dislocated)}: the load of "
                f"{numpy.linalg.norm(self.forces[first_dislocated]):.0f} N points "
                f"{degrees(self._force_angles[first_dislocated]):.1f}° from the dome's pole, and the bore ends at "
                f"{degrees(self.reach):.1f}°{_REVERSED_NOTE if reversed_load else ''}"
            )

    @cached_property
    def side_cycle(self) -> Cycle | Mix:
        """Cycle for the cup's side of the body: the given cycle, mirrored for a left cup."""
        return self.cycle.mirrored() if self.cup.side is Side.LEFT else self.cycle

    @cached_array
    def forces(self) -> Numbers:
        """Forces of the ball on the socket in N at all instants, in the cup's frame: (instants, 3)."""
        forces = self.side_cycle.forces
        return forces if self.cycle.frame is Frame.CUP else _convert_to_cup_frame(self.placed, forces)

    @property
    def _force_angles(self) -> Numbers:
        """Angles in rad between the forces and the dome's pole: (instants,)."""
        return numpy.arctan2(numpy.hypot(self.forces[:, 0], self.forces[:, 1]), self.forces[:, 2])

    @cached_array
    def _load_mask(self) -> Numbers:
        magnitudes = self.cycle.force_magnitudes
        return numpy.asarray(magnitudes > _MIN_RELATIVE_FORCE * max(float(magnitudes.max()), 1e-300))

    @cached_property
    def _spring_loaded_ball(self) -> SpringLoadedBall | None:
        spring, joint = self.side_cycle.spring, self.joint
        radii = {"socket_radius": float(joint.socket_radius), "ball_radius": float(joint.ball_radius)}
        return (
            None
            if spring is None
            else SpringLoadedBall(spring=spring, side=self._spring_axis, reach=self.reach, **radii)
        )

    @property
    def _spring_axis(self) -> Numbers:
        """Direction of the spring force in the cup's frame, the first axis of the cycle's frame: (3,)."""
        return numpy.array([1.0, 0.0, 0.0] if self.cycle.frame is Frame.CUP else numpy.array(self.placed.frame)[:, 0])

    @cached_array
    def lateral_stiffness(self) -> Numbers:
        """Stiffness matrix of the cycle's lateral spring in N/mm: (3, 3), zero without a spring.

        A displacement of the ball times this matrix is the decrease of the force on the socket.
        """
        spring = self.side_cycle.spring
        return numpy.outer(self._spring_axis, self._spring_axis) * (0.0 if spring is None else spring.stiffness)

    def socket_forces(self, displacement: Numbers) -> Numbers:
        """Compute the forces on the socket in N for displacements (loaded, 3) of the ball in mm."""
        return self.loads - displacement @ self.lateral_stiffness

    @cached_array
    def _instants_beyond_rim(self) -> Numbers:
        """Indices of the instants in which the load points beyond the rim."""
        beyond_rim = numpy.flatnonzero(self._load_mask & (self._force_angles >= self.reach))
        ball = self._spring_loaded_ball
        return beyond_rim if ball is None else beyond_rim[ball.leaves_bore(self.forces[beyond_rim])]

    @cached_property
    def separation(self) -> Microseparation | None:
        """Microseparation: instants in which a spring has pushed the ball onto the rim; None without any."""
        beyond_rim, ball = self._instants_beyond_rim, self._spring_loaded_ball
        if ball is None or not len(beyond_rim):
            return None
        return ball.solve_separation(self.forces[beyond_rim], beyond_rim)

    @cached_property
    def placed(self) -> Cup:
        """Cup with its orientation: the stated one, else the tilt by the cycle's standard."""
        tilt = self.cycle.cup_tilt
        return self.cup if self.cup.oriented or tilt is None else self.cup.tilted(tilt)

    @property
    def reach(self) -> float:
        """Polar angle in rad from the dome's pole to the end of the bore."""
        return float(self.cup.rim - self.cup.chamfer / self.joint.socket_radius)

    @cached_array
    def loaded(self) -> Numbers:
        """Indices of the instants in which the ball is pressed into the bore: (loaded,)."""
        mask = self._load_mask.copy()
        mask[self._instants_beyond_rim] = False
        return numpy.flatnonzero(mask)

    @cached_property
    def activities(self) -> tuple[tuple[str, Numbers], ...]:
        """Name of each activity with contact, and indices of its loads among the loaded instants."""
        loads = [
            (name, numpy.flatnonzero((self.loaded >= steps.start) & (self.loaded < steps.stop)))
            for name, steps in self.cycle.activity_slices
        ]
        return tuple((name, indices) for name, indices in loads if len(indices))

    @cached_array
    def loads(self) -> Numbers:
        """Forces in N at the loaded instants, in the cup's frame: (loaded, 3)."""
        return numpy.ascontiguousarray(self.forces[self.loaded])

    @property
    def largest_load_index(self) -> Numbers:
        """Index of the largest load among the loaded instants: (1,), or (0,) without loads."""
        magnitudes = numpy.linalg.norm(self.loads, axis=1)
        return numpy.flatnonzero(magnitudes == magnitudes.max(initial=0.0))[:1]

    @cached_array
    def rotation_increments(self) -> Numbers:
        """Rotation vectors of the ball in the loaded instants in rad, in the cup's frame: (loaded, 3)."""
        return _convert_to_cup_frame(self.placed, self.side_cycle.rotation_increments[self.loaded])

    @property
    def slide(self) -> float:
        """Sliding distance in mm in a cycle, at the point of the socket to which the load points."""
        magnitudes = self.cycle.force_magnitudes[:, None]
        directions = numpy.divide(self.forces, magnitudes, out=numpy.zeros_like(self.forces), where=magnitudes > 0)
        rotations = _convert_to_cup_frame(self.placed, self.side_cycle.rotation_increments)
        if len(self.loaded):  # an unloaded instant has the direction of the last loaded one before
            last_loaded = numpy.searchsorted(self.loaded, numpy.arange(len(directions)), side="right") - 1
            directions = directions[self.loaded[last_loaded]]
        return sliding_distance(float(self.joint.ball_radius), rotations, directions)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the orientation of the cup, unloaded instants and microseparation."""
        notes = []
        if self.placed != self.cup:
            tilt = degrees(self.cycle.cup_tilt or 0.0)
            notes.append(f"the cup is tilted by {tilt:g}° from the load, as the cycle's standard requires")
        unloaded, count = numpy.flatnonzero(~self._load_mask), self.cycle.n_steps
        if len(unloaded) == count:
            notes.append("no wear: the ball is never in contact during this cycle")
        elif len(unloaded):
            first, part = self.cycle.describe_step(int(unloaded[0])), f"{len(unloaded)} of {counted(count, 'instant')}"
            notes.append(f"the ball lifts off, first at {first}: {part} have no contact and no wear")
        if self.separation is not None:
            notes.append(self.separation.describe(self.cycle))
        return tuple(notes)


def _convert_to_cup_frame(cup: Cup, vectors: Numbers) -> Numbers:
    return numpy.ascontiguousarray(vectors @ numpy.array(cup.frame).T)
