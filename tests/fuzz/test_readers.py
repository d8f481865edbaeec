"""Readers of files and units: every input gives a result or a one-sentence refusal within seconds."""

import io
import os
from contextlib import contextmanager, redirect_stderr
from functools import reduce
from math import cos
from pathlib import Path
from unittest import mock

import numpy
import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from ballsocket.cli import root
from ballsocket.core.input_files import restriction_variables
from ballsocket.core.kinds import Kind
from ballsocket.core.storage.atomic_files import read_arrays
from ballsocket.elasticity.off_axis.scans import read_scan
from ballsocket.evidence.question import read_question
from ballsocket.files.units import parse
from ballsocket.hip.config import read_hip
from ballsocket.hip.cycle_file import TableOptions, read_cycle
from ballsocket.hip.wear_law import wear_factor, wear_per_energy, wear_per_slide
from ballsocket.identification.file import read_identify
from ballsocket.mcp.call import command_line
from ballsocket.planning import fit_liner, read_mesh

from ..cli.command import run
from ..places import EXAMPLES
from ..planning.scans import ascii_stl, binary, liner
from . import damage
from .limits import check_command, check_run, check_sentence, folder_with, inputs, within_limits
from .words import mistyped, number, odd_text, quantity


def printed(message):
    """Return a message as the command line prints it."""
    with redirect_stderr(io.StringIO()) as error:
        root.print_message(message)
    return error.getvalue().removeprefix("ballsocket: ").removesuffix("\n")


@contextmanager
def refused_in_a_sentence(files=None):
    """Yield a folder with files; check that errors are those that the command line prints in one sentence."""
    with folder_with(files or {}) as folder, within_limits(), numpy.errstate(all="ignore"):
        try:
            yield folder
            event("read")
        except OSError as error:
            check_sentence(printed(f"{error.filename}: {error.strerror}"))
        except ValueError as error:
            check_sentence(printed(str(error)))
        except (ArithmeticError, MemoryError) as error:
            check_sentence(printed(str(error)) or "too large")


PHASES = numpy.linspace(0.0, 1.0, 11)
_rows = [f"{t:.4g},{2000 + 900 * cos(6.2832 * t):.4g},{20 * (t - t * t):.4g},0,0" for t in PHASES]
CSV = "\n".join(["time [s],force [N],flexion [deg],adduction [deg],rotation [deg]", *_rows]).encode()
ORTHOLOAD = b"\n".join(
    [b"Cycle\tFx\tFy\tFz\tF", b"[%]\t[N]\t[N]\t[N]\t[N]"]
    + [f"{10 * i}\t{100 + i * (10 - i)}\t{-50}\t{-2000 - i * (10 - i)}\t2000".encode() for i in range(11)]
)
REACTIONS = b"\t".join(b"hip_r_on_femur_r_in_pelvis_f" + axis for axis in (b"x", b"y", b"z"))
STO = b"\n".join(
    [b"walk", b"version=1", b"nRows=11", b"nColumns=7", b"inDegrees=yes", b"endheader"]
    + [b"time\thip_flexion_r\thip_adduction_r\thip_rotation_r\t" + REACTIONS]
    + [f"{i / 10}\t{i * (10 - i) / 3:.3g}\t1\t0\t50\t2000\t100".encode() for i in range(11)]
)
HIPS = (
    b'joint = "hip-28"\ncycles = 1e6\nreport_at = [1e6]\n[cup]\ntilt = "30 deg"\n[cycle]\nfile = "cycle.csv"\n'
    b'instants = 12\n[wear]\nlaw = "archard"\ncoefficient = "1e-6 mm^3/(N m)"\nring_width = "10 deg"\n',
    b'joint = "hip-28"\n[cycle]\nname = "iso-14242-1"\ninstants = 10\n[wear]\nlaw = "cross-shear"\ncoefficient = 1e-6\n'
    b'circular = 2e-6\nring_width = 10\n[film]\nviscosity = "0.003"\n'
    b'ball_roughness = "10 nm"\ncup_roughness = "1 um"\n',
    b'joint = "hip-28"\nbody_weight = "800 N"\ncycles_per_year = 1e6\nyears = 3\nreport_years = [3]\n'
    b'[wear]\nlaw = "energy"\ncoefficient = "1e-5 mm^3/J"\nfriction = 0.05\nring_width = 10\n'
    b'[[activity]]\nname = "walking"\nshare = 0.9\n'
    b'instants = 10\n[[activity]]\nname = "stairs-up"\nper_year = 1e4\ninstants = 10\n',
    *((EXAMPLES / name).read_bytes() for name in ("hip_in_use.toml", "hip_of_many.toml")),
    (EXAMPLES / "wear_test.toml").read_bytes().replace(b'law = "archard"', b"coefficient = 1e-6"),
)
MEASURED = (
    b'joint = "hip-28"\n[free]\nclearance = "0.02..0.3 mm"\nliner.young = {median = "1 GPa", factor = 1.5}\n'
    b'[machine.m]\ncompliance = "0.1 um/kN"\noffset = "-1..1 um"\n[[data]]\nfile = "points.csv"\nuncertainty = "2 %"\n'
    b'machine = "m"\n[[data]]\nquantity = "area"\nvalues = ["50 mm^2", "90 mm^2"]\nforce = ["500 N", "1 kN"]\n'
    b'uncertainty = "5 mm^2"\n',
    (EXAMPLES / "measured_areas.toml").read_bytes(),
)
POINTS = (
    b"force_N,indentation_um\n500,20\n1000,31\n2000,45\n",
    b"# a remark\nforce [kN],half_angle [deg],half_angle_uncertainty_deg\n0.5,20,1\n1,25,1\n2,31,1\n",
)


