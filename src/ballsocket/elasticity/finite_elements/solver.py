"""Load curve of one joint, each load on a mesh for contacts of its width, with error estimates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from math import inf, pi, radians
from operator import attrgetter
from typing import Any

import numpy

from ...contact.per_joint import QUANTITIES, JointContacts
from ...contact.roots import PeakPressure, find_peak_pressure
from ...core.arrays import Numbers
from ...core.checks import require
from ...problem import Joint, Support
from ...problem.cup import Cup, Interface
from ...problem.gaps import Gap, GapKind
from .bodies import ContactSurface, SurfacePair, ball_compliance, socket_compliance
from .load_search import ContactBracket, Solved, is_pressed, stiffness, work
from .mesh import Resolution, socket_shape
from .pair_contact import FullContact, partial_contact
from .progress import report_progress
from .spacing import Spacing, Uniform, check_memory, mesh_size

FINE, COARSE, COARSEST = 0, 1, 2  # indices of the meshes; the last is for the errors of yielding liners
_STRIDE = 4  # number of classes whose contacts one coarse mesh resolves
_CLASS_MARGIN = 1.12  # factor by which the half angle may differ from its class on another mesh


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshedLoadCurve:
    """Force, indentation and half angle of one joint on finite element meshes."""

    pairs: Callable[[int, int], SurfacePair]  # function that makes the meshes
    # half angles in rad, descending from the widest of all; a class lies between each and the next
    classes: tuple[float, ...]
    gap: Gap
    ends_at_rim: bool  # True if deeper contacts fill the socket; otherwise they are not solved
    meshes: int  # 1 gives errors of NaN, 2 estimates them
    order: int  # order of the elements and of the error estimate
    _cached_brackets: dict[tuple[int, int], ContactBracket] = field(default_factory=dict, init=False, repr=False)

    def press(self, kind: str, load: Numbers) -> JointContacts:
        """Solve the contacts for loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        loads = load[touching].tolist()
        numbers = [self.mesh_class(kind, value) for value in loads]
        pairs = list(zip(loads, numbers, strict=True))
        fine, *coarse = (
            MeshedStates(solved=tuple(self._solve_contact(kind, *pair, mesh) for pair in pairs))
            for mesh in (FINE, COARSE)[: self.meshes]
        )
        reached = numpy.isfinite(fine.indentation) & numpy.isfinite(fine.force)
        error = dict.fromkeys(QUANTITIES, numpy.full(len(loads), numpy.nan))
        if coarse:
            error = estimate_errors(kind, fine, coarse[0], self.order)
        return JointContacts(load=load, touching=touching, state=fine, reached=reached, error=error)

    def mesh_class(self, kind: str, load: float) -> int:
        """Return the mesh class of a load, from its half angle estimated on the coarse mesh of a nearby class."""
        last = len(self.classes) - 2
        if kind == "half_angle":
            return min(sum(load <= edge for edge in self.classes[1:]), last)
        for start in range(0, last, _STRIDE):
            bracket = self.contact_bracket(start, COARSE)
            angle = bracket.estimate_angle(kind, load)
            if angle is not None:
                return min(sum(angle <= edge for edge in self.classes[1:]), last)
            if bracket.lies_below(kind, load):
                return start
        return last

    def contact_bracket(self, number: int, mesh: int) -> ContactBracket:
        if (number, mesh) not in self._cached_brackets:
            low = self.classes[min(number + _STRIDE, len(self.classes) - 1)] / _CLASS_MARGIN
            high = min(_CLASS_MARGIN * self.classes[number], self.classes[0])
            pair = self.pairs(number, mesh)
            self._cached_brackets[number, mesh] = ContactBracket(pair=pair, gap=self.gap, low=low, high=high)
        return self._cached_brackets[number, mesh]

    def _solve_contact(self, kind: str, load: float, number: int, mesh: int) -> Solved | None:
        """Solve one contact on the mesh of a class; None for a load outside the range of the class."""
        bracket = self.contact_bracket(number, mesh)
        if kind == "half_angle":
            if not self.classes[-1] / _CLASS_MARGIN <= load <= bracket.high:
                return None
            contact = partial_contact(bracket.pair, self.gap, load)
            return contact if is_pressed(contact) else None
        may_fill = number == 0 and self.ends_at_rim
        if may_fill and bracket.lies_below(kind, load):
            return _solve_full_contact(kind, load, bracket.pair, self.gap)
        partial = bracket.solve(kind, load)
        if not may_fill or (partial is not None and _is_round(partial)):
            return partial
        # a thin sheet of nearly the ball's radius is pressed all over before a cap reaches its rim
        full = _solve_full_contact(kind, load, bracket.pair, self.gap)
        return full if _is_round(full) else partial


