"""Kinds of unknowns: numbers of a contact model, and errors of a machine that add to the indentations it reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from ..contact import Model
from ..core.arrays import Array
from ..core.kinds import Kind, Unit
from ..core.quantities import Quantity
from ..models.adhesion import AdhesiveSocket

Effect = Callable[[Array, Array], Array]
"""Function from the force (N) and the number of the reading to a factor on the size of an error."""


@dataclass(frozen=True, kw_only=True)
class ModelNumber:
    """Parameter of a contact model that can be an unknown, such as the work of adhesion.

    Attributes
    ----------
    quantity : Quantity
        Name, symbol, title, unit and allowed range of the number.
    models : tuple of type
        Classes of models that have this number.
    insert : callable or None
        Function from a model and a value (number or array) to the model with that value. By default the field with
        the name of the quantity is replaced.
    """

    quantity: Quantity
    models: tuple[type[Model], ...]
    insert: Callable[[Any, Array], Model] | None = None

    @property
    def name(self) -> str:
        """Name of the model parameter, such as "work_of_adhesion"."""
        return self.quantity.name

    def belongs_to(self, model: Model) -> bool:
        """Check if a contact model, or the model inside a wrapper, has this parameter."""
        inner = _wrapped_model(model)
        return isinstance(model, self.models) if inner is None else self.belongs_to(inner)

    def insert_into(self, model: Model, value: Array) -> Model:
        """Return a copy of a contact model with another value of this parameter."""
        inner = _wrapped_model(model)
        if inner is not None:
            wrapper: Any = model
            wrapped: Model = replace(wrapper, model=self.insert_into(inner, value))
            return wrapped
        if self.insert is not None:
            return self.insert(model, value)
        changes: Any = {self.name: value}
        changed: Model = replace(model, **changes)  # type: ignore[type-var]
        return changed


def _wrapped_model(model: Model) -> Model | None:
    """Return the model inside a wrapper, such as a model in a cup; None without a wrapper."""
    inner = getattr(model, "model", None)
    return inner if isinstance(inner, Model) else None


WORK_OF_ADHESION = ModelNumber(
    quantity=Quantity(
        "work_of_adhesion",
        "w",
        "work of adhesion",
        Kind.SURFACE_ENERGY,
        "Energy per area that separates ball and liner.",
        Unit("J/m²", 1e3),
        allows=lambda value: (value >= 0) & (value < inf),
        allowed="a work of adhesion (N/mm) is 0 or more and finite",
    ),
    models=(AdhesiveSocket,),
)
"""Work of adhesion of the adhesive socket."""


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
