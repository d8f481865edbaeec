"""Check by finite elements: the joint on the screen with its rim and support, beside the exact result."""

from __future__ import annotations

import time
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import partial
from html import escape
from typing import Any, cast

import numpy

from ...comparison import relative_deviation
from ...contact.describe import to_summary
from ...core.answers import Check
from ...core.quantities import BEARING, CONTACT, JOINT
from ...core.unit_systems import Units
from ...core.validity import OutsideDomainError
from ...design_checks import checks_of
from ...elasticity.finite_elements.model import MeshedContact
from ...elasticity.finite_elements.section import Part
from ...files.joint_file import JointFile
from ...model_catalogue import JUDGE, named_models, reference
from ...question import complete
from ...reports import svg
from ...reports.joint_drawing import profile
from ...reports.pages import picture, table
from ...reports.section_plots import MAX_EXTENT, largest_stress, section_figure, shown_triangles
from ...reports.style import bytes_by_units, line_of
from ..long_view import LongView, long_body
from ..pictures.chart import legend
from ..pictures.section import extent_of, section
from ..pressing import pressure_chart
from ..results import without_name
from ..running import Reached, Report, Work
from ..state.screen import Screen
from ..view import Document, field_places
from ..widgets.controls import Control
from ..widgets.joint_controls import cup_controls
from ..widgets.reading import Reading, number_text
from ..widgets.words import checked, distinct_quantities, notes_list, percent

_NAME = "judge"
_FIELDS = ("arc_of_cover", "chamfer", "interface")
_TO_COME = (
    "A run meshes this section with its rim, chamfer and backing, presses the ball in four load steps and shows the "
    "von Mises stress, the pressure beside the exact one of a complete shell, and the error of the mesh. It takes some "
    "seconds."
)
_WIDTH, _MIDDLE, _REACH = 480.0, 240.0, 225.0
_TOP = 34.0
_MOVE, _CLOSE = 1, 79  # codes of a path in matplotlib
_LOAD_STEPS = (0.25, 0.5, 0.75, 1.0)


class ElementCheck(LongView):
    """View that runs finite elements on request."""

    name, title, run_label = _NAME, "Check by finite elements", "Run finite elements"
    body = long_body(
        _NAME, field_places(_NAME, _FIELDS), f'<div id="{_NAME}-numbers"></div><div id="{_NAME}-picture"></div>'
    )

    def question_of(self, screen: Screen) -> Hashable:
        file, cup = screen.file, screen.file.cup
        load = tuple(file.load.items())
        return without_name(file.joint), load, file.tilt, cup.arc_of_cover, cup.chamfer, cup.interface

    def work(self, screen: Screen) -> Work:
        return partial(run_finite_elements, screen.file)

    def controls(self, screen: Screen) -> list[Control]:
        return [control for control in cup_controls(screen) if control.field["name"] in _FIELDS]

    def show_result(self, screen: Screen, result: ElementResult | None) -> None:
        if result is None:
            drawing = section(screen.file, None, extent_of(screen.file), 1.0)
            preview = f"<div class='beside'><figure>{drawing}</figure><p class='quiet'>{_TO_COME}</p></div>"
            self.put(numbers="", picture=preview)
        else:
            self.put(numbers=_numbers(result, screen), picture=_pictures(result, screen))

    def document(self, screen: Screen) -> Document:
        result: ElementResult = self.result(screen)
        units = screen.reading.units
        heads = ["quantity", "finite elements", "error of the mesh", "exact"]
        exact = result.exact or {}
        rows = [
            [entry.key, result.numbers[entry.key], result.error.get(entry.name, ""), exact.get(entry.key, "")]
            for entry in CONTACT.values()
            if isinstance(result.numbers[entry.key], float)
        ]
        figure = picture(result.figures["png"][units], "mesh, von Mises stress, and pressure beside the exact one")
        return Document(
            picture=lambda form: result.figures[form][units],
            rows=lambda: [heads, *rows],
            sections=lambda: {"judge": ("Finite elements", _numbers(result, screen) + figure)},
        )