def _solve_full_contact(kind: str, load: float, pair: SurfacePair, gap: Gap) -> FullContact:
    """Solve the contact that fills the socket under a load, by the secant method: one step for the linear gap."""
    contact = FullContact(pair=pair, gap=gap, indentation=load if kind == "indentation" else 1e-3 * pair.radius)
    if kind == "indentation":
        return contact
    step = 1e-3 * contact.indentation
    for _ in range(gap.steps + 3):
        following = replace(contact, indentation=contact.indentation + step)
        slope = (following.force - contact.force) / step
        contact, step = following, (load - following.force) / slope
        if abs(step) <= 1e-13 * contact.indentation:
            break
    return replace(contact, indentation=contact.indentation + step)


_MAX_TENSION = 1e-3  # over the pressure at the pole
_MAX_OVERLAP = 1e-3  # over the indentation
_PRESSURE_NOISE = 5e-4  # of the nodal pressures, over the one at the pole


def _is_round(contact: Solved) -> bool:
    """Return True for a contact without tension inside and without overlap outside."""
    return bool(contact.tension <= _MAX_TENSION and contact.overlap <= _MAX_OVERLAP)


_LAWS: dict[str, Callable[[Solved], float]] = {"stiffness": stiffness, "energy": work}


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshedStates(PeakPressure):
    """Solved contacts of one joint; each quantity has one number per contact, NaN for a missing contact (None)."""

    solved: tuple[Solved | None, ...]

    def __getattr__(self, name: str) -> Numbers:
        if name not in QUANTITIES:
            raise AttributeError(name)
        return self._evaluate_contacts(_LAWS.get(name, attrgetter(name)))

    def _evaluate_contacts(self, law: Callable[[Any], float]) -> Numbers:
        """Evaluate a function of each contact; NaN for missing contacts."""
        return numpy.array([numpy.nan if contact is None else law(contact) for contact in self.solved])

    @property
    def at_rim(self) -> Numbers:
        """Flag of each contact: 1 if it fills the socket, else 0."""
        return self._evaluate_contacts(lambda contact: float(contact.fills_bore))

    @property
    def not_round(self) -> Numbers:
        """Flag of each contact: 1 if tension or overlap shows that its area is not round, else 0."""
        return self._evaluate_contacts(lambda contact: float(not _is_round(contact)))

    @property
    def edge_element(self) -> Numbers:
        """Length of the elements at the edge of each contact, as a fraction of its half angle; 0 without contact."""
        return self._evaluate_contacts(lambda contact: contact.edge_element / (contact.half_angle or numpy.inf))

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """Largest pressure of each contact in MPa, and its polar angle in rad."""
        return find_peak_pressure(self.pressure, self.pole_pressure, self.half_angle, _PRESSURE_NOISE)

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (any, loads)."""
        columns = [
            numpy.full(len(angle), numpy.nan) if contact is None else contact.pressure(angle[:, i])
            for i, contact in enumerate(self.solved)
        ]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)


_SAFETY = 2.0  # factor on Richardson's error estimate
_MIN_ERRORS = {"force": 0.03, "indentation": 0.03, "half_angle": 0.7, "max_pressure": 0.2, "pole_pressure": 0.2}
_MIN_ERRORS |= {"stiffness": 1.0, "energy": 0.07, "pressure_integral": 0.02}
"""Observed errors of random contacts against the exact solution, over the square of relative element size.

