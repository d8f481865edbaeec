"""The same contact by CalculiX, the free finite-element program: its input, its run and what it answers.

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
from itertools import pairwise
from math import cos, pi, radians, sin
from pathlib import Path

import numpy

import ballsocket as bs
from ballsocket.elasticity.finite_elements.calculix import SECTORS, read_contact_pressures, read_printed

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


@dataclass(frozen=True, kw_only=True)
class Steps:
    """Force in N, pressure at the pole in MPa and half angle in rad of each step."""

    force: numpy.ndarray
    max_pressure: numpy.ndarray
    half_angle: numpy.ndarray


class Calculix:
    """One joint on one mesh, pushed to some indentations in turn."""

    def __init__(self, joint: bs.Joint, mesh: Mesh, depths: numpy.ndarray, folder: Path) -> None:
        self.steps, self.folder, self.name = len(depths), folder, "deck"
        folder.mkdir(parents=True, exist_ok=True)
        deck = _Deck(joint, mesh)
        self.nodes, self.surface = len(deck.nodes), deck.surface
        (folder / f"{self.name}.inp").write_text(deck.text(depths), encoding="ascii")

    def run(self) -> None:
        command, environment = shutil.which("ccx"), {**os.environ, "OMP_NUM_THREADS": "1"}
        assert command is not None
        subprocess.run([command, "-i", self.name], cwd=self.folder, env=environment, capture_output=True, check=True)

    def answer(self) -> Steps:
        """What the last run wrote; NaN for a step that it did not reach."""
        whole = numpy.full((3, self.steps), numpy.nan)
        for step, forces in read_printed(self.folder / f"{self.name}.dat", "PUSHED").items():
            whole[0, step] = -forces[0, 1] * SECTORS / SCALE
        for step, pressures in read_contact_pressures(self.folder / f"{self.name}.frd").items():
            whole[1:, step] = _profile(self.surface, pressures)
        return Steps(force=whole[0], max_pressure=whole[1], half_angle=whole[2])


def _profile(surface: dict[int, float], pressures: dict[int, float]) -> tuple[float, float]:
    """Pole pressure and half angle from the contact pressures at the nodes of the surface, given with their angles.

    The pressures of a coarse mesh zigzag from node to node, most of all at the pole. So the pole pressure is that of
    a + b φ² + c φ⁴ through the inner two thirds without the pole's own elements. The half angle lies halfway between
    the last node under pressure and the next: no better than the mesh.
    """
    known = surface.keys() & pressures.keys()
    angle, pressure = numpy.array(sorted((surface[node], pressures[node] / SCALE) for node in known)).T
    last = int(numpy.flatnonzero(pressure > 0.01 * numpy.median(pressure[pressure > 0]))[-1])
    edge = float(angle[last] + angle[min(last + 1, len(angle) - 1)]) / 2
    inner = (angle > radians(2.6)) & (angle < 0.67 * edge)
    degree = 2 if numpy.count_nonzero(inner) >= 6 else 1
    fit = numpy.polynomial.Polynomial.fit(angle[inner] ** 2, pressure[inner], degree)
    return float(fit(0.0)), edge


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
        on_bore = ("LINER", round(R2, 9))
        self.surface = {n: angle for (angle, radius, body), n in self.nodes.items() if (body, radius) == on_bore}

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
