"""CalculiX and ours on one mesh, the paper's: a quarter of an hour, nearly all of it CalculiX'.

It gets exactly our mesh and indentations by `ballsocket deck`. It has contact by penalty on the deformed shape, at a
thousandth of the size; its time is that of the process, both cores allowed.
"""

from __future__ import annotations

from .fem_rival import on_the_papers_mesh
from .report import Report

NOTES = (
    "CalculiX 2.20: CAX4, face-to-face penalty, SPOOLES with two threads. Flat facets catch on each other, so that its "
    "nodal pressures are not read.",
)


def measure() -> Report:
    """Once."""
    return Report([on_the_papers_mesh()], NOTES, ("scipy", "scikit-fem"))
