"""A bore with a field on it, in three dimensions: cells as plain numbers that the page's script draws and turns."""

from __future__ import annotations

import json
from html import escape
from math import pi
from typing import Any

import numpy

from ..core.quantities import FIELD
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import unit_vectors
from ..reports.cup_map import shown_maximum, shown_pressure

_RINGS, _MERIDIANS = 40, 96
_THICKEST = 0.8  # of the bore's radius: what is thicker is drawn so thick


def pressed_bowl(contact: OffAxisContact) -> str:
    """The pressure of one contact on its cup, with the load as an arrow."""
    joint, reach = contact.joint, float(contact.model.reach_of(contact.joint))
    polar = numpy.linspace(0.0, reach, _RINGS + 1)
    around = 2 * pi * numpy.arange(_MERIDIANS) / _MERIDIANS
    middles = unit_vectors(((polar[1:] + polar[:-1]) / 2)[:, None], around + pi / _MERIDIANS)
    values = shown_pressure(contact, numpy.moveaxis(middles, 0, -1))
    radius = float(joint.socket_radius)
    said = f"the cup in three dimensions with its pressure, up to {shown_maximum(contact):.3g} {FIELD['pressure'].unit}"
    return bowl(
        "cup",
        f"{said}; arrow keys turn it, Home looks into its opening",
        polar=polar.round(5).tolist(),
        meridians=_MERIDIANS,
        values=(values / shown_maximum(contact)).round(3).ravel().tolist(),
        outer=1 + min(float(joint.liner_thickness) / radius, _THICKEST),
        load=(contact.force_vector / contact.force).tolist(),
        turned=[0.5, -0.35],
    )


def bowl(name: str, said: str, **data: Any) -> str:
    """The place of a bore that turns.

    Its data are the `polar` edges of its rings in rad, `meridians`, `values` of its cells from 0 to 1, the `outer`
    radius over that of the bore, where the `load` points, and how it is `turned` at first, in rad.
    """
    return (
        f'<canvas class="bowl" data-name="{name}" tabindex="0" role="img" aria-label="{escape(said)}" '
        f"data-bowl='{json.dumps(data, separators=(',', ':'))}'></canvas>"
    )
