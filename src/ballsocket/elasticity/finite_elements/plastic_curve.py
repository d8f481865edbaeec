"""Contacts of one joint whose liner yields: each load from the virgin socket, or one load after another."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from operator import attrgetter
from typing import Any

import numpy

from ...contact.per_joint import QUANTITIES, JointContacts
from ...contact.roots import bisect
from ...core.arrays import Numbers
from ...core.quantities import PLASTIC
from ...problem import Joint
from ...problem.cup import Cup
from ...problem.hardening import Hardening
from .bodies import socket_body
from .mesh import socket_shape
from .plastic_body import PlasticBody
from .plastic_contact import PlasticContact, PlasticPath
from .solver import COARSE, COARSEST, MeshedLoadCurve, MeshedStates, estimate_errors, load_curve_of
from .spacing import Spacing

_CONVERGENCE_ORDER = 2  # of force and displacement, measured
_FORCE_TOLERANCE, _DEPTH_TOLERANCE = 1e-3, 0.1  # relative, of the collapse load and its indentation
_RUNGS, _GROWTH = 8, 1.25  # increments up to the widest elastic contact of a mesh; ratio of the loads beyond


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticContacts(MeshedStates):
    """Contacts with a yielding liner; each quantity has one number per contact, NaN for a missing contact (None)."""

    solved: tuple[PlasticContact | None, ...]  # type: ignore[assignment]

    def __getattr__(self, name: str) -> Numbers:
        if name not in (*QUANTITIES, *PLASTIC, "von_mises"):
            raise AttributeError(name)
        return self._evaluate_contacts(attrgetter(name))


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticLoadCurve:
    """Contacts of a joint of plain numbers whose liner yields.

    The meshes are those of the elastic contacts, coarser by one halving: plastic strains gain nothing from finer ones.
    """

    elastic: MeshedLoadCurve
    joint: Joint
    cup: Cup
    hardening: Hardening
    _paths: dict[tuple[int, int], PlasticPath] = field(default_factory=dict, init=False, repr=False)
    _ladders: dict[tuple[str, int, int], list[PlasticContact]] = field(default_factory=dict, init=False, repr=False)

    @property
    def _meshes(self) -> tuple[int, ...]:
        return (COARSE, COARSEST)[: self.elastic.meshes]

    def press(self, kind: str, load: Numbers) -> JointContacts:
        """Solve contacts, each loaded from the virgin socket by a "force" or "indentation"."""
        touching = load > 0
        loads = load[touching].tolist()
        meshed = [[self._press_on_mesh(kind, value, mesh) for value in loads] for mesh in self._meshes]
        return self._contacts(kind, load, touching, meshed)

    def follow(self, kind: str, load: Numbers) -> JointContacts:
        """Solve contacts under loads that follow one another; the first one loads the virgin socket."""
        meshed = [self._follow_on_mesh(kind, load.tolist(), mesh) for mesh in self._meshes]
        return self._contacts(kind, load, numpy.ones(len(load), dtype=bool), meshed)

    def _contacts(
        self, kind: str, load: Numbers, touching: Numbers, meshed: list[list[PlasticContact | None]]
    ) -> JointContacts:
        fine, *coarse = (PlasticContacts(solved=tuple(contacts)) for contacts in meshed)
        error = dict.fromkeys(QUANTITIES, numpy.full(len(meshed[0]), numpy.nan))
        if coarse:
            with numpy.errstate(invalid="ignore", divide="ignore"):
                error = estimate_errors(kind, fine, coarse[0], _CONVERGENCE_ORDER)
        reached = numpy.isfinite(fine.indentation)
        return JointContacts(load=load, touching=touching, state=fine, reached=reached, error=error)

    def _path(self, number: int, mesh: int) -> PlasticPath:
        """Make the path on the mesh of a class."""
        if (number, mesh) not in self._paths:
            pair, young = self.elastic.pairs(number, mesh), float(self.joint.liner.young)
            body = socket_body(socket_shape(self.joint, self.cup), pair.resolution)
            plastic = PlasticBody(body=body, hardening=self.hardening.scaled(1 / young))
            self._paths[number, mesh] = PlasticPath(body=plastic, pair=pair, gap=self.elastic.gap, young=young)
        return self._paths[number, mesh]

    def _rung(self, kind: str, number: int, index: int) -> float:
        """Return a load of the ladder of a class, from 0 to that of its widest elastic contact and beyond.

        A class without elastic contacts has the ladder of the nearest one; without any there are no increments.
        """
        classes = sorted(range(len(self.elastic.classes) - 1), key=lambda other: abs(other - number))
        samples = (self.elastic.contact_bracket(other, COARSE).samples for other in classes)
        widest = next((float(getattr(contacts[-1], kind)) for contacts in samples if contacts), numpy.inf)
        return widest * (index / _RUNGS if index <= _RUNGS else _GROWTH ** (index - _RUNGS))

    def _press_on_mesh(self, kind: str, load: float, mesh: int) -> PlasticContact | None:
        """Solve a load in increments that do not depend on the other loads, on a mesh that is wide enough."""
        for number in range(self.elastic.mesh_class(kind, load), -1, -1):
            ladder = self._ladders.setdefault((kind, number, mesh), [self._path(number, mesh).start])
            while self._rung(kind, number, len(ladder)) < load and self._fits(ladder[-1], number):
                rung = self._path(number, mesh).approach(kind, self._rung(kind, number, len(ladder)), ladder[-1])
                if rung is None:
                    break
                ladder.append(rung)
            below = sum(self._rung(kind, number, index) < load for index in range(1, len(ladder)))
            contact = self._path(number, mesh).approach(kind, load, ladder[below])
            if contact is not None and self._fits(contact, number):
                return contact
        return None

    def collapse_load(self) -> float:
        """Find the largest force in N of all indentations up to the radius, from its tangent, within 0.1 %.

        It does not depend on increments. In a cup of more than 180 degrees the contact may end at the last pressure
        node; pressure beyond it would add 0.1 % of force.
        """
        path, forces = self._path(0, COARSE), [0.0]
        contact, depth = path.start, path.pair.radius * path.body.hardening.stress[0]

        def rises(depth: float) -> bool:
            nonlocal contact
            deeper = path.approach("indentation", depth, contact)
            if deeper is None:
                return False
            forces.append(deeper.force)
            if deeper.stiffness * depth < _FORCE_TOLERANCE * deeper.force:
                return False
            contact = deeper
            return True

        while depth < path.pair.radius and rises(depth):
            depth *= 2
        bisect(depth / 2, min(depth, path.pair.radius), rises, tolerance=_DEPTH_TOLERANCE)
        return max(forces)

    def _follow_on_mesh(self, kind: str, loads: list[float], mesh: int) -> list[PlasticContact | None]:
        """Solve a path of loads on the mesh of its largest load, or a wider one where the contact needs it.

        From the first contact that fits no mesh, there are none.
        """
        contacts: list[PlasticContact | None] = []
        fitting = 0
        for number in range(self.elastic.mesh_class(kind, max(loads)), -1, -1):
            path, contacts = self._path(number, mesh), []
            contact: PlasticContact | None = path.start
            for load in loads:
                start = 0.0 if contact is None else float(getattr(contact, kind))
                count = int(numpy.ceil(abs(load - start) / self._rung(kind, number, 1))) or 1
                for target in numpy.linspace(start, load, min(count, _RUNGS) + 1)[1:].tolist():
                    contact = None if contact is None else path.approach(kind, target, contact)
                contacts.append(contact)
            misfits = (index for index, each in enumerate(contacts) if each and not self._fits(each, number))
            fitting = next(misfits, len(contacts))
            if fitting == len(contacts):
                break
        return contacts[:fitting] + [None] * (len(contacts) - fitting)

    def _fits(self, contact: PlasticContact, number: int) -> bool:
        """Return True unless the contact reaches the end of its pressure nodes inside the bore."""
        if number == 0:
            return self.elastic.ends_at_rim or not contact.fills_bore
        return not contact.pressures[-4:].any()


@lru_cache(maxsize=16)
def plastic_curve_of(
    joint: Joint, cup: Cup, spacings: tuple[Spacing, Spacing], order: int, meshes: int, kind: Any, hardening: Hardening
) -> PlasticLoadCurve:
    """Return the curve of a joint of plain numbers whose liner yields; see `solver.load_curve_of`.

    `kind` is the class of the gap.
    """
    elastic = load_curve_of(joint, cup, spacings, order, meshes, kind)
    return PlasticLoadCurve(elastic=elastic, joint=joint, cup=cup, hardening=hardening)
