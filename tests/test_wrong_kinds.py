"""Arguments of a wrong type: each is refused by name, and no part of it is ignored."""

import io
import struct
import warnings

import numpy
import pytest

import ballsocket as bs
from ballsocket.core.executors.processes import Serial
from ballsocket.core.storage.atomic_files import read_arrays, write_arrays
from ballsocket.elasticity.off_axis import read_scan
from ballsocket.hip import HipSimulation
from ballsocket.hip.simulator_cycles import iso_14242_1
from ballsocket.hip.wear_laws import Archard

HIP = bs.joints["hip-28"]
ELEMENT = bs.ForceElement(bs.HessForsbach(), HIP)


class DataFrame:
    """Stand-in for a pandas DataFrame: a shape without a dtype."""

    shape = (2, 1)


def matrix(*values):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        return numpy.matrix([values])


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (DataFrame(), "got a DataFrame: take one of its columns"),
        (matrix(1.0, 2.0), "got a numpy.matrix: use numpy.asarray"),
        (matrix(-1.0), "got a numpy.matrix: use numpy.asarray"),
    ],
)
def test_data_frames_and_matrices_are_refused(value, message):
    with pytest.raises(TypeError, match=f"force must be a number or an array .* {message}"):
        bs.HessForsbach().press(HIP, force=value)
    with pytest.raises(TypeError, match=f"ball_radius must be a number or an array .* {message}"):
        bs.Joint(ball_radius=value, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)


def test_a_matrix_as_a_position_is_refused():
    """A matrix as a position once ended the process inside NumPy."""
    with pytest.raises(TypeError, match="position must be a number or an array .* got a numpy.matrix"):
        ELEMENT(matrix(0.0, 0.0, 0.2))


@pytest.mark.parametrize(
    "position",
    [
        (0.0, 0.0, 0.2j),
        [0, 0, 0.2 + 1e-9j],
        (numpy.float64(0.0), numpy.complex128(0.1j), numpy.float64(0.2)),
        (0, 0, 10**400),
        (None, 0.0, 0.0),
    ],
)
def test_positions_have_three_real_components(position):
    with pytest.raises(ValueError, match="a state must have three components, x, y and z, all real numbers"):
        ELEMENT(position)


@pytest.mark.parametrize("which", ["position", "velocity", "spin"])
def test_complex_states_are_refused(which):
    words = {"position": numpy.array([0.0, 0.0, 0.2]), which: numpy.array([0.0, 0.0, 0.2 + 1j])}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(TypeError, match=f"{which} must be a number or an array of real numbers"):
            ELEMENT(**words)


@pytest.mark.parametrize("engine", ["processes", 3, None, object(), Serial])
def test_an_engine_of_another_type_is_refused(engine):
    pytest.importorskip("xarray")
    with pytest.raises(TypeError, match=r"engine must be an Engine, such as Serial\(\)"):
        bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], engine=engine)


@pytest.mark.parametrize(
    ("name", "value"), [("cup", "steep"), ("cup", None), ("cycle", "iso-14242-1"), ("joint", "hip-28")]
)
def test_parts_of_a_hip_of_another_type_are_refused(name, value):
    words = {"joint": HIP, "cycle": iso_14242_1(), "wear": Archard(coefficient=1e-6), name: value}
    with pytest.raises(TypeError, match=f"{name} must be a {name.capitalize()}, got"):
        HipSimulation(**words)


def test_a_scan_with_huge_coordinates_is_refused(tmp_path, capfd):
    pytest.importorskip("meshio")
    rows = [f"v {i % 20}e200 {i // 20} 1" for i in range(400)]
    faces = [f"f {i + 1} {i + 2} {i + 3}" for i in range(300)]
    (tmp_path / "bore.obj").write_text("\n".join([*rows, *faces]), encoding="ascii")
    with pytest.raises(ValueError, match=r"points of bore.obj.* is not allowed: coordinates \(mm\) are at most 1e\+06"):
        read_scan(tmp_path / "bore.obj")
    (tmp_path / "bore.stl").write_bytes(b"solid \xff")
    with pytest.raises(ValueError, match="bore.stl cannot be read as a mesh"):
        read_scan(tmp_path / "bore.stl")
    assert capfd.readouterr() == ("", "")


def test_an_archive_without_all_of_its_members_is_damaged(tmp_path):
    """A damaged directory lists fewer members."""
    path = tmp_path / "kept.npz"
    write_arrays(path, rings=numpy.arange(12.0), count=3, identity="run")
    assert set(read_arrays(path)) == {"rings", "count", "identity"}
    raw = bytearray(path.read_bytes())
    size, begin = struct.unpack("<LL", raw[-10:-2])
    first = 46 + sum(struct.unpack("<HHH", raw[begin + 28 : begin + 34]))  # of the entry for one member
    raw[-10:-2] = struct.pack("<LL", size - first, begin + first)
    path.write_bytes(raw)
    with numpy.load(io.BytesIO(raw)) as damaged:
        assert len(damaged.files) == 2
    with pytest.raises(ValueError, match="kept.npz is damaged"):
        read_arrays(path)


def test_a_damaged_label_of_a_store_names_the_store(tmp_path):
    pytest.importorskip("zarr")
    bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], store=tmp_path / "store")
    (tmp_path / "store" / "indentation" / "zarr.json").write_bytes(b"{\xb5}")
    with pytest.raises(ValueError, match="store is a damaged store: .*; run its study again to repair it"):
        bs.studies.read(tmp_path / "store")
    again = bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], store=tmp_path / "store")
    assert numpy.isfinite(again.indentation).all()
