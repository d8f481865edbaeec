"""Figures of a wear simulation: wear, penetration, tracks, film, distance to the rim, sensitivity, one cycle."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import accumulate
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy

from ..core.kinds import CUBIC_MILLIMETRES, MILLIONS
from ..core.unit_systems import Amount, Sentence
from ..hip.ball_wear import ball_directions
from ..hip.bands import Bands
from ..hip.history import History, Report
from ..hip.kinematics import tracks
from ..hip.variability import INFLUENCED_RESULTS
from .style import BLUE, finish, new_figure, single_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.arrays import Numbers
    from ..hip.film import Film
    from ..hip.hip_setup import HipSetup

_INK, _SECOND, _THIRD = "#0072B2", "#D55E00", "#009E73"
_HEADROOM = 1.2  # height of the axes relative to the largest value, which leaves room for a legend


def wear_map(history: History, report: Report | None = None) -> Figure:
    """Draw the worn depth over the bore, seen along the cup's axis: the pole in the middle, the rim outside."""
    shown_report = history.last if report is None else report
    title = Sentence("{} after {} cycles; the load leans to the right", *_worn(shown_report.volume, shown_report))
    return _map(history.use, 1e3 * shown_report.wear, "worn depth [µm]", title)


def _worn(volume: float, report: Report) -> tuple[Amount, Amount]:
    return Amount(volume, CUBIC_MILLIMETRES), Amount(report.cycles, MILLIONS)


def cross_shear_map(history: History) -> Figure:
    """Draw the cross-shear of the first cycle over the bore."""
    use = history.use
    exposure = use.exposure(use.unworn)
    field = exposure.cross_shear.reshape(use.grid.rings, -1)
    return _map(use, field, "cross-shear", "0 on a straight track, 0.5 where no direction is preferred")


def ball_map(history: History) -> Figure:
    """Draw the worn depth of the unrotated ball, seen from above: the side is to the right, the front above."""
    grid = history.use.ball_grid
    x, y, z = ball_directions(grid)
    upper, radius = z > 0, float(history.use.joint.ball_radius)
    figure, axes = single_axes(5.6, 4.8)
    depth = 1e3 * history.last.ball_wear[upper]
    shown = axes.tricontourf(radius * x[upper], radius * y[upper], depth, levels=20, cmap="cividis")
    figure.colorbar(shown, ax=axes, label="worn depth [µm]", shrink=0.8)
    axes.set_aspect("equal")
    finish(axes, "to the side [mm]", "to the front [mm]")
    title = Sentence("{} of the ball after {} cycles", *_worn(history.last.ball_volume, history.last))
    axes.set_title(title, fontsize=10)
    return figure


def _map(use: HipSetup, field: Numbers, label: str, title: str) -> Figure:
    """Draw a field (rings, meridians) over the bore, with a cross in the direction of the largest load."""
    figure = new_figure(5.6, 4.8)
    axes: Any = figure.add_subplot(projection="polar")
    azimuth = numpy.append(use.grid.azimuth, use.grid.azimuth[0] + 2 * pi)
    pole = numpy.full_like(field[:1], field[0].mean())
    values = numpy.maximum(numpy.vstack([pole, field, field[-1:]]), 0.0)  # rounding leaves less than nothing
    polar = numpy.degrees([0.0, *use.grid.polar, use.frame.reach])
    closed = numpy.hstack([values, values[:, :1]])
    shown = axes.contourf(azimuth, polar, closed, levels=20, cmap="cividis")
    sizes = numpy.linalg.norm(use.frame.loads, axis=1)
    if len(sizes):
        x, y, z = use.frame.loads[sizes.argmax()] / sizes.max()
        axes.plot(numpy.arctan2(y, x), degrees(numpy.arctan2(numpy.hypot(x, y), z)), "+", color="white", ms=12)
    axes.set_ylim(0, degrees(use.frame.reach))
    axes.set_rgrids([30, 60], ["30°", "60°"], angle=100, color="0.85")
    axes.set_xticks([0, pi / 2, pi, 3 * pi / 2], [""] * 4)
    axes.grid(color="0.6", linewidth=0.4)
    figure.colorbar(shown, ax=axes, label=label, shrink=0.8)
    axes.set_title(title, fontsize=10)
    return figure


