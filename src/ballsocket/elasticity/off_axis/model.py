"""Contact of a ball at any position in a real cup, by full elasticity: tilted loads, edge loading, worn bores."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, inf, pi, radians
from typing import TYPE_CHECKING, Any, ClassVar

import numpy

from ...contact import Contact, Model
from ...contact.assembly import SolverResult
from ...contact.law import ForceLaw
from ...contact.model import bonded_liner
from ...contact.per_joint import JointContacts, solve_per_joint
from ...contact.verdict import EDGE_DISTANCE
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
from ...core.validity import SMALL_STRAIN, Range, Remark, Status, largest_poisson
from ...problem import Joint
from ...problem.cup import UP, Cup
from ...problem.gaps import GapKind, check_gap, gap_remarks, gap_validity, select_gap
from .bore_shapes import BoreShape
from .contact import OffAxisContact
from .directions import check_direction, cup_frames, tilted_directions
from .surfaces import ClosedShell, RealCup, Springs, Surface

if TYPE_CHECKING:
    from .bore_contact import BoreContact

KEPT = ("fields", "summary")  # allowed values of `keep` of a `Sphere`
_MIN_RING_WIDTH, MAX_RING_WIDTH = radians(0.5), radians(6.0)


@dataclass(frozen=True, kw_only=True)
class Sphere(Model):
    """Contact by full elasticity for any direction of the load in a real cup.

    Linear elasticity and small displacements without friction, as in `Exact` and `FiniteElement`, but loads may be
    tilted from the cup's axis. Rings about the cup's axis and meridians divide the bore into cells. The compliance
    between rings is known for every harmonic about the axis, so that a press takes milliseconds.

    Parameters
    ----------
    cup : Cup
        Arc of cover, chamfer, interface and orientation. A hemisphere that opens downwards by default.
    surface : RealCup, ClosedShell or Springs
        Compliance of the bore: the real cup (default), a closed shell, or springs.
    ring_width : float
        Width of the rings in rad, 0.5° to 6°; 2° by default. The error of forces is about 0.1 % at 2° and 0.03 % at 1°,
        for contacts that span at least ten rings; `contact.error` estimates it for each contact.
    gap : type, optional
        `LinearGap` or `CircularGap`. By default it is linear up to c/R2 0.01, and circular beyond.
    worn : object with a method `depth`, optional
        Depth in mm of the bore below its sphere, by direction: see `BoreDeviation`.
    direction : array (..., 3), optional
        Direction of the load in the body's frame, of any length; upwards by default. `press` accepts it, too.
    keep : str
        "fields" (default) keeps the pressure field of each contact, 70 kB a load in rings of 2°. "summary" keeps
        numbers alone: those of `summary()`, and no profile, map or outline. `press` accepts it, too.

    Raises
    ------
    ValueError
        A number outside its allowed range, reported with its value.
    TypeError
        A cup, surface or gap of another type.
    ImportError
        In `press`: the extra `fem` is not installed.

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
    gap: GapKind | None = None
    worn: BoreShape | None = None
    direction: Any = UP
    keep: str = "fields"

    name: ClassVar[str] = "sphere"
    title: ClassVar[str] = "full elasticity in rings about the cup's axis, any direction of load"
    sources: ClassVar[tuple[Source, ...]] = (Source("polonsky1999"),)
    contact_type: ClassVar[type[Contact]] = OffAxisContact
    off_axis: ClassVar[bool] = True
    further_quantities: ClassVar[tuple[str, ...]] = (EDGE_DISTANCE,)
    differentiable: ClassVar[bool] = False
    smooth_step: ClassVar[float] = 3e-3
    seconds_a_press: ClassVar[float] = 0.03
    fits: ClassVar[tuple[Range, ...]] = ()
    reach: ClassVar[str] = "forces along directions in which the bore holds the ball, contacts no wider than the bore"

    def __post_init__(self) -> None:
        for name, types in {"cup": (Cup,), "surface": (RealCup, ClosedShell, Springs)}.items():
            if not isinstance(getattr(self, name), types):
                allowed = " or ".join(kind.__name__ for kind in types)
                raise TypeError(f"{name} must be {allowed}, got {getattr(self, name)!r}")
        check_gap(self.gap)
        width = check_number("ring_width", self.ring_width)
        in_range = _MIN_RING_WIDTH <= width <= MAX_RING_WIDTH
        require("ring_width", width, in_range, "a ring is 0.5 to 6 degrees wide, 0.00873 to 0.105 radians")
        if self.worn is not None and (isinstance(self.worn, type) or not hasattr(self.worn, "depth")):
            raise TypeError(f"worn must have a method depth(directions), got {shown(self.worn)}")
        object.__setattr__(self, "direction", check_direction(self.direction))
        if self.keep not in KEPT:
            raise ValueError(f"keep must be {' or '.join(map(repr, KEPT))}, got {shown(self.keep)}")

    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity=largest_poisson,
            symbol="ν",
            low=-1.0,
            high=0.49995,
            why="an incompressible body has no bulk modulus",
        ),
        Range(quantity="joint.thickness_ratio", high=250.0, why="a thinner liner is not meshed in rings"),
    )

    @property
    def validity(self) -> tuple[Range, ...]:
        """Ranges of the contact in which the model is accurate."""
        narrow = Range(
            quantity=lambda contact: contact.half_angle / self.ring_width,
            symbol="ε over a ring's width",
            low=5.0,
            why="the contact spans few rings: reduce ring_width, or use exact far from the rim",
        )
        held = Range(
            quantity=lambda contact: arrays.where(
                contact.joint.clearance < 0, self.cup.arc_of_cover / pi, inf + 0.0 * contact.joint.clearance
            ),
            symbol="arc of cover over 180°",
            low=1.0 + 1e-9,
            why="a half socket does not hold a preloaded ball: set arc_of_cover above 180 deg",
        )
        bonded = bonded_liner(self.cup) if isinstance(self.surface, ClosedShell) else ()
        return (*gap_validity(self.gap), SMALL_STRAIN, narrow, held, *bonded)

    @property
    def remarks(self) -> tuple[Range, ...]:
        """Remarks on the gap, and on an inclination that looks like radians, below 1.6° but not 0."""
        small_inclination = Remark(
            quantity=lambda _: abs(self.cup.inclination) or inf,
            symbol="inclination",
            low=radians(pi / 2),
            why=f"the cup's inclination or tilt is {degrees(self.cup.inclination):.3g}°, as if radians were given as "
            f"degrees: {degrees(self.cup.inclination):.3g} rad are {degrees(degrees(self.cup.inclination)):.3g}°",
        )
        return (*gap_remarks(self.gap), small_inclination)

    @property
    def parameters(self) -> tuple[Array, ...]:
        """Components of the load's direction, which broadcast against joint and load."""
        components = (self.direction[..., axis] for axis in range(3))
        return tuple(float(component) if component.ndim == 0 else component for component in components)

    def _law(self, joint: Joint) -> ForceLaw:
        """Raise TypeError: a contact off the axis has no closed force law."""
        raise TypeError("sphere has no force law: its rings are too coarse near first touch; use exact")

    def in_cup(self, cup: Cup, **aim: Any) -> Sphere:
        """Return a copy of the model with another cup and direction of the load; a tilt tilts the cup as well."""
        tilted = cup.tilted(min(aim["tilt"], pi / 2)) if "tilt" in aim else cup
        return replace(self, cup=tilted).with_direction(**aim)

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
        keep: str | None = None,
    ) -> Contact:
        """Press the ball into the cup by one of three loads, along a direction.

        Parameters
        ----------
        joint : Joint
        force : float or array, optional
            Magnitude of the load in N. The ball moves to its equilibrium; near the rim it does not move along the load.
        indentation : float or array, optional
            Displacement in mm of the ball's centre along the direction, beyond the clearance. The force may have
            another direction.
        half_angle : float or array, optional
            Half angle in rad of a round contact of the same area.
        displacement : array (..., 3), optional
            Displacement of the ball's centre from the centre of the bore in mm, in the body's frame. It replaces an
            indentation and a direction.
        direction : array (..., 3), optional
            Direction in the body's frame, upwards by default. Its leading axes broadcast against joint and load.
        tilt : float or array, optional
            Angle of the direction from the cup's axis in rad, from the dome to the rim. It replaces a direction.
        azimuth : float or array, optional
            Angle of a tilted load about the cup's axis in rad. It starts at the cup's x, the azimuth of a tilt alone.
        inclination, anteversion : float or array, optional
            Other orientations of the cup in rad. They broadcast against the load.
        keep : str, optional
            "fields" or "summary", in place of the model's.

        Returns
        -------
        OffAxisContact

        Raises
        ------
        ValueError
            Not exactly one load; both a direction and a tilt; a number outside its allowed range; more contacts than
            fit into the available memory.
        TypeError
            Another type in place of a joint; a load without its keyword.
        """
        from .load_cases import check_contact_memory  # slow to import

        reject_unnamed_loads(unnamed)
        model = self if keep in (None, self.keep) else replace(self, keep=keep)
        load = {"force": force, "indentation": indentation, "half_angle": half_angle}
        numbers, vectors = (*load.values(), tilt, azimuth, inclination, anteversion), (displacement, direction)
        shapes = [numpy.shape(number) for number in numbers if number is not None]
        check_contact_memory(*shapes, *(numpy.shape(vector)[:-1] for vector in vectors if vector is not None))
        if displacement is None:
            model = model.with_direction(direction, tilt, azimuth)
            if inclination is not None or anteversion is not None:
                model = model.with_orientation(inclination, anteversion)
            return Model.press(model, joint, **load)
        select_load(**load, displacement=displacement)
        if any(given is not None for given in (direction, tilt, azimuth, inclination, anteversion)):
            raise ValueError(
                "a displacement includes its direction: leave direction, tilt and azimuth out, and give inclination "
                "and anteversion in the cup of the model"
            )
        vector = arrays.to_numpy(check_vectors("displacement", displacement, "x, y, z (mm)")).astype(float)
        require("displacement", vector, numpy.isfinite(vector), "a displacement (mm) is finite")
        length = numpy.linalg.norm(vector, axis=-1)
        depth = numpy.maximum(length - arrays.to_numpy(joint.clearance), 0.0)  # within the clearance no contact
        along = numpy.where(length[..., None] > 0, vector, numpy.array(self.cup.dome))
        return Model.press(
            replace(model, direction=along), joint, indentation=float(depth) if depth.ndim == 0 else depth
        )

    def with_direction(
        self, direction: Array | None = None, tilt: Array | None = None, azimuth: Array | None = None
    ) -> Sphere:
        """Return this model with another direction of the load; see `press` for the arguments."""
        if direction is not None and tilt is not None:
            raise ValueError("give either a direction or a tilt, not both")
        if azimuth is not None and tilt is None:
            raise ValueError("an azimuth needs a tilt: it rotates a tilted load about the cup's axis")
        if tilt is not None:
            return replace(self, direction=tilted_directions(tilt, azimuth) @ numpy.array(self.cup.frame))
        return self if direction is None else replace(self, direction=direction)

    def with_orientation(self, inclination: Array | None = None, anteversion: Array | None = None) -> Sphere:
        """Return a copy of the model with the load direction that a cup at other orientations (rad) has.

        Arrays of orientations are many cups. The cups are equal in their own frames, so their orientations are
        directions of the load on one cup.
        """
        in_cup = numpy.einsum("...ij,...j->...i", cup_frames(self.cup, inclination, anteversion), self.direction)
        return replace(self, direction=in_cup @ numpy.array(self.cup.frame))

    def reach_of(self, joint: Joint) -> Array:
        """Compute the polar angle of the end of the bore in rad, from the pole of the dome."""
        return self.cup.rim - self.cup.chamfer / joint.socket_radius

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        needs("fem", "skfem", "scipy")
        in_cup = self.direction @ numpy.array(self.cup.frame).T
        in_cup = in_cup / numpy.linalg.norm(in_cup, axis=-1, keepdims=True)
        components = [in_cup[..., axis] for axis in range(3)]

        def solve(single: Joint, loads: Numbers, *axis: Numbers) -> JointContacts:
            from .contact_states import estimate_errors  # slow to import
            from .load_cases import KEEP_FUNCTIONS, LOAD_SOLVERS

            touching = loads > (0 if single.clearance >= 0 else -1)  # a preloaded joint touches without a load
            bore, axes = self.bore_contact(single), numpy.stack(axis, axis=-1)[touching]
            edges = self.surface.edges(single, self.cup, bore.compliance.grid)
            state = KEEP_FUNCTIONS[self.keep](LOAD_SOLVERS[kind], bore, loads[touching], axes, edges)
            errors = estimate_errors(state, kind)
            return JointContacts(load=loads, touching=touching, state=state, reached=state.reachable, error=errors)

        solution = solve_per_joint(self, joint, load, solve, *components)
        return SolverResult(
            laws=solution,
            force=solution.force,
            indentation=solution.indentation,
            failures={
                Status.DISLOCATED: solution.combine(lambda piece: piece.state.dislocated) == 1,
                Status.NOT_CONVERGED: solution.combine(lambda piece: piece.state.unconverged) == 1,
            },
        )

    def bore_contact(self, joint: Joint) -> BoreContact:
        """Return ball and bore of one joint: compliance and gap of every cell."""
        from .bore_contact import BoreContact, GapField  # slow to import
        from .compliance import cached_compliance

        compliance = cached_compliance(self.surface, joint, self.cup, self.ring_width)
        gap = GapField(
            grid=compliance.grid,
            clearance=float(joint.clearance),
            socket_radius=float(joint.socket_radius),
            depth=self.worn_depth(compliance.grid.centroids, float(joint.socket_radius)),
            kind=select_gap(self.gap, joint),
        )
        return BoreContact(compliance=compliance, gap=gap)

    def worn_depth(self, directions: Numbers, socket_radius: float) -> Numbers:
        """Evaluate the depth of the worn bore in mm at unit vectors (3, rings, meridians); 0 of an unworn bore.

        Raises ValueError: a worn bore of another radius than the socket's; depths of another shape, or that are not
        finite.
        """
        if self.worn is None:
            return numpy.zeros(directions.shape[1:])
        radius = float(getattr(self.worn, "radius", socket_radius))
        similar = abs(radius - socket_radius) < socket_radius / 2
        require("radius of the worn bore", radius, similar, f"the socket's is {socket_radius:.4g} mm; a scan is in mm")
        depth = arrays.to_numpy(check_numeric("worn depth", self.worn.depth(directions)))
        if depth.shape not in ((), directions.shape[1:]):
            raise ValueError(f"worn depth of shape {depth.shape} is not allowed: give one depth (mm) per direction")
        require("worn depth", depth, numpy.isfinite(depth), "a depth (mm) is finite")
        return numpy.broadcast_to(depth, directions.shape[1:])


def check_sphere(model: Any) -> Sphere:
    """Return the model if it is a `Sphere`, and raise TypeError otherwise."""
    if not isinstance(model, Sphere):
        raise TypeError(f"model must be Sphere, got {shown(model)}")
    return model
