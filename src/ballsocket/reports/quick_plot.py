"""`contact.plot()` and `comparison.plot()`: what was pressed, pressed on for its curve, and drawn; or in its cup."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..catalogue import reference
from ..compare import force_curves, successful_contacts
from ..contact import Contact
from ..elasticity.off_axis.contact import OffAxisContact
from .cup_plot import cup_figure
from .press_plot import press_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


MOST = 7
"""Curves that can be told from each other in one figure."""


def plot(contacts: Mapping[str, Contact]) -> Figure:
    """The pressure over the angle of single contacts, beside the force over the indentation.

    A contact off the cup's axis that is alone is drawn in its cup. Of many models at most `MOST` are drawn, and the
    others named.

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
    shown = successful_contacts(contacts)
    if not shown:
        raise ValueError("there is nothing to draw: no model has an answer")
    alone = next(iter(shown.values())) if len(shown) == 1 else None
    if isinstance(alone, OffAxisContact) and alone.max_pressure > 0:
        return cup_figure(alone)
    kept = telling(shown)
    models: Any = {name: contact.model for name, contact in kept.items()}
    return press_figure(kept, force_curves(kept, models), note=_left_out(shown, kept))


def telling(contacts: Mapping[str, Contact]) -> dict[str, Contact]:
    """At most `MOST` of the contacts: those that can be trusted first, and none that lies on the exact one."""
    if len(contacts) <= MOST:
        return dict(contacts)
    exact = contacts.get(reference.name)
    apart = [name for name, contact in contacts.items() if exact in (None, contact) or not _same(contact, exact)]
    first = sorted(apart, key=lambda name: not contacts[name].valid)[:MOST]
    return {name: contact for name, contact in contacts.items() if name in first}


def _same(contact: Contact, exact: Contact) -> bool:
    """Whether two curves would lie on each other."""
    ratios = [getattr(contact, name) / getattr(exact, name) for name in ("force", "indentation", "max_pressure")]
    return all(abs(ratio - 1) < 1e-3 for ratio in ratios)


def _left_out(shown: Iterable[str], kept: Mapping[str, Contact]) -> str:
    names = [name for name in shown if name not in kept]
    return f"not drawn: {', '.join(names)}" if names else ""
