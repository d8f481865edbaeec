"""Arguments of a wrong type, name or unit: each is refused in one sentence, and no part of it is ignored."""

import warnings

import numpy
import pytest

import ballsocket as bs
from ballsocket.core.executors.processes import Serial
from ballsocket.elasticity.off_axis.scans import read_scan
from ballsocket.hip import HipSimulation
from ballsocket.hip.simulator_cycles import iso_14242_1
from ballsocket.hip.wear_laws import Archard

from .refusals import refused_calls

HIP = bs.joints["hip-28"]
PRESSED = bs.HessForsbach().press(HIP, force=3000.0)
ELEMENT = bs.ForceElement(bs.HessForsbach(), HIP)


class DataFrame:
    """Stand-in for a pandas DataFrame: a shape without a dtype."""

    shape = (2, 1)

    def to_numpy(self):
        return numpy.ones(self.shape)


class Series(DataFrame):
    """Stand-in for a pandas Series or a DataArray of xarray."""

    dtype = numpy.dtype(float)


def matrix(*values):
    with warnings.catch_warnings(action="ignore", category=PendingDeprecationWarning):
        return numpy.matrix([values])


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (DataFrame(), r"a DataFrame: use .to_numpy\(\) of one of its columns"),
        (Series(), r"a Series: use .to_numpy\(\)"),
        (matrix(-1.0), "a numpy.matrix: use numpy.a"),
    ],
)
def test_data_frames_and_matrices_are_refused(value, hint):
    with pytest.raises(TypeError, match=f"force must be a number or an array .* got {hint}"):
        bs.HessForsbach().press(HIP, force=value)
    with pytest.raises(TypeError, match=f"ball_radius must be a number or an array .* got {hint}"):
        bs.Joint(ball_radius=value, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)


COMPLEX = (numpy.float64(0.0), numpy.complex128(0.1j), numpy.float64(0.2))


@pytest.mark.parametrize("position", [(0, 0, 0.2j), [0, 0, 0.2 + 1e-9j], COMPLEX, (0, 0, 10**400), (None, 0.0, 0.0)])
def test_positions_have_three_real_components(position):
    with pytest.raises(ValueError, match="a state must have three components, x, y and z, all real numbers"):
        ELEMENT(position)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("which", ["position", "velocity", "spin"])
def test_complex_states_and_matrices_are_refused(which):
    """A matrix as a position once ended the process inside NumPy."""
    for value in (numpy.array([0.0, 0.0, 0.2 + 1j]), matrix(0.0, 0.0, 0.2)):
        with pytest.raises(TypeError, match=f"{which} must be a number or an array of real numbers"):
            ELEMENT(**{"position": numpy.array([0.0, 0.0, 0.2]), which: value})


@pytest.mark.parametrize("engine", ["processes", None, object(), Serial])
def test_parts_of_a_study_of_another_type_or_unit_are_refused(engine):
    pytest.importorskip("xarray", reason="the extra for studies is not installed")
    with pytest.raises(TypeError, match=r"engine must be an Engine, such as Serial\(\)"):
        bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], engine=engine)
    with pytest.raises(TypeError, match=r"model must be a Model, got 'exact'; bs.catalogue\['exact'\] is"):
        bs.study("exact", HIP, force=1.0)
    with pytest.raises(ValueError, match=r"half_angle.* = 20 .*; 20 degrees are 0.3491 rad"):
        bs.study(bs.Hertz(), HIP, half_angle=[20, 40])


def test_a_scan_with_huge_coordinates_is_refused(tmp_path, capfd):
    pytest.importorskip("meshio")
    rows = [f"v {i % 20}e200 {i // 20} 1" for i in range(400)]
    faces = [f"f {i + 1} {i + 2} {i + 3}" for i in range(300)]
    (tmp_path / "bore.obj").write_text("\n".join([*rows, *faces]), encoding="ascii")
    with pytest.raises(ValueError, match=r"points of bore.obj.* is not allowed: coordinates \(mm\) are at most 1e\+06"):
        read_scan(tmp_path / "bore.obj")
    assert capfd.readouterr() == ("", "")


