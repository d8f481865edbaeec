"""The same contact by CalculiX, the free finite-element program: its input and its run.

Axisymmetric 8-node quadrilaterals of reduced integration, frictionless face-to-face penalty contact. The ball is rigid:
one ring of elements, every node of it displaced, so that it costs nothing and indentation means the same as ours. The
liner's outer surface is fixed; it ends at 120 degrees, where a rim no longer matters. Clearance and indentation are a
thousandth of the real ones and the force is scaled back, which leaves the small-displacement limit. Both surfaces have
their nodes at the same angles, so that the gap between them does not feel the elements' curvature. A small element at
the pole is worth its cost: without it the error is several times as large.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy

import ballsocket as bs

from .timing import Job

SCALE = 1e-3
RIM, GROWTH, WIDEST = 120.0, 1.3, 15.0  # degrees, of the liner's elements beyond the contact
RING = 1.0  # mm of rigid ball


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """`angles` are (end in degrees, elements up to there); `deep` elements through the liner, each `ratio` times as
    thick as the one before; `slope` is the contact's penalty in MPa/mm.
    """

    name: str
    angles: tuple[tuple[float, int], ...]
    deep: int
    slope: float
    ratio: float = 1.3


def calculix(joint: bs.Joint, mesh: Mesh, depths: numpy.ndarray, folder: Path) -> Job | str:
    """Write one joint on one mesh, pushed to some indentations in turn; return its run, or why it is skipped."""
    command = shutil.which("ccx")
    if command is None:
        return "no command ccx"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "deck.inp").write_text(_Deck(joint, mesh).text(depths), encoding="ascii")
    options: Any = {"cwd": folder, "env": {**os.environ, "OMP_NUM_THREADS": "1"}, "capture_output": True, "check": True}
    return Job(partial(subprocess.run, [command, "-i", "deck"], **options))


class _Deck:
    """Nodes and elements of liner and ball; x is the distance from the axis, the ball is pushed along -y."""

    def __init__(self, joint: bs.Joint, mesh: Mesh) -> None:
        self.joint, self.mesh = joint, mesh
        self.nodes: dict[tuple[float, float, str], int] = {}
        self.places: list[tuple[float, float]] = []
        self.elements: dict[str, list[list[int]]] = {"LINER": [], "BALL": []}
        self.inner: dict[str, list[int]] = {"LINER": [], "BALL": []}
        R2, L, c = float(joint.socket_radius), float(joint.liner_thickness), SCALE * float(joint.clearance)
        contact, angles = _angles(mesh)
        layers = numpy.cumsum([0.0, *(mesh.ratio**k for k in range(mesh.deep))]).astype(float)
        self.radii = R2 + L * layers / layers[-1]
        self._fill("LINER", angles, self.radii, 0.0)
        self._fill("BALL", angles[: contact + 1], numpy.array([R2 - c - RING, R2 - c]), c)
        self.touching = self.inner["LINER"][:contact]

    def _fill(self, body: str, angles: numpy.ndarray, radii: numpy.ndarray, drop: float) -> None:
        count = sum(map(len, self.elements.values()))
        for a, b in pairwise(angles):
            for number, (r, s) in enumerate(pairwise(radii)):
                count += 1
                middle, deep = (a + b) / 2, (r + s) / 2
                corners = ((a, s), (b, s), (b, r), (a, r), (middle, s), (b, deep), (middle, r), (a, deep))
                nodes = [self._node(angle, radius, body, drop) for angle, radius in corners]
                self.elements[body].append([count, *nodes])
                if number == 0:
                    self.inner[body].append(count)

    def _node(self, angle: float, radius: float, body: str, drop: float) -> int:
        key = (round(angle, 9), round(radius, 9), body)
        if key not in self.nodes:
            self.nodes[key] = len(self.nodes) + 1
            self.places.append((radius * sin(angle) if angle else 0.0, -radius * cos(angle) - drop))
        return self.nodes[key]

    def text(self, depths: numpy.ndarray) -> str:
        outer = round(float(self.radii[-1]), 9)
        fixed = [n for (_, radius, body), n in self.nodes.items() if body == "LINER" and radius == outer]
        axis = [
            n for (angle, radius, body), n in self.nodes.items() if (body, angle) == ("LINER", 0) and radius != outer
        ]
        ball = [n for (*_, body), n in self.nodes.items() if body == "BALL"]
        liner = self.joint.liner
        lines = ["*NODE, NSET=ALL", *(f"{n},{x:.16g},{y:.16g}" for n, (x, y) in enumerate(self.places, 1))]
        for body, elements in self.elements.items():
            lines += [f"*ELEMENT, TYPE=CAX8R, ELSET={body}", *(",".join(map(str, element)) for element in elements)]
        for name, members in (("FIXED", fixed), ("AXIS", axis), ("PUSHED", ball)):
            lines += [f"*NSET, NSET={name}", *(f"{n}," for n in sorted(members))]
        lines += ["*SURFACE, NAME=LINED", *(f"{e},S3" for e in self.touching)]
        lines += ["*SURFACE, NAME=ROUND", *(f"{e},S1" for e in self.inner["BALL"])]
        lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{liner.young},{liner.poisson}"]
        lines += [f"*SOLID SECTION, ELSET={body}, MATERIAL=M" for body in self.elements]
        lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
        lines += [f"{self.mesh.slope:g}", "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "LINED,ROUND"]
        lines += ["*BOUNDARY", "FIXED,1,2", "AXIS,1,1"]
        for depth in depths:
            lines += ["*STEP, INC=100", "*STATIC", "1.,1.", "*BOUNDARY", "PUSHED,1,1"]
            lines += [f"PUSHED,2,2,{-SCALE * depth:.12g}", "*NODE PRINT, NSET=PUSHED, TOTALS=ONLY", "RF"]
            lines += ["*CONTACT FILE", "CDIS, CSTR", "*END STEP"]
        return "\n".join(lines) + "\n"


def _angles(mesh: Mesh) -> tuple[int, numpy.ndarray]:
    """How many elements may touch, and where the elements of the liner end, in rad."""
    angles = [0.0]
    for end, count in mesh.angles:
        angles += numpy.linspace(angles[-1], end, count + 1)[1:].tolist()
    contact, width = len(angles) - 1, angles[-1] - angles[-2]
    while angles[-1] < RIM:
        width = min(GROWTH * width, WIDEST)
        angles.append(angles[-1] + width)
    return contact, numpy.array(angles) * pi / 180
