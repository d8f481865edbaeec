"""Gait: a cycle of the hip, instant by instant: load, pressure, film, distance to the rim."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import partial
from html import escape
from itertools import groupby
from math import radians
from operator import attrgetter
from typing import Any

import numpy

from ...core.checks import check_whole_number, shown
from ...core.kinds import Unit
from ...core.quantities import CONTACT, DERIVED, FIELD, Quantity
from ...files.joint_file import JointFile
from ...hip import named_cycle
from ...hip.cycle_registry import CYCLES
from ...reports.figure_files import figure_bytes
from ...reports.hip_plots import course_figure
from ...reports.pages import picture
from ...reports.style import BLUE, INK, LineStyle
from ...reports.svg import levels_between
from ..long_view import LongView, LongWork, long_body
from ..pictures.bore import CELLS_EDGE, BoreField, bare_bore, bore_map, colour_scale, node_field, shape_of, viewer
from ..pictures.chart import Curve, chart, charts, spans
from ..pressing import axis_end
from ..running import Work
from ..state.screen import Screen
from ..state.use import CHOICES, FIELDS, UploadedCycle, sample_table
from ..view import Document
from ..widgets.blocks import Block, Content, notes_list, numbers, sentence, table
from ..widgets.controls import Changes, Control, changed, choice, chosen, cycle_controls, segments
from ..widgets.reading import Reading
from ..widgets.words import checked, doubt, number_cell, number_text, quantity_cell, value_text
from .hip_runs import MERIDIANS, RINGS, Frames, GaitFilm, GaitResult, gait_key, simulate_film, simulate_gait

_LARGEST = 100_000  # characters of a table
_FILM_SECONDS = 300.0
_UPLOAD = """<div class="field">
<label class="label" for="gait-own">Custom cycle (table: phase or time, force, angles)</label>
<input id="gait-own" type="file" accept=".csv,.txt,.dat,.mot,.sto" data-tell-file="gait.own">
<button type="button" data-tell="gait.sample">Save a sample</button>
<div id="gait-question" role="alert"></div></div>"""
_SHOWN = """<p class="quiet" id="gait-load"></p><div id="gait-numbers"></div>
<div class="player"><span id="gait-at" data-at hidden></span>
<div class="transport" hidden><button type="button">▶ Play</button>
<input type="range" min="0" step="1" aria-label="instant of the cycle"></div><output></output>
<div class="panes"><div><div data-field="gait.field"></div><div id="gait-viewer"></div><div id="gait-flat"></div>
<div data-field="gait-film.run"></div><div id="gait-film-trouble" role="alert"></div></div>
<div id="gait-courses" class="courses"></div></div></div>"""

_PHASE_LABEL = "phase of the cycle [%]"
_SIZE = (520.0, 182.0)
_INK, _BLUE = LineStyle(INK), LineStyle(BLUE, (6.0, 2.0))
_NM, _RATIO = Unit("nm"), Unit("")
_FILM_TITLE = "film thickness"


class Gait(LongView):
    """View of a cycle that is computed in a process and played by the page; its film follows by itself."""

    name, title, run_label, automatic = "gait", "Gait", "Compute the cycle", True
    body = long_body("gait", _SHOWN, _UPLOAD)

    def begin(self) -> None:
        super().begin()
        self._upload: UploadedCycle | None = None
        self._doubtful: UploadedCycle | None = None  # table whose units the user is to confirm
        work = LongWork(
            self.page,
            "gait-film",
            "Compute the film",
            self.question_of,
            lambda screen: partial(simulate_film, screen.file, screen.use, self._table_of(screen)),
            self._show_film,
            automatic=True,
            longest=_FILM_SECONDS,
        )
        self.film = self.add(work)
        self.actions |= {
            "gait.own": self._take_upload,
            "gait.units": lambda yes: self._with_table(self._doubtful),
            "gait.sample": self._save_sample,
            "gait.instant": lambda value: changed(
                self.page.screen, "use.instant", check_whole_number("instant", value)
            ),
        }

    def controls(self, screen: Screen) -> list[Control]:
        cycle, weight, contact = cycle_controls(screen)
        use, table = screen.use, self._table_of(screen)
        options = [*([use.table] if use.table else []), *CHOICES["cycle"]]
        return [
            Control(
                choice("cycle", cycle.field["label"], options, use.table or use.cycle),
                lambda name: {} if name == use.table else {"use": replace(use, cycle=name, table="")},
            ),
            weight if table is None else weight.but(hidden=not table.per_body_weight),
            contact,
            chosen(screen, "use.field", "Shown on the cup", FIELDS, segments),
        ]

    def question_of(self, screen: Screen) -> Hashable:
        return gait_key(screen.file, screen.use, self._table_of(screen))

    def work(self, screen: Screen) -> Work:
        table = self._table_of(screen)
        if screen.use.table and table is None:
            raise ValueError(f"a link does not hold {screen.use.table}: choose the file again, or another cycle")
        return partial(simulate_gait, screen.file, screen.use, table)

    def show(self, screen: Screen) -> None:
        table_note = f" A link does not hold {escape(screen.use.table)}." if screen.use.table else ""
        self.put(load=f"The load is that of the cycle; the force beside the joint is not used.{table_note}")
        super().show(screen)

    def _table_of(self, screen: Screen) -> UploadedCycle | None:
        """Return the table of the screen's cycle; None for a named cycle, or for a table that is not on this page."""
        return self._upload if self._upload and self._upload.name == screen.use.table else None

    def show_result(self, screen: Screen, result: GaitResult | None) -> None:
        if result is None:
            bore = bare_bore(screen.file.cup, radians(90.0))
            self.put(numbers="", viewer="", flat=bore, courses=gait_charts(None, None, screen.reading))
        elif result is self.long.result(screen):
            self.film.show(screen)
        else:
            self._show_cycle(screen, result, None)

    def _show_film(self, screen: Screen, film: GaitFilm | None) -> None:
        result = self.long.result(screen)
        if result is not None:
            self._show_cycle(screen, result, self.film.result(screen))

    def _show_cycle(self, screen: Screen, result: GaitResult, film: GaitFilm | None) -> None:
        reading, instant = screen.reading, screen.use.instant
        instant = result.heaviest if instant is None else min(instant, len(result.phase) - 1)
        field = film if screen.use.field == "film" else None
        self.put(
            at=str(instant),
            numbers=_numbers(result, film, reading),
            viewer=gait_viewer(result, field, screen.file, reading),
            flat=flat_bore(result, field, screen.file, reading, instant),
            courses=gait_charts(result, film, reading),
        )

    def _take_upload(self, value: Any) -> Changes:
        upload, weight = _read_upload(value), self.page.screen.use.body_weight
        self.put(question="")
        try:
            upload.cycle(weight)
        except ValueError:
            self._doubtful = upload.with_units()
            if self._doubtful == upload:
                raise
            self._doubtful.cycle(weight)
            self.put(question=_UNITS_QUESTION.format(escape(upload.name)))
            return {}
        return self._with_table(upload)

    def _with_table(self, upload: UploadedCycle | None) -> Changes:
        if upload is None:
            raise ValueError("no table waits for its units: choose the file again")
        self._upload, screen = upload, self.page.screen
        self.put(question="")
        if screen.use.table == upload.name:  # the same file, chosen again
            self.show(screen)
        return changed(screen, "use.table", upload.name)

    def _save_sample(self, value: Any) -> None:
        use = self.page.screen.use
        weight = use.body_weight if CYCLES[use.cycle].per_body_weight else None
        text = sample_table(named_cycle(use.cycle, body_weight=weight))
        self.page.send_file(f"{use.cycle}.csv", text.encode("utf-8"))

    def document(self, screen: Screen) -> Document:
        result, film, reading = self.result(screen), self.film.result(screen), screen.reading
        courses = {course.label(reading): values for course, values in courses_of(result, film, reading).items()}
        heads = ["phase [%]", *courses]
        rows = numpy.stack([result.phase, *courses.values()], axis=1).tolist()
        numbers = {
            **result.numbers,
            **{f"film_{name}": value for name, value in (film.numbers if film else {}).items()},
        }
        listed = table(["quantity", "value"], [[name, value_text(value)] for name, value in numbers.items()])
        sections: dict[str, tuple[str, Content]] = {
            "checks": ("Checks", [rim_sentence(result, reading), *checked(result.checks, reading)]),
            "gait": (f"A cycle: {result.name}", [listed, notes_list(result.notes, reading)]),
        }
        if film is not None:
            sections["film"] = (
                "Film",
                [picture(film.figures[reading.units], "film over the cycle"), notes_list([film.note], reading)],
            )
        return Document(
            picture=lambda form: figure_bytes(course_figure(result.phase, courses, result.name), form),
            rows=lambda: [heads, *rows],
            sections=lambda: sections,
        )


