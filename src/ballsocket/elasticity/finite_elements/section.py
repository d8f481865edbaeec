"""The inside of ball and socket under one contact: displacements and stresses at the nodes of the meshes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy

from ...core.arrays import Numbers
from ...core.stress import Peak, Stress
from ...problem import Joint
from ...problem.cup import Cup
from .bodies import ball_body, socket_body
from .condensation import CondensedBody
from .elasticity import shape_functions
from .shapes import socket_shape
from .tangent import Solved

_CORNER = 0.25  # of the liner's thickness, or of the socket's radius where that is less


@dataclass(frozen=True, kw_only=True, eq=False)
class Part:
    """One layer of the socket, or the ball, with its mesh.

    Attributes
    ----------
    name : str
        "liner", "backing 1" and so on outwards, "ball".
    angle, radius : array (nodes,)
        Polar angle in rad from the load axis, distance in mm from the part's centre.
    place : array (2, nodes)
        In mm: distance from the load axis, and height above the centre of the socket. The ball is drawn where it first
        touches; the load pushes it down.
    elements : array (4 or 9, elements)
        Nodes: corners, then edges and middle.
    displacement : array (2, nodes)
        In mm, in the directions of `place`.
    stress : Stress
        At the nodes, averaged over the part's elements around each.
    """

    name: str
    angle: Numbers
    radius: Numbers
    place: Numbers
    elements: Numbers
    displacement: Numbers
    stress: Stress


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """Everything that deforms; a rigid ball is no part of it. `section["liner"]` is one of its `parts`.

    Attributes
    ----------
    parts : tuple of Part
    socket_radius : float
        R2 in mm.
    """

    parts: tuple[Part, ...]
    socket_radius: float

    def __getitem__(self, name: str) -> Part:
        found = {part.name: part for part in self.parts}
        if name not in found:
            raise KeyError(f"part {name!r} is not known; there are {', '.join(found)}")
        return found[name]

    @cached_property
    def peak_stress(self) -> Peak:
        """The largest von Mises stress (MPa) in the liner, its depth below the bore (mm) and polar angle (rad).

        The corners of its rim are left out, where elasticity knows no bound.
        """
        liner = self["liner"]
        corner = numpy.isclose(liner.angle, liner.angle.max())
        corners = liner.place[:, [numpy.flatnonzero(corner)[i] for i in (0, -1)]]
        away = numpy.min(numpy.hypot(*(liner.place[..., None] - corners[:, None])), axis=-1)
        size = min(liner.radius.max() - liner.radius.min(), liner.radius.min())  # a massive socket has no thickness
        at = int(numpy.argmax(numpy.where(away > _CORNER * size, liner.stress.von_mises, 0.0)))
        return Peak(
            von_mises=float(liner.stress.von_mises[at]),
            depth=float(liner.radius[at]) - self.socket_radius,
            angle=float(liner.angle[at]),
        )

    @cached_property
    def rim_displacement(self) -> tuple[float, float]:
        """Displacement of the bore's end in mm, away from the load axis and up against the load."""
        liner = self["liner"]
        end = numpy.flatnonzero(liner.angle > liner.angle.max() - 1e-12)
        across, up = liner.displacement[:, end[numpy.argmin(liner.radius[end])]]
        return float(across), float(up)


