"""A joint in section, to scale, with the pressure painted on its socket."""

from __future__ import annotations

from itertools import pairwise
from math import isinf, pi
from typing import Any

import numpy
from bokeh.models import ColumnDataSource, LinearColorMapper

from ..contact import Contact
from ..io.joint_file import JointFile
from ..quantities import FIELD
from .look import Palette, chart, colour_bar

_MASSIVE = 0.8  # of the socket's radius is drawn of what has no end
_PETALS = 48
_HIGHEST = 0.45  # of the liner, or of the radius


class SectionDrawing:
    """Ball, liner, backing and cup; the load comes from above."""

    def __init__(self, palette: Palette, height: int = 340) -> None:
        self._palette = palette
        self.figure = chart("distance from the load axis [mm]", "height [mm]", palette, height, match_aspect=True)
        self.figure.toolbar_location = None
        self.figure.grid.visible = False
        self._parts = ColumnDataSource({"x": [], "y": [], "fill": []})
        self._petals = ColumnDataSource({"x": [], "y": [], "pressure": []})
        self._colours = LinearColorMapper("Viridis256", low=0.0, high=1.0)
        outline = {"line_color": palette.text, "line_width": 0.8}
        self.figure.patches("x", "y", source=self._parts, fill_color="fill", **outline)
        self.figure.patches(
            "x",
            "y",
            source=self._petals,
            fill_color={"field": "pressure", "transform": self._colours},
            line_color=None,
        )
        self._corners = ColumnDataSource({"x": [], "y": []})
        self.figure.scatter("x", "y", source=self._corners, alpha=0.0)
        self.figure.add_layout(colour_bar(self._colours, palette, FIELD["pressure"].label()), "right")

    def show(
        self, file: JointFile, contact: Contact | None, extent: float | None = None, highest: float | None = None
    ) -> None:
        """Draw a joint; without a contact nothing is painted on it.

        `extent` (mm) and `highest` (MPa) are those of several drawings that are to be compared, this joint's without.
        """
        radii = _radii(file)
        parts = [_sector(inner, outer, file.cup.rim) for inner, outer in pairwise(radii)]
        fills = [self._palette.liner, *[self._palette.backing] * (len(parts) - 1)]
        depth = 0.0 if contact is None else float(contact.indentation)
        parts.append(_ball(float(file.joint.ball_radius), float(file.joint.clearance) + depth))
        self._parts.data = {
            "x": [x for x, _ in parts],
            "y": [y for _, y in parts],
            "fill": [*fills, self._palette.ball],
        }
        self._petals.data = _petals(file, contact)
        half = extent or extent_of(file)
        self._corners.data = {"x": [-half, half], "y": [-half, half]}
        self._colours.high = highest or (1.0 if contact is None else float(contact.max_pressure) or 1.0)


def extent_of(file: JointFile) -> float:
    """Half the width of the drawing in mm."""
    return _radii(file)[-1]


def _radii(file: JointFile) -> list[float]:
    """Radii in mm of the bore, and from there outwards behind the liner and each layer."""
    radii = [float(file.joint.socket_radius)]
    for thickness in (file.joint.liner_thickness, *(layer.thickness for layer in file.joint.backing)):
        radii.append(radii[-1] + (_MASSIVE * radii[0] if isinf(float(thickness)) else float(thickness)))
    return radii


def _sector(inner: float, outer: float, rim: float) -> tuple[numpy.ndarray, numpy.ndarray]:
    angle = numpy.linspace(-rim, rim, 121)
    x = numpy.concatenate([inner * numpy.sin(angle), outer * numpy.sin(angle[::-1])])
    y = numpy.concatenate([-inner * numpy.cos(angle), -outer * numpy.cos(angle[::-1])])
    return x, y


def _ball(radius: float, drop: float) -> tuple[numpy.ndarray, numpy.ndarray]:
    angle = numpy.linspace(0.0, 2 * pi, 181)
    return radius * numpy.sin(angle), radius * numpy.cos(angle) - drop


def _petals(file: JointFile, contact: Contact | None) -> dict[str, Any]:
    """Quadrilaterals in the liner up to its rim, as high and as coloured as the pressure."""
    if contact is None or not float(contact.half_angle) > 0:
        return {"x": [], "y": [], "pressure": []}
    radius, edge = float(file.joint.socket_radius), min(float(contact.half_angle), file.cup.rim)
    angle = edge * numpy.sin(numpy.linspace(-pi / 2, pi / 2, _PETALS + 1))
    pressure = numpy.asarray(contact.pressure(numpy.abs(angle) * (1 - 1e-9)))
    highest = _HIGHEST * min(float(file.joint.liner_thickness), 0.6 * radius)
    reach = radius + highest * pressure / float(contact.max_pressure)
    a, b = slice(None, -1), slice(1, None)
    corners: list[tuple[Any, slice]] = [(radius, a), (radius, b), (reach[b], b), (reach[a], a)]
    x = numpy.stack([r * numpy.sin(angle[side]) for r, side in corners], axis=1)
    y = numpy.stack([-r * numpy.cos(angle[side]) for r, side in corners], axis=1)
    # as text: an array of its own for each petal would be a message of its own
    return {"x": x.round(4).tolist(), "y": y.round(4).tolist(), "pressure": (pressure[a] + pressure[b]) / 2}
