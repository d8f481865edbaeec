"""Comparison of models: one joint and one load, pressed by each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from math import inf, nan, radians
from typing import TYPE_CHECKING, Any

import numpy

from .contact import Contact, Model
from .contact.describe import PRESSURE_RATIO, UTILISATION, UTILISATION_NOTE, count_text, number_text, values_of
from .core.arrays import Array, to_list, where
from .core.checks import nearest, needs, reject_unnamed_loads, select_load, shown
from .core.display import html_table, load_plot
from .core.quantities import CONTACT, HEADLINE
from .core.sources import Source
from .core.unit_systems import Sentence, holders_of
from .core.validity import OutsideDomainError
from .model_catalogue import catalogue, reference
from .problem import Joint
from .problem.cup import DEFAULT_CUP, Cup
from .version import __version__

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Comparison(Mapping[str, Contact]):
    """Contacts of several models for one joint and load, by the name of the model.

    Prints as a table of one row per model, with the reasons why models are invalid for this contact.

    Attributes
    ----------
    joint : Joint
    contacts : dict of str to Contact
    missing : dict of str to str
        Reason for each model whose domain excludes the joint.
    """

    joint: Joint
    contacts: dict[str, Contact]
    missing: dict[str, str]

    def __getitem__(self, name: str) -> Contact:
        if name in self.missing:
            raise KeyError(self.missing[name])
        if name not in self.contacts:
            raise KeyError(f"model {shown(name)} is not in this comparison{nearest(name, self.contacts)}")
        return self.contacts[name]

    def __contains__(self, name: object) -> bool:
        return name in self.contacts

    def __iter__(self) -> Iterator[str]:
        return iter(self.contacts)

    def __len__(self) -> int:
        return len(self.contacts)

    @property
    def sources(self) -> tuple[Source, ...]:
        """Publications of the formulas of all compared models, without duplicates."""
        listed = [source for contact in self.contacts.values() for source in getattr(contact.model, "sources", ())]
        return tuple(dict.fromkeys(listed))

    def notes(self) -> list[str]:
        """List the notes of all contacts with their models, and the reasons of missing models, without duplicates."""
        holders = holders_of((name, contact.notes) for name, contact in self.contacts.items())
        noted = [Sentence("{}: {}", ", ".join(names), note) for note, names in holders.items()]
        return [*noted, *self.missing.values()]

    def deviation(self, name: str) -> dict[str, Array] | None:
        """Compute the relative deviations of a model from the exact solution.

        Returns
        -------
        dict of str to array, or None
            Deviation of each quantity by its key in JSON, of the shape of the contact. None for the exact model
            itself, for a missing model, and in a comparison without the exact model.
        """
        return self._deviations.get(name)

    @cached_property
    def _deviations(self) -> dict[str, dict[str, Array]]:
        exact = self.contacts.get(reference.name)
        if exact is None:
            return {}
        truths = {quantity: values_of(exact, quantity) for quantity in CONTACT.values()}
        return {
            name: {
                quantity.key: relative_deviation(values_of(contact, quantity), truth)
                for quantity, truth in truths.items()
            }
            for name, contact in self.contacts.items()
            if name != reference.name
        }

    def rows(self) -> list[tuple[str, ...]]:
        """Format the table rows, one per model, with the columns of `COLUMN_HEADS`."""
        return [
            (name, *(number_text(values_of(contact, column), 5, "-") for column in _SHOWN), count_text(contact.valid))
            for name, contact in self.contacts.items()
        ]

    def summary(self) -> dict[str, Any]:
        """Return a dictionary of the comparison for JSON, in N, mm, MPa and degrees."""
        results = []
        for name, contact in self.contacts.items():
            deviation = self.deviation(name)
            lists = None if deviation is None else {key: to_list(value) for key, value in deviation.items()}
            results.append({**contact.summary(), "deviation": lists})
        numbers = (*CONTACT.values(), UTILISATION, PRESSURE_RATIO)
        gaps = dict.fromkeys([*(quantity.key for quantity in numbers), UTILISATION_NOTE])
        missing = [
            {"model": name, **gaps, "valid": False, "notes": [why], "deviation": None}
            for name, why in self.missing.items()
        ]
        return {"version": __version__, "joint": self.joint.summary(), "results": [*results, *missing]}

    def to_frame(self) -> pandas.DataFrame:
        """Return a pandas data frame with one row per model and point.

        Column names end in units; the last column has the notes.

        Raises ImportError: pandas is not installed.
        """
        needs("study", "pandas")
        import pandas

        frames = {name: contact.to_frame().assign(notes="; ".join(contact.notes)) for name, contact in self.items()}
        frames |= {name: pandas.DataFrame({"valid": [False], "notes": [why]}) for name, why in self.missing.items()}
        table = pandas.concat(frames, names=["model"])
        return table.droplevel(1) if all(len(frame) == 1 for frame in frames.values()) else table

    def plot(self) -> Figure:
        """Plot pressure over angle and force over indentation of all models that have a result.

        Raises ValueError: more than one contact per model, or no model with a result.
        """
        figure: Figure = load_plot("contacts")(self.contacts)
        return figure

    def __repr__(self) -> str:
        table = [COLUMN_HEADS, *self.rows()]
        widths = [max(len(row[i]) for row in table) for i in range(len(COLUMN_HEADS))]
        lines = [
            "  ".join(text.ljust(width) if i == 0 else text.rjust(width) for i, (text, width) in enumerate(pairs))
            for pairs in (list(zip(row, widths, strict=True)) for row in table)
        ]
        return "\n".join([str(self.joint), *lines, *self.notes()])

    def _repr_html_(self) -> str:
        notes = "".join(f"<div>{escape(reason)}</div>" for reason in self.notes())
        return f"<div>{escape(str(self.joint))}</div>{html_table(COLUMN_HEADS, self.rows())}{notes}"


def relative_deviation(value: Array, truth: Array) -> Array:
    """Compute value/truth - 1: 0 where both are equal, else NaN where the truth is 0, infinite or NaN."""
    known = (truth > -inf) & (truth < inf) & (truth != 0)
    return where(truth == value, 0.0, value / where(known, truth, nan) - 1)


_SHOWN = tuple(CONTACT[name] for name in HEADLINE)
COLUMN_HEADS = ("model", *(quantity.head(quantity.written) for quantity in _SHOWN), "valid")
"""Heads of the columns of `Comparison.rows`: model, the quantities of `HEADLINE` with units, and valid."""


def compare(
    joint: Joint,
    *unnamed: Any,
    force: Array | None = None,
    indentation: Array | None = None,
    half_angle: Array | None = None,
    models: Mapping[str, Model] | Sequence[Model | str] | None = None,
    cup: Cup | None = None,
    **aim: Any,
) -> Comparison:
    """Compute the contact of one joint and load with several models.

    Parameters
    ----------
    joint : Joint
    force, indentation, half_angle : float or array
        Exactly one of them, in N, mm or rad.
    models : mapping of str to Model, or list of Model or str, optional
        Models by name, or models and names of the catalogue; all models of the catalogue by default.
    cup : Cup, optional
        Rim of the socket. Models without a rim are then invalid near it.
    **aim
        Direction of the load in the cup, as of `Model.in_cup`: `direction` or `tilt`.

    Returns
    -------
    Comparison
        A mapping from name to `Contact`. Models whose domain excludes the joint are in `missing`, with the reason.

    Raises
    ------
    ValueError
        A load that is not allowed; two models of one name in a list.
    TypeError
        A load without its name; `models` that is not a mapping or a list of models.

    Examples
    --------
    >>> import ballsocket as bs
    >>> answers = bs.compare(bs.joints["hess-forsbach"], force=3000.0)
    >>> round(answers["bartel"].max_pressure, 3)
    11.717
    """
    reject_unnamed_loads(unnamed)
    named = catalogue if models is None else _models_by_name(models)
    kind, load = select_load(force=force, indentation=indentation, half_angle=half_angle)
    keyword: dict[str, Any] = {kind: load}
    contacts, missing = {}, {}
    for name, model in named.items():
        try:
            placed = model.in_cup(cup or DEFAULT_CUP, **aim) if aim or cup is not None else model
            contacts[name] = placed.press(joint, **keyword)
        except OutsideDomainError as error:
            missing[name] = str(error)
    return Comparison(joint, contacts, missing)


def _models_by_name(models: Any) -> dict[str, Model]:
    """Return the models to compare by name, from a mapping or from a list of models and names of the catalogue."""
    if not isinstance(models, Mapping | list | tuple):
        raise TypeError(
            f"models must be a list such as [bs.Exact(), bs.Hertz()] or a mapping {{'exact': bs.Exact()}}, "
            f"got {shown(models)}"
        )
    if isinstance(models, Mapping):
        pairs = list(models.items())
    else:
        listed = [catalogue[model] if isinstance(model, str) else model for model in models]
        pairs = [(getattr(model, "name", number), model) for number, model in enumerate(listed)]
    for name, model in pairs:
        if isinstance(model, type) or not hasattr(model, "press"):
            raise TypeError(f"models[{name!r}] must be a model, such as bs.Exact(), got {shown(model)}")
    named = dict(pairs)
    if len(named) < len(pairs):
        names = [name for name, _ in pairs]
        double = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"two of the models are named {double!r}: use a mapping with two names")
    return named


def successful_contacts(comparison: Mapping[str, Contact]) -> dict[str, Contact]:
    """Select the contacts of one point that have a result."""
    return {name: contact for name, contact in comparison.items() if not contact.status.failed}


THIN_LINER_RATIO = 12.0  # R2/L above which a curve of a numerical model takes seconds
MAX_HALF_ANGLE = radians(84.9)  # largest half angle of a short curve in rad


def is_curve_slow(model: Model, joint: Joint) -> bool:
    """Check if a force curve of this model and joint takes seconds, as with thin liners."""
    return model.seconds_a_press > 1e-3 and float(joint.thickness_ratio) > THIN_LINER_RATIO


def press_short_curve(contact: Contact, model: Model) -> Contact:
    """Compute 12 contacts at half angles, which need no search for the load, up to 1.15 times that of a contact."""
    max_half_angle = min(1.15 * float(contact.half_angle), MAX_HALF_ANGLE)
    return model.press(contact.joint, half_angle=max_half_angle * numpy.linspace(0.0, 1.0, 12))


def force_curves(contacts: Mapping[str, Contact], models: Mapping[str, Model]) -> dict[str, Contact]:
    """Compute the force curve of each model, up to 1.15 times the largest indentation of some contacts.

    Contacts of one point each, and models, have the same names. The curves are contacts of a 1-D array of indentations;
    slow models have 12, up to 1.15 times their own half angle.
    """
    max_indentation = 1.15 * max(contact.indentation for contact in contacts.values())

    def curve(contact: Contact, model: Model) -> Contact:
        steps = numpy.linspace(0.0, 1.0, 121) ** 2
        if model.seconds_a_press > 0.1:  # it makes a mesh for each range: few steps
            steps = numpy.append(0.0, numpy.linspace(0.15, 1.0, 18) ** 2)
        elif is_curve_slow(model, contact.joint):
            return press_short_curve(contact, model)
        return model.press(contact.joint, indentation=max_indentation * steps)

    return {name: curve(contact, models[name]) for name, contact in contacts.items()}
