"""What Figures 2 to 6 of the paper show, as numbers: panels of curves, and maps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy

from ..arrays import to_numpy
from ..joint import Joint
from ..models.base import Model
from ..models.modulus import hess_forsbach
from . import cases

Array = numpy.ndarray
Models = Mapping[str, Model]
"""By the name under which they are drawn."""

FIT = "Eq. (18), Table 3"


@dataclass(frozen=True, kw_only=True)
class Line:
    """One curve: `model` says who, `case` what is varied; numbers with the units of the panel's axes."""

    model: str
    case: str
    x: list[float]
    y: list[float]


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One part of a figure."""

    title: str
    x: str
    y: str
    lines: list[Line]


@dataclass(frozen=True, kw_only=True)
class Map:
    """A quantity over two axes; `z` has a row for each y, None where there is nothing."""

    title: str
    x_label: str
    y_label: str
    x: list[float]
    y: list[float]
    z: list[list[float | None]]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """One figure of the paper: panels, or maps."""

    number: int
    caption: str
    panels: list[Panel]
    maps: list[Map]

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return asdict(self)

    @classmethod
    def of(cls, summary: Mapping[str, Any]) -> Figure:
        """From its dictionary."""
        panels = [Panel(**{**panel, "lines": [Line(**line) for line in panel["lines"]]}) for panel in summary["panels"]]
        return cls(
            number=summary["number"],
            caption=summary["caption"],
            panels=panels,
            maps=[Map(**each) for each in summary["maps"]],
        )


def _line(model: str, case: str, x: Any, y: Any) -> Line:
    return Line(model=model, case=case, x=to_numpy(x).ravel().tolist(), y=to_numpy(y).ravel().tolist())


_FORCES = numpy.array([100.0, 200.0, 350.0, 500.0, 750.0, 1000.0, 1500.0, 2000.0, 2500.0, 3000.0, 3500.0, 4000.0])
_CLEARANCES = numpy.linspace(0.05, 0.2, 7)
_RATIOS = numpy.array([0.8, 1.2, 1.8, 2.5, 3.3, 4.2, 5.2, 6.3, 7.5])


def figure_2(references: Models) -> Figure:
    """K~ = p0 R2/(d E) by force, clearance and R2/L for five ν, with the published fit."""
    by_force, by_clearance, by_ratio = [], [], []
    for poisson in cases.POISSON:
        case = f"ν {poisson:g}"
        hip = cases.hip(poisson)
        wide = cases.joint(head_radius=18.0 - _CLEARANCES, clearance=_CLEARANCES, liner_thickness=6.75, poisson=poisson)
        family = cases.by_ratio(_RATIOS, poisson)
        for name, model in references.items():
            by_force.append(_line(name, case, _FORCES, _scaled(model, hip, _FORCES)))
            by_clearance.append(_line(name, case, _CLEARANCES, _scaled(model, wide, cases.LOADS[:, None]).mean(axis=0)))
            by_ratio.append(_line(name, case, _RATIOS, _scaled(model, family, cases.LOADS[:, None]).mean(axis=0)))
        ends = numpy.array([_FORCES[0], _FORCES[-1]])
        by_force.append(_line(FIT, case, ends, _fitted(hip) + 0 * ends))
        by_clearance.append(_line(FIT, case, _CLEARANCES, _fitted(wide) + 0 * _CLEARANCES))
        by_ratio.append(_line(FIT, case, _RATIOS, _fitted(family)))
    label = "dimensionless modulus p0 R2/(δ E)"
    return Figure(
        number=2,
        caption="Dimensionless foundation modulus by force (R2 18, L 6.75, c 0.1 mm), radial clearance and R2/L.",
        panels=[
            Panel(title="by force", x="normal force [N]", y=label, lines=by_force),
            Panel(title="by clearance, mean of 1 to 3 kN", x="radial clearance [mm]", y=label, lines=by_clearance),
            Panel(title="by R2/L, mean of 1 to 3 kN", x="R2/L", y=label, lines=by_ratio),
        ],
        maps=[],
    )


def _scaled(model: Model, joint: Joint, force: Array) -> Array:
    contact = model.press(joint, force=force)
    return cases.scaled_modulus(contact.max_pressure, contact.indentation, joint.socket_radius)


def _fitted(joint: Joint) -> Array:
    """K~ of Eq. (18)."""
    return hess_forsbach(joint) * joint.socket_radius / joint.liner.young


_STEPS = 25


def figure_3_or_4(number: int, models: Models) -> Figure:
    """Force over indentation, and pressure over angle at 3 kN, of all models; ν 0.4 for Figure 3, 0.45 for Figure 4."""
    poisson = {3: 0.40, 4: 0.45}[number]
    joint = cases.hip(poisson)
    loads, pressures = [], []
    for name, model in models.items():
        loads.append(_load_line(name, "", model, joint))
        pressures.append(_pressure_line(name, "", model, joint))
    return Figure(
        number=number,
        caption=f"Force and pressure (at 3 kN) of all models: R2 18, L 6.75, c 0.1 mm, ν {poisson:g}.",
        panels=[
            Panel(title="force", x="indentation δ [µm]", y="normal force [N]", lines=loads),
            Panel(title="pressure at 3 kN", x="polar angle φ [°]", y="contact pressure [MPa]", lines=pressures),
        ],
        maps=[],
    )


def figure_5(models: Models) -> Figure:
    """The same for three series: clearance, head radius, liner thickness."""
    series: dict[str, dict[str, Joint]] = {
        "clearance": {f"ΔR {c:g} mm": cases.joint(clearance=c) for c in (0.05, 0.1, 0.2)},
        "head radius": {f"R1 {r:g} mm": cases.joint(head_radius=r) for r in (11.0, 16.0, 23.0)},
        "liner thickness": {f"L {t:g} mm": cases.joint(liner_thickness=t) for t in (3.0, 6.0, 12.0)},
    }
    panels = []
    for name, joints in series.items():
        pairs = [(case, joint, who, model) for case, joint in joints.items() for who, model in models.items()]
        loads = [_load_line(who, case, model, joint) for case, joint, who, model in pairs]
        pressures = [_pressure_line(who, case, model, joint) for case, joint, who, model in pairs]
        panels.append(Panel(title=f"{name}: force", x="indentation δ [µm]", y="normal force [N]", lines=loads))
        title = f"{name}: pressure at 3 kN"
        panels.append(Panel(title=title, x="polar angle φ [°]", y="contact pressure [MPa]", lines=pressures))
    return Figure(
        number=5,
        caption="Force and pressure by clearance, head radius and liner thickness around R1 16, L 6, ΔR 0.1 mm, ν 0.4.",
        panels=panels,
        maps=[],
    )


def _load_line(name: str, case: str, model: Model, joint: Joint) -> Line:
    forces = 4000.0 * numpy.linspace(0.12, 1.0, _STEPS) ** 2
    contact = model.press(joint, force=forces)
    start = numpy.zeros(1)
    x, y = numpy.append(start, 1e3 * contact.indentation), numpy.append(start, forces)
    return _line(name, case, x, y)


def _pressure_line(name: str, case: str, model: Model, joint: Joint) -> Line:
    contact = model.press(joint, force=cases.LOAD)
    angle = float(contact.half_angle) * numpy.sin(numpy.linspace(0.0, numpy.pi / 2, 60))
    return _line(name, case, numpy.degrees(angle), contact.pressure(angle))


def figure_6(model: Model, points: int = 25) -> Figure:
    """Peak pressure and contact area over head radius and liner thickness at 3 kN, about the outer radii of Table 1."""
    radius, thickness = numpy.linspace(11.0, 23.0, points), numpy.linspace(3.0, 15.0, points)
    R, L = numpy.meshgrid(radius, thickness)
    outer = R + L
    inside = (outer > cases.OUTER_RADII[0] - 1.5) & (outer < cases.OUTER_RADII[1] + 1.5)
    contact = model.press(cases.joint(head_radius=R[inside], liner_thickness=L[inside]), force=cases.LOAD)
    maps = []
    for title, values in (("peak pressure [MPa]", contact.max_pressure), ("contact area [mm²]", contact.area)):
        whole = numpy.full(R.shape, numpy.nan)
        whole[inside] = values
        rows = [[None if numpy.isnan(value) else value for value in row] for row in whole.tolist()]
        axes = {"x_label": "head radius R1 [mm]", "y_label": "liner thickness L [mm]"}
        maps.append(Map(title=title, **axes, x=radius.tolist(), y=thickness.tolist(), z=rows))
    return Figure(
        number=6,
        caption=f"Peak pressure and contact area at 3 kN, ΔR 0.1 mm, ν 0.4, by {model.name}. "
        "Dotted: outer radius 16 and 26 mm.",
        panels=[],
        maps=maps,
    )
