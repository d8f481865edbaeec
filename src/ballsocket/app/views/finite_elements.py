"""Check by finite elements: the joint on the screen with its rim and support, beside the exact result."""

from __future__ import annotations

import time
from collections.abc import Hashable
from dataclasses import dataclass
from functools import partial
from html import escape
from typing import Any

import numpy

from ...comparison import relative_deviation
from ...contact.describe import to_summary
from ...core.answers import Check
from ...core.quantities import CONTACT, JOINT, PLASTIC
from ...core.unit_systems import Units
from ...core.validity import OutsideDomainError
from ...design_checks import checks_of, verdict_of
from ...elasticity.finite_elements.model import MeshedContact
from ...files.joint_file import JointFile
from ...model_catalogue import JUDGE, named_models, reference, with_yielding
from ...question import complete
from ...reports.joint_drawing import profile
from ...reports.pages import picture
from ...reports.section_plots import section_figure, section_picture
from ...reports.style import bytes_by_units, line_of
from ..long_view import LongView, long_body
from ..pictures.chart import charts
from ..pictures.section import extent_of, section
from ..pressing import pressure_chart
from ..results import without_name
from ..running import Reached, Report, Work
from ..state.screen import LINER_LAWS, Screen
from ..view import Document
from ..widgets.blocks import Content, notes_list, sentence, table
from ..widgets.controls import Control, chosen, segments
from ..widgets.joint_controls import cup_controls
from ..widgets.reading import number_text
from ..widgets.words import checked, distinct_quantities, percent

_NAME = "judge"
_CUP_FIELDS = ("arc_of_cover", "chamfer", "interface")
_LOAD_STEPS = (0.25, 0.5, 0.75, 1.0)


class ElementCheck(LongView):
    """View that presses the joint by finite elements."""

    name, title, run_label = _NAME, "Check by finite elements", "Run finite elements"
    body = long_body(
        _NAME,
        f'<div id="{_NAME}-numbers"></div><div id="{_NAME}-picture" class="beside"></div>',
    )

    def question_of(self, screen: Screen) -> Hashable:
        file, cup = screen.file, screen.file.cup
        load = tuple(file.load.items())
        return without_name(file.joint), load, file.tilt, cup.arc_of_cover, cup.chamfer, cup.interface, screen.liner_law

    def work(self, screen: Screen) -> Work:
        return partial(run_finite_elements, screen.file, yields=screen.liner_law == "yielding")

    def controls(self, screen: Screen) -> list[Control]:
        of_cup = [control for control in cup_controls(screen) if control.field["name"] in _CUP_FIELDS]
        return [*of_cup, chosen(screen, "liner_law", "Liner", LINER_LAWS, segments)]

    def show_result(self, screen: Screen, result: ElementResult | None) -> None:
        if result is None:
            drawing = section(screen.file, None, extent_of(screen.file), 1.0)
            self.put(numbers="", picture=f"<figure>{drawing}</figure>")
        else:
            self.put(numbers=_numbers(result, screen), picture=_pictures(result, screen))

    def document(self, screen: Screen) -> Document:
        result: ElementResult = self.result(screen)
        units = screen.reading.units
        heads = ["quantity", "finite elements", "error of the mesh", "exact"]
        exact = result.exact or {}
        rows = [
            [entry.key, result.numbers[entry.key], result.error.get(entry.name, ""), exact.get(entry.key, "")]
            for entry in {**CONTACT, **PLASTIC}.values()
            if isinstance(result.numbers.get(entry.key), float)
        ]
        figure = picture(result.figures["png"][units], "mesh, von Mises stress, and pressure beside the exact one")
        return Document(
            picture=lambda form: result.figures[form][units],
            rows=lambda: [heads, *rows],
            sections=lambda: {"judge": ("Finite elements", [*_numbers(result, screen), figure])},
        )


def _pictures(result: ElementResult, screen: Screen) -> Content:
    reading, joint = screen.reading, result.file.joint
    head, outside = (
        reading.with_unit(JOINT[name], getattr(joint, name)) for name in ("head_diameter", "outer_diameter")
    )
    ((kind, load),) = result.file.load.items()
    caption = f"head ⌀ {head}, outside ⌀ {outside}, {CONTACT[kind].title} {reading.with_unit(CONTACT[kind], load)}"
    names = {JUDGE: "finite elements", reference.name: "exact"}
    lines = {names[model]: line_of(model) for model in result.pressures}
    profiles = {names[model]: (*pressures, True) for model, pressures in result.pressures.items()}
    drawing = f"<figure><figcaption>{escape(caption)}</figcaption>{result.drawing[reading.units]}</figure>"
    pressures = pressure_chart(profiles, lines, reading, ["Pressure beside the exact one"])
    return [drawing, charts(pressures, legend=[])]


