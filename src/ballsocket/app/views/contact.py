"""Contact: one joint under one load, along the axis of the cup by any model, otherwise in the real cup."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import replace
from functools import partial
from typing import Any
from weakref import WeakKeyDictionary

from ...comparison import Comparison, successful_contacts
from ...contact import Contact
from ...core.checks import check_names
from ...core.quantities import BEARING, CONTACT, FIELD
from ...elasticity.off_axis.contact import OffAxisContact
from ...files.joint_file import JointFile
from ...model_catalogue import catalogue, reference
from ...question import complete, real_cup_reason
from ...reports.figure_files import figure_bytes
from ...reports.press_plots import press_figure
from ...reports.press_report import press_lede, press_sections
from ...reports.style import line_of
from ..pictures.chart import plain_numbers
from ..pictures.section import LinerStresses, first_view, key, liner_stresses
from ..pressing import (
    AXIAL_CURVES,
    effects_are_slow,
    effects_of,
    fine_curves,
    is_waiting,
    load_curve,
    press_charts,
    pressed,
)
from ..solving import heavy
from ..state.screen import Screen
from ..view import STRESS_PAUSE, Document
from ..widgets.blocks import Block, Content, sentence
from ..widgets.controls import MODEL_LABELS, Control, chosen, fields_of, segments, several
from ..widgets.words import alert, headline, models_table, number_rows
from .real_cup import RealCupView, bore_of, cup_document, is_prepared, pressed_in_cup

_STRESSES: WeakKeyDictionary[Contact, float] = WeakKeyDictionary()
"""Largest von Mises stress (MPa) of contacts for which it was computed: shown again, they have it at once."""

_EVERY = tuple(catalogue)
_PAINTED = {"pressure": "pressure", "stress": "von Mises stress"}
_PAUSE = 0.1  # s without a change until curves and table follow
_NO_STRESSES = "this model has no stresses inside the liner"
_NO_BAND = [sentence("No band from the tolerances here: One input states the reason.")]
_OFFER = "<p class='quiet'>The contact ends near the rim, where the real cup is softer.</p>"


class Press(RealCupView):
    """View of a press: numbers and drawing at once, then the curves and the table of all models."""

    name, title, run_label = "press", "Contact", "Compute the real cup"
    body = """
<div class="first-view">
  <div>
    <div data-field="press.answered_by"></div>
    <div id="press-trouble" role="alert"></div>
    <div id="press-offer"></div><div data-field="press.run"></div>
    <div id="press-numbers"></div><div id="press-band"></div>
  </div>
  <div class="drawing">
    <div id="press-section"></div>
    <div data-field="press.painted"></div>
    <p class="quiet">Drag the arrow, the ball or the liner's border; or move to one with Tab, and use the arrow
    keys.</p>
    <div id="press-charts"></div>
    <details class="fold"><summary>Curves of the models</summary><div data-field="press.shown"></div></details>
  </div>
