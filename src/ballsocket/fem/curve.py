"""All contacts of one joint: loads find their half angles, each on a mesh that is made for contacts of its width."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter

import numpy

from ..arrays import Numbers, gauss_legendre
from ..gaps import Gap
from ..per_joint import QUANTITIES, Piece, largest_pressure
from .full_contact import Brimful
from .load_search import Ladder, is_contact
from .round_contact import Cap, cap
from .surfaces import Pair

Solved = Cap | Brimful

FINE, COARSE = 0, 1
"""The two meshes."""

_STRIDE = 4
"""Classes whose contacts can be told apart on one coarse mesh."""

_ROOM = 1.12
"""How much wider or narrower than its class a contact may come out on another mesh."""

_SAFETY = 2.0
_LEAST = {
    "force": 0.03,
    "indentation": 0.03,
    "half_angle": 0.7,
    "max_pressure": 0.2,
    "pole_pressure": 0.2,
    "stiffness": 0.4,
    "energy": 0.07,
    "pressure_integral": 0.02,
}
"""Errors that random contacts have shown against the exact answer, in squares of the element over the half angle.

For biquadratic elements; bilinear ones have shown three times as much.
"""

_TENSION, _OVERLAP = 1e-3, 1e-3
_NOISE = 5e-4  # of the pressures at nodes, over the one at the pole


@dataclass(frozen=True, kw_only=True, eq=False)
class States:
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
        return self._each(lambda one: float(isinstance(one, Brimful)))

    @property
    def unsound(self) -> Numbers:
        """1 where something pulls or overlaps: the contact is not the round patch that was assumed."""
        return self._each(lambda one: float(one.tension > _TENSION or one.overlap > _OVERLAP))

    @property
    def edge_element(self) -> Numbers:
        """Length of the elements at the edge over the half angle."""
        return self._each(lambda one: one.edge_element / one.half_angle)

    @cached_property
    def _largest(self) -> tuple[Numbers, Numbers]:
        return largest_pressure(self.pressure, self.pole_pressure, self.half_angle, _NOISE)

    @property
    def max_pressure(self) -> Numbers:
        """The largest pressure in MPa."""
        return self._largest[0]

    @property
    def max_pressure_angle(self) -> Numbers:
        """Where the pressure is largest, in rad from the pole."""
        return self._largest[1]

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, loads)."""
        columns = [
            numpy.full(len(angle), numpy.nan) if one is None else one.pressure(angle[:, i])
            for i, one in enumerate(self.solved)
        ]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """Force, indentation and half angle of one joint.

    Parameters
    ----------
    pairs : function (number of the class, FINE or COARSE) -> Pair
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

    pairs: Callable[[int, int], Pair]
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
            States(solved=tuple(self._contact(kind, *one, mesh) for one in zip(given, numbers, strict=True)))
            for mesh in (FINE, COARSE)[: self.meshes]
        )
        reached = numpy.isfinite(fine.indentation) & numpy.isfinite(fine.force)
        error = dict.fromkeys(QUANTITIES, numpy.full(len(given), numpy.nan))
        if coarse:
            error = _errors(kind, fine, coarse[0], self.order)
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

    def _ladder(self, number: int, mesh: int) -> Ladder:
        """The contacts on the mesh of a class, and of some narrower ones."""
        if (number, mesh) not in self._ladders:
            low = self.classes[min(number + _STRIDE, len(self.classes) - 1)] / _ROOM
            high = min(_ROOM * self.classes[number], self.classes[0])
            self._ladders[number, mesh] = Ladder(pair=self.pairs(number, mesh), gap=self.gap, low=low, high=high)
        return self._ladders[number, mesh]

    @cached_property
    def _ladders(self) -> dict[tuple[int, int], Ladder]:
        return {}

    def _contact(self, kind: str, load: float, number: int, mesh: int) -> Solved | None:
        ladder = self._ladder(number, mesh)
        if kind == "half_angle":
            one = cap(ladder.pair, self.gap, load) if self.classes[-1] / _ROOM <= load <= ladder.high else None
            return one if one is not None and is_contact(one) else None
        if number == 0 and self.ends_at_rim and ladder.falls_short(kind, load):
            return _brimful(kind, load, ladder.pair, self.gap)
        return ladder.find(kind, load)


def _brimful(kind: str, load: float, pair: Pair, gap: Gap) -> Brimful:
    """The contact that fills the socket under a load; its force grows with the indentation.

    By the secant method, which is one step for the linear gap.
    """
    here = Brimful(pair=pair, gap=gap, indentation=load if kind == "indentation" else 1e-3 * pair.radius)
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


_AROUND = 0.02 * numpy.arange(-3, 4)
_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(12))
_DEPTHS = numpy.geomspace(1 / 30, 1.0, 12)


def _stiffness(one: Solved) -> float:
    """dF/dd in N/mm, from contacts on both sides, since the edge moves unevenly through the elements.

    With q = ln(F/d) and v = 1/d, both smooth in ε even where d goes to infinity: F' = (F/d) (1 - v q'/v').
    """
    if isinstance(one, Brimful):
        return one.stiffness
    angles = numpy.minimum(_AROUND, one.pair.angle[-1] / one.half_angle - 1)
    beside = [cap(one.pair, one.gap, float(one.half_angle * (1 + angle))) for angle in numpy.unique(angles)]
    sound = [other for other in beside if is_contact(other)]
    if len(sound) < _CUBIC + 1:
        return numpy.nan
    x = numpy.array([other.half_angle / one.half_angle - 1 for other in sound])
    q = numpy.log([other.force / other.indentation for other in sound])
    v = numpy.array([one.indentation / other.indentation for other in sound])
    dq, dv = (numpy.polynomial.Polynomial.fit(x, values, _CUBIC).deriv()(0.0) for values in (q, v))
    return float(one.force / one.indentation * (1 - dq / dv))


_CUBIC = 3


def _energy(one: Solved) -> float:
    """Work of the load in N mm: the strain energy, where the gap makes that the same."""
    if one.gap.conservative:
        return one.strain_energy
    if isinstance(one, Brimful):
        return _work_up_to(cap(one.pair, one.gap, one.half_angle)) + _work_beyond(one)
    return _work_up_to(one)


def _work_up_to(one: Cap) -> float:
    """∫ F dd, from where F is a power of d: ln F is a polynomial of ln d over what matters of it."""
    ladder = Ladder(pair=one.pair, gap=one.gap, low=0.2 * one.half_angle, high=one.half_angle)
    found = [ladder.find("indentation", float(depth * one.indentation)) for depth in _DEPTHS[:-1]]
    known = [other for other in found if other is not None] + [one]
    x = numpy.log([other.indentation / one.indentation for other in known])
    y = numpy.log([other.force / one.force for other in known])
    law = numpy.polynomial.Polynomial.fit(x, y, min(6, len(x) - 1))
    depths = x[0] * (1 - _NODES)  # ln d
    narrow = numpy.exp(law(x[0]) + x[0]) / (law.deriv()(x[0]) + 1)
    return float(one.force * one.indentation * (narrow - x[0] * (_WEIGHTS @ numpy.exp(law(depths) + depths))))


def _work_beyond(one: Brimful) -> float:
    """∫ F dd from where the contact reaches the rim."""
    start = cap(one.pair, one.gap, one.half_angle).indentation
    depth = one.indentation - start
    forces = [replace(one, indentation=start + depth * node).force for node in _NODES]
    return float(depth * (_WEIGHTS @ forces))


_LAWS: dict[str, Callable[[Solved], float]] = {"stiffness": _stiffness, "energy": _energy}


def _errors(kind: str, fine: States, coarse: States, order: int) -> dict[str, Numbers]:
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
