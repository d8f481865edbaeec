"""Design map: one quantity over two numbers of the joint, with limits; a click shows the design that is there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from html import escape
from typing import Any

import numpy

from ...core.quantities import JOINT, QUANTITIES, SHELL
from ...files.joint_file import JointFile
from ...reports import svg
from ...reports.figure_files import figure_bytes
from ...reports.study_plots import design_map
from ...studies.limits import Limit, allowed, margin_on_plane, relative_margins
from ...studies.study_answer import map_table
from ...studies.task import BOUNDS, EDGE_DISTANCE
from ..pictures.contour_map import MapPlane, contour_map, outlined, read_point
from ..state.screen import AXES, MAPPED, PICKED, MapAxis, Screen
from ..view import Document, View
from ..widgets.blocks import Content, answer_blocks
from ..widgets.controls import Changes, Control, choice, chosen, empty_number, parameter, segments
from ..widgets.design_table import design_table, press_designs, with_drawings, with_stresses
from ..widgets.limit_rows import limit_controls, limit_text, present_value
from ..widgets.reading import Reading, box_text
from ..widgets.words import alert, column_of
from .compare import with_compared
from .map_study import (
    allowed_points,
    best_point,
    catalogue_sizes,
    check_map,
    default_axis,
    joint_at,
    limits_of,
    map_summary,
    mapped,
    models_of,
    move_limit,
    picked_point,
)

_LIMITED = tuple(dict.fromkeys((*MAPPED, EDGE_DISTANCE, *JOINT, *AXES)))  # quantities that the rows of limits offer
_AXIS_LETTERS, _END_WORDS = {"across": "x", "up": "y"}, {"low": "from", "high": "to"}
_PRESENT, _PICKED = "this design", "selected point"
_HINT = (
    "<p class='quiet'>Click the map, or move its cross with the arrow keys and press Enter: the design at that point "
    "is shown here beside the present one, which is the white ring.</p>"
)
_BUTTONS = "".join(
    f"<button type='button' data-tell='map.{event}'>{words}</button> "
    for event, words in (("use", "Use this design"), ("compare", "Add to the comparison"), ("drop", "Close"))
)
_BELOW_ZERO = -1e300
_MAX_LEVELS = 12


def axis_control(screen: Screen, which: str) -> Control:
    """Return the parameter of an axis; another one runs over half to twice its present value.

    The other axis of the map makes way for its own parameter, and takes the present axis.
    """
    axis = getattr(screen, which)
    other = "up" if which == "across" else "across"
    names = [name for name in AXES if name not in SHELL or screen.file.joint.shell or name == axis.name]
    axes = [(name, QUANTITIES[name].input_label(screen.reading.unit(QUANTITIES[name]))) for name in names]

    def read(name: str) -> Changes:
        chosen = {"picked": None, which: default_axis(name, present_value(screen.file, name))}
        return {**chosen, **({other: axis} if name == getattr(screen, other).name else {})}

    return Control(choice(which, f"{_AXIS_LETTERS[which]} axis", axes, axis.name), read)


def end_control(screen: Screen, which: str, end: str) -> Control:
    """Return the input of an end of an axis."""
    label, axis = f"{_AXIS_LETTERS[which]} {_END_WORDS[end]}", getattr(screen, which)
    quantity, spec = QUANTITIES[axis.name], replace(parameter(axis.name), label=label)
    unit = screen.reading.unit(quantity)

    def read(value: Any) -> Changes:
        ends = {**vars(axis), end: spec.meant(value, screen.reading) / quantity.written.factor}
        low, high = (screen.reading.with_unit(quantity, ends[name]) for name in ("low", "high"))
        if not ends["low"] < ends["high"]:
            raise ValueError(f"{quantity.title} from {low} to {high} is not a range: it must end above its start")
        return {which: MapAxis(**ends)}

    return Control(
        empty_number(f"{which}_{end}", label, unit, box_text(getattr(axis, end) * unit.factor, unit.text)), read
    )


class DesignMap(View):
    """View of one quantity over two parameters, computed as one study by a quick model."""

    name, title = "map", "Design map"
    body = """
<div class="inputs-row" id="map-inputs"></div>
<div data-field="map.limits"></div>
<div id="map-trouble" role="alert"></div>
<div class="map-layout">
  <div><div id="map-picture"></div><div id="map-note"></div></div>
  <div>
    <div data-field="map.sizes"></div>
    <p><button type="button" data-tell="map.best">Show the design with the smallest value</button></p>
    <div id="map-point" role="status"></div>
  </div>
