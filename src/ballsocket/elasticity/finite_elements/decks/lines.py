"""The lines of a deck: meshes, materials, what touches, what is held, and the steps."""

from __future__ import annotations

from collections.abc import Iterator

from ....core.arrays import Numbers
from .bodies import Bodies
from .solid import Solid, node_set

_INSIDE, _OUTSIDE = "S4", "S2"  # faces of elements


def mesh_lines(bodies: Bodies) -> Iterator[str]:
    """Nodes and elements of both bodies, and the sets of nodes that may touch."""
    yield "*NODE, NSET=ALL"
    for body in (bodies.socket, bodies.ball):
        yield from body.node_lines()
    for body in (bodies.socket, bodies.ball):
        yield from body.element_lines()
    yield from node_set("BORE", bodies.socket.surface()["node"])
    yield from node_set("ROUND", bodies.ball.surface()["node"])


def material_lines(bodies: Bodies) -> Iterator[str]:
    """A material for each set of elements."""
    for name, (young, poisson) in bodies.materials.items():
        yield from (f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12g}, {poisson:.12g}")
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"


def contact_lines(bodies: Bodies, slope: float) -> Iterator[str]:
    """What touches: the surfaces go as far as a pressure was looked for, the ball's by an element farther."""
    yield "*SURFACE, NAME=LINED, TYPE=ELEMENT"
    yield from (f"{element}, {_INSIDE}" for element in bodies.socket.touching(bodies.reach, strip=0))
    yield "*SURFACE, NAME=PRESSED, TYPE=ELEMENT"
    yield from (f"{element}, {_OUTSIDE}" for element in bodies.ball.touching(bodies.reach, strip=-1, more=1))
    yield from ("*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR")
    yield from (f"{slope:.6g}", "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "LINED, PRESSED")


def support_lines(bodies: Bodies) -> Iterator[str]:
    """What is held: x and y where both or, on the axis, x is held; else radius and angle, which are 1 and 2."""
    socket, ball = bodies.socket, bodies.ball
    upright = [*socket.numbers(socket.on_axis & ~socket.fixed), *ball.numbers(ball.on_axis | ball.fixed)]
    seated, rolling = socket.held & ~socket.fixed & ~socket.on_axis
    yield from node_set("PUSHED", ball.numbers(ball.held[0] & (ball.fixed | ~ball.on_axis)))
    yield from _polar(socket, seated | rolling)
    for name, directions, nodes in (
        ("UPRIGHT", "1, 1", upright),
        ("FIXED", "1, 2", socket.numbers(socket.fixed)),
        ("SEATED", "2, 2", socket.numbers(seated)),
        ("ROLLING", "1, 1", socket.numbers(rolling)),
    ):
        yield from _held(name, directions, nodes)


def _polar(socket: Solid, held: Numbers) -> Iterator[str]:
    """Directions of the nodes that are held or slide, and what slides: the first direction is the radius."""
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


def step_lines(height: float) -> Iterator[str]:
    """One step, which pushes the ball to a height (mm, negative is down), and what is printed of it."""
    yield from ("*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY", f"PUSHED, 2, 2, {height:.13g}")
    yield from ("*NODE PRINT, NSET=PUSHED, TOTALS=ONLY", "RF")
    for surface in ("BORE", "ROUND"):
        yield from (f"*NODE PRINT, NSET={surface}, GLOBAL=YES", "U")
    yield from ("*CONTACT FILE", "CDIS, CSTR", "*END STEP")