def penetration_curve(history: History, bands: Bands | None = None) -> Figure:
    """Draw the penetration over the cycles, with its parts from wear alone and from creep alone.

    The band holds the patients who differ if `bands` is given, and the numerical error otherwise.
    """
    figure, axes = single_axes()
    count = numpy.array([0.0, *(report.cycles / 1e6 for report in history.reports)])
    penetration = numpy.array([0.0, *(report.penetration for report in history.reports)])
    error = history.error.depth * penetration
    low, high = (
        (penetration - error, penetration + error)
        if bands is None
        else ([0.0, *ends] for ends in bands.band("penetration"))
    )
    label = None if bands is None else f"{100 * bands.level:g} % of the {bands.subject}"
    axes.fill_between(count, low, high, color=_INK, alpha=0.2, linewidth=0, label=label)
    if bands is not None and bands.shared is not None:
        low, high = ([0.0, *ends] for ends in bands.population_band("penetration"))
        label = f"{100 * bands.level:g} % of the {bands.noun}, median coefficient"
        axes.fill_between(count, low, high, color=_INK, alpha=0.3, linewidth=0, label=label)
    axes.plot(count, penetration, "o-", color=_INK, ms=4, label="penetration")
    if any(report.creep_depth > 0 for report in history.reports):
        parts = {"wear_displacement": ("wear alone", _SECOND, "--"), "creep_displacement": ("creep alone", _THIRD, ":")}
        for name, (label, colour, dash) in parts.items():
            part = [0.0, *(float(numpy.linalg.norm(getattr(report, name))) for report in history.reports)]
            axes.plot(count, part, dash, color=colour, label=label)
    axes.plot(count, [0.0, *(report.depth for report in history.reports)], "-.", color="0.4", label="deepest wear")
    finish(axes, "million cycles", "depth [mm]")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    return figure


def track_map(history: History) -> Figure:
    """Draw the sliding tracks (mm) of points of the ball on the socket in one cycle, seen along the cup's axis."""
    use = history.use
    figure, axes = single_axes(5.2, 4.8)
    frame = numpy.array(use.frame.placed.frame)
    rotations = numpy.einsum("ij,njk,lk->nil", frame, use.frame.side_cycle.rotations, frame)
    for track in tracks(rotations, _points(use.frame.reach), float(use.joint.ball_radius)):
        axes.plot(track[:, 0], track[:, 1], color=_INK, linewidth=0.8)
    rim = numpy.linspace(0.0, 2 * pi, 200)
    size = float(use.joint.socket_radius) * numpy.sin(min(use.frame.reach, pi / 2))
    axes.plot(size * numpy.cos(rim), size * numpy.sin(rim), color="0.4")
    axes.set_aspect("equal")
    finish(axes, "towards the nearest rim [mm]", "across [mm]")
    return figure


def _points(reach: float) -> Numbers:
    """Return unit vectors of the pole and of three rings of points around it."""
    rings = [(0.0, 1), *((0.85 * reach * share, count) for share, count in ((0.25, 6), (0.5, 12), (0.75, 18)))]
    polar, azimuth = numpy.array([(angle, 2 * pi * i / count) for angle, count in rings for i in range(count)]).T
    across = numpy.sin(polar)
    return numpy.stack([across * numpy.cos(azimuth), across * numpy.sin(azimuth), numpy.cos(polar)])


def film_figure(use: HipSetup, film: Film) -> Figure:
    """Draw the film by the wave, its comparison and the friction moment over the first cycle."""
    figure, axes = single_axes()
    curves = {
        "refreshed part, mean": (film.refreshed_mean, "-", _INK),
        "core, mean": (film.core_mean, "-.", _THIRD),
        "smallest": (film.least, "--", _INK),
        "Hamrock-Dowson, smallest": (film.comparison, ":", "0.5"),
    }
    for label, (values, line, colour) in curves.items():
        if values is not None and numpy.isfinite(values).any():
            axes.plot(*_course(use, 1e6 * values), line, color=colour, label=label)
    finish(axes, "", "film [nm]")
    moment_axes = axes.twinx()
    moment_axes.plot(*_course(use, 1e-3 * numpy.linalg.norm(film.moment, axis=1)), color=_SECOND, linewidth=1.0)
    moment_axes.set_ylabel("moment of friction [N m]", color=_SECOND)
    for either in (axes, moment_axes):
        either.set_ylim(0, _HEADROOM * either.dataLim.ymax or 1.0)
    _over_the_cycle(axes, use)
    return figure


