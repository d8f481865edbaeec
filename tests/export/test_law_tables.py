"""Tables of the law: a pivot for ROSS, both signs along two axes, and user subroutines of Adams and Simpack."""

import ctypes
import subprocess
from shutil import copytree, which

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import ContactState, ForceElement, Friction
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library

from ..cli.command import printed, run
from ..joints import HIP
from ..places import DATA, EXAMPLES
from .library import load_module, needs_compiler, table, written

PIVOT = bs.joints["tilting-pad-pivot"]
ROUGH = ForceElement(bs.HessForsbach(), HIP, friction=Friction(coefficient=0.05))
STATE = (0.03, 0.0, 0.12), (1.0, 0.0, 20.0), (0.0, 1.0, 2.0)
LOAD = ROUGH(*STATE)


@pytest.fixture(scope="module")
def pivot(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pivot")
    printed("export", "ross", "tilting-pad-pivot", "--force", "20 kN", "--out", "pivot", folder=folder)
    return folder / "pivot"


def test_a_pivot_has_the_stiffness_of_exact_and_the_error_of_hertz(pivot):
    """The table is interpolated in logarithms between 201 forces: within 1e-5 of the solution."""
    module, forces = load_module(pivot, "pivot_ross"), np.array([5.0, 313.0, 3000.0, 19e3])
    contact, hertz = bs.Exact().press(PIVOT, force=forces), bs.Hertz().press(PIVOT, force=forces)
    depth, secant, tangent = module.pivot(forces)
    assert_allclose(1e3 * depth, contact.indentation, rtol=1e-4)
    assert_allclose(1e-3 * secant, forces / contact.indentation, rtol=1e-4)
    assert_allclose(1e-3 * tangent, contact.stiffness, rtol=1e-4)
    rows = table(pivot / "pivot_pivot.csv")
    for name, quantity in (("indentation", "indentation"), ("tangent_stiffness", "stiffness")):
        ratios = np.interp(np.log(forces), np.log(rows["force_N"]), rows[f"{name}_by_Hertz/{name}"])
        assert_allclose(ratios, getattr(hertz, quantity) / getattr(contact, quantity), rtol=1e-4)
    with pytest.raises(ValueError, match="the table has forces from"):
        module.pivot(25e3)


def test_ross_computes_the_pivot_with_the_options_of_the_module(pivot):
    deform = pytest.importorskip("ross.bearings.fluid_film.deform", reason="ross-rotordynamics 3 is not installed")
    module, force = load_module(pivot, "pivot_ross"), 3000.0

    def solve(kind, stiffness=0.0):
        sizes = 1e-3 * PIVOT.ball_diameter, 1e-3 * PIVOT.socket_diameter
        steel = 0.3, 210e9
        buffers = [force], [0.0], [0.0]
        return deform.deform_pivots(1, "pad_pivot_mechanical", kind, *steel, *sizes, [0.1], stiffness, *buffers)

    by_hertz = solve("ball_in_socket")
    contact = bs.Hertz().press(PIVOT, force=force)
    assert_allclose(by_hertz, [[1e-3 * contact.indentation], [1e3 * contact.stiffness]], rtol=1e-3)  # three digits
    depth, _, tangent = module.pivot(force)
    assert_allclose(solve(*module.static_pivot(force).values())[0], depth)
    assert_allclose(solve(*module.dynamic_pivot(force).values())[1], tangent)


def test_a_table_has_both_signs_along_a_tilted_load_and_across_it(tmp_path):
    """The ball meets the rim of a cup of 170° at 80° from the dome, and leaves the cup on the other side."""
    words = str(EXAMPLES / "hip.toml"), "--tilt", "80", "--arc-of-cover", "170"
    finished = run("export", "table", *words, "--out", "hip", folder=tmp_path)
    assert "the rim of the cup is in hip_axes.csv only" in finished.stderr
    rows = table(tmp_path / "hip" / "hip_axes.csv")
    joint, cup = bs.read_joint(EXAMPLES / "hip.toml").joint, bs.Cup(arc_of_cover=np.radians(170.0))
    element, tilt = ForceElement(bs.Tabulated(), joint, cup=cup), np.radians(80.0)
    for name, axis in (("along", (0.0, np.sin(tilt), np.cos(tilt))), ("across", (0.0, np.cos(tilt), -np.sin(tilt)))):
        load = element(rows["displacement_mm"][:, None] * np.array(axis))
        assert_allclose(rows[f"force_N_{name}"], load.force @ axis, rtol=1e-6, atol=1e-6)
    assert rows["force_N_along"][200] < -1000.0 < 0.0 < rows["force_N_along"][0] < 1000.0
    assert_allclose(rows["force_N_across"][0], 3000.0, rtol=1e-6)
    assert rows["force_N_across"][200] == 0.0


@needs_compiler
def test_the_user_subroutine_of_adams_has_the_loads_of_the_element(tmp_path):
    """A solver of a few lines calls it through the published interface."""
    written("adams", ROUGH, tmp_path, name="hip")
    copytree(DATA / "adams", tmp_path, dirs_exist_ok=True)
    strict = ("-Wall", "-Wextra", "-Werror", "-I.")
    path = shared_library(["hip.c", "hip_adams.c", "solver.c"], tmp_path / f"all{LIBRARY_ENDING}", tmp_path, strict)
    solver, result = ctypes.CDLL(str(path)), (ctypes.c_double * 6)()
    motion = (ctypes.c_double * 9).in_dll(solver, "motion")
    motion[:] = np.ravel(STATE)
    solver.call(result)
    assert_allclose(result, [*LOAD.force, *LOAD.moment], rtol=1e-12, atol=1e-9)
    assert ctypes.c_int.in_dll(solver, "stopped").value == 0
    motion[0] = np.nan
    solver.call(result)
    assert ctypes.c_int.in_dll(solver, "stopped").value == 1


@pytest.mark.skipif(which("gfortran") is None, reason="gfortran is not installed")
def test_the_user_subroutine_of_simpack_has_the_loads_of_the_element(tmp_path):
    """A harness in C calls it as Simpack does: force and torque act on the socket, in the axes of its marker."""
    written("simpack", ROUGH, tmp_path, name="hip")
    copytree(DATA / "simpack", tmp_path, dirs_exist_ok=True)
    sources = "hip.c", "harness.c", "simpack.f90", "hip_simpack.f90"
    library = tmp_path / f"all{LIBRARY_ENDING}"
    subprocess.run(["gfortran", "-Wall", "-shared", "-fPIC", *sources, "-o", library], cwd=tmp_path, check=True)
    solver = ctypes.CDLL(str(library))

    def numbers(name, count, kind=ctypes.c_double):
        return (kind * count).in_dll(solver, name)

    numbers("motion", 9)[:] = np.ravel(np.array(STATE) * [[1e-3], [1e-3], [1.0]])
    assert solver.call() == 0
    assert_allclose(numbers("force", 3), -np.array(LOAD.force), rtol=1e-12, atol=1e-9)
    assert_allclose(numbers("torque", 3), -1e-3 * np.array(LOAD.moment), rtol=1e-12, atol=1e-12)
    assert_allclose(numbers("ov", 3), (LOAD.half_angle, 1e6 * LOAD.max_pressure, ContactState.CONTACT), rtol=1e-12)
    assert list(numbers("sizes", 5, ctypes.c_int)) == [1, 0, 0, 3, 5]  # a force, three outputs, in the marker's axes
    assert list(numbers("kinds", 2, ctypes.c_int)) == [3, 4]
    numbers("motion", 9)[0] = np.nan
    assert solver.call() == 1
    ctypes.c_int.in_dll(solver, "refused").value = 1
    assert solver.call() == 1