_UNITS_QUESTION = (
    "<p class='refused'>{} has heads without units. Read phases in %, times in s, forces in N and angles in degrees? "
    "<button type='button' data-tell='gait.units'>Yes</button></p>"
)


def _read_upload(value: Any) -> UploadedCycle:
    upload = value if isinstance(value, dict) else {}
    name, text, size = str(upload.get("name", "")), upload.get("text"), upload.get("size")
    if not isinstance(text, str):
        raise ValueError(f"{shown(value)} is not a table of a cycle, which has a name and a text")
    if len(text) > _LARGEST or (isinstance(size, int) and size > _LARGEST):
        raise ValueError(f"the table is longer than {_LARGEST} characters: a cycle needs some hundred lines")
    return UploadedCycle(name, text)


def _numbers(result: GaitResult, film: GaitFilm | None, reading: Reading) -> Content:
    force, pressure, distance = CONTACT["force"], CONTACT["max_pressure"], DERIVED["edge_distance"]
    least, notes = least_edge_distance(result), list(result.notes)
    cells = [
        quantity_cell(force, result.force.max(initial=0.0), reading, "largest load"),
        quantity_cell(pressure, numpy.nanmax(result.pressure, initial=0.0), reading, "largest pressure"),
        quantity_cell(distance, least, reading, "smallest distance to the rim", result.worst),
        quantity_cell(distance, result.numbers["slide_mm"], reading, "sliding distance per cycle"),
    ]
    if film is not None:
        state = "wave method, valid here" if film.valid else "✗ wave method, not valid here"
        thinnest, ratio = (float(numpy.nanmin(values, initial=numpy.inf)) for values in (film.least, film.ratio))
        unit = reading.units.of_text("nm")
        cells.append(number_cell("smallest film thickness", thinnest * unit.factor, unit.text, state))
        cells.append(number_cell("smallest film ratio λ", ratio, "", film.regime))
        notes.append(film.note)
    rim, checks = rim_sentence(result, reading), checked(result.checks, reading)
    return [rim, *doubt(result.valid), numbers(cells), *checks, notes_list(notes, reading)]


