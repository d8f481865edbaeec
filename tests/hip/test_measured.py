"""Tables as OpenSim and OrthoLoad write them: sides, frames, units, what is cut out; and files with activities."""

import re
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Frame, Mix, iso_14242_1, named_cycle
from ballsocket.hip.cycle_file import Reading, read_cycle
from ballsocket.hip.file import read_hip
from ballsocket.hip.sliding import rotation_matrices, slide

from ..cli.command import run
from .test_file import TEXT, told

PHASES = np.linspace(0.0, 1.0, 201)
ISO = iso_14242_1()
ANGLES = np.degrees(ISO.angles(PHASES))
FORCE = np.stack([0.1 * ISO.force(PHASES), 200 * np.sin(2 * np.pi * PHASES), ISO.force(PHASES)])
"""On the socket, to the side, to the front and upwards."""
UP = np.array([0.0, 0.0, 1.0])


def opensim(path, columns, time=1.1 * PHASES, header="nRows=201\nnColumns=4\ninDegrees=yes"):
    """A storage of OpenSim, after a column that is not asked for."""
    rows = np.column_stack([time, np.zeros(len(time)), *columns.values()])
    heads = "\t".join(["time", "pelvis_tilt", *columns])
    lines = ["\t".join(f"{number:.9g}" for number in row) for row in rows]
    path.write_text("\n".join([path.stem, "version=1", header, "endheader", heads, *lines]) + "\n")
    return path


def coordinates(path, side="r", **words):
    names = (f"hip_{name}_{side}" for name in ("flexion", "adduction", "rotation"))
    return opensim(path, dict(zip(names, ANGLES, strict=True)), **words)


def reactions(path, side="r", on="femur", frame="pelvis", force=-FORCE, **words):
    """OpenSim's axes are to the front, upwards and to the right."""
    lateral, front, up = force
    axes = {"x": front, "y": up, "z": lateral if side == "r" else -lateral}
    name = f"hip_{side}_on_{on}" + (f"_{side}" if on == "femur" else "")
    frame = f"{frame}_{side}" if frame == "femur" else frame
    return opensim(path, {f"{name}_in_{frame}_f{axis}": axes[axis] for axis in "xyz"}, **words)


def orthoload(path, force, parting=";", comma=True, units=True):
    heads = ["Time", "Fx", "Fy", "Fz", "F", "Mx"]
    rows = np.column_stack([PHASES, *force, np.linalg.norm(force, axis=0), 0 * PHASES])
    lines = [parting.join(f"{number:.6f}".replace(".", "," if comma else ".") for number in row) for row in rows]
    below = [parting.join(["[s]", *["[N]"] * 4, "[Nm]"])] if units else []
    path.write_text("\n".join(["Patient H1L, level walking", "", parting.join(heads), *below, *lines]))
    return path


def in_femur(force):
    return np.einsum("nji,jn->in", rotation_matrices(ISO.angles(PHASES).T), force)


@pytest.mark.parametrize("side", ["r", "l"])
@pytest.mark.parametrize(("on", "frame"), [("femur", "pelvis"), ("pelvis", "pelvis"), ("femur", "femur")])
def test_coordinates_and_reactions_of_opensim(tmp_path, side, on, frame):
    force = FORCE if frame == "pelvis" else in_femur(FORCE)
    files = [
        coordinates(tmp_path / "ik.mot", side),
        reactions(tmp_path / "loads.sto", side, on, frame, force if on == "pelvis" else -force),
    ]
    cycle = read_cycle(files, 100, reading=Reading(side=bs.Side.RIGHT if side == "r" else bs.Side.LEFT))
    assert cycle.duration == pytest.approx(1.1)
    expected = np.stack(
        [0.1 * ISO.force_magnitudes, 200 * np.sin(2 * np.pi * ISO.phases), ISO.force_magnitudes], axis=1
    )
    assert cycle.forces == pytest.approx(expected, abs=3.0)
    assert slide(14.0, cycle.rotation_increments, UP) == pytest.approx(
        slide(14.0, ISO.rotation_increments, UP), rel=1e-3
    )


