"""Contact by axisymmetric finite elements, as in the paper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial
from math import degrees, inf, isnan, nan, prod
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy

from ...contact import Contact, Model
from ...contact.assembly import SolverResult
from ...contact.law import ForceLaw
from ...contact.per_joint import JointContacts, SolvedContact, joint_at, solve_per_joint
from ...contact.roots import bisect
from ...contact.verdict import Bounded, exact_number
from ...core import arrays
from ...core.arrays import Array, Numbers, to_numpy
from ...core.checks import needs, require
from ...core.kinds import MEGAPASCALS
from ...core.quantities import PLASTIC, QUANTITIES, SHAKEDOWN_WORK, YIELD_LIMITS
from ...core.sources import Source
from ...core.stress import Peak
from ...core.unit_systems import Amount, Sentence
from ...core.validity import SMALL_STRAIN, OutsideDomainError, Range, Remark, Status, body_remarks, largest_poisson
from ...problem import Joint
from ...problem.cup import AXIAL_TILT, Cup
from ...problem.gaps import GapKind, check_gap, gap_remarks, gap_validity, select_gap
from ...problem.hardening import Hardening
from .spacing import SPACINGS, Adapted, Element, MeshSize, Spacing, Uniform, mesh_size

if TYPE_CHECKING:
    from .load_search import Solved
    from .plastic_curve import PlasticLoadCurve
    from .section import Section
    from .solver import MeshedLoadCurve


def _plastic_property(name: str) -> Any:
    """Make a property of contacts with a liner that may yield, of which the solver has one number per contact."""

    def read_quantity(self: MeshedContact) -> Array:
        if not self.model.plastic:
            return 0.0 * self.indentation
        return self._match_load(self.laws.combine(lambda contacts: getattr(contacts.state, name)))

    return _documented(read_quantity, name, "0 without yielding")


def _limit_property(name: str, *arguments: str) -> Any:
    """Make a property of contacts with a liner that may yield: a limit that the model finds for one joint.

    `arguments` are the quantities of a contact that the limit depends on.
    """

    def find_limit(self: MeshedContact) -> Array:
        if not self.model.plastic:
            return nan * self.indentation

        shape = self.laws.shape
        quantities = [numpy.broadcast_to(to_numpy(getattr(self, argument)), shape).ravel() for argument in arguments]
        limits = numpy.full(prod(shape), nan)
        for indices, contacts in self.laws.pieces:  # a load beyond the collapse has no result, but a limit
            find = lru_cache(partial(getattr(self.model, name), joint_at(self.joint, shape, int(indices[0]))))
            for index, load in zip(indices, contacts.load, strict=True):
                values = [float(quantity[index]) for quantity in quantities]
                if load > 0 and all(value > 0 for value in values):
                    limits[index] = find(*values)  # loads on one joint share a limit
        return self._match_load(arrays.convert_like(limits.reshape(shape), self.laws.like))

    return _documented(find_limit, name, "NaN without yielding or load")


def _documented(function: Callable[[MeshedContact], Array], name: str, otherwise: str) -> Any:
    """Make a cached property with the meaning of a quantity as its documentation."""
    quantity = QUANTITIES[name]
    function.__name__ = name
    function.__doc__ = f"{quantity.meaning} In {quantity.unit}; {otherwise}."
    return cached_property(function)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class MeshedContact(SolvedContact):
    """Contact with its mesh, displacements and stresses, available for a single load.

    Attributes
    ----------
    error : dict
        Relative error of each quantity by name at the applied load, estimated from two meshes; NaN with one mesh.
    """

    model: Any

    stress_error: ClassVar[float | None] = 4e-3

    @cached_property
    def section(self) -> Section:
        """Displacements and stresses in both bodies, by part, as in `section["liner"].stress.von_mises`.

        Raises
        ------
        ValueError
            More than one contact, or one without load or answer.
        """
        from .section import section

        return section(self._plain_joint, self.model.cup, self._solved)

    @property
    def quick_von_mises(self) -> Bounded:
        """Largest von Mises stress in the liner in MPa with its bounds; solved for near a rim or on a soft backing."""
        if self.model.plastic:
            return exact_number(self.von_mises).scaled(1.0, self.stress_error or 0.0)
        stress = super().quick_von_mises
        is_known = self.model.cup == Cup() and arrays.all_true(arrays.isfinite(stress.high) | self._failed)
        return stress if is_known else exact_number(self.von_mises).scaled(1.0, self.stress_error or 0.0)

    def _joint_von_mises(self, index: Numbers, contacts: JointContacts) -> Numbers:
        if self.model.plastic:
            return contacts.state.von_mises
        from .section import section

        joint, cup = joint_at(self.joint, self.laws.shape, int(index[0])), self.model.cup
        sections = (None if contact is None else section(joint, cup, contact) for contact in contacts.state.solved)
        return numpy.array([nan if part is None else part.peak_stress.von_mises for part in sections], dtype=float)

    @property
    def yields(self) -> bool:
        """True if the liner may yield."""
        return bool(self.model.plastic)

    permanent_set = _plastic_property("permanent_set")
    plastic_strain = _plastic_property("plastic_strain")
    plastic_fraction = _plastic_property("plastic_fraction")
    plastic_work = _plastic_property("plastic_work")
    repeated_work = _plastic_property("repeated_work")

    yield_load = _limit_property("yield_load")
    shakedown_load = _limit_property("shakedown_load")
    collapse_load = _limit_property("collapse_load")
    minimum_thickness = _limit_property("minimum_thickness", "force")

    @property
    def peak_stress(self) -> Peak:
        """Largest von Mises stress in the liner in MPa at the nodes of the mesh, with its depth and polar angle."""
        return self.section.peak_stress

    @property
    def rim_displacement(self) -> tuple[float, float]:
        """Displacement of the end of the bore in mm: away from the load axis, and up against the load."""
        return self.section.rim_displacement

    @property
    def mesh(self) -> MeshSize:
        """Size of the mesh of a single contact: elements and nodes of both bodies, element size at the contact."""
        pair = self._solved.pair
        return mesh_size(self._plain_joint, self.model.cup, pair.resolution, pair.ball_resolution)

    @property
    def _plain_joint(self) -> Joint:
        return self.joint.with_numbers([float(to_numpy(number).item()) for number in self.joint.numbers()])

    @property
    def _solved(self) -> Solved:
        """Solved contact on its meshes; ValueError if the load has no solution."""
        solved: Solved | None = self.single_state.solved[0]
        if solved is None:
            raise ValueError("displacements and stresses need a contact with a solution")
        return solved

    def summary(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON, with error estimates and the mesh size of a single contact."""
        single = self.laws.shape == () and not Status(self.status).failed and self.indentation > 0
        return {**super().summary(), **({"mesh": self.mesh.summary()} if single else {})}


