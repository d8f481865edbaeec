"""Map of a contact over the orientations of its cup."""

from __future__ import annotations

from collections.abc import Iterator
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

_MIN_POINTS, _FINE_POINTS = 4, 61
"""Values an axis: least for a cubic spline, and of a smooth contour."""


def angle_map(orientations: OrientationMap, cup: Cup, quantity: str, reading: Reading = METRIC) -> str:
    """Draw a field over inclination and anteversion, with the present cup and Lewinnek's zone."""
    held = orientations.held
    fields = [numpy.where(held, getattr(orientations, name), numpy.nan).T for name in (quantity, "edge_distance")]
    x, y, (values, edge_distance) = _refined(
        numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion), fields
    )
    plane = MapPlane(
        x=x,
        y=y,
        x_label=CUP["inclination"].label(),
        y_label=CUP["anteversion"].label(),
    )
    values = numpy.where(numpy.isfinite(values), values, numpy.nan) * reading.unit(QUANTITIES[quantity]).factor
    rim = plane.contours(edge_distance)
    label = reading.label(QUANTITIES[quantity])
    marks = [
        *(outlined("path", "limit", f'd="{svg.path(*line.T)}"') for line in rim.lines(0.0)),
        *_lewinnek_zone(plane),
        *plane.ring(degrees(cup.inclination), degrees(cup.anteversion), "here"),
    ]
    labels = label, _map_description(orientations, label, reading)
    return contour_map(plane, values, _levels(quantity, values), labels, marks, "cup.pick")


def _refined(
    x: numpy.ndarray, y: numpy.ndarray, fields: list[numpy.ndarray]
) -> tuple[numpy.ndarray, numpy.ndarray, list[numpy.ndarray]]:
    """Interpolate complete fields (y, x) by cubic splines, for smooth contours."""
    if min(len(x), len(y)) < _MIN_POINTS or not all(numpy.isfinite(field).all() for field in fields):
        return x, y, fields
    fine_x, fine_y = (numpy.linspace(axis[0], axis[-1], _FINE_POINTS) for axis in (x, y))
    return fine_x, fine_y, [RectBivariateSpline(y, x, field)(fine_y, fine_x) for field in fields]


def _levels(quantity: str, values: numpy.ndarray) -> list[float]:
    """Return round levels around the values; those of an edge distance include 0."""
    high = float(numpy.nanmax(values, initial=0.0))
    low = float(numpy.nanmin(values, initial=high if quantity == "max_pressure" else 0.0))
    return svg.levels_between(low, high, 7)


def _lewinnek_zone(plane: MapPlane) -> Iterator[str]:
    x_low, x_high, low, high = LEWINNEK
    position = f'x="{plane.across(x_low):.1f}" y="{plane.up(high):.1f}"'
    size = f'width="{plane.across(x_high) - plane.across(x_low):.1f}" height="{plane.up(low) - plane.up(high):.1f}"'
    yield outlined("rect", "zone", f"{position} {size}")


def _map_description(orientations: OrientationMap, label: str, reading: Reading) -> str:
    """Describe the map in a sentence for screen readers."""
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
