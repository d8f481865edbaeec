"""Numbers of a contact model that an identification can fit, such as a work of adhesion."""

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
