"""Makes the tables and figures of `explanation/hip_validation.md`: `python docs/make_hip_validation.py`, by hand."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy
from matplotlib.figure import Figure

import ballsocket as bs
from ballsocket.core.arrays import Numbers
from ballsocket.evidence.hip_wear import INPUTS, PUBLISHED, Predicted, Ratio, patients, ratios, separations, simulators
from ballsocket.hip import Archard, Film, HipSimulation, Lubricant, Stribeck, in_vivo
from ballsocket.reports.style import BLUE, INK, LEGEND, ORANGE, VERMILLION, finish

DOCS = Path(__file__).parent
_UNITS = {"mm3/Mc": "mm³/Mc", "mm3/year": "mm³/year"}
PAGE = DOCS / "explanation" / "hip_validation.md"

BODY_WEIGHT, HEAD_RADIUS = 800.0, 16.0
"""Weight of the patient in N, and radius of the head in mm, of the calculated friction."""

MEASURED_COEFFICIENT = {
    0.12: ("contralateral toe-off", 0.04, 0.03, 0.06),
    0.50: ("contralateral heel strike", 0.06, 0.04, 0.08),
    0.62: ("toe-off", 0.14, 0.09, 0.23),
}
"""Event, and mean, least and largest coefficient by the phase of the cycle, in eight patients.

Source: Damm et al. 2013, doi 10.1371/journal.pone.0078373.
"""

MEASURED_PEAK_FORCE, MEASURED_PEAK_MOMENT, MEASURED_POWER = 248, 0.26, (2.3, 1.4, 3.8)
"""Means of the peaks in % of body weight and in % of body weight times m; mean power in W, with its range.

Source: as above.
"""

LUBRICANTS = {
    "μ 0.06": (Lubricant(friction=0.06), INK, "-"),
    "by the film, μ 0.08 where surfaces touch, Ra 1 µm": (
        Lubricant(friction=Stribeck(boundary=0.08), ball_roughness=0.0, cup_roughness=1e-3),
        BLUE,
        "--",
    ),
    "by the film, μ 0.2 where surfaces touch, Ra 0.1 µm": (
        Lubricant(friction=Stribeck(boundary=0.2), ball_roughness=0.0, cup_roughness=1e-4),
        ORANGE,
        "-.",
    ),
}
"""Lubricants of the calculated friction, with their lines."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WalkingFriction:
    """Friction of the hip of a patient over a cycle of walking.

    Attributes
    ----------
    film : Film
    forces : array (instants,)
        Sizes of the loads in N.
    """

    film: Film
    forces: Numbers

    @cached_property
    def moments(self) -> Numbers:
        """Sizes of the friction moments (instants,) in N mm."""
        return numpy.asarray(numpy.linalg.norm(self.film.moment, axis=1))

    @cached_property
    def coefficients(self) -> Numbers:
        """Friction moments over force and radius of the head (instants,)."""
        return self.moments / (self.forces * HEAD_RADIUS)

    @property
    def relative_moments(self) -> Numbers:
        """Friction moments (instants,) in % of body weight times m."""
        return 0.1 * self.moments / BODY_WEIGHT

    @property
    def power(self) -> float:
        """Mean power in W."""
        return self.film.heat / self.film.duration

    def coefficient_at(self, phase: float) -> float:
        """Interpolate the coefficient at a phase of the cycle, 0 to 1."""
        return float(numpy.interp(phase, self.film.phases, self.coefficients))


@cache
def walking_friction(label: str) -> WalkingFriction:
    """Compute the friction in walking with one of the lubricants."""
    liner = bs.Material(young=1000.0, poisson=0.4)
    joint = bs.Joint(ball_radius=HEAD_RADIUS, clearance=0.1, liner_thickness=7.0, liner=liner)
    cycle = in_vivo("walking", BODY_WEIGHT, 50)
    use = HipSimulation(joint=joint, cycle=cycle, wear=Archard(coefficient=1e-6))
    forces = numpy.asarray(numpy.linalg.norm(cycle.forces, axis=1))
    return WalkingFriction(film=use.film(LUBRICANTS[label][0]), forces=forces)


def friction_column(label: str) -> list[str]:
    """Return the column of the table of friction for one of the lubricants."""
    friction = walking_friction(label)
    return [
        f"{100 * friction.forces.max() / BODY_WEIGHT:.0f} (input)",
        f"{friction.relative_moments.max():.2f}",
        *(f"{friction.coefficient_at(phase):.3f}" for phase in MEASURED_COEFFICIENT),
        f"{friction.power:.1f}",
    ]


def friction_table() -> str:
    """Return the table of friction in walking, measured and calculated, as Markdown."""
    measured = [
        ("peak force, % of body weight", f"{MEASURED_PEAK_FORCE}"),
        ("peak moment, % of body weight times m", f"{MEASURED_PEAK_MOMENT}"),
        *(
            (f"coefficient at {event}", f"{mean} ({least} to {largest})")
            for event, mean, least, largest in MEASURED_COEFFICIENT.values()
        ),
        ("mean power, W", "{} ({} to {})".format(*MEASURED_POWER)),
    ]
    columns = [friction_column(label) for label in LUBRICANTS]
    rows = [(*row, *numbers) for row, numbers in zip(measured, zip(*columns, strict=True), strict=True)]
    return _table(("", "measured", *LUBRICANTS), rows)


