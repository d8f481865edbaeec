"""The model of one contact as an input deck, on the mesh that answered, so that other programs can check the answer.

x is the distance from the load axis, y points up; the ball is pushed down by its equator, which stays plane and is free
along itself. Elements are CAX4 or, without the middle node of ours, CAX8R.

Contact of surfaces that move is not the linear problem that this package solves, but tends to it as the movements
become small. So clearance and indentation are multiplied by a small scale, and what comes out is divided by it.

CalculiX reads the deck as it is. By its manual Abaqus differs in three things (nobody has run it there yet): it wants
`TOTALS=YES` for `TOTALS=ONLY` and `CDISP, CSTRESS` behind *CONTACT FILE, and its forces are those of the whole ring,
where CalculiX calculates two degrees of it and prints a 180th.

CalculiX's contact is no judge of CAX4: it sees flat facets, which touch along their edges only. With 20 elements along
the contact its force is 6 % too large, with 100, 200 of them 0.7 %, 0.3 %, and its pressures are several times ours.
CAX8R has no such trouble.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import degrees, prod
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy

from ...arrays import Numbers
from ...atomic import write_text
from ...checks import require
from ...gaps import LinearGap
from ...joint import Joint, Material
from ...version import __version__
from ..bodies import ball_body, socket_body
from ..contact import MeshedContact
from ..mesh import Block, block
from ..shapes import socket_shape
from ..surfaces import Pair
from ..work import Solved
from .solid import TYPES, Solid, node_set

NAME, EXPECTED = "ballsocket", "expected.json"
"""Names of the deck, as CalculiX wants it, and of the file beside it."""

_STIFFER = 2000.0
_FALSE = 2e-3  # of the indentation
_RING = 0.05  # of a rigid ball's radius, meshed
_INSIDE, _OUTSIDE = "S4", "S2"
_WIDTH = 100
_SAME = 1e-9  # rad


def deck_of(contact: MeshedContact, *, steps: int = 8, scale: float = 1e-3) -> Deck:
    """The input deck of one contact.

    The gap between elements is that between spheres where both bodies have their nodes at the same angles, as they do
    unless the contact is wide and a rim or chamfer near, or the ball has a spacing of its own. Elsewhere it is only as
    good as the elements follow the sphere: parabolas do well, chords do not.

    Parameters
    ----------
    contact : MeshedContact
        One contact under load, pressed by a `FiniteElement` with the linear gap.
    steps : int
        Equal indentations up to the contact's own, one step each; 1 or more.
    scale : float
        What clearance and indentation are multiplied by, above 0 and at most 1. 1 is the real geometry, whose answer
        differs from ours by what small displacements leave out.

    Raises
    ------
    ValueError
        Several contacts, one without load or answer, a circular gap, surfaces that follow the sphere too
        coarsely where they do not match, or a number that is not allowed.
    """
    if prod(contact.laws.shape) != 1:
        raise ValueError(f"a deck is for one contact, not {contact.laws.shape}: press it alone")
    require("steps", steps, isinstance(steps, int) and steps >= 1, "a deck has a whole number of steps, 1 or more")
    require("scale", scale, 0 < scale <= 1, "a scale lies above 0 and is at most 1")
    if contact.model.gap is not LinearGap:
        raise ValueError("a deck tends to the linear gap: press with gap=LinearGap")
    room = _false_gap(contact._solved.pair) / (scale * contact._solved.indentation)
    if room > _FALSE:
        raise ValueError(
            f"elements of ball and socket do not match, which leaves a gap of {room:.1%} of the scaled indentation: "
            "take smaller ones, Element.BIQUADRATIC, or a larger scale"
        )
    return Deck(contact=contact, steps=steps, scale=scale)


def _false_gap(pair: Pair) -> float:
    """Between the surface of elements and its sphere, in mm; 0 where it is the same for both bodies.

    A chord lies R h²/2 below its arc of half angle h, a parabola through three of its points R h⁴/32.
    """
    corners = [surface.corners[surface.corners <= pair.angle[-1] + _SAME] for surface in pair.surfaces]
    if all(len(own) == len(pair.angle) and abs(own - pair.angle).max() < _SAME for own in corners):
        return 0.0
    half = max(float(numpy.diff(own).max()) for own in corners) / 2
    return pair.radius * (half**2 / 2 if pair.resolution.order == 1 else half**4 / 32)


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck:
    """An input deck; see `deck_of`.

    Attributes
    ----------
    contact : MeshedContact
    steps : int
    scale : float
        What forces (N), pressures (MPa) and displacements (mm) of the deck are to be divided by.
    """

    contact: MeshedContact
    steps: int
    scale: float

    def text(self) -> str:
        """The deck, in ASCII."""
        lines = [*self._title(), *self._meshes(), *self._materials(), *self._touching(), *self._supports()]
        for depth in self._depths:
            lines += _step(-self.scale * depth)
        return "\n".join(lines) + "\n"

    def write(self, folder: Path) -> Path:
        """Write `ballsocket.inp` and `expected.json` into a folder, which is made; gives the path of the former.

        `expected.json` has the joint, the scale, the elements' type; our own answer of the real joint under "steps"
        (`indentation` in mm, `force` in N, `max_pressure` and `pole_pressure` in MPa, `half_angle_deg`; null where
        there is none); and the nodes of both surfaces with their angles in rad, under "bore" and "round". Each file
        appears at once: an interrupted write leaves none.

        Raises
        ------
        OSError
            A folder that cannot be written to.
        """
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        write_text(folder / EXPECTED, json.dumps(self._record(), indent=1) + "\n", encoding="ascii")
        return write_text(folder / f"{NAME}.inp", self.text(), encoding="ascii")

    # --- what is expected ---

    @cached_property
    def expected(self) -> dict[str, Numbers]:
        """Our own answer at each step (steps,), by name, with indentation in mm, force in N, pressures in MPa."""
        answer = self.contact.model.press(self._joint, indentation=self._depths)
        return {
            "indentation": self._depths,
            "force": answer.force,
            "max_pressure": answer.max_pressure,
            "pole_pressure": answer.pole_pressure,
            "half_angle_deg": numpy.degrees(answer.half_angle),
        }

    @property
    def slope(self) -> float:
        """The contact's penalty in MPa/mm.

        The bodies overlap by pressure over slope. 2000 times the largest pressure per indentation of all steps makes
        that a 2000th of the indentation or less, which takes about twice as much from the force: it was 0.05 %. Ten
        times as much takes ten times less, but the nodal pressures zigzag more.
        """
        return _STIFFER * float(numpy.nanmax(self.expected["max_pressure"] / self.expected["indentation"]))

    @property
    def _depths(self) -> Numbers:
        return float(self._solved.indentation) * numpy.arange(1, self.steps + 1) / self.steps

    def _rows(self) -> list[list[float]]:
        return numpy.stack(list(self.expected.values()), axis=-1).tolist()

    def _record(self) -> dict[str, Any]:
        return {
            "ballsocket": __version__,
            "joint": self._joint.summary(),
            "scale": self.scale,
            "element": TYPES[self._solved.pair.resolution.order],
            "steps": [
                {name: None if numpy.isnan(value) else value for name, value in zip(self.expected, row, strict=True)}
                for row in self._rows()
            ],
            "bore": self._socket.surface(),
            "round": self._ball.surface(),
        }

    # --- bodies ---

    @property
    def _solved(self) -> Solved:
        return self.contact._solved

    @cached_property
    def _joint(self) -> Joint:
        return self.contact._plain_joint

    @cached_property
    def _socket(self) -> Solid:
        body = socket_body(socket_shape(self._joint, self.contact.model.cup), self._solved.pair.resolution)
        return Solid(
            names=("LINER", *(f"BACKING{number}" for number in range(1, len(self._joint.backing) + 1))),
            block=body.elastic.block,
            held=body.held.reshape(-1, 2).T,
            contact=body.contact,
            radius=float(self._joint.socket_radius),
        )

    @cached_property
    def _ball(self) -> Solid:
        """Where it first touches. It is as large as the scaled clearance leaves room for."""
        mesh, held, contact = self._ring() if self._joint.ball is None else self._half(self._joint.ball)
        clearance = self.scale * float(self._joint.clearance)
        return Solid(
            names=("BALL",),
            block=mesh,
            held=held,
            contact=contact,
            radius=float(self._joint.socket_radius) - clearance,
            drop=clearance,
            nodes_before=self._socket.nodes,
            elements_before=self._socket.block.elements.shape[1],
        )

    def _half(self, material: Material) -> tuple[Block, Numbers, Numbers]:
        body = ball_body(float(material.poisson), self._solved.pair.ball_resolution)
        return body.elastic.block, body.held.reshape(-1, 2).T, body.contact

    def _ring(self) -> tuple[Block, Numbers, Numbers]:
        """A rigid ball: one layer of elements, matching the bore's and one element longer, all of it held."""
        corners = self._solved.pair.angle
        corners = numpy.append(corners, 2 * corners[-1] - corners[-2])
        mesh = block(corners, [numpy.array([1 - _RING, 1.0])], self._solved.pair.resolution.order)
        return mesh, numpy.ones((2, mesh.number.size), dtype=bool), mesh.number[:, -1]

    @property
    def _layers(self) -> dict[str, tuple[float, float]]:
        """Young's modulus and Poisson's ratio of each set of elements; those of a rigid ball do not matter."""
        joint = self._joint
        materials = [joint.liner, *(layer.material for layer in joint.backing), joint.ball or joint.liner]
        moduli = {
            name: (float(material.young), float(material.poisson))
            for name, material in zip((*self._socket.names, *self._ball.names), materials, strict=True)
        }
        young, poisson = moduli["BALL"]
        return {**moduli, "BALL": (young * float(joint.socket_radius) / self._ball.radius, poisson)}

    # --- lines ---

    def _title(self) -> Iterator[str]:
        for sentence in self._sentences():
            yield from (f"** {line}" for line in wrap(sentence, _WIDTH))
        for number, row in enumerate(self._rows(), 1):
            yield f"** {number:4d}" + "".join(f"{value:16.7g}" for value in row)

    def _sentences(self) -> Iterator[str]:
        cup = self.contact.model.cup
        joint = str(self._joint).encode("ascii", "replace").decode()
        yield f"ballsocket {__version__}: {joint}"
        yield f"Liner {cup.interface.value}, rim at {degrees(cup.rim):g} degrees, chamfer {cup.chamfer:g} mm."
        yield "Units N, mm, MPa. x is the distance from the load axis, y points up."
        yield (
            f"Clearance and indentation are multiplied by {self.scale:g}, for the limit of small displacements: "
            "divide forces, pressures and displacements by it. CalculiX prints a 180th of the force."
        )
        if self._joint.ball is not None:
            yield "The ball's modulus is multiplied by R2 over its radius here: it gives way like one of radius R2."
        yield "Contact is without friction; its penalty takes less than 0.1 % from the force."
        yield (
            f"{self.steps} steps push the ball (set PUSHED) down by equal parts. Expected of the real joint: "
            "step, indentation (mm), force (N), pressure at the pole (MPa), half angle (deg)."
        )

    def _meshes(self) -> Iterator[str]:
        yield "*NODE, NSET=ALL"
        for body in (self._socket, self._ball):
            yield from body.node_lines()
        for body in (self._socket, self._ball):
            yield from body.element_lines()
        yield from node_set("BORE", self._socket.surface()["node"])
        yield from node_set("ROUND", self._ball.surface()["node"])

    def _materials(self) -> Iterator[str]:
        for name, (young, poisson) in self._layers.items():
            yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12g}, {poisson:.12g}")
            yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"

    def _touching(self) -> Iterator[str]:
        """The surfaces go as far as a pressure was looked for, the ball's by an element farther."""
        reach = float(self._solved.pair.angle[-1])
        yield "*SURFACE, NAME=LINED, TYPE=ELEMENT"
        yield from (f"{element}, {_INSIDE}" for element in self._socket.touching(reach, strip=0))
        yield "*SURFACE, NAME=PRESSED, TYPE=ELEMENT"
        yield from (f"{element}, {_OUTSIDE}" for element in self._ball.touching(reach, strip=-1, more=1))
        yield from ("*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
        yield from (f"{self.slope:.6g}", "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "LINED, PRESSED")

    def _supports(self) -> Iterator[str]:
        """Lines that hold x and y where both or, on the axis, x is held; else radius and angle, which are 1 and 2."""
        socket, ball = self._socket, self._ball
        upright = [*socket.numbers(socket.on_axis & ~socket.fixed), *ball.numbers(ball.on_axis | ball.fixed)]
        seated, rolling = socket.held & ~socket.fixed & ~socket.on_axis
        yield from node_set("PUSHED", ball.numbers(ball.held[0] & (ball.fixed | ~ball.on_axis)))
        yield from self._polar(seated | rolling)
        for name, directions, nodes in (
            ("UPRIGHT", "1, 1", upright),
            ("FIXED", "1, 2", socket.numbers(socket.fixed)),
            ("SEATED", "2, 2", socket.numbers(seated)),
            ("ROLLING", "1, 1", socket.numbers(rolling)),
        ):
            yield from _held(name, directions, nodes)

    def _polar(self, held: Numbers) -> Iterator[str]:
        """Directions of the nodes that are held or slide, and what slides: the first direction is the radius."""
        socket = self._socket
        inner, outer = socket.sliding
        polar = held.copy()
        polar[inner] = polar[outer] = True
        numbers = socket.numbers(polar & ~socket.on_axis)
        if numbers:
            yield from node_set("POLAR", numbers)
            yield from ("*TRANSFORM, NSET=POLAR, TYPE=C", "0., 0., 0., 0., 0., 1.")
        if len(inner):
            yield "*EQUATION"
        for one, other in zip(inner, outer, strict=True):
            direction = 2 if socket.on_axis[one] else 1
            yield from ("2", f"{socket.number[one]}, {direction}, 1., {socket.number[other]}, {direction}, -1.")


def _held(name: str, directions: str, nodes: list[int]) -> Iterator[str]:
    if nodes:
        yield from node_set(name, nodes)
        yield from ("*BOUNDARY", f"{name}, {directions}")


def _step(height: float) -> Iterator[str]:
    yield from ("*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY", f"PUSHED, 2, 2, {height:.13g}")
    yield from ("*NODE PRINT, NSET=PUSHED, TOTALS=ONLY", "RF")
    for surface in ("BORE", "ROUND"):
        yield from (f"*NODE PRINT, NSET={surface}, GLOBAL=YES", "U")
    yield from ("*CONTACT FILE", "CDIS, CSTR", "*END STEP")
