"""A contact that lies off the cup's axis becomes a picture: the pressure on the cup beside a section."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

from ..core.quantities import FIELD
from ..elasticity.off_axis.contact import OffAxisContact
from .cup_map import draw_map
from .cup_section import draw_section
from .style import LEGEND

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def cup_figure(contact: OffAxisContact) -> Figure:
    """The pressure on the cup seen from its opening, beside the section in the plane of load and cup's axis.

    The cup is drawn in an equal-area projection, the direction in which it is inclined above, with its rim, the edge
    of the contact, the load, and where the pressure is largest. In the section the dome is above; the pressure is a
    band on the bore.

    Parameters
    ----------
    contact : OffAxisContact
        One contact under load, from `Sphere.press`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    ValueError
        More than one contact, or one without load or answer.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    _ = contact.single_state
    figure = Figure(figsize=(11.0, 5.2), layout=ConstrainedLayoutEngine(rect=(0.0, 0.07, 1.0, 0.93)))
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    filled = draw_map(left, contact)
    bar = figure.colorbar(filled, ax=left, shrink=0.8, pad=0.02, format="%g", ticks=list(filled.levels)[1:])
    bar.set_label(FIELD["pressure"].label())
    left.set_title("the cup seen from its opening", fontsize=10, pad=14)
    draw_section(right, contact)
    right.set_title("section in the plane of load and cup's axis", fontsize=10, pad=14)
    figure.legend(loc="lower center", ncols=6, **LEGEND)
    figure.suptitle(_title(contact), fontsize=10, parse_math=False)
    return figure


def _title(contact: OffAxisContact) -> str:
    """The joint, and the load with its angle to the cup's axis."""
    tilt = f"{degrees(contact.tilt):.3g}° from the cup's axis"
    return f"{contact.joint.dimensions}; {contact.force:.4g} N at {tilt}"