_BODY_REMARKS = body_remarks("cut off at the plane of the socket's rim", "half a one on its equator")


_SMALL_PLASTIC_STRAIN = Range(
    quantity="plastic_strain",
    symbol="plastic strain",
    high=0.05,
    why="the elements have small strains",
)


def _hardening_modulus_ratio(contact: Any) -> Array:
    """Compute the ratio of the liner's modulus to that of its hardening; 1 if this is not known."""
    liner = contact.joint.liner
    measured = None if liner.hardening is None else liner.hardening.young
    return liner.young / measured if measured else 1.0 + 0.0 * liner.young


class _OtherModulus(Remark):
    """Liners with another Young's modulus than their hardening curve, by more than 5 %."""

    def note(self, contact: Any) -> str:
        """Note with both moduli."""
        liner = contact.joint.liner
        moduli = float(to_numpy(liner.young)[~to_numpy(self.holds(contact))].flat[0]), liner.hardening.young
        amounts = (Amount(young, MEGAPASCALS) for young in moduli)
        return Sentence(f"E {{}} of the liner is not E {{}} of its hardening curve: {self.why}", *amounts)


_OTHER_MODULUS = _OtherModulus(
    quantity=_hardening_modulus_ratio,
    low=0.95,
    high=1.05,
    why="strains under a stress differ from the measured ones",
)


