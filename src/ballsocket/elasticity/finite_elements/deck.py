"""Input decks of one contact on its own mesh, so that other finite element programs can check the result.

x is the distance from the load axis, y points up. The ball is pushed down by its equator, which stays plane and can
expand. Elements are CAX4 or CAX8R, which has no middle node.

A contact with moving surfaces is not the linear problem of this package, but tends to it for small displacements. The
clearance and the indentation are therefore multiplied by a small scale, and the results are divided by it.

CalculiX reads the deck as it is. By its manual Abaqus differs in three points, which are not tested yet: it needs
`TOTALS=YES` for `TOTALS=ONLY` and `CDISP, CSTRESS` after *CONTACT FILE. Its forces are those of the full ring, where
CalculiX solves two degrees and prints a 180th of the force.

CalculiX's contact is inaccurate on CAX4, because it uses flat facets that touch along their edges only. With 20, 100
and 200 elements along the contact its force is 6 %, 0.7 % and 0.3 % too large, and its pressures are several times too
large. CAX8R has no such error.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import degrees, prod
from textwrap import wrap
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.checks import require
from ...core.display import ascii_text, finite_or_none
from ...problem.gaps import LinearGap, select_gap
from ...version import __version__
from .calculix import InputDeck, contact_lines, material_lines, node_set_lines, step_lines
from .deck_bodies import TYPES, DeckBodies, faceting_gap
from .model import MeshedContact

MAX_STEPS = 1000  # largest number of steps of a deck; the expected result of each is computed
_PENALTY_FACTOR = 2000.0
_MAX_FACETING_GAP = 2e-3  # over the indentation
_LINE_WIDTH = 100


def deck_of(contact: MeshedContact, *, steps: int = 8, scale: float = 1e-3) -> Deck:
    """Make the input deck of one contact.

    The gap between elements equals that between spheres if both bodies have their nodes at the same angles. They do
    unless the contact is wide and near a rim or chamfer, or the ball has its own spacing. Elsewhere the gap is only as
    accurate as the elements follow the sphere: parabolas do, chords do not.

    Parameters
    ----------
    contact : MeshedContact
        One contact under load, pressed by a `FiniteElement` with the linear gap.
    steps : int
        Number of equal increments up to the contact's indentation; 1 to `MAX_STEPS`.
    scale : float
        Factor on clearance and indentation, above 0 and at most 1. 1 is the real geometry, whose results include large
        displacements.

    Raises
    ------
    ValueError
        Several contacts, one without load or solution, a circular gap, surfaces that follow the sphere too coarsely, or
        a number outside its range.
    """
    if prod(contact.laws.shape) != 1:
        raise ValueError(f"a deck needs one contact, got an array of shape {contact.laws.shape}: press a single load")
    is_allowed = isinstance(steps, int) and 1 <= steps <= MAX_STEPS
    require("steps", steps, is_allowed, f"steps must be an integer from 1 to {MAX_STEPS}")
    require("scale", scale, 0 < scale <= 1, "a scale must be above 0 and at most 1")
    if select_gap(contact.model.gap, contact.joint) is not LinearGap:
        raise ValueError("a deck needs the linear gap: press with gap=LinearGap")
    gap = faceting_gap(contact._solved.pair) / (scale * contact._solved.indentation)
    if gap > _MAX_FACETING_GAP:
        raise ValueError(
            f"elements of ball and socket do not match, which leaves a gap of {gap:.1%} of the scaled indentation: "
            "use smaller ones, Element.BIQUADRATIC, or a larger scale"
        )
    return Deck(contact=contact, steps=steps, scale=scale)


@dataclass(frozen=True, kw_only=True, eq=False)
class Deck(InputDeck):
    """Input deck of one contact; see `deck_of`.

    `expected.json` has the joint, the scale, the element type and the expected results of the real joint under "steps":
    `indentation` in mm, `force` in N, `max_pressure` and `pole_pressure` in MPa, `half_angle_deg`; null for missing
    values. A liner that yields has `permanent_set` in mm too, and one more step that unloads it. The nodes of both
    surfaces are under "bore" and "round", with their angles in rad.

    Attributes
    ----------
    contact : MeshedContact
    steps : int
    scale : float
        Divisor for the forces (N), pressures (MPa) and displacements (mm) of the deck.
    """

    contact: MeshedContact
    steps: int
    scale: float

    def lines(self) -> Iterator[str]:
        """Yield the lines of the deck in ASCII."""
        bodies = self._bodies
        for sentence in self._description_sentences():
            yield from (f"** {line}" for line in wrap(sentence, _LINE_WIDTH))
        for number, row in enumerate(zip(*self.expected.values(), strict=True), 1):
            yield f"** {number:4d}" + "".join(f"{value:16.7g}" for value in row)
        yield "*NODE, NSET=ALL"
        for body in (bodies.socket, bodies.ball):
            yield from body.node_lines()
        for body in (bodies.socket, bodies.ball):
            yield from body.element_lines()
        yield from node_set_lines("BORE", bodies.socket.surface()["node"])
        yield from node_set_lines("ROUND", bodies.ball.surface()["node"])
        curve, hardening = self.contact.joint.liner.yield_curve, {}
        if self.contact.yields and curve:  # at scaled stresses and strains
            hardening = {"LINER": curve.scaled(self.scale, self.scale)}
        yield from material_lines(bodies.materials, hardening)
        lined = (f"{element}, {_INSIDE}" for element in bodies.socket.contact_elements(bodies.reach, strip=0))
        ball_elements = bodies.ball.contact_elements(bodies.reach, strip=-1, extra=1)  # one longer than the socket's
        pressed = (f"{element}, {_OUTSIDE}" for element in ball_elements)
        yield from contact_lines(lined, pressed, self.contact_penalty)
        yield from support_lines(bodies)
        for depth in self._indentations:
            yield from step_lines([(2, -self.scale * depth)], _STEP_OUTPUT)

    @cached_property
    def _bodies(self) -> DeckBodies:
        return DeckBodies(contact=self.contact, scale=self.scale)

    @property
    def element_count(self) -> int:
        """Number of elements of both bodies."""
        return sum(body.block.elements.shape[1] for body in (self._bodies.socket, self._bodies.ball))

    # --- expected results ---

    @cached_property
    def expected(self) -> dict[str, Numbers]:
        """Expected results at each step (steps,) by name, with indentation in mm, force in N, pressures in MPa."""
        model, joint, names = self.contact.model, self._bodies.joint, ["force", "max_pressure", "pole_pressure"]
        if self.contact.yields:
            names.append("permanent_set")
            joint = replace(joint, liner=self.contact.joint.liner)
        contact = model.press(joint, indentation=self._indentations)  # each on its own mesh, unlike by `follow`
        results = {name: getattr(contact, name) for name in names}
        if self.contact.yields:
            left = results["permanent_set"]
            results["permanent_set"] = numpy.append(left[:-1], left[-2])  # the last step unloads
        return {"indentation": self._indentations, **results, "half_angle_deg": numpy.degrees(contact.half_angle)}

    @property
    def contact_penalty(self) -> float:
        """Contact penalty in MPa/mm.

        The bodies overlap by pressure over slope. The slope is 2000 times the largest ratio of pressure to indentation,
        so the overlap is at most a 2000th of the indentation. The force error is about twice that; 0.05 % was measured.
        A ten times larger slope has a ten times smaller error, but larger oscillations of the nodal pressures.
        """
        pressed = self._indentations > 0
        pressure, indentation = (self.expected[name][pressed] for name in ("max_pressure", "indentation"))
        return _PENALTY_FACTOR * float(numpy.nanmax(pressure / indentation))

    @property
    def _indentations(self) -> Numbers:
        """Indentation in mm of each step; a liner that yields is unloaded in one more."""
        depths = float(self._bodies.solved.indentation) * numpy.arange(1, self.steps + 1) / self.steps
        return numpy.append(depths, 0.0) if self.contact.yields else depths

    def expected_record(self) -> dict[str, Any]:
        """Return the expected results for JSON; see the class."""
        rows = zip(*self.expected.values(), strict=True)
        steps = [{name: finite_or_none(value) for name, value in zip(self.expected, row, strict=True)} for row in rows]
        return {
            "ballsocket": __version__,
            "joint": self._bodies.joint.summary(),
            "scale": self.scale,
            "element": TYPES[self._bodies.solved.pair.resolution.order],
            "steps": steps,
            "bore": self._bodies.socket.surface(),
            "round": self._bodies.ball.surface(),
        }

    # --- comments at the top ---

    def _description_sentences(self) -> Iterator[str]:
        cup = self.contact.model.cup
        yield f"ballsocket {__version__}: {ascii_text(str(self._bodies.joint))}"
        yield f"Liner {cup.interface.value}, rim at {degrees(cup.rim):g} degrees, chamfer {cup.chamfer:g} mm."
        yield "Units N, mm, MPa. x is the distance from the load axis, y points up."
        yield (
            f"Clearance and indentation are multiplied by {self.scale:g}, for the limit of small displacements: "
            "divide forces, pressures and displacements by it. CalculiX prints a 180th of the force."
        )
        if self.contact.yields:
            yield "The liner yields, at stresses and strains that are multiplied likewise. The last step unloads it."
        if self._bodies.joint.ball is not None:
            yield "The ball's modulus is multiplied by R2 over its radius, for the compliance of a ball of radius R2."
        yield "Contact is without friction; its penalty reduces the force by less than 0.1 %."
        yield (
            f"{self.steps} steps push the ball (set PUSHED) down by equal increments. Expected of the real joint: "
            "step, indentation (mm), force (N), pressure at the pole (MPa), half angle (deg)."
        )


_INSIDE, _OUTSIDE = "S4", "S2"  # faces of elements

_STEP_OUTPUT = (
    *("*NODE PRINT, NSET=BORE, GLOBAL=YES", "U", "*NODE PRINT, NSET=ROUND, GLOBAL=YES", "U"),
    *("*CONTACT FILE", "CDIS, CSTR"),
)


def support_lines(bodies: DeckBodies) -> Iterator[str]:
    """Yield the lines of the supports of both bodies.

    They act along x and y on the axis and for fixed nodes of the ball, elsewhere along radius and angle.
    """
    socket, ball = bodies.socket, bodies.ball
    upright = socket.node_numbers(socket.axis_nodes & ~socket.fixed_nodes)
    upright += ball.node_numbers(ball.axis_nodes | ball.fixed_nodes)
    seated, rolling = socket.fixed_directions & ~socket.fixed_nodes & ~socket.axis_nodes
    pushed = ball.fixed_directions[0] & (ball.fixed_nodes | ~ball.axis_nodes)
    yield from node_set_lines("PUSHED", ball.node_numbers(pushed))
    inner, outer = socket.sliding
    polar = seated | rolling
    polar[inner] = polar[outer] = True
    numbers = socket.node_numbers(polar & ~socket.axis_nodes)
    if numbers:
        yield from node_set_lines("POLAR", numbers)
        yield from ("*TRANSFORM, NSET=POLAR, TYPE=C", "0., 0., 0., 0., 0., 1.")
    if len(inner):
        yield "*EQUATION"
    for first, second in zip(inner, outer, strict=True):
        direction = 2 if socket.axis_nodes[first] else 1
        yield from ("2", f"{socket.number[first]}, {direction}, 1., {socket.number[second]}, {direction}, -1.")
    for name, directions, nodes in (
        ("UPRIGHT", "1, 1", upright),
        ("FIXED", "1, 2", socket.node_numbers(socket.fixed_nodes)),
        ("SEATED", "2, 2", socket.node_numbers(seated)),
        ("ROLLING", "1, 1", socket.node_numbers(rolling)),
    ):
        if nodes:
            yield from node_set_lines(name, nodes)
            yield from ("*BOUNDARY", f"{name}, {directions}")
