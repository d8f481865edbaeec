"""Figures of the paper as numbers: panels of curves, and maps, for plots, CSV and JSON files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers, to_numpy
from ..core.quantities import CONTACT, DERIVED, FIELD, JOINT
from ..models.foundation import HessForsbach
from ..problem import Joint
from . import cases


@dataclass(frozen=True, kw_only=True)
class FigureLine:
    """Curve of a model and a case; numbers in the units of the axes of its panel."""

    model: str
    case: str
    x: list[float]
    y: list[float]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """Panel of a figure: axis labels and curves; `highest` is the end of the vertical axis, None for automatic."""

    title: str
    x: str
    y: str
    lines: list[FigureLine]
    highest: float | None = None


@dataclass(frozen=True, kw_only=True)
class Map:
    """Map of a quantity over two axes; `z` has a row for each y, and None for a missing value.

    `about_zero` is true for a deviation, whose sign matters.
    """

    title: str
    x_label: str
    y_label: str
    x: list[float]
    y: list[float]
    z: list[list[float | None]]
    about_zero: bool = False


@dataclass(frozen=True, kw_only=True)
class Figure:
    """Figure of panels or maps; `columns` is their number in a row."""

    title: str
    caption: str
    columns: int
    panels: list[Panel] = field(default_factory=list)
    maps: list[Map] = field(default_factory=list)

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, summary: Mapping[str, Any]) -> Figure:
        """Create a figure from its dictionary."""
        panels = [
            Panel(**{**panel, "lines": [FigureLine(**line) for line in panel["lines"]]}) for panel in summary["panels"]
        ]
        return cls(**{**summary, "panels": panels, "maps": [Map(**entry) for entry in summary["maps"]]})

    @classmethod
    def joined(cls, parts: Iterable[Figure]) -> Figure:
        """Join several figures into one: panels with the same title get the lines of all, in the order of the parts."""
        figures = list(parts)
        panels: dict[str, Panel] = {}
        for panel in (panel for figure in figures for panel in figure.panels):
            known = panels.get(panel.title)
            panels[panel.title] = replace(known, lines=[*known.lines, *panel.lines]) if known else panel
        return replace(
            figures[0], panels=list(panels.values()), maps=[entry for figure in figures for entry in figure.maps]
        )


Models = Mapping[str, Model]
"""Models by their name in the figure."""

FIT = "Eq. (18), Table 3"
"""Name of the paper's closed form in figures of the modulus."""


def _curve(model: str, case: str, x: Any, y: Any) -> FigureLine:
    return FigureLine(model=model, case=case, x=to_numpy(x).ravel().tolist(), y=to_numpy(y).ravel().tolist())


_FORCES = numpy.array([100.0, 200.0, 350.0, 500.0, 750.0, 1000.0, 1500.0, 2000.0, 2500.0, 3000.0, 3500.0, 4000.0])
_CLEARANCES = numpy.linspace(0.05, 0.2, 7)
_RATIOS = numpy.array([0.8, 1.2, 1.8, 2.5, 3.3, 4.2, 5.2, 6.3, 7.5])
_MODULUS = "p0 R2/(d E)"


def figure_2(poisson: float, references: Models) -> Figure:
    """Compute K~ = p0 R2/(d E) by force, clearance and R2/L for one ν, with the published fit."""
    panels = _modulus_panels(poisson, {**references, FIT: HessForsbach()}, f"ν {poisson:g}")
    return Figure(
        title="Figure 2",
        caption="Dimensionless foundation modulus by force (R2 18, L 6.75, c 0.1 mm), by radial clearance, and by R2/L"
        " (outer radius 24 mm), the latter two averaged over 1 to 3 kN.",
        columns=3,
        panels=[Panel(title=title, x=x, y=_MODULUS, lines=lines) for (title, x), lines in panels.items()],
    )


def figure_2_models(poisson: float, models: Models) -> Figure:
    """Compute Figure 2 for one ν with the modulus of every model."""
    panels = _modulus_panels(poisson, models, "")
    return Figure(
        title="Figure 2, with every model",
        caption="The dimensionless modulus p0 R2/(d E) of every model, one row for each Poisson's ratio.",
        columns=3,
        panels=[
            Panel(title=f"ν {poisson:g}, {title}", x=x, y=_MODULUS, lines=lines) for (title, x), lines in panels.items()
        ],
    )


