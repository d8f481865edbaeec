"""One joint, one load, every model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape
from importlib import import_module
from math import inf, radians
from typing import TYPE_CHECKING, Any

import numpy

from .catalogue import catalogue, reference
from .contact import Contact, Model
from .contact.describe import COLUMNS, UTILISATION, UTILISATION_NOTE, count_text, number_text
from .core.arrays import Array, to_list, where
from .core.checks import nearest, needs, reject_unnamed_loads, select_load, shown
from .core.quantities import HEADLINE
from .core.sources import Source
from .core.validity import OutsideDomainError
from .problem import Joint
from .problem.cup import Cup
from .version import __version__

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Comparison(Mapping[str, Contact]):
    """Contacts by the name of the model, and for the models that have no answer the reason.

    Prints as a table of one row a model, with the reasons why models are not valid here.
    """

    joint: Joint
    contacts: dict[str, Contact]
    missing: dict[str, str]

    def __getitem__(self, name: str) -> Contact:
        if name in self.missing:
            raise KeyError(self.missing[name])
        if name not in self.contacts:
            raise KeyError(f"model {shown(name)} was not asked{nearest(name, self.contacts)}")
        return self.contacts[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.contacts)

    def __len__(self) -> int:
        return len(self.contacts)

    @property
    def sources(self) -> tuple[Source, ...]:
        """Where the formulas of all models that answered come from."""
        listed = [source for contact in self.contacts.values() for source in getattr(contact.model, "sources", ())]
        return tuple(dict.fromkeys(listed))

    def notes(self) -> list[str]:
        """Why models are outside their validity or have no answer: each reason once, with its models."""
        holders: dict[str, list[str]] = {}
        for name, contact in self.contacts.items():
            for note in contact.notes:
                holders.setdefault(note, []).append(name)
        return [f"{', '.join(names)}: {note}" for note, names in holders.items()] + list(self.missing.values())

    def deviation(self, name: str) -> dict[str, Array] | None:
        """How far a model is from the exact answer, relative, by column and of the contact's shape.

        None without an exact answer.
        """
        exact = self.contacts.get(reference.name)
        if exact is None or name == reference.name or name not in self.contacts:
            return None
        contact = self.contacts[name]
        return {column.name: relative_deviation(column.of(contact), column.of(exact)) for column in COLUMNS}

    def rows(self) -> list[tuple[str, ...]]:
        """Text for a table: model, force, indentation, half angle, max pressure, area, stiffness, valid."""
        return [
            (name, *(number_text(column.of(contact), 5, "-") for column in _SHOWN), count_text(contact.valid))
            for name, contact in self.contacts.items()
        ]

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON: version, joint and results, in mm, N, MPa, degrees."""
        answers = [{**self[name].summary(), "deviation": _listed(self.deviation(name))} for name in self]
        gaps = dict.fromkeys([*(column.name for column in (*COLUMNS, UTILISATION)), UTILISATION_NOTE])
        missing = [
            {"model": name, **gaps, "valid": False, "notes": [why], "deviation": None}
            for name, why in self.missing.items()
        ]
        return {"version": __version__, "joint": self.joint.summary(), "results": [*answers, *missing]}

    def to_frame(self) -> pandas.DataFrame:
        """A row a model and point, by the name of the model; columns end in their units, the last has the notes.

        Raises
        ------
        ImportError
            pandas is not installed.
        """
        needs("study", "pandas")
        import pandas

        told = {name: contact.to_frame().assign(notes="; ".join(contact.notes)) for name, contact in self.items()}
        told |= {name: pandas.DataFrame({"valid": [False], "notes": [why]}) for name, why in self.missing.items()}
        whole = pandas.concat(told, names=["model"])
        return whole.droplevel(1) if all(len(each) == 1 for each in told.values()) else whole

    def plot(self) -> Figure:
        """The pressure over the angle beside the force over the indentation, of all models that have an answer.

        Raises
        ------
        ValueError
            More than one contact a model, or none that has an answer.
        """
        # as in `Contact.plot`
        made: Figure = import_module("ballsocket.output.quick_plot").plot(self.contacts)
        return made

    def __repr__(self) -> str:
        table = [COLUMN_HEADS, *self.rows()]
        widths = [max(len(row[i]) for row in table) for i in range(len(COLUMN_HEADS))]
        lines = [
            "  ".join(text.ljust(width) if i == 0 else text.rjust(width) for i, (text, width) in enumerate(pairs))
            for pairs in (list(zip(row, widths, strict=True)) for row in table)
        ]
        return "\n".join([str(self.joint), *lines, *self.notes()])

    def _repr_html_(self) -> str:
        cells = "".join(f"<th>{escape(text)}</th>" for text in COLUMN_HEADS)
        rows = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in row) + "</tr>" for row in self.rows())
        notes = "".join(f"<div>{escape(reason)}</div>" for reason in self.notes())
        return f"<div>{escape(str(self.joint))}</div><table><tr>{cells}</tr>{rows}</table>{notes}"


