"""Input decks for CalculiX: what is the same for axisymmetric and three-dimensional meshes."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ...core.storage.atomic_files import make_folder, write_text

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


def material_lines(materials: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    """Yield the lines of a material, Young's modulus in MPa and Poisson's ratio, for each set of elements."""
    for name, (young, poisson) in materials.items():
        yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12g}, {poisson:.12g}")
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
