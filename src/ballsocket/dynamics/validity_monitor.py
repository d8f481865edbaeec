"""Log warning for the first time that a force element leaves the validity range of its model."""

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
    """Monitor that logs one warning when an indentation first leaves the validity range of a model.

    Contacts below the range do not count, because every impact passes through them.

    Attributes
    ----------
    model : Model
    joint : Joint
    wall : float
        Largest indentation in mm that wall thickness and model allow.
    limit : float
        Largest indentation in mm that needs no check; infinite after the warning.
    """

    model: Model
    joint: Joint
    wall: float
    limit: float = 0.0

    def check_array(self, indentation: Array) -> None:
        """Check the largest of some indentations in mm, and log a warning if the model is invalid there."""
        depths = concrete_values(indentation) if self.limit < inf else None
        if depths is not None and depths.size:
            self.check(float(numpy.max(depths, initial=0.0, where=depths <= self.wall)))

    def check(self, indentation: float) -> None:
        """Check an indentation in mm, and log a warning if the model is invalid there.

        Indentations beyond the wall are reported by the status of the load instead.
        """
        if not self.limit < indentation <= self.wall:
            return
        contact = self._contact_at(indentation)
        if not self._exceeds_validity_range(contact):
            self.limit = self._find_valid_indentation(indentation)
            return
        self.limit = inf
        _log.warning("%s at an indentation of %.3g mm: %s", self.model.name, indentation, "; ".join(contact.notes))

    def _find_valid_indentation(self, depth: float) -> float:
        """Find an indentation in mm, `depth` or larger, at which the model is valid."""
        deeper = min(max(2 * depth, 1e-3 * self.wall), self.wall)
        for _ in range(6):
            if not self._exceeds_validity_range(self._contact_at(deeper)):
                return deeper
            deeper = (depth + deeper) / 2
        return depth

    def _contact_at(self, indentation: float) -> Contact:
        """Compute the contact at an indentation in mm."""
        return self.model.press(self.joint, indentation=indentation)

    def _exceeds_validity_range(self, contact: Contact) -> bool:
        """Check if a contact is invalid for a reason other than its small size."""
        return not contact.valid and not all(
            map(partial(_is_satisfied_by_larger_contact, contact), contact._validity_ranges)
        )


def _is_satisfied_by_larger_contact(contact: Contact, limit: Range) -> bool:
    """Check if a contact, or a larger contact, lies inside a range."""
    increases_with_size = isinstance(limit.quantity, str) and not limit.quantity.startswith("joint.")
    return bool(limit.holds(contact)) or (increases_with_size and bool(limit.quantity_of(contact) < limit.low))
