"""`contact.plot()` and `comparison.plot()`: what was pressed, pressed on for its curve, and drawn; or in its cup."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..compare import answered, force_curves
from ..contact import Contact
from ..sphere.contact import OffAxisContact
from .cup_plot import cup_figure
from .press_plot import press_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plot(contacts: Mapping[str, Contact]) -> Figure:
    """The pressure over the angle of single contacts, beside the force over the indentation.

    A contact off the cup's axis that is alone is drawn in its cup.

    Raises
    ------
    ValueError
        More than one contact of a model, or none that has an answer.
    """
    for contact in contacts.values():
        shape = tuple(getattr(contact.indentation, "shape", ()))
        if shape:
            many = " x ".join(map(str, shape))
            raise ValueError(f"a plot shows one contact of a model, and here are {many}: a study draws many")
    shown = answered(contacts)
    if not shown:
        raise ValueError("there is nothing to draw: no model has an answer")
    alone = next(iter(shown.values())) if len(shown) == 1 else None
    if isinstance(alone, OffAxisContact) and alone.indentation > 0:
        return cup_figure(alone)
    models: Any = {name: contact.model for name, contact in shown.items()}
    return press_figure(shown, force_curves(shown, models))
