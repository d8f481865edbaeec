"""Lubricating films as figures."""

from __future__ import annotations

from math import degrees, inf, pi, sin
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.kinds import NANOMETRES, NEWTONS
from ..core.unit_systems import Amount, Sentence
from ..hip.film import Film
from ..hip.film_cycle import CarriedFilm
from ..lubrication.film import FilmResult
from .cup_map import on_page
from .style import BLUE, INK, LEGEND, ORANGE, VERMILLION, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_NANOMETRES = 1e6
_LEVELS = 14
_LARGEST_SHOWN = 2.0  # largest film in the colours of the map, relative to the central film

_SECTION_POINTS = 301
_FRAME = 1.15  # half width of the map, relative to the contact on the page
_MAPS = 3  # number of instants with a map
_SHOWN = 90.0  # percentile of the films of a cycle that ends the colours
_CORE_LEVEL = 0.5  # level of the mask of the core at its outline


def film_figure(film: FilmResult) -> Figure:
    """Draw a film as a map seen from the opening, and film and pressure along the motion through the load."""
    figure = new_figure(10.4, 4.6)
    map_axes, section_axes = figure.subplots(1, 2)
    colours = _draw_map(map_axes, film)
    figure.colorbar(colours, ax=map_axes, label="film thickness h [nm]", shrink=0.85)
    _draw_section(section_axes, film)
    figure.suptitle(_title(film), fontsize=10, parse_math=False)
    return figure


def _title(film: FilmResult) -> Sentence:
    run = f"{numpy.linalg.norm(film.spin):g} rad/s, {1e3 * film.lubricant.viscosity:g} mPa s; {film.method}"
    thicknesses = (Amount(float(thickness), NANOMETRES) for thickness in (film.central, film.minimum))
    text = f"{film.contact.model.name}, {{}}, {run}: central {{}}, minimum {{}}"
    return Sentence(text, Amount(float(film.contact.force), NEWTONS), *thicknesses)


def _frame(film: FilmResult) -> Numbers:
    """Make the axes of the figure: along the motion, across it, and along the load."""
    load = film.dry.axis
    motion = numpy.cross(film.spin, load)
    if not numpy.linalg.norm(motion) > 0:
        motion = numpy.cross(load, numpy.array([1.0, 0.0, 0.0]))
    motion = motion / numpy.linalg.norm(motion)
    return numpy.stack([motion, numpy.cross(load, motion), load])


def _page(film: FilmResult) -> tuple[Numbers, Numbers, Numbers]:
    """Project the cells in and near the contact to the page: right along the motion, up, and the mask of the cells."""
    local = film.directions @ _frame(film).T
    shown = local[:, 2] > numpy.cos(min(1.3 * film.dry.half_angle, pi / 2))
    up, right = on_page(local[shown])
    return right, up, shown


def _draw_map(axes: Axes, film: FilmResult) -> Any:
    """Draw contours of the film in the contact, with the edge of the dry contact and the direction of motion."""
    from matplotlib.ticker import MaxNLocator

    right, up, shown = _page(film)
    thickness = _NANOMETRES * film.thickness[shown]
    known = numpy.isfinite(thickness)
    highest = _LARGEST_SHOWN * max(_NANOMETRES * film.central, float(numpy.nanmin(thickness)), 1e-6)
    levels = MaxNLocator(_LEVELS).tick_values(0.0, highest)
    colours = axes.tricontourf(right[known], up[known], thickness[known], levels=levels, cmap="viridis", extend="max")
    around = numpy.linspace(0.0, 2 * pi, 181)
    edge = 2 * sin(film.dry.half_angle / 2)
    axes.plot(edge * numpy.cos(around), edge * numpy.sin(around), color=INK, linewidth=1.2, label="edge of the contact")
    arrow = {"arrowstyle": "->", "color": "white", "linewidth": 1.8}
    axes.annotate("", (0.35 * edge, 0.0), (-0.35 * edge, 0.0), arrowprops=arrow)
    axes.text(0.0, 0.05 * edge, "motion of the ball", ha="center", fontsize=8, color="white")
    axes.set(aspect="equal", xlim=(-_FRAME * edge, _FRAME * edge), ylim=(-_FRAME * edge, _FRAME * edge))
    axes.set_axis_off()
    return colours


