"""CalculiX: input decks of axisymmetric and three-dimensional meshes, runs of them, and their results."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ...core.arrays import Numbers
from ...core.storage.atomic_files import make_folder, write_text
from ...problem.hardening import Hardening
from .deck_bodies import TYPES
from .pair_contact import edge_beyond

_NAME, _EXPECTED = "ballsocket", "expected.json"  # names of the deck, and of the file with the expected results
_NUMBERS_PER_LINE = 16


def deck_paths(out: Path) -> tuple[Path, Path]:
    """Return the paths of the deck and of its expected results, from a folder or from a file that ends in `.inp`.

    Examples
    --------
    >>> [path.as_posix() for path in (*deck_paths(Path("a")), *deck_paths(Path("a/hip.inp")))]
    ['a/ballsocket.inp', 'a/expected.json', 'a/hip.inp', 'a/hip_expected.json']
    """
    out = Path(out)
    if out.suffix.lower() == ".inp":
        return out, out.with_name(f"{out.stem}_{_EXPECTED}")
    return out / f"{_NAME}.inp", out / _EXPECTED


class InputDeck(ABC):
    """Input deck of one contact, with a file of its expected results."""

    @abstractmethod
    def lines(self) -> Iterator[str]:
        """Yield the lines of the deck in ASCII."""

    @abstractmethod
    def expected_record(self) -> dict[str, Any]:
        """Return the expected results for JSON, with what is needed to read the results of CalculiX."""

    def text(self) -> str:
        """Return the deck as ASCII text."""
        return "\n".join(self.lines()) + "\n"

    def write(self, out: Path) -> Path:
        """Write `ballsocket.inp` and `expected.json` into a new or existing folder; return the path of the former.

        A path that ends in `.inp` is the deck itself, with the results beside it: see `deck_paths`. Each file is
        written atomically: an interrupted write leaves none.

        Raises
        ------
        OSError
            The folder cannot be written to.
        """
        deck, expected = deck_paths(out)
        make_folder(deck.parent)
        write_text(expected, json.dumps(self.expected_record(), indent=1) + "\n", encoding="ascii")
        return write_text(deck, self.text(), encoding="ascii")


def node_set_lines(name: str, nodes: Iterable[int]) -> Iterator[str]:
    """Yield the lines of a named set of nodes."""
    yield f"*NSET, NSET={name}"
    numbers = [str(int(node)) for node in nodes]
    for start in range(0, len(numbers), _NUMBERS_PER_LINE):
        yield ", ".join(numbers[start : start + _NUMBERS_PER_LINE])


def material_lines(
    materials: Mapping[str, tuple[float, float]], hardening: Mapping[str, Hardening] = MappingProxyType({})
) -> Iterator[str]:
    """Yield the lines of a material, Young's modulus in MPa and Poisson's ratio, for each set of elements.

    `hardening` has the sets that yield.
    """
    for name, (young, poisson) in materials.items():
        yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12g}, {poisson:.12g}")
        if name in hardening:
            yield "*PLASTIC"
            curve = hardening[name]
            pairs = zip(curve.stress, curve.plastic_strain, strict=True)
            yield from (f"{stress:.12g}, {strain:.12g}" for stress, strain in pairs)
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"


def contact_lines(lined: Iterable[str], pressed: Iterable[str], penalty: float) -> Iterator[str]:
    """Yield the lines of a contact without friction between faces "element, face"; its penalty is in MPa/mm."""
    for name, faces in (("LINED", lined), ("PRESSED", pressed)):
        yield f"*SURFACE, NAME={name}, TYPE=ELEMENT"
        yield from faces
    yield from ("*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
    yield from (f"{penalty:.6g}", "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "LINED, PRESSED")


def step_lines(motions: Iterable[tuple[int, float]], output: Iterable[str] = ()) -> Iterator[str]:
    """Yield the lines of a load step that displaces the set PUSHED to (direction, mm), and print its reaction."""
    yield from ("*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY")
    yield from (f"PUSHED, {direction}, {direction}, {height:.13g}" for direction, height in motions)
    yield from ("*NODE PRINT, NSET=PUSHED, TOTALS=ONLY", "RF", *output, "*END STEP")


SECTORS = 180  # number of sectors in a ring: CalculiX solves two degrees of an axisymmetric element
_OUTPUT_LINES = 12  # of ccx's output in an error message
_OPEN_GAP = 3e-3  # over the indentation
_INNER_FRACTION = 0.67  # of the half angle
_SKIPPED_POLE_NODES = 10


@dataclass(frozen=True, kw_only=True, eq=False)
class CcxAnswer:
    """Results of CalculiX, scaled back to the real joint: one number per step (steps,), NaN for missing steps."""

    # values in mm, N, MPa and rad. Pressure and half angle are NaN on CAX4, whose facets CalculiX does not treat
    # as one surface.
    indentation: Numbers
    force: Numbers
    pole_pressure: Numbers
    half_angle: Numbers


def run(out: Path, *, threads: int = 1) -> CcxAnswer:
    """Run CalculiX on a deck, or the deck in a folder (see `deck_paths`), and read the results.

    CalculiX's files stay in the folder.

    Parameters
    ----------
    out : Path
    threads : int
        Number of threads of CalculiX.

    Raises
    ------
    FileNotFoundError
        The command `ccx` is not installed, or there is no deck in the folder.
    RuntimeError
        CalculiX failed before the end of the first step; the message has its last output. After a later failure the
        missing steps are NaN.
    """
    process = run_calculix(out, threads)
    answer = read_results(out)
    if numpy.isnan(answer.force).all():
        raise RuntimeError(f"ccx ended with {process.returncode} before the first step did: {last_output(process)}")
    return answer


def run_calculix(out: Path, threads: int) -> subprocess.CompletedProcess[str]:
    """Run CalculiX on a deck, or the deck in a folder, until it ends; the results of an earlier run are deleted.

    Raises FileNotFoundError: the command `ccx` is not installed, or there is no deck in the folder.
    """
    command = shutil.which("ccx")
    if command is None:
        raise FileNotFoundError("CalculiX is not installed: there is no command 'ccx'")
    deck, _ = deck_paths(out)
    if not deck.is_file():
        raise FileNotFoundError(f"there is no {deck.name} in {str(deck.parent)!r}")
    for suffix in (".dat", ".frd"):
        deck.with_suffix(suffix).unlink(missing_ok=True)  # a failed run must not return earlier results
    return subprocess.run(
        [command, "-i", deck.stem],
        cwd=deck.parent,
        env={**os.environ, "OMP_NUM_THREADS": str(threads)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )


def last_output(process: subprocess.CompletedProcess[str]) -> str:
    """Return the last lines of CalculiX's output, joined to one line."""
    return "; ".join([line.strip() for line in process.stdout.splitlines() if line.strip()][-_OUTPUT_LINES:])