def _pictures(result: ElementResult, screen: Screen) -> str:
    reading, joint = screen.reading, result.file.joint
    head, outside = (
        reading.with_unit(JOINT[name], getattr(joint, name)) for name in ("head_diameter", "outer_diameter")
    )
    ((kind, load),) = result.file.load.items()
    caption = f"head ⌀ {head}, outside ⌀ {outside}, {CONTACT[kind].title} {reading.with_unit(CONTACT[kind], load)}"
    names = {JUDGE: "finite elements", reference.name: "exact"}
    lines = {names[model]: line_of(model) for model in result.pressures}
    profiles = {names[model]: (*pressures, True) for model, pressures in result.pressures.items()}
    return (
        f"<div class='beside elements'><figure><figcaption>{escape(caption)}</figcaption>"
        f"{section_picture(result.drawing, result.file, reading)}</figure>"
        f"<figure><figcaption>Pressure beside the exact one</figcaption>"
        f"{pressure_chart(profiles, lines, reading)}<p class='legend'>{legend(lines)}</p></figure></div>"
    )


def _numbers(result: ElementResult, screen: Screen) -> str:
    rows = []
    for quantity in distinct_quantities(result.numbers[CONTACT["max_pressure_angle"].key]):
        unit = screen.reading.unit(quantity)
        factor = unit.factor / quantity.written.factor  # the numbers are those of JSON
        value = result.numbers[quantity.key] * factor
        error = result.error.get(quantity.name)
        unit_text = unit.text.replace(" ", "\N{NO-BREAK SPACE}")
        row = [f"{quantity.title} [{unit_text}]", number_text(value), percent(error) if error else "–"]
        if result.exact is None:
            row += ["–", "–"]
        else:
            exact = result.exact[quantity.key] * factor
            row += [number_text(exact), percent(float(relative_deviation(value, exact)), "+")]
        rows.append(row)
    heads = ["quantity", "finite elements", "mesh error", "exact", "difference"]
    return (
        f"{checked(result.checks, screen.reading)}<div class='narrow'>{table(heads, rows)}</div>"
        f"<p class='quiet'>{result.elements} elements, {result.seconds:.2g} s. The exact solution is that of a "
        f"complete shell, without a rim.</p>{notes_list(result.notes, screen.reading)}"
    )


@dataclass(frozen=True, kw_only=True)
class StressBands:
    """Levels (MPa) of the von Mises stress in one kind of part, and the path of each band."""

    levels: tuple[float, ...]
    paths: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class SectionDrawing:
    """Mesh at the left and stresses at the right, as paths of a picture."""

    height: float
    mesh: str
    bands: Mapping[str, StressBands]


def section_drawing(contact: MeshedContact) -> SectionDrawing:
    """Draw mesh and stresses of a contact as paths."""
    section = contact.section
    parts = section.parts
    extent = min(max(float(part.position[0].max()) for part in parts), section.socket_radius + MAX_EXTENT)
    scale, highest = _REACH / extent, max(float(part.position[1].max()) for part in parts)
    lowest = max(min(float(part.position[1].min()) for part in parts), -extent)

    def project(position: Any, side: float) -> numpy.ndarray:
        """Return picture coordinates (points, 2) of positions (2, points) at the left (-1) or right (1)."""
        return numpy.stack([_MIDDLE + side * scale * position[0], _TOP + scale * (highest - position[1])], axis=-1)

    bands = {}
    for kind in ("liner", "ball", "backing"):
        drawn = [part for part in parts if part.name.startswith(kind)]
        if drawn:
            levels = svg.levels_between(0.0, largest_stress(section, kind), 6)
            paths = zip(*(_bands(part, levels, project) for part in drawn), strict=True)
            bands[kind] = StressBands(levels=tuple(levels), paths=tuple("".join(parts) for parts in paths))
    mesh = "".join(_edges(part, project(part.position, -1.0)) for part in parts)
    return SectionDrawing(height=_TOP + scale * (highest - lowest) + 8, mesh=mesh, bands=bands)