def _draw_section(axes: Axes, film: FilmResult) -> None:
    """Draw film and pressure along the motion through the load; the inlet is on the left."""
    from matplotlib.tri import LinearTriInterpolator, Triangulation

    right, up, shown = _page(film)
    angle = numpy.linspace(-1.25, 1.25, _SECTION_POINTS) * film.dry.half_angle
    mesh = Triangulation(right, up)
    along, across = 2 * numpy.sin(angle / 2), 0 * angle
    thickness = numpy.nan_to_num(film.thickness[shown], nan=numpy.nan)
    curve = LinearTriInterpolator(mesh, _NANOMETRES * thickness)(along, across)
    axes.plot(numpy.degrees(angle), curve, color=BLUE, label="film h")
    limit = 2.5 * max(_NANOMETRES * film.central, 1e-6)
    axes.set(xlabel="angle from the load along the motion [°]", ylabel="film thickness h [nm]", ylim=(0.0, limit))
    axes.axvline(-degrees(film.dry.half_angle), color=INK, linestyle=":", label="inlet and outlet of the dry contact")
    axes.axvline(degrees(film.dry.half_angle), color=INK, linestyle=":")
    other = axes.twinx()
    pressure = LinearTriInterpolator(mesh, film.pressure[shown])(along, across)
    other.plot(numpy.degrees(angle), pressure, color=VERMILLION, linestyle="--", label="pressure p")
    other.set_ylabel("pressure p [MPa]")
    other.set_ylim(bottom=0.0)
    handles = [*axes.get_legend_handles_labels()[0], *other.get_legend_handles_labels()[0]]
    axes.legend(handles=handles, **LEGEND)
    axes.grid(alpha=0.3)


def cycle_film_figure(film: Film) -> Figure:
    """Draw the film and λ over the cycle, and maps of the film at its least, middle and largest contact."""
    figure = new_figure(10.4, 7.2 if film.carried else 3.8)
    if film.carried is None:
        _draw_course(figure.subplots(), film)
        return figure
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.1))
    upper, lower = parts
    _draw_course(upper.subplots(), film)
    axes = lower.subplots(1, _MAPS)
    colours = _draw_cycle_maps(axes, film, film.carried)
    lower.colorbar(colours, ax=axes, label="film thickness h [nm]", shrink=0.85)
    return figure


def _draw_course(axes: Axes, film: Film) -> None:
    """Draw smallest and mean films over the cycle, with λ on the right."""
    percent = 100 * film.phases
    curves: dict[str, tuple[Numbers | None, str, str]] = {
        "refreshed part, mean": (film.refreshed_mean, "-", BLUE),
        "at the load": (film.central, "--", BLUE),
        "core, mean": (film.core_mean, "-", ORANGE),
        "smallest": (film.least, "--", ORANGE),
        "Hamrock-Dowson, smallest": (film.comparison, ":", "0.4"),
    }
    for label, (values, line, colour) in curves.items():
        if values is not None and numpy.isfinite(values).any():
            axes.plot(percent, _NANOMETRES * values, line, color=colour, label=label)
    axes.set(xlabel="% of the cycle", ylabel="film thickness h [nm]", xlim=(0, 100), yscale="log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("{x:g}")
    axes.grid(alpha=0.3)
    axes.legend(ncols=3, **LEGEND)
    roughness = _NANOMETRES * film.lubricant.roughness
    if 0 < roughness < inf:
        scales: Any = (lambda thickness: thickness / roughness, lambda ratio: ratio * roughness)
        other = axes.secondary_yaxis("right", functions=scales)
        other.yaxis.set_major_formatter("{x:g}")
        other.yaxis.set_minor_formatter("{x:g}")
        other.set_ylabel("film ratio λ")


def _draw_cycle_maps(axes: Any, film: Film, carried: CarriedFilm) -> Any:
    """Draw maps of the film at the instants of least, middle and largest contact; return their colours."""
    from matplotlib.ticker import MaxNLocator

    thickness, core = carried.joined("thickness"), carried.joined("core")
    inside = numpy.isfinite(thickness)
    order = numpy.argsort(inside @ carried.mesh.area)
    instants = sorted({int(order[0]), int(order[len(order) // 2]), int(order[-1])})
    highest = _NANOMETRES * float(numpy.nanpercentile(thickness, _SHOWN))
    levels = MaxNLocator(_LEVELS).tick_values(0.0, max(highest, 1e-6))
    up, right = on_page(carried.mesh.direction)
    colours = None
    for one, index in zip(axes, instants, strict=False):
        cells = inside[index]
        values = _NANOMETRES * thickness[index]
        colours = one.tricontourf(right[cells], up[cells], values[cells], levels=levels, cmap="viridis", extend="max")
        if core[index].any():
            mask = core[index][cells].astype(float)
            one.tricontour(right[cells], up[cells], mask, levels=[_CORE_LEVEL], colors=[VERMILLION])
        rim = numpy.linspace(0.0, 2 * numpy.pi, 181)
        reach = float(numpy.hypot(right, up).max())
        one.plot(reach * numpy.cos(rim), reach * numpy.sin(rim), color="0.5", linewidth=0.8)
        one.set_title(f"{100 * film.phases[index]:.0f} % of the cycle", fontsize=9)
        one.set(aspect="equal")
        one.set_axis_off()
    axes[0].text(0.5, -0.05, "red: core without fresh lubricant", transform=axes[0].transAxes, ha="center", fontsize=8)
    return colours
