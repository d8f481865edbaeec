"""A contact off the axis as a VTK file, for ParaView and its like."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy

from ...core.arrays import Numbers
from ...core.checks import needs
from ...core.storage.atomic_files import write_atomically
from ..finite_elements.decks.vtk import check_suffix
from .contact import OffAxisContact
from .directions import unit_vectors

BORE, BALL, EDGE = 0, 1, 2
"""Parts, as the cell data number them."""

_BALL_RINGS = 90


def write_vtk(contact: OffAxisContact, path: Path) -> None:
    """Write the bore with its pressures, the ball where it lies, and the edge of the contact.

    Places are in mm, in the cup's own frame, from the centre of the bore: z points to the dome's pole, x leans towards
    the rim. Cell data are `part` (0 bore, 1 ball, 2 edge of the contact), `pressure` (MPa) and `gap` (mm, what is left
    between ball and bore, both deformed); the latter two are 0 outside of the bore. The file appears at once: an
    interrupted write leaves none.

    Parameters
    ----------
    contact : OffAxisContact
        One contact under load.
    path : Path
        Ends in .vtu or .vtk.

    Raises
    ------
    ValueError
        A path that ends like no known format; more than one contact, or one without load or answer.
    ImportError
        meshio is not installed.
    """
    check_suffix(path)
    grid = contact.single_state.bed.compliance.grid
    needs("fem", "meshio")
    import meshio

    bore, cells = _faces(grid.edges, grid.meridians)
    ball, faces = _faces(numpy.linspace(0.0, pi, _BALL_RINGS + 1), 2 * _BALL_RINGS)
    edge = contact.outline
    links = numpy.stack([numpy.arange(len(edge)), numpy.roll(numpy.arange(len(edge)), -1)], axis=-1)
    radius, joint = float(contact.joint.socket_radius), contact.joint
    places = [radius * bore, contact.displacement + float(joint.ball_radius) * ball, radius * edge]
    blocks = [("quad", cells), ("quad", faces + len(bore)), ("line", links + len(bore) + len(ball))]
    sizes = [len(each) for _, each in blocks]
    fields = {"pressure": contact.pressure_map[2], "gap": _gap(contact)}
    data = {name: [values.ravel(), *(numpy.zeros(size) for size in sizes[1:])] for name, values in fields.items()}
    parts = [numpy.full(size, part) for size, part in zip(sizes, (BORE, BALL, EDGE), strict=True)]
    mesh = meshio.Mesh(numpy.concatenate(places), blocks, cell_data={"part": parts, **data})
    with write_atomically(path) as draft:
        mesh.write(draft)


def _gap(contact: OffAxisContact) -> Numbers:
    """What is left between the surfaces in mm: (rings, meridians); 0 where they touch."""
    state = contact.single_state
    given = state.bed.compliance.displacement(state.rest.pressure)
    apart: Numbers = (given - state.bed.separation.overlap(state.rest.displacement))[0]
    return numpy.where(state.rest.pressure[0] > 0, 0.0, apart)


def _faces(polar: Numbers, meridians: int) -> tuple[Numbers, Numbers]:
    """Points (n, 3) of a sphere of radius 1 between rings and meridians, and the corners (cells, 4) of its cells."""
    azimuth = numpy.arange(meridians) * (2 * pi / meridians)
    points = unit_vectors(polar[:, None], azimuth).reshape(3, -1).T
    first = numpy.arange((len(polar) - 1) * meridians).reshape(-1, meridians)
    after = numpy.roll(first, -1, axis=1)
    corners = numpy.stack([first, after, after + meridians, first + meridians], axis=-1)
    return points, corners.reshape(-1, 4)