def read_results(out: Path) -> CcxAnswer:
    """Read the results of CalculiX's last run of a deck."""
    path, expected = deck_paths(out)
    deck = json.loads(expected.read_text(encoding="ascii"))
    dat = path.with_suffix(".dat")
    forces, bore, ball = (read_printed(dat, name) for name in ("PUSHED", "BORE", "ROUND"))
    pressures = read_contact_pressures(path.with_suffix(".frd"))
    answer = CcxAnswer(**{field.name: numpy.full(len(deck["steps"]), numpy.nan) for field in fields(CcxAnswer)})
    angle = numpy.array(deck["bore"]["angle"])
    for step in forces.keys() & bore.keys() & ball.keys() & pressures.keys():
        indentation, gap = indentation_and_gap(deck, bore[step], ball[step])
        answer.indentation[step] = indentation
        answer.force[step] = -float(forces[step][0, 1]) * SECTORS / deck["scale"]
        if deck["element"] != TYPES[1] and indentation > 0:
            half_angle = edge_angle(angle, gap / indentation)
            nodal = numpy.array([pressures[step][node] for node in deck["bore"]["node"]]) / deck["scale"]
            answer.half_angle[step] = half_angle
            answer.pole_pressure[step] = pressure_at_pole(angle, nodal, half_angle)
    return answer


def indentation_and_gap(deck: dict[str, Any], bore: Numbers, ball: Numbers) -> tuple[float, Numbers]:
    """Compute the indentation in mm, and the gaps in mm between the bore's nodes and the ball, from printed rows."""
    angle, ball_moved = numpy.array(deck["bore"]["angle"]), _surface_displacements(deck, "round", ball)
    ball_at_bore = [numpy.interp(angle, deck["round"]["angle"], component) for component in ball_moved]
    opening = deck["joint"]["clearance"] * 2 * numpy.sin(angle / 2) ** 2
    equator = ball_moved[1, -1]
    return -float(equator), _outward(angle, _surface_displacements(deck, "bore", bore) - ball_at_bore) + opening