@dataclass(frozen=True)
class Course:
    """Quantity over the cycle: its field of `GaitResult` or `GaitFilm`, the number of its chart, its name and unit."""

    field: str
    chart: int
    name: str
    quantity: Quantity | None = None
    own_unit: Unit = _NM
    line: LineStyle = _INK

    def unit(self, reading: Reading) -> Unit:
        return reading.units.written(self.own_unit) if self.quantity is None else reading.unit(self.quantity)

    def label(self, reading: Reading) -> str:
        return f"{self.name}{self.unit(reading).text_in_brackets}"


_PRESSURE, _EDGE = CONTACT["max_pressure"], DERIVED["edge_distance"]
_COURSES = (
    Course("force", 0, "load", CONTACT["force"]),
    Course("pressure", 1, _PRESSURE.title, _PRESSURE),
    Course("edge", 2, _EDGE.title, _EDGE),
    Course("least", 3, "smallest film thickness"),
    Course("central", 3, "central film thickness", line=_BLUE),
    Course("ratio", 4, "film ratio λ", own_unit=_RATIO),
)
Courses = dict[Course, numpy.ndarray]  # values in the units of the page


def courses_of(result: GaitResult | None, film: GaitFilm | None, reading: Reading) -> Courses:
    """Return the courses that are known, in the units of the page."""
    fields = {name: values for part in (result, film) if part is not None for name, values in vars(part).items()}
    return {course: course.unit(reading).factor * fields[course.field] for course in _COURSES if course.field in fields}


def gait_charts(result: GaitResult | None, film: GaitFilm | None, reading: Reading) -> Content:
    """Return the charts of a cycle, with which the page plays it; empty ones while it is prepared."""
    courses = courses_of(result, film, reading)
    return [_chart(list(charted), courses, result, reading) for _, charted in groupby(_COURSES, attrgetter("chart"))]


