"""Tables of the law: a pivot for ROSS, both signs along two axes, and user subroutines of Adams and Simpack."""

import ctypes
import subprocess
from shutil import which

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import ContactState, ForceElement, Friction
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library

from ..cli.command import printed, run
from ..joints import HIP
from ..places import EXAMPLES
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


HEADER = """
struct sAdamsGforce { int ID; int NPAR; const double *PAR; int I; int RM; int JFLOAT; };
typedef void adams_c_Gfosub(const struct sAdamsGforce *, double, int, int, double *);
void c_sysary(const char *name, const int *markers, int size, double *values, int *count, int *error);
void c_errmes(int error, const char *text, int id, const char *action);
"""
SOLVER = """
#include <string.h>
#include "slv_c_utils.h"
double motion[9]; int stopped = 0;
void c_sysary(const char *name, const int *markers, int size, double *values, int *count, int *error)
{
    const int speed = strcmp(name, "TVEL") == 0, spin = strcmp(name, "RVEL") == 0;
    *error = markers[0] != 11 || markers[1] != 20 || markers[2] != 20 || size != 3 + speed;
    memcpy(values, motion + 3 * speed + 6 * spin, 3 * sizeof(double));
    *count = 3;
}
void c_errmes(int error, const char *text, int id, const char *action)
{
    (void)text, (void)id;
    stopped |= error && strcmp(action, "STOP") == 0;
}
adams_c_Gfosub Hip_gforce;
void call(double *result)
{
    const struct sAdamsGforce gforce = {1, 0, 0, 11, 20, 21};
    Hip_gforce(&gforce, 0.0, 0, 0, result);
}
"""


@needs_compiler
def test_the_user_subroutine_of_adams_has_the_loads_of_the_element(tmp_path):
    """A solver of a few lines calls it through the published interface."""
    written("adams", ROUGH, tmp_path, name="hip")
    (tmp_path / "slv_c_utils.h").write_text(HEADER)
    (tmp_path / "solver.c").write_text(SOLVER)
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


SIMPACK = """
module simpack
    integer, parameter :: fclass_force = 1, knodef = 2, kforce_res_force_torque = 3, kforce_strst_none = 4
    integer, parameter :: kref_marker = 5
end module
"""
FORCES = """
#include <string.h>
double motion[9], force[3], torque[3], ov[3]; int sizes[5], kinds[2], refused = 0;
void spck_df_fclass_(const int *kind, int *error) { sizes[0] = *kind, *error = 0; }
void spck_df_forcepardim_(const int *size, int *error) { sizes[1] = *size, *error = 0; }
void spck_df_forcestdyndim_(const int *size, int *error) { sizes[2] = *size, *error = 0; }
void spck_df_forceovdim_(const int *size, int *error) { sizes[3] = *size, *error = 0; }
void spck_df_forcerefsys_(const int *system, int *error) { sizes[4] = *system, *error = 0; }
static int seen(double *out, int first, const int *to, const int *from, const int *reference)
{
    memcpy(out, motion + first, 3 * sizeof(double));
    return refused || *to != 22 || *from != 11 || *reference != 11;
}
void spck_av_dxyz_(double *d, double *out, int *to, int *from, int *ref, int *error)
{
    *error = seen(out, 0, to, from, ref);
}
void spck_av_vxyz_(double *v, double *rate, double *out, int *to, int *from, int *by, int *ref, int *error)
{
    *error = seen(out, 3, to, from, ref) || *by != 11;
}
void spck_av_wxyz_(double *w, double *out, int *to, int *from, int *ref, int *error)
{
    *error = seen(out, 6, to, from, ref);
}
typedef int *I;
typedef double *D;
typedef char *C;
typedef size_t Length;
void uforce20_type_(I, C, I, Length);
void uforce20_setup_(I, I, I, I, I, I, I, I, D, I, C, I, C, I, C, I, I, I, I, I, I, Length, Length, Length);
void uforce20_(I, I, I, I, I, I, I, D, I, I, D, D, D, I, D, D, D, D, D, I);
int call(void)
{
    static char name[30], names[90];
    int length = 30, none = 0, outputs = 3, id = 1, from = 11, to = 22, error = 0, task, units[3], unused;
    double time = 0.0, nothing[1];
    uforce20_type_(&length, name, &error, 30);
    for (task = 0; task < 2 && !error; task++)
        uforce20_setup_(&task, &none, &none, &outputs, &length, &id, &from, &to, nothing, &unused, name, &unused, name,
                        &unused, names, units, &kinds[0], &unused, &unused, &kinds[1], &error, 30, 30, 30);
    task = 0;
    if (!error && !memcmp(names + 30, "largest pressure, Pa", 20))
        uforce20_(&task, &none, &none, &none, &none, &outputs, &id, nothing, &from, &to, &time, nothing, nothing,
                  &unused, nothing, force, torque, ov, nothing, &error);
    return error;
}
"""


@pytest.mark.skipif(which("gfortran") is None, reason="gfortran is not installed")
def test_the_user_subroutine_of_simpack_has_the_loads_of_the_element(tmp_path):
    """A harness in C calls it as Simpack does: force and torque act on the socket, in the axes of its marker."""
    written("simpack", ROUGH, tmp_path, name="hip")
    (tmp_path / "simpack.f90").write_text(SIMPACK)
    (tmp_path / "harness.c").write_text(FORCES)
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
