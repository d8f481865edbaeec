"""Gait: a cycle of the hip, instant by instant: load, pressure, film, distance to the rim."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import partial
from html import escape
from math import nan
from typing import Any

import numpy

from ....core.checks import check_names
from ....core.kinds import Kind, Unit
from ....reports.figure_files import figure_bytes
from ....reports.hip_plots import course_figure
from ....reports.pages import table
from ...jobs import ViewJob
from ...running import CachedRun
from ...state.screen import Screen
from ...state.use import UploadedCycle, Use, cycle_fields
from ...view import Document, Host, View
from ...widgets.fields import typed
from ...widgets.reading import Reading
from ...widgets.words import doubt, notes_list, number_cell, progress, value_text
from .charts import COURSES, player
from .worker import GaitResult, gait_key, simulate_gait

_RESULTS: CachedRun = CachedRun(max_size=24)
_LARGEST = 100_000  # characters of a table


class Gait(View):
    """View of a cycle that is computed in a process and played by the page."""

    title = "Gait"
    body = """
<div class="inputs-row"><div data-field="gait.cycle"></div><div data-field="gait.body_weight"></div>
<div data-field="gait.contact"></div>
<div class="field"><label class="label" for="gait-own">A cycle of your own (table: phase or time, force, angles)</label>
<input id="gait-own" type="file" accept=".csv,.txt,.dat,.mot,.sto" data-tell-file="gait.own"></div></div>
<p class="quiet" id="gait-said"></p>
<div id="gait-trouble" role="alert"></div>
<div id="gait-progress" role="status"></div>
<div id="gait-numbers"></div>
<span id="gait-at" hidden></span>
<div id="gait-player"></div>
"""

    def __init__(self, page: Host) -> None:
        self._page, self._screen = page, page.screen
        self._job = ViewJob(page.channel, "gait", self._store_result)
        self._upload: UploadedCycle | None = None
        page.listen("gait", self._edited)

    def show(self, screen: Screen) -> None:
        if screen.use.cycle != self._screen.use.cycle:
            self._upload = None
        self._screen = screen
        self._job.put("trouble", "")
        self._page.channel.put_fields({field["name"]: field for field in cycle_fields("gait", screen.use)})
        self._job.put("said", self._words())
        result = _RESULTS.get(self._key)
        if result is None:
            self._job.put("numbers", "")
            self._job.put("player", "")
            self._job.ask(self._key, partial(simulate_gait, screen.file, screen.use, self._upload))
        else:
            self._job.stop()
            self._job.put("progress", "")
            self._put_found(result)

    @property
    def _key(self) -> Hashable:
        return gait_key(self._screen.file, self._screen.use, self._upload)

    def _words(self) -> str:
        aside = "The load is that of the cycle; the force beside the joint is not used."
        upload_note = "" if self._upload is None else f" {escape(self._upload.name)}: a link does not hold it."
        return f"{aside}{upload_note}"

    def _put_found(self, result: GaitResult) -> None:
        instant = self._screen.use.instant
        self._job.put("at", str(result.heaviest if instant is None else min(instant, len(result.phase) - 1)))
        self._job.put("numbers", _numbers(result, self._screen.reading))
        self._job.put("player", player(result, self._screen.reading))

    def _edited(self, key: str, value: Any) -> None:
        if key == "stop":
            self._job.stop()
            self._job.put("progress", progress("Stopped.", None, again="gait.again"))
        elif key == "again":
            self.show(self._screen)
        elif key == "own":
            self._upload = _read_upload(value)
            self.show(self._screen)
        else:
            self._page.ask(use=_changed(self._screen, key, value))

    def _store_result(self, key: Hashable, result: GaitResult) -> None:
        _RESULTS.put(key, result)
        self._put_found(result)

    def document(self, screen: Screen) -> Document:
        result: GaitResult | None = _RESULTS.get(self._key)
        if result is None:
            raise ValueError("this cycle has not been pressed yet: wait until it is there")
        reading = screen.reading
        courses = {course.label(reading): course.of(result, reading) for course in COURSES}
        heads = ["phase [%]", *courses]
        rows = numpy.stack([result.phase, *courses.values()], axis=1).tolist()
        listed = table(["quantity", "value"], [[name, value_text(value)] for name, value in result.numbers.items()])
        return Document(
            picture=lambda form: figure_bytes(course_figure(result.phase, courses, result.name), form),
            rows=lambda: [heads, *rows],
            sections=lambda: {"gait": (f"A cycle: {result.name}", listed + notes_list(result.notes))},
        )

    def leave(self) -> None:
        self._job.stop()


def _changed(screen: Screen, key: str, value: Any) -> Use:
    """Return the settings after one input has changed."""
    check_names([key], ("instant", "body_weight", "cycle", "contact"), "among the inputs of a cycle")
    if key == "instant" and not (isinstance(value, int) and not isinstance(value, bool)):
        raise ValueError("an instant of a cycle is a whole number")
    if key == "body_weight":
        value = typed(key, value, Unit("N"), Kind.FORCE)
    changes: dict[str, Any] = {key: value if key in ("instant", "body_weight") else str(value)}
    return replace(screen.use, **changes)


def _read_upload(value: Any) -> UploadedCycle:
    """Read an uploaded table."""
    upload = value if isinstance(value, dict) else {}
    name, text, size = str(upload.get("name", "")), upload.get("text"), upload.get("size")
    if not isinstance(text, str) or (isinstance(size, int) and size > _LARGEST) or len(text) > _LARGEST:
        raise ValueError(f"the table is longer than {_LARGEST} characters: a cycle needs some hundred lines")
    return UploadedCycle(name, text)


def _numbers(result: GaitResult, reading: Reading) -> str:
    film = result.film[numpy.isfinite(result.film)]
    force, pressure, _, edge = (course.unit(reading) for course in COURSES)
    least = float(numpy.nanmin(result.edge, initial=numpy.inf))
    cells = [
        number_cell("largest load", float(result.force.max(initial=0.0)) * force.factor, force.text),
        number_cell(
            "largest pressure", float(numpy.nanmax(result.pressure, initial=0.0)) * pressure.factor, pressure.text
        ),
        number_cell("least film", float(film.min()) if len(film) else float("nan"), "nm", result.regime),
        number_cell("nearest to the rim", least * edge.factor, edge.text, result.worst),
        number_cell("utilisation σv/σy", nan if result.utilisation is None else result.utilisation, ""),
        number_cell("sliding in a cycle", result.numbers["slide_mm"] * edge.factor, edge.text),
    ]
    listed = notes_list(result.notes) if result.notes else ""
    return f"{doubt(result.valid)}<dl class='tiles'>{''.join(cells)}</dl>{listed}"