</div>
<label class="tick" for="press-all"><input type="checkbox" id="press-all">All numbers of each model</label>
<div id="press-table"></div>
"""

    def begin(self) -> None:
        super().begin()
        self._real: OffAxisContact | None = None
        self._curve_key: Hashable = None
        self._curve: dict[str, Any] | None = None  # numbers over the load, from which a page answers at once
        self._requested: Hashable = None  # bore for which the real cup was requested
        self._explained: tuple[str, ...] = ()  # names of numbers whose explanation is open
        self.actions |= {"press.run": self._request_cup, "press.why": self._explain}

    def controls(self, screen: Screen) -> list[Control]:
        lines = {name: line_of(name) for name in _EVERY}
        one_model = bool(self._needs_cup(screen, pressed(screen.file, (screen.answered_by, reference.name))))
        return [
            chosen(screen, "answered_by", "Model", MODEL_LABELS).but(hidden=one_model),
            chosen(screen, "painted", "Colours show", _PAINTED.items(), segments),
            Control(
                several("shown", "Curves of the models", _EVERY, screen.shown, lines),
                lambda names: {"shown": tuple(names)},
            ),
        ]

    def show(self, screen: Screen) -> None:
        self._real = None
        self.expect("charts", "table", "band")
        comparison = pressed(screen.file, tuple(dict.fromkeys((screen.answered_by, reference.name))))
        needs_cup = bool(self._needs_cup(screen, comparison))
        self.channel.put("curve", None if needs_cup or self._curve_key != self._key_of(screen) else self._curve)
        if needs_cup or not screen.asked.tolerances:
            self.put(band=_NO_BAND if screen.asked.tolerances else "")
        if needs_cup:
            self.long.show(screen)
        else:
            self._show_axial(screen, comparison)
        self.later(_PAUSE, partial(self._fill, screen))

    def _needs_cup(self, screen: Screen, comparison: Comparison) -> str:
        """Return the reason for the real cup; it solves an axial load near the rim on request."""
        reason, file = _reason(comparison, screen), screen.file
        if not reason or not (real_cup_reason(file) or self._requested == bore_of(file)):
            return ""
        is_prepared(file)  # notes a bore whose rings are on disk, which needs no work
        return reason

    def _request_cup(self, starts: Any) -> None:
        screen = self.page.screen
        self._requested = bore_of(screen.file) if starts else None
        self.show_inputs(screen)
        self.long.click(starts)
        if starts and is_prepared(screen.file):
            self.show(screen)

    def _show_axial(self, screen: Screen, comparison: Comparison) -> None:
        """Show the numbers of a model of a load along the axis of the cup."""
        self.long.leave()
        near_rim = bool(_reason(comparison, screen))
        numbers: Content
        self.long.put_button(hidden=not near_rim)
        by = comparison.contacts.get(screen.answered_by)
        if by is not None:
            numbers = self._numbers(screen, by, comparison.contacts.get(reference.name), _STRESSES.get(by))
        elif is_waiting(screen.file, screen.answered_by):
            numbers = [sentence(comparison.missing[screen.answered_by])]
        else:
            numbers = alert(comparison.missing[screen.answered_by])
        self.put(trouble="", offer=_OFFER if near_rim else "", numbers=numbers)
        self._draw(screen, None if by is None or by.status.failed else by)

    def _numbers(
        self, screen: Screen, contact: Contact, exact: Contact | None, von_mises: float | None = None
    ) -> list[Any]:
        return headline(contact, exact, screen.file.cup, screen.reading, von_mises, self._explained)

    def _explain(self, names: Any) -> None:
        """Send the explanations of the numbers with these names; the page shows them below their titles."""
        check_names(names if isinstance(names, list) else [names], CONTACT, "among the numbers")
        self._explained = tuple(names)
        self.show(self.page.screen)

    def show_result(self, screen: Screen, result: bool | None) -> None:
        """Show the numbers of the real cup; its bore is set up first if it is new."""
        self.put(offer="")
        if self.long.result(screen) is None:
            self.put(numbers=self._reason(screen))
            self._draw(screen, None)
        else:
            self.expect("numbers", "section")
            self.compute(lambda: pressed_in_cup(screen.file), partial(self._show_real, screen))

    def _show_real(self, screen: Screen, contact: OffAxisContact) -> None:
        self._real = contact
        self.put(numbers=self._numbers(screen, contact, None) + self._reason(screen))
        self._draw(screen, contact)
        self._fill(screen)

    def fail(self, why: str) -> None:
        screen = self.page.screen
        self.put(numbers=[alert(why), *self._reason(screen)])
        self._draw(screen, None)

    def _reason(self, screen: Screen) -> list[Block]:
        """State why the real cup is needed; empty where it is not."""
        reason = self._needs_cup(screen, pressed(screen.file, (screen.answered_by,)))
        if not reason:
            return []
        words = f"Computed by the elastic model of the real cup (sphere), because {reason}."
        return [sentence(text) for text in (words, *complete(screen.file)[1].values())]

    def _draw(self, screen: Screen, contact: Contact | None) -> None:
        """Draw the joint with its pressure; stresses follow from a thread."""
        if screen.painted == "pressure" or contact is None:
            self._put_drawing(screen, contact, None)
        else:
            self.compute(partial(liner_stresses, contact), partial(self._put_drawing, screen, contact))

    def _put_drawing(self, screen: Screen, contact: Contact | None, inside: LinerStresses | None) -> None:
        file = complete(screen.file)[0]
        content: list[Any] = [first_view(file, contact, fields_of(self.page.controls), screen.reading.units, inside)]
        if inside is not None:
            top = screen.reading.with_unit(BEARING["von_mises"], inside.largest)
            content.append(key(top, BEARING["von_mises"]))
        elif contact is not None:
            top = screen.reading.with_unit(FIELD["pressure"], float(contact.max_pressure))
            content.append(key(top, FIELD["pressure"], _NO_STRESSES if screen.painted == "stress" else ""))
        self.put(section=content)

    def _fill(self, screen: Screen) -> None:
        """Show the curves and the table of all models, then the numbers with the stress of the model itself."""
        comparison, reading = pressed(screen.file, _EVERY), screen.reading
        drawn = _drawn(comparison, screen)
        charts = press_charts(drawn, {name: line_of(name) for name in drawn}, reading)
        if self._needs_cup(screen, comparison):
            table = models_table(_with_real(self._real, comparison), reading)
            self.put(charts=[AXIAL_CURVES, charts], table=table)
        else:
            self.put(charts=[charts], table=models_table(comparison, reading))
            self._put_curve(screen)
            self.later(STRESS_PAUSE, partial(self._compute_stress, screen, comparison))

    def _key_of(self, screen: Screen) -> tuple[Any, ...]:
        """Return what the curve depends on: joint, model, kind and largest load of the slider, and the units."""
        (kind,) = screen.file.load
        largest = self.page.controls["load"].field["high"] / screen.reading.unit(CONTACT[kind]).factor
        return screen.file.joint, screen.answered_by, kind, largest, screen.reading

    def _put_curve(self, screen: Screen) -> None:
        """Send the numbers over the load, from zero to the end of the slider, unless the page has them."""
        key, reading = self._key_of(screen), screen.reading
        if key == self._curve_key or heavy(screen.file.joint, screen.answered_by):
            return
        contact, self._curve_key, self._curve = load_curve(*key[:4]), key, None
        if contact is not None:
            shown = {name: plain_numbers(reading.values_of(contact, CONTACT[name]), 5) for name in CONTACT}
            self._curve = {"load": shown.pop(key[2]), "values": shown}
        self.channel.put("curve", self._curve)

    def _compute_stress(self, screen: Screen, comparison: Comparison) -> None:
        if screen.asked.tolerances:
            self.compute(partial(_band, screen), lambda html: self.put(band=html))
        by, exact = (comparison.contacts.get(name) for name in (screen.answered_by, reference.name))
        if by is None or by.status.failed or by in _STRESSES:
            return

        def numbers() -> Content:
            _STRESSES[by] = float(by.von_mises)
            return self._numbers(screen, by, exact, _STRESSES[by])

        self.compute(numbers, lambda content: self.put(numbers=content))

    def document(self, screen: Screen) -> Document:
        comparison, units = pressed(screen.file, _EVERY), screen.reading.units
        if self._needs_cup(screen, comparison):
            return cup_document(screen, lambda contact: _rows(_with_real(contact, comparison), screen))
        by, file = comparison.contacts.get(screen.answered_by), screen.file
        drawn = _drawn(comparison, screen)
        return Document(
            picture=(lambda form: figure_bytes(press_figure(drawn, fine_curves(drawn, catalogue), units=units), form))
            if drawn
            else None,
            rows=lambda: _rows(comparison, screen),
            sections=lambda: press_sections(comparison, units, surroundings=effects_of(file, screen.asked.tolerances)),
            lede=lambda: "" if by is None else press_lede(by, file.cup, units),
            contact=by,
        )

    def asks(self, screen: Screen) -> tuple[list[JointFile], tuple[str, ...]]:
        first = (screen.answered_by, *screen.shown)
        return [screen.file], tuple(dict.fromkeys((*first, *_EVERY)))


def _drawn(comparison: Comparison, screen: Screen) -> dict[str, Contact]:
    """Return the contacts of the models whose curves are shown."""
    contacts = successful_contacts(comparison)
    return {name: contacts[name] for name in screen.shown if name in contacts}


def _band(screen: Screen) -> Content:
    """State between which pressures most joints within the tolerances lie, unless that is not known at once."""
    try:
        effects = None if effects_are_slow(screen.file) else effects_of(screen.file, screen.asked.tolerances)
    except ValueError as error:
        return alert(f"Tolerances: {error}")
    if effects is None or "max_pressure" not in effects.band:
        return _NO_BAND
    low, _, high = (screen.reading.with_unit(CONTACT["max_pressure"], end) for end in effects.band["max_pressure"])
    return [sentence(f"Largest pressure of 95 % of the joints within the tolerances: {low} to {high}", "")]


def _with_real(real: Contact | None, comparison: Comparison) -> Comparison:
    """Return a comparison with the contact in the real cup first."""
    first = {} if real is None else {real.model.name: real}
    return replace(comparison, contacts={**first, **comparison.contacts})


def _reason(comparison: Comparison, screen: Screen) -> str:
    """Return the reason why the screen needs the real cup, judged by the chosen model or the first with a result."""
    contacts = successful_contacts(comparison)
    return real_cup_reason(screen.file, contacts.get(screen.answered_by) or next(iter(contacts.values()), None))


def _rows(comparison: Comparison, screen: Screen) -> list[list[Any]]:
    heads, *rows = number_rows("model", comparison, screen.reading)
    units = screen.reading.units
    return [[*heads, "notes"], *([*row, "; ".join(map(units.sentence, comparison[row[0]].notes))] for row in rows)]