@inputs(20)
@given(
    text=damage.coefficient | quantity | odd_text,
    read=st.sampled_from((wear_factor, wear_per_energy, wear_per_slide)),
    kind=st.sampled_from(tuple(Kind)),
)
def test_coefficients_and_quantities(text, read, kind):
    with refused_in_a_sentence():
        assert read("coefficient", text) >= 0
    with refused_in_a_sentence():
        parse("number", text, kind)


@inputs(6)
@given(raw=damage.table_of(CSV, ORTHOLOAD, STO), side=st.sampled_from((None, 700.0)))
def test_cycle_tables(raw, side):
    with refused_in_a_sentence({"cycle.csv": raw}) as folder:
        cycle = read_cycle(folder / "cycle.csv", n_steps=12, body_weight=side, options=TableOptions(closing=0.5))
        assert numpy.isfinite(numpy.asarray(cycle.force(PHASES))).all()


@inputs(5)
@given(raw=damage.file_of(*HIPS), table=damage.table_of(CSV))
def test_hip_files(raw, table):
    with refused_in_a_sentence({"hip.toml": raw, "cycle.csv": table}) as folder:
        read_hip(folder / "hip.toml")


@inputs(1)
@given(raw=damage.file_of(*HIPS[:3]), table=damage.table_of(CSV))
def test_hips_in_use(raw, table):
    check_command({"hip.toml": raw, "cycle.csv": table}, "hip", "hip.toml", "--json")


@inputs(5)
@given(raw=damage.file_of(*MEASURED), table=damage.table_of(*POINTS))
def test_measurements(raw, table):
    files = {"measured.toml": raw, **dict.fromkeys(("points.csv", "measured_areas.csv"), table)}
    files["measured_hip.toml"] = (EXAMPLES / "measured_hip.toml").read_bytes()
    with refused_in_a_sentence(files) as folder:
        read_identify(folder / "measured.toml")


@inputs(3)
@given(raw=damage.file_of((EXAMPLES / "evidence.toml").read_bytes()), hip=damage.file_of(*HIPS[:2]))
def test_questions_of_evidence(raw, hip):
    with refused_in_a_sentence({"question.toml": raw, "hip_in_use.toml": hip, "cycle.csv": CSV}) as folder:
        assert read_question(folder / "question.toml").files[0] == folder / "question.toml"


