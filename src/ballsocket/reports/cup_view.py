"""A contact off the cup's axis in three dimensions: into the bore, with its pressures, from beside the opening."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from ..core.quantities import FIELD
from ..core.storage.atomic_files import write_atomically
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import unit_vectors
from .cup_map import drawn, highest
from .style import INK, VERMILLION

if TYPE_CHECKING:
    import pyvista

_RINGS, _MERIDIANS = 181, 361
_LINER, _EMPTY, _SEEN = "#d9c9a0", "#eeeeee", 0.01  # of the largest pressure: less is drawn as none
_THICKEST = 0.8  # of the bore's radius: what is thicker is drawn so thick
_SIZE = (1100, 900)
_FROM = (0.8, 0.65)  # how far the eye is out of the opening, and beside its axis


def cup_view(contact: OffAxisContact, *, off_screen: bool = False) -> pyvista.Plotter:
    """The liner seen from beside its opening, in the body's frame, with the pressure on its bore.

    The edge of the contact is a black line; an arrow from the ball's centre shows the load. The ball is left out.

    Parameters
    ----------
    contact : OffAxisContact
        One contact under load, from `Sphere.press`.
    off_screen : bool
        Whether to draw without a window, for `screenshot`.

    Returns
    -------
    pyvista.Plotter
        `show()` opens it.

    Raises
    ------
    ValueError
        More than one contact, or one without load or answer.
    ImportError
        The extra `view3d` is not installed.
    """
    _ = contact.single_state
    needs("view3d", "pyvista")
    import pyvista

    plotter = pyvista.Plotter(off_screen=off_screen, window_size=_SIZE)
    plotter.set_background("white")
    turn = numpy.array(contact.model.cup.frame)  # rows are the cup's axes in the body's frame
    _add_liner(plotter, contact, turn)
    _add_bore(plotter, contact, turn)
    radius = float(contact.joint.socket_radius)
    edge = 0.999 * radius * numpy.vstack([contact.outline, contact.outline[:1]]) @ turn
    plotter.add_mesh(pyvista.MultipleLines(edge), color=INK, line_width=3)
    if contact.force > 0:
        load = contact.force_vector / contact.force @ turn
        arrow = {"tip_length": 0.2, "tip_radius": 0.05, "shaft_radius": 0.015, "scale": 0.9 * radius}
        plotter.add_mesh(pyvista.Arrow(start=(0.0, 0.0, 0.0), direction=load, **arrow), color=VERMILLION)
    _look_into(plotter, contact, radius)
    return plotter


def save_view(contact: OffAxisContact, path: Path) -> None:
    """Write that view as PNG; one that cannot be drawn leaves no file.

    Raises
    ------
    ValueError, ImportError
        As `cup_view`.
    OSError
        A path that cannot be written to.
    """
    plotter = cup_view(contact, off_screen=True)
    try:
        with write_atomically(path) as draft:
            plotter.screenshot(str(draft))
    finally:
        plotter.close()


def _add_bore(plotter: Any, contact: OffAxisContact, turn: Numbers) -> None:
    reach = float(contact.model.reach_of(contact.joint))
    directions = _directions(numpy.linspace(0.0, reach, _RINGS))
    bore = _surface(float(contact.joint.socket_radius) * directions, turn)
    bore["pressure"] = drawn(contact, directions).ravel(order="F")
    bar = {
        "title": FIELD["pressure"].head(),
        "color": "black",
        "vertical": True,
        "below_label": " ",
        "fmt": "%.0f",
        "label_font_size": 18,
    }
    bar |= {"position_x": 0.88, "position_y": 0.2, "height": 0.6, "width": 0.06, "title_font_size": 18}
    most = highest(contact)
    look = {"cmap": "viridis", "clim": (_SEEN * most, most), "below_color": _EMPTY, "ambient": 0.45, "diffuse": 0.6}
    plotter.add_mesh(bore, scalars="pressure", scalar_bar_args=bar, smooth_shading=True, **look)


def _add_liner(plotter: Any, contact: OffAxisContact, turn: Numbers) -> None:
    """The liner's outside, and its face from the bore to the outside."""
    joint, cup, radius = contact.joint, contact.model.cup, float(contact.joint.socket_radius)
    outer = radius + min(float(joint.liner_thickness), _THICKEST * radius)
    reach = float(contact.model.reach_of(joint))
    corners = [(radius, reach), (radius + cup.chamfer, cup.rim), (outer, cup.rim)]
    face = numpy.stack([size * _directions(numpy.array([polar]))[0] for size, polar in corners])
    for shape in (face, outer * _directions(numpy.linspace(0.0, cup.rim, _RINGS))):
        plotter.add_mesh(_surface(shape, turn), color=_LINER, ambient=0.1)


def _directions(polar: Numbers) -> Numbers:
    """Unit vectors (rings, meridians, 3) all around."""
    return numpy.moveaxis(unit_vectors(polar[:, None], numpy.linspace(0.0, 2 * pi, _MERIDIANS)), 0, -1)


def _surface(places: Numbers, turn: Numbers) -> Any:
    """A surface through places (rings, meridians, 3) of the cup's frame, in the body's."""
    import pyvista

    x, y, z = numpy.moveaxis(places @ turn, -1, 0)
    return pyvista.StructuredGrid(x, y, z)


def _look_into(plotter: Any, contact: OffAxisContact, radius: float) -> None:
    """From out of the opening, beside the axis on the side away from where the load points."""
    x, _, z = numpy.array(contact.model.cup.frame)
    out, beside = _FROM
    eye = -out * z - beside * x
    plotter.camera_position = [tuple(6.2 * radius * eye), (0.0, 0.0, 0.0), tuple(x)]
