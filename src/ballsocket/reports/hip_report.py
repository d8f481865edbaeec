"""Page of a wear simulation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ..files.joint_file import NO_DETAILS, ReportDetails
from ..hip.bands import Bands
from ..hip.film import WAVE_NOTE
from ..hip.hamrock_dowson import CONFORMITY_NOTE
from ..hip.history import History
from . import hip_plots
from .figure_files import figure_bytes
from .hip_tables import (
    CONTACT_HEADS,
    band_contact_line,
    band_heads,
    band_rows,
    band_summary,
    contact_line,
    contact_rows,
    radiograph_line,
    rim_lines,
    wear_rows,
    wear_units,
)
from .pages import letterhead, picture, render_page

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
    history: History, bands: Bands | None = None, name: str = "", details: ReportDetails = NO_DETAILS
) -> str:
    """Return the page of a wear simulation as HTML; bands of patients who differ have two more sections.

    Raises
    ------
    ValueError, OSError
        As `pages.logo_address`, for the logo of the head.
    """
    sections: dict[str, tuple[str, str | None]] = {"numbers": ("Numbers", None)}
    if history.use.unworn_checks:
        sections["contact"] = ("Validity of the contact", None)
    if len(history.use.frame.loaded):
        figures = dict(_FIGURES)
        if history.use.ball_wear is not None:
            figures["ball"] = ("Wear of the ball", hip_plots.ball_map, "Seen from above, in the ball's own frame.")
        for section, (title, draw, caption) in figures.items():
            sections[section] = (title, picture(figure_bytes(draw(history)), title, caption))
        if history.film is not None:
            title, curves = "Film and friction", figure_bytes(hip_plots.film_figure(history.use, history.film))
            sections["film"] = (title, picture(curves, title, f"{WAVE_NOTE}. {CONFORMITY_NOTE}."))
    if bands is not None:
        sections |= _band_sections(history, bands)
    return render_page(
        "hip_report.html",
        f"Wear of a hip: {name}" if name else "Wear of a hip",
        sections,
        **letterhead(details),
        summary=_summary(history),
        notes=history.notes,
        first_cycle=_first_cycle(history),
        rim=_rim_approach(history),
        wear={
            "heads": ["million cycles", *(f"{head} [{unit}]" for head, unit in list(wear_units(history).items())[1:])],
            "rows": [(*cells, f"{rim:.3g}") for *cells, rim in wear_rows(history)],
        },
        contacts={"summary": contact_line(history), "heads": CONTACT_HEADS, "rows": contact_rows(history)},
        bands=None if bands is None else _band_table(bands),
    )


def _band_sections(history: History, bands: Bands) -> dict[str, tuple[str, str | None]]:
    caption = f"The line is the nominal patient; the band holds {100 * bands.level:g} % of the {bands.subject}"
    caption += (
        "."
        if bands.shared is None
        else ", the dark band holds the same share of the patients at the median coefficient."
    )
    curve = figure_bytes(hip_plots.penetration_curve(history, bands))
    sections: dict[str, tuple[str, str | None]] = {
        "penetration": ("Penetration", picture(curve, "Penetration", caption)),
        "patients": ("Bands of different patients", None),
    }
    if bands.indices is not None:
        indices = figure_bytes(hip_plots.share_figure(bands))
        sections["matters"] = (
            "Sensitivity",
            picture(indices, "Sensitivity", "Sobol's indices with 95 % intervals."),
        )
    return sections


def _band_table(bands: Bands) -> Mapping[str, Any]:
    tail = (1 - bands.level) / 2
    return {
        "summary": band_summary(bands),
        "lines": (*rim_lines(bands), band_contact_line(bands)),
        "notes": bands.notes,
        "heads": band_heads(bands),
        "rows": band_rows(bands, (tail, 0.5, 1 - tail)),
    }


def _summary(history: History) -> str:
    use, last = history.use, history.last
    return (
        f"{use.joint}, {use.cycle.name}: {last.volume:.4g} mm³ worn and a penetration of {last.penetration:.3g} mm "
        f"after {last.cycles / 1e6:g} million cycles."
    )


def _first_cycle(history: History) -> str:
    """Describe slide, work, cross-shear and wear rate of the first cycle, and the error of the time steps."""
    first, error = history.use.first, history.error
    return (
        f"The sliding distance of a cycle is {first.slide:.4g} mm; pressure times slide is {first.work:.4g} N m, "
        f"the mean cross-shear {first.cross_shear:.3g}. "
        f"The unworn hip wears {first.volume:.4g} mm³ and {first.depth:.3g} mm in a million cycles. "
        f"The estimated numerical error is {100 * error.volume:.2g} % of the volume and "
        f"{100 * error.depth:.2g} % of the depth."
    )


def _rim_approach(history: History) -> str:
    """Describe the least distance to the rim with instant and location, new and at the end, and the radiograph."""
    nearest = {"New": history.worst, "at the end": history.last.edge.closest_approach(history.use.frame)}
    sentences = []
    for stage, worst in nearest.items():
        if worst is not None:
            near = f"comes within {worst.distance:.3g} mm of the rim"
            words = near if worst.distance > 0 else f"reaches the rim ({worst.kind})"
            sentences.append(f"{stage} the contact {words} at {worst.location}")
    distances = "; ".join(sentences)
    line = radiograph_line(history)
    return f"{distances}. {line[:1].upper()}{line[1:]}" if distances else "nothing is pressed"