</div>
"""

    def begin(self) -> None:
        self.actions |= {
            "map.drag": self._drag,
            "map.pick": lambda value: self._at(*self._in_study(*read_point(value, 2))),
            "map.best": self._best,
            "map.use": lambda value: {"file": self._picked_file(), "picked": None},
            "map.compare": lambda value: with_compared(self.page.screen, self._picked_file()),
            "map.drop": lambda value: {"picked": None},
        }

    def controls(self, screen: Screen) -> list[Control]:
        quantities = [(name, QUANTITIES[name].title) for name in MAPPED]
        across, up = (
            [axis_control(screen, which), *(end_control(screen, which, end) for end in _END_WORDS)]
            for which in _AXIS_LETTERS
        )
        controls = [
            *across,
            chosen(screen, "quantity", "Map of", quantities),
            *up,
            chosen(screen, "map_model", "Model", models_of(screen), name="model"),
            chosen(screen, "sizes", "Sizes at a selected point", PICKED, segments),
        ]
        return [
            *(Control(control.field, checked(screen, control.read, _AXIS_LETTERS)) for control in controls),
            *limit_inputs(screen, mapped),
        ]

    def show(self, screen: Screen) -> None:
        if not self.channel.shown_value("#map-picture"):
            self.put(picture="<p class='quiet'>Preparing the map …</p>", point=_HINT)
        self.expect("picture", "note", "point")
        self.compute(lambda: _drawn(screen), lambda parts: self.put(trouble="", **parts))

    def _drag(self, value: Any) -> Changes:
        """Move the line of a limit through a point."""
        number, *point = read_point(value, 3)
        screen = self.page.screen
        return {"limits": move_limit(mapped(screen), screen, int(number), self._in_study(*point))}

    def _best(self, value: Any) -> Changes:
        best = best_point(mapped(self.page.screen), self.page.screen)
        if best is None:
            raise ValueError("no point of the map keeps the limits: widen the axes or a limit")
        return self._at(*best.values())

    def _in_study(self, x: float, y: float) -> tuple[float, float]:
        """Convert a point in the units of the axes to those of a study."""
        screen = self.page.screen
        across, up = (screen.reading.unit(QUANTITIES[axis.name]).factor for axis in (screen.across, screen.up))
        return x / across, y / up

    def _at(self, x: float, y: float) -> Changes:
        """Select a point, in the units of a study; raise ValueError if it has no joint."""
        screen = self.page.screen
        point = {screen.across.name: x, screen.up.name: y}
        picked = catalogue_sizes(point) if screen.sizes == "catalogue" else point
        joint_at(screen.file, picked)
        return {"picked": tuple(picked.values())}

    def _picked_file(self) -> JointFile:
        picked = picked_point(self.page.screen)
        if picked is None:
            raise ValueError("no point of the map is chosen: click the map first")
        return joint_at(self.page.screen.file, picked)

    def document(self, screen: Screen) -> Document:
        results = mapped(screen)
        limits = list(limits_of(screen))
        return Document(
            picture=lambda form: figure_bytes(design_map(results, limits, units=screen.reading.units), form),
            rows=lambda: study_rows(results, screen.reading),
            sections=lambda: {"map": ("Design map", answer_blocks(map_table(results, limits), screen.reading.units))},
        )


def checked(screen: Screen, read: Callable[[Any], Changes], varied: Iterable[str]) -> Callable[[Any], Changes]:
    """Let an edit be refused for which no map can be computed over the varied axes, "across" and "up"."""

    def checked(value: Any) -> Changes:
        changes = read(value)
        edited = replace(screen, **changes)
        check_map(edited, [getattr(edited, which) for which in varied])
        return changes

    return checked


def limit_inputs(screen: Screen, study_of: Callable[[Screen], Any]) -> list[Control]:
    """Return the rows of limits of a study of the screen; those that the joint does not have are refused."""

    def present(name: str) -> float:
        designs = press_designs({_PRESENT: screen.file}, study_of(screen).attrs["model"], {})
        return present_value(screen.file, name, designs[_PRESENT].contact)

    def change(limits: tuple[Limit, ...]) -> Changes:
        allowed(study_of(screen), limits_of(replace(screen, limits=limits)))
        return {"limits": limits}

    return limit_controls(_LIMITED, screen.limits, screen.reading, present, change)


def _drawn(screen: Screen) -> dict[str, Content]:
    results = mapped(screen)
    return {"picture": map_picture(results, screen), "note": map_summary(results, screen), "point": _point(screen)}


def _point(screen: Screen) -> Content:
    picked = picked_point(screen)
    if picked is None:
        return _HINT
    try:
        file = joint_at(screen.file, picked)
    except ValueError as error:
        return alert(f"the point of the map: {error}")
    files = {_PRESENT: screen.file, _PICKED: file}
    designs = with_drawings(with_stresses(press_designs(files, mapped(screen).attrs["model"], {})))
    return [f"<p>{_BUTTONS}</p>", design_table(designs, _PRESENT, screen, MAPPED)]


def study_rows(results: Any, reading: Reading) -> list[list[Any]]:
    """Tabulate the points of a study for a file, in the units of the page."""
    flat, heads = results.to_dataframe().reset_index(), []
    for column in flat.columns:
        name, quantity = column, BOUNDS.get(column) or QUANTITIES.get(column)
        if quantity is not None:
            name, factor = column_of(quantity, reading)
            flat[column] = flat[column] * factor
        heads.append(name)
    return [heads, *flat.to_numpy(dtype=object).tolist()]


def map_picture(results: Any, screen: Screen) -> str:
    """Draw a map with a ring at the picked point; raise ValueError if it has no result anywhere.

    The part that is undecided is faded, and the part that exceeds a limit once more.
    """
    axes, reading = (screen.across.name, screen.up.name), screen.reading
    label, x_label, y_label = (reading.label(QUANTITIES[name]) for name in (screen.quantity, *axes))
    factor, x_factor, y_factor = (reading.unit(QUANTITIES[name]).factor for name in (screen.quantity, *axes))
    values = results[screen.quantity].transpose(*axes[::-1]).values * factor
    if numpy.isnan(values).all():
        raise ValueError(f"{results.attrs['model']} has no result anywhere on this map: choose another model")
    x, y = results[axes[0]].values * x_factor, results[axes[1]].values * y_factor
    plane = MapPlane(x=x, y=y, x_label=x_label, y_label=y_label)
    picked = screen.picked
    x, y = (present_value(screen.file, name) for name in axes)
    margins = relative_margins(results, limits_of(screen), *axes)
    areas = (plane.contours(values).area(_BELOW_ZERO, 0.0) for values in margins)
    veils = [f'<path class="veil" fill-rule="evenodd" d="{outline}"/>' for outline in areas if outline]
    marks = [
        *plane.crosses(~results.valid.transpose(*axes[::-1]).values),
        *plane.ring(x * x_factor, y * y_factor, "here"),
        *(() if picked is None else plane.ring(picked[0] * x_factor, picked[1] * y_factor, "picked")),
        *_limit_lines(results, screen, plane),
    ]
    levels = svg.levels_between(float(numpy.nanmin(values)), float(numpy.nanmax(values)), _MAX_LEVELS)
    share = 100 * float(allowed_points(results, screen).mean())
    sentence = f"{label} over {x_label} and {y_label}; {share:.3g} % of the map keep the limits"
    return contour_map(plane, values, levels, (label, sentence), marks, "map.pick", veils)


def _limit_lines(results: Any, screen: Screen, plane: MapPlane) -> Iterator[str]:
    """Draw each limit that crosses the map as a line with a handle at its middle."""
    for number, limit in enumerate(limits_of(screen)):
        lines = plane.contours(margin_on_plane(results, limit, screen.across.name, screen.up.name).value).lines(0.0)
        yield from (outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in lines)
        if lines:
            longest = max(lines, key=len)
            yield _handle(number, screen.limits[number], longest[len(longest) // 2], screen.reading)


def _handle(number: int, limit: Limit, point: numpy.ndarray, reading: Reading) -> str:
    """Draw the square of a limit, a slider for mouse, keyboard and screen readers."""
    quantity, text = QUANTITIES[limit.name], limit_text(limit, reading)
    value = (limit.high if numpy.isfinite(limit.high) else limit.low) * reading.unit(quantity).factor
    step = svg.rounded_up((abs(value) or 1.0) / 50)
    right = point[0] < 240
    slider = f'role="slider" aria-label="{escape(quantity.title)}" aria-valuenow="{value:.6g}"'
    return (
        f'<g tabindex="0" {slider} aria-valuetext="{escape(text)}" data-limit="{number}" data-step="{step:g}"'
        f' transform="translate({point[0]:.1f} {point[1]:.1f})">'
        f'<rect class="square" x="-6" y="-6" width="12" height="12"/>'
        f"{svg.text(11 if right else -11, -6, text, 'on', 'start' if right else 'end')}</g>"
    )