_angle, _azimuth = numpy.meshgrid(numpy.linspace(0.05, 1.2, 12), numpy.linspace(0, 6.28, 24))
_directions = [numpy.sin(_angle) * numpy.cos(_azimuth), numpy.sin(_angle) * numpy.sin(_azimuth), numpy.cos(_angle)]
POINTS_OF_BORE = 14.1 * numpy.stack(_directions, axis=-1).reshape(-1, 3)
ROWS = [" ".join(f"{x:.5f}" for x in point) for point in POINTS_OF_BORE]
FACES = [(i, i + 1, i + 12) for i in range(200)]
PLY = ["ply", "format ascii 1.0", f"element vertex {len(ROWS)}", *(f"property float {axis}" for axis in "xyz")]
PLY += [f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header", *ROWS]
PLY += [f"3 {i} {j} {k}" for i, j, k in FACES]
OBJ = ["v " + row for row in ROWS] + [f"f {i + 1} {j + 1} {k + 1}" for i, j, k in FACES]
MESHES = {"bore.ply": "\n".join(PLY).encode(), "bore.obj": "\n".join(OBJ).encode()}
MESHES["bore.stl"] = binary(POINTS_OF_BORE[numpy.array(FACES)])
MESHES |= {"liner.stl": binary(liner(steps=12, segments=24)), "ascii.stl": ascii_stl(liner(steps=6, segments=12))}
_wound = st.sampled_from((b"", b"\0", b"\xff\xff\xff\x7f", b"nan ", b"1e999 ", b"-", b"\n")) | st.binary(max_size=5)
wounds = st.lists(st.tuples(st.integers(0, 20_000), st.integers(0, 8), _wound), max_size=3)


@inputs(2)
@given(name=st.sampled_from(tuple(MESHES)), wounds=wounds, cut=st.integers(0, 4))
def test_scans(name, wounds, cut):
    pytest.importorskip("meshio")
    raw = reduce(lambda damaged, wound: damage.with_bytes(damaged, *wound), wounds, MESHES[name])
    for read in (read_scan, lambda path: fit_liner(read_mesh(path))):
        with refused_in_a_sentence({name: raw[: len(raw) // cut] if cut > 1 else raw}) as folder:
            read(folder / name)


_STREAM = io.BytesIO()
numpy.savez(_STREAM, rings=numpy.arange(12.0).reshape(3, 4), count=3, identity="run")
ARCHIVE = _STREAM.getvalue()


@inputs(5)
@given(bits=st.lists(st.integers(0, 8 * len(ARCHIVE) - 1), max_size=2), wounds=wounds)
def test_archives(bits, wounds):
    """An archive that can be read has all members, with the numbers that were written."""
    raw = bytearray(ARCHIVE)
    for bit in bits:
        raw[bit // 8] ^= 1 << bit % 8
    damaged = damage.with_bytes(bytes(raw), *wounds[0]) if wounds else bytes(raw)
    with refused_in_a_sentence({"kept.npz": damaged}) as folder:
        assert len(read_arrays(folder / "kept.npz")) == 3 or wounds


_argument = st.one_of(
    quantity, odd_text, number, st.floats(), st.integers(), st.booleans(), st.none(), st.lists(odd_text, max_size=3),
    st.sampled_from(("hip-28", "../x.toml", "/etc/passwd", "--help", "./" * 110 + "../x", "a.toml", "tabulated")),
)  # fmt: skip
_NAMES = mistyped(("press", "study", "wear", "identify", "curve", "models", "evidence"))
_KEYS = mistyped(("joint", "force", "model", "file", "steps", "indentation", "units"))
_arguments = st.dictionaries(_KEYS, _argument, max_size=4)
_contents = st.none() | damage.file_of(*HIPS[:2], *MEASURED)


@inputs(3)
@given(name=_NAMES, arguments=_arguments, content=_contents, runs=st.integers(0, 9))
def test_calls_of_assistants(name, arguments, content, runs):
    """A call is refused, or becomes a command that reads only files in its folder."""
    if content is not None:
        arguments = {**arguments, "content": content.decode("utf-8", "replace")}
    with refused_in_a_sentence() as folder:
        words = command_line(name, arguments, folder, root.load_commands())
        assert all(isinstance(word, str) for word in words)
        assert not any(Path(word).is_absolute() or word.startswith("..") for word in words)
        if runs or words[0] not in ("press", "models", "curve"):
            return
        with mock.patch.dict(os.environ, restriction_variables((folder, Path(os.environ["BALLSOCKET_CACHE"])))):
            check_run(run(*words, folder=folder))
