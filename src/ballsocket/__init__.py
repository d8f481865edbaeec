"""ballsocket: contact of a ball in a socket of nearly its own radius.

    import ballsocket as bs
    hip = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
    contact = bs.HessForsbach().press(hip, force=3000.0)
    contact.max_pressure

Lengths are in mm, forces in N, moduli and pressures in MPa, angles in rad.
"""

from importlib import import_module
from typing import Any

from .core.lazy import names_of_stub
from .reports.figure_files import register_plots
from .version import __version__ as __version__

register_plots()

_DOORS = ("dynamics", "evidence", "export", "hip", "identification", "studies")
"""Subpackages for users, which are imported on first use."""

_import_name, _, _NAMES = names_of_stub(__name__, __file__)

__all__ = ["studies", *_NAMES]


def __getattr__(name: str) -> Any:
    """Import a name or a subpackage on first use."""
    if name == "press":
        raise AttributeError(
            f"module {__name__!r} has no attribute 'press'; press is a method of models, such as "
            "bs.Exact().press(joint, force=3000.0); bs.compare(joint, force=3000.0) presses with all models"
        )
    return import_module(f"{__name__}.{name}") if name in _DOORS else _import_name(name)


def __dir__() -> list[str]:
    """List the names for users; other modules of the package can still be imported."""
    return sorted({*__all__, *_DOORS, "__doc__", "__version__"})
