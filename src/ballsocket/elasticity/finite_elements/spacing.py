"""Element types, element sizes of ball and socket, and the size and memory of a mesh before it is built."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import Enum
from math import inf, log2, pi
from typing import Any

from ...core.arrays import is_plain_number
from ...core.checks import check_numeric, require, shown
from ...problem import Joint
from ...problem.cup import Cup
from .mesh import Resolution, ball_corners, socket_shape

_CLASS_COUNT = 24
_CLASS_RATIO = 2**-0.5  # of a class's narrowest contact to its widest
_DEFAULT_ELEMENTS = 60
_MIN_ELEMENTS = 12  # in the narrowest contact of a uniform mesh
_REACH_FACTOR = 1.2  # of a class's widest contact: extent of its small elements


class Element(Enum):
    """Type of quadrilateral elements, by the degree of their displacements; neither locks near ν = ½."""

    BILINEAR = 1
    BIQUADRATIC = 2


@dataclass(frozen=True, kw_only=True)
class Adapted:
    """Elements adapted to the width of the contact, larger away from it.

    Contacts are sorted into classes, each 0.7 times as wide as the previous one and with its own mesh. A contact
    therefore spans between 0.7 times `elements` and `elements`, or more for a thin liner: an element is at most a
    quarter of the liner thickness.

    Parameters
    ----------
    elements : int
        Number of elements along the widest contact of each class, from the pole to its edge; an even number from 24 on.
        Default 60.
    growth : float
        Ratio of the lengths of successive elements of the coarse mesh away from the contact, 1 to 2. It applies to 60
        elements; more elements grow more slowly.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    elements: int = _DEFAULT_ELEMENTS
    growth: float = 1.3

    def __post_init__(self) -> None:
        valid = isinstance(self.elements, int) and self.elements >= 24 and self.elements % 2 == 0
        require("elements", self.elements, valid, "the number of elements along a contact must be even and at least 24")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """Compute the limits of the classes of contacts: half angles in rad, descending."""
        return tuple(reach * _CLASS_RATIO**number for number in range(_CLASS_COUNT + 1))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """Compute the element sizes of the coarse mesh of a class; the fine mesh halves them."""
        scale = _DEFAULT_ELEMENTS / self.elements
        return Resolution(
            size=min(2 * widest / self.elements, scale * thickness / (2 * radius)),
            reach=_REACH_FACTOR * widest,
            growth=self.growth**scale,
            widest=scale * pi / 12,
            deepest=min(scale / 3, 0.5),
            order=order,
        )


@dataclass(frozen=True, kw_only=True)
class Uniform:
    """Elements of one size along both surfaces, independent of the contact.

    Parameters
    ----------
    size : float
        Element size in mm. Heß & Forsbach (2021) used 0.05 mm.
    growth : float
        Ratio of the depths of successive elements of the coarse mesh away from the contact, 1 to 2.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    size: float
    growth: float = 1.03

    def __post_init__(self) -> None:
        if not is_plain_number(check_numeric("size", self.size)):
            raise TypeError(f"size must be one number, got {shown(self.size)}")
        require("size", self.size, 0 < self.size < inf, "an element size (mm) must be above 0 and finite")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """Compute the limits of the single class of contacts: half angles in rad, descending."""
        return (reach, min(_MIN_ELEMENTS * self.size / radius, reach / 2))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """Compute the element sizes of the coarse mesh; the fine mesh halves them."""
        size = 2 * self.size / radius
        return Resolution(size=size, reach=inf, growth=self.growth, widest=size, deepest=1 / 3, order=order)


def _check_growth(growth: float) -> None:
    require("growth", growth, 1 <= growth <= 2, "growth must lie between 1 and 2")


Spacing = Adapted | Uniform
SPACINGS = (Adapted, Uniform)


_GIB = 2**30


@dataclass(frozen=True, kw_only=True)
class MeshSize:
    """Size of the meshes of both bodies.

    Attributes
    ----------
    elements, nodes : int
        Number of elements and of nodes in both bodies.
    largest : int
        Number of nodes of the larger body.
    element_size : float
        Element size along the contact in mm.
    """

    elements: int
    nodes: int
    largest: int
    element_size: float

    def summary(self) -> dict[str, Any]:
        """Return the sizes as a dictionary for JSON."""
        return asdict(self)


def mesh_size(joint: Joint, cup: Cup, resolution: Resolution, ball_resolution: Resolution) -> MeshSize:
    """Compute the size of a joint's meshes without building them."""
    angle, radii = socket_shape(joint, cup).corners(resolution)
    counts = [(len(angle) - 1, sum(layer.shape[-1] - 1 for layer in radii))]
    if joint.ball is not None:
        angles, across = ball_corners(ball_resolution)
        counts.append((len(angles) - 1, len(across) - 1))
    order = resolution.order
    nodes = [(order * along + 1) * (order * deep + 1) for along, deep in counts]
    return MeshSize(
        elements=sum(along * deep for along, deep in counts),
        nodes=sum(nodes),
        largest=max(nodes),
        element_size=float(angle[1]) * float(joint.socket_radius),
    )


def check_memory(size: MeshSize, order: int) -> None:
    """Raise ValueError for a mesh that does not fit into the free memory."""
    import psutil

    nodes, free = size.largest, psutil.virtual_memory().available
    needed = 2 * 12 * 8 * 2 * nodes * log2(max(nodes, 2)) + 1000 * nodes * order  # matrix factors, element matrices
    if needed > free:
        raise ValueError(
            f"a mesh of {size.elements} elements needs about {needed / _GIB:.2g} GiB of memory, and "
            f"{free / _GIB:.2g} GiB are free: use larger elements"
        )