def test_the_states_of_opensim_in_radians(tmp_path):
    names = (f"/jointset/hip_r/hip_{name}_r/value" for name in ("flexion", "adduction", "rotation"))
    states = opensim(
        tmp_path / "states.sto", dict(zip(names, np.radians(ANGLES), strict=True)), header="nRows=201\ninDegrees=no"
    )
    cycle = read_cycle([states, reactions(tmp_path / "loads.sto")])
    assert slide(14.0, cycle.rotation_increments, UP) == pytest.approx(
        slide(14.0, ISO.rotation_increments, UP), rel=1e-3
    )


def test_one_step_is_cut_out_of_a_walk(tmp_path):
    long = np.linspace(-0.3, 1.7, 401)
    force = np.stack([0 * long, 0 * long, ISO.force(long % 1.0)])
    file = reactions(tmp_path / "loads.sto", force=-force, time=long, header="nRows=401")
    cycle = read_cycle(file, reading=Reading(begin=0.2, end=1.2))
    assert cycle.duration == pytest.approx(1.0)
    assert cycle.forces[:, 2] == pytest.approx(ISO.force((ISO.phases + 0.2) % 1.0), abs=20.0)
    with pytest.raises(ValueError, match="from 0.2 to 3 is not allowed: time goes from -0.3 to 1.7"):
        read_cycle(file, reading=Reading(begin=0.2, end=3.0))


@pytest.mark.parametrize(("parting", "comma", "units"), [(";", True, True), ("\t", False, True)])
def test_loads_of_orthoload_act_on_the_ball_and_turn_with_it(tmp_path, parting, comma, units):
    file = orthoload(tmp_path / "h1l.csv", -in_femur(FORCE), parting, comma, units)
    cycle = read_cycle(file, reading=Reading(motion=ISO))
    assert cycle.forces[:, 2] == pytest.approx(ISO.force_magnitudes, abs=3.0)
    assert cycle.forces[:, 0] == pytest.approx(0.1 * ISO.force_magnitudes, abs=3.0)
    assert any("the motion is that of iso-14242-1" in note for note in cycle.notes)
    mirrored = -in_femur(FORCE) * [[-1.0], [1.0], [1.0]]
    with_left = read_cycle(orthoload(tmp_path / "left.csv", mirrored), reading=Reading(side=bs.Side.LEFT))
    assert with_left.forces == pytest.approx(read_cycle(file).forces, abs=1e-3)


def test_loads_in_the_frame_of_the_cup(tmp_path):
    file = orthoload(tmp_path / "cup.csv", FORCE)
    cycle = read_cycle(file, reading=Reading(frame="cup", force_on="socket"))
    assert cycle.frame is Frame.CUP
    assert cycle.forces[:, 0] == pytest.approx(0.1 * ISO.force_magnitudes, abs=3.0)


def test_what_is_missing_at_the_end_is_spread_over_the_cycle(tmp_path):
    drifting = FORCE + np.array([[0.0], [0.0], [60.0]]) * PHASES
    file = reactions(tmp_path / "loads.sto", force=-drifting)
    with pytest.raises(
        ValueError, match="loads.sto: the cycle does not close: force_z begins with -300 N and ends with -360 N"
    ):
        read_cycle(file)
    cycle = read_cycle(file, reading=Reading(closing=0.05))
    assert cycle.force(np.array([0.0, 1.0]))[2] == pytest.approx(330.0, rel=1e-6)
    assert cycle.forces[:, 2] == pytest.approx(ISO.force_magnitudes + 30.0, abs=3.0)


