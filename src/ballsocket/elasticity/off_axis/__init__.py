"""Contact of a ball at any position in a socket, on a grid of rings and meridians about the socket's axis."""

from .bore_shapes import BoreDeviation, DepthTable, OvalBore
from .model import Sphere
from .orientations import Orientations, orient
from .preload import Preload, PullOut, pull_out
from .scans import Scan, read_scan
from .surfaces import ClosedShell, RealCup, Springs

__all__ = [
    "BoreDeviation",
    "ClosedShell",
    "DepthTable",
    "Orientations",
    "OvalBore",
    "Preload",
    "PullOut",
    "RealCup",
    "Scan",
    "Sphere",
    "Springs",
    "orient",
    "pull_out",
    "read_scan",
]
