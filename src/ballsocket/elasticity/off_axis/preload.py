"""Preloaded joints, and the force that draws a ball out of a socket beyond whose equator it sits."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, inf, nan, pi, sin
from typing import TYPE_CHECKING

import numpy

from ...contact.assembly import check_joint
from ...contact.roots import bisect
from ...contact.strength import MAX_ELASTIC_UTILISATION
from ...core.arrays import Array, Numbers
from ...core.checks import check_number, require
from ...problem import Joint
from ...problem.gaps import CircularGap
from .directions import check_direction
from .model import Sphere, check_sphere

if TYPE_CHECKING:
    from .contact import OffAxisContact

_MAX_BISECTIONS = 40
_RELATIVE_TOLERANCE = 1e-4
_MAX_INTERFERENCES = 4.0  # displacement, as a multiple of the interference, at which a part of every contact is open


@dataclass(frozen=True, kw_only=True)
class Preload:
    """Preloaded joint: a ball with an interference in its socket, unloaded, displaced or worn.

    The joint is assembled. Pressing the ball in through the narrower opening is not modelled, nor is any permanent
    deformation from it.

    Parameters
    ----------
    model : Sphere
        Model with a cup that reaches beyond the equator, an arc of cover above π.
    joint : Joint
        Joint with an `interference`.

    Raises
    ------
    ValueError
        A joint with a clearance; a cup that ends before the equator.
    TypeError
        Another model; another type than a joint; an array of joints.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> joint = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    >>> fitted = bs.Preload(model=bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0))), joint=joint)
    >>> bool(fitted.equilibrium.max_pressure > 50.0)
    True
    """

    model: Sphere
    joint: Joint

    def __post_init__(self) -> None:
        check_sphere(self.model)
        check_joint(self.joint)
        interference = check_number("interference", self.joint.interference)
        require("interference", interference, interference > 0, "a preloaded joint has an interference above 0")
        arc = self.model.cup.arc_of_cover
        require("arc_of_cover", arc, arc > pi, "a preloaded socket reaches beyond the equator, above 180 deg (pi)")

    @cached_property
    def equilibrium(self) -> OffAxisContact:
        """Contact of the ball in equilibrium without a load."""
        return self.model.press(self.joint, force=0.0)  # type: ignore[return-value]

    def displace(self, displacement: Array) -> OffAxisContact:
        """Solve the contacts of the ball at displacements from the centre of the bore.

        Parameters
        ----------
        displacement : array (..., 3)
            Displacements of the ball's centre in mm, in the body's frame.
        """
        return self.model.press(self.joint, displacement=displacement)  # type: ignore[return-value]

    def separation_displacement(self, direction: Array) -> float:
        """Compute the displacement in mm from equilibrium at which the ball first loses contact in any cell.

        It is 0 where the opening pushes the ball off its dome: a part of the bore is then open in equilibrium. The
        joint is still preloaded, see `wear_depth_to_loosen`.

        Parameters
        ----------
        direction : array (3,)
            Direction in the body's frame, of any length.

        Raises
        ------
        ValueError
            More than one direction; a direction of length 0.
        """
        vector = check_direction(direction)
        if vector.shape != (3,):
            raise ValueError(f"direction of shape {vector.shape} is not allowed: give one direction x, y, z")
        start = self.equilibrium.displacement @ numpy.array(self.model.cup.frame)

        def is_closed(distance: float) -> bool:
            contact = self.displace(start + distance * vector / numpy.linalg.norm(vector))
            return bool((contact.pressure_map[2] > 0).all())

        if not is_closed(0.0):
            return 0.0
        farthest = _MAX_INTERFERENCES * float(self.joint.interference)
        return bisect(0.0, farthest, is_closed, _MAX_BISECTIONS, _RELATIVE_TOLERANCE)

    def wear_depth_to_loosen(self) -> float:
        """Compute the uniform wear of the bore in mm at which the ball loses its preload.

        Pressure and friction torque of the unloaded ball vanish at this depth, and the ball has play beyond it. That
        is geometry: the smallest depth t at which the ball fits freely at some displacement e, with overlaps
        e·n - c - w(n) - t ≤ 0 in all cells. In a bore without `worn` it is the interference, for every arc of cover,
        load and mesh. Wear adds to the depth w of `worn`, and t is 0 where the ball is already free.
        """
        from scipy.optimize import linprog  # slow to import

        gap = self.model.bore_contact(self.joint).gap
        normals = gap.grid.normals.reshape(3, -1).T
        fitted = linprog(
            [0.0, 0.0, 0.0, 1.0],
            A_ub=numpy.column_stack([normals, -numpy.ones(len(normals))]),
            b_ub=-gap.overlap(numpy.zeros((1, 3))).ravel(),
            bounds=[(None, None)] * 3 + [(0.0, None)],
        )
        return float(fitted.x[3])


MAX_RIM_STRAIN = 0.1
"""Largest compression of the liner at its rim over its thickness, up to which a pull-out force is reported."""

_PULL_OUT_STEPS = 25  # number of displacements of the ball on its way out

PULL_OUT_LIMITS = (
    "pull-out: quasi-static, along the cup's axis; linear elasticity of the liner on its backing, without yield or "
    "fracture; a housing that widens as a ring makes the force smaller"
)
"""Note on the limits of every pull-out force."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PullOut:
    """Force that draws a ball out of its socket along the cup's axis.

    Attributes
    ----------
    force : float
        Largest force in N; NaN if it cannot be computed, see `notes`.
    displacement : float
        Displacement of the ball's centre in mm, out of the socket, at the largest force.
    strain : float
        Largest compression of the liner as a fraction of its thickness, at the largest force.
    utilisation : float or None
        Largest von Mises stress over the yield stress at the largest force; None without a yield stress.
    displacements, forces : array (steps,)
        Displacements in mm and forces in N from equilibrium until the ball is out.
    notes : tuple of str
        Limits of the result.
    """

    force: float
    displacement: float
    strain: float
    utilisation: float | None
    displacements: Numbers
    forces: Numbers
    notes: tuple[str, ...]

    @property
    def valid(self) -> bool:
        """True if the largest force was computed, and the liner stays elastic."""
        elastic = self.utilisation is None or self.utilisation <= MAX_ELASTIC_UTILISATION
        return bool(self.force >= 0.0) and elastic

    def summary(self) -> dict[str, object]:
        """Return the result as a dictionary for JSON, in N and mm; the force is None if it is not computed."""
        computed = self.force >= 0.0
        return {
            "force": self.force if computed else None,
            "displacement": self.displacement,
            "strain": self.strain,
            "utilisation": self.utilisation,
            "valid": self.valid,
            "notes": list(self.notes),
        }


