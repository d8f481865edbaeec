"""CalculiX on a deck of `deck.py`: its run, and what it answers."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy

from ....core.arrays import Numbers
from .deck import EXPECTED, NAME

SECTORS = 180
"""An axisymmetric element is calculated as two degrees of a ring."""

_LINES = 12  # of ccx's words, when it fails
_OPEN, _BEYOND, _NODES = 3e-3, 2, 5  # of the indentation; nodes that are left out, and those that count
_INNER, _WITHOUT = 0.67, 10  # of the half angle; nodes next to the pole that are left out


@dataclass(frozen=True, kw_only=True, eq=False)
class CcxAnswer:
    """What CalculiX found, scaled back to the real joint: one number a step (steps,), NaN where it did not get.

    Attributes
    ----------
    indentation, force, pole_pressure, half_angle : array
        In mm, N, MPa and rad. Pressure and half angle are NaN on CAX4, whose facets CalculiX' contact cannot see as one
        surface.
    """

    indentation: Numbers
    force: Numbers
    pole_pressure: Numbers
    half_angle: Numbers


def run(folder: Path, *, threads: int = 1) -> CcxAnswer:
    """Run CalculiX on the deck in a folder (see `Deck.write`), which keeps its files, and read its answer.

    Parameters
    ----------
    folder : Path
    threads : int
        That CalculiX may use.

    Raises
    ------
    FileNotFoundError
        The command `ccx` is not installed, or there is no deck in the folder.
    RuntimeError
        CalculiX failed before the end of the first step; with its last words. Where it fails later, the steps that it
        did not reach are NaN.
    """
    folder = Path(folder)
    done = run_calculix(folder, threads)
    answer = read(folder)
    if numpy.isnan(answer.force).all():
        raise RuntimeError(f"ccx ended with {done.returncode} before the first step did: {last_output(done)}")
    return answer


def run_calculix(folder: Path, threads: int) -> subprocess.CompletedProcess[str]:
    """CalculiX, ended, on the deck in a folder; what an earlier run left there is gone.

    Raises
    ------
    FileNotFoundError
        The command `ccx` is not installed, or there is no deck in the folder.
    """
    command = shutil.which("ccx")
    if command is None:
        raise FileNotFoundError("CalculiX is not installed: there is no command 'ccx'")
    if not (folder / f"{NAME}.inp").is_file():
        raise FileNotFoundError(f"there is no {NAME}.inp in {str(folder)!r}")
    for suffix in ("dat", "frd"):
        (folder / f"{NAME}.{suffix}").unlink(missing_ok=True)  # or a failure would hand out an older answer
    return subprocess.run(
        [command, "-i", NAME],
        cwd=folder,
        env={**os.environ, "OMP_NUM_THREADS": str(threads)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )


def last_output(done: subprocess.CompletedProcess[str]) -> str:
    """What CalculiX said in the end, in a line."""
    return "; ".join([line.strip() for line in done.stdout.splitlines() if line.strip()][-_LINES:])


def read(folder: Path) -> CcxAnswer:
    """The answer of the last run in a folder."""
    deck = json.loads((folder / EXPECTED).read_text(encoding="ascii"))
    dat = folder / f"{NAME}.dat"
    forces, bore, ball = read_printed(dat, "PUSHED"), read_printed(dat, "BORE"), read_printed(dat, "ROUND")
    pressures = read_contact_pressures(folder / f"{NAME}.frd")
    answer = CcxAnswer(**{field.name: numpy.full(len(deck["steps"]), numpy.nan) for field in fields(CcxAnswer)})
    for step in forces.keys() & bore.keys() & ball.keys() & pressures.keys():
        surfaces = _Surfaces(deck=deck, bore=bore[step], ball=ball[step], pressures=pressures[step])
        answer.indentation[step] = surfaces.indentation
        answer.force[step] = -float(forces[step][0, 1]) * SECTORS / deck["scale"]
        if deck["element"] != "CAX4":
            answer.half_angle[step] = surfaces.half_angle
            answer.pole_pressure[step] = surfaces.pole_pressure
    return answer


@dataclass(frozen=True, kw_only=True, eq=False)
class _Surfaces:
    """What happened to both surfaces in one step: rows of a node and its displacements, and pressures by node."""

    deck: dict[str, Any]
    bore: Numbers
    ball: Numbers
    pressures: dict[int, float]

    @property
    def _angle(self) -> Numbers:
        """Polar angles of the bore's nodes in rad, from the pole on."""
        return numpy.array(self.deck["bore"]["angle"])

    def _moved(self, name: str, rows: Numbers) -> Numbers:
        """Displacements across the axis and along it in mm, shape (2, nodes), of nodes from the pole on."""
        places = {int(node): place for place, node in enumerate(rows[:, 0])}
        return rows[[places[node] for node in self.deck[name]["node"]], 1:3].T / self.deck["scale"]

    @property
    def indentation(self) -> float:
        """Indentation in mm: how far the ball's end, its equator, has moved."""
        return -float(self._moved("round", self.ball)[1, -1])

    @property
    def gap(self) -> Numbers:
        """Between the bore's nodes and the ball, in mm."""
        angle, clearance = self._angle, self.deck["joint"]["clearance"]
        ball = [numpy.interp(angle, self.deck["round"]["angle"], moved) for moved in self._moved("round", self.ball)]
        across, up = self._moved("bore", self.bore) - ball
        return across * numpy.sin(angle) - up * numpy.cos(angle) + clearance * 2 * numpy.sin(angle / 2) ** 2

    @property
    def half_angle(self) -> float:
        return edge(self._angle, self.gap / self.indentation)

    @property
    def pole_pressure(self) -> float:
        pressures = numpy.array([self.pressures[node] for node in self.deck["bore"]["node"]])
        return pole(self._angle, pressures / self.deck["scale"], self.half_angle)


