"""A hip in use as one page of HTML."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from ..core.storage.atomic_files import check_parent_folder, write_text
from ..hip.bands import Bands
from ..hip.film import CONFORMITY_NOTE
from ..hip.history import History
from . import hip_plots
from .hip_bands import band_sections
from .hip_contact import HEADS, contact_line, contact_rows
from .html import drawn, page, picture, table, words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FIGURES: MappingProxyType[str, tuple[str, Callable[[History], Figure], str]] = MappingProxyType(
    {
        "wear": (
            "Wear map",
            hip_plots.wear_map,
            "Seen along the cup's axis; a cross where the largest load points.",
        ),
        "penetration": (
            "Penetration",
            hip_plots.penetration_curve,
            "How far the ball's centre has moved; the band is what blocks, rings and instants leave open, "
            "not what the law does.",
        ),
        "tracks": ("Tracks", hip_plots.track_map, "Of points of the ball on the socket, in one cycle."),
        "cross_shear": (
            "Cross-shear",
            hip_plots.cross_shear_map,
            "Of the first cycle, each slide weighted by its pressure.",
        ),
        "film": ("Film and friction", hip_plots.film_figure, f"{CONFORMITY_NOTE}."),
        "edge": ("Edge distance", hip_plots.edge_figure, "0 is edge loading; a dot where the contact comes nearest."),
    }
)
_OF_BALLS: MappingProxyType[str, tuple[str, Callable[[History], Figure], str]] = MappingProxyType(
    {"ball": ("Wear of the ball", hip_plots.ball_map, "Seen from above, in the ball's own frame.")}
)
_HEADS = (
    "million cycles",
    "volume [mm³]",
    "depth [mm]",
    "penetration [mm]",
    "pmax [MPa]",
    "creep [mm]",
    "to the rim [mm]",
)


def check_page(path: Path) -> None:
    """Raise ValueError unless a page can be written there."""
    if path.suffix.lower() != ".html":
        raise ValueError(f"report {str(path)!r} must end in .html")
    check_parent_folder(path)


def write_hip_report(history: History, path: Path, bands: Bands | None = None) -> Path:
    """Write the page, with the bands of patients who differ where there are any; returns its path.

    Raises
    ------
    ValueError
        Another ending than .html, or no folder.
    OSError
        It cannot be written.
    """
    check_page(path)
    sections = {"numbers": ("Numbers", _numbers(history))}
    if history.use.unworn_checks:
        sections["contact"] = ("Validity of the contact", _contacts(history))
    if len(history.use.loaded):
        drawn_here = _FIGURES if history.use.ball_wear is None else _FIGURES | _OF_BALLS
        for name, (title, draw, caption) in drawn_here.items():
            sections[name] = (title, picture(drawn(draw(history)), title, escape(caption)))
    if bands is not None:
        sections |= band_sections(history, bands)
    return write_text(path, page("A hip in use", _lede(history), sections))


def _lede(history: History) -> str:
    use, last = history.use, history.last
    notes = "".join(f"<li>{escape(note)}</li>" for note in history.notes)
    told = (
        f"{use.joint}, {use.cycle.name}: {last.volume:.4g} mm³ worn and a penetration of {last.penetration:.3g} mm "
        f"after {last.cycles / 1e6:g} million cycles."
    )
    return f"<p>{escape(told)}</p><ul class='quiet'>{notes}</ul>"


def _numbers(history: History) -> str:
    first, error = history.use.first, history.error
    rows = [
        (
            f"{each.cycles / 1e6:g}",
            *(f"{number:.4g}" for number in (each.volume, each.depth, each.penetration, each.max_pressure)),
            f"{each.creep_depth:.4g}",
            f"{each.edge_distance.min(initial=float('inf')):.3g}",
        )
        for each in history.reports
    ]
    told = (
        f"A cycle slides {first.slide:.4g} mm; pressure times slide is {first.work:.4g} N m, the mean cross-shear "
        f"{first.cross_shear:.3g}. Unworn it wears {first.volume:.4g} mm³ and {first.depth:.3g} mm a million cycles. "
        f"Against the same model in the finest steps the volume is within {100 * error.volume:.2g} %, the depth within "
        f"{100 * error.depth:.2g} %."
    )
    return f"<p>{escape(told)}</p><p>{escape(_rim(history))}</p>{table(_HEADS, rows)}"


def _contacts(history: History) -> str:
    """Lay out validity and utilisation of the worst contact of each activity."""
    said = "The instant of the largest pressure of each activity, unworn and at each report."
    return f"<p>{escape(contact_line(history))}. {said}</p>{words(HEADS, contact_rows(history))}"


def _rim(history: History) -> str:
    """How near the contact comes to the rim, when and where, new and at the end."""
    seen = {"New": history.worst, "at the end": history.last.edge.closest_approach(history.use)}
    told = (
        f"{name} the contact {_how_near(worst.distance)} at {worst.location}"
        for name, worst in seen.items()
        if worst is not None
    )
    return "; ".join(told) or "nothing is pressed"


def _how_near(distance: float) -> str:
    return f"comes within {distance:.3g} mm of the rim" if distance > 0 else "reaches the rim"