def ratio_table(found: Iterable[Ratio]) -> str:
    rows = []
    for each in found:
        one, other = PUBLISHED[each.numerator], PUBLISHED[each.denominator]
        area = "" if each.area is None else f"{each.area:.2f}"
        what = f"{one.description}, over {other.description}"
        rows.append((what, f"{one.value / other.value:.2f}", f"{each.archard:.2f}", area, one.source))
    return _table(("measured over measured", "measured", "Archard", "area law", "source"), rows)


def separation_table(found: Iterable[tuple[str, float, float]]) -> str:
    rows = [
        (
            PUBLISHED[name].description,
            f"{PUBLISHED[name]} mm",
            f"{lateral:.1f} mm",
            f"{distance:.1f} mm",
            PUBLISHED[name].source,
        )
        for name, lateral, distance in found
    ]
    return _table(("what", "measured", "predicted", "distance of the centres", "source"), rows)


def band_table(found: Iterable[Predicted]) -> str:
    rows = []
    for each in found:
        told = PUBLISHED[each.name]
        spread = f" ({told.spread})" if told.spread else ""
        rows.append(
            (
                told.description,
                f"{told}{spread} {_UNITS.get(told.unit, told.unit)}",
                _short(each.median),
                f"{_short(each.low)} to {_short(each.high)}",
                told.source if told.read == "abstract" else f"{told.source} ({told.read})",
            )
        )
    return _table(("what", "measured", "predicted", "95 % of the predictions", "source"), rows)


def _short(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"


def _table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [list(heads), *map(list, rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def inputs() -> str:
    return "\n".join(f"- {each}." for each in INPUTS)


def figure(panels: dict[str, list[Predicted]]) -> Figure:
    """Measured numbers beside the bands of their predictions, a panel for each unit."""
    drawn = Figure(figsize=(9.0, 4.6), layout="constrained")
    for axes, (title, found) in zip(drawn.subplots(1, len(panels)), panels.items(), strict=True):
        for row, each in enumerate(found):
            told = PUBLISHED[each.name]
            axes.plot([each.low, each.high], [row, row], color=BLUE, linewidth=7, alpha=0.3, solid_capstyle="butt")
            axes.plot(each.median, row, "|", color=BLUE, markersize=12)
            axes.errorbar(
                told.value, row, xerr=told.half_width or None, fmt="o", color=VERMILLION, markersize=5, capsize=3
            )
        axes.set_yticks(range(len(found)), [PUBLISHED[each.name].description for each in found], fontsize=8)
        axes.invert_yaxis()
        axes.set_xlim(left=0)
        finish(axes, title, "")
    drawn.suptitle("dots: measured; bars: 95 % of the predictions, whose inputs are assumed", fontsize=10)
    return drawn


def friction_figure() -> Figure:
    """Coefficient of friction and friction moment in walking, calculated and measured in patients."""
    drawn = Figure(figsize=(9.0, 4.6), layout="constrained")
    coefficient_axes, moment_axes = drawn.subplots(1, 2)
    for label, (_, color, line) in LUBRICANTS.items():
        friction, style = walking_friction(label), {"color": color, "linestyle": line, "label": label}
        coefficient_axes.plot(100 * friction.film.phases, friction.coefficients, **style)
        moment_axes.plot(100 * friction.film.phases, friction.relative_moments, **style)
    for phase, (_, mean, least, largest) in MEASURED_COEFFICIENT.items():
        spread = [[mean - least], [largest - mean]]
        name = "measured in eight patients, with ranges" if phase == min(MEASURED_COEFFICIENT) else None
        coefficient_axes.errorbar(100 * phase, mean, yerr=spread, fmt="o", color=VERMILLION, capsize=3, label=name)
    moment_axes.axhline(MEASURED_PEAK_MOMENT, color=VERMILLION, linestyle=":", label="mean of the measured peaks")
    for axes, name in ((coefficient_axes, "coefficient of friction"), (moment_axes, "moment [% of body weight · m]")):
        axes.set(xlim=(0, 100))
        axes.set_ylim(bottom=0)
        finish(axes, "part of the walking cycle [%]", name)
    handles = [*coefficient_axes.get_legend_handles_labels()[0], *moment_axes.get_legend_handles_labels()[0][-1:]]
    drawn.legend(handles=handles, loc="outside lower center", ncols=2, **LEGEND)
    return drawn


def main() -> None:
    shaken, walked = list(simulators()), list(patients())
    found = {
        "inputs": inputs(),
        "ratios": ratio_table(ratios()),
        "separations": separation_table(separations()),
        "bands": band_table([*shaken, *walked]),
        "friction": friction_table(),
    }
    text = PAGE.read_text(encoding="utf-8")
    for name, part in found.items():
        text = re.sub(rf"(?<=% {name} begin\n).*?(?=% {name} end)", f"\n{part}\n\n", text, flags=re.S)
    PAGE.write_text(text, encoding="utf-8")
    panels = {
        unit: [each for each in (*shaken, *walked) if PUBLISHED[each.name].unit in units]
        for unit, units in {"mm³ a million cycles": ("mm3/Mc",), "mm, and mm a year": ("mm", "mm/year")}.items()
    }
    figure(panels).savefig(DOCS / "hip_validation.png", dpi=130)
    friction_figure().savefig(DOCS / "hip_friction.png", dpi=130)


if __name__ == "__main__":
    main()
