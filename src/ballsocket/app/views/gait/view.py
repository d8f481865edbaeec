"""Gait: a cycle of the hip, instant by instant: load, pressure, film, distance to the rim."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import partial
from html import escape
from math import radians
from typing import Any

import numpy

from ....core.checks import shown
from ....core.quantities import CONTACT, DERIVED
from ....reports.figure_files import figure_bytes
from ....reports.hip_plots import course_figure
from ....reports.pages import picture, table
from ...long_view import LongView, LongWork, long_body
from ...pictures.bore import bare_bore
from ...running import Work
from ...state.screen import Screen
from ...state.use import FIELDS, UploadedCycle
from ...view import Document, Host
from ...widgets.cycle_settings import CYCLE_SETTINGS
from ...widgets.fields import segments
from ...widgets.reading import Reading
from ...widgets.settings import chosen
from ...widgets.words import checked, doubt, notes_list, number_cell, value_text
from .charts import courses_of, empty_charts, flat_bore, gait_charts, gait_viewer, least_edge_distance, rim_sentence
from .worker import GaitFilm, GaitResult, gait_key, simulate_film, simulate_gait

_LARGEST = 100_000  # characters of a table
_FILM_SECONDS = 300.0
_INPUTS = """<div data-field="gait.cycle"></div><div data-field="gait.body_weight"></div>
<div data-field="gait.contact"></div>
<div class="field"><label class="label" for="gait-own">Custom cycle (table: phase or time, force, angles)</label>
<input id="gait-own" type="file" accept=".csv,.txt,.dat,.mot,.sto" data-tell-file="gait.own"></div>"""
_SHOWN = """<p class="quiet" id="gait-load"></p><div id="gait-numbers"></div>
<div class="player"><span id="gait-at" data-at hidden></span>
<div class="transport" hidden><button type="button" class="plain">▶ Play</button>
<input type="range" min="0" step="1" aria-label="instant of the cycle"></div><output></output>
<div class="panes"><div><div data-field="gait.field"></div><div id="gait-viewer"></div><div id="gait-flat"></div>
<div data-field="gait-film.run"></div><div id="gait-film-trouble" role="alert"></div></div>
<div id="gait-courses" class="courses"></div></div></div>"""

_TILES = CONTACT["force"], CONTACT["max_pressure"], DERIVED["edge_distance"]


class Gait(LongView):
    """View of a cycle that is computed in a process and played by the page; its film follows by itself."""

    title = "Gait"
    name = "gait"
    settings = (*CYCLE_SETTINGS, chosen("use.field", "Shown on the cup", FIELDS, segments))
    run_label = "Compute the cycle"
    automatic = True
    body = long_body("gait", _INPUTS, _SHOWN)

    def __init__(self, page: Host) -> None:
        super().__init__(page)
        self._upload: UploadedCycle | None = None
        self._cycle = page.screen.use.cycle
        self.film = LongWork(
            page,
            "gait-film",
            "Compute the film",
            self.question_of,
            lambda screen: partial(simulate_film, screen.file, screen.use, self._upload),
            self._show_film,
            automatic=True,
            longest=_FILM_SECONDS,
        )
        self.further = [self.film]

    def question_of(self, screen: Screen) -> Hashable:
        return gait_key(screen.file, screen.use, self._upload)

    def work(self, screen: Screen) -> Work:
        return partial(simulate_gait, screen.file, screen.use, self._upload)

    def show_inputs(self, screen: Screen) -> None:
        if screen.use.cycle != self._cycle:
            self._upload, self._cycle = None, screen.use.cycle
        super().show_inputs(screen)
        upload_note = "" if self._upload is None else f" {escape(self._upload.name)}: a link does not hold it."
        self.put(load=f"The load is that of the cycle; the force beside the joint is not used.{upload_note}")

    def show_result(self, screen: Screen, result: GaitResult | None) -> None:
        if result is None:
            bore = bare_bore(screen.file.cup, radians(90.0))
            self.put(numbers="", viewer="", flat=bore, courses=empty_charts(screen.reading))
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

    def edit(self, key: str, value: Any) -> None:
        if key == "own":
            self._upload = _read_upload(value)
            self.show(self.page.screen)
        elif key == "instant":
            if not isinstance(value, int) or isinstance(value, bool):
                raise ValueError("an instant of a cycle is a whole number")
            self.page.ask(use=replace(self.page.screen.use, instant=value))
        else:
            super().edit(key, value)

    def document(self, screen: Screen) -> Document:
        result, film, reading = self.result(screen), self.film.result(screen), screen.reading
        courses = {
            course.label(reading): values for charted in courses_of(result, film, reading) for course, values in charted
        }
        heads = ["phase [%]", *courses]
        rows = numpy.stack([result.phase, *courses.values()], axis=1).tolist()
        numbers = {
            **result.numbers,
            **({} if film is None else {f"film_{name}": value for name, value in film.numbers.items()}),
        }
        listed = table(["quantity", "value"], [[name, value_text(value)] for name, value in numbers.items()])
        sections = {
            "checks": ("Checks", f"{rim_sentence(result, reading)}{checked(result.checks, reading)}"),
            "gait": (f"A cycle: {result.name}", listed + notes_list(result.notes)),
        }
        if film is not None:
            sections["film"] = ("Film", picture(film.figure, "film over the cycle") + notes_list([film.note]))
        return Document(
            picture=lambda form: figure_bytes(course_figure(result.phase, courses, result.name), form),
            rows=lambda: [heads, *rows],
            sections=lambda: sections,
        )


def _read_upload(value: Any) -> UploadedCycle:
    upload = value if isinstance(value, dict) else {}
    name, text, size = str(upload.get("name", "")), upload.get("text"), upload.get("size")
    if not isinstance(text, str):
        raise ValueError(f"{shown(value)} is not a table of a cycle, which has a name and a text")
    if len(text) > _LARGEST or (isinstance(size, int) and size > _LARGEST):
        raise ValueError(f"the table is longer than {_LARGEST} characters: a cycle needs some hundred lines")
    return UploadedCycle(name, text)


def _numbers(result: GaitResult, film: GaitFilm | None, reading: Reading) -> str:
    force, pressure, edge = (reading.unit(quantity) for quantity in _TILES)
    least = least_edge_distance(result)
    highest = float(numpy.nanmax(result.pressure, initial=0.0)) * pressure.factor
    cells = [
        number_cell("largest load", float(result.force.max(initial=0.0)) * force.factor, force.text),
        number_cell("largest pressure", highest, pressure.text),
        number_cell("smallest distance to the rim", least * edge.factor, edge.text, result.worst),
        number_cell("sliding distance per cycle", result.numbers["slide_mm"] * edge.factor, edge.text),
        *([] if film is None else _film_cells(film)),
    ]
    notes = [*result.notes, *([] if film is None else [film.note])]
    checks = checked(result.checks, reading)
    rim = rim_sentence(result, reading)
    return f"{rim}{doubt(result.valid)}<dl class='tiles'>{''.join(cells)}</dl>{checks}{notes_list(notes)}"


def _film_cells(film: GaitFilm) -> list[str]:
    state = "wave method, valid here" if film.valid else "✗ wave method, not valid here"
    least, ratio = (float(numpy.nanmin(values, initial=numpy.inf)) for values in (film.least, film.ratio))
    return [
        number_cell("smallest film thickness", least, "nm", state),
        number_cell("smallest film ratio λ", ratio, "", film.regime),
    ]
