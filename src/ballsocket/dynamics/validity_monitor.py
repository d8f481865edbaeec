"""Warning on an indentation outside the validity of a model, logged once for each force element."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any

import numpy

from ..contact import Contact, Model
from ..core.arrays import Array, concrete_values, logical_not
from ..core.validity import Range
from ..problem import Joint

_log = logging.getLogger("ballsocket.dynamics")

FIRST_TOUCH = 1e-9
"""Indentation just after first touch, over the largest one."""


def is_lower_limit(limit: Range, first_touch: Any, deepest: Any) -> Array:
    """Check if a range excludes only contacts that are too small; every contact passes through them."""
    return logical_not(limit.holds(first_touch)) & limit.holds(deepest)


@dataclass
class ValidityMonitor:
    """Monitor that logs one warning when an indentation first leaves the validity range of a model.

    Contacts that are only too small for the model do not count, because every contact begins so.
    """

    model: Model
    joint: Joint
    wall: float  # largest indentation in mm that wall thickness and model allow
    limit: float = 0.0  # largest indentation in mm that needs no check; infinite after the warning

    @contextmanager
    def paused(self) -> Iterator[None]:
        """Check nothing in a block, such as an integration: the ball never reaches some of its trial states."""
        limit, self.limit = self.limit, inf
        try:
            yield
        finally:
            self.limit = limit

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
        contact = self._press(indentation)
        if self._exceeds_validity_range(contact):
            self.limit = inf
            _log.warning("%s at an indentation of %.3g mm: %s", self.model.name, indentation, "; ".join(contact.notes))
            return
        deeper = min(max(2 * indentation, 1e-3 * self.wall), self.wall)
        for _ in range(6):
            if not self._exceeds_validity_range(self._press(deeper)):
                break
            deeper = (indentation + deeper) / 2
        else:
            deeper = indentation
        self.limit = deeper

    def _press(self, indentation: float) -> Contact:
        return self.model.press(self.joint, indentation=indentation)

    @cached_property
    def _extreme_contacts(self) -> tuple[Contact, Contact]:
        """Contacts just after first touch, and at the largest indentation."""
        return self._press(FIRST_TOUCH * self.wall), self._press(self.wall)

    def _exceeds_validity_range(self, contact: Contact) -> bool:
        """Check if a contact is invalid for a reason other than its small size."""
        broken = [limit for limit in contact._validity_ranges if not limit.holds(contact)]
        return not all(is_lower_limit(limit, *self._extreme_contacts) for limit in broken)
