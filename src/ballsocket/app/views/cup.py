"""Cup: the load in the cup as it stands, how near it comes to the rim, and cups that stand otherwise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from html import escape
from math import degrees
from typing import Any

import numpy
from scipy.interpolate import RectBivariateSpline

from ...contact.verdict import EDGE_DISTANCE
from ...core.quantities import CONTACT, CUP, DERIVED, QUANTITIES
from ...design_checks import checks_of
from ...elasticity.off_axis.contact import OffAxisContact
from ...elasticity.off_axis.orientations import Orientations
from ...problem.cup import Cup
from ...reports import svg
from ...reports.figure_files import figure_bytes
from ...reports.orientation_plots import orientation_figure
from ...reports.pages import picture
from ...reports.press_report import rim_sentence
from ..long_view import LongWork, long_body
from ..pictures.bore import METRIC, bare_bore, pressed_bore, pressed_viewer
from ..pictures.contour_map import MapPlane, contour_map, outlined, read_point
from ..state.screen import STANDINGS, Screen
from ..view import Document
from ..widgets.blocks import Block, Content, numbers, sentence
from ..widgets.controls import Changes, Control, by_name, capital, chosen, segments
from ..widgets.joint_controls import cup_controls
from ..widgets.reading import Reading
from ..widgets.words import VERDICT_KINDS, checked, column_of, quantity_cell, trust
from .real_cup import (
    LEWINNEK,
    RealCupView,
    cup_document,
    is_prepared,
    map_orientations,
    orientation_key,
    pressed_in_cup,
)

_TYPICAL = {"inclination": 45.0, "anteversion": 15.0}
_SHOWN = """<div id="cup-numbers"></div><div class="beside">
<figure><figcaption>Pressure on the cup, seen from its opening</figcaption><div id="cup-map"></div></figure>
<figure><figcaption>In three dimensions</figcaption><div id="cup-viewer"></div></figure></div>"""

_NAMED = {**QUANTITIES, "rim_distance": replace(DERIVED["edge_distance"], name="rim_distance")}
_MIN_POINTS, _FINE_POINTS = 4, 61  # values an axis: least for a cubic spline, and of a smooth contour


class CupView(RealCupView):
    """View of the load in the present cup, followed by a map over orientations."""

    name, title, run_label = "cup", "Cup", "Prepare the cup"
    body = f"""{long_body("cup", _SHOWN)}
<figure>
  <figcaption>Cup orientation map</figcaption>
  <div data-field="cup.show"></div>{long_body("cup-stood", '<div id="cup-stood"></div>')}
