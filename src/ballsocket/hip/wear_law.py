"""Wear law: worn depth of each point of the socket from the pressures and slides of a cycle."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Protocol

import numpy

from ..core.arrays import Numbers
from .kinematics import SurfaceSliding
from .law_fields import Law, LawField

METRE = 1e-3
"""Wear factor per millimetre of sliding over wear factor per metre."""

COEFFICIENT = "coefficient"
"""Key of the wear coefficient in files and among sampled quantities."""

_PRESSURE_STEP = 1e-6
"""Step of the pressure for the sensitivity of a law, relative to the largest pressure."""

_PLAUSIBLE_FACTORS = 1e-9, 1e-4
"""Range of wear factors of materials in joints, in mm³/(N m)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleExposure:
    """Pressures and slides of all points of the socket during a cycle.

    Attributes
    ----------
    pressure : array (instants, points)
        Pressure in MPa.
    sliding : SurfaceSliding
    contact_shares : function, optional
        Function that computes `contact`. Without it, a cell with a positive pressure is in contact completely.
    """

    pressure: Numbers
    sliding: SurfaceSliding
    contact_shares: Callable[[], Numbers] | None = None

    @cached_property
    def contact(self) -> Numbers:
        """Share of each point's cell that is in contact, from 0 to 1: (instants, points)."""
        return (self.pressure > 0).astype(float) if self.contact_shares is None else self.contact_shares()

    @cached_property
    def work(self) -> Numbers:
        """∫ p v dt of each point, in N/mm: (points,)."""
        return numpy.einsum("tp,tp->p", self.pressure, self.sliding.distances)

    @cached_property
    def cross_shear(self) -> Numbers:
        """Cross-shear of each point: (points,)."""
        return self.sliding.cross_shear(self.pressure)


class AnyWearLaw(Protocol):
    """Object that a simulation accepts as a wear law: a `WearLaw`, or any object with depth and notes."""

    def depth(self, cycle: CycleExposure) -> Numbers:
        """Compute the worn depth of each point in a cycle, in mm: (points,)."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on the coefficients."""
        ...


class WearLaw(Law):
    """Base of wear laws: frozen dataclasses with `name`, `title`, fields by `law_field`, and `depth`.

    A law in the registry `WEAR_LAWS` is available in files, on the command line, and in the explorer.
    """

    wears_balls: ClassVar[bool] = True
    """True if files accept a `ball_coefficient` of a ball that wears too."""

    @abstractmethod
    def depth(self, cycle: CycleExposure) -> Numbers:
        """Compute the worn depth of each point in a cycle, in mm: (points,)."""

    def with_coefficient(self, value: float) -> WearLaw:
        """Return the law with another wear coefficient.

        Raises
        ------
        ValueError
            The law has no coefficient.
        """
        changed: WearLaw = replace(self, **{_coefficient_field(self).name: value})  # type: ignore[type-var]
        return changed


def coefficient_field(law: Any) -> LawField | None:
    """Return the field of the wear coefficient of a law; None for a law without one."""
    parts = law.law_fields() if isinstance(law, Law) else ()
    return next((part for part in parts if part.key == COEFFICIENT), None)


def _coefficient_field(law: Any) -> LawField:
    part = coefficient_field(law)
    if part is None:
        raise ValueError("coefficient cannot be sampled: the wear law has no coefficient")
    return part


def with_coefficient(law: AnyWearLaw, value: float) -> AnyWearLaw:
    """Return a law with another wear coefficient.

    Raises
    ------
    ValueError
        The law has no coefficient.
    """
    _coefficient_field(law)
    changed: AnyWearLaw = law.with_coefficient(value)  # type: ignore[attr-defined]  # it has fields: a `WearLaw`
    return changed


def plausibility_notes(*factors: float) -> tuple[str, ...]:
    """Note the first wear factor outside the range of materials in joints (mm³/(N m))."""
    low, high = _PLAUSIBLE_FACTORS
    unusual = next((factor for factor in factors if factor > 0 and not low <= factor <= high), None)
    if unusual is None:
        return ()
    return (
        f"a wear factor of {unusual:g} mm^3/(N m) is out of the usual range of {low:g} to {high:g}; "
        "one in mm^3/(N mm) is 1000 times smaller",
    )


def max_wear_sensitivity(law: AnyWearLaw, cycle: CycleExposure) -> float:
    """Compute the largest increase of the depth of a cycle by the pressure, in mm/MPa."""
    step = _PRESSURE_STEP * float(cycle.pressure.max(initial=0.0))
    if not step > 0:
        return 0.0
    raised = CycleExposure(
        pressure=cycle.pressure + step * (cycle.pressure > 0),
        sliding=cycle.sliding,
        contact_shares=lambda: cycle.contact,
    )
    return float((law.depth(raised) - law.depth(cycle)).max() / step)