def edge_figure(history: History) -> Figure:
    """Draw the distance (mm) from the contact's edge to the rim over the cycle, unworn and at the end."""
    use, last = history.use, history.last
    figure, axes = single_axes()
    axes.plot(*_course(use, use.edge_distance(use.unworn)), color=_INK, label="unworn")
    label = f"after {last.cycles / 1e6:g} million cycles"
    axes.plot(*_course(use, last.edge_distance), "--", color=_SECOND, label=label)
    worst = last.edge.closest_index(use.frame)
    if worst is not None:
        phase = 100 * use.cycle.phases[use.frame.loaded[worst]]
        axes.plot(phase, last.edge_distance[worst], "o", color=_SECOND, ms=5)
    finish(axes, "", "contact's edge to the rim [mm]")
    axes.set_ylim(-0.2, _HEADROOM * axes.dataLim.ymax or 1.0)  # a line at 0 is seen
    _over_the_cycle(axes, use)
    return figure


def _course(use: HipSetup, values: Numbers) -> tuple[Numbers, Numbers]:
    """Return % of the cycle and values (loaded,) over it, with gaps between activities and where nothing is pressed."""
    course = numpy.full(use.cycle.n_steps, numpy.nan)
    course[use.frame.loaded] = values
    gaps = _ends(use)[:-1]
    return numpy.insert(100 * use.cycle.phases, gaps, numpy.nan), numpy.insert(course, gaps, numpy.nan)


def _ends(use: HipSetup) -> list[int]:
    """Return the steps at which a cycle, or each activity of a mix, ends."""
    return list(accumulate(cycle.n_steps for cycle in use.cycle.activity_cycles))


def _over_the_cycle(axes: Any, use: HipSetup) -> None:
    """Label the horizontal axis and add a legend; a mix has its activities side by side with their names."""
    axes.legend(frameon=False, loc="upper center", ncol=2)
    axes.set_xlim(0, 100)
    cycles = use.cycle.activity_cycles
    if use.cycle.per_year is None:
        axes.set_xlabel("% of the cycle")
        return
    ends = 100 * numpy.array([0, *_ends(use)]) / use.cycle.n_steps
    axes.set_xticks((ends[1:] + ends[:-1]) / 2, [cycle.name for cycle in cycles])
    axes.set_xlabel("each activity from its beginning to its end")
    for end in ends[1:-1]:
        axes.axvline(end, color="0.6", linewidth=0.8)


def share_figure(bands: Bands) -> Figure:
    """Draw first and total Sobol indices of the inputs that differ between patients, with 95 % intervals."""
    indices = bands.indices or {}
    panels = {
        result: {
            order: [indices[f"{order}{end}"][number] for end in ("", "_low", "_high")]
            for order in ("first_order", "total_order")
        }
        for number, result in enumerate(INFLUENCED_RESULTS)
    }
    from .study_plots import draw_indices  # loads the studies

    return draw_indices(panels, [name.replace("_", " ") for name in bands.variability.distributions])


def course_figure(phase: Numbers, courses: Mapping[str, Numbers], title: str) -> Figure:
    """Draw quantities over a cycle, in panels below each other.

    `phase` (instants,) is in %; `courses` has values (instants,) by the label of their axis, NaN where there is none.
    """
    figure = new_figure(6.4, 1.6 * len(courses) + 0.9)
    panels = figure.subplots(len(courses), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, values) in zip(panels, courses.items(), strict=True):
        axes.plot(phase, values, color=BLUE)
        finish(axes, "", label)
        axes.set_ylim(bottom=0)
    panels[-1].set_xlabel("% of the cycle")
    figure.suptitle(title, fontsize=10, parse_math=False)
    return figure
