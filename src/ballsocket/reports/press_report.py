"""Page of a press: verdict, results, sensitivity to tolerances, sources."""

from __future__ import annotations

from datetime import date

from ..compare import Comparison, successful_contacts
from ..contact import Contact
from ..contact.describe import number_text
from ..contact.verdict import assess_strength
from ..core.quantities import CONTACT
from ..core.sources import Source
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..studies.derivatives import LocalUncertainty
from ..studies.parameters import PARAMETERS
from . import press_plots
from .joint_report import joint_report
from .pages import render_part, svg_address
from .unit_systems import Units

_TEMPLATE = "press.html"
_VERDICT_STYLES = {True: "holds", False: "fails", None: "nearly"}
"""Style of a verdict by whether the liner bears the load; None if that is unknown."""


def press_report(
    comparison: Comparison,
    file: JointFile,
    leading: str,
    units: Units = Units.SI,
    surroundings: LocalUncertainty | None = None,
    day: date | None = None,
) -> str:
    """Return the page of single contacts of one joint as HTML.

    Parameters
    ----------
    comparison : Comparison
    file : JointFile
        Joint with its cup and load.
    leading : str
        Name of the model whose contact gets the verdict; the exact one if there is one.
    units : Units
        Units of every number.
    surroundings : LocalUncertainty, optional
        Sensitivity of the results to each number and to the tolerances.
    day : date, optional
        Date of the page; by default today.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    contact = comparison[leading]
    answers, *more = press_sections(comparison, units, surroundings).items()
    drawn = ("figures", ("Pressure and force", _figures(comparison, contact)))
    return joint_report(file, dict([answers, drawn, *more]), press_lede(contact, units), units, contact, day)


def press_lede(contact: Contact, units: Units = Units.SI) -> str:
    """Return the largest pressure of a contact with the verdict in words, as HTML."""
    verdict = assess_strength(contact)
    pressure, load = (_number(contact, name, units) for name in ("max_pressure", "force"))
    model, kind = contact.model.name, _VERDICT_STYLES[verdict.bears]
    return render_part(_TEMPLATE, "lede", pressure, load, model, verdict.words, kind)


def press_sections(
    comparison: Comparison, units: Units = Units.SI, surroundings: LocalUncertainty | None = None
) -> dict[str, tuple[str, str]]:
    """Return the sections of a press without its figures: title and HTML by id."""
    return {
        "answers": ("Results", _results(comparison, units)),
        "tolerances": ("Sensitivity and tolerances", _tolerances(surroundings, units)),
        "sources": ("Sources", _sources(comparison)),
    }


def _number(contact: Contact, name: str, units: Units) -> str:
    """Write a quantity of a contact with its unit."""
    column = next(column for column in units.columns if column.attribute == name)
    return f"{number_text(column.values_of(contact), 4, 'no result')} {column.unit}"


def _results(comparison: Comparison, units: Units) -> str:
    """Return the table of results by model with the notes, as HTML."""
    columns = units.columns
    rows = [
        (
            name,
            *(number_text(column.values_of(contact), 4, "-") for column in columns),
            "yes" if contact.valid else "no",
        )
        for name, contact in comparison.items()
    ]
    heads = ("model", *(column.head for column in columns), "valid")
    symbols = ", ".join(f"{column.symbol} {column.title}" for column in columns)
    return render_part(_TEMPLATE, "answers", heads, rows, symbols, comparison.notes())


def _figures(comparison: Comparison, leading: Contact) -> str:
    """Return the figure of the curves as HTML; for a contact off the cup's axis the pressure map of the cup."""
    contacts = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else successful_contacts(comparison)
    drawable = contacts and not leading.status.failed
    return render_part(_TEMPLATE, "figures", svg_address(press_plots.plot(contacts)) if drawable else None)


def _tolerances(surroundings: LocalUncertainty | None, units: Units) -> str:
    """Return elasticities and the bands of the tolerances as HTML."""
    if surroundings is None:
        return render_part(_TEMPLATE, "tolerances", None, ())
    names = list(next(iter(surroundings.changes.values())))
    rows = [
        (CONTACT[name].title, *(f"{changes[name]:+.2f}" for name in names))
        for name, changes in surroundings.changes.items()
    ]
    heads = ("change in % if 1 % is added to the", *(PARAMETERS[name].title for name in names))
    ends = [
        (CONTACT[name].title, *(units.text_of(CONTACT[name], end) for end in band))
        for name, band in surroundings.band.items()
    ]
    return render_part(_TEMPLATE, "tolerances", {"heads": heads, "rows": rows}, ends)


def _sources(comparison: Comparison) -> str:
    """Return the list of sources as HTML."""
    return render_part(_TEMPLATE, "sources", map(_source_text, comparison.sources))


def _source_text(source: Source) -> str:
    """Write a source with its DOI."""
    return f"{source}, doi {source.doi}" if source.doi else str(source)