They hold for biquadratic elements; bilinear ones had three times the errors. test_fem.py draws new contacts and
checks that the true error lies within the error bar.
"""


def estimate_errors(kind: str, fine: MeshedStates, coarse: MeshedStates, order: int) -> dict[str, Numbers]:
    """Estimate relative errors of the fine solution by Richardson's extrapolation with a safety factor.

    Both meshes may have the same error by chance, so an estimate is at least the observed error of elements of this
    size. The applied quantity is exact.
    """
    errors = {}
    for name in QUANTITIES:
        difference = abs(getattr(coarse, name) / getattr(fine, name) - 1)
        observed = _MIN_ERRORS[name] * (3 if order == 1 else 1) * fine.edge_element**2
        errors[name] = numpy.maximum(_SAFETY * difference / (2**order - 1), observed)
    errors[kind] = 0.0 * errors[kind]
    return errors


LIMIT = radians(88.0)  # largest half angle in rad that is solved
_REACH_FACTOR = 1.2  # of a class's widest contact: extent of its pressure nodes
CHAMFERS = 1e-3, 0.9  # limits on a chamfer as a share of the liner thickness
MIN_ELEMENTS, MAX_ELEMENTS = 24, 100_000  # limits on the number of elements of one size along the bore


@lru_cache(maxsize=32)
def load_curve_of(
    joint: Joint, cup: Cup, spacings: tuple[Spacing, Spacing], order: int, meshes: int, kind: GapKind
) -> MeshedLoadCurve:
    """Return the load curve of a joint of plain numbers; it is cached for further loads.

    `spacings` are those of socket and ball, `order` is that of the elements, and `kind` the class of the gap.
    """
    radius, bore = float(joint.socket_radius), socket_shape(joint, cup).reach
    if isinstance(spacings[0], Uniform):
        _check_element_size(spacings[0].size, joint, radius * bore)
    check_cup(cup, joint)
    ends_at_rim = bore <= pi / 2 + 1e-12
    widest = bore if ends_at_rim else LIMIT
    class_limits = spacings[0].classes(widest, radius)

    def make_pair(class_index: int, mesh: int) -> SurfacePair:
        limit, thickness = class_limits[class_index], float(joint.liner_thickness)
        coarse = (spacing.coarse(limit, radius, thickness, order) for spacing in spacings)
        change = {FINE: Resolution.halved, COARSEST: Resolution.doubled}.get(mesh)
        socket, ball = coarse if change is None else map(change, coarse)
        return _make_surface_pair(cup, joint, socket, ball, min(_REACH_FACTOR * limit, widest))

    gap = kind(clearance=float(joint.clearance), socket_radius=radius)
    return MeshedLoadCurve(
        pairs=make_pair, classes=class_limits, gap=gap, ends_at_rim=ends_at_rim, meshes=meshes, order=order
    )


def check_cup(cup: Cup, joint: Joint) -> None:
    """Raise ValueError for a cup that does not fit the joint."""
    if cup.interface is Interface.SLIDING and not joint.backing:
        ground = joint.support is Support.FIXED and float(joint.liner_thickness) < inf
        if not ground:
            raise ValueError("interface = 'sliding' needs a backing or a fixed outer surface behind the liner")
    chamfer, liner, bore = cup.chamfer, float(joint.liner_thickness), socket_shape(joint, cup).reach
    leaves = f"a chamfer must leave a tenth of the liner thickness, {liner:g} mm"
    require("chamfer", chamfer, chamfer < CHAMFERS[1] * liner, leaves)
    allowed = "a chamfer must be 0 or above a thousandth of the liner thickness"
    require("chamfer", chamfer, chamfer == 0 or chamfer > CHAMFERS[0] * liner, allowed)
    require("chamfer", chamfer, bore > cup.rim / 2, "a chamfer must leave half of the bore")


def _check_element_size(size: float, joint: Joint, bore: float) -> None:
    thicknesses = {"liner_thickness": joint.liner_thickness}
    thicknesses |= {f"backing[{number}].thickness": layer.thickness for number, layer in enumerate(joint.backing)}
    for name, thickness in thicknesses.items():
        require(name, thickness, thickness >= 2 * size, f"a layer must have at least two elements of {size:g} mm")
    allowed = f"the bore of {bore:.4g} mm allows {MIN_ELEMENTS} to {MAX_ELEMENTS} elements"
    require("size", size, bore / MAX_ELEMENTS <= size <= bore / MIN_ELEMENTS, allowed)


def _make_surface_pair(
    cup: Cup, joint: Joint, resolution: Resolution, ball_resolution: Resolution, reach: float
) -> SurfacePair:
    """Mesh both bodies up to the angle `reach` (rad) and condense them onto their contact surfaces."""
    size = mesh_size(joint, cup, resolution, ball_resolution)
    check_memory(size, resolution.order)
    report_progress(f"condensing {size.elements} elements, {size.nodes} nodes")
    R2, order = float(joint.socket_radius), resolution.order  # the ball, too, is pressed on a patch of the radius R2
    unit_bodies = [(*socket_compliance(socket_shape(joint, cup), resolution), joint.liner)]
    if joint.ball is not None:
        unit_bodies.append((*ball_compliance(float(joint.ball.poisson), ball_resolution), joint.ball))
    surfaces = [
        ContactSurface(angle=angle, order=order, compliance=compliance / (R2 * float(material.young)))
        for angle, compliance, material in unit_bodies
    ]
    return SurfacePair(
        surfaces=tuple(surfaces), radius=R2, reach=reach, resolution=resolution, ball_resolution=ball_resolution
    )
