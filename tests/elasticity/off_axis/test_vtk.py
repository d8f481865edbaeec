"""VTK files of contacts: positions, pressures and gaps of the bodies."""

from math import radians

import meshio
import numpy as np
import pytest

from ballsocket.elasticity.off_axis.vtk import BALL, BORE, EDGE, write_vtk

from .shapes import COARSE, RIGID


@pytest.fixture(scope="module")
def contact():
    return COARSE.press(RIGID, force=2500.0, tilt=0.6)


@pytest.fixture(scope="module")
def mesh(contact, tmp_path_factory):
    path = tmp_path_factory.mktemp("vtk") / "contact.vtu"
    write_vtk(contact, path)
    return meshio.read(path)


def body(mesh, part):
    """Return the corners of the cells of one body, and their pressures and gaps."""
    for number, block in enumerate(mesh.cells):
        mask = mesh.cell_data["part"][number] == part
        if mask.any():
            return block.data[mask], *(mesh.cell_data[name][number][mask] for name in ("pressure", "gap"))
    raise AssertionError(f"no cells of part {part}")


def test_surfaces_are_the_bore_and_the_displaced_ball(contact, mesh):
    assert (BORE, BALL, EDGE) == (0, 1, 2)
    rings, meridians = contact.pressure_map[2].shape
    assert [len(body(mesh, part)[0]) for part in range(3)] == [rings * meridians, 90 * 180, 90]
    bore, ball = (mesh.points[np.unique(body(mesh, part)[0])] for part in (BORE, BALL))
    assert np.linalg.norm(bore, axis=1) == pytest.approx(RIGID.socket_radius)
    assert bore[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(ball - contact.displacement, axis=1) == pytest.approx(RIGID.ball_radius)


def test_edge_is_a_closed_line_around_the_contact(contact, mesh):
    links = body(mesh, EDGE)[0]
    assert (links[:, 1] == np.roll(links[:, 0], -1)).all()
    assert mesh.points[links[:, 0]] == pytest.approx(RIGID.socket_radius * contact.outline)


def test_gap_is_open_where_there_is_no_pressure_and_undeformed_far_away(contact, mesh):
    _, pressure, gap = body(mesh, BORE)
    polar, azimuth, expected = contact.pressure_map
    assert pressure == pytest.approx(expected.ravel())
    assert (pressure * gap == 0).all()
    assert gap.min() >= -1e-6
    assert gap.max() > 0.05
    n = np.array([-np.sin(polar[-1]), 0.0, np.cos(polar[-1])])
    far = gap.reshape(len(polar), len(azimuth))[-1, len(azimuth) // 2]
    assert far == pytest.approx(RIGID.clearance - contact.displacement @ n, abs=5e-3)
    for part in (BALL, EDGE):
        assert not np.any(body(mesh, part)[1:])


@pytest.mark.parametrize("load", [{"force": [1.0, 2.0]}, {"force": 0.0}, {"force": 10.0, "tilt": radians(120.0)}])
def test_contacts_without_a_solution_or_in_batches_raise(load, tmp_path):
    with pytest.raises(ValueError, match="pressure maps"):
        write_vtk(COARSE.press(RIGID, **load), tmp_path / "contact.vtu")