def pull_out(model: Sphere, joint: Joint, friction: float = 0.0) -> PullOut:
    """Compute the largest force that draws a ball out of a socket which reaches beyond its equator.

    The model solves the pressure for the exact circle of the ball at displacements out of the socket. The force is the
    sum of the pressures along the normals of the displaced ball, with Coulomb friction against the motion. It grows
    with the compression of the rim, and falls as the widest section of the ball approaches the rim.

    Parameters
    ----------
    model : Sphere
        Model with a cup whose arc of cover is above π.
    joint : Joint
        Joint with a clearance or an interference.
    friction : float
        Coefficient of friction, 0 by default.

    Raises
    ------
    ValueError
        A cup that ends before the equator; a negative coefficient.
    TypeError
        Another model; another type than a joint; an array of joints.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> joint = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
    >>> pulled = bs.pull_out(bs.Sphere(cup=bs.Cup(arc_of_cover=radians(200.0)), ring_width=radians(4.0)), joint)
    >>> f"{pulled.force / 1e3:.1f} kN at {pulled.displacement:.1f} mm"
    '1.4 kN at 0.6 mm'
    """
    check_sphere(model)
    check_joint(joint)
    coefficient = check_number("friction", friction)
    require("friction", coefficient, 0.0 <= coefficient < inf, "a coefficient of friction is 0 or more and finite")
    reach, socket_radius = float(model.reach_of(joint)), float(joint.socket_radius)
    if reach <= pi / 2:
        angle = 2 * numpy.degrees(reach)
        raise ValueError(f"a socket of {angle:.4g} deg does not hold its ball: arc_of_cover must be above 180 deg")
    circular = replace(model, gap=CircularGap)
    start = (1.0 + 1e-6) * float(joint.clearance)  # a ball with a clearance touches beyond it
    if start <= 0.0:
        start = -float(circular.press(joint, force=0.0).displacement[2])  # type: ignore[attr-defined]
    displacements = numpy.linspace(start, -socket_radius * cos(reach), _PULL_OUT_STEPS)
    contact = _contact_outwards(circular, joint, displacements)
    forces = _pulling_forces(contact, displacements, coefficient)
    best = int(forces.argmax())
    finer = numpy.linspace(displacements[max(best - 1, 0)], displacements[min(best + 1, len(displacements) - 1)], 9)
    contact = _contact_outwards(circular, joint, finer)
    fine_forces = _pulling_forces(contact, finer, coefficient)
    best = int(fine_forces.argmax())
    displacement = float(finer[best])
    opening = float(joint.ball_radius**2 - (displacement + socket_radius * cos(reach)) ** 2) ** 0.5
    compression = max(opening - socket_radius * sin(reach), 0.0)
    strain = compression / float(min(joint.liner_thickness, joint.socket_radius))
    utilisation = None
    if joint.liner.yield_stress is not None:
        # by the largest pressure of the cells: the fit of `max_pressure` does not apply to a narrow band at the rim
        ((_, contacts),) = contact.laws.pieces
        largest, fitted = float(contacts.state.equilibrium.pressure[best].max()), float(contact.max_pressure[best])
        utilisation = float(contact.utilisation[best]) * largest / fitted if fitted > 0.0 else 0.0
    return PullOut(
        force=max(float(fine_forces[best]), 0.0) if strain <= MAX_RIM_STRAIN else nan,
        displacement=displacement,
        strain=strain,
        utilisation=utilisation,
        displacements=displacements,
        forces=forces,
        notes=tuple(_pull_out_notes(strain, utilisation)),
    )