</figure>
"""

    def begin(self) -> None:
        super().begin()
        work = LongWork(
            self.page,
            "cup-stood",
            "Compute the map",
            lambda screen: orientation_key(screen.file),
            lambda screen: partial(map_orientations, screen.file),
            self._show_map,
            automatic=True,
        )
        self.orientations = self.add(work)
        self.actions |= {
            "cup.usual": lambda value: self._set_angles(_TYPICAL.values()),
            "cup.pick": lambda point: self._set_angles(round(angle, 1) for angle in read_point(point, 2)),
        }

    def controls(self, screen: Screen) -> list[Control]:
        titles = [(name, QUANTITIES[name].title) for name in STANDINGS]
        *own, _ = cup_controls(screen)  # the interface is an input of the finite elements
        return [*own, chosen(screen, "standing", "Map of", titles, segments, "show")]

    def show(self, screen: Screen) -> None:
        is_prepared(screen.file)
        super().show(screen)

    def show_result(self, screen: Screen, result: bool | None) -> None:
        if self.long.result(screen) is None:
            if result is None:
                self.put(map=bare_bore(screen.file.cup, screen.file.cup.arc_of_cover / 2))
            return
        self.expect("numbers", "map", "viewer")
        self.compute(lambda: _drawn(screen), lambda parts: self.put(**parts))
        if "tilt" in screen.file.aim:
            self.orientations.leave()
            self.orientations.put_button(hidden=True)
            self.put(**{"stood-earlier": "", "stood": _NO_MAP})
        else:
            self.orientations.show(screen)

    def _set_angles(self, angles: Iterable[float]) -> Changes:
        """Change inclination and anteversion, in degrees."""
        screen = self.page.screen
        for name, angle in zip(_TYPICAL, angles, strict=True):
            screen = replace(screen, **by_name(cup_controls(screen))[name].read(f"{angle} deg"))
        return {"file": screen.file}

    def _show_map(self, screen: Screen, orientations: Orientations | None) -> None:
        if orientations is None:
            self.put(stood="")
        else:
            self.put(stood=angle_map(orientations, screen.file.cup, screen.standing, screen.reading) + _KEY)

    def document(self, screen: Screen) -> Document:
        orientations: Orientations | None = self.orientations.result(screen)

        def maps() -> dict[str, tuple[str, str]]:
            if orientations is None:
                return {}
            figure = figure_bytes(orientation_figure(orientations, screen.reading.units))
            return {"orientations": ("Cup orientation map", picture(figure, "map"))}

        heads = ["quantity", "value"]
        return cup_document(screen, lambda contact: [heads, *_file_rows(contact, screen.reading)], maps)


_NO_MAP = (
    "<p class='quiet'>A load that is given from the cup's axis turns with the cup: there is no map of orientations.</p>"
)
_KEY = (
    "<p class='quiet'>Dotted: where the contact reaches the rim. Dashed: Lewinnek's zone (1978). Ring: this cup. "
    "Blank: the load points out of the bore, or the rim presses into the ball. "
    "Click, or move the cross by arrow keys and press Enter, to select an orientation.</p>"
)


def _drawn(screen: Screen) -> dict[str, Content]:
    contact, reading = pressed_in_cup(screen.file), screen.reading
    if not float(contact.half_angle) > 0:
        return {"numbers": [_verdict(contact, reading)], "map": "", "viewer": ""}
    return {
        "numbers": _numbers(contact, screen),
        "map": pressed_bore(contact, reading),
        "viewer": pressed_viewer(contact, reading),
    }


def _file_rows(contact: OffAxisContact, reading: Reading) -> Iterator[list[Any]]:
    """Yield the numbers of a file by their names in JSON, each with its unit."""
    for name, value in contact.summary().items():
        quantity = _NAMED.get(name.removesuffix("_deg"))
        if quantity is not None and isinstance(value, float | int):
            heading, factor = column_of(quantity, reading)
            yield [heading, value / quantity.written.factor * factor]
        elif isinstance(value, float | int | str | bool):
            yield [name, value]


def _numbers(contact: OffAxisContact, screen: Screen) -> Content:
    reading = screen.reading
    margin, error = float(contact.edge_margin), float(contact.error["edge_margin"])
    arc = f"{reading.with_unit(CUP['inclination'], margin, error)} of arc"  # with the digits that are known
    cells = [
        quantity_cell(DERIVED[EDGE_DISTANCE], contact.edge_distance, reading, more=arc),
        quantity_cell(CONTACT["max_pressure"], contact.max_pressure, reading),
        quantity_cell(CUP["inclination"], contact.tilt, reading, "tilt of the load"),
        quantity_cell(CONTACT["half_angle"], contact.half_angle, reading),
        quantity_cell(CONTACT["force"], contact.force, reading),
    ]
    checks = checked(checks_of(contact, contact.model.cup), reading)
    notes = trust(contact, contact.notes, reading)
    return [_verdict(contact, reading), numbers(cells), *checks, *notes, _hint(contact)]


def _verdict(contact: OffAxisContact, reading: Reading) -> Block:
    verdict, words = rim_sentence(contact, reading.units)
    return sentence(f"{verdict.sign} {capital(words)}", f"trust {VERDICT_KINDS[verdict]}")


def _hint(contact: OffAxisContact) -> str:
    """Offer the usual orientation for a cup without one."""
    if contact.model.cup.oriented:
        return ""
    angles = escape(" and ".join(f"{name} {angle:g}°" for name, angle in _TYPICAL.items()))
    words = f"This cup opens straight down. Set {angles}"
    return f"<p><button type='button' data-tell='cup.usual'>{words}</button></p>"


def angle_map(orientations: Orientations, cup: Cup, quantity: str, reading: Reading = METRIC) -> str:
    """Draw a field over inclination and anteversion, with the present cup and Lewinnek's zone.

    Complete fields are interpolated by cubic splines, for smooth contours.
    """
    held = orientations.held
    fields = [numpy.where(held, getattr(orientations, name), numpy.nan).T for name in (quantity, "edge_distance")]
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    if min(len(x), len(y)) >= _MIN_POINTS and all(numpy.isfinite(field).all() for field in fields):
        splines = [RectBivariateSpline(y, x, field) for field in fields]
        x, y = (numpy.linspace(axis[0], axis[-1], _FINE_POINTS) for axis in (x, y))
        fields = [spline(y, x) for spline in splines]
    values, edge_distance = fields
    plane = MapPlane(x=x, y=y, x_label=CUP["inclination"].label(), y_label=CUP["anteversion"].label())
    values = numpy.where(numpy.isfinite(values), values, numpy.nan) * reading.unit(QUANTITIES[quantity]).factor
    rim = plane.contours(edge_distance)
    label = reading.label(QUANTITIES[quantity])
    high = float(numpy.nanmax(values, initial=0.0))
    low = float(numpy.nanmin(values, initial=high if quantity == "max_pressure" else 0.0))  # 0 is the rim
    left, right, bottom, top = LEWINNEK
    corner = f'x="{plane.across(left):.1f}" y="{plane.up(top):.1f}"'
    size = f'width="{plane.across(right) - plane.across(left):.1f}" height="{plane.up(bottom) - plane.up(top):.1f}"'
    marks = [
        *(outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in rim.lines(0.0)),
        outlined("rect", "zone", f"{corner} {size}"),
        *plane.ring(degrees(cup.inclination), degrees(cup.anteversion), "here"),
    ]
    labels = label, _map_description(orientations, label, reading)
    return contour_map(plane, values, svg.levels_between(low, high, 7), labels, marks, "cup.pick")


def _map_description(orientations: Orientations, label: str, reading: Reading) -> str:
    free = orientations.held & (orientations.edge_distance > 0)
    if not free.any():
        return f"{label}: in every orientation of the map the contact reaches the rim"
    inclination, anteversion, index = orientations.best(orientations.edge_distance)
    share = f"{100 * free.mean():.0f} % of the orientations keep the contact off the rim"
    apart = reading.with_unit(QUANTITIES["edge_distance"], float(orientations.edge_distance.flat[index]))
    return (
        f"{label} over inclination and anteversion: {share}; furthest, {apart}, at "
        f"inclination {degrees(inclination):.3g}°, anteversion {degrees(anteversion):.3g}°"
    )