def _edges(part: Part, points: numpy.ndarray) -> str:
    """Draw every edge of the elements once."""
    corners = part.elements[:4]
    edges = numpy.concatenate([numpy.stack([corners[a], corners[(a + 1) % 4]], axis=-1) for a in range(4)])
    starts, ends = points[numpy.unique(numpy.sort(edges, axis=1), axis=0).T]
    return "".join(
        f"M{x:.1f},{y:.1f}l{dx:.1f},{dy:.1f}" for (x, y), (dx, dy) in zip(starts, ends - starts, strict=True)
    )


def _bands(part: Part, levels: list[float], project: Any) -> list[str]:
    """Return the path of each band of the von Mises stress, the last one without an upper end."""
    from matplotlib.figure import Figure
    from matplotlib.tri import Triangulation

    triangulation = Triangulation(part.position[0], part.position[1], shown_triangles(part))
    ends = [*levels[:-1], max(levels[-1], float(part.stress.von_mises.max()) * (1 + 1e-9))]
    filled = Figure().subplots().tricontourf(triangulation, part.stress.von_mises, levels=ends)
    bands, outlines = [], cast("Any", filled.get_paths())
    for path in outlines:
        points = [] if path.codes is None else zip(project(path.vertices.T, 1.0), path.codes, strict=True)
        strokes = (
            "Z" if code == _CLOSE else f"{'M' if code == _MOVE else 'L'}{x:.1f},{y:.1f}" for (x, y), code in points
        )
        bands.append("".join(strokes))
    return bands


def section_picture(drawing: SectionDrawing, file: JointFile, reading: Reading) -> str:
    """Draw mesh and stresses with a colour scale for each kind of part, in the units of the page."""
    unit, count = reading.unit(BEARING["von_mises"]), len(drawing.bands)
    span = (_WIDTH - 20) / count
    parts = [
        f'<path class="mesh" d="{drawing.mesh}"/>',
        *(
            f'<path fill="{svg.heat(number / max(len(bands.paths) - 1, 1))}" fill-rule="evenodd" d="{path}"/>'
            for bands in drawing.bands.values()
            for number, path in enumerate(bands.paths)
        ),
        svg.line(_MIDDLE, 24, _MIDDLE, drawing.height, "edge"),
        svg.text(_MIDDLE - 12, 16, "mesh", "label", "end"),
        svg.text(_MIDDLE + 12, 16, "von Mises stress", "label", "start"),
    ]
    for number, (kind, bands) in enumerate(drawing.bands.items()):
        levels = [level * unit.factor for level in bands.levels]
        parts += svg.scale(levels, f"{kind} [{unit.text}]", 14 + span * number, drawing.height + 26, span - 28)
    sizes = [
        f"{JOINT[name].title} {reading.with_unit(JOINT[name], float(getattr(file.joint, name)))}"
        for name in ("head_diameter", "outer_diameter", "diametral_clearance")
    ]
    label = f"mesh and von Mises stress in section: {', '.join(sizes)}"
    return svg.picture((_WIDTH, drawing.height + 56), label, parts)


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
    drawing: SectionDrawing
    pressures: dict[str, tuple[numpy.ndarray, numpy.ndarray]]
    figures: dict[str, dict[Units, bytes]]  # by the format


def run_finite_elements(file: JointFile, report: Report) -> ElementResult:
    """Press a joint in load steps by finite elements, and report progress as `Reached`."""
    start = time.perf_counter()
    model = named_models[JUDGE].in_cup(file.cup, **file.aim)
    ((kind, load),) = file.load.items()
    report(Reached(share=0.05, words="making the meshes"))
    for share in _LOAD_STEPS:
        contact = model.press(file.joint, **{kind: share * load})
        report(Reached(share=0.05 + 0.75 * share, words=f"pressed to {100 * share:g} % of the load"))
    if contact.status.failed:
        raise ValueError(f"the finite elements have no result: {contact.status.sentence}")
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
        drawing=section_drawing(contact),
        pressures={name: profile(pressed) for name, pressed in contacts.items() if pressed is not None},
        figures={form: bytes_by_units(section_figure(contact, exact), form) for form in ("png", "svg")},
    )
