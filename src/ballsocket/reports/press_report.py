"""Pages of a joint, of a press, and of several designs side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from hashlib import sha256
from math import ceil, degrees, inf, isfinite
from pathlib import Path

from ..comparison import Comparison, successful_contacts
from ..contact import Contact
from ..contact.verdict import Verdict, error_bar, range_text, rim_verdict
from ..core.answers import Check, grid
from ..core.quantities import CONTACT, CUP, MATERIAL, QUANTITIES, STRESS_LIMITS
from ..core.unit_systems import Units
from ..core.validity import Status
from ..design_checks import checks_of, unchecked_text, verdict_of
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import polar_angle
from ..files.joint_file import JointFile, ReportDetails
from ..files.joint_toml import toml_of
from ..files.schema import Text
from ..press_answer import describe_press
from ..problem import Material
from ..problem.cup import Cup
from ..problem.presets import material_label
from ..studies.derivatives import LocalUncertainty
from ..studies.parameters import PARAMETERS
from ..studies.task import EDGE_DISTANCE
from ..studies.variance_shares import uncertainty_tables
from . import press_plots
from .joint_drawing import DrawnLoad, joint_svg
from .pages import (
    HEAD_TEXTS,
    answer_table,
    checks_html,
    data_address,
    letterhead,
    logo_address,
    render_page,
    render_part,
    svg_address,
    trusted_html,
)

_TEMPLATE = "press.html"
_ROUNDING = 1e-7  # relative size of a component of a force that is the rounding error of zero

_VERDICT_STYLES = {Verdict.KEPT: "holds", Verdict.UNDECIDED: "nearly", Verdict.EXCEEDED: "fails"}
"""Style of a verdict on the checks."""

_MAX_COLUMNS = 3  # designs beside each other in one table, which fits a printed page

_MAX_MODELS = 3  # models beside each other in one table, each with its deviations

TitledHtml = dict[str, tuple[str, str]]
"""Title and HTML of each section by its id."""


@dataclass(frozen=True, kw_only=True)
class PressedDesign:
    """Design of a report: a joint file with its results.

    Attributes
    ----------
    comparison : Comparison
        Contacts of one joint under one load.
    file : JointFile
        Joint with its cup and load.
    leading : str
        Name of the model whose contact gets the verdict.
    uncertainty : LocalUncertainty or None
        Sensitivity of the results to each number and to the tolerances.
    command : str
        Options of the command line that compute the results from the joint file.
    remarks : sequence of str
        Remarks on the computation, such as friction torques.
    """

    comparison: Comparison
    file: JointFile
    leading: str
    uncertainty: LocalUncertainty | None = None
    command: str = ""
    remarks: Sequence[str] = ()

    @property
    def contact(self) -> Contact:
        """Contact that gets the verdict."""
        return self.comparison[self.leading]

    @property
    def title(self) -> str:
        """Name of the joint, or a general one."""
        return self.file.joint.name or "A ball in its socket"


def designs_report(designs: Sequence[PressedDesign], units: Units = Units.SI, day: date | None = None) -> str:
    """Return the page of one design, or of several with a table that compares them, as HTML.

    Customer, project and author that differ are stated for each design.

    Raises ValueError: a logo that cannot be shown, or two designs with different logos.
    Raises OSError: a logo that cannot be read.
    """
    details = _common_details(designs)
    if len(designs) == 1:
        (design,) = designs
        lede = press_lede(design.contact, design.file.cup, units, design.uncertainty)
        return _page(design.title, _design_sections(design, units), details, day, lede)
    sections: TitledHtml = {"comparison": ("Comparison", _comparison(designs, units))}
    for number, design in enumerate(designs, 1):
        lede = press_lede(design.contact, design.file.cup, units, design.uncertainty)
        parts = [(title, trusted_html(html)) for title, html in _design_sections(design, units).values()]
        sections[f"design-{number}"] = (design.title, render_part(_TEMPLATE, "design", trusted_html(lede), parts))
    return _page(f"{len(designs)} designs", sections, details, day)


def _common_details(designs: Sequence[PressedDesign]) -> ReportDetails:
    """Return the head of the page of several designs; texts that differ stand with the name of their design.

    Raises ValueError: a logo that cannot be shown, or two designs with different logos.
    """

    def text_of(name: str) -> str:
        texts = [(text, design.title) for design in designs if (text := getattr(design.file.report, name))]
        if len({text for text, _ in texts}) < 2:
            return texts[0][0] if texts else ""
        return ", ".join(f"{text} ({title})" for text, title in texts)

    logos = dict.fromkeys(design.file.report.logo for design in designs if design.file.report.logo)
    if len({logo_address(Path(logo)) for logo in logos}) > 1:
        raise ValueError(f"the designs have different logos, {' and '.join(map(repr, logos))}; a report has one")
    return ReportDetails(**{name: Text(text_of(name)) for name in HEAD_TEXTS}, logo=next(iter(logos), None))


def _page(
    title: str, sections: TitledHtml, details: ReportDetails, day: date | None, lede: str = "", logo: str = ""
) -> str:
    head = letterhead(details, day) | ({"logo": logo} if logo else {})
    return render_page("joint_report.html", title, sections, lede=trusted_html(lede), **head)


def joint_report(
    file: JointFile,
    sections: Mapping[str, tuple[str, str]],
    lede: str = "",
    units: Units = Units.SI,
    contact: Contact | None = None,
    day: date | None = None,
    title: str = "",
    logo: str = "",
) -> str:
    """Return the page of a joint without axes as HTML that needs no other file.

    Below `lede`, which is HTML, the page has the checks of the contact, a drawing with its pressure, the inputs, the
    given sections (title and HTML by id), and the joint file. By default its date is today, its title the joint's
    name, and its logo that of the file; another one is given by its address.
    """
    everything = _joint_sections(file, dict(sections), units, contact)
    return _page(title or file.joint.name or "A ball in its socket", everything, file.report, day, lede, logo)


def _joint_sections(
    file: JointFile, sections: TitledHtml, units: Units, contact: Contact | None = None, command: str = ""
) -> TitledHtml:
    """Return the sections of a joint: checks, drawing, inputs, the given sections, and the joint file."""
    drawing = data_address(_drawing(file, contact, units), "svg+xml")
    text = toml_of(file)
    checksum = sha256(text.encode()).hexdigest()
    checked = () if contact is None else _checks(contact, file.cup)
    return {
        **({"checks": ("Checks", checks_html(checked, units.text_of))} if checked else {}),
        "drawing": ("Drawing", render_part(_TEMPLATE, "drawing", drawing, units.sentence(file.joint.diameters))),
        "inputs": ("Inputs", render_part(_TEMPLATE, "inputs", list(_inputs(file, units)))),
        **sections,
        "origin": ("Joint file", render_part(_TEMPLATE, "origin", text, checksum, command)),
    }


def _drawing(file: JointFile, contact: Contact | None, units: Units) -> bytes:
    """Draw the joint with its load, and with the pressure of a contact that has one."""
    if contact is None or contact.status.failed:
        return joint_svg(file, units=units)
    load = DrawnLoad(text=units.text_of(CONTACT["force"], float(contact.force)), tilt=file.tilt)
    return joint_svg(file, contact, 0.0 if file.tilt else float(contact.half_angle), load, units)


def _design_sections(design: PressedDesign, units: Units) -> TitledHtml:
    contact = design.contact
    answers, *more = press_sections(design.comparison, units, design.uncertainty, design.remarks, contact).items()
    figures = "figures", ("Pressure and force", _figures(design.comparison, contact, units))
    return _joint_sections(design.file, dict([answers, figures, *more]), units, contact, design.command)


def _inputs(file: JointFile, units: Units) -> Iterator[tuple[str, str, str]]:
    """Yield title, value and source of each input."""
    joint, (fit, radial_fit) = file.joint, file.joint.fit
    yield "head diameter", units.length(2 * float(joint.ball_radius)), joint.source
    yield "bore diameter", units.length(2 * float(joint.socket_radius)), ""
    yield f"diametral {fit}", units.length(2 * float(radial_fit)), f"twice the radial {fit}"
    yield "liner thickness", units.length(float(joint.liner_thickness)), ""
    yield "liner", _material(joint.liner, units), joint.liner.source
    yield "ball", "rigid" if joint.ball is None else _material(joint.ball, units), getattr(joint.ball, "source", "")
    for number, layer in enumerate(joint.backing, 1):
        material = layer.material
        yield (
            f"backing {number}",
            f"{units.length(float(layer.thickness))} of {_material(material, units)}",
            material.source,
        )
    yield "outermost surface", joint.support.value, ""
    yield from _cup(file.cup, units)
    for name, angle in file.aim.items():
        if name == "tilt":
            yield PARAMETERS[name].title, units.text_of(PARAMETERS[name], float(angle)), "between load and cup's axis"
        else:
            parts = ", ".join(f"{part:.4g}" for part in angle)
            yield "direction of the load", parts, f"{_DIRECTION}: components to the right, to the front and up"
    if not file.aim and file.cup.oriented:
        yield "direction of the load", "0, 0, 1", f"{_DIRECTION}: straight up"
    for name, value in file.load.items():
        yield PARAMETERS[name].title, units.text_of(PARAMETERS[name], float(value)), ""


_DIRECTION = "in which the ball pushes into the cup, in the body"  # meaning of the direction of a load


def _material(material: Material, units: Units) -> str:
    values = {MATERIAL[name]: getattr(material, name) for name in ("young", "poisson")}
    values |= {STRESS_LIMITS[name]: limit for name, limit in material.stress_limits.items()}
    numbers = (f"{quantity.title} {units.text_of(quantity, float(number))}" for quantity, number in values.items())
    return f"{material_label(material, 'a material')}: {', '.join(numbers)}"


_ORIENTATION = ("inclination", "anteversion")  # angles of a cup in the body


def _cup(cup: Cup, units: Units) -> Iterator[tuple[str, str, str]]:
    """Yield title and value of each dimension of the cup."""
    for name, quantity in CUP.items():
        if name in _ORIENTATION and not cup.oriented:
            continue
        number = float(getattr(cup, name))
        yield quantity.title, units.text_of(quantity, number), ""
    yield "liner on its backing", cup.interface.value, ""


def press_lede(contact: Contact, cup: Cup, units: Units = Units.SI, uncertainty: LocalUncertainty | None = None) -> str:
    """Return the largest pressure of a contact with the verdict on its checks and its place at the rim, as HTML."""
    pressure, load = (_number(contact, name, units) for name in ("max_pressure", "force"))
    verdict, kind = _verdict(contact, cup)
    remarks = [*filter(None, [unchecked_text(_checks(contact, cup))]), *_rim_words(contact, units, uncertainty)]
    return render_part(_TEMPLATE, "lede", pressure, load, contact.model.name, (verdict, kind), remarks)


def _checks(contact: Contact, cup: Cup) -> tuple[Check, ...]:
    """List the checks of a contact with the von Mises stress of its own model."""
    return checks_of(contact, cup, float(contact.von_mises))


def _verdict(contact: Contact, cup: Cup) -> tuple[str, str]:
    """Return the verdict on the checks of a contact in one sentence, and its style."""
    checks = _checks(contact, cup)
    if contact.status.failed and not checks:
        return f"Undecided: {contact.status.sentence}", _VERDICT_STYLES[Verdict.UNDECIDED]
    verdict, sentence = verdict_of(checks)
    return sentence, _VERDICT_STYLES[verdict]


def _rim_words(contact: Contact, units: Units, uncertainty: LocalUncertainty | None = None) -> list[str]:
    """Describe the place of a contact at the rim of its cup; empty for a contact along the axis."""
    if not isinstance(contact, OffAxisContact) or contact.status.failed:
        return []
    verdict, sentence = rim_sentence(contact, units)
    least = uncertainty.band.get(EDGE_DISTANCE, (inf,))[0] if uncertainty else inf
    possible = verdict is Verdict.KEPT and least <= 0
    return [sentence, *(["edge loading is possible within the tolerances"] if possible else [])]


def rim_sentence(contact: OffAxisContact, units: Units) -> tuple[Verdict, str]:
    """Judge the place of a contact at the rim of its cup, in one sentence."""
    verdict = rim_verdict(contact)
    if contact.status.failed:
        dislocated = contact.status is Status.DISLOCATED
        return Verdict.EXCEEDED if dislocated else Verdict.UNDECIDED, f"no contact: {contact.status.sentence}"
    if not contact.half_angle > 0:
        return Verdict.UNDECIDED, "no contact: the ball is not loaded"
    distance = units.short_length(abs(float(contact.edge_distance)))
    if contact.edge_loaded and contact.joint.clearance < 0:
        return Verdict.UNDECIDED, "the contact reaches the rim, as is normal in a preloaded joint"
    if verdict is Verdict.EXCEEDED:
        return verdict, f"edge loading: the contact reaches the rim (CPER -{distance})"
    if verdict is Verdict.UNDECIDED:
        ends = f"the contact ends {distance} from the rim (CPER), less than its error bar"
        return verdict, f"edge loading is undecided: {ends}"
    return verdict, f"no edge loading: the contact ends {distance} from the rim (CPER)"


def _position(contact: OffAxisContact, units: Units) -> Iterator[tuple[str, str, str]]:
    """Yield title, value and meaning of the numbers that locate a contact in its cup."""
    edge, centre = (units.short_length(float(value)) for value in (contact.edge_distance, contact.rim_distance))
    beyond = "; below 0 the rim cuts the contact off" if contact.edge_loaded else ""
    yield "edge distance (CPER)", edge, f"contact patch edge to rim: shortest arc on the bore{beyond}"
    yield "contact patch centre to rim (CPCR)", centre, "arc on the bore from the direction of the load to the rim"
    yield "load from the cup's axis", f"{degrees(float(contact.tilt)):.3g}°", "angle between load and axis"
    if isfinite(contact.max_pressure):
        angle = degrees(float(polar_angle(contact.max_pressure_at)))
        yield "largest pressure from the cup's axis", f"{angle:.3g}°", "angle at the centre of the bore"
    vector = contact.force_vector + 0.0
    scale = max(*abs(vector), contact.max_pressure * contact.area)  # the pressures of a preload balance
    vector[abs(vector) < _ROUNDING * scale] = 0.0
    force = (units.text_of(CONTACT["force"], float(part)) for part in vector)
    yield "force of the ball on the cup", ", ".join(force), "components towards the rim, across, towards the dome"


def _comparison(designs: Sequence[PressedDesign], units: Units) -> str:
    tables = []
    count = ceil(len(designs) / ceil(len(designs) / _MAX_COLUMNS))
    for start in range(0, len(designs), count):
        group = designs[start : start + count]
        columns = [list(_summary(design, units)) for design in group]
        rows = [(name, *(column[index][1] for column in columns)) for index, (name, _) in enumerate(columns[0])]
        tables.append((("", *(design.title for design in group)), rows))
    return render_part(_TEMPLATE, "comparison", tables)


def _summary(design: PressedDesign, units: Units) -> Iterator[tuple[str, str]]:
    """Yield name and value of the numbers that designs are compared by; the same names for every design."""
    file, contact = design.file, design.contact
    joint, (fit, radial_fit) = file.joint, file.joint.fit
    yield "head diameter", units.length(2 * float(joint.ball_radius))
    yield "diametral fit", f"{fit} {units.length(2 * float(radial_fit))}"
    layers = [(joint.liner_thickness, joint.liner), *((layer.thickness, layer.material) for layer in joint.backing)]
    parts = (f"{units.length(float(thickness))} {material_label(material, 'liner')}" for thickness, material in layers)
    yield "liner and backing", " on ".join(parts)
    yield "ball", material_label(joint.ball, "elastic")
    angles = [f"{degrees(float(getattr(file.cup, name))):.3g}° {name}" for name in _ORIENTATION if file.cup.oriented]
    angles += [f"load {degrees(file.aim['tilt']):.3g}° from its axis"] if "tilt" in file.aim else []
    yield "cup", ", ".join(angles) or "load along its axis"
    yield "load", ", ".join(units.text_of(PARAMETERS[name], float(value)) for name, value in file.load.items())
    yield "model", contact.model.name
    for name in ("max_pressure", "half_angle", "indentation", "area"):
        yield CONTACT[name].title, _number(contact, name, units)
    located = isinstance(contact, OffAxisContact) and not contact.status.failed
    yield "edge distance (CPER)", units.short_length(float(getattr(contact, EDGE_DISTANCE))) if located else "-"
    ratio = error_bar(contact, "utilisation")
    bar = f" (estimate, {range_text(ratio)})" if joint.strengths() and ratio.is_estimate else ""
    text = f"{ratio.value:.3g}" if joint.strengths() else "-"
    yield f"{QUANTITIES['utilisation'].title} {QUANTITIES['utilisation'].symbol}", f"{text}{bar}"
    yield "verdict", "; ".join([_verdict(contact, file.cup)[0], *_rim_words(contact, units, design.uncertainty)])


def press_sections(
    comparison: Comparison,
    units: Units = Units.SI,
    surroundings: LocalUncertainty | None = None,
    remarks: Sequence[str] = (),
    leading: Contact | None = None,
) -> TitledHtml:
    """Return the sections of a press without its figures: title and HTML by id.

    The position in the cup is that of the contact `leading`, or of the first that is off the cup's axis.
    """
    sources = [f"{source}, doi {source.doi}" if source.doi else str(source) for source in comparison.sources]
    position: TitledHtml = {}
    contacts = successful_contacts(comparison)
    located = [contact for contact in contacts.values() if isinstance(contact, OffAxisContact)]
    if located:
        rows = list(_position(next((contact for contact in located if contact is leading), located[0]), units))
        position["position"] = "Position of the contact in the cup", render_part(_TEMPLATE, "position", rows)
    return {
        "answers": ("Results", _results(comparison, units, remarks)),
        **position,
        "tolerances": ("Sensitivity and tolerances", _tolerances(surroundings, units)),
        "sources": ("Sources", render_part(_TEMPLATE, "sources", sources)),
    }


def _number(contact: Contact, name: str, units: Units) -> str:
    value = float(getattr(contact, name))
    return units.text_of(CONTACT[name], value) if value == value else "no result"


def _results(comparison: Comparison, units: Units, remarks: Sequence[str]) -> str:
    """Return the table of results as HTML, with a column for each model."""
    described = describe_press(comparison, remarks)
    (table,) = described.tables
    tables = []
    for start in range(0, len(table.rows), _MAX_MODELS):
        written = grid(table._replace(rows=table.rows[start : start + _MAX_MODELS]), units)
        names, *numbers = zip(*written.rows, strict=True)
        heads = [f"{column.title} {column.head}".strip() for column in written.columns]
        rows = [(head, *cells, unit) for head, cells, unit in zip(heads[1:], numbers, written.units[1:], strict=True)]
        tables.append((("", *names, "unit"), rows))
    notes = [units.sentence(note) for note in (*table.lines, *described.notes)]
    return render_part(_TEMPLATE, "answers", tables, notes)


def _figures(comparison: Comparison, leading: Contact, units: Units) -> str:
    """Return the figure of the curves as HTML; for a contact off the cup's axis the pressure map of the cup."""
    contacts = {leading.model.name: leading} if isinstance(leading, OffAxisContact) else successful_contacts(comparison)
    drawable = contacts and not leading.status.failed
    return render_part(_TEMPLATE, "figures", svg_address(press_plots.plot(contacts, units)) if drawable else None)


def _tolerances(surroundings: LocalUncertainty | None, units: Units) -> str:
    if surroundings is None:
        return "<p>Not computed: it needs a load above 0, and for a load off the cup's axis a tolerance.</p>"
    return "".join(answer_table(table, units) for table in uncertainty_tables(surroundings))
