"""A press as one page to send: verdict, answers, tolerances, sources."""

from __future__ import annotations

from datetime import date
from html import escape

from ..compare import Comparison, successful_contacts
from ..contact import Contact
from ..contact.describe import number_text
from ..contact.verdict import assess_strength
from ..core.quantities import CONTACT
from ..core.sources import Source
from ..elasticity.off_axis.contact import OffAxisContact
from ..files.joint_file import JointFile
from ..studies.local_uncertainty import LocalUncertainty
from ..studies.parameters import PARAMETERS
from . import html, quick_plot
from .joint_report import joint_report
from .unit_systems import Units

_CLASSES = {True: "holds", False: "fails", None: "nearly"}


def press_report(
    comparison: Comparison,
    file: JointFile,
    leading: str,
    units: Units = Units.SI,
    surroundings: LocalUncertainty | None = None,
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
    surroundings : LocalUncertainty, optional
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
    said = assess_strength(contact)
    pressure, load = (escape(_number(contact, name, units)) for name in ("max_pressure", "force"))
    told = f"<strong>{pressure}</strong> largest pressure under {load}, by {escape(contact.model.name)}"
    return f"<p>{told}: <span class='{_CLASSES[said.bears]}'>{escape(said.words)}.</span></p>"


def press_sections(
    comparison: Comparison, units: Units = Units.SI, surroundings: LocalUncertainty | None = None
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
    meant = ", ".join(f"{column.symbol} {column.title}" for column in columns)
    notes = "".join(f"<p class='quiet'>{escape(note)}</p>" for note in comparison.notes())
    return f"{html.table(heads, rows)}<p class='quiet'>{escape(meant)}</p>{notes}"


def _curves(comparison: Comparison, leading: Contact) -> str:
    """The curves; the cup seen from its opening for a contact beside its axis."""
    shown = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else successful_contacts(comparison)
    if not shown or leading.status.failed:
        return "<p>There is nothing to draw.</p>"
    return html.picture(html.drawn(quick_plot.plot(shown), "svg"), "pressure and force", form="svg+xml")


def _around(found: LocalUncertainty | None, units: Units) -> str:
    """Elasticities, and the band of the tolerances."""
    if found is None:
        return "<p>Not asked for.</p>"
    names = list(next(iter(found.changes.values())))
    rows = [(CONTACT[asked].title, *(f"{each[name]:+.2f}" for name in names)) for asked, each in found.changes.items()]
    heads = ("changes by %, where 1 % is added to the", *(PARAMETERS[name].title for name in names))
    text = html.table(heads, rows)
    if not found.band:
        return text + "<p class='quiet'>No tolerances were given.</p>"
    ends = [
        (CONTACT[asked].title, *(units.told(CONTACT[asked], end) for end in band)) for asked, band in found.band.items()
    ]
    return text + html.table(("95 % of the joints within the tolerances lie", "above", "half above", "below"), ends)


def _sources(comparison: Comparison) -> str:
    return "<ul>" + "".join(f"<li>{escape(_told(source))}</li>" for source in comparison.sources) + "</ul>"


def _told(source: Source) -> str:
    return f"{source}, doi {source.doi}" if source.doi else str(source)
