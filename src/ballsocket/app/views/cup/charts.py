"""Map of a contact over the orientations of its cup."""

from __future__ import annotations

from math import degrees

import numpy
from scipy.interpolate import RectBivariateSpline

from ....core.quantities import CUP, QUANTITIES
from ....problem.cup import Cup
from ...pictures import svg
from ...pictures.bore import METRIC
from ...pictures.contour_map import MapPlane, contour_map, outlined
from ...widgets.reading import Reading
from .worker import LEWINNEK, OrientationMap

_MIN_POINTS, _FINE_POINTS = 4, 61  # values an axis: least for a cubic spline, and of a smooth contour


def angle_map(orientations: OrientationMap, cup: Cup, quantity: str, reading: Reading = METRIC) -> str:
    """Draw a field over inclination and anteversion, with the present cup and Lewinnek's zone."""
    held = orientations.held
    fields = [numpy.where(held, getattr(orientations, name), numpy.nan).T for name in (quantity, "edge_distance")]
    x, y, (values, edge_distance) = _refined(
        numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion), fields
    )
    plane = MapPlane(x=x, y=y, x_label=CUP["inclination"].label(), y_label=CUP["anteversion"].label())
    values = numpy.where(numpy.isfinite(values), values, numpy.nan) * reading.unit(QUANTITIES[quantity]).factor
    rim = plane.contours(edge_distance)
    label = reading.label(QUANTITIES[quantity])
    high = float(numpy.nanmax(values, initial=0.0))
    low = float(numpy.nanmin(values, initial=high if quantity == "max_pressure" else 0.0))  # 0 is the rim
    left, right, bottom, top = LEWINNEK
    corner = f'x="{plane.across(left):.1f}" y="{plane.up(top):.1f}"'
    size = f'width="{plane.across(right) - plane.across(left):.1f}" height="{plane.up(bottom) - plane.up(top):.1f}"'
    marks = [
        *(outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in rim.lines(0.0)),
        outlined("rect", "zone", f"{corner} {size}"),
        *plane.ring(degrees(cup.inclination), degrees(cup.anteversion), "here"),
    ]
    labels = label, _map_description(orientations, label, reading)
    return contour_map(plane, values, svg.levels_between(low, high, 7), labels, marks, "cup.pick")


def _refined(
    x: numpy.ndarray, y: numpy.ndarray, fields: list[numpy.ndarray]
) -> tuple[numpy.ndarray, numpy.ndarray, list[numpy.ndarray]]:
    """Interpolate complete fields (y, x) by cubic splines, for smooth contours."""
    if min(len(x), len(y)) < _MIN_POINTS or not all(numpy.isfinite(field).all() for field in fields):
        return x, y, fields
    fine_x, fine_y = (numpy.linspace(axis[0], axis[-1], _FINE_POINTS) for axis in (x, y))
    return fine_x, fine_y, [RectBivariateSpline(y, x, field)(fine_y, fine_x) for field in fields]


def _map_description(orientations: OrientationMap, label: str, reading: Reading) -> str:
    free = orientations.held & (orientations.edge_distance > 0)
    if not free.any():
        return f"{label}: in every orientation of the map the contact reaches the rim"
    best = numpy.where(free, orientations.edge_distance, -numpy.inf)
    row, column = numpy.unravel_index(int(best.argmax()), best.shape)
    inclination, anteversion = degrees(orientations.inclination[row]), degrees(orientations.anteversion[column])
    share = f"{100 * free.mean():.0f} % of the orientations keep the contact off the rim"
    apart = reading.with_unit(QUANTITIES["edge_distance"], float(best.max()))
    return (
        f"{label} over inclination and anteversion: {share}; furthest, {apart}, at "
        f"inclination {inclination:.3g}°, anteversion {anteversion:.3g}°"
    )
