"""Page of a wear simulation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING

from ..core.unit_systems import Units
from ..files.joint_file import NO_DETAILS, ReportDetails
from ..hip.answers import describe_bands, describe_history
from ..hip.bands import Bands
from ..hip.film import CONFORMITY_NOTE, WAVE_NOTE
from ..hip.history import History
from . import hip_plots
from .figure_files import figure_bytes
from .pages import answer_lede, answer_sections, letterhead, picture, render_page, trusted_html
from .style import in_units

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FIGURES: MappingProxyType[str, tuple[str, Callable[[History], Figure], str]] = MappingProxyType(
    {
        "wear": (
            "Wear map",
            hip_plots.wear_map,
            "Seen along the cup's axis; the cross marks the direction of the largest load.",
        ),
        "penetration": (
            "Penetration",
            hip_plots.penetration_curve,
            "Displacement of the ball's centre. The band is the numerical error of blocks, rings and steps, "
            "without that of the wear law.",
        ),
        "tracks": ("Tracks", hip_plots.track_map, "Paths of points of the ball on the socket in one cycle."),
        "cross_shear": (
            "Cross-shear",
            hip_plots.cross_shear_map,
            "Cross-shear of the first cycle; each sliding distance is weighted by its pressure.",
        ),
        "edge": (
            "Edge distance",
            hip_plots.edge_figure,
            "0: the contact reaches the rim, worn to it or by edge loading; the dot marks the least distance.",
        ),
    }
)
"""Title, figure and caption of each section with a figure, by its id."""


def hip_report(
    history: History,
    bands: Bands | None = None,
    name: str = "",
    details: ReportDetails = NO_DETAILS,
    units: Units = Units.SI,
) -> str:
    """Return the page of a wear simulation as HTML; bands of patients who differ have sections of their own.

    Raises ValueError, OSError: as `pages.logo_address`, for the logo of the head.
    """
    answer = describe_history(history)
    sections = answer_sections(answer, units)
    if bands is not None:
        described = describe_bands(bands)
        sections |= answer_sections(described, units)
        answer = replace(answer, notes=[*answer.notes, f"bands: {described.title} the values", *described.notes])
    if len(history.use.frame.loaded):
        for section, (title, draw, caption) in _figures(history, bands).items():
            sections[section] = (title, picture(figure_bytes(in_units(draw(history), units)), title, caption))
    title = f"Wear of a hip: {name}" if name else "Wear of a hip"
    lede = trusted_html(answer_lede(answer, units))
    return render_page("joint_report.html", title, sections, lede=lede, **letterhead(details))


def _figures(history: History, bands: Bands | None) -> dict[str, tuple[str, Callable[[History], Figure], str]]:
    """Return title, figure and caption of the sections of a hip that is loaded, by their ids."""
    figures = dict(_FIGURES)
    if history.use.ball_wear is not None:
        figures["ball"] = ("Wear of the ball", hip_plots.ball_map, "Seen from above, in the ball's own frame.")
    if (film := history.film) is not None:
        caption = f"{WAVE_NOTE}. {CONFORMITY_NOTE}."
        figures["film_course"] = ("Film over the cycle", lambda run: hip_plots.film_figure(run.use, film), caption)
    if bands is not None:
        curve = partial(hip_plots.penetration_curve, bands=bands)
        caption = f"The line is the nominal patient; the band holds {100 * bands.level:g} % of the {bands.subject}"
        if bands.shared is not None:
            caption += ", the dark band the same share of the patients at the median coefficient"
        figures["penetration"] = ("Penetration", curve, f"{caption}.")
        if bands.indices is not None:
            caption = "Sobol's indices with 95 % intervals."
            figures["matters"] = ("Sensitivity", lambda _: hip_plots.share_figure(bands), caption)
    return figures