@pytest.mark.parametrize(
    ("make", "refused"),
    [
        (lambda p: coordinates(p, header="nRows=201"), "the header does not say in what the angles are"),
        (lambda p: coordinates(p, header="nRows=300\ninDegrees=yes"), "the header tells of '300' rows, and 201 are"),
        (lambda p: coordinates(p, header="datarows 300\ninDegrees=yes"), "the header tells of '300' rows"),
        (lambda p: coordinates(p, "l"), "no column of the right hip, such as hip_flexion_r or hip_r_on_femur_"),
        (lambda p: reactions(p, frame="ground"), "in the ground's frame: let OpenSim express it in pelvis or femur"),
        (lambda p: coordinates(p), r"a column force \[N\], or force_x, force_y and force_z, is needed"),
        (lambda p: coordinates(p, time=np.sort(np.append(1.1 * PHASES[:-1], 9))), "time has a gap from"),
    ],
)
def test_storages_that_are_no_cycle(tmp_path, make, refused):
    with pytest.raises(ValueError, match=f"walk.sto: .*{refused}"):
        read_cycle(make(tmp_path / "walk.sto"))


def test_degrees_under_a_head_in_radians_are_no_hips(tmp_path):
    file = tmp_path / "walk.csv"
    lines = [f"{t:g},1000,{25 * np.cos(2 * np.pi * t):.6f}" for t in np.linspace(0, 1, 21)]
    file.write_text("\n".join(["time [s],force [N],flexion [rad]", *lines]), encoding="utf-8")
    with pytest.raises(ValueError, match="flexion goes to 1432°, and no hip turns further than 180°"):
        read_cycle(file)


def test_files_that_do_not_go_together(tmp_path):
    angles = coordinates(tmp_path / "ik.mot")
    short = reactions(tmp_path / "loads.sto", time=0.9 * PHASES)
    with pytest.raises(ValueError, match="goes from 0 to 1.1, and another one only from 0 to 0.9: use from and to"):
        read_cycle([angles, short])
    with pytest.raises(ValueError, match="the column flexion is in two files"):
        read_cycle([angles, angles])
    with pytest.raises(ValueError, match="angles are there, and the motion of iso-14242-1 is one too many"):
        read_cycle([angles, reactions(tmp_path / "all.sto")], reading=Reading(motion=ISO))


@pytest.mark.parametrize(
    ("words", "refused"),
    [
        ({"frame": "thigh"}, "frame 'thigh' is not known"),
        ({"force_on": "bone"}, "force_on 'bone' is not known"),
        ({"closing": 0.9}, "closing = 0.9 is not allowed"),
    ],
)
def test_readings_that_are_none(words, refused):
    with pytest.raises(ValueError, match=refused):
        Reading(**words)


# in a file

ACTIVITIES = """body_weight = "750 N"
[[activity]]
name = "walking"
instants = 40
per_year = 1e6
[[activity]]
name = "stairs-up"
instants = 40
per_year = 5e4
"""
CYCLE = TEXT[TEXT.index("[cycle]") : TEXT.index("[wear]")]
COUNTS = "cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]\n"


def test_activities_in_a_file(tmp_path):
    lines = ACTIVITIES.split("\n", 1)
    text = TEXT.replace(COUNTS, f"{lines[0]}\nyears = 2\nreport_years = [1, 2]\n").replace(CYCLE, lines[1])
    text = text.replace("[wear]", '[wear]\nring_width = "8 deg"')
    given = read_hip(told(tmp_path, text=text))
    assert isinstance(given.use.cycle, Mix)
    assert given.use.cycle.per_year == 1.05e6
    assert (given.cycles, given.report_at) == (2.1e6, (1.05e6, 2.1e6))
    seen = given.use.after(given.cycles, given.report_at).summary()["history"]
    assert [each["years"] for each in seen] == pytest.approx([1.0, 2.0])
    shown = run("hip", str(told(tmp_path, text=text))).stdout
    assert "walking + stairs-up: slide" in shown
    assert re.search(r"^ +1 +1\.05 .*\n +2 +2\.1 ", shown, flags=re.MULTILINE)
    shares = text.replace("per_year = 1e6", "share = 0.9").replace("per_year = 5e4", "share = 0.1")
    mix = read_hip(told(tmp_path, text="cycles_per_year = 2e6\n" + shares)).use.cycle
    assert mix.shares == pytest.approx((0.9, 0.1))
    assert mix.per_year == pytest.approx(2e6)