def test_a_damaged_label_of_a_store_names_the_store(tmp_path):
    pytest.importorskip("zarr")
    bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], store=tmp_path / "store")
    (tmp_path / "store" / "indentation" / "zarr.json").write_bytes(b"{\xb5}")
    with pytest.raises(ValueError, match="store is a damaged store: .*; run its study again to repair it"):
        bs.studies.read(tmp_path / "store")
    again = bs.study(bs.HessForsbach(), HIP, force=[1.0, 2.0], store=tmp_path / "store")
    assert numpy.isfinite(again.indentation).all()


def hip(**parts):
    return HipSimulation(**{"joint": HIP, "cycle": iso_14242_1(), "wear": Archard(coefficient=1e-6), **parts})


test_arguments_of_another_kind_are_refused_with_a_hint = refused_calls(
    (lambda: hip(cup="steep"), "cup must be a Cup, got 'steep'"),
    (lambda: hip(cycle="iso-14242-1"), "cycle must be a Cycle, got 'iso-14242-1'"),
    (lambda: hip(joint="hip-28"), "joint must be a Joint, got 'hip-28'"),
    (lambda: bs.Exact().press("Hip 28", force=1.0), r"must be a Joint, got 'Hip 28'; use bs.joints\['hip-28'\]"),
    (lambda: bs.Exact().press(28.0, force=1.0), r"joint must be a Joint, got 28\.0$"),
    (lambda: bs.PinInHole().press("hip-28", line_load=1.0), "joint must be a Joint, got 'hip-28'"),
    (lambda: bs.Exact().press(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
    (lambda: bs.PinInHole().press(HIP, 30.0), "a load needs its name: line_load in N/mm"),
    (lambda: bs.compare(HIP, 3000.0), r"a load needs its name: force=3000\.0 in N"),
    (lambda: bs.compare("hip-28", force=1.0), "joint must be a Joint, got 'hip-28'"),
    (lambda: bs.compare(HIP, force=1.0, models="exact"), r"models must be a list .* got 'exact'$"),
    (lambda: bs.compare(HIP, force=1.0, models={"exact": "exact"}), r"models\['exact'\] must be a model"),
    error=TypeError,
)

test_names_that_are_not_known_are_refused_with_a_hint = refused_calls(
    (lambda: bs.joints["hip36"], "joint 'hip36' is not known; did you mean 'hip-36'"),
    (lambda: bs.catalogue["hess"], "model 'hess' is not known; did you mean 'hess-forsbach'"),
    (lambda: bs.compare(HIP, force=1.0)["herz"], "model 'herz' is not in this comparison; did you mean 'hertz'"),
    error=KeyError,
)

test_angles_in_degrees_are_refused_with_a_hint = refused_calls(
    (lambda: PRESSED.pressure(30), "angle = 30 is not allowed: .* in radians; 30 degrees are 0.5236 radians$"),
    (lambda: PRESSED.pressure([0.1, 30.0]), r"angle\[1\] = 30 is not allowed: .*; 30 degrees are 0.5236 radians$"),
    (lambda: bs.Exact().press(HIP, force=1e3).stress(angle=30, depth=1.0), "angle = 30 is .* are 0.5236 radians$"),
    (lambda: bs.Exact().press(HIP, force=1e3).displacement(30), "angle = 30 is .* 30 degrees are 0.5236 radians$"),
    (lambda: bs.Exact().press(HIP, half_angle=40), "half_angle = 40 is .*; 40 degrees are 0.6981 radians$"),
)


def test_angles_up_to_half_a_turn_are_accepted():
    angles = numpy.array([0.0, 1.0, numpy.pi, -1.0, numpy.nan])
    assert PRESSED.pressure(angles)[:3].tolist() == [PRESSED.pressure(0.0), 0.0, 0.0]
    assert PRESSED.pressure(numpy.float32(numpy.pi)) == 0.0
