"""A press as one page to send: verdict, answers, tolerances, sources."""

from __future__ import annotations

from datetime import date

from ..compare import Comparison, successful_contacts
from ..contact import Contact
from ..contact.describe import number_text
from ..contact.verdict import assess_strength
from ..core.quantities import CONTACT
from ..core.sources import Source
from ..elasticity.off_axis.contact import OffAxisContact
from ..io.joint_file import JointFile
from ..studies.around import Around
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
    surroundings: Around | None = None,
    day: date | None = None,
) -> str:
    """The page of single contacts of one joint.

    Parameters
    ----------
    comparison : Comparison
    file : JointFile
        The joint with its cup and load.
    leading : str
        The name of the model that gives the verdict; the exact answer, where there is one, is best.
    units : Units
        Of every number.
    surroundings : Around, optional
        What a percent of each number and the tolerances do.
    day : date, optional
        By default today's.

    Returns
    -------
    str
        HTML that needs nothing beside it.
    """
    contact = comparison[leading]
    answers, *rest = press_sections(comparison, units, surroundings).items()
    drawn = ("figures", ("Pressure and force", _curves(comparison, contact)))
    return joint_report(file, dict([answers, drawn, *rest]), press_lede(contact, units), units, contact, day)


def press_lede(contact: Contact, units: Units = Units.SI) -> str:
    """The first number of a contact with the verdict in words, as HTML."""
    verdict = assess_strength(contact)
    pressure, load = (_number(contact, name, units) for name in ("max_pressure", "force"))
    model, kind = contact.model.name, _VERDICT_STYLES[verdict.bears]
    return render_part(_TEMPLATE, "lede", pressure, load, model, verdict.words, kind)


def press_sections(
    comparison: Comparison, units: Units = Units.SI, surroundings: Around | None = None
) -> dict[str, tuple[str, str]]:
    """What a press puts on a page, without its figures: by id a title and HTML."""
    return {
        "answers": ("Answers", _answers(comparison, units)),
        "tolerances": ("What tolerances do", _around(surroundings, units)),
        "sources": ("Sources", _sources(comparison)),
    }


def _number(contact: Contact, name: str, units: Units) -> str:
    column = next(column for column in units.columns if column.attribute == name)
    return f"{number_text(column.values_of(contact), 4, 'no answer')} {column.unit}"


def _answers(comparison: Comparison, units: Units) -> str:
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


def _curves(comparison: Comparison, leading: Contact) -> str:
    """The curves; the cup seen from its opening for a contact beside its axis."""
    shown = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else successful_contacts(comparison)
    drawable = shown and not leading.status.failed
    return render_part(_TEMPLATE, "figures", svg_address(press_plots.plot(shown)) if drawable else None)


def _around(found: Around | None, units: Units) -> str:
    """Elasticities, and the band of the tolerances."""
    if found is None:
        return render_part(_TEMPLATE, "tolerances", None, ())
    names = list(next(iter(found.changes.values())))
    rows = [(CONTACT[asked].title, *(f"{each[name]:+.2f}" for name in names)) for asked, each in found.changes.items()]
    heads = ("changes by %, where 1 % is added to the", *(PARAMETERS[name].title for name in names))
    ends = [
        (CONTACT[asked].title, *(units.told(CONTACT[asked], end) for end in band)) for asked, band in found.band.items()
    ]
    return render_part(_TEMPLATE, "tolerances", {"heads": heads, "rows": rows}, ends)


def _sources(comparison: Comparison) -> str:
    return render_part(_TEMPLATE, "sources", map(_source_text, comparison.sources))


def _source_text(source: Source) -> str:
    return f"{source}, doi {source.doi}" if source.doi else str(source)
