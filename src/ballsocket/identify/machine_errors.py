"""Errors of a machine that add to the indentations it reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..core.arrays import Array
from ..core.kinds import Kind, Unit
from ..core.quantities import Quantity

Effect = Callable[[Array, Array], Array]
"""Function from the force (N) and the number of the reading to a factor on the size of an error."""


@dataclass(frozen=True, kw_only=True)
class MachineError:
    """Type of machine error, such as an offset, that adds to each reading.

    A reading increases by the size of the error times `effect(force, order)`.

    Attributes
    ----------
    quantity : Quantity
        Name, symbol, title, unit and allowed range of the size.
    effect : callable
        Factor on the size from force (N) and number of the reading, such that the product is in mm.
    slope : callable or None
        Derivative of `effect` with respect to the force; None for an effect that does not depend on the force.
    assumed : float
        Size assumed for the sensitivity of estimates to this error, in the unit of the quantity.
    phrase : str
        Description in a note, with {} for the size: "a zero offset of {}".
    """

    quantity: Quantity
    effect: Effect
    slope: Effect | None = None
    assumed: float
    phrase: str

    @property
    def name(self) -> str:
        """Name of the error, such as "offset".

        It is also an argument of `Machine` and a key in files.
        """
        return self.quantity.name


COMPLIANCE = MachineError(
    quantity=Quantity(
        "compliance",
        "Cm",
        "compliance of the machine",
        Kind.COMPLIANCE,
        "Deformation of frame and fixtures per force.",
        Unit("µm/kN", 1e6),
        allows=lambda value: value >= 0,
        allowed="a machine's compliance (mm/N) is 0 or more",
    ),
    effect=lambda force, order: force,
    slope=lambda force, order: 1.0,
    assumed=1e-6,
    phrase="a compliance of {}",
)
"""Compliance of frame and fixtures; 1 µm/kN is assumed."""

OFFSET = MachineError(
    quantity=Quantity(
        "offset", "d0", "zero offset", Kind.LENGTH, "Indentation that is read at first touch.", Unit("µm", 1e3)
    ),
    effect=lambda force, order: 1.0,
    assumed=1e-3,
    phrase="a zero offset of {}",
)
"""Offset of the zero; 1 µm is assumed."""

DRIFT = MachineError(
    quantity=Quantity(
        "drift", "dd", "drift of the zero", Kind.LENGTH, "Change of the zero between two readings.", Unit("µm", 1e3)
    ),
    effect=lambda force, order: order,
    assumed=1e-4,
    phrase="a drift of {} per reading",
)
"""Drift of the zero; 0.1 µm per reading is assumed."""
