"""Design map: one answer over two numbers of the joint, with limits; a click presses the joint that is there."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from typing import Any

import panel as pn

from ....core.kinds import Unit
from ....core.quantities import QUANTITIES
from ....reports.figure_files import figure_bytes
from ....reports.pages import table
from ....reports.study_plots import design_map
from ....reports.study_tables import map_rows
from ....reports.unit_systems import Units
from ....studies.expressions import parse_limit, parse_range
from ....studies.parameters import PARAMETERS
from ...jobs import run_in_thread
from ...state.screen import AXES, MAP_MODELS, MAPPED, MapAxis, Screen, phrases_of
from ...style import PALETTES, html, inputs
from ...view import Document, Host, View
from ...widgets.reading import Reading
from ...widgets.words import alert, column_of, unit_of_files
from .charts import MapChart
from .worker import (
    MapPoint,
    best_point,
    catalogue_sizes,
    current_value,
    default_axis,
    joint_at,
    limits_of,
    map_summary,
    mapped,
    models_of,
    move_limit,
)


class DesignMap(View):
    """View of one quantity over two parameters, computed as one study by a quick model."""

    title = "Design map"

    def __init__(self, page: Host) -> None:
        self._ask, self._screen, self._putting = page.ask, page.screen, False
        titles = {PARAMETERS[name].title: name for name in AXES}
        self._across = pn.widgets.Select(label="Across", options=titles, width=200, stylesheets=inputs())
        self._up = pn.widgets.Select(label="Upwards", options=titles, width=200, stylesheets=inputs())
        self._ranges = {
            "across": pn.widgets.TextInput(label="from..to", width=150, stylesheets=inputs()),
            "up": pn.widgets.TextInput(label="from..to", width=150, stylesheets=inputs()),
        }
        self._quantity = pn.widgets.Select(
            label="Shown", options={QUANTITIES[name].label(): name for name in MAPPED}, width=220, stylesheets=inputs()
        )
        self._model = pn.widgets.Select(label="Answered by", options=list(MAP_MODELS), width=170, stylesheets=inputs())
        self._limits = pn.widgets.TextInput(
            label="Limits, with commas",
            placeholder="outer_diameter<=52 mm, liner_thickness>=4 mm",
            width=330,
            stylesheets=inputs(),
        )
        self._sizes = pn.widgets.Select(
            label="A click takes",
            options={"any size": "any", "sizes of a catalogue": "catalogue"},
            width=170,
            stylesheets=inputs(),
        )
        self._best = pn.widgets.Button(label="Press the best joint", width=180)
        self._watch()
        self._refused, self._told = html(), html()
        self._chart = MapChart(PALETTES[page.screen.theme], self._tapped, self._dragged)
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self.panel = pn.Column(
            pn.FlexBox(
                self._across,
                self._ranges["across"],
                self._up,
                self._ranges["up"],
                self._quantity,
                self._model,
                self._limits,
                self._sizes,
                flex_wrap="wrap",
                gap="4px 12px",
                **wide,
            ),
            self._refused,
            pn.pane.Bokeh(self._chart.figure, **wide),
            self._told,
            self._best,
            **wide,
        )

    def _watch(self) -> None:
        for name, choice in (("across", self._across), ("up", self._up)):
            self._told_by(choice, partial(self._axis, name))
            self._told_by(self._ranges[name], partial(self._range, name))
        self._told_by(self._quantity, lambda event: self._change(quantity=event.new))
        self._told_by(self._model, lambda event: self._change(map_model=event.new))
        self._told_by(self._limits, self._limited)
        self._told_by(self._sizes, lambda event: self._ask(sizes=event.new))
        self._best.on_click(lambda event: self._press_best())

    def _told_by(self, widget: Any, changed: Callable[[Any], None]) -> None:
        """Call a function when a user changes a widget."""
        widget.param.watch(lambda event: None if self._putting else changed(event), "value")

    def _change(self, **fields: Any) -> None:
        """Request another map; show why it is impossible, and keep the present one."""
        try:
            wanted = replace(self._screen, **fields)
        except ValueError as error:
            self._refuse(error)
            return
        run_in_thread(lambda: _map_of(wanted), partial(self._changed, fields))

    def _changed(self, fields: Mapping[str, Any], outcome: Future[Any]) -> None:
        try:
            outcome.result()
        except ValueError as error:
            self._refuse(error)
        else:
            self._ask(**fields)

    def _refuse(self, error: ValueError) -> None:
        self._put(self._screen)
        self._refused.object = alert(str(error))

    def _axis(self, which: str, event: Any) -> None:
        """Choose another parameter over half to twice its present value."""
        self._change(**{which: default_axis(event.new, current_value(self._screen.file, event.new))})

    def _range(self, which: str, event: Any) -> None:
        name = getattr(self._screen, which).name
        try:
            _, low, high = parse_range(_with_unit(f"{name}={event.new}", name, self._screen.reading))
            axis = MapAxis(name=name, low=low, high=high)
        except ValueError as error:
            self._refuse(error)
            return
        self._change(**{which: axis})

    def _limited(self, event: Any) -> None:
        try:
            phrases = [phrase.strip() for phrase in event.new.split(",") if phrase.strip()]
            limits = tuple(parse_limit(_limit_with_unit(phrase, self._screen.reading)) for phrase in phrases)
        except ValueError as error:
            self._refuse(error)
            return
        self._change(limits=limits)

    def _tapped(self, x: float, y: float) -> None:
        """Press the joint at a clicked point of the map."""
        across, up = self._screen.across, self._screen.up
        if across.low <= x <= across.high and up.low <= y <= up.high:
            self._press({across.name: x, up.name: y})

    def _dragged(self, number: int, point: MapPoint) -> None:
        """Move a limit to the new position of its line."""
        try:
            limits = move_limit(_map_of(self._screen), self._screen, number, point)
        except ValueError as error:
            self.show(self._screen)  # the handle goes back
            self._refuse(error)
        else:
            self._ask(limits=limits)

    def _press_best(self) -> None:
        point = best_point(_map_of(self._screen), self._screen)
        if point is None:
            self._refuse(ValueError("no point of the map is allowed by the limits"))
        else:
            self._press(point)

    def _press(self, point: Mapping[str, float]) -> None:
        try:
            file = joint_at(self._screen.file, catalogue_sizes(point) if self._screen.sizes == "catalogue" else point)
        except ValueError as error:
            self._refuse(error)
            return
        self._ask(file=file, view="press")

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._refused.object = ""
        self._put(screen)
        run_in_thread(lambda: _map_of(screen) if screen is self._screen else None, partial(self._shown, screen))

    def _shown(self, screen: Screen, outcome: Future[Any]) -> None:
        """Draw a finished map, unless a newer one was requested."""
        if screen is not self._screen:
            return
        try:
            results = outcome.result()
            self._chart.show(results, screen)
        except ValueError as error:
            self._chart.clear()
            self._told.object = ""
            self._refuse(error)
            return
        self._told.object = map_summary(results, screen)

    def _put(self, screen: Screen) -> None:
        self._putting = True
        try:
            for which, choice in (("across", self._across), ("up", self._up)):
                axis = getattr(screen, which)
                choice.value = axis.name
                unit = _unit(axis.name, screen.reading)
                low, high = (value * unit.factor for value in (axis.low, axis.high))
                self._ranges[which].value = f"{low:.6g}..{high:.6g} {unit.text}".strip()
            labels = {screen.reading.label(QUANTITIES[name]): name for name in MAPPED}
            self._quantity.param.update(options=labels, value=screen.quantity)
            known = models_of(screen)
            self._model.param.update(options=known, value=screen.map_model)
            self._sizes.value = screen.sizes
            typed = partial(_typed, screen.reading)
            self._limits.value = ", ".join(phrase for limit in screen.limits for phrase in phrases_of(limit, typed))
        finally:
            self._putting = False

    def document(self, screen: Screen) -> Document:
        results = _map_of(screen)
        limits = list(limits_of(screen))

        return Document(
            picture=lambda form: figure_bytes(design_map(results, limits), form),
            rows=lambda: _rows(results, screen.reading),
            sections=lambda: {"map": ("Design map", table(*map_rows(results, limits)))},
        )


def _rows(results: Any, reading: Reading) -> list[list[Any]]:
    """Tabulate the joints in rows, with numbers under names with units."""
    flat, heads = results.to_dataframe().reset_index(), []
    for name in flat.columns:
        quantity = QUANTITIES.get(name)
        if quantity is not None:
            unit = unit_of_files(quantity, reading)
            flat[name] = flat[name] * unit.factor
        heads.append(name if quantity is None else column_of(quantity, unit))
    return [heads, *flat.to_numpy(dtype=object).tolist()]


def _map_of(screen: Screen) -> Any:
    return mapped(screen.file, screen.across, screen.up, screen.map_model)


_TYPED = {"mil": "thou", "°": "deg"}
"""Units as the door for text knows them."""


def _unit(name: str, reading: Reading) -> Unit:
    """Return the unit of typed numbers: that of files, or that of an imperial page."""
    quantity = QUANTITIES[name]
    unit = quantity.written if reading.units is Units.SI else reading.unit(quantity)
    return Unit(
        _TYPED.get(unit.text, unit.text if reading.units is not Units.SI else quantity.kind.assumed_unit), unit.factor
    )


def _typed(reading: Reading, name: str, value: float) -> str:
    """Write a number as it would be typed."""
    unit = _unit(name, reading)
    return f"{value * unit.factor:.6g} {unit.text}".strip()


def _with_unit(phrase: str, name: str, reading: Reading) -> str:
    """Append the page's unit to a phrase that ends in a bare number."""
    bare = name in QUANTITIES and phrase.rstrip()[-1:].isdigit()
    return f"{phrase} {_unit(name, reading).text}".strip() if bare else phrase


def _limit_with_unit(phrase: str, reading: Reading) -> str:
    return _with_unit(phrase, re.split("[<>=≤≥]", phrase)[0].strip(), reading)
