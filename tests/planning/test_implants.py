"""Liners and heads from STL files: radius, arc of cover, axis and wall within 0.02 mm and 0.5°, and refusals."""

import struct

import numpy as np
import pytest

from ballsocket.planning import Mesh, fit_head, fit_liner, read_mesh

from ..extent import some
from . import scans

HALF = {"arc_of_cover": 180.0, "steps": 30, "segments": 64}
SHIFT = np.array([30.0, -50.0, 800.0])
OVER = scans.liner(arc_of_cover=200.0, steps=24, segments=48)
PLAIN, SMALL = scans.liner(steps=24, segments=48), scans.liner(steps=6, segments=12)


def placed(triangles):
    """Return a mesh that is turned and moved, in the precision of a file, and its opening."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    return Mesh((triangles @ turn.T + SHIFT).astype(np.float32).astype(float)), turn[:, 2]


def angle(first, second):
    return np.degrees(np.arccos(np.clip(first @ second, -1.0, 1.0)))


def two_sided(triangles):
    """Add a second side of the bore, 1 % behind it, and leave the outer surface of the pole."""
    distance, heights = np.linalg.norm(triangles, axis=2), triangles.mean(axis=1)[:, 2]
    bore = triangles[(abs(distance - 16.0) < 1e-6).all(axis=1)]
    pole = triangles[(abs(distance - 24.0) < 1e-6).all(axis=1) & (heights < -15.5)]
    return np.concatenate([bore, pole, 1.01 * bore[:, ::-1]])


UPWARDS = np.array([0.0, 0.0, 1.0])
MOVED = scans.rotated(pitch=50.0, roll=-20.0, yaw=70.0)
LIPPED = scans.scattered(scans.locked(scans.lipped(PLAIN)), 0.01)
LINERS = {
    "plain": (PLAIN, 170.0, 8.0),
    "twelve facets": (scans.liner(steps=8, segments=16), 170.0, 8.0),
    "chamfer and scatter": (scans.scattered(scans.liner(chamfer=1.0, steps=30, segments=64), 0.02), 170.0, 8.0),
    "ribs": (scans.scattered(scans.ribbed(scans.liner(steps=30, segments=64), 24.0, height=0.5), 0.01), 170.0, 8.0),
    "open by a hole": (scans.with_hole(scans.scattered(PLAIN, 0.01), [0.5, 0.3, -0.8]), 170.0, 8.0),
    "cylinder beyond the sphere": (scans.liner(**HALF, cylinder=2.0), 180.0, 8.0),
    "cylinder in its scatter": (scans.scattered(scans.liner(**HALF, cylinder=0.8), 0.02), 180.0, 8.0),
    "over-hemispherical": (scans.liner(wall=4.0, arc_of_cover=200.0, steps=24, segments=48), 200.0, 4.0),
    "inside out": (PLAIN[:, ::-1], 170.0, 8.0),
    "eccentric": (OVER - np.where(np.linalg.norm(OVER, axis=2) > 20.0, 1.0, 0.0)[..., None] * [0, 0, 1], 200.0, 9.0),
    "bore of two sides": (two_sided(PLAIN), 170.0, 8.0),
    "lipped": (LIPPED, 170.0, 8.0),
}


@pytest.mark.parametrize(("triangles", "arc_of_cover", "wall"), LINERS.values(), ids=LINERS)
def test_a_liner_is_measured_within_its_tolerances(triangles, arc_of_cover, wall):
    mesh, opening = placed(triangles)
    fit = fit_liner(mesh)
    assert fit.radius == pytest.approx(16.0, abs=0.01)
    assert np.linalg.norm(fit.centre - SHIFT) < 0.02
    assert np.degrees(fit.arc_of_cover) == pytest.approx(arc_of_cover, abs=0.2)
    assert angle(fit.axis, opening) < 0.1
    # an outer sphere 1 mm off the bore is √(24² - sin²72°) + cos 72° - 16 mm thick at 0.8 of 90° from the pole
    assert (fit.wall_thickness, *fit.wall_range) == pytest.approx((wall, 8.29 if wall == 9.0 else wall, wall), abs=0.01)
    assert any("in two planes" in note for note in fit.notes) == (triangles is LIPPED)


@pytest.mark.parametrize(
    ("lip", "offset", "outer", "ring"),
    some([(20.0, -4.0, True, True), (15.0, 0.0, True, True), (10.0, 0.0, False, False)], 1),
)
def test_a_lip_moves_neither_axis_nor_arc_however_the_file_is_turned(lip, offset, outer, ring):
    triangles = scans.lipped(PLAIN, lip, offset, outer=outer)
    triangles = scans.locked(triangles) if ring else triangles
    plain, turned = (fit_liner(Mesh(corners)) for corners in (triangles, triangles @ MOVED.T + SHIFT))
    assert angle(plain.axis, UPWARDS) < 0.002
    assert np.degrees([plain.arc_of_cover, plain.lip_angle]) == pytest.approx([170.0, lip], abs=0.005)
    assert not plain.ambiguous
    assert turned.axis @ MOVED == pytest.approx(plain.axis, abs=1e-6)
    numbers = [[fit.arc_of_cover, fit.lip_angle, *(plane.height for plane in fit.rim)] for fit in (plain, turned)]
    assert numbers[1] == pytest.approx(numbers[0], abs=1e-6)


def test_two_planes_between_which_nothing_decides_are_called_ambiguous():
    """The outer surface is a sphere, cut like the bore; then it has a ring around the axis between both planes."""
    lipped, ring = scans.lipped(PLAIN), scans.locked(PLAIN)[len(PLAIN) :] @ scans.rotated(roll=7.5).T
    for triangles in (lipped, np.concatenate([lipped, ring])):
        fit = fit_liner(Mesh(triangles))
        assert fit.ambiguous
        assert min(angle(plane.normal, UPWARDS) for plane in fit.rim) < 0.01


@pytest.mark.parametrize(("steps", "scatter"), [(30, 0.0), (30, 0.02), (10, 0.0)])
def test_a_head_is_measured_to_the_edge_of_its_taper(steps, scatter):
    mesh, opening = placed(scans.scattered(scans.head(steps=steps, segments=2 * steps), scatter))
    fit = fit_head(mesh)
    assert fit.radius == pytest.approx(16.0, abs=0.005)
    assert np.degrees(fit.arc_of_cover) == pytest.approx(280.0, abs=0.2)
    assert angle(fit.axis, opening) < 0.1
    assert fit.wall_thickness is None


def test_a_complete_ball_has_no_axis_and_a_bore_alone_no_wall():
    ball = fit_head(Mesh(scans.turned(scans.arc(16.0, 180.0, 0.0, 19), 36)))
    assert (ball.axis, ball.arc_of_cover) == (None, 2 * np.pi)
    assert ball.radius == pytest.approx(16.0, abs=1e-9)
    # the middle of an equilateral facet of edge a lies a²/(6 R) below the sphere
    assert 0.02 < ball.facet_depth < (16.0 * np.radians(10.0)) ** 2 / (4 * 16.0)
    assert "a mesh whose facets straddle the surface has a smaller one" in ball.notes[0]
    bore = PLAIN[(abs(np.linalg.norm(PLAIN, axis=2) - 16.0) < 1e-6).all(axis=1)]
    assert fit_liner(Mesh(bore)).wall_thickness is None


@pytest.mark.parametrize(
    ("fit", "triangles", "message"),
    [
        (fit_liner, scans.head(steps=20, segments=40), "no bore.*; its sphere of radius 16 mm is convex, as of a hea"),
        (fit_liner, scans.turned(np.array([[16, 0], [24, 0], [24, 40], [16, 40], [16, 0.0]])), "mesh has no bore"),
        (fit_liner, np.array([[[0, 0, 0], [30, 0, 0], [0, 30, 0.0]]]), "mesh has no bore, no concave"),
        (fit_liner, scans.turned(np.array([[0, 0], [16, 14], [24, 14], [24, -8], [0, -8.0]])), "mesh has no bore"),
        (fit_liner, np.random.default_rng(2).normal(0.0, 20.0, (2000, 3, 3)), "mesh has no bore"),
        (fit_liner, scans.turned(scans.arc(16.0, 0.0, 180.0, 19), 36), "no bore"),
        (fit_head, scans.turned(np.array([[0, 0], [16, 0], [16, 40], [0, 40.0]])), "mesh has no ball, no convex sph"),
    ],
    ids=["head", "tube", "triangle", "cone", "soup", "closed ball inside out", "rod"],
)
def test_a_mesh_without_a_bore_or_a_ball_is_refused(fit, triangles, message):
    with pytest.raises(ValueError, match=message):
        fit(Mesh(triangles))


BINARY, ASCII = scans.binary(PLAIN, b"solid 3D Slicer output. SPACE=LPS"), scans.ascii_stl(SMALL)


def test_binary_and_ascii_files_hold_the_same_triangles(tmp_path):
    path = tmp_path / "a.stl"
    inches = scans.binary(PLAIN / 25.4)
    for content, units, triangles in ((BINARY, "mm", PLAIN), (inches, "in", PLAIN), (ASCII, "mm", SMALL)):
        path.write_bytes(content)
        mesh = read_mesh(path, units=units)
        np.testing.assert_allclose(mesh.triangles, triangles, atol=1e-5)
        assert mesh.space == ("LPS" if content == BINARY else None)


def test_obj_and_ply_files_hold_the_same_triangles(tmp_path):
    meshio = pytest.importorskip("meshio")
    corners, index = np.unique(SMALL.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    mesh = meshio.Mesh(corners, [("triangle", index.reshape(-1, 3).astype(np.int32))])
    for name, options in (("a.obj", {}), ("a.ply", {"binary": False}), ("a.ply", {"binary": True})):
        path = tmp_path / name
        meshio.write(path, mesh, **options)
        content = path.read_bytes().replace(b"vertex_indices", b"vertex_index")  # both names are usual
        path.write_bytes(b"vn 0 0 1\nvt 0 0\n" * (path.suffix == ".obj") + content)  # fewer than the points
        np.testing.assert_allclose(read_mesh(path).triangles, SMALL, atol=1e-8)


PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.step", b"ISO-10303-21;", r"a.step is not read: '.step' is no suffix of a mesh; save it as STL, OBJ or PLY"),
        ("a.stl", b"ply\nformat ascii 1.0\n", "a.stl is a PLY file: name it with the suffix .ply"),
        ("a.obj", b"v 1 2 3\nv 4 5 6\nv 7 8 0\nf -3 -2 -1\n", "a face names point -3, and the file has 3 points"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "the file is incomplete"),
        ("a.ply", PLY.replace(b"face 1", b"face 0") + b"1 2 3\n", "a.ply is incomplete: .* 3 points, and it has 1"),
        ("a.ply", PLY + b"1 2 3\n4 5 6\n7 8 0\n3 0 1 3\n", "a face names point 3, .*: count them from 0"),
    ],
)
def test_other_files_are_refused_by_their_name(tmp_path, name, content, message):
    pytest.importorskip("meshio")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_mesh(tmp_path / name)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "a.stl is a truncated or damaged binary STL: 0 bytes, less than the header of 84"),
        (BINARY[:-1], "truncated or damaged binary STL: .* bytes, its header states"),
        (bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(500), r"states 4294967295 triangles, 214748364834 bytes"),
        (bytes(84), "a.stl has no triangles"),
        (scans.binary(PLAIN * np.nan), "coordinates without a finite number"),
        (ASCII[:-100], "truncated or damaged ASCII STL: a vertex is not three numbers, 'vertex'"),
        (ASCII.replace(b"vertex", b"vortex", 1), "damaged ASCII STL: facet 1 has not three vertices"),
        (ASCII.replace(b".", b",", 3), "damaged ASCII STL: could not convert string to float"),
        (ASCII[:-12], "`endsolid` is missing"),
        (ASCII.replace(b"vertex ", b"vertex 1 ", 1), "a vertex is not three numbers, 'vertex 1 "),
        (scans.binary(PLAIN / 1000), r"a.stl is 0\.04\d+ mm large: .* 12 to 200 mm; its unit may be m \(4\d\.\d mm\)"),
        (scans.binary(PLAIN * 1000), r"4\.\d+e\+04 mm large: .* its unit may be um \(4\d\.\d mm\)"),
        (scans.binary(PLAIN / 25.4), r"1\.\d+ mm large: .* may be cm \(1\d\.\d mm\) or in \(4\d\.\d mm\)"),
    ],
)
def test_damaged_files_and_impossible_sizes_are_refused(tmp_path, content, message):
    (tmp_path / "a.stl").write_bytes(content)
    with np.errstate(all="ignore"), pytest.raises(ValueError, match=message):
        read_mesh(tmp_path / "a.stl")


def test_large_files_are_refused_before_they_are_read(tmp_path):
    with (tmp_path / "a.stl").open("wb") as stream:
        stream.truncate(2_000_000_000)  # sparse: takes no space
    with pytest.raises(ValueError, match=r"a\.stl has 2000 MB: at most 200 are read"):
        read_mesh(tmp_path / "a.stl")
    with pytest.raises(ValueError, match="units = 'inch' is not allowed: mm, cm, m, um, in"):
        read_mesh(tmp_path / "a.stl", units="inch")
