"""All contacts of one joint: loads find their half angles, each on a mesh that is made for contacts of its width."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy

from ...contact.per_joint import QUANTITIES, JointContacts
from ...core.arrays import Numbers
from ...problem.gaps import Gap
from .full_contact import Brimful
from .load_search import Ladder, is_contact
from .round_contact import cap
from .states import States, errors_of
from .surfaces import Pair
from .work import Solved

FINE, COARSE = 0, 1
"""The two meshes."""

_STRIDE = 4
"""Classes whose contacts can be told apart on one coarse mesh."""

_ROOM = 1.12
"""How much wider or narrower than its class a contact may come out on another mesh."""


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

    def press(self, kind: str, load: Numbers) -> JointContacts:
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
            error = errors_of(kind, fine, coarse[0], self.order)
        return JointContacts(load=load, touching=touching, state=fine, reached=reached, error=error)

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
