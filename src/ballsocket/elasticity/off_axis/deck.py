"""Input decks of tilted loads in three dimensions, with which CalculiX checks the solution.

The mesh is one half of the cup and of the ball's skin, cut by the plane of tilt and axis. It has quadratic bricks of 20
nodes, and wedges of 15 at the pole. Every node of the skin is displaced as a rigid ball. As in the axisymmetric deck, a
small scale multiplies clearance and displacement for the limit of small displacements, and results are divided by it.
Forces are accurate on coarse elements. CalculiX's pressures at the nodes of quadratic faces oscillate and are not used.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import cos, degrees, inf, pi, sin
from pathlib import Path
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.checks import require
from ...core.display import ascii_text
from ...problem import Joint
from ...problem.cup import Cup, Interface
from ..finite_elements.calculix import (
    InputDeck,
    contact_lines,
    deck_paths,
    last_output,
    material_lines,
    node_set_lines,
    read_printed,
    run_calculix,
    step_lines,
)
from ..finite_elements.mesh import add_midpoints, graded_points, join_points, socket_shape
from ..finite_elements.solver import check_cup
from .directions import unit_vectors
from .model import Sphere

_CONTACT_STIFFNESS_FACTOR = 500.0  # ratio of the contact stiffness to the largest pressure over the indentation

_SKIN_THICKNESS = 0.1  # as a fraction of the ball's radius
_INNER_FACE, _OUTER_FACE = "S1", "S2"
_NUMBERS_PER_LINE = 12


@dataclass(frozen=True, kw_only=True, eq=False)
class SphericalBlock:
    """Half of a spherical block, azimuths 0 to π, in quadratic bricks and, at the pole, wedges."""

    # coordinates of the corners in rad and mm, ascending; the first polar angle is 0
    polar: Numbers
    azimuth: Numbers
    radius: Numbers
    centre: Numbers  # (3,), centre in mm
    offset: tuple[int, int] = (0, 0)  # numbers of nodes and of elements in other bodies that come first

    @cached_property
    def number(self) -> Numbers:
        """Number of the node at each polar angle, azimuth and radius, also in the middle of edges; 0 without a node."""
        shape = tuple(2 * len(corners) - 1 for corners in (self.polar, self.azimuth, self.radius))
        i, j, k = numpy.indices(shape)
        used = (i % 2 + j % 2 + k % 2) <= 1
        used[0, 1:] = False  # all azimuths meet at the pole
        number = numpy.where(used, self.offset[0] + numpy.cumsum(used).reshape(shape), 0)
        number[0, 1:] = number[0, :1]
        return number

    @property
    def last_number(self) -> int:
        """Largest number of a node."""
        return int(self.number.max())

    @cached_property
    def points(self) -> Numbers:
        """Coordinates of the nodes in mm: (3, polar, azimuth, radius)."""
        polar, azimuth, radius = (add_midpoints(corners, 2) for corners in (self.polar, self.azimuth, self.radius))
        directions = unit_vectors(polar[:, None], azimuth)
        return directions[..., None] * radius + self.centre[:, None, None, None]

    def elements(self) -> Iterator[tuple[int, str, tuple[int, int, int], list[int]]]:
        """Yield number, type, indices and node numbers of each element."""
        number = self.offset[1]
        for i, j, k in numpy.ndindex(len(self.polar) - 1, len(self.azimuth) - 1, len(self.radius) - 1):
            number += 1
            kind, steps = ("C3D15", _WEDGE) if i == 0 else ("C3D20R", _BRICK)
            nodes = [int(self.number[2 * i + a, 2 * j + b, 2 * k + c]) for a, b, c in steps]
            yield number, kind, (i, j, k), nodes

    def node_lines(self) -> Iterator[str]:
        """Yield a line of number and coordinates for each node."""
        points = self.points.reshape(3, -1)
        numbers, first = numpy.unique(self.number.ravel(), return_index=True)
        for number, index in zip(numbers, first, strict=True):
            if number:
                x, y, z = points[:, index]
                yield f"{number}, {x:.14g}, {y:.14g}, {z:.14g}"


def _element_nodes(corners: list[tuple[int, int]], middles: list[tuple[int, int]]) -> list[tuple[int, int, int]]:
    """Return the nodes of an element: corners and middles at inner and outer face, then middles of the radial edges."""
    rows = [(corners, 0), (corners, 2), (middles, 0), (middles, 2), (corners, 1)]
    return [(a, b, c) for row, c in rows for a, b in row]


_BRICK = _element_nodes([(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 0), (2, 1), (1, 2), (0, 1)])
_WEDGE = _element_nodes([(0, 0), (2, 0), (2, 2)], [(1, 0), (2, 1), (1, 2)])


@dataclass(frozen=True, kw_only=True, eq=False)
class TiltedDeck(InputDeck):
    """Input deck of a rigid ball that is displaced into a cup at a tilt.

    Raises ValueError: an elastic ball, a liner that slides, a free outer surface, a number outside its allowed range.
    """

    joint: Joint  # one joint with a rigid ball and a liner that is bonded to rigid ground or layers
    cup: Cup
    indentation: float  # displacement of the ball's centre beyond the clearance, in mm
    tilt: float  # angle of the displacement from the cup's axis in rad, 0 to π
    element_size: float = pi / 60  # size of the elements along the bore in rad, 0.5° to 15°
    scale: float = 1e-3  # factor on clearance and indentation, above 0 and at most 1

    def __post_init__(self) -> None:
        check_cup(self.cup, self.joint)
        if self.joint.ball is not None:
            raise ValueError("a tilted deck has a rigid ball: leave the ball's material out")
        if self.cup.interface is not Interface.BONDED or self.joint.support.value != "fixed":
            raise ValueError("a tilted deck needs a bonded liner and a fixed outer surface")
        require("indentation", self.indentation, 0 < self.indentation < inf, "an indentation (mm) is above 0")
        require("tilt", self.tilt, 0 <= self.tilt <= pi, "a tilt is 0 to pi radians")
        allowed = pi / 360 <= self.element_size <= pi / 12
        require("element_size", self.element_size, allowed, "an element is 0.5 to 15 degrees wide")
        require("scale", self.scale, 0 < self.scale <= 1, "a scale lies above 0 and is at most 1")

    @cached_property
    def _layer_radii(self) -> list[Numbers]:
        inner, first, radii, scale = 1.0, self.element_size, [], float(self.joint.socket_radius)
        for outer, _, _ in socket_shape(self.joint, self.cup).layers:
            if outer == inf:
                raise ValueError("a tilted deck has layers of finite thickness: give the outermost one a thickness")
            layer = graded_points(inner, outer, min(first, (outer - inner) / 3), 1.5, (outer - inner) / 3)
            radii.append(layer * scale)
            inner, first = outer, float(layer[-1] - layer[-2]) * 1.5
        return radii

    @cached_property
    def socket(self) -> SphericalBlock:
        """Mesh of the cup, without a chamfer: the bore ends on a cone where the chamfer begins."""
        return SphericalBlock(
            polar=self._divide_angles(socket_shape(self.joint, self.cup).reach),
            azimuth=self._divide_angles(pi),
            radius=join_points(self._layer_radii),
            centre=numpy.zeros(3),
        )

    @cached_property
    def ball(self) -> SphericalBlock:
        """Mesh of the ball's skin, at first touch."""
        clearance = float(self.joint.clearance) * self.scale
        radius = float(self.joint.socket_radius) - clearance
        return SphericalBlock(
            polar=self.socket.polar,
            azimuth=self.socket.azimuth,
            radius=numpy.array([(1 - _SKIN_THICKNESS) * radius, radius]),
            centre=clearance * self._displacement_direction,
            offset=(self.socket.last_number, sum(1 for _ in self.socket.elements())),
        )

    def _divide_angles(self, end: float) -> Numbers:
        """Compute the corners of elements of equal size from 0 to an end, in rad."""
        return numpy.linspace(0.0, end, max(round(end / self.element_size), 4) + 1)

    @property
    def _displacement_direction(self) -> Numbers:
        return numpy.array([sin(self.tilt), 0.0, cos(self.tilt)])

    def lines(self) -> Iterator[str]:
        """Yield the lines of the deck in ASCII."""
        penalty = _CONTACT_STIFFNESS_FACTOR * self.expected["max_pressure"] / self.indentation
        lined, pressed = (
            [f"{number}, {face}" for number, _, (_, _, k), _ in body.elements() if k == 0]
            for body, face in ((self.socket, _INNER_FACE), (self.ball, _OUTER_FACE))
        )
        x, _, z = self.scale * self.indentation * self._displacement_direction
        yield f"** {ascii_text(str(self.joint))}"[:200]
        yield f"** Rigid ball displaced at {degrees(self.tilt):g} degrees from the cup's axis z; half, y > 0."
        yield f"** Clearance and indentation are multiplied by {self.scale:g}: divide forces by it; twice"
        yield "** the forces are those of the whole cup. Units N, mm, MPa."
        yield "*NODE, NSET=ALL"
        for body in (self.socket, self.ball):
            yield from body.node_lines()
        ends = numpy.cumsum([len(layer) - 1 for layer in self._layer_radii])
        yield from _element_lines(self.socket, lambda k: f"LAYER{int(numpy.searchsorted(ends, k, 'right'))}")
        yield from _element_lines(self.ball, lambda k: "SKIN")
        # the skin of the ball is almost rigid
        liner, shells = float(self.joint.liner.young), socket_shape(self.joint, self.cup).layers
        layers = {f"LAYER{i}": (young * liner, nu) for i, (_, young, nu) in enumerate(shells)}
        yield from material_lines({**layers, "SKIN": (1e3 * liner, 0.3)})
        yield from contact_lines(lined, pressed, penalty)
        for name, nodes in (  # of the symmetry plane, the fixed ones, and the ball's skin
            ("MIRROR", self.socket.number[:, [0, -1]]),
            ("OUTSIDE", self.socket.number[:, :, -1]),
            ("PUSHED", self.ball.number),
        ):
            yield from node_set_lines(name, numpy.unique(nodes[nodes > 0]))
        yield from ("*BOUNDARY", "MIRROR, 2, 2", "OUTSIDE, 1, 3", "PUSHED, 1, 3")
        yield from step_lines([(1, x), (3, z)])

    def expected_record(self) -> dict[str, Any]:
        """Return the expected results for JSON, with scale and tilt."""
        return {"scale": self.scale, "tilt_deg": degrees(self.tilt), **self.expected}

    @cached_property
    def expected(self) -> dict[str, Any]:
        """Expected results without the scale: indentation (mm), force vector (N) and largest pressure (MPa)."""
        contact: Any = Sphere(cup=self.cup).press(self.joint, indentation=self.indentation, tilt=self.tilt)
        return {
            "indentation": self.indentation,
            "force_vector": [float(component) for component in contact.force_vector],
            "max_pressure": float(contact.max_pressure),
        }


