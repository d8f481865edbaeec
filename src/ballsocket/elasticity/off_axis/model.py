"""The ball anywhere in a real cup, by full elasticity: tilted loads, edge loading, worn bores."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import radians
from typing import Any, ClassVar

import numpy

from ...contact import Contact, Model
from ...contact.assembly import SolverResult
from ...contact.law import ForceLaw
from ...contact.per_joint import JointContacts, solve_per_joint
from ...core import arrays
from ...core.arrays import Array, Numbers
from ...core.checks import (
    check_number,
    check_numeric,
    check_vectors,
    needs,
    reject_unnamed_loads,
    require,
    select_load,
    shown,
)
from ...core.sources import Source
from ...core.validity import CLOSE_FIT, SMALL_STRAIN, Range, Status
from ...problem import Joint
from ...problem.cup import UP, Cup
from ...problem.gaps import CircularGap, LinearGap, check_gap
from ..finite_elements.model import largest_poisson
from .contact import OffAxisContact
from .directions import checked_direction, frames_of, tilted
from .surfaces import ClosedShell, RealCup, Springs, Surface
from .worn import Shape

_FINEST, _WIDEST = radians(0.5), radians(6.0)


@dataclass(frozen=True, kw_only=True)
class Sphere(Model):
    """Contact on the sphere: any direction of load, in the cup as it is built.

    Linear elasticity and small displacements without friction, as in `Exact` and `FiniteElement`, but for loads that
    need not go along the cup's axis. The bore is cut into rings about the cup's axis and each ring by meridians; what
    rings do to each other is known for every harmonic about the axis, so that a press takes milliseconds.

    Parameters
    ----------
    cup : Cup
        Arc of cover, chamfer, interface, and where it faces. A hemisphere that opens downwards by default.
    surface : RealCup, ClosedShell or Springs
        How the bore gives way: as built (default), as a closed shell, or as springs.
    ring_width : float
        Of the rings in rad, 0.5° to 6°; 2° by default. At 2° forces are good to about 0.1 %, at 1° to 0.03 %, of
        contacts that span ten rings and more; `contact.error` says it of each.
    gap : type
        `LinearGap` (default) or `CircularGap`.
    worn : object with a method `depth`, optional
        What is missing of the bore, in mm, by direction: see `Worn`.
    direction : array (..., 3), optional
        Of the load, in the body's frame, of any length; upwards by default. `press` takes it, too.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    TypeError
        A cup, surface or gap of another type.
    ImportError
        At a press: the finite elements' extra is not installed.

    Examples
    --------
    >>> from math import radians
    >>> import ballsocket as bs
    >>> cup = bs.Cup(inclination=radians(45.0), anteversion=radians(15.0))
    >>> contact = bs.Sphere(cup=cup).press(bs.joints["hip-36"], force=3000.0, direction=(-0.26, 0.0, 0.97))
    >>> bool(contact.edge_loaded)
    False
    """

    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    surface: Surface = RealCup()  # noqa: RUF009 (frozen)
    ring_width: float = radians(2.0)
    gap: type[LinearGap] | type[CircularGap] = LinearGap
    worn: Shape | None = None
    direction: Any = UP

    name: ClassVar[str] = "sphere"
    title: ClassVar[str] = "full elasticity in rings about the cup's axis, any direction of load"
    sources: ClassVar[tuple[Source, ...]] = (Source("polonsky1999"),)
    contact_type: ClassVar[type[Contact]] = OffAxisContact
    off_axis: ClassVar[bool] = True
    differentiable: ClassVar[bool] = False
    smooth_step: ClassVar[float] = 3e-3
    seconds_a_press: ClassVar[float] = 0.03
    fits: ClassVar[tuple[Range, ...]] = ()
    reach: ClassVar[str] = "forces along directions in which the bore holds the ball, contacts no wider than the bore"

    def __post_init__(self) -> None:
        for name, kinds in {"cup": (Cup,), "surface": (RealCup, ClosedShell, Springs)}.items():
            if not isinstance(getattr(self, name), kinds):
                known = " or ".join(kind.__name__ for kind in kinds)
                raise TypeError(f"{name} must be {known}, got {getattr(self, name)!r}")
        check_gap(self.gap)
        width = check_number("ring_width", self.ring_width)
        good = _FINEST <= width <= _WIDEST
        require("ring_width", width, good, "a ring is 0.5 to 6 degrees wide, 0.00873 to 0.105 radians")
        if self.worn is not None and (isinstance(self.worn, type) or not hasattr(self.worn, "depth")):
            raise TypeError(f"worn must have a method depth(directions), got {shown(self.worn)}")
        object.__setattr__(self, "direction", checked_direction(self.direction))

    @property
    def domain(self) -> tuple[Range, ...]:
        incompressible = Range(
            quantity=largest_poisson,
            symbol="ν",
            low=-1.0,
            high=0.49995,
            why="an incompressible body has no bulk modulus",
        )
        thin = Range(quantity="joint.thickness_ratio", high=60.0, why="so thin a liner is not meshed in rings: ask fem")
        return (incompressible, thin)

    @property
    def validity(self) -> tuple[Range, ...]:
        narrow = Range(
            quantity=lambda contact: contact.half_angle / self.ring_width,
            symbol="ε over a ring's width",
            low=5.0,
            why="the contact spans few rings: make ring_width smaller, or ask exact where the rim is far",
        )
        return (SMALL_STRAIN, narrow, *((CLOSE_FIT,) if self.gap is LinearGap else ()))

    @property
    def parameters(self) -> tuple[Array, ...]:
        parts = (self.direction[..., axis] for axis in range(3))
        return tuple(float(part) if part.ndim == 0 else part for part in parts)

    def _law(self, joint: Joint) -> ForceLaw:
        raise TypeError("rings about the cup's axis are too coarse for a law from first touch on: ask exact")

    def in_cup(self, cup: Cup) -> Sphere:
        return replace(self, cup=cup)

    def press(
        self,
        joint: Joint,
        *unnamed: Any,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
        displacement: Array | None = None,
        direction: Array | None = None,
        tilt: Array | None = None,
        azimuth: Array | None = None,
        inclination: Array | None = None,
        anteversion: Array | None = None,
    ) -> Contact:
        """Press the ball into the cup by one of three loads, along a direction.

        Parameters
        ----------
        joint : Joint
        force : float or array, optional
            The size of the load in N. The ball comes to rest where the contact carries it, displaced along another
            direction where the rim is near.
        indentation : float or array, optional
            The ball's centre is displaced by clearance + indentation (mm) along the direction; the load then need not
            be parallel to it.
        half_angle : float or array, optional
            In rad, of a round contact of the same area.
        displacement : array (..., 3), optional
            Where the ball's centre sits, in mm from the centre of the bore, in the body's frame: in place of an
            indentation and a direction.
        direction : array (..., 3), optional
            In the body's frame, upwards by default; its leading axes broadcast against joint and load.
        tilt : float or array, optional
            In place of a direction its angle from the cup's axis in rad, from the dome to the rim.
        azimuth : float or array, optional
            Of a tilted load around the cup's axis in rad, from the cup's x, where the tilt alone leans to.
        inclination, anteversion : float or array, optional
            Other orientations of the cup, in rad: many of them under one load, or each under its own.

        Returns
        -------
        OffAxisContact

        Raises
        ------
        ValueError
            Not exactly one load; direction and tilt both; a number that is not allowed.
        TypeError
            What is no joint; a load without its name.
        """
        reject_unnamed_loads(unnamed)
        load = {"force": force, "indentation": indentation, "half_angle": half_angle}
        if inclination is not None or anteversion is not None:
            return self.along(direction, tilt, azimuth).facing(inclination, anteversion)._pressed(joint, **load)
        if displacement is None:
            return self.along(direction, tilt, azimuth)._pressed(joint, **load)
        select_load(**load, displacement=displacement)
        if direction is not None or tilt is not None or azimuth is not None:
            raise ValueError("a displacement has a direction of its own: neither direction nor tilt goes with it")
        return self._displaced(joint, displacement)

    def _displaced(self, joint: Joint, displacement: Array) -> Contact:
        """A displacement as how far it goes and where to; within the clearance nothing touches."""
        place = arrays.to_numpy(check_vectors("displacement", displacement, "x, y, z (mm)")).astype(float)
        require("displacement", place, numpy.isfinite(place), "a displacement (mm) is finite")
        length = numpy.linalg.norm(place, axis=-1)
        way = numpy.where(length[..., None] > 0, place, numpy.array(self.cup.dome))
        depth = numpy.maximum(length - arrays.to_numpy(joint.clearance), 0.0)
        return replace(self, direction=way)._pressed(joint, indentation=float(depth) if depth.ndim == 0 else depth)

    def _pressed(self, joint: Joint, **load: Array | None) -> Contact:
        return super().press(joint, **load)

    def along(self, direction: Array | None = None, tilt: Array | None = None, azimuth: Array | None = None) -> Sphere:
        """This model with another direction of load; see `press`."""
        if direction is not None and tilt is not None:
            raise ValueError("either a direction or a tilt is needed, got both")
        if azimuth is not None and tilt is None:
            raise ValueError("an azimuth turns a tilted load around the cup's axis: a tilt is needed besides")
        if tilt is not None:
            return replace(self, direction=tilted(tilt, azimuth) @ numpy.array(self.cup.frame))
        return self if direction is None else replace(self, direction=direction)

    def facing(self, inclination: Array | None = None, anteversion: Array | None = None) -> Sphere:
        """This model under the load that a cup of other orientations finds: arrays are as many cups.

        What they are made of is the same, and their own frames; so they are directions of load to one cup.
        """
        inside = numpy.einsum("...ij,...j->...i", frames_of(self.cup, inclination, anteversion), self.direction)
        return replace(self, direction=inside @ numpy.array(self.cup.frame))

    def reach_of(self, joint: Joint) -> Array:
        """Where the bore ends, in rad from the dome's pole."""
        return self.cup.rim - self.cup.chamfer / joint.socket_radius

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        needs("fem", "skfem", "scipy")
        inside = self.direction @ numpy.array(self.cup.frame).T
        inside = inside / numpy.linalg.norm(inside, axis=-1, keepdims=True)
        axes = [inside[..., axis] for axis in range(3)]
        solution = solve_per_joint(
            self, joint, load, lambda one, loads, *along: self._piece(one, kind, loads, along), *axes
        )
        return SolverResult(
            laws=solution,
            force=solution.force,
            indentation=solution.indentation,
            failures={
                Status.DISLOCATED: solution.spread(lambda piece: piece.state.lost) == 1,
                Status.NOT_CONVERGED: solution.spread(lambda piece: piece.state.unsettled) == 1,
            },
        )

    def _piece(self, joint: Joint, kind: str, loads: Numbers, along: tuple[Numbers, ...]) -> JointContacts:
        """Contacts of one joint of plain numbers."""
        from .compliance import compliance  # takes its time to import
        from .gap import Separation
        from .loads import LOADED
        from .search import Bed

        touching = loads > (0 if joint.clearance >= 0 else -1)  # a preloaded joint touches without a load
        soft = compliance(self.surface, joint, self.cup, self.ring_width)
        separation = Separation(
            grid=soft.grid,
            clearance=float(joint.clearance),
            socket_radius=float(joint.socket_radius),
            depth=self._depth(soft.grid.centroids, float(joint.socket_radius)),
            kind=self.gap,
        )
        axes = numpy.stack(along, axis=-1)[touching]
        edges = self.surface.edges(joint, self.cup, soft.grid)
        state = LOADED[kind](Bed(compliance=soft, separation=separation), loads[touching], axes, edges)
        return JointContacts(
            load=loads,
            touching=touching,
            state=state,
            reached=state.reached,
            error=state.errors(kind),
        )

    def _depth(self, directions: Numbers, socket_radius: float) -> Numbers:
        if self.worn is None:
            return numpy.zeros(directions.shape[1:])
        radius = float(getattr(self.worn, "radius", socket_radius))
        near = abs(radius - socket_radius) < socket_radius / 2
        require("radius of the worn bore", radius, near, f"the socket's is {socket_radius:.4g} mm; a scan is in mm")
        depth = arrays.to_numpy(check_numeric("worn depth", self.worn.depth(directions)))
        if depth.shape not in ((), directions.shape[1:]):
            raise ValueError(f"worn depth of shape {depth.shape} is not allowed: a depth (mm) for each direction")
        require("worn depth", depth, numpy.isfinite(depth), "a depth (mm) is finite")
        return numpy.broadcast_to(depth, directions.shape[1:])


def check_sphere(model: Any) -> Sphere:
    """The model, if it is contact on the sphere."""
    if not isinstance(model, Sphere):
        raise TypeError(f"model must be Sphere, got {shown(model)}")
    return model