def _numbers(result: ElementResult, screen: Screen) -> list[Any]:
    rows = []
    yielding = [quantity for quantity in PLASTIC.values() if quantity.key in result.numbers]
    for quantity in [*distinct_quantities(result.numbers[CONTACT["max_pressure_angle"].key]), *yielding]:
        unit = screen.reading.unit(quantity)
        factor = unit.factor / quantity.written.factor  # the numbers are those of JSON
        value = result.numbers[quantity.key] * factor
        error = result.error.get(quantity.name)
        unit_text = unit.text.replace(" ", "\N{NO-BREAK SPACE}")
        title = f"{quantity.title} [{unit_text}]" if unit_text else quantity.title
        row = [title, number_text(value), percent(error) if error else "–"]
        if result.exact is None or quantity.key not in result.exact:
            row += ["–", "–"]
        else:
            exact = result.exact[quantity.key] * factor
            row += [number_text(exact), percent(float(relative_deviation(value, exact)), "+")]
        rows.append(row)
    heads = ["quantity", "finite elements", "mesh error", "exact", "difference"]
    took = f"{result.elements} elements, {result.seconds:.2g} s"
    words = f"{took}. The exact solution is that of a complete shell, without a rim."
    notes = notes_list(result.notes, screen.reading)
    return [*checked(result.checks, screen.reading), table(heads, rows, "narrow"), sentence(words), notes]


@dataclass(frozen=True, kw_only=True)
class ElementResult:
    """Result of finite elements as for JSON, beside the exact one, with drawings for the page and for files.

    `pressures` are angles (rad) and pressures (MPa) by model.
    """

    file: JointFile
    numbers: dict[str, Any]
    error: dict[str, float]
    exact: dict[str, Any] | None
    elements: int
    seconds: float
    notes: tuple[str, ...]
    checks: tuple[Check, ...]
    drawing: dict[Units, str]  # SVG of mesh and stress
    pressures: dict[str, tuple[numpy.ndarray, numpy.ndarray]]
    figures: dict[str, dict[Units, bytes]]  # by the format


def run_finite_elements(file: JointFile, report: Report, *, yields: bool = False) -> ElementResult:
    """Press a joint in load steps by finite elements, and report progress as `Reached`; its liner may yield."""
    start = time.perf_counter()
    model = named_models[JUDGE].in_cup(file.cup, **file.aim)
    model = with_yielding(model) if yields else model
    ((kind, load),) = file.load.items()
    report(Reached(share=0.05, words="making the meshes"))
    for share in _LOAD_STEPS:
        contact = model.press(file.joint, **{kind: share * load})
        report(Reached(share=0.05 + 0.75 * share, words=f"pressed to {100 * share:g} % of the load"))
    if contact.status.failed:
        rows = checks_of(contact, file.cup)
        verdict = f". {verdict_of(rows)[1]}" if rows else ""
        raise ValueError(f"the finite elements have no result: {contact.status.sentence}{verdict}")
    assert isinstance(contact, MeshedContact)
    try:
        exact = reference.press(file.joint, **file.load)
    except OutsideDomainError:
        exact = None
    if exact is not None and exact.status.failed:
        exact = None
    report(Reached(share=0.85, words="drawing stresses"))
    contacts = {JUDGE: contact, reference.name: exact}
    return ElementResult(
        file=file,
        numbers=to_summary(contact),
        error={name: float(value) for name, value in contact.error.items()},
        exact=None if exact is None else to_summary(exact),
        elements=contact.mesh.elements,
        seconds=time.perf_counter() - start,
        notes=tuple(contact.notes),
        checks=checks_of(contact, complete(file)[0].cup, float(contact.von_mises)),
        drawing=section_picture(contact),
        pressures={name: profile(pressed) for name, pressed in contacts.items() if pressed is not None},
        figures={form: bytes_by_units(section_figure(contact, exact), form) for form in ("png", "svg")},
    )
