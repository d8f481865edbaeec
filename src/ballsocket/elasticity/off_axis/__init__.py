"""Contact on the sphere: the ball anywhere in a socket, in rings and meridians about the socket's own axis."""

from .forms import DepthTable, Pinched
from .model import Sphere
from .orientations import Orientations, orient
from .preload import Preload
from .scans import Scan, read_scan
from .surfaces import ClosedShell, RealCup, Springs
from .worn import Worn

__all__ = [
    "ClosedShell",
    "DepthTable",
    "Orientations",
    "Pinched",
    "Preload",
    "RealCup",
    "Scan",
    "Sphere",
    "Springs",
    "Worn",
    "orient",
    "read_scan",
]