def section(joint: Joint, cup: Cup, solved: Solved) -> Section:
    """The inside of one solved contact of a joint of plain numbers."""
    pair, R2 = solved.pair, float(joint.socket_radius)
    names = ("liner", *(f"backing {number}" for number in range(1, len(joint.backing) + 1)))
    socket = _Loaded(
        body=socket_body(socket_shape(joint, cup), pair.resolution),
        radius=R2,
        pressed=R2,
        young=float(joint.liner.young),
        forces=solved.forces(0),
        lift=0.0,
        drop=0.0,
    )
    parts = list(socket.parts(names))
    if joint.ball is not None:
        ball = _Loaded(
            body=ball_body(float(joint.ball.poisson), pair.ball_resolution),
            radius=float(joint.ball_radius),
            pressed=R2,
            young=float(joint.ball.young),
            forces=-solved.forces(1),
            lift=-float(joint.clearance),
            drop=solved.indentation,
        )
        parts += ball.parts(("ball",))
    return Section(parts=tuple(parts), socket_radius=R2)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Loaded:
    """A body of unit size with its real stiffness and load, on a patch of the radius `pressed`.

    `radius` is that of its picture, which `lift` moves; `drop` moves all of it.
    """

    body: CondensedBody
    radius: float
    pressed: float
    young: float
    forces: Numbers
    lift: float
    drop: float

    @cached_property
    def _moved(self) -> Numbers:
        """u_φ and u_r of the nodes over the radius, shape (nodes, 2)."""
        return self.body.displacements(self.forces / (self.young * self.pressed**2))

    def parts(self, names: tuple[str, ...]) -> Iterator[Part]:
        """The layers, from the inside out."""
        block = self.body.elastic.block
        phi = numpy.repeat(block.angle, block.radius.shape[1])
        u_phi, u_r = self.pressed * self._moved.T
        sine, cosine = numpy.sin(phi), numpy.cos(phi)
        moved = numpy.stack([u_phi * cosine + u_r * sine, u_phi * sine - u_r * cosine - self.drop])
        across, below = self.radius * block.nodes
        for index, name in enumerate(names):
            elements = block.elements[:, block.layers == index]
            nodes, own = numpy.unique(elements, return_inverse=True)
            yield Part(
                name=name,
                angle=phi[nodes],
                radius=self.radius * block.radius.ravel()[nodes],
                place=numpy.stack([across, self.lift - below])[:, nodes],
                elements=own.reshape(elements.shape),
                displacement=moved[:, nodes],
                stress=self._stress(index, own.reshape(elements.shape), len(nodes)),
            )

    def _stress(self, layer: int, elements: Numbers, nodes: int) -> Stress:
        """Stresses of a layer: those of its elements, carried to their nodes and averaged there."""
        components = self._at_nodes(layer)
        total, count = numpy.zeros((4, nodes)), numpy.zeros(nodes)
        numpy.add.at(count, elements.T, 1.0)
        for sums, values in zip(total, components, strict=True):
            numpy.add.at(sums, elements.T, values)
        radial, meridional, hoop, shear = self.young * total / count
        return Stress(radial=radial, meridional=meridional, hoop=hoop, shear=shear)

    def _at_nodes(self, layer: int) -> Numbers:
        """Stress components (4, elements, nodes) of a layer over Young's modulus.

        Taken where elements of this kind have them best, at the 1 or 2 by 2 Gauss points of the next lower degree.
        """
        elastic = self.body.elastic
        block = elastic.block
        shear, bulk = (float(modulus[layer]) for modulus in elastic.moduli)
        chosen = numpy.flatnonzero(block.layers == layer)
        whole = numpy.empty((4, len(chosen), len(block.elements)))
        points, carried = _best_points(block.order)
        flat = self._moved.ravel()
        for chunk in elastic.chunks(chosen):
            parts = elastic.strains(chosen[chunk], points)
            u = flat[elastic.unknowns[chosen[chunk]]]
            strain = numpy.einsum("eqsu,eu->seq", parts.strain, u)
            swelling = numpy.einsum("equ,eu->eq", parts.swelling, u)
            mean = bulk * swelling - 2 * shear * (strain[0] + strain[1] + strain[3]) / 3
            rho, z, hoop = (2 * shear * strain[i] + mean for i in (0, 1, 3))
            polar = _polar(parts.place, rho, z, shear * strain[2])
            whole[:, chunk] = numpy.stack([*polar[:2], hoop, polar[2]]) @ carried
        return whole


def _polar(place: Numbers, rho: Numbers, z: Numbers, shear: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """σ_rr, σ_φφ and σ_rφ from stresses along the axis and across it."""
    r = numpy.hypot(*place)
    sine, cosine = place / r
    across, along = rho - z, 2 * sine * cosine * shear
    return (
        sine**2 * rho + cosine**2 * z + along,
        cosine**2 * rho + sine**2 * z - along,
        sine * cosine * across + (cosine**2 - sine**2) * shear,
    )


def _best_points(order: int) -> tuple[Numbers, Numbers]:
    """Points (2, points) of the unit square, and what carries values from them to the nodes (points, nodes)."""
    if order == 1:
        return numpy.full((2, 1), 0.5), numpy.ones((1, 4))
    low, high = 0.5 - numpy.sqrt(1 / 12), 0.5 + numpy.sqrt(1 / 12)
    points = numpy.array([[low, high, high, low], [low, low, high, high]])
    corners = numpy.array([[0, 1, 1, 0, 0.5, 1, 0.5, 0, 0.5], [0, 0, 1, 1, 0, 0.5, 1, 0.5, 0.5]])
    stretched = (corners - low) / (high - low)  # the square whose corners the points are
    return points, shape_functions(1, stretched)[0]
