"""Size of a mesh and its memory, before it is built."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import log2
from typing import Any

from ...problem import Joint
from ...problem.cup import Cup
from .shapes import Resolution, ball_corners, socket_shape

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

    needed, free = bytes_needed(size.largest, order), psutil.virtual_memory().available
    if needed > free:
        raise ValueError(
            f"a mesh of {size.elements} elements needs about {needed / _GIB:.2g} GiB of memory, and "
            f"{free / _GIB:.2g} GiB are free: use larger elements"
        )


def bytes_needed(nodes: int, order: int) -> float:
    """Estimate the peak memory in bytes of one body, from both matrix factors and the element matrices."""
    factors = 2 * 12 * 8 * 2 * nodes * log2(max(nodes, 2))
    return factors + 1000 * nodes * order
