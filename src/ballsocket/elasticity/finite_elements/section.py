"""Displacements and stresses inside ball and socket under one contact, at the nodes of the meshes, and as VTK files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy

from ...core.arrays import Numbers
from ...core.checks import needs
from ...core.storage.atomic_files import check_parent_folder, write_atomically
from ...core.stress import Peak, Stress
from ...problem import Joint, Material
from ...problem.cup import Cup
from .bodies import CondensedBody, ball_body, socket_body
from .elasticity import ElasticBlock, element_quadrature, shape_functions
from .load_search import Solved
from .mesh import socket_shape
from .plastic_contact import PlasticContact
from .plasticity import PlasticStrain

_CORNER_RADIUS = 0.25  # of the liner's thickness, or of the socket's radius if that is smaller


@dataclass(frozen=True, kw_only=True, eq=False)
class Part:
    """Layer of the socket, or the ball, with its mesh.

    Attributes
    ----------
    name : str
        "liner", "backing 1" and so on outwards, "ball".
    angle, radius : array (nodes,)
        Polar angle in rad from the load axis, distance in mm from the part's centre.
    position : array (2, nodes)
        Position in mm: distance from the load axis, and height above the centre of the socket. The ball is placed at
        first contact; the load pushes it down.
    elements : array (4 or 9, elements)
        Nodes of the elements: corners, then edges and middle.
    displacement : array (2, nodes)
        Displacement in mm, in the directions of `position`.
    stress : Stress
        Stress at the nodes, averaged over the part's elements around each.
    plastic_strain : array (nodes,)
        Equivalent plastic strain at the nodes, averaged likewise.
    """

    name: str
    angle: Numbers
    radius: Numbers
    position: Numbers
    elements: Numbers
    displacement: Numbers
    stress: Stress
    plastic_strain: Numbers


@dataclass(frozen=True, kw_only=True, eq=False)
class Section:
    """All deformable parts of one contact, without a rigid ball. `section["liner"]` is one of its `parts`.

    Attributes
    ----------
    parts : tuple of Part
    socket_radius : float
        R2 in mm.
    """

    parts: tuple[Part, ...]
    socket_radius: float

    def __getitem__(self, name: str) -> Part:
        known = {part.name: part for part in self.parts}
        if name not in known:
            raise KeyError(f"part {name!r} is not known; known parts: {', '.join(known)}")
        return known[name]

    @cached_property
    def peak_stress(self) -> Peak:
        """Largest von Mises stress (MPa) in the liner, its depth below the bore (mm) and polar angle (rad).

        The corners of its rim are omitted, because the elastic stress is unbounded there.
        """
        liner = self["liner"]
        corner = numpy.isclose(liner.angle, liner.angle.max())
        corners = liner.position[:, [numpy.flatnonzero(corner)[i] for i in (0, -1)]]
        corner_distance = numpy.min(numpy.hypot(*(liner.position[..., None] - corners[:, None])), axis=-1)
        size = min(liner.radius.max() - liner.radius.min(), liner.radius.min())  # a massive socket has no thickness
        at = int(numpy.argmax(numpy.where(corner_distance > _CORNER_RADIUS * size, liner.stress.von_mises, 0.0)))
        return Peak(
            von_mises=float(liner.stress.von_mises[at]),
            depth=float(liner.radius[at]) - self.socket_radius,
            angle=float(liner.angle[at]),
        )

    @cached_property
    def rim_displacement(self) -> tuple[float, float]:
        """Displacement of the end of the bore in mm: away from the load axis, and up against the load."""
        liner = self["liner"]
        end = numpy.flatnonzero(liner.angle > liner.angle.max() - 1e-12)
        across, up = liner.displacement[:, end[numpy.argmin(liner.radius[end])]]
        return float(across), float(up)


def section(joint: Joint, cup: Cup, solved: Solved | PlasticContact) -> Section:
    """Compute displacements and stresses of one solved contact of a joint of plain numbers."""
    pair, R2 = solved.pair, float(joint.socket_radius)
    names = ("liner", *(f"backing {number}" for number in range(1, len(joint.backing) + 1)))
    socket = socket_body(socket_shape(joint, cup), pair.resolution)
    if isinstance(solved, PlasticContact):
        displaced, plastic = socket.nodal_displacements(solved.displacement), solved.plastic
    else:
        displaced, plastic = _unit_displacements(socket, joint.liner, solved.forces(0), R2), None
    parts = list(_make_parts(socket, names, joint.liner, displaced, R2, R2, plastic))
    if joint.ball is not None:
        ball = ball_body(float(joint.ball.poisson), pair.ball_resolution)
        pressed = _unit_displacements(ball, joint.ball, -solved.forces(1), R2)
        # placed at first touch, and pushed down
        lowered, descent = (numpy.array([[0.0], [float(drop)]]) for drop in (joint.clearance, solved.indentation))
        for part in _make_parts(ball, ("ball",), joint.ball, pressed, R2, float(joint.ball_radius)):
            parts.append(replace(part, position=part.position - lowered, displacement=part.displacement - descent))
    return Section(parts=tuple(parts), socket_radius=R2)


def _unit_displacements(body: CondensedBody, material: Material, forces: Numbers, loaded_radius: float) -> Numbers:
    """Compute the displacements (nodes, 2) of a body of unit size under forces in N on its surface."""
    return body.displacements(forces / (float(material.young) * loaded_radius**2))


def _make_parts(
    body: CondensedBody,
    names: tuple[str, ...],
    material: Material,
    unit_displacements: Numbers,
    loaded_radius: float,
    radius: float,
    plastic: PlasticStrain | None = None,
) -> Iterator[Part]:
    """Yield the parts of a body of unit size, one for each layer from the inside out.

    Its displacements (nodes, 2) are in units of `loaded_radius` in mm. Young's modulus is that of the material, and
    `radius` in mm scales the positions. The first part may have plastic strains.
    """
    young, block = float(material.young), body.elastic.block
    phi = numpy.repeat(block.angle, block.radius.shape[1])
    u_phi, u_r = loaded_radius * unit_displacements.T
    sine, cosine = numpy.sin(phi), numpy.cos(phi)
    displacement = numpy.stack([u_phi * cosine + u_r * sine, u_phi * sine - u_r * cosine])
    across, below = radius * block.nodes
    for layer, name in enumerate(names):
        elements = block.elements[:, block.layers == layer]
        nodes, local_nodes = numpy.unique(elements, return_inverse=True)
        local_nodes = local_nodes.reshape(elements.shape)
        yielding = plastic if layer == 0 else None
        stresses = young * _element_stresses(body.elastic, layer, unit_displacements.ravel(), yielding)
        plastic_strain = numpy.zeros((1, *stresses.shape[1:]))
        if yielding is not None:
            extrapolation = _superconvergent_points(block.order)[1]
            plastic_strain[0] = numpy.maximum(_inner_values(yielding.equivalent, block.order) @ extrapolation, 0.0)
        # mean over the elements around each node
        count = numpy.bincount(local_nodes.ravel())
        radial, meridional, hoop, shear, equivalent = (
            numpy.bincount(local_nodes.T.ravel(), weights=values.ravel()) / count
            for values in (*stresses, *plastic_strain)
        )
        yield Part(
            name=name,
            angle=phi[nodes],
            radius=radius * block.radius.ravel()[nodes],
            position=numpy.stack([across, 0.0 - below])[:, nodes],
            elements=local_nodes,
            displacement=displacement[:, nodes],
            stress=Stress(radial=radial, meridional=meridional, hoop=hoop, shear=shear),
            plastic_strain=equivalent,
        )


def _element_stresses(
    elastic: ElasticBlock, layer: int, displacements: Numbers, plastic: PlasticStrain | None
) -> Numbers:
    """Compute stress components (4, elements, nodes) of a layer as fractions of Young's modulus.

    The unknowns of the body are `displacements`. The stresses are evaluated at the superconvergent points: the 1 or 2
    by 2 Gauss points of the next lower degree.
    """
    block = elastic.block
    shear, bulk = (float(modulus[layer]) for modulus in elastic.moduli)
    element_indices = numpy.flatnonzero(block.layers == layer)
    stresses = numpy.empty((4, len(element_indices), len(block.elements)))
    points, extrapolation = _superconvergent_points(block.order)
    for chunk in elastic.chunks(element_indices):
        strains = elastic.strains(element_indices[chunk], points)
        u = displacements[elastic.element_unknowns[element_indices[chunk]]]
        strain = numpy.einsum("eqsu,eu->seq", strains.strain, u)
        swelling = numpy.einsum("equ,eu->eq", strains.swelling, u)
        mean = bulk * swelling - 2 * shear * (strain[0] + strain[1] + strain[3]) / 3
        if plastic is not None:
            strain -= numpy.moveaxis(_inner_values(plastic.components[chunk], block.order), -1, 0)
        rho, z, hoop = (2 * shear * strain[i] + mean for i in (0, 1, 3))
        rho_z = shear * strain[2]
        # spherical directions at the polar angle of each point
        sine, cosine = strains.coordinates / numpy.hypot(*strains.coordinates)
        along = 2 * sine * cosine * rho_z
        radial = sine**2 * rho + cosine**2 * z + along
        meridional = cosine**2 * rho + sine**2 * z - along
        tilted = sine * cosine * (rho - z) + (cosine**2 - sine**2) * rho_z
        stresses[:, chunk] = numpy.stack([radial, meridional, hoop, tilted]) @ extrapolation
    return stresses


def _inner_values(values: Numbers, order: int) -> Numbers:
    """Convert values (elements, points, ...) at quadrature points to the superconvergent ones, by a bilinear fit."""
    inner, outer = (
        numpy.stack([numpy.ones_like(points[0]), *points, points[0] * points[1]], axis=-1)
        for points in (_superconvergent_points(order)[0], element_quadrature(order)[0])
    )
    return numpy.moveaxis(numpy.tensordot(inner @ numpy.linalg.pinv(outer), values, (1, 1)), 0, 1)


def _superconvergent_points(order: int) -> tuple[Numbers, Numbers]:
    """Return superconvergent points (2, points) and the matrix (points, nodes) that extrapolates stresses."""
    if order == 1:
        return numpy.full((2, 1), 0.5), numpy.ones((1, 4))
    low, high = 0.5 - numpy.sqrt(1 / 12), 0.5 + numpy.sqrt(1 / 12)
    points = numpy.array([[low, high, high, low], [low, low, high, high]])
    corners = numpy.array([[0, 1, 1, 0, 0.5, 1, 0.5, 0, 0.5], [0, 0, 1, 1, 0, 0.5, 1, 0.5, 0.5]])
    stretched = (corners - low) / (high - low)  # in the square with these points as corners
    return points, shape_functions(1, stretched)[0]


_CELLS = {4: "quad", 9: "quad9"}
SUFFIXES = (".vtu", ".vtk")


def check_vtk_path(path: Path) -> None:
    """Raise ValueError unless `path` has the suffix of a VTK format and its folder exists."""
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{str(path)!r} must end in {', '.join(SUFFIXES)}")
    check_parent_folder(path)


def write_vtk(section: Section, path: Path) -> None:
    """Write meshes, displacements (mm) and stresses (MPa) of a section to a VTK file.

    x is the distance from the load axis, y the height above the centre of the socket, in mm. Point data are
    `displacement`, `plastic_strain`, `von_mises`, and `radial`, `meridional`, `hoop` and `shear`, stresses in spherical
    directions. Cell data are `part`, 0 for the first. The file is written atomically: an interrupted write leaves none.

    Parameters
    ----------
    section : Section
        Section of a `MeshedContact`.
    path : Path
        Path that ends in .vtu or .vtk.

    Raises
    ------
    ValueError
        The path has another suffix.
    ImportError
        meshio is not installed.
    """
    check_vtk_path(path)
    needs("fem", "meshio")
    import meshio

    parts = section.parts
    first = numpy.cumsum([0, *(part.position.shape[1] for part in parts)])
    no_depth = numpy.zeros(first[-1])  # third coordinate of vectors in the plane
    positions, moved = (
        numpy.column_stack([*numpy.concatenate(vectors, axis=1), no_depth])
        for vectors in ([part.position for part in parts], [part.displacement for part in parts])
    )
    data = {"displacement": moved, "plastic_strain": numpy.concatenate([part.plastic_strain for part in parts])}
    for name in ("von_mises", "radial", "meridional", "hoop", "shear"):
        data[name] = numpy.concatenate([getattr(part.stress, name) for part in parts]).ravel()
    pairs = zip(parts, first[:-1], strict=True)
    cells = [(_CELLS[len(part.elements)], (part.elements + start).T) for part, start in pairs]
    numbers = [numpy.full(part.elements.shape[1], i) for i, part in enumerate(parts)]
    mesh = meshio.Mesh(positions, cells, point_data=data, cell_data={"part": numbers})
    with write_atomically(path) as draft:
        mesh.write(draft)
