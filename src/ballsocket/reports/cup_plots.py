"""Pictures of a contact off the cup's axis: pressure map beside a section, and a view in three dimensions."""

from __future__ import annotations

from math import cos, degrees, inf, isfinite, pi, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from ..core.kinds import MILLIMETRES, NEWTONS
from ..core.quantities import FIELD
from ..core.storage.atomic_files import write_atomically
from ..core.unit_systems import Amount, Sentence, Units
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import unit_vectors
from ..problem import Support
from .cup_map import draw_map, shown_maximum, shown_pressure
from .style import BLUE, INK, LEGEND, ORANGE, VERMILLION

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def cup_figure(contact: OffAxisContact, units: Units = Units.SI) -> Figure:
    """Draw the pressure on the cup, seen from its opening, beside the section in the plane of load and cup's axis.

    The map is an equal-area projection with the direction of inclination above. It shows rim, edge of the contact, load
    and location of the largest pressure. In the section the dome is above, and the pressure is a band on the bore.

    Parameters
    ----------
    contact : OffAxisContact
        One contact under load, from `OffAxisContactModel.press`.
    units : Units
        Units of every number.

    Raises
    ------
    ValueError
        More than one contact, a contact without load, or a failed one.
    """
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    from .notebook_figure import NotebookFigure

    _ = contact.single_state
    figure = NotebookFigure(figsize=(11.0, 5.2), layout=ConstrainedLayoutEngine(rect=(0.0, 0.09, 1.0, 0.91)))
    map_axes, section_axes = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    filled = draw_map(map_axes, contact, units)
    bar = figure.colorbar(filled, ax=map_axes, shrink=0.8, pad=0.02, format="%g", ticks=list(filled.levels)[1:])
    bar.set_label(FIELD["pressure"].label(units.unit_of(FIELD["pressure"])))
    map_axes.set_title("the cup seen from its opening", fontsize=10, pad=14)
    draw_section(section_axes, contact, units)
    section_axes.set_title("section in the plane of load and cup's axis", fontsize=10, pad=14)
    figure.legend(loc="lower center", ncols=6, **LEGEND)
    force, tilt = Amount(float(contact.force), NEWTONS), f"{degrees(contact.tilt):.3g}°"
    title = Sentence("{}; {} at {} from the cup's axis", contact.joint.dimensions, force, tilt)
    figure.suptitle(units.sentence(title), fontsize=10, parse_math=False)
    return figure


_BALL, _SOLIDS = "0.9", ("#f3e6c4", "#cfd8de", "#e7d9cc", "#dcdcdc")
_THICKEST = 0.8  # largest drawn thickness of a layer, relative to the bore's radius
_BAND = 0.45  # height of the largest pressure, relative to the bore's radius
_BACK = 0.08  # thickness of a rigid backing, relative to the bore's radius


def draw_section(axes: Axes, contact: OffAxisContact, units: Units = Units.SI) -> None:
    """Draw a section with ball, liner and backing, the pressure as a band on the bore, the rim and the load."""
    from matplotlib.patches import Circle

    joint, radius = contact.joint, float(contact.joint.socket_radius)
    outer = _draw_socket(axes, contact, radius)
    middle = float(contact.displacement @ lateral(contact)), float(contact.displacement[2])
    axes.add_patch(Circle(middle, float(joint.ball_radius), facecolor=_BALL, edgecolor=INK, linewidth=0.9))
    _draw_pressure(axes, contact, radius)
    _draw_margin(axes, contact, radius, units)
    _draw_load(axes, contact, float(joint.ball_radius))
    axes.axvline(0.0, color="0.5", linewidth=0.6, linestyle=(0, (8, 3, 2, 3)), zorder=0.5)
    axes.set_aspect("equal")
    axes.set_xlim(-1.04 * outer, 1.04 * outer)
    _label_lengths(axes, units)
    axes.spines[["top", "right"]].set_visible(False)


def _label_lengths(axes: Axes, units: Units) -> None:
    """Label the axes of a section, which is drawn in mm, in a unit of length."""
    from matplotlib.ticker import FuncFormatter, MultipleLocator

    unit = units.written(MILLIMETRES)
    axes.set_xlabel(f"across the cup's axis{unit.text_in_brackets}")
    axes.set_ylabel(f"along the cup's axis{unit.text_in_brackets}")
    if units is not Units.SI:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MultipleLocator(0.5 / unit.factor))
            axis.set_major_formatter(FuncFormatter(lambda millimetres, _: f"{millimetres * unit.factor:.4g}"))


def lateral(contact: OffAxisContact) -> Numbers:
    """Return the unit vector across the cup's axis in the plane of axis and load; the cup's x for an axial load."""
    x, y, _ = contact.force_vector
    size = numpy.hypot(x, y)
    if size <= 1e-9 * contact.force:
        return numpy.array([1.0, 0.0, 0.0])
    return numpy.array([x / size, y / size, 0.0])


