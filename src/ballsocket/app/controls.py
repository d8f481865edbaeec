"""The numbers of a joint as sliders and lists: each edits one entry of the tables of a joint file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from html import escape
from math import inf, isinf, radians
from typing import Any

import panel as pn

from ..io.joint_file import JointFile, joint_of
from ..io.joint_toml import Tables, tables_of
from ..joint.dimensions import DIAMETERS
from ..kinds import Unit
from ..presets import joints, materials
from ..quantities import JOINT, LOADS, MATERIAL, QUANTITIES
from .screen import Screen
from .slider import Number, Slider
from .style import inputs

_OWN, _RIGID = "– own numbers –", "rigid"
_PRESET = "– choose –"


def _number(name: str, table: str, key: str, ends: tuple[float, float], step: float) -> Number:
    """A quantity in the unit that is shown, where the table has that of files."""
    quantity = QUANTITIES[name]
    factor = quantity.shown.factor / quantity.written.factor
    label = f"{table.capitalize()}: {MATERIAL[key].title} {quantity.head()}" if key in MATERIAL else quantity.capital()
    return Number(table=table, key=key, label=label, low=ends[0], high=ends[1], step=step, factor=factor)


_NUMBERS = {
    "ball_radius": _number("ball_radius", "joint", "ball_radius", (5.0, 30.0), 0.1),
    "clearance": _number("clearance", "joint", "clearance", (0.0, 0.5), 0.005),
    "liner_thickness": _number("liner_thickness", "joint", "liner_thickness", (0.5, 20.0), 0.1),
    "outer_radius": _number("outer_radius", "joint", "outer_radius", (10.0, 40.0), 0.1),
    "liner_young": _number("liner_young", "liner", "young", (100.0, 5000.0), 10.0),
    "liner_poisson": _number("liner_poisson", "liner", "poisson", (0.0, 0.4995), 0.005),
    "ball_young": _number("ball_young", "ball", "young", (1e3, 4e5), 1e3),
    "ball_poisson": _number("ball_poisson", "ball", "poisson", (0.0, 0.4995), 0.005),
}
_DIAMETERS = {
    single: replace(
        _NUMBERS[single],
        label=JOINT[double].capital(),
        low=2 * _NUMBERS[single].low,
        high=2 * _NUMBERS[single].high,
        step=2 * _NUMBERS[single].step,
        factor=2 * _NUMBERS[single].factor,
    )
    for double, single in DIAMETERS.items()
}
_LOADS = {
    "force": _number("force", "load", "force", (50.0, 5000.0), 50.0),
    "indentation": _number("indentation", "load", "indentation", (1.0, 200.0), 1.0),
    "half_angle": _number("half_angle", "load", "half_angle", (1.0, 80.0), 0.5),
}
_IN_RADIANS = replace(
    _LOADS["half_angle"],
    label=LOADS["half_angle"].capital(Unit("rad")),
    low=0.02,
    high=1.4,
    step=0.01,
    form="0.[00000]",
    factor=radians(1.0),
)
_LOAD_NAMES = {name.replace("_", " "): name for name in LOADS}


class JointControls:
    """All inputs of a joint and its load.

    Parameters
    ----------
    changed : callable
        Told the joint after every change.
    refused : callable
        Told, in one sentence, why there is no such joint.
    loaded : callable
        Asked for the load of another kind that presses the joint as much as now.
    """

    def __init__(
        self,
        changed: Callable[[JointFile], None],
        refused: Callable[[str], None],
        loaded: Callable[[str], dict[str, float]],
    ) -> None:
        self._changed, self._refused, self._loaded = changed, refused, loaded
        self._putting = False
        self._screen: Screen
        self._file: JointFile
        wide: dict[str, Any] = {"sizing_mode": "stretch_width"}
        self.preset = pn.widgets.Select(label="Start from", options=[_PRESET, *joints], stylesheets=inputs(), **wide)
        self.sliders = {name: Slider(spec, name, self._typed) for name, spec in _NUMBERS.items()}
        self.massive = pn.widgets.Checkbox(label="massive socket (L = ∞)")
        self.liner = pn.widgets.Select(label="Liner", options=[_OWN, *materials], stylesheets=inputs(), **wide)
        self.ball = pn.widgets.Select(label="Ball", options=[_RIGID, _OWN, *materials], stylesheets=inputs(), **wide)
        self.kind = pn.widgets.RadioButtonGroup(
            label="Load given as", options=_LOAD_NAMES, stylesheets=inputs(), **wide
        )
        self.load = Slider(_LOADS["force"], "load", self._typed)
        self.backing = pn.pane.HTML("", **wide)
        self._watch()
        self.panel = pn.Column(
            self.preset,
            self.sliders["ball_radius"].panel,
            self.sliders["clearance"].panel,
            self.sliders["liner_thickness"].panel,
            self.sliders["outer_radius"].panel,
            self.massive,
            self.kind,
            self.load.panel,
            self.liner,
            self.sliders["liner_young"].panel,
            self.sliders["liner_poisson"].panel,
            self.ball,
            self.sliders["ball_young"].panel,
            self.sliders["ball_poisson"].panel,
            self.backing,
            **wide,
        )

    def _watch(self) -> None:
        self.kind.param.watch(self._load_kind, "value")
        self.preset.param.watch(self._start, "value")
        self.massive.param.watch(self._made_massive, "value")
        self.liner.param.watch(lambda event: self._material("liner", event.new), "value")
        self.ball.param.watch(lambda event: self._material("ball", event.new), "value")

    def put(self, screen: Screen) -> None:
        """Set every input to what is on the screen, without an answer."""
        self._putting = True
        try:
            self._put(screen)
        finally:
            self._putting = False

    def _put(self, screen: Screen) -> None:
        file, joint = screen.file, screen.file.joint
        self._screen, self._file = screen, file
        ((kind, _),) = file.load.items()
        named = tables_of(file)
        tables = dict(named)
        for part in ("liner", "ball"):
            material = getattr(joint, part)
            if material is not None:
                tables[part] = {"young": float(material.young), "poisson": float(material.poisson)}
        tables["joint"] = {**tables["joint"], "outer_radius": float(joint.outer_radius)}
        for name, slider in self.sliders.items():
            spec = _DIAMETERS.get(name, _NUMBERS[name]) if screen.size == "diameter" else _NUMBERS[name]
            value = tables.get(spec.table, {}).get(spec.key)
            slider.panel.visible = value is not None and not isinf(value)
            if slider.panel.visible:
                slider.put(spec, value)
        spec = _IN_RADIANS if (kind, screen.angle) == ("half_angle", "radians") else _LOADS[kind]
        self.load.put(spec, tables["load"][kind])
        self.massive.value = isinf(float(joint.liner_thickness))
        self.massive.visible = not joint.backing
        self.kind.value = kind
        self.liner.value = _chosen(named["liner"])
        self.ball.value = _RIGID if joint.ball is None else _chosen(named["ball"])
        self.preset.value = joint.name if joints.get(joint.name) == joint else _PRESET
        behind = "".join(f"<li>{escape(str(layer))}</li>" for layer in joint.backing)
        self.backing.object = f"<p>Behind the liner:</p><ul>{behind}</ul>" if behind else ""

    def _edit(self, change: Callable[[Tables], None], load: dict[str, float] | None = None) -> None:
        """The joint with a change to its tables; its preset's name goes with the first number that differs."""
        if self._putting:
            return
        tables = tables_of(self._file)
        before = joint_of(tables).joint
        try:
            change(tables)
            file = joint_of(tables)
            if file.joint != before:
                tables.pop("name", None)
                tables.pop("source", None)
                file = joint_of(tables)
        except ValueError as error:
            self.put(self._screen)
            self._refused(str(error))
            return
        if load is not None:
            file = replace(file, load=load)
        self._file = file
        self._changed(file)

    def _typed(self, spec: Number, value: float) -> None:
        def change(tables: Tables) -> None:
            if spec.key == "outer_radius":  # in place of the thickness that it fixes
                tables["joint"].pop("liner_thickness")
            tables.setdefault(spec.table, {})[spec.key] = round(value / spec.factor, 12)

        self._edit(change)

    def _load_kind(self, event: Any) -> None:
        if not self._putting:
            load = self._loaded(event.new)
            self._edit(lambda tables: None, load)

    def _start(self, event: Any) -> None:
        if not self._putting and event.new != _PRESET:
            self._file = replace(self._file, joint=joints[event.new])
            self._changed(self._file)

    def _made_massive(self, event: Any) -> None:
        radius = float(self._file.joint.socket_radius)
        thickness = inf if event.new else round(radius / 3, 1)
        self._edit(lambda tables: tables["joint"].update(liner_thickness=thickness))

    def _material(self, part: str, chosen: str) -> None:
        material = getattr(self._file.joint, part)
        if chosen == _RIGID:
            self._edit(lambda tables: tables.pop(part, None))
        elif chosen != _OWN:
            self._edit(lambda tables: tables.update({part: {"material": chosen}}))
        else:
            numbers = {"young": 2e5, "poisson": 0.3}
            if material is not None:
                numbers = {"young": float(material.young), "poisson": float(material.poisson)}
            self._edit(lambda tables: tables.update({part: numbers}))


def _chosen(table: Tables) -> str:
    """The material's name, unless a number differs from it."""
    return str(table["material"]) if list(table) == ["material"] else _OWN
