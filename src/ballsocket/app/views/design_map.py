"""Design map: one answer over two numbers of the joint, with limits; a click presses the joint that is there."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from math import degrees, inf
from typing import Any

import panel as pn

from ...html_page import drawn, table
from ...phrases import limit_of, range_of
from ...studies.limits import Limit
from ...studies.parameters import PARAMETERS
from ...study_figures import design_map, label
from ...study_tables import map_rows
from ..look import PALETTES
from ..map_chart import MapChart
from ..mapping import around, joint_at, limits_of, mapped, now, told
from ..screen import MAPPED, QUICK, Axis, Screen
from ..style import html
from ..view import Ask, Document


class DesignMap:
    """A map that is computed as one study by a model that answers at once."""

    title = "Design map"

    def __init__(self, ask: Ask, screen: Screen) -> None:
        self._ask, self._screen, self._putting = ask, screen, False
        names = [name for name in PARAMETERS if name != "half_angle"]
        self._across = pn.widgets.Select(label="Across", options=names, width=170)
        self._up = pn.widgets.Select(label="Upwards", options=names, width=170)
        self._ranges = {
            "across": pn.widgets.TextInput(label="from..to", width=150),
            "up": pn.widgets.TextInput(label="from..to", width=150),
        }
        self._quantity = pn.widgets.Select(label="Shown", options={label(name): name for name in MAPPED}, width=220)
        self._model = pn.widgets.Select(label="Answered by", options=list(QUICK), width=170)
        self._limits = pn.widgets.TextInput(
            label="Limits, with commas", placeholder="outer_radius<=26 mm, liner_thickness>=4 mm", width=330
        )
        self._watch()
        self._refused, self._told = html(), html()
        self._chart = MapChart(PALETTES[screen.theme], self._tapped)
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
                flex_wrap="wrap",
                gap="4px 12px",
                **wide,
            ),
            self._refused,
            pn.pane.Bokeh(self._chart.figure, **wide),
            self._told,
            **wide,
        )

    def _watch(self) -> None:
        for name, choice in (("across", self._across), ("up", self._up)):
            choice.param.watch(lambda event, name=name: self._axis(name, event.new), "value")
            self._ranges[name].param.watch(lambda event, name=name: self._range(name, event.new), "value")
        self._quantity.param.watch(lambda event: self._change(quantity=event.new), "value")
        self._model.param.watch(lambda event: self._change(map_model=event.new), "value")
        self._limits.param.watch(self._limited, "value")

    def _change(self, **fields: Any) -> None:
        if self._putting:
            return
        try:
            replace(self._screen, **fields)
        except ValueError as error:
            self._refuse(str(error))
            return
        self._ask(**fields)

    def _refuse(self, sentence: str) -> None:
        self._refused.object = f"<p class='refused' role='alert'>{escape(sentence)}</p>" if sentence else ""

    def _axis(self, which: str, name: str) -> None:
        """Another parameter, over half to twice what the joint has now."""
        if not self._putting:
            self._change(**{which: around(name, now(self._screen.file, name))})

    def _range(self, which: str, text: str) -> None:
        if self._putting:
            return
        name = getattr(self._screen, which).name
        try:
            _, low, high = range_of(f"{name}={text}")
        except ValueError as error:
            self._refuse(str(error))
            return
        self._change(**{which: Axis(name=name, low=low, high=high)})

    def _limited(self, event: Any) -> None:
        if self._putting:
            return
        try:
            limits = tuple(limit_of(phrase) for phrase in event.new.split(",") if phrase.strip())
        except ValueError as error:
            self._refuse(str(error))
            return
        self._change(limits=limits)

    def _tapped(self, x: float, y: float) -> None:
        """The joint at the point that was clicked goes on the screen."""
        chosen = {self._screen.across.name: x, self._screen.up.name: y}
        try:
            file = joint_at(self._screen.file, chosen)
        except ValueError as error:
            self._refuse(str(error))
            return
        self._ask(file=file, view="press")

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._put(screen)
        try:
            found = mapped(screen.file, screen.across, screen.up, screen.map_model)
            self._chart.show(found, screen)
        except ValueError as error:
            self._refuse(str(error))
            return
        self._refuse("")
        self._told.object = told(found, screen)

    def _put(self, screen: Screen) -> None:
        self._putting = True
        try:
            for which, choice in (("across", self._across), ("up", self._up)):
                axis = getattr(screen, which)
                choice.value = axis.name
                unit = PARAMETERS[axis.name].unit
                self._ranges[which].value = f"{axis.low:g}..{axis.high:g} {'' if unit == '1' else unit}".strip()
            self._quantity.value = screen.quantity
            self._model.value = screen.map_model
            self._limits.value = ", ".join(map(_phrase, screen.limits))
        finally:
            self._putting = False

    def document(self, screen: Screen) -> Document:
        found = mapped(screen.file, screen.across, screen.up, screen.map_model)
        flat = found.to_dataframe().reset_index()
        limits = list(limits_of(screen))
        heads, rows = map_rows(found, limits)
        return Document(
            picture=lambda form: drawn(design_map(found, limits), form),
            rows=[list(flat.columns), *flat.to_numpy(dtype=object).tolist()],
            sections={"map": ("Design map", table(heads, rows))},
        )

    def leave(self) -> None:
        """Nothing runs on."""


def _phrase(limit: Limit) -> str:
    """As it would be typed."""
    angle = limit.name == "half_angle"
    low, high = (degrees(end) if angle else end for end in (limit.low, limit.high))
    unit = " deg" if angle else ""
    ends = [f"{limit.name}>={low:.6g}{unit}"] if low > -inf else []
    return ", ".join(ends + ([f"{limit.name}<={high:.6g}{unit}"] if high < inf else []))