def _chart(charted: list[Course], courses: Courses, result: GaitResult | None, reading: Reading) -> Block:
    """Draw some courses in one chart, without curves before they are known."""
    unit = charted[0].unit(reading)
    if result is None or charted[0] not in courses:
        words = f"{charted[0].label(reading)}: Preparing ..."
        return charts(chart(words, _PHASE_LABEL, "", {}, (100.0, 1.0), _SIZE, caption=[words]))
    curves, sentences, highest = {}, [], 0.0
    for course in charted:
        values = numpy.where(numpy.isfinite(courses[course]), courses[course], numpy.nan)
        curves[course.name] = Curve(result.phase, values, course.line)
        finite = values[numpy.isfinite(values)]
        ends = f"{number_text(finite.min())} to {number_text(finite.max())} {unit.text}" if finite.size else "no number"
        sentences.append(f"{course.name}: {ends}".rstrip())
        highest = max(highest, float(finite.max(initial=0.0)))
    flagged = spans(result.phase, result.rim) if charted[0].field == "edge" else []
    words = "; ".join(sentences)
    caption = [words, "✗ red: rim contact"] if flagged else [words]
    ends_of_axes = (100.0, axis_end(1.05 * highest))
    labels = f"over the cycle: {words}", _PHASE_LABEL, unit.text or "λ"
    drawn = chart(*labels, curves, ends_of_axes, _SIZE, flagged, caption=caption)
    return charts(drawn, legend=[] if len(charted) > 1 else None)


def least_edge_distance(result: GaitResult) -> float:
    """Return the smallest distance from the contact to the rim in mm; NaN if the cycle presses nothing."""
    known = result.edge[numpy.isfinite(result.edge)]
    return float(known.min()) if known.size else numpy.nan


def rim_sentence(result: GaitResult, reading: Reading) -> Block:
    """State in words if the contact reaches the rim, and when."""
    if not result.rim.any():
        distance = least_edge_distance(result)
        if numpy.isnan(distance):
            return sentence("✗ No contact: this cycle never presses the ball into its socket", "trust no")
        least = reading.with_unit(DERIVED["edge_distance"], distance)
        return sentence(f"✓ No rim contact: the contact ends at least {least} before the rim", "trust yes")
    ranges = ", ".join(f"{low:.0f} to {high:.0f} %" for low, high in spans(result.phase, result.rim))
    share = f"{100 * result.rim.mean():.0f} % of the cycle"
    return sentence(f"✗ Rim contact in {share} ({ranges}): the pressure there is a lower bound", "trust no")


def _shown(result: GaitResult, film: GaitFilm | None, reading: Reading) -> tuple[Frames, float, str]:
    """Return the field on the bore, the factor of its unit, and its label; the pressure without a film."""
    if film is not None:
        return film.frames, 1.0, f"{_FILM_TITLE}{_NM.text_in_brackets}"
    return result.frames, reading.unit(FIELD["pressure"]).factor, reading.label(FIELD["pressure"])


def gait_viewer(result: GaitResult, film: GaitFilm | None, file: JointFile, reading: Reading) -> str:
    """Show the pressure or the film of a cycle on the bore in three dimensions."""
    frames, factor, label = _shown(result, film, reading)
    levels = levels_between(0.0, factor * frames.highest or 1.0)
    return viewer(
        "gait",
        f"{label} on the cup in the chosen instant",
        colour_scale(levels, label),
        **shape_of(file.joint, file.cup, result.reach, RINGS, MERIDIANS),
        bytes=b64encode(frames.cells.tobytes()).decode("ascii"),
        gain=factor * frames.highest / levels[-1],
        loads=result.load.round(4).tolist(),
        sizes=(result.force / (float(result.force.max(initial=0.0)) or 1.0)).round(4).tolist(),
        film=film is not None,
    )


def flat_bore(result: GaitResult, film: GaitFilm | None, file: JointFile, reading: Reading, instant: int) -> str:
    """Draw the pressure or the film of one instant on the flat bore."""
    frames, factor, label = _shown(result, film, reading)
    nodes = factor * frames.highest / 255 * frames.cells[instant]
    field = BoreField(
        name="gait",
        at=node_field(nodes if film is None else numpy.where(nodes > 0, nodes, numpy.nan), result.reach),
        highest=factor * frames.highest or 1.0,
        label=label,
        reach=result.reach,
        cup=file.cup,
        least=CELLS_EDGE if film is None else 1e-3,
    )
    phase, highest = result.phase[instant], number_text(nodes.max())
    words = f"{label} at {phase:.1f} % of the cycle, seen from the opening, up to {highest}"
    return bore_map(words, field, result.load[instant])