def relative_deviation(value: Array, truth: Array) -> Array:
    """value/truth - 1: 0 where they are equal, NaN where the truth is 0, infinite or not known."""
    known = (truth > -inf) & (truth < inf) & (truth != 0)
    return where(truth == value, 0.0, where(known, value / where(known, truth, 1.0) - 1, float("nan")))


def _listed(deviation: dict[str, Array] | None) -> dict[str, Any] | None:
    return None if deviation is None else {name: to_list(value) for name, value in deviation.items()}


_SHOWN = tuple(column for column in COLUMNS if column.attribute in HEADLINE)
COLUMN_HEADS = ("model", *(column.head for column in _SHOWN), "valid")
"""Heads of the columns of `Comparison.rows`."""


def compare(
    joint: Joint,
    *unnamed: Any,
    force: Array | None = None,
    indentation: Array | None = None,
    half_angle: Array | None = None,
    models: Mapping[str, Model] | None = None,
    cup: Cup | None = None,
) -> Comparison:
    """Press one joint by every model.

    Parameters
    ----------
    joint : Joint
    force, indentation, half_angle : float or array
        Exactly one, in N, mm or rad.
    models : mapping of str to Model, optional
        By default the whole catalogue.
    cup : Cup, optional
        What the socket ends as; models that know no cups are then not trusted near its rim.

    Returns
    -------
    Comparison
        A mapping from name to `Contact`; a model without any answer for the joint is in `missing`, with the reason.

    Raises
    ------
    ValueError
        A load that is not allowed.
    TypeError
        A load without its name; models that are no mapping.

    Examples
    --------
    >>> import ballsocket as bs
    >>> answers = bs.compare(bs.joints["hess-forsbach"], force=3000.0)
    >>> round(answers["bartel"].max_pressure, 3)
    11.717
    """
    reject_unnamed_loads(unnamed)
    if not (models is None or isinstance(models, Mapping)):
        raise TypeError(f"models must be a mapping such as {{'exact': bs.Exact()}}, got {shown(models)}")
    for name, model in ({} if models is None else models).items():
        if isinstance(model, type) or not hasattr(model, "press"):
            raise TypeError(f"models[{name!r}] must be a model, such as bs.Exact(), got {shown(model)}")
    kind, load = select_load(force=force, indentation=indentation, half_angle=half_angle)
    keyword: dict[str, Any] = {kind: load}
    contacts, missing = {}, {}
    for name, model in (catalogue if models is None else models).items():
        try:
            contacts[name] = (model if cup is None else model.in_cup(cup)).press(joint, **keyword)
        except OutsideDomainError as error:
            missing[name] = str(error)
    return Comparison(joint, contacts, missing)


def successful_contacts(comparison: Mapping[str, Contact]) -> dict[str, Contact]:
    """The contacts of models that have an answer."""
    return {name: contact for name, contact in comparison.items() if not contact.status.failed}


THIN_LINER_RATIO = 12.0
"""R2/L from which a model that solves for its answer takes seconds over a curve."""

_SOLVES, _MESHES = 1e-3, 0.1  # s a press, from which a model solves or makes a mesh for its answer
_MANY = numpy.linspace(0.0, 1.0, 121) ** 2
_FEW = numpy.append(0.0, numpy.linspace(0.15, 1.0, 18) ** 2)  # each class of contacts takes a mesh
_DOZEN, _WIDEST = numpy.linspace(0.0, 1.0, 12), radians(84.9)


def is_slow(model: Model, joint: Joint) -> bool:
    """Whether many presses of a joint of plain numbers take seconds: the thinner a liner, the more is to be summed."""
    return model.seconds_a_press > _SOLVES and float(joint.thickness_ratio) > THIN_LINER_RATIO


def short_curve(contact: Contact, model: Model) -> Contact:
    """A dozen contacts from first touch to a little beyond one, by half angles: no load has to be searched for."""
    widest = min(1.15 * float(contact.half_angle), _WIDEST)
    return model.press(contact.joint, half_angle=widest * _DOZEN)


def force_curves(contacts: Mapping[str, Contact], models: Mapping[str, Model]) -> dict[str, Contact]:
    """From first touch to a little beyond the deepest of some contacts: each pressed on by its own model.

    Parameters
    ----------
    contacts : mapping of str to Contact
        One contact of plain numbers each.
    models : mapping of str to Model
        By the same names.

    Returns
    -------
    dict of str to Contact
        Contacts of a 1-D array of indentations; those that take long are a dozen, and end beyond their own contact.
    """
    deepest = 1.15 * max(contact.indentation for contact in contacts.values())

    def curve(contact: Contact, model: Model) -> Contact:
        if model.seconds_a_press > _MESHES:
            return model.press(contact.joint, indentation=deepest * _FEW)
        if is_slow(model, contact.joint):
            return short_curve(contact, model)
        return model.press(contact.joint, indentation=deepest * _MANY)

    return {name: curve(contact, models[name]) for name, contact in contacts.items()}
