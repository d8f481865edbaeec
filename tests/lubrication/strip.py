"""Plane film along a line, for problems with published solutions."""

import numpy

from ballsocket.lubrication.mesh import FilmMesh


def strip_mesh(edges):
    """Divide a strip of unit width along x into cells between `edges` (mm); `spin` is then the sliding velocity."""
    centre = 0.5 * (edges[1:] + edges[:-1])
    cells = len(centre)
    inner = numpy.arange(cells - 1)
    along = numpy.array([1.0, 0.0, 0.0])
    return FilmMesh(
        area=numpy.diff(edges),
        direction=numpy.zeros((cells, 3)),
        first=inner,
        second=inner + 1,
        width=numpy.ones(cells - 1),
        first_distance=edges[1:-1] - centre[:-1],
        second_distance=centre[1:] - edges[1:-1],
        axis=numpy.tile(along, (cells - 1, 1)),
        rim_cell=numpy.array([0, cells - 1]),
        rim_width=numpy.ones(2),
        rim_distance=numpy.array([centre[0] - edges[0], edges[-1] - centre[-1]]),
        rim_axis=numpy.stack([-along, along]),
    )
