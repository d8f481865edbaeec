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

from ....core.arrays import Numbers
from ....core.checks import require
from ....core.storage.atomic_files import write_text
from ....problem.gaps import LinearGap
from ....version import __version__
from ..contact import MeshedContact
from .bodies import Bodies, false_gap
from .lines import contact_lines, material_lines, mesh_lines, step_lines, support_lines
from .solid import TYPES

NAME, EXPECTED = "ballsocket", "expected.json"
"""Names of the deck, as CalculiX wants it, and of the file beside it."""

MOST_STEPS = 1000
"""Steps of a deck; our own answer to each is computed and written beside it."""

_STIFFER = 2000.0
_FALSE = 2e-3  # of the indentation
_WIDTH = 100


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
        Equal indentations up to the contact's own, one step each; 1 to `MOST_STEPS`.
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
    good = isinstance(steps, int) and 1 <= steps <= MOST_STEPS
    require("steps", steps, good, f"a deck has a whole number of steps, 1 to {MOST_STEPS}")
    require("scale", scale, 0 < scale <= 1, "a scale lies above 0 and is at most 1")
    if contact.model.gap is not LinearGap:
        raise ValueError("a deck tends to the linear gap: press with gap=LinearGap")
    room = false_gap(contact._solved.pair) / (scale * contact._solved.indentation)
    if room > _FALSE:
        raise ValueError(
            f"elements of ball and socket do not match, which leaves a gap of {room:.1%} of the scaled indentation: "
            "take smaller ones, Element.BIQUADRATIC, or a larger scale"
        )
    return Deck(contact=contact, steps=steps, scale=scale)


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
        bodies = self._bodies
        lines = [*self._title(), *mesh_lines(bodies), *material_lines(bodies)]
        lines += [*contact_lines(bodies, self.slope), *support_lines(bodies)]
        for depth in self._depths:
            lines += step_lines(-self.scale * depth)
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

    @cached_property
    def _bodies(self) -> Bodies:
        return Bodies(contact=self.contact, scale=self.scale)

    # --- what is expected ---

    @cached_property
    def expected(self) -> dict[str, Numbers]:
        """Our own answer at each step (steps,), by name, with indentation in mm, force in N, pressures in MPa."""
        answer = self.contact.model.press(self._bodies.joint, indentation=self._depths)
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
        return float(self._bodies.solved.indentation) * numpy.arange(1, self.steps + 1) / self.steps

    def _rows(self) -> list[list[float]]:
        return numpy.stack(list(self.expected.values()), axis=-1).tolist()

    def _record(self) -> dict[str, Any]:
        return {
            "ballsocket": __version__,
            "joint": self._bodies.joint.summary(),
            "scale": self.scale,
            "element": TYPES[self._bodies.solved.pair.resolution.order],
            "steps": [
                {name: None if numpy.isnan(value) else value for name, value in zip(self.expected, row, strict=True)}
                for row in self._rows()
            ],
            "bore": self._bodies.socket.surface(),
            "round": self._bodies.ball.surface(),
        }

    # --- what is said on top ---

    def _title(self) -> Iterator[str]:
        for sentence in self._sentences():
            yield from (f"** {line}" for line in wrap(sentence, _WIDTH))
        for number, row in enumerate(self._rows(), 1):
            yield f"** {number:4d}" + "".join(f"{value:16.7g}" for value in row)

    def _sentences(self) -> Iterator[str]:
        cup = self.contact.model.cup
        joint = str(self._bodies.joint).encode("ascii", "replace").decode()
        yield f"ballsocket {__version__}: {joint}"
        yield f"Liner {cup.interface.value}, rim at {degrees(cup.rim):g} degrees, chamfer {cup.chamfer:g} mm."
        yield "Units N, mm, MPa. x is the distance from the load axis, y points up."
        yield (
            f"Clearance and indentation are multiplied by {self.scale:g}, for the limit of small displacements: "
            "divide forces, pressures and displacements by it. CalculiX prints a 180th of the force."
        )
        if self._bodies.joint.ball is not None:
            yield "The ball's modulus is multiplied by R2 over its radius here: it gives way like one of radius R2."
        yield "Contact is without friction; its penalty takes less than 0.1 % from the force."
        yield (
            f"{self.steps} steps push the ball (set PUSHED) down by equal parts. Expected of the real joint: "
            "step, indentation (mm), force (N), pressure at the pole (MPa), half angle (deg)."
        )