def _modulus_panels(poisson: float, models: Models, case: str) -> dict[tuple[str, str], list[FigureLine]]:
    """Compute the lines of each panel, by title and axis label."""
    hip = cases.hip(poisson)
    wide = cases.joint(head_radius=18.0 - _CLEARANCES, clearance=_CLEARANCES, liner_thickness=6.75, poisson=poisson)
    family = cases.paper_joint(poisson, _RATIOS)
    by_force, by_clearance, by_ratio = [], [], []
    for name, model in models.items():
        by_force.append(_curve(name, case, _FORCES, _scaled_modulus(model, hip, _FORCES)))
        by_clearance.append(_curve(name, case, _CLEARANCES, _mean_modulus(model, wide)))
        by_ratio.append(_curve(name, case, _RATIOS, _mean_modulus(model, family)))
    return {
        ("by force", CONTACT["force"].label()): by_force,
        ("by clearance", JOINT["clearance"].label()): by_clearance,
        ("by R2/L", DERIVED["thickness_ratio"].head()): by_ratio,
    }


def _scaled_modulus(model: Model, joint: Joint, force: Numbers) -> Numbers:
    contact = model.press(joint, force=force)
    return cases.scaled_modulus(contact.max_pressure, contact.indentation, joint.socket_radius)


def _mean_modulus(model: Model, joints: Joint) -> Numbers:
    """Compute the mean dimensionless modulus over 1 to 3 kN."""
    return _scaled_modulus(model, joints, cases.LOADS[:, None]).mean(axis=0)


_STEPS = 25


def figure_3_or_4(number: int, models: Models) -> Figure:
    """Compute force by indentation and pressure by angle at 3 kN: ν 0.4 for Figure 3, 0.45 for Figure 4."""
    poisson = {3: 0.40, 4: 0.45}[number]
    joint = cases.hip(poisson)
    return Figure(
        title=f"Figure {number}",
        caption=f"Force by indentation, and pressure by angle at 3 kN: R2 18, L 6.75, c 0.1 mm, ν {poisson:g}.",
        columns=2,
        panels=[_load_panel("force", "", joint, models), _pressure_panel("pressure at 3 kN", "", joint, models)],
    )


SERIES: dict[str, dict[str, Joint]] = {
    "clearance": {f"c {c:g} mm": cases.joint(clearance=c) for c in (0.05, 0.1, 0.2)},
    "head radius": {f"R1 {r:g} mm": cases.joint(head_radius=r) for r in (11.0, 16.0, 23.0)},
    "liner thickness": {f"L {t:g} mm": cases.joint(liner_thickness=t) for t in (3.0, 6.0, 12.0)},
}
"""Joints of Figure 5, by series."""

_LETTERS = {"clearance": ("a", "b"), "head radius": ("c", "d"), "liner thickness": ("e", "f")}


def figure_5(series: str, case: str, models: Models) -> Figure:
    """Compute force and pressure of one joint of Figure 5, for the two panels of its series."""
    joint = SERIES[series][case]
    axis = _BY_ARC if series == "head radius" else _BY_ANGLE
    first, second = _LETTERS[series]
    return Figure(
        title="Figure 5",
        caption="Force by indentation, and pressure at 3 kN, by clearance, head radius and liner thickness around "
        "R1 16, L 6, c 0.1 mm, ν 0.4. Pressure is shown over the arc R1 φ where the head's radius varies.",
        columns=2,
        panels=[
            _load_panel(f"({first}) {series}: force", case, joint, models),
            _pressure_panel(f"({second}) {series}: pressure at 3 kN", case, joint, models, axis),
        ],
    )


def figure_5_forces(series: str, case: str, models: Models) -> Figure:
    """Compute force by indentation of one joint of Figure 5 with every model, in a separate panel."""
    return Figure(
        title="Figure 5, forces of every model",
        caption="Force by indentation for each joint of Figure 5.",
        columns=3,
        panels=[_load_panel(case, "", SERIES[series][case], models)],
    )


def figure_5_pressures(series: str, case: str, models: Models) -> Figure:
    """Compute pressure by angle of one joint of Figure 5 with every model, in a separate panel."""
    return Figure(
        title="Figure 5, pressures of every model",
        caption="Pressure by angle at 3 kN for each joint of Figure 5.",
        columns=3,
        panels=[_pressure_panel(case, "", SERIES[series][case], models)],
    )


