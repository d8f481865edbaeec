"""What the paper says of how geometry changes a joint (Figures 5 and 6)."""

from __future__ import annotations

from functools import cache

import numpy

from ...contact import Contact, Model
from ...core.arrays import Numbers
from .. import cases
from .finding import Finding, named, true


def stiffness_and_geometry(reference: Model) -> Finding:
    """Figure 5 a, c, e: which way the stiffness at 3 kN goes."""
    rise = {name: reference.press(series, force=cases.LOAD).stiffness for name, series in cases.series().items()}
    signs = {"clearance": -1, "head_radius": 1, "liner_thickness": -1}
    return Finding(
        name="stiffness-and-geometry",
        where="Section 3.2, Figure 5 a, c, e",
        sentence="The joint gets softer with clearance, stiffer with the head's radius, stiffer with a thinner liner.",
        numbers={
            f"stiffness at the largest over that at the smallest {named(name)}": float(values[-1] / values[0])
            for name, values in rise.items()
        },
        **true(all(numpy.all(sign * numpy.diff(rise[name]) > 0) for name, sign in signs.items())),
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
        **true(good),
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
        comment=f"At an outer radius of {radius[best] + 0.1 + thickness[best]:.3g} mm, where a larger head leaves a "
        "thinner liner.",
        **true(radius[best] > 17 and 4.0 <= thickness[best] <= 10.0),
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
        comment=f"At an outer radius of {radius[best] + 0.1 + thickness[best]:.3g} mm: a small head is allowed a thin "
        "liner only as far as that limit.",
        **true(radius[best] < 14 and thickness[best] < 6),
    )


@cache
def _within_table_1(reference: Model) -> tuple[Numbers, Numbers, Contact]:
    """Head radius and liner thickness of the joints within the outer radii of Table 1, and their contacts at 3 kN."""
    radius, thickness, joints = cases.outline(heads=13, liners=7)
    return radius, thickness, reference.press(joints, force=cases.LOAD)
