"""All contacts of one joint: loads find their half angles, each on a mesh that is made for contacts of its width."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter

import numpy

from ...contact.peak_pressure import Peaked, largest_pressure
from ...contact.per_joint import QUANTITIES, Piece
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .full_contact import FullContact
from .load_search import ContactBracket, is_pressed
from .round_contact import partial_contact
from .surfaces import SurfacePair
from .tangent import Solved, stiffness, work

FINE, COARSE = 0, 1
"""The two meshes."""

_STRIDE = 4
"""Classes whose contacts can be told apart on one coarse mesh."""

_ROOM = 1.12
"""How much wider or narrower than its class a contact may come out on another mesh."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshedLoadCurve:
    """Force, indentation and half angle of one joint.

    Parameters
    ----------
    pairs : function (number of the class, FINE or COARSE) -> SurfacePair
        The meshes.
    classes : tuple of float
        Half angles in rad, descending, the first one the widest of all: a class lies between each and the next.
    gap : Gap
    ends_at_rim : bool
        Whether deeper contacts fill the socket; otherwise they are not solved.
    meshes : int
        1 leaves the errors unknown, 2 estimates them.
    order : int
        Of the elements, and of the error bars.
    """

    pairs: Callable[[int, int], SurfacePair]
    classes: tuple[float, ...]
    gap: Gap
    ends_at_rim: bool
    meshes: int
    order: int

    def press(self, kind: str, load: Numbers) -> Piece:
        """The contacts that belong to loads of one kind: "force", "indentation" or "half_angle"."""
        touching = load > 0
        given = load[touching].tolist()
        numbers = [self._class(kind, one) for one in given]
        fine, *coarse = (
            MeshedStates(solved=tuple(self._contact(kind, *one, mesh) for one in zip(given, numbers, strict=True)))
            for mesh in (FINE, COARSE)[: self.meshes]
        )
        reached = numpy.isfinite(fine.indentation) & numpy.isfinite(fine.force)
        error = dict.fromkeys(QUANTITIES, numpy.full(len(given), numpy.nan))
        if coarse:
            error = estimate_errors(kind, fine, coarse[0], self.order)
        return Piece(load=load, touching=touching, state=fine, reached=reached, error=error)

    def _class(self, kind: str, load: float) -> int:
        """The class that a load belongs to, by its half angle on the coarse mesh of a class not far from it."""
        last = len(self.classes) - 2
        if kind == "half_angle":
            return min(sum(load <= angle for angle in self.classes[1:]), last)
        for start in range(0, last, _STRIDE):
            ladder = self._ladder(start, COARSE)
            rough = ladder.guess(kind, load)
            if rough is not None:
                return min(sum(rough <= angle for angle in self.classes[1:]), last)
            if ladder.falls_short(kind, load):
                return start
        return last

    def _ladder(self, number: int, mesh: int) -> ContactBracket:
        """The contacts on the mesh of a class, and of some narrower ones."""
        if (number, mesh) not in self._ladders:
            low = self.classes[min(number + _STRIDE, len(self.classes) - 1)] / _ROOM
            high = min(_ROOM * self.classes[number], self.classes[0])
            self._ladders[number, mesh] = ContactBracket(
                pair=self.pairs(number, mesh), gap=self.gap, low=low, high=high
            )
        return self._ladders[number, mesh]

    @cached_property
    def _ladders(self) -> dict[tuple[int, int], ContactBracket]:
        return {}

    def _contact(self, kind: str, load: float, number: int, mesh: int) -> Solved | None:
        ladder = self._ladder(number, mesh)
        if kind == "half_angle":
            one = (
                partial_contact(ladder.pair, self.gap, load)
                if self.classes[-1] / _ROOM <= load <= ladder.high
                else None
            )
            return one if one is not None and is_pressed(one) else None
        if number == 0 and self.ends_at_rim and ladder.falls_short(kind, load):
            return _solve_full_contact(kind, load, ladder.pair, self.gap)
        return ladder.find(kind, load)


def _solve_full_contact(kind: str, load: float, pair: SurfacePair, gap: Gap) -> FullContact:
    """The contact that fills the socket under a load; its force grows with the indentation.

    By the secant method, which is one step for the linear gap.
    """
    here = FullContact(pair=pair, gap=gap, indentation=load if kind == "indentation" else 1e-3 * pair.radius)
    if kind == "indentation":
        return here
    step = 1e-3 * here.indentation
    for _ in range(gap.steps + 3):
        ahead = replace(here, indentation=here.indentation + step)
        slope = (ahead.force - here.force) / step
        here, step = ahead, (load - ahead.force) / slope
        if abs(step) <= 1e-13 * here.indentation:
            break
    return replace(here, indentation=here.indentation + step)


_TENSION, _OVERLAP = (
    1e-3,
    1e-3,
)  # over the pressure at the pole; over the indentation
_NOISE = 5e-4  # of the pressures at nodes, over the one at the pole

_LAWS: dict[str, Callable[[Solved], float]] = {"stiffness": stiffness, "energy": work}


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshedStates(Peaked):
    """Solved contacts side by side, each quantity one number a contact; None and NaN where there is none."""

    solved: tuple[Solved | None, ...]

    def __getattr__(self, name: str) -> Numbers:
        if name not in QUANTITIES:
            raise AttributeError(name)
        return self._each(_LAWS.get(name, attrgetter(name)))

    def _each(self, law: Callable[[Solved], float]) -> Numbers:
        return numpy.array([numpy.nan if one is None else law(one) for one in self.solved])

    @property
    def at_rim(self) -> Numbers:
        """1 where the contact fills its socket."""
        return self._each(lambda one: float(isinstance(one, FullContact)))

    @property
    def unsound(self) -> Numbers:
        """1 where something pulls or overlaps: the contact is not the round patch that was assumed."""
        return self._each(lambda one: float(one.tension > _TENSION or one.overlap > _OVERLAP))

    @property
    def edge_element(self) -> Numbers:
        """Length of the elements at the edge over the half angle."""
        return self._each(lambda one: one.edge_element / one.half_angle)

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""
        return largest_pressure(self.pressure, self.pole_pressure, self.half_angle, _NOISE)

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, loads)."""
        columns = [
            numpy.full(len(angle), numpy.nan) if one is None else one.pressure(angle[:, i])
            for i, one in enumerate(self.solved)
        ]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)


_SAFETY = 2.0  # over what Richardson's extrapolation takes off
_LEAST = {
    "force": 0.03,
    "indentation": 0.03,
    "half_angle": 0.7,
    "max_pressure": 0.2,
    "pole_pressure": 0.2,
    "stiffness": 1.0,
    "energy": 0.07,
    "pressure_integral": 0.02,
}
"""Errors that random contacts have shown against the exact answer, in squares of the element over the half angle.

For biquadratic elements; bilinear ones have shown three times as much. A test draws such contacts anew: the true error
lies within the error bar (test_fem.py).
"""


def estimate_errors(kind: str, fine: MeshedStates, coarse: MeshedStates, order: int) -> dict[str, Numbers]:
    """Relative errors of the fine solution by Richardson's extrapolation, with some safety.

    Both meshes may be off by the same by chance, so an error is at least what elements of this size have shown. What
    was given is exact.
    """
    errors = {}
    for name in QUANTITIES:
        apart = abs(getattr(coarse, name) / getattr(fine, name) - 1)
        least = _LEAST[name] * (3 if order == 1 else 1) * fine.edge_element**2
        errors[name] = numpy.maximum(_SAFETY * apart / (2**order - 1), least)
    errors[kind] = 0.0 * errors[kind]
    return errors
