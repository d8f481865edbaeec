"""VTK files of off-axis contacts, for ParaView and similar viewers."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy

from ...core.arrays import Numbers
from ...core.checks import needs
from ...core.storage.atomic_files import write_atomically
from ..finite_elements.section import check_vtk_path
from .contact import OffAxisContact
from .directions import unit_vectors

BORE, BALL, EDGE = 0, 1, 2  # numbers of the bodies in the cell data `part`
_BALL_RINGS = 90  # number of rings in which the ball is drawn


def write_vtk(contact: OffAxisContact, path: Path) -> None:
    """Write bore, displaced ball and edge of the contact to a VTK file, with pressure (MPa) and gap (mm).

    Coordinates are in mm, in the cup's own frame, from the centre of the bore. z points to the pole of the dome, and x
    leans towards the rim. Cell data are `part` (0 bore, 1 ball, 2 edge of the contact), `pressure` (MPa) and `gap` (mm,
    between the deformed surfaces). The latter two are 0 on ball and edge. The file is written atomically: an
    interrupted write leaves no file.

    Parameters
    ----------
    contact : OffAxisContact
        A single contact under load.
    path : Path
        File name that ends in .vtu or .vtk.

    Raises
    ------
    ValueError
        A path with another suffix; more than one contact; a contact without load or solution.
    ImportError
        The package meshio is not installed.
    """
    check_vtk_path(path)
    grid = contact.single_state.bore.compliance.grid
    needs("fem", "meshio")
    import meshio

    bore, cells = _mesh_sphere(grid.edges, grid.meridians)
    ball, faces = _mesh_sphere(numpy.linspace(0.0, pi, _BALL_RINGS + 1), 2 * _BALL_RINGS)
    edge = contact.outline
    links = numpy.stack([numpy.arange(len(edge)), numpy.roll(numpy.arange(len(edge)), -1)], axis=-1)
    radius, joint = float(contact.joint.socket_radius), contact.joint
    points = [radius * bore, contact.displacement + float(joint.ball_radius) * ball, radius * edge]
    blocks = [("quad", cells), ("quad", faces + len(bore)), ("line", links + len(bore) + len(ball))]
    sizes = [len(block) for _, block in blocks]
    equilibrium, bore_contact = contact.single_state.equilibrium, contact.single_state.bore
    pressure = contact.pressure_map[2]
    deformation = bore_contact.compliance.softness(equilibrium.pressure)
    gap = (deformation - bore_contact.gap.overlap(equilibrium.displacement))[0]
    fields = {"pressure": pressure, "gap": numpy.where(pressure > 0, 0.0, gap)}
    data = {name: [values.ravel(), *(numpy.zeros(size) for size in sizes[1:])] for name, values in fields.items()}
    bodies = [numpy.full(size, body) for size, body in zip(sizes, (BORE, BALL, EDGE), strict=True)]
    mesh = meshio.Mesh(numpy.concatenate(points), blocks, cell_data={"part": bodies, **data})
    with write_atomically(path) as draft:
        mesh.write(draft)


def _mesh_sphere(polar: Numbers, meridians: int) -> tuple[Numbers, Numbers]:
    """Mesh a unit sphere: compute the points (n, 3) of a grid and the corners (cells, 4) of its cells."""
    azimuth = numpy.arange(meridians) * (2 * pi / meridians)
    points = unit_vectors(polar[:, None], azimuth).reshape(3, -1).T
    first = numpy.arange((len(polar) - 1) * meridians).reshape(-1, meridians)
    after = numpy.roll(first, -1, axis=1)
    corners = numpy.stack([first, after, after + meridians, first + meridians], axis=-1)
    return points, corners.reshape(-1, 4)