_SHAKEDOWN = Remark(
    quantity="repeated_work", high=SHAKEDOWN_WORK, why="the liner ratchets: repeated loads add plastic work"
)


def _meanings_of_yield(contact: Any) -> Array:
    """Count the hardening curve and the yield stress, where a liner has both."""
    liner = contact.joint.liner
    return float(liner.hardening is not None) + float(liner.yield_stress is not None) + 0.0 * liner.young


_CURVE_COUNTS = Remark(
    quantity=_meanings_of_yield,
    high=1,
    why="the liner yields by its hardening curve; its yield stress counts for the utilisation only",
)


def _is_elastic(contact: Any) -> bool:
    return not contact.status.failed and contact.plastic_work == 0


_TOLERANCE = 1e-3  # relative, of loads and the thickness at a limit


@dataclass(frozen=True, kw_only=True)
class FiniteElement(Model):
    """Contact by axisymmetric finite elements, with a rim, a sliding liner or a compliant shell.

    Linear elasticity and small displacements, as in `Exact`; contact without friction and without penalty. The ball is
    the half that faces the socket, pushed by its equator, which stays plane. Each body is condensed once onto its
    contact surface, after which every load takes milliseconds. All arrays are converted to NumPy.

    Parameters
    ----------
    cup : Cup
        Arc of cover, chamfer, and interface of the liner to its backing. A hemisphere by default. The load is along the
        cup's own axis: inclination, anteversion and side have no effect.
    spacing, ball_spacing : Adapted or Uniform
        Element sizes of socket and ball; the meshes need not match. The default adapts to the contact, and the ball's
        default (None) is the socket's.
    element : Element
        BIQUADRATIC (default) or BILINEAR.
    meshes : int
        2 (default) solves on a coarser mesh too and gives `contact.error`; 1 gives an error of NaN.
    gap : type, optional
        `LinearGap` (Eq. 6 of Heß & Forsbach 2021) or `CircularGap` (Eq. 5). By default it is linear up to c/R2 0.01,
        and circular beyond.
    plastic : bool
        True lets the liner yield by the `hardening` of its material, or perfectly plastic at its yield stress. `press`
        then loads a new socket by each force or indentation, and `follow` one socket by all of them in turn.

    Raises
    ------
    ValueError
        A number outside its range; at a press, a joint that cannot be meshed, a mesh larger than the memory, or a
        yielding liner without hardening and yield stress.
    TypeError
        A cup, spacing, element or gap of another type; a press inside `jax.jit` or `jax.grad`.
    ImportError
        At a press: the finite elements' extra is not installed.

    References
    ----------
    The analysis is that of Heß & Forsbach (2021), doi 10.3390/app112311170. See the docs (finite elements).
    """

    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    spacing: Spacing = Adapted()  # noqa: RUF009 (frozen)
    ball_spacing: Spacing | None = None
    element: Element = Element.BIQUADRATIC
    meshes: int = 2
    gap: GapKind | None = None
    plastic: bool = False

    def __post_init__(self) -> None:
        kinds = {"cup": (Cup,), "spacing": SPACINGS, "ball_spacing": (*SPACINGS, type(None)), "element": (Element,)}
        for name, kind in kinds.items():
            if not isinstance(getattr(self, name), kind):
                known = " or ".join(allowed.__name__.replace("NoneType", "None") for allowed in kind)
                raise TypeError(f"{name} must be {known}, got {getattr(self, name)!r}")
        require("meshes", self.meshes, self.meshes in (1, 2), "meshes must be 1 (no error bars) or 2")
        check_gap(self.gap)

    contact_type: ClassVar[type[Contact]] = MeshedContact
    differentiable: ClassVar[bool] = False
    smooth_step: ClassVar[float] = 3e-2
    seconds_a_press: ClassVar[float] = 0.2
    name: ClassVar[str] = "fem"
    _sequence: ClassVar[str] = "press"  # method of the load curve

    @property
    def title(self) -> str:
        """Description of the model in one line."""
        return f"axisymmetric finite elements, {self.element.name.lower()}{', yielding liner' if self.plastic else ''}"

    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "section 2.3"),)

    domain: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity="joint.clearance",
            low=0.0,
            why="without clearance every load has the same half angle: use a millionth of the radius",
        ),
        Range(
            quantity=largest_poisson,
            symbol="ν",
            low=-1.0,
            high=0.49995,
            why="an incompressible body has no bulk modulus: 0.4999 is solved",
        ),
        Range(quantity="joint.thickness_ratio", high=250.0, why="the liner is too thin to be meshed"),
    )
    reach: ClassVar[str] = (
        "half angles up to half the arc of cover, at most 88°, or less if the ball fills its socket first or "
        "leaves the pole; the contact must be wider than a few elements, and a yielding liner must not collapse"
    )

    @property
    def further_quantities(self) -> tuple[str, ...]:
        """Quantities and limits of a liner that yields."""
        return (*PLASTIC, *YIELD_LIMITS) if self.plastic else ()

    @property
    def validity(self) -> tuple[Range, ...]:
        """Validity ranges; a circular gap needs no close fit."""
        return (*gap_validity(self.gap), SMALL_STRAIN, *([_SMALL_PLASTIC_STRAIN] if self.plastic else []))

    @property
    def remarks(self) -> tuple[Range, ...]:
        """Remarks on the gap, the bodies, and of a yielding liner on the modulus of its hardening and on ratcheting."""
        return (
            *gap_remarks(self.gap),
            *_BODY_REMARKS,
            *([_CURVE_COUNTS, _OTHER_MODULUS, _SHAKEDOWN] if self.plastic else []),
        )

    def _law(self, joint: Joint) -> ForceLaw:
        """Raise TypeError: each load has its own mesh, so there is no smooth force law."""
        raise TypeError("finite elements are too noisy for a law, because each load has its own mesh: use exact")

    def in_cup(self, cup: Cup, **aim: Any) -> FiniteElement:
        """Return a copy of the model with another cup; OutsideDomainError for a load at an angle to its axis."""
        tilt = cup.load_tilt(**aim)
        if tilt > AXIAL_TILT:
            angle = f"{degrees(tilt):.3g}° from the cup's axis"
            raise OutsideDomainError(f"fem solves axial loads only, and this one is {angle}: use sphere")
        return replace(self, cup=cup)

    def follow(self, joint: Joint, **loads: Any) -> MeshedContact:
        """Compute the contacts of one joint under loads that follow one another, such as repeated or removed loads.

        The first load presses a new socket, and each later one the socket as the previous load left it.

        Parameters
        ----------
        joint : Joint
            Joint of plain numbers.
        **loads
            `force` in N or `indentation` in mm, an array (loads,), zero or more.

        Returns
        -------
        MeshedContact
            Contact of the shape of the loads. Without force its indentation is where the ball touches again.

        Raises
        ------
        ValueError
            As of `press`; a liner that cannot yield.
        """
        if not self.plastic:
            raise ValueError("the contact does not depend on earlier loads without plastic=True: use press")
        follower = _LoadPath(**vars(self))
        contact: MeshedContact = follower.press(joint, **loads)  # type: ignore[assignment]
        return contact

    def yield_load(self, joint: Joint) -> float:
        """Compute the largest force in N under which the liner of a joint of plain numbers is elastic, within 0.1 %."""
        return self._largest_force(joint, _is_elastic)

    def collapse_load(self, joint: Joint) -> float:
        """Compute the largest force in N that a joint of plain numbers with a yielding liner bears, within 0.1 %.

        NaN outside the domain.
        """
        if not all(limit.strictly_holds(SimpleNamespace(joint=joint)) for limit in self.domain):
            return nan
        curve: Any = replace(self, meshes=1, plastic=True)._curve_of(joint.without_strengths(), joint.liner.yield_curve)
        return float(curve.collapse_load())

    def shakedown_load(self, joint: Joint) -> float:
        """Compute the largest force in N whose repetitions add no plastic work, within 0.1 %; see `repeated_work`."""
        return self._largest_force(joint, lambda contact: not contact.status.failed and _SHAKEDOWN.holds(contact))

    def _largest_force(self, joint: Joint, bears: Callable[[Any], bool]) -> float:
        """Bisect below the collapse load for the largest force in N that a socket bears; NaN outside the domain."""
        model, collapse = replace(self, meshes=1, plastic=True), self.collapse_load(joint)
        if isnan(collapse):
            return nan
        return bisect(0.0, collapse, lambda force: bears(model.press(joint, force=force)), tolerance=_TOLERANCE)

    def minimum_thickness(self, joint: Joint, force: float) -> float:
        """Compute the smallest thickness in mm of a liner that is elastic under a force in N, within 0.1 %.

        Bore, ball and backing of the joint of plain numbers stay. The liner is from R2/25 to 4 R2 thick, as far as
        chamfer and element size allow. The result is 0 if the thinnest one is elastic, and infinite if the thickest one
        is not.
        """
        from .solver import CHAMFERS  # slow to import

        model, radius = replace(self, meshes=1, plastic=True), float(joint.socket_radius)
        low, high = radius / 25, 4 * radius
        if self.cup.chamfer:
            thickest, thinnest = (self.cup.chamfer / share for share in CHAMFERS)
            low, high = max(low, thinnest * (1 + _TOLERANCE)), min(high, thickest * (1 - _TOLERANCE))
        if isinstance(self.spacing, Uniform):
            low = max(low, 2 * self.spacing.size)

        def yields(thickness: float) -> bool:
            changed = joint.replace(ball_radius=joint.ball_radius, clearance=joint.clearance, liner_thickness=thickness)
            return not _is_elastic(model.press(changed, force=force))

        if yields(high):
            return inf
        return bisect(low, high, yields, tolerance=_TOLERANCE) if yields(low) else 0.0

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        needs("fem", "skfem", "psutil")
        if self.plastic and kind == "half_angle":
            raise ValueError("a yielding liner is pressed by force or indentation, not by half_angle")
        hardening = joint.liner.yield_curve

        def solve(single: Joint, loads: Numbers) -> JointContacts:
            contacts: JointContacts = getattr(self._curve_of(single, hardening), self._sequence)(kind, loads)
            return contacts

        solution = solve_per_joint(self, joint, load, solve)
        return SolverResult(
            laws=solution,
            force=solution.force,
            indentation=solution.indentation,
            failures={
                Status.AT_RIM: solution.combine(lambda piece: piece.state.at_rim) == 1,
                Status.NOT_ROUND: solution.combine(lambda piece: piece.state.not_round) == 1,
            },
        )

    def _curve_of(self, joint: Joint, hardening: Hardening | None) -> MeshedLoadCurve | PlasticLoadCurve:
        """Return the load curve of a joint of plain numbers, whose liner yields by the hardening if it may yield."""
        from .plastic_curve import plastic_curve_of  # slow to import
        from .solver import load_curve_of

        gap: Any = select_gap(self.gap, joint)
        spacings = self.spacing, self.ball_spacing or self.spacing
        inputs = joint, self.cup, spacings, self.element.value, self.meshes, gap
        if not self.plastic:
            return load_curve_of(*inputs)
        if hardening is None:
            raise ValueError("a liner that yields needs hardening or yield_stress in its material, one number each")
        return plastic_curve_of(*inputs, hardening)


class _LoadPath(FiniteElement):
    """Finite elements whose liner keeps the plastic strain of the previous loads of an array."""

    _sequence: ClassVar[str] = "follow"
