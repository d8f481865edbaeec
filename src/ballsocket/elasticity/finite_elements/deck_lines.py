"""Lines of an input deck for CalculiX, the same for axisymmetric and three-dimensional meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

_NUMBERS_PER_LINE = 16


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
