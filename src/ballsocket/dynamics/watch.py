"""A law outside its validity says so in the log, once."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from functools import partial
from math import inf

import numpy

from ..contact import Contact, Model
from ..core.arrays import Array, concrete_values
from ..core.validity import Range
from ..problem import Joint

_log = logging.getLogger("ballsocket.dynamics")


@dataclass
class ValidityMonitor:
    """Looks out for the first indentation at which a model does not trust itself, and says so; then it is quiet.

    Contacts that are only too small, which every touch-down passes through, are not told.

    Attributes
    ----------
    limit : float
        In mm: up to here nothing is to be said.
    """

    model: Model
    joint: Joint
    wall: float
    limit: float = 0.0

    def check_array(self, indentation: Array) -> None:
        """At an array."""
        depths = concrete_values(indentation) if self.limit < inf else None
        if depths is not None and depths.size:
            self.check(float(numpy.max(depths, initial=0.0, where=depths <= self.wall)))

    def check(self, indentation: float) -> None:
        """At one indentation in mm; beyond the wall there is a status for it."""
        if not self.limit < indentation <= self.wall:
            return
        contact = self._pressed(indentation)
        if not self._outgrown(contact):
            self.limit = self._trusted_from(indentation)
            return
        self.limit = inf
        _log.warning("%s at an indentation of %.3g mm: %s", self.model.name, indentation, "; ".join(contact.notes))

    def _trusted_from(self, depth: float) -> float:
        """A depth up to which the model trusts itself as it does at this one."""
        further = min(max(2 * depth, 1e-3 * self.wall), self.wall)
        for _ in range(6):
            if not self._outgrown(self._pressed(further)):
                return further
            further = (depth + further) / 2
        return depth

    def _pressed(self, indentation: float) -> Contact:
        return self.model.press(self.joint, indentation=indentation)

    def _outgrown(self, contact: Contact) -> bool:
        """Whether it is not valid, and not just because it is small."""
        return not contact.valid and not all(map(partial(_small, contact), contact._limits))


def _small(contact: Contact, limit: Range) -> bool:
    """Whether a limit holds, or will when the contact grows."""
    grows = isinstance(limit.quantity, str) and not limit.quantity.startswith("joint.")
    return bool(limit.holds(contact)) or (grows and bool(limit.of(contact) < limit.low))
