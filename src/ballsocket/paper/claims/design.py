"""What the paper says of how geometry changes a joint (Figures 5 and 6)."""

from __future__ import annotations

from functools import cache

import numpy

from ...contact import Contact
from ...models.base import Model
from .. import cases
from .finding import Finding, graded

Array = numpy.ndarray


def stiffness_and_geometry(reference: Model) -> Finding:
    """Figure 5 a, c, e: which way the stiffness at 3 kN goes."""
    rise = {name: reference.press(series, force=cases.LOAD).stiffness for name, series in cases.series().items()}
    signs = {"clearance": -1, "head_radius": 1, "liner_thickness": -1}
    good = all(numpy.all(sign * numpy.diff(rise[name]) > 0) for name, sign in signs.items())
    return Finding(
        name="stiffness-and-geometry",
        where="Section 3.2, Figure 5 a, c, e",
        sentence="The joint gets softer with clearance, stiffer with the head's radius, stiffer with a thinner liner.",
        numbers={f"last over first of {name}": float(values[-1] / values[0]) for name, values in rise.items()},
        verdict=graded(good, False),
    )


def clearance_and_pressure(reference: Model) -> Finding:
    """Figure 5 a, b."""
    contact = reference.press(cases.series()["clearance"], force=cases.LOAD)
    good = numpy.all(numpy.diff(contact.max_pressure) > 0) and numpy.all(numpy.diff(contact.half_angle) < 0)
    return Finding(
        name="clearance-and-pressure",
        where="Section 3.2, Figure 5 a, b",
        sentence="More clearance makes the contact narrower and the peak pressure higher.",
        numbers={
            "p0 at 0.2 over p0 at 0.05 mm": float(contact.max_pressure[-1] / contact.max_pressure[0]),
            "ε at 0.2 over ε at 0.05 mm": float(contact.half_angle[-1] / contact.half_angle[0]),
        },
        verdict=graded(bool(good), False),
    )


def lowest_pressure(reference: Model) -> Finding:
    """Figure 6, left: where the peak pressure is least, within the limits of Table 1."""
    radius, thickness, contact = _within_table_1(reference)
    best = int(numpy.nanargmin(contact.max_pressure))
    return Finding(
        name="lowest-pressure",
        where="Section 3.2, Figure 6 left",
        sentence="Peak pressures are least for large heads with liners of moderate thickness.",
        numbers={
            "least p0, MPa": float(contact.max_pressure[best]),
            "at R1, mm": float(radius[best]),
            "at L, mm": float(thickness[best]),
        },
        verdict=graded(bool(radius[best] > 18) and 3.0 < thickness[best] < 12.0, bool(radius[best] > 17)),
        comment="Within an outer radius of 26 mm, where a larger head leaves a thinner liner.",
    )


def smallest_area(reference: Model) -> Finding:
    """Figure 6, right: where the contact area is least."""
    radius, thickness, contact = _within_table_1(reference)
    best = int(numpy.nanargmin(contact.area))
    return Finding(
        name="smallest-area",
        where="Section 3.2, Figure 6 right",
        sentence="The contact area goes the other way: it is least for small heads with thin liners.",
        numbers={
            "least area, mm²": float(contact.area[best]),
            "at R1, mm": float(radius[best]),
            "at L, mm": float(thickness[best]),
        },
        verdict=graded(bool(radius[best] < 15 and thickness[best] < 6), bool(radius[best] < 16)),
        comment="The smallest head, with the thinnest liner that an outer radius of 16 mm leaves it.",
    )


@cache
def _within_table_1(reference: Model) -> tuple[Array, Array, Contact]:
    """Head radius and liner thickness of the joints within the outer radii of Table 1, and their contacts at 3 kN."""
    radius, thickness = (grid.ravel() for grid in numpy.meshgrid(numpy.linspace(11, 23, 13), numpy.linspace(3, 15, 13)))
    outer = radius + 0.1 + thickness
    kept = (outer >= cases.OUTER_RADII[0]) & (outer <= cases.OUTER_RADII[1])
    joints = cases.joint(head_radius=radius[kept], liner_thickness=thickness[kept])
    return radius[kept], thickness[kept], reference.press(joints, force=cases.LOAD)
