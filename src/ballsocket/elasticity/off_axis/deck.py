"""A tilted load as a three-dimensional input deck, so that another program can check the answer.

Half of the cup and of the ball's skin, cut by the plane of tilt and axis: quadratic bricks of 20 nodes, wedges of 15
at the pole. Every node of the ball's skin is moved as a rigid ball moves. As in the axisymmetric deck, clearance and
displacement are multiplied by a small scale, for the limit of small displacements, and what comes out is divided by it.
Forces are close on coarse elements already; CalculiX' pressures at the nodes of quadratic faces zigzag and say little.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, inf, pi, sin
from pathlib import Path
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.checks import require
from ...core.storage.atomic import write_text
from ...problem import Joint
from ...problem.cup import Cup, Interface
from ..finite_elements.decks.calculix import last_output, read_printed, run_calculix
from ..finite_elements.decks.deck import EXPECTED, NAME
from ..finite_elements.mesh import graded_points, join_points
from ..finite_elements.shapes import SocketShape, socket_shape
from ..finite_elements.solver import check_cup
from .bricks import Bricks

_STIFFER = 500.0
_SKIN = 0.1  # of the radius
_INNER, _OUTER = "S1", "S2"
_A_LINE = 16


@dataclass(frozen=True, kw_only=True, eq=False)
class TiltedDeck:
    """An input deck of a rigid ball that is displaced into a cup at a tilt.

    Parameters
    ----------
    joint : Joint
        Of plain numbers, with a rigid ball and a liner that is bonded to rigid ground or layers.
    cup : Cup
    indentation : float
        Displacement of the ball's centre beyond the clearance, in mm.
    tilt : float
        Of the displacement from the cup's axis, in rad, 0 to π.
    element_size : float
        Of the elements along the bore, in rad.
    scale : float
        What clearance and indentation are multiplied by.

    Raises
    ------
    ValueError
        An elastic ball, a liner that slides, a free outer surface, a number that is not allowed.
    """

    joint: Joint
    cup: Cup
    indentation: float
    tilt: float
    element_size: float = pi / 60
    scale: float = 1e-3

    def __post_init__(self) -> None:
        check_cup(self.cup, self.joint)
        if self.joint.ball is not None:
            raise ValueError("a tilted deck has a rigid ball: leave the ball's material out")
        if self.cup.interface is not Interface.BONDED or self.joint.support.value != "fixed":
            raise ValueError("a tilted deck has a liner that is bonded, and is held by its outermost surface")
        require("indentation", self.indentation, 0 < self.indentation < inf, "an indentation (mm) is above 0")
        require("tilt", self.tilt, 0 <= self.tilt <= pi, "a tilt is 0 to pi radians")
        good = pi / 360 <= self.element_size <= pi / 12
        require("element_size", self.element_size, good, "an element is 0.5 to 15 degrees wide")
        require("scale", self.scale, 0 < self.scale <= 1, "a scale lies above 0 and is at most 1")

    @cached_property
    def _shape(self) -> SocketShape:
        return socket_shape(self.joint, self.cup)

    @cached_property
    def _layers(self) -> list[Numbers]:
        """Radii of the corners in each layer, in mm."""
        inner, first, radii = 1.0, self.element_size, []
        for outer, _, _ in self._shape.layers:
            if outer == inf:
                raise ValueError("a tilted deck has layers of finite thickness: give the outermost one a thickness")
            layer = graded_points(inner, outer, min(first, (outer - inner) / 3), 1.5, (outer - inner) / 3)
            radii.append(layer * self._bore)
            inner, first = outer, float(layer[-1] - layer[-2]) * 1.5
        return radii

    @property
    def _bore(self) -> float:
        return float(self.joint.socket_radius)

    @cached_property
    def socket(self) -> Bricks:
        """The cup. A chamfer is left out: the bore ends where it begins, on a cone."""
        return Bricks(
            polar=self._evenly(self._shape.reach),
            azimuth=self._evenly(pi),
            radius=join_points(self._layers),
            centre=numpy.zeros(3),
        )

    @cached_property
    def ball(self) -> Bricks:
        """The ball's skin, at first touch."""
        clearance = float(self.joint.clearance) * self.scale
        radius = self._bore - clearance
        return Bricks(
            polar=self.socket.polar,
            azimuth=self.socket.azimuth,
            radius=numpy.array([(1 - _SKIN) * radius, radius]),
            centre=clearance * self._way,
            before=(self.socket.count, sum(1 for _ in self.socket.elements())),
        )

    def _evenly(self, end: float) -> Numbers:
        return numpy.linspace(0.0, end, max(round(end / self.element_size), 4) + 1)

    @property
    def _way(self) -> Numbers:
        return numpy.array([sin(self.tilt), 0.0, cos(self.tilt)])

    def text(self) -> str:
        """The deck, in ASCII."""
        lines = [*self._title(), *self._mesh(), *self._materials(), *self._contact(), *self._step()]
        return "\n".join(lines) + "\n"

    def write(self, folder: Path) -> Path:
        """Write `ballsocket.inp` and `expected.json` into a folder, which is made; gives the path of the former."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        record = {"scale": self.scale, "tilt_deg": degrees(self.tilt), **self.expected}
        write_text(folder / EXPECTED, json.dumps(record) + "\n", encoding="ascii")
        return write_text(folder / f"{NAME}.inp", self.text(), encoding="ascii")

    @cached_property
    def expected(self) -> dict[str, Any]:
        """Our own answer of the real joint."""
        from .model import Sphere

        contact: Any = Sphere(cup=self.cup).press(self.joint, indentation=self.indentation, tilt=self.tilt)
        return {
            "indentation": self.indentation,
            "force_vector": [float(each) for each in contact.force_vector],
            "max_pressure": float(contact.max_pressure),
        }

    def _title(self) -> Iterator[str]:
        joint = str(self.joint).encode("ascii", "replace").decode()
        yield f"** {joint}"[:200]
        yield f"** Rigid ball displaced at {degrees(self.tilt):g} degrees from the cup's axis z; half, y > 0."
        yield f"** Clearance and indentation are multiplied by {self.scale:g}: divide forces by it; twice"
        yield "** the forces are those of the whole cup. Units N, mm, MPa."

    def _mesh(self) -> Iterator[str]:
        yield "*NODE, NSET=ALL"
        for body in (self.socket, self.ball):
            yield from body.node_lines()
        ends = numpy.cumsum([len(layer) - 1 for layer in self._layers])
        yield from self._element_lines(self.socket, lambda k: f"LAYER{int(numpy.searchsorted(ends, k, 'right'))}")
        yield from self._element_lines(self.ball, lambda k: "SKIN")

    @staticmethod
    def _element_lines(body: Bricks, named: Any) -> Iterator[str]:
        headed = None
        for number, kind, (_, _, k), nodes in sorted(body.elements(), key=lambda each: (each[1], each[2][2])):
            head = f"*ELEMENT, TYPE={kind}, ELSET={named(k)}"
            if head != headed:
                yield head
                headed = head
            row = [number, *nodes]
            yield from (
                ", ".join(map(str, row[i : i + 12])) + ("," if i + 12 < len(row) else "")
                for i in range(0, len(row), 12)
            )

    def _materials(self) -> Iterator[str]:
        liner = float(self.joint.liner.young)
        named = {f"LAYER{i}": (young * liner, nu) for i, (_, young, nu) in enumerate(self._shape.layers)}
        for name, (young, nu) in (named | {"SKIN": (1e3 * liner, 0.3)}).items():
            yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12g}, {nu:.12g}")
            yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"

    def _contact(self) -> Iterator[str]:
        slope = _STIFFER * self.expected["max_pressure"] / self.indentation
        for name, body, face, layer in (("LINED", self.socket, _INNER, 0), ("PRESSED", self.ball, _OUTER, 0)):
            yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
            yield from (f"{number}, {face}" for number, _, place, _ in body.elements() if place[2] == layer)
        yield from (
            "*SURFACE INTERACTION, NAME=TOUCH",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            f"{slope:.6g}",
        )
        yield from ("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "LINED, PRESSED")
        number = self.socket.number
        plane = numpy.concatenate([number[:, 0].ravel(), number[:, -1].ravel()])
        yield from _node_set("MIRROR", plane)
        yield from _node_set("OUTSIDE", number[:, :, -1].ravel())
        yield from _node_set("PUSHED", self.ball.number.ravel())
        yield from ("*BOUNDARY", "MIRROR, 2, 2", "OUTSIDE, 1, 3", "PUSHED, 1, 3")

    def _step(self) -> Iterator[str]:
        x, _, z = self.scale * self.indentation * self._way
        yield from ("*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY")
        yield from (f"PUSHED, 1, 1, {x:.13g}", f"PUSHED, 3, 3, {z:.13g}")
        yield from ("*NODE PRINT, NSET=PUSHED, TOTALS=ONLY", "RF", "*END STEP")


def _node_set(name: str, nodes: Numbers) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    listed = sorted({int(node) for node in nodes if node})
    for start in range(0, len(listed), _A_LINE):
        yield ", ".join(map(str, listed[start : start + _A_LINE]))


def run(folder: Path, *, threads: int = 1) -> Mapping[str, Any]:
    """Run CalculiX on the tilted deck in a folder, and read its answer, scaled back to the real joint.

    Returns
    -------
    mapping
        `force_vector` in N: towards the rim, across, towards the dome.

    Raises
    ------
    FileNotFoundError
        The command `ccx` is not installed, or there is no deck in the folder.
    RuntimeError
        CalculiX failed; with its last words.
    """
    folder = Path(folder)
    done = run_calculix(folder, threads)
    forces = read_printed(folder / f"{NAME}.dat", "PUSHED")
    if 0 not in forces:
        raise RuntimeError(f"ccx ended with {done.returncode}: {last_output(done)}")
    deck = json.loads((folder / EXPECTED).read_text(encoding="ascii"))
    x, _, z = 2 * forces[0][0] / deck["scale"]
    return {"force_vector": [float(x), 0.0, float(z)]}