def _surface_displacements(deck: dict[str, Any], surface: str, rows: Numbers) -> Numbers:
    """Return displacements in mm across and along the axis of a surface's nodes, from the pole on: (2, nodes)."""
    rows_by_node = {int(node): row for row, node in enumerate(rows[:, 0])}
    return rows[[rows_by_node[node] for node in deck[surface]["node"]], 1:3].T / deck["scale"]


def _outward(angle: Numbers, displacements: Numbers) -> Numbers:
    across, up = displacements
    return across * numpy.sin(angle) - up * numpy.cos(angle)


def bore_displacements(out: Path) -> dict[int, Numbers]:
    """Read the outward displacements in mm of the bore's nodes at the end of each step (from 0), from the pole on.

    After the last step of a liner that yields they are its permanent set. CalculiX's are wrong at the nodes next to the
    pole, see `pressure_at_pole`.
    """
    path, expected = deck_paths(out)
    deck = json.loads(expected.read_text(encoding="ascii"))
    angle, printed = numpy.array(deck["bore"]["angle"]), read_printed(path.with_suffix(".dat"), "BORE")
    return {step: _outward(angle, _surface_displacements(deck, "bore", rows)) for step, rows in printed.items()}


def edge_angle(angle: Numbers, gap: Numbers) -> float:
    """Compute the half angle in rad from gaps at angles (rad), as fractions of the indentation.

    Without any gap it is the last angle.

    Beyond the edge a gap opens like (φ - ε)^(3/2): its power 2/3 is extrapolated to zero, by a parabola through a few
    nodes. Nodal pressures are smeared over two elements there: p² extrapolated was off by 1.5 degrees in the mean on
    meshes with 16 to 48 elements along the contact, where this was off by 0.03.
    """
    return edge_beyond(int(numpy.flatnonzero(gap < _OPEN_GAP)[-1]), angle, gap)


def pressure_at_pole(angle: Numbers, pressures: Numbers, half_angle: float) -> float:
    """Extrapolate the pressure at the pole in MPa from the inner two thirds of the nodes.

    The polynomial is a + b φ² + c φ⁴. The nodes next to the pole are omitted: their pressures are wrong by a factor.
    """
    inside = int(numpy.count_nonzero(angle < _INNER_FRACTION * half_angle))
    nodes = slice(min(_SKIPPED_POLE_NODES, inside // 2), inside)
    degree = min(2, max((nodes.stop - nodes.start) // 4, 1))
    return float(numpy.polynomial.Polynomial.fit(angle[nodes] ** 2, pressures[nodes], degree)(0.0))


def read_printed(dat: Path, name: str) -> dict[int, Numbers]:
    """Read the rows of a set of nodes at the end of each step (from 0) from a .dat file.

    Fortran omits the letter of an exponent of three digits: 1.0608-172.
    """
    return {
        step: numpy.array(
            [re.sub(r"(\d)(-\d{3})\b", r"\1E\2", row).split() for row in table.splitlines() if row.strip()], dtype=float
        )
        for step, table in _split_by_step(dat, rf"^ .* for set (?:{name} and time +(\S+)|.*)$").items()
    }


def read_contact_pressures(frd: Path) -> dict[int, dict[int, float]]:
    """Read the contact pressures by node at the end of each step (from 0) from a .frd file."""
    return {
        step: {int(row[3:13]): float(row[49:61]) for row in table.splitlines() if row.startswith(" -1")}
        for step, table in _split_by_step(frd, r"^ +100CL +\d+ +(\S+).*\n -4  CONTACT.*$").items()
    }


def _split_by_step(path: Path, head: str) -> dict[int, str]:
    """Split a file at its headers; return the text after each header, by the index of the load step.

    A header without a time ends the previous text. A step may end in a second increment of zero length at nearly the
    same time: the later one counts.
    """
    pieces = re.split(head, path.read_text(encoding="ascii"), flags=re.MULTILINE) if path.is_file() else []
    blocks = {}
    for time, table in zip(pieces[1::2], pieces[2::2], strict=True):
        step = round(float(time or 0))
        if step > 0 and abs(float(time) - step) < 1e-4:
            blocks[step - 1] = table
    return blocks