def _arc(radius: float, start: float, end: float) -> Numbers:
    """Return points (n, 2) of an arc between two polar angles (rad)."""
    angle = numpy.linspace(start, end, 181)
    return radius * numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)


def _draw_socket(axes: Axes, contact: OffAxisContact, radius: float) -> float:
    """Draw all layers from the liner outwards, and return the radius (mm) of the outermost."""
    joint, cup = contact.joint, contact.model.cup
    thicknesses = [float(joint.liner_thickness), *(float(layer.thickness) for layer in joint.backing)]
    end, rim, inner = float(contact.model.reach_of(joint)), cup.rim, radius
    edge = radius + cup.chamfer
    for number, thickness in enumerate(thicknesses):
        outer = inner + min(thickness, _THICKEST * radius)
        bore = (
            [_arc(inner, -end, end)] if number else [_corner(edge, -rim), _arc(radius, -end, end), _corner(edge, rim)]
        )
        shape = numpy.vstack([*bore, _arc(outer, rim, -rim)])
        axes.fill(*shape.T, facecolor=_SOLIDS[number % len(_SOLIDS)], edgecolor=INK, linewidth=0.9)
        inner, end = outer, rim
    if joint.support is Support.FIXED and thicknesses[-1] < inf:
        shape = numpy.vstack([_arc(inner, -rim, rim), _arc(inner + _BACK * radius, rim, -rim)])
        axes.fill(*shape.T, facecolor="none", edgecolor="0.5", hatch="//////", linewidth=0.0)
        inner += _BACK * radius
    return inner


def _corner(radius: float, angle: float) -> Numbers:
    """Return the point (1, 2) at a radius (mm) and a polar angle (rad)."""
    return radius * numpy.array([[sin(angle), cos(angle)]])


def _draw_pressure(axes: Axes, contact: OffAxisContact, radius: float) -> None:
    """Draw the pressure as a band inwards from the bore, so that the layers stay visible."""
    end, maximum = float(contact.model.reach_of(contact.joint)), shown_maximum(contact)
    angle = numpy.linspace(-end, end, 721)
    out = numpy.stack([numpy.sin(angle), numpy.cos(angle)], axis=-1)
    along = out[:, :1] * lateral(contact) + out[:, 1:] * numpy.array([0.0, 0.0, 1.0])
    share = numpy.minimum(contact.pressure_at(along) / maximum, 1.15)
    foot, top = radius * out, radius * (1 - _BAND * share)[:, None] * out
    axes.fill(*numpy.vstack([foot, top[::-1]]).T, facecolor=BLUE, alpha=0.45, linewidth=0.0, zorder=2.5)
    axes.plot(*top[share > 0].T, color=BLUE, linewidth=1.5, label="pressure on the cut")


def _draw_margin(axes: Axes, contact: OffAxisContact, radius: float, units: Units) -> None:
    """Draw the arc of the bore from the edge of the contact to the rim, or mark the loaded rim."""
    end = float(contact.model.reach_of(contact.joint))
    if contact.edge_loaded:
        label = "contact at the rim" if isfinite(contact.max_pressure) else "contact at the rim: unbounded pressure"
        axes.plot(*_corner(radius, end).T, "s", color=VERMILLION, markersize=6, label=label)
        return
    label = f"{units.short_length(float(contact.edge_distance))} from contact to rim"
    axes.plot(*_arc(radius, end - float(contact.edge_margin), end).T, color=ORANGE, linewidth=3.0, label=label)


def _draw_load(axes: Axes, contact: OffAxisContact, length: float) -> None:
    """Draw the load as an arrow from the ball's centre; a preloaded ball without load has none."""
    if contact.force == 0:
        return
    load = contact.force_vector / contact.force
    tip = 0.5 * length * float(load @ lateral(contact)), 0.5 * length * float(load[2])
    axes.annotate("", tip, (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.8})
    axes.plot(0.0, 0.0, "o", color=INK, markersize=3)


_RINGS, _MERIDIANS = 181, 361
_LINER, _EMPTY, _SEEN = "#d9c9a0", "#eeeeee", 0.01  # least drawn share of the largest pressure
_SIZE = (1100, 900)
_FROM = (0.8, 0.65)  # camera position outside the opening and beside the axis