def _contact_outwards(model: Sphere, joint: Joint, displacements: Numbers) -> OffAxisContact:
    opening = numpy.array(model.cup.opening)
    return model.press(joint, displacement=displacements[:, None] * opening)  # type: ignore[return-value]


def _pulling_forces(contact: OffAxisContact, displacements: Numbers, friction: float) -> Numbers:
    """Sum pressures and friction along the opening of the cup: forces (steps,) in N that pull the ball."""
    radius = float(contact.joint.socket_radius)
    ((_, contacts),) = contact.laws.pieces
    grid, pressure = contacts.state.bore.compliance.grid, contacts.state.equilibrium.pressure
    outward = -radius * grid.centroids[2] - displacements[:, None, None]
    across = radius * numpy.hypot(grid.centroids[0], grid.centroids[1])
    normal = (outward + friction * across) / numpy.hypot(outward, across)
    return radius**2 * (pressure * grid.areas * normal).sum(axis=(1, 2))


def _pull_out_notes(strain: float, utilisation: float | None) -> Iterator[str]:
    """Yield the notes on a pull-out force: its limits, and the reason why it is not computed or not elastic."""
    if strain > MAX_RIM_STRAIN:
        yield (
            f"pull-out: not computed, the rim would compress the liner by {100 * strain:.0f} % of its thickness; "
            f"linear elasticity is limited to {100 * MAX_RIM_STRAIN:.0f} %"
        )
        return
    if utilisation is not None and utilisation > MAX_ELASTIC_UTILISATION:
        yield (
            f"pull-out: an upper bound, von Mises stress {utilisation:.2g} times the yield stress of the liner "
            f"on the way out; results are valid up to {MAX_ELASTIC_UTILISATION:g} times this stress"
        )
    yield PULL_OUT_LIMITS
