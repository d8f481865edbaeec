"""Gait: a cycle of the hip, instant by instant: load, pressure, film, distance to the rim."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import partial
from html import escape
from math import nan
from typing import Any

import numpy

from ...core.checks import check_names
from ...core.kinds import Kind, Unit
from ...files.joint_file import JointFile
from ...output import html as page
from ...output.gait_plot import course_figure
from ..fields import typed
from ..gaiting import Gaited, gait_of, gaited
from ..in_use import Own, Use
from ..jobs import CachedRun, ViewJob
from ..player import COURSES, player
from ..reading import Reading
from ..screen import Screen
from ..use_fields import cycle_fields
from ..view import Document, Host
from ..words import doubt, notes_list, number_cell, progress, told

_FOUND: CachedRun = CachedRun(most=24)
_LARGEST = 100_000  # characters of a table


class Gait:
    """The cycle is pressed when it is first looked at, in a process; the page plays it by itself."""

    title = "Gait"
    panel = None
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
        self._job = ViewJob(page.channel, "gait", self._done)
        self._own: Own | None = None
        page.listen("gait", self._edited)

    def show(self, screen: Screen) -> None:
        if screen.use.cycle != self._screen.use.cycle:
            self._own = None
        self._screen = screen
        self._job.put("trouble", "")
        self._page.channel.put_fields({field["name"]: field for field in cycle_fields("gait", screen.use)})
        self._job.put("said", self._words())
        found = _FOUND.get(self._key)
        if found is None:
            self._job.put("numbers", "")
            self._job.put("player", "")
            self._job.ask(self._key, partial(gaited, screen.file, screen.use, self._own))
        else:
            self._job.stop()
            self._job.put("progress", "")
            self._put_found(found)

    @property
    def _key(self) -> Hashable:
        return gait_of(self._screen.file, self._screen.use, self._own)

    def _words(self) -> str:
        aside = "The load is that of the cycle; the force beside the joint is not used."
        own = "" if self._own is None else f" {escape(self._own.name)}: a link does not hold it."
        return f"{aside}{own}"

    def _put_found(self, found: Gaited) -> None:
        instant = self._screen.use.instant
        self._job.put("at", str(found.heaviest if instant is None else min(instant, len(found.phase) - 1)))
        self._job.put("numbers", _numbers(found, self._screen.reading))
        self._job.put("player", player(found, self._screen.reading))

    def _edited(self, key: str, value: Any) -> None:
        if key == "stop":
            self._job.stop()
            self._job.put("progress", progress("Stopped.", None, again="gait.again"))
        elif key == "again":
            self.show(self._screen)
        elif key == "own":
            self._own = _own(value)
            self.show(self._screen)
        else:
            self._page.ask(use=_changed(self._screen, key, value))

    def _done(self, key: Hashable, found: Gaited) -> None:
        _FOUND.put(key, found)
        self._put_found(found)

    def document(self, screen: Screen) -> Document:
        found: Gaited | None = _FOUND.get(self._key)
        if found is None:
            raise ValueError("this cycle has not been pressed yet: wait until it is there")
        reading = screen.reading
        courses = {each.label(reading): each.of(found, reading) for each in COURSES}
        heads = ["phase [%]", *courses]
        rows = numpy.stack([found.phase, *courses.values()], axis=1).tolist()
        listed = page.table(["quantity", "value"], [[name, told(value)] for name, value in found.numbers.items()])
        return Document(
            picture=lambda form: page.drawn(course_figure(found.phase, courses, found.name), form),
            rows=lambda: [heads, *rows],
            sections=lambda: {"gait": (f"A cycle: {found.name}", listed + notes_list(found.notes))},
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        return [], ()

    def leave(self) -> None:
        self._job.stop()


def _changed(screen: Screen, key: str, value: Any) -> Use:
    """What the hip goes through, after one input has been changed."""
    check_names([key], ("instant", "body_weight", "cycle", "contact"), "among the inputs of a cycle")
    if key == "instant" and not (isinstance(value, int) and not isinstance(value, bool)):
        raise ValueError("an instant of a cycle is a whole number")
    if key == "body_weight":
        value = typed(key, value, Unit("N"), Kind.FORCE)
    changes: dict[str, Any] = {key: value if key in ("instant", "body_weight") else str(value)}
    return replace(screen.use, **changes)


def _own(value: Any) -> Own:
    """A table from the browser."""
    given = value if isinstance(value, dict) else {}
    name, text, size = str(given.get("name", "")), given.get("text"), given.get("size")
    if not isinstance(text, str) or (isinstance(size, int) and size > _LARGEST) or len(text) > _LARGEST:
        raise ValueError(f"the table is longer than {_LARGEST} characters: a cycle needs some hundred lines")
    return Own(name, text)


def _numbers(found: Gaited, reading: Reading) -> str:
    film = found.film[numpy.isfinite(found.film)]
    force, pressure, _, edge = (each.unit(reading) for each in COURSES)
    least = float(numpy.nanmin(found.edge, initial=numpy.inf))
    cells = [
        number_cell("largest load", float(found.force.max(initial=0.0)) * force.factor, force.text),
        number_cell(
            "largest pressure", float(numpy.nanmax(found.pressure, initial=0.0)) * pressure.factor, pressure.text
        ),
        number_cell("least film", float(film.min()) if len(film) else float("nan"), "nm", found.regime),
        number_cell("nearest to the rim", least * edge.factor, edge.text, found.worst),
        number_cell("utilisation σv/σy", nan if found.utilisation is None else found.utilisation, ""),
        number_cell("sliding in a cycle", found.numbers["slide_mm"] * edge.factor, edge.text),
    ]
    listed = notes_list(found.notes) if found.notes else ""
    return f"{doubt(found.valid)}<dl class='tiles'>{''.join(cells)}</dl>{listed}"
