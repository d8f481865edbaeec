"""Press: one joint under one load; every model beside the exact answer."""

from __future__ import annotations

import time
from concurrent.futures import Future
from functools import partial
from html import escape
from typing import Any

import panel as pn

from ....catalogue import catalogue, reference
from ....compare import Comparison, successful_contacts
from ....contact import Contact
from ....core.quantities import BEARING, FIELD
from ....files.joint_file import JointFile
from ....reports.figure_files import figure_bytes
from ....reports.press_plots import press_figure
from ....reports.press_report import press_lede, press_sections
from ....reports.style import line_of
from ....studies.derivatives import LocalUncertainty, local_uncertainty
from ...jobs import run_in_thread
from ...pictures.chart import swatch
from ...pictures.section import LinerStresses, liner_stresses, painted_stresses
from ...pressing import fine_curves, press_charts, pressed
from ...state.screen import PAINTED, Screen
from ...view import Document, Host, View
from ...widgets.fields import choice, segments, several
from ...widgets.joint_fields import fields_of, tilt_of
from ...widgets.words import estimate_von_mises, headline, models_table, number_rows
from .drawing import about_the_rim, first_view, frame_of, key

_EVERY = tuple(catalogue)
_PAINTED = {"pressure": "pressure", "stress": "von Mises stress"}
_PATIENCE = 300  # ms until the table of all models follows
_LATE, _WAITS = 0.05, 10  # s: a server that comes so late has others to answer first; how often it may


class Press(View):
    """View of a press: numbers, drawing and curves at once, then the table of all models."""

    title = "Press"

    def __init__(self, page: Host) -> None:
        self._channel = page.channel
        self._screen = page.screen
        self._later: Any = None

    def show(self, screen: Screen) -> None:
        names = tuple(dict.fromkeys((screen.answered_by, *screen.shown)))
        comparison = pressed(screen.file, names)
        by = comparison.contacts.get(screen.answered_by)
        drawn = {name: comparison[name] for name in screen.shown if name in successful_contacts(comparison)}
        lines = {name: line_of(name) for name in drawn}
        if by is None:
            self._channel.put(
                "#press-numbers", f"<p class='trust no'>✗ {escape(comparison.missing[screen.answered_by])}</p>"
            )
        else:
            exact = comparison.contacts.get(reference.name)
            self._channel.put("#press-numbers", headline(by, exact, estimate_von_mises(by), screen.reading))
        self._draw(screen, None if by is None or by.status.failed else by)
        self._channel.put("#press-charts", press_charts(drawn, lines, screen.reading))
        self._channel.put_fields(_fields(screen))
        self._fill_later(screen)

    def _draw(self, screen: Screen, contact: Contact | None) -> None:
        """Draw the joint with its pressure; stresses follow from a thread."""
        self._screen = screen
        if screen.painted == "pressure" or contact is None:
            self._put_drawing(screen, contact, None)
        else:
            run_in_thread(
                lambda: liner_stresses(contact) if screen is self._screen else None,
                partial(self._stressed, screen, contact),
            )

    def _stressed(self, screen: Screen, contact: Contact, outcome: Future[LinerStresses | None]) -> None:
        if screen is self._screen:
            try:
                stresses = outcome.result()
            except ValueError:  # a contact too narrow for it
                stresses = None
            self._put_drawing(screen, contact, stresses)
            self._channel.send()

    def _put_drawing(self, screen: Screen, contact: Contact | None, inside: LinerStresses | None) -> None:
        file, tilt = screen.file, tilt_of(screen.file)
        painted = "" if inside is None else painted_stresses(file, inside, frame_of(file), tilt)
        drawing = first_view(file, contact, fields_of(screen), (tilt, screen.reading.length), painted)
        top = 0.0 if contact is None else float(contact.max_pressure)
        if contact is None:
            legend = ""
        elif inside is None:
            legend = key(
                screen.reading.with_unit(FIELD["pressure"], top), FIELD["pressure"], screen.painted == "stress"
            )
        else:
            legend = key(screen.reading.with_unit(BEARING["von_mises"], inside.largest), BEARING["von_mises"], False)
        self._channel.put("#press-section", drawing + legend + about_the_rim(file, contact, tilt))

    def _fill_later(self, screen: Screen, waits: int = _WAITS) -> None:
        """Schedule the table of all models for a moment without changes."""
        document = pn.state.curdoc
        if document is None:
            self._fill(screen)
            return
        if self._later is not None:
            document.remove_timeout_callback(self._later)
        due = time.monotonic() + _PATIENCE / 1e3
        self._later = document.add_timeout_callback(lambda: self._due(screen, due, waits), _PATIENCE)

    def _due(self, screen: Screen, due: float, waits: int) -> None:
        self._later = None
        if waits and time.monotonic() - due > _LATE:
            self._fill_later(screen, waits - 1)
            return
        self._fill(screen)
        self._channel.send()

    def _fill(self, screen: Screen) -> None:
        comparison = pressed(screen.file, _EVERY)
        self._channel.put("#press-table", models_table(comparison, screen.reading))
        by = successful_contacts(comparison).get(screen.answered_by)
        if by is not None:
            run_in_thread(
                lambda: float(by.von_mises) if screen is self._screen else 0.0,
                partial(self._show_model_stress, screen, comparison),
            )

    def _show_model_stress(self, screen: Screen, comparison: Comparison, outcome: Future[float]) -> None:
        """Show the numbers again, with the von Mises stress of the model itself."""
        if screen is self._screen:
            by, exact = comparison[screen.answered_by], comparison.contacts.get(reference.name)
            self._channel.put("#press-numbers", headline(by, exact, outcome.result(), screen.reading, ""))
            self._channel.send()

    def document(self, screen: Screen) -> Document:
        comparison, units = pressed(screen.file, _EVERY), screen.reading.units
        by = comparison.contacts.get(screen.answered_by)
        drawn = {name: comparison[name] for name in screen.shown if name in successful_contacts(comparison)}
        return Document(
            picture=(lambda form: figure_bytes(press_figure(drawn, fine_curves(drawn, catalogue), units=units), form))
            if drawn
            else None,
            rows=lambda: _rows(comparison, screen),
            sections=lambda: press_sections(comparison, units, surroundings=_local_effects(screen.file)),
            lede=lambda: "" if by is None else press_lede(by, units),
            contact=by,
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        first = (screen.answered_by, *screen.shown)
        return [screen.file], tuple(dict.fromkeys((*first, *_EVERY)))


def _fields(screen: Screen) -> dict[str, Any]:
    names = [(name, name) for name in _EVERY]
    pieces = {name: swatch(line_of(name)) for name in _EVERY}
    return {
        "answered_by": choice("answered_by", "Answered by", names, screen.answered_by),
        "painted": segments("painted", "Painted", [(name, _PAINTED[name]) for name in PAINTED], screen.painted),
        "shown": several("shown", "Curves of", names, screen.shown, pieces),
    }


def _rows(comparison: Comparison, screen: Screen) -> list[list[Any]]:
    """Tabulate the contacts with their notes."""
    heads, *rows = number_rows("model", comparison, screen.reading)
    return [[*heads, "notes"], *([*row, "; ".join(comparison[row[0]].notes)] for row in rows)]


def _local_effects(file: JointFile) -> LocalUncertainty | None:
    """Compute the effect of one percent of each number; None without a load."""
    pressing = any(float(load) > 0 for load in file.load.values())
    return local_uncertainty(file.joint, file.cup, file.load, {}) if pressing else None
