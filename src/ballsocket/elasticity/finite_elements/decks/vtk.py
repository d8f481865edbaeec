"""VTK files of displacements and stresses in ball and socket, for ParaView and similar programs."""

from __future__ import annotations

from pathlib import Path

import numpy

from ....core.checks import needs
from ....core.storage.atomic_files import check_parent_folder, write_atomically
from ..section import Section

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
    `displacement`, `von_mises`, and `radial`, `meridional`, `hoop` and `shear`, stresses in spherical directions. Cell
    data are `part`, 0 for the first. The file is written atomically: an interrupted write leaves none.

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

    positions = numpy.concatenate([part.position for part in section.parts], axis=1)
    first = numpy.cumsum([0, *(part.position.shape[1] for part in section.parts)])
    moved = numpy.concatenate([part.displacement for part in section.parts], axis=1)
    names = ("von_mises", "radial", "meridional", "hoop", "shear")
    stresses = {
        name: numpy.concatenate([getattr(part.stress, name) for part in section.parts]).ravel() for name in names
    }
    cells = [
        (_CELLS[len(part.elements)], (part.elements + start).T)
        for part, start in zip(section.parts, first[:-1], strict=True)
    ]
    mesh = meshio.Mesh(
        _add_third_coordinate(positions),
        cells,
        point_data={"displacement": _add_third_coordinate(moved), **stresses},
        cell_data={"part": [numpy.full(part.elements.shape[1], i) for i, part in enumerate(section.parts)]},
    )
    with write_atomically(path) as draft:
        mesh.write(draft)


def _add_third_coordinate(plane: numpy.ndarray) -> numpy.ndarray:
    """Add a third coordinate of 0 to vectors in the plane: (points, 3)."""
    return numpy.column_stack([*plane, numpy.zeros(plane.shape[1])])