def _load_panel(title: str, case: str, joint: Joint, models: Models) -> Panel:
    forces = 4000.0 * numpy.linspace(0.06, 1.0, _STEPS) ** 2
    depth, force = CONTACT["indentation"], CONTACT["force"]
    lines = []
    for name, model in models.items():
        pressed = model.press(joint, force=forces).indentation * depth.shown.factor
        lines.append(_curve(name, case, numpy.append(0.0, pressed), numpy.append(0.0, forces)))
    return Panel(title=title, x=depth.label(), y=force.label(), lines=lines, highest=float(forces[-1]))


PressureAxis = tuple[str, Callable[[Joint, Numbers], Numbers]]
_BY_ANGLE: PressureAxis = (FIELD["angle"].label(), lambda joint, angle: numpy.degrees(angle))
_BY_ARC: PressureAxis = ("arc from the pole R1 φ [mm]", lambda joint, angle: angle * joint.ball_radius)


def _pressure_panel(title: str, case: str, joint: Joint, models: Models, axis: PressureAxis = _BY_ANGLE) -> Panel:
    """Compute the panel of pressure at 3 kN by angle or arc."""
    label, position = axis
    lines = []
    for name, model in models.items():
        contact = model.press(joint, force=cases.LOAD)
        angle = float(contact.half_angle) * numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 60))
        lines.append(_curve(name, case, position(joint, angle), contact.pressure(angle)))
    return Panel(title=title, x=label, y=FIELD["pressure"].label(), lines=lines)


def figure_6(name: str, model: Model, points: int = 25) -> Figure:
    """Compute maps of peak pressure and contact area at 3 kN over head radius and liner thickness."""
    grid = _CurveGrid(points)
    contact = model.press(grid.joint, force=cases.LOAD)
    return Figure(
        title=f"Figure 6, {name}",
        caption="Peak pressure and contact area at 3 kN by head radius and liner thickness, c 0.1 mm, ν 0.4. Dotted: "
        "outer radius 16 and 26 mm.",
        columns=2,
        maps=[
            grid.map(CONTACT["max_pressure"].label(), contact.max_pressure),
            grid.map(CONTACT["area"].label(), contact.area),
        ],
    )


def figure_6_deviations(quantity: str, name: str, model: Model, reference: Model, points: int = 25) -> Figure:
    """Compute the map of the deviation of a model from a reference in "max_pressure" or "area"."""
    plural, title, symbol = _DEVIATIONS[quantity]
    grid = _CurveGrid(points)
    value, truth = (getattr(solver.press(grid.joint, force=cases.LOAD), quantity) for solver in (model, reference))
    deviation = grid.map(f"{name}: {symbol} over exact [%]", 100 * (value / truth - 1))
    return Figure(
        title=f"Figure 6, {plural} of every model",
        caption=f"How far the {title} of each model lies from the exact one, in %; white is within 1 %.",
        columns=3,
        maps=[replace(deviation, about_zero=True)],
    )


_DEVIATIONS = {"max_pressure": ("pressures", "peak pressure", "p0"), "area": ("areas", "contact area", "area")}
"""Plural, title and symbol of the quantities of the maps of deviations."""


class _CurveGrid:
    """Grid of head radii and liner thicknesses, `points` of each, slightly beyond the outer radii of Table 1."""

    def __init__(self, points: int) -> None:
        self.radius, self.thickness = numpy.linspace(11.0, 23.0, points), numpy.linspace(3.0, 15.0, points)
        R, L = numpy.meshgrid(self.radius, self.thickness)
        self.inside = (cases.OUTER_RADII[0] - 1.5 < R + L) & (cases.OUTER_RADII[1] + 1.5 > R + L)
        self.joint = cases.joint(head_radius=R[self.inside], liner_thickness=L[self.inside])

    def map(self, title: str, values: Numbers) -> Map:
        """Create a map of values at the joints of the grid."""
        table = numpy.full(self.inside.shape, numpy.nan)
        table[self.inside] = values
        rows = [[None if numpy.isnan(value) else value for value in row] for row in table.tolist()]
        return Map(
            title=title,
            x_label=JOINT["ball_radius"].label(),
            y_label=JOINT["liner_thickness"].label(),
            x=self.radius.tolist(),
            y=self.thickness.tolist(),
            z=rows,
        )
