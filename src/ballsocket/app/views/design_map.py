"""Design map: one answer over two numbers of the joint, with limits; a click presses the joint that is there."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from html import escape
from math import degrees, inf
from typing import Any

import numpy
import panel as pn
from bokeh.models import ColorBar, ColumnDataSource, HoverTool, LinearColorMapper
from bokeh.plotting.contour import contour_data

from ...all_models import catalogue
from ...files import JointFile
from ...html_page import drawn, table
from ...phrases import limit_of, range_of
from ...studies.design import Span, grid
from ...studies.limits import Limit, allowed
from ...studies.parameters import LOADS, PARAMETERS, pressable
from ...studies.run import study
from ...study_figures import design_map, factor, label
from ...study_tables import map_rows
from ..look import PALETTES, chart
from ..screen import QUICK, Axis, Screen
from ..style import html
from ..view import Ask, Document

SHOWN = ("max_pressure", "area", "half_angle", "indentation", "stiffness")
_POINTS = 61
_LEVELS = 14


class DesignMap:
    """A map that is computed as one study by a model that answers at once."""

    title = "Design map"

    def __init__(self, ask: Ask, screen: Screen) -> None:
        self._ask, self._screen, self._putting = ask, screen, False
        self._palette = PALETTES[screen.theme]
        names = [name for name in PARAMETERS if name != "half_angle"]
        self._across = pn.widgets.Select(label="Across", options=names, width=170)
        self._up = pn.widgets.Select(label="Upwards", options=names, width=170)
        self._ranges = {
            "across": pn.widgets.TextInput(label="from..to", width=150),
            "up": pn.widgets.TextInput(label="from..to", width=150),
        }
        self._quantity = pn.widgets.Select(label="Shown", options={label(name): name for name in SHOWN}, width=220)
        self._model = pn.widgets.Select(label="Answered by", options=list(QUICK), width=170)
        self._limits = pn.widgets.TextInput(
            label="Limits, with commas", placeholder="outer_radius<=26 mm, liner_thickness>=4 mm", width=330
        )
        self._watch()
        self._refused, self._told = html(), html()
        self._chart()
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
            pn.pane.Bokeh(self._figure, **wide),
            self._told,
            **wide,
        )

    def _chart(self) -> None:
        self._figure = chart("", "", self._palette, 440)
        self._colours = LinearColorMapper("Viridis256", low=0.0, high=1.0)
        self._image = ColumnDataSource({"image": [], "x": [], "y": [], "dw": [], "dh": []})
        self._pale = ColumnDataSource({"image": [], "x": [], "y": [], "dw": [], "dh": []})
        box = {"x": "x", "y": "y", "dw": "dw", "dh": "dh"}
        image: Any = self._figure.image("image", source=self._image, color_mapper=self._colours, **box)
        self._hover = HoverTool(renderers=[image], tooltips=[("", "@image{0.000}")])
        self._figure.add_tools(self._hover)
        veil = LinearColorMapper([self._palette.paper], low=0.5, high=1.5, low_color="#00000000")
        self._figure.image("image", source=self._pale, color_mapper=veil, global_alpha=0.65, **box)
        flat = numpy.add.outer(numpy.arange(3.0), numpy.arange(3.0))
        self._lines = self._figure.contour(
            *(numpy.arange(3.0),) * 2, flat, levels=[1.0, 2.0], line_color="white", line_width=0.8
        )
        self._ends = self._figure.contour(
            *(numpy.arange(3.0),) * 2, flat, levels=[1.0, 2.0], line_color="white", line_width=2.0, line_dash="dotted"
        )
        self._doubt = ColumnDataSource({"x": [], "y": []})
        self._figure.scatter("x", "y", source=self._doubt, marker="x", size=5, color="white", line_width=1.2)
        self._here = ColumnDataSource({"x": [], "y": []})
        self._figure.scatter(
            "x", "y", source=self._here, size=11, fill_color="white", line_color="black", line_width=1.5
        )
        text = self._palette.text
        self._bar = ColorBar(
            color_mapper=self._colours,
            width=12,
            background_fill_alpha=0.0,
            title_text_color=text,
            major_label_text_color=text,
            title_text_font_style="normal",
        )
        self._figure.add_layout(self._bar, "right")
        self._figure.on_event("tap", self._tapped)

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
            now = _now(self._screen.file, name)
            self._change(**{which: _around(name, now)})

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

    def _tapped(self, event: Any) -> None:
        """The joint at the point that was clicked goes on the screen."""
        chosen = {self._screen.across.name: event.x, self._screen.up.name: event.y}
        try:
            file = _joint_at(self._screen.file, chosen)
        except ValueError as error:
            self._refuse(str(error))
            return
        self._ask(file=file, view="press")

    def show(self, screen: Screen) -> None:
        self._screen = screen
        self._put(screen)
        try:
            found = mapped(screen.file, screen.across, screen.up, screen.map_model)
            self._draw(found, screen)
        except ValueError as error:
            self._refuse(str(error))
            return
        self._refuse("")

    def _put(self, screen: Screen) -> None:
        self._putting = True
        try:
            for which, choice in (("across", self._across), ("up", self._up)):
                axis = getattr(screen, which)
                choice.value = axis.name
                unit = PARAMETERS[axis.name].unit
                self._ranges[which].value = f"{axis.low:g}..{axis.high:g} {'' if unit == '1' else unit}".strip()
            self._quantity.value = screen.quantity if screen.quantity in SHOWN else SHOWN[0]
            self._model.value = screen.map_model
            self._limits.value = ", ".join(map(_phrase, screen.limits))
        finally:
            self._putting = False

    def _draw(self, found: Any, screen: Screen) -> None:
        across, up, name = screen.across, screen.up, screen.quantity
        values = found[name].transpose(up.name, across.name).values * factor(name)
        if numpy.isnan(values).all():
            raise ValueError(f"{screen.map_model} has no answer anywhere on this map: choose another model")
        good = _good(found, screen).transpose(up.name, across.name).values
        valid = found.valid.transpose(up.name, across.name).values
        x, y = found[across.name].values, found[up.name].values
        box = _box(x, y)
        self._colours.update(low=float(numpy.nanmin(values)), high=float(numpy.nanmax(values)))
        self._image.data = {"image": [values], **box}
        self._pale.data = {"image": [(~good).astype(float)], **box}
        levels = _levels(values)
        self._lines.set_data(contour_data(x, y, values, levels, want_fill=False))
        self._ends.set_data(contour_data(x, y, _margin(found, screen), [0.0], want_fill=False))
        grid_x, grid_y = numpy.meshgrid(x, y)
        thinned = (~valid) & (numpy.add.outer(numpy.arange(len(y)), numpy.arange(len(x))) % 4 == 0)
        self._doubt.data = {"x": grid_x[thinned], "y": grid_y[thinned]}
        here = {which: _now(screen.file, getattr(screen, which).name) for which in ("across", "up")}
        self._here.data = {"x": [here["across"]], "y": [here["up"]]}
        self._figure.x_range.update(start=box["x"][0], end=box["x"][0] + box["dw"][0])
        self._figure.y_range.update(start=box["y"][0], end=box["y"][0] + box["dh"][0])
        self._figure.xaxis.axis_label, self._figure.yaxis.axis_label = label(across.name), label(up.name)
        self._bar.title = label(name)
        axes = ((across.name, "$x{0.000}"), (up.name, "$y{0.000}"), (name, "@image{0.000}"))
        self._hover.tooltips = [(label(each), form) for each, form in axes]
        self._told.object = _told(found, screen, bool(valid.all()))

    def document(self, screen: Screen) -> Document:
        found = mapped(screen.file, screen.across, screen.up, screen.map_model)
        flat = found.to_dataframe().reset_index()
        limits = list(_with_rim(screen))
        heads, rows = map_rows(found, limits)
        return Document(
            picture=lambda form: drawn(design_map(found, limits), form),
            rows=[list(flat.columns), *flat.to_numpy(dtype=object).tolist()],
            sections={"map": ("Design map", table(heads, rows))},
        )

    def leave(self) -> None:
        """Nothing runs on."""


@lru_cache(maxsize=16)
def _mapped(joint: Any, load: tuple[tuple[str, float], ...], across: Axis, up: Axis, model: str) -> Any:
    axes: dict[str, Any] = {axis.name: Span(axis.low, axis.high, _POINTS) for axis in (across, up)}
    varied = any(name in axes for name in LOADS)
    design = grid(**axes, **({} if varied else dict(load)))
    return study(catalogue[model], joint, design, quantities=SHOWN)


def mapped(file: JointFile, across: Axis, up: Axis, model: str) -> Any:
    """The study behind a map."""
    return _mapped(file.joint, tuple(file.load.items()), across, up, model)


def _with_rim(screen: Screen) -> tuple[Limit, ...]:
    """Distances from the edge are those of this cup."""
    return tuple(replace(limit, rim=screen.file.cup.rim) for limit in screen.limits)


def _good(found: Any, screen: Screen) -> Any:
    good = allowed(found, _with_rim(screen))
    return good.broadcast_like(found.max_pressure)


def _margin(found: Any, screen: Screen) -> numpy.ndarray:
    """How far inside the nearest limit each point is; far where there is none."""
    nearest = numpy.ones((found.sizes[screen.up.name], found.sizes[screen.across.name]))
    for limit in _with_rim(screen):
        spread = limit.margin(found) + 0.0 * found[screen.across.name] + 0.0 * found[screen.up.name]
        values = spread.transpose(screen.up.name, screen.across.name).values
        nearest = numpy.minimum(nearest, values / max(float(numpy.nanmax(numpy.abs(values))), 1e-300))
    return nearest


def _box(x: numpy.ndarray, y: numpy.ndarray) -> dict[str, list[float]]:
    """Pixels are centred on the points."""
    dx, dy = x[1] - x[0], y[1] - y[0]
    return {
        "x": [float(x[0] - dx / 2)],
        "y": [float(y[0] - dy / 2)],
        "dw": [float(x[-1] - x[0] + dx)],
        "dh": [float(y[-1] - y[0] + dy)],
    }


def _levels(values: numpy.ndarray) -> list[float]:
    from matplotlib.ticker import MaxNLocator

    low, high = float(numpy.nanmin(values)), float(numpy.nanmax(values))
    if not low < high:
        return [low, low + max(abs(low), 1.0)]
    return [float(level) for level in MaxNLocator(_LEVELS).tick_values(low, high)]


def _told(found: Any, screen: Screen, all_valid: bool) -> str:
    good = _good(found, screen)
    name = screen.quantity
    words = [f"{100 * float(good.mean()):.3g} % of the map is allowed by the limits."]
    if bool(good.any()):
        least = found[name].where(good)
        place = least.argmin(...)
        at = {axis: float(found[axis].isel({axis: place[axis]})) for axis in (screen.across.name, screen.up.name)}
        where = ", ".join(f"{PARAMETERS[axis].symbol} {value:.4g} {_unit(axis)}" for axis, value in at.items())
        words.append(f"Least {label(name)} there: <b>{float(least.min()) * factor(name):.4g}</b> at {escape(where)}.")
    if not all_valid:
        words.append("Crosses: the model is not to be trusted there.")
    if not bool(good.all()):
        words.append("Faded: a limit is broken, or there is no answer.")
    words.append("Click a point to press the joint that is there; the circle is the joint now.")
    return f"<p class='quiet'>{' '.join(words)}</p>"


def _unit(name: str) -> str:
    unit = PARAMETERS[name].unit
    return "" if unit == "1" else unit


def _phrase(limit: Limit) -> str:
    """As it would be typed."""
    angle = limit.name == "half_angle"
    low, high = (degrees(end) if angle else end for end in (limit.low, limit.high))
    unit = " deg" if angle else ""
    ends = [f"{limit.name}>={low:.6g}{unit}"] if low > -inf else []
    return ", ".join(ends + ([f"{limit.name}<={high:.6g}{unit}"] if high < inf else []))


def _now(file: JointFile, name: str) -> float:
    """What the joint on the screen has there; NaN where it has no such number."""
    joint = file.joint
    known = {
        "socket_radius": joint.socket_radius,
        "outer_radius": joint.socket_radius + joint.liner_thickness,
        "liner_young": joint.liner.young,
        "liner_poisson": joint.liner.poisson,
        "ball_young": None if joint.ball is None else joint.ball.young,
        "ball_poisson": None if joint.ball is None else joint.ball.poisson,
        **file.load,
    }
    value = known.get(name, getattr(joint, name, None))
    return float("nan") if value is None else float(value)


def _around(name: str, now: float) -> Axis:
    if name.endswith("poisson"):
        return Axis(name=name, low=0.3, high=0.48)
    middle = now if 0 < now < 1e9 else {"force": 3000.0, "indentation": 0.05, "clearance": 0.1}.get(name, 10.0)
    return Axis(name=name, low=float(f"{middle / 2:.2g}"), high=float(f"{2 * middle:.2g}"))


def _joint_at(file: JointFile, chosen: dict[str, float]) -> JointFile:
    """The joint of a point of the map, to four digits; its load, where that is an axis."""
    rounded = {name: float(f"{value:.4g}") for name, value in chosen.items()}
    made, load, possible = pressable(file.joint, rounded)
    if not bool(possible):
        raise ValueError("these numbers make no joint: no liner or no clearance is left")
    plain = replace(
        made,
        ball_radius=round(float(made.ball_radius), 9),
        clearance=round(float(made.clearance), 9),
        liner_thickness=round(float(made.liner_thickness), 9),
        name="",
        source="",
    )
    return replace(file, joint=plain, load={name: float(value) for name, value in load.items()} or file.load)