def _element_lines(body: SphericalBlock, set_name: Callable[[int], str]) -> Iterator[str]:
    """Yield the lines of a body's elements, sorted by type and layer, in the set that `set_name` gives a layer."""
    previous = None
    for number, kind, (_, _, k), nodes in sorted(body.elements(), key=lambda element: (element[1], element[2][2])):
        header = f"*ELEMENT, TYPE={kind}, ELSET={set_name(k)}"
        if header != previous:
            yield header
            previous = header
        row = [number, *nodes]
        for start in range(0, len(row), _NUMBERS_PER_LINE):
            end = start + _NUMBERS_PER_LINE
            yield ", ".join(map(str, row[start:end])) + ("," if end < len(row) else "")


def run(out: Path, *, threads: int = 1) -> Mapping[str, Any]:
    """Run CalculiX on a tilted deck, or that in a folder, and return its result for the real joint.

    Returns
    -------
    mapping
        `force_vector` in N: towards the rim, across, towards the dome.

    Raises
    ------
    FileNotFoundError
        The command `ccx` is not installed, or there is no deck in the folder.
    RuntimeError
        CalculiX failed; the message ends with its output.
    """
    path, expected = deck_paths(out)
    process = run_calculix(out, threads)
    forces = read_printed(path.with_suffix(".dat"), "PUSHED")
    if 0 not in forces:
        raise RuntimeError(f"ccx ended with {process.returncode}: {last_output(process)}")
    deck = json.loads(expected.read_text(encoding="ascii"))
    x, _, z = 2 * forces[0][0] / deck["scale"]
    return {"force_vector": [float(x), 0.0, float(z)]}