def cup_view(contact: OffAxisContact, units: Units = Units.SI, *, off_screen: bool = False) -> pyvista.Plotter:
    """Draw the liner in three dimensions, seen from beside its opening, with the pressure on its bore.

    The edge of the contact is a black line; an arrow from the ball's centre shows the load. The ball is left out.

    Parameters
    ----------
    contact : OffAxisContact
        One contact under load, from `OffAxisContactModel.press`.
    units : Units
        Units of the pressure.
    off_screen : bool
        True to draw without a window, for `screenshot`.

    Returns
    -------
    pyvista.Plotter
        `show()` opens it.

    Raises
    ------
    ValueError
        More than one contact, a contact without load, or a failed one.
    ImportError
        The extra `view3d` is not installed.
    """
    _ = contact.single_state
    needs("view3d", "pyvista")
    import pyvista

    plotter = pyvista.Plotter(off_screen=off_screen, window_size=_SIZE)
    plotter.set_background("white")
    to_body = numpy.array(contact.model.cup.frame)  # rows are the cup's axes in the body's frame
    _add_liner(plotter, contact, to_body)
    _add_bore(plotter, contact, to_body, units)
    radius = float(contact.joint.socket_radius)
    edge = 0.999 * radius * numpy.vstack([contact.outline, contact.outline[:1]]) @ to_body
    plotter.add_mesh(pyvista.MultipleLines(edge), color=INK, line_width=3)
    if contact.force > 0:
        load = contact.force_vector / contact.force @ to_body
        arrow = {"tip_length": 0.2, "tip_radius": 0.05, "shaft_radius": 0.015, "scale": 0.9 * radius}
        plotter.add_mesh(pyvista.Arrow(start=(0.0, 0.0, 0.0), direction=load, **arrow), color=VERMILLION)
    out, sideways = _FROM
    eye = -out * to_body[2] - sideways * to_body[0]  # outside the opening, beside the axis and opposite to the load
    plotter.camera_position = [tuple(6.2 * radius * eye), (0.0, 0.0, 0.0), tuple(to_body[0])]
    return plotter


def save_view(contact: OffAxisContact, path: Path, units: Units = Units.SI) -> None:
    """Write the view of `cup_view` as PNG; after an error there is no file.

    Raises ValueError, ImportError: as `cup_view`.
    Raises OSError: a path that cannot be written to.
    """
    plotter = cup_view(contact, units, off_screen=True)
    try:
        with write_atomically(path) as draft:
            plotter.screenshot(str(draft))
    finally:
        plotter.close()


def _add_bore(plotter: Any, contact: OffAxisContact, to_body: Numbers, units: Units) -> None:
    unit = units.unit_of(FIELD["pressure"])
    reach = float(contact.model.reach_of(contact.joint))
    directions = _directions(numpy.linspace(0.0, reach, _RINGS))
    bore = _surface(float(contact.joint.socket_radius) * directions, to_body)
    bore["pressure"] = unit.factor * shown_pressure(contact, directions).ravel(order="F")
    bar = {
        "title": FIELD["pressure"].head(unit),
        "color": "black",
        "vertical": True,
        "below_label": " ",
        "fmt": "%.0f",
        "label_font_size": 18,
    }
    bar |= {"position_x": 0.88, "position_y": 0.2, "height": 0.6, "width": 0.06, "title_font_size": 18}
    maximum = unit.factor * shown_maximum(contact)
    appearance = {
        "cmap": "viridis",
        "clim": (_SEEN * maximum, maximum),
        "below_color": _EMPTY,
        "ambient": 0.45,
        "diffuse": 0.6,
    }
    plotter.add_mesh(bore, scalars="pressure", scalar_bar_args=bar, smooth_shading=True, **appearance)


def _add_liner(plotter: Any, contact: OffAxisContact, to_body: Numbers) -> None:
    """Add the outside of the liner, and its face from the bore to the outside."""
    joint, cup, radius = contact.joint, contact.model.cup, float(contact.joint.socket_radius)
    outer = radius + min(float(joint.liner_thickness), _THICKEST * radius)
    reach = float(contact.model.reach_of(joint))
    corners = [(radius, reach), (radius + cup.chamfer, cup.rim), (outer, cup.rim)]
    face = numpy.stack([size * _directions(numpy.array([polar]))[0] for size, polar in corners])
    for shape in (face, outer * _directions(numpy.linspace(0.0, cup.rim, _RINGS))):
        plotter.add_mesh(_surface(shape, to_body), color=_LINER, ambient=0.1)


def _directions(polar: Numbers) -> Numbers:
    """Return unit vectors (rings, meridians, 3) around the cup's axis."""
    return numpy.moveaxis(unit_vectors(polar[:, None], numpy.linspace(0.0, 2 * pi, _MERIDIANS)), 0, -1)


def _surface(points: Numbers, to_body: Numbers) -> Any:
    """Return a surface in the body's frame through points (rings, meridians, 3) of the cup's frame."""
    import pyvista

    x, y, z = numpy.moveaxis(points @ to_body, -1, 0)
    return pyvista.StructuredGrid(x, y, z)