def edge(angle: Numbers, gap: Numbers) -> float:
    """The half angle from the gap over the indentation, at angles (rad) from the pole on; without a gap the last one.

    Beyond the edge a gap opens like (φ - ε)^(3/2): its power 2/3 is extrapolated to zero, by a parabola through a few
    nodes. Nodal pressures are smeared over two elements there: p² extrapolated was off by 1.5 degrees in the mean on
    meshes with 16 to 48 elements along the contact, where this was off by 0.03.
    """
    last = int(numpy.flatnonzero(gap < _OPEN)[-1])
    nodes = numpy.arange(last + 1, len(angle))
    if len(nodes) == 0:
        return float(angle[-1])
    nodes = nodes[_BEYOND if len(nodes) > _BEYOND + 2 else 0 :][:_NODES]
    opening = gap[nodes] ** (2 / 3)
    return float(numpy.polynomial.Polynomial.fit(opening, angle[nodes], min(2, len(nodes) - 1))(0.0))


def pole(angle: Numbers, pressures: Numbers, half_angle: float) -> float:
    """The pressure at the pole from those at nodes, even around it: a + b φ² + c φ⁴ through the inner two thirds.

    Without the nodes next to the pole, whose pressures are off by a factor.
    """
    inside = int(numpy.count_nonzero(angle < _INNER * half_angle))
    near = slice(min(_WITHOUT, inside // 2), inside)
    degree = min(2, max((near.stop - near.start) // 4, 1))
    return float(numpy.polynomial.Polynomial.fit(angle[near] ** 2, pressures[near], degree)(0.0))


def read_printed(dat: Path, name: str) -> dict[int, Numbers]:
    """The rows of numbers that a .dat file has of a set of nodes at the end of each step, the first of which is 0."""
    return {
        step: numpy.array([row.split() for row in table.splitlines() if row.strip()], dtype=float)
        for step, table in _blocks(dat, rf"^ .* for set (?:{name} and time +(\S+)|.*)$").items()
    }


def read_contact_pressures(frd: Path) -> dict[int, dict[int, float]]:
    """The contact pressures that a .frd file has at the end of each step, the first of which is 0, by node."""
    return {
        step: {int(row[3:13]): float(row[49:61]) for row in table.splitlines() if row.startswith(" -1")}
        for step, table in _blocks(frd, r"^ +100CL +\d+ +(\S+).*\n -4  CONTACT.*$").items()
    }


def _blocks(path: Path, head: str) -> dict[int, str]:
    """Text after each headline, by the step that its time says; headlines without a time only end what is before.

    A step may end in a second increment of no length, at nearly the same time: the later one is meant.
    """
    parts = re.split(head, path.read_text(encoding="ascii"), flags=re.MULTILINE) if path.is_file() else []
    found = {}
    for time, table in zip(parts[1::2], parts[2::2], strict=True):
        step = round(float(time or 0))
        if step > 0 and abs(float(time) - step) < 1e-4:
            found[step - 1] = table
    return found
