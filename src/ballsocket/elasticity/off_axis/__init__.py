"""Contact of a ball at any position in a socket, on a grid of rings and meridians about the socket's axis."""

from .bore_shapes import BoreDeviation, DepthTable, OvalBore
from .model import Sphere
from .orientations import Orientations, orient
from .preload import Preload, PullOut, pull_out
from .scans import Scan, read_scan
from .surfaces import ClosedShell, RealCup, Springs

Pinched, Worn = OvalBore, BoreDeviation
"""Names of version 1.0."""

__all__ = [
    "BoreDeviation",
    "ClosedShell",
    "DepthTable",
    "Orientations",
    "OvalBore",
    "Pinched",
    "Preload",
    "PullOut",
    "RealCup",
    "Scan",
    "Sphere",
    "Springs",
    "Worn",
    "orient",
    "pull_out",
    "read_scan",
]