def test_a_cycle_as_a_multiple_of_the_bodys_weight(tmp_path):
    given = read_hip(
        told(tmp_path, ("instants = 100", 'instants = 100\nbody_weight = "800 N"\ntimes_body_weight = 2.5'))
    )
    assert given.use.cycle.largest_force == pytest.approx(2000.0, rel=1e-6)


def test_a_storage_beside_a_file(tmp_path):
    coordinates(tmp_path / "ik.mot", "l")
    reactions(tmp_path / "loads.sto", "l")
    given = read_hip(
        told(tmp_path, ('name = "iso-14242-1"', 'file = ["ik.mot", "loads.sto"]\nside = "left"\nfrom = 0\nto = 1.1'))
    )
    assert given.use.first.slide == pytest.approx(22.7, abs=0.1)  # the load leans by 6°


def test_a_machine_with_a_spring_in_a_file(tmp_path):
    changed = told(tmp_path, ('name = "iso-14242-1"', 'name = "iso-14242-4"\nmismatch = "3 mm"\nstiffness = "80 N/mm"'))
    spring = read_hip(changed).use.cycle.spring
    assert (spring.mismatch, spring.stiffness) == (3.0, 80.0)


@pytest.mark.parametrize(
    ("changes", "refused"),
    [
        ([('name = "iso-14242-1"', 'name = "walking"')], "the loads of 'walking' are multiples of the body's weight"),
        ([('name = "iso-14242-1"', 'name = "walking"\nmismatch = 4')], "'mismatch' beside the name 'walking' in"),
        (
            [("instants = 100", "instants = 100\ntimes_body_weight = 2")],
            "times_body_weight needs a body_weight",
        ),
        ([(CYCLE, f"{CYCLE}[[activity]]\nname = 'walking'\n")], r"\[cycle\] and \[\[activity\]\] are one too many"),
        ([(CYCLE, "[activity]\nname = 'walking'\n")], r"must be an array of tables: \[\[activity\]\]"),
        ([(CYCLE, "[[activity]]\nname = 'flexion'\n")], "needs per_year, how many cycles, or its share"),
        ([(CYCLE, "[[activity]]\nname = 'flexion'\nshare = 1\n")], "share is one of cycles_per_year, which is missing"),
        ([(CYCLE, "[[activity]]\nname = 'flexion'\nper_yaer = 1\n")], "'per_yaer' in ..activity.. is not known"),
        ([('name = "iso-14242-1"', "file = []")], r"file = \[\] names no table"),
        ([('name = "iso-14242-1"', 'name = "iso-14242-4"\nswing_load = 0')], "swing = 0 is not allowed"),
        ([("instants = 100", 'instants = 100\nbody_weight = "1 MN"')], "body_weight = 1e.06 is not allowed"),
        ([(COUNTS, "years = 3\n")], "years needs activities with counts a year"),
    ],
)
def test_activities_that_are_none(tmp_path, changes, refused):
    with pytest.raises(ValueError, match=refused):
        read_hip(told(tmp_path, *changes))


def test_a_named_motion_is_that_of_its_name(tmp_path):
    orthoload(tmp_path / "loads.csv", -FORCE)
    changed = told(tmp_path, ('name = "iso-14242-1"', 'file = "loads.csv"\nmotion = "two-axis"\nframe = "body"'))
    cycle = read_hip(changed).use.cycle
    assert cycle.rotation_increments == pytest.approx(named_cycle("two-axis").rotation_increments, abs=1e-9)
    assert np.degrees(radians(cycle.duration)) == pytest.approx(1.0)
