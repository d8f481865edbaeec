"""Cycles in files: text tables, tables of OpenSim and OrthoLoad, and the tables [cycle] and [[activity]]."""

from math import pi, radians
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.files.tables import read_table
from ballsocket.hip import Frame, Mix, iso_14242_1, named_cycle
from ballsocket.hip.config import read_hip
from ballsocket.hip.cycle_file import TableOptions, cycle_of, read_cycle
from ballsocket.hip.kinematics import rotation_matrices
from ballsocket.hip.schema import CycleTables

from ..cli.command import run
from ..refusals import edited, text_tables
from .hips import COUNTS, CYCLE, QUICK, hip, refuses, write_edited_file

PHASES = np.linspace(0.0, 1.0, 201)
ISO = iso_14242_1()
ANGLES = np.degrees(ISO.angles(PHASES))
FORCE = np.stack([0.1 * ISO.force(PHASES), 200 * np.sin(2 * np.pi * PHASES), ISO.force(PHASES)])
"""Force on the socket to the side, to the front and upwards."""
HEADS = "time [s],force [N],flexion [deg],adduction [deg],rotation [deg]"
FORCE_COLUMN = r"needs either a column force \[N\], or force_x, force_y and force_z"
LEFT = TableOptions(side=bs.Side.LEFT)
FORCE_HEADS = {"force [kN]": 2000.0, "force [BW]": 1500.0, "Force (N)": 2.0, '"force [ % BW ]"': 15.0}
TIME_STEPS = {"s": 0.1, "ms": 100.0, "min": 0.1 / 60}


# text tables


def write_table(path, change=lambda rows: rows, heads=HEADS):
    rows = np.column_stack([1.2 * PHASES, ISO.force(PHASES), *ANGLES])
    lines = [",".join(f"{number:.9g}" for number in row) for row in rows]
    return write_lines(path, f"# a comment\n{heads}", change(lines))


def write_lines(path, heads, lines):
    path.write_text("\n".join([heads, *lines]) + "\n", encoding="utf-8")
    return path


def test_a_table_of_iso_gives_the_cycle_of_iso(tmp_path):
    cycle = read_cycle(write_table(tmp_path / "walk.csv"))
    assert (cycle.name, cycle.n_steps, cycle.frame) == ("walk", 100, Frame.BODY)
    assert cycle.duration == pytest.approx(1.2)
    assert cycle.forces == pytest.approx(ISO.forces, abs=2.0)
    assert np.degrees(cycle.angles(PHASES)) == pytest.approx(ANGLES, abs=1e-6)
    assert cycle.midpoint_rotations == pytest.approx(ISO.midpoint_rotations, abs=1e-4)
    reordered = read_cycle(tmp_path / "walk.csv", 40, "zyx")
    assert reordered.midpoint_rotations == pytest.approx(iso_14242_1(40, "zyx").midpoint_rotations, abs=1e-4)


@pytest.mark.parametrize(
    ("heads", "values", "force", "seconds"),
    [
        *((f"phase [%],{head}", (10, 2), force, 1.0) for head, force in FORCE_HEADS.items()),
        *((f"time [{unit}],force [N]", (step, 700), 700.0, 1.0) for unit, step in TIME_STEPS.items()),
        ("time,force\ns,(kN)", (0.1, 0.7), 700.0, 1.0),
        ("Cycle [%],Time [s],Fx [N],Fy [N],Fz [N]", (10, 0.2, 0, 0, -700), 700.0, 2.0),
        ("Cycle[ % ],  Fx' [N],Fy (N),Fz [N]", (10, 0, 0, -700), 700.0, 1.0),
    ],
)
def test_columns_of_time_and_force_have_units(tmp_path, heads, values, force, seconds):
    """Units may stand below the heads; the time of OrthoLoad replaces its cycle column."""
    n_growing = len(values) - (3 if "Fx" in heads else 1)
    rows = [[x * (step if place < n_growing else 1) for place, x in enumerate(values)] for step in range(11)]
    lines = [",".join(f"{number:.12g}" for number in row) for row in rows]
    cycle = read_cycle(write_lines(tmp_path / "load.csv", heads, lines), body_weight=750.0)
    assert cycle.forces == pytest.approx(np.tile([0.0, 0.0, force], (100, 1)))
    assert cycle.duration == pytest.approx(seconds)


def test_three_components_of_the_force(tmp_path):
    heads = "phase [%],force_x [kN],force_y [kN],force_z [kN]"
    lines = [f"{100 * t},{0.1 * np.sin(2 * pi * t)},0.0,{2 + np.cos(2 * pi * t)}" for t in np.linspace(0, 1, 41)]
    path = write_lines(tmp_path / "load.csv", heads, lines)
    cycle = read_cycle(path)
    angle = 2 * pi * cycle.phases
    expected = np.column_stack([100 * np.sin(angle), 0 * angle, 2000 + 1000 * np.cos(angle)])
    assert cycle.forces == pytest.approx(expected, abs=3.0)
    assert not cycle.rotation_increments.any()
    assert "no columns of flexion, adduction, rotation: they are assumed to be 0" in cycle.notes[0]
    assert read_cycle(path, options=LEFT).forces == pytest.approx(cycle.forces * [-1, 1, 1], abs=1e-9)
    on_ball = read_cycle(path, options=TableOptions(force_on="ball")).forces
    assert on_ball == pytest.approx(-cycle.forces, abs=1e-9)


def replaced(row, new):
    """Change of a table in which a row has its own time and other cells."""
    return lambda rows: [*rows[:row], f"{rows[row].split(',')[0]},{new}", *rows[row + 1 :]]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: [*rows[:-1], f"1.2,{rows[100].partition(',')[2]}"], "force begins with 300 N and ends with 3000"),
        (lambda rows: [*rows[:-1], rows[-1].replace(",25,", ",20,", 1)], "flexion begins with 25° and ends with 20°"),
        (lambda rows: [*rows[:50], *rows[80:]], r"time has a gap from 0\.294 to 0\.48, 31 times the median step"),
        (replaced(7, "nan,0,0,0"), "line 10 has 'nan' for force"),
        (replaced(7, ",0,0,0"), "line 10 has nothing for force"),
        (replaced(7, "300,0,0"), "line 10 has nothing for rotation"),
        (lambda rows: [*rows[:9], rows[3], *rows[10:]], "time does not increase from row 9 to row 10"),
        (lambda rows: rows[:4], "4 lines below the heads; a cycle has 5 to 100000"),
        (lambda rows: [], "0 lines below the heads"),
    ],
)
def test_tables_that_are_not_a_cycle_are_rejected(tmp_path, change, message):
    refuses(f"walk.csv: .*{message}", read_cycle, write_table(tmp_path / "walk.csv", change))


def test_five_lines_are_enough_and_steps_may_differ_threefold(tmp_path):
    path = tmp_path / "a.csv"
    assert read_cycle(write_lines(path, "phase [%],force [N]", [f"{25 * k},5" for k in range(5)]))
    times = [0, 1, 2, 3, 5.9, 7]
    assert read_cycle(write_lines(path, "time [s],force [N]", [f"{t},5" for t in times])).duration == 7
    times[4] = 6.1
    with pytest.raises(ValueError, match="a gap from 3 to 6.1, 3.1 times the median step; allowed are 3 times"):
        read_cycle(write_lines(path, "time [s],force [N]", [f"{t},5" for t in times]))


*_, WRONG_HEADS = text_tables(Path(__file__).parent / "refused.txt")


@pytest.mark.parametrize(("old", "new", "message"), WRONG_HEADS)
def test_heads_that_are_incomplete_are_rejected(tmp_path, old, new, message):
    refuses(message, read_cycle, write_table(tmp_path / "walk.csv", heads=edited(HEADS, old, new)))


def test_files_beyond_a_hip_without_text_or_too_large_are_rejected(tmp_path):
    path = tmp_path / "walk.csv"

    def write(unit, force, amplitude):
        lines = [f"{t:g},{force},{amplitude * np.cos(2 * np.pi * t):.6f}" for t in np.linspace(0, 1, 21)]
        return write_lines(path, f"time [s],force [{unit}],flexion [rad]", lines)

    refuses("flexion goes to 1432°; allowed are angles up to 180°: check its unit", read_cycle, write("N", 1000, 25))
    refuses(r"force goes to 2e\+09 N; allowed are forces up to 1e\+09 N", read_cycle, write("kN", 2e6, 3.1))
    assert read_cycle(write("N", 2e6, 3.1)).largest_force == 2e6
    assert read_cycle(path).angles(np.array([0.0, 0.5]))[0] == pytest.approx([3.1, -3.1])
    refuses("the column force is in %BW: set body_weight", read_cycle, write("%BW", 200, 0.1))
    refuses("no table is named", read_cycle, [])


# OpenSim and OrthoLoad


def opensim(path, columns, time=1.1 * PHASES, header="nRows=201\nnColumns=4\ninDegrees=yes"):
    rows = np.column_stack([time, np.zeros(len(time)), *columns.values()])
    lines = ["\t".join(f"{number:.9g}" for number in row) for row in rows]
    heads = "\t".join(["time", "pelvis_tilt", *columns])
    return write_lines(path, f"{path.stem}\nversion=1\n{header}\nendheader\n{heads}", lines)


def coordinates(path, side="r", **words):
    names = (f"hip_{name}_{side}" for name in ("flexion", "adduction", "rotation"))
    return opensim(path, dict(zip(names, ANGLES, strict=True)), **words)


def test_a_motion_in_one_plane_is_named_in_every_answer(tmp_path):
    """Models of walking in the sagittal plane have flexion alone: cross-shear is 0 by assumption."""
    path = opensim(tmp_path / "plane.sto", {"hip_flexion_r": ANGLES[0]})
    use = hip(cycle=read_cycle([path, reactions(tmp_path / "reactions.sto")], 16), ring_width=QUICK["ring_width"])
    (note,) = (note for note in use.after(1e3).summary()["notes"] if "no columns" in note)
    assert note.startswith("the motion has no columns of adduction, rotation: they are assumed to be 0")
    assert "cross-shear and crossing angle mean nothing" in note
    complete = read_cycle([coordinates(tmp_path / "complete.sto"), reactions(tmp_path / "reactions.sto")])
    assert complete.notes == ()


def reactions(path, side="r", on="femur", frame="pelvis", force=-FORCE, **words):
    """Write joint reactions; the axes of OpenSim are to the front, upwards and to the right."""
    lateral, front, up = force
    axes = {"x": front, "y": up, "z": lateral if side == "r" else -lateral}
    name = f"hip_{side}_on_{on}" + (f"_{side}" if on == "femur" else "")
    frame = f"{frame}_{side}" if frame == "femur" else frame
    return opensim(path, {f"{name}_in_{frame}_f{axis}": axes[axis] for axis in "xyz"}, **words)


def orthoload(path, force, separator=";", comma=True):
    heads = separator.join(["Time", "Fx", "Fy", "Fz", "F", "Mx"])
    units = separator.join(["[s]", *["[N]"] * 4, "[Nm]"])
    rows = np.column_stack([PHASES, *force, np.linalg.norm(force, axis=0), 0 * PHASES])
    lines = [separator.join(f"{number:.6f}".replace(".", "," if comma else ".") for number in row) for row in rows]
    return write_lines(path, f"Patient H1L, level walking\n\n{heads}\n{units}", lines)


def in_femur(force):
    return np.einsum("nji,jn->in", rotation_matrices(ISO.angles(PHASES).T), force)


@pytest.mark.parametrize("side", ["r", "l"])
@pytest.mark.parametrize(("on", "frame"), [("femur", "pelvis"), ("pelvis", "pelvis"), ("femur", "femur")])
def test_coordinates_and_reactions_of_opensim(tmp_path, side, on, frame):
    force = FORCE if frame == "pelvis" else in_femur(FORCE)
    loads = reactions(tmp_path / "loads.sto", side, on, frame, force if on == "pelvis" else -force)
    options = TableOptions(side=bs.Side.RIGHT if side == "r" else bs.Side.LEFT)
    cycle = read_cycle([coordinates(tmp_path / "ik.mot", side), loads], 100, options=options)
    assert (cycle.name, cycle.notes) == ("ik", ())
    assert cycle.duration == pytest.approx(1.1)
    front = 200 * np.sin(2 * np.pi * ISO.phases)
    expected = np.stack([0.1 * ISO.force_magnitudes, front, ISO.force_magnitudes], axis=1)
    assert cycle.forces == pytest.approx(expected, abs=3.0)
    assert np.degrees(cycle.angles(PHASES)) == pytest.approx(ANGLES, abs=1e-6)


def test_coordinates_of_opensim_in_radians(tmp_path):
    names = (f"/jointset/hip_r/hip_{name}_r/value" for name in ("flexion", "adduction", "rotation"))
    columns = dict(zip(names, np.radians(ANGLES), strict=True))
    states = opensim(tmp_path / "states.sto", columns, header="inDegrees=no")
    cycle = read_cycle([states, reactions(tmp_path / "loads.sto")])
    assert np.degrees(cycle.angles(PHASES)) == pytest.approx(ANGLES, abs=1e-6)


def test_one_cycle_is_cut_out_of_a_longer_record(tmp_path):
    long = np.linspace(-0.3, 1.7, 401)
    force = np.stack([0 * long, 0 * long, ISO.force(long % 1.0)])
    file = reactions(tmp_path / "loads.sto", force=-force, time=long, header="nRows=401")
    cycle = read_cycle(file, options=TableOptions(begin=0.2, end=1.2))
    assert cycle.duration == pytest.approx(1.0)
    assert cycle.forces[:, 2] == pytest.approx(ISO.force((ISO.phases + 0.2) % 1.0), abs=20.0)
    between = read_cycle(file, options=TableOptions(begin=0.2021, end=1.2021))
    assert between.duration == pytest.approx(1.0)
    assert between.force(np.zeros(1))[2, 0] == pytest.approx(ISO.force(np.array([0.2021]))[0], rel=1e-3)
    for words in ({"begin": 0.7}, {"end": 0.7}):
        assert read_cycle(file, options=TableOptions(**words)).duration == pytest.approx(1.0)
    for begin, end in ((0.2, 3.0), (-0.4, 0.6), (1.2, 0.2)):
        with pytest.raises(ValueError, match=f"from {begin:g} to {end:g} is not allowed: time goes from -0.3 to 1.7"):
            read_cycle(file, options=TableOptions(begin=begin, end=end))
    with pytest.raises(ValueError, match="lines between from and to = 4 is not allowed: a cycle has at least 5"):
        read_cycle(file, options=TableOptions(begin=0.2, end=0.211))


@pytest.mark.parametrize(("separator", "comma"), [(";", True), ("\t", False)])
def test_orthoload_forces_act_on_the_ball_and_rotate_with_it(tmp_path, separator, comma):
    file = orthoload(tmp_path / "h1l.csv", -in_femur(FORCE), separator, comma)
    cycle = read_cycle(file, options=TableOptions(motion=ISO))
    assert cycle.forces[:, ::2] == pytest.approx(np.outer(ISO.force_magnitudes, [0.1, 1.0]), abs=3.0)
    assert "the motion is that of iso-14242-1" in cycle.notes
    assert cycle.rotations == pytest.approx(ISO.rotations, abs=0)
    mirrored = orthoload(tmp_path / "left.csv", -in_femur(FORCE) * [[-1.0], [1.0], [1.0]])
    assert read_cycle(mirrored, options=LEFT).forces == pytest.approx(read_cycle(file).forces, abs=1e-3)
    (note,) = (note for note in read_cycle(file).notes if "force" in note)
    assert note.startswith("the force acts on the ball and is in the frame of the femur")
    on_cup = read_cycle(orthoload(tmp_path / "cup.csv", FORCE), options=TableOptions(frame="cup", force_on="socket"))
    assert not any("force" in note for note in on_cup.notes)
    assert on_cup.frame is Frame.CUP
    assert on_cup.forces[:, 0] == pytest.approx(0.1 * ISO.force_magnitudes, abs=3.0)
    assert read_cycle(tmp_path / "cup.csv").forces == pytest.approx(-on_cup.forces, abs=1e-9)
    with pytest.raises(ValueError, match="other body, socket or ball, state this by force_on"):
        hip(cycle=read_cycle(orthoload(tmp_path / "reversed.csv", FORCE), options=TableOptions(frame="cup")))


def test_the_difference_of_the_ends_is_distributed_over_the_cycle(tmp_path):
    drifting = FORCE + np.array([[0.0], [0.0], [60.0]]) * PHASES
    file = reactions(tmp_path / "loads.sto", force=-drifting)
    refuses("loads.sto: the cycle does not close: force_z begins with -300 N and ends wi", read_cycle, file)
    cycle = read_cycle(file, options=TableOptions(closing=0.05))
    assert cycle.force(np.array([0.0, 1.0]))[2] == pytest.approx(330.0, rel=1e-6)
    assert cycle.forces[:, 2] == pytest.approx(ISO.force_magnitudes + 30.0, abs=3.0)
    assert [TableOptions(closing=value).closing for value in (0.0, 0.5)] == [0.0, 0.5]
    assert TableOptions().closing == 0.01


MANY_ROWS = "nRows=300\ninDegrees=yes"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda p: coordinates(p, header="nRows=201"), "the header does not state the unit of angles"),
        (lambda p: coordinates(p, header=MANY_ROWS), "the header states '300' rows, but the file has 2"),
        (lambda p: coordinates(p, header=MANY_ROWS.replace("nRows=", "datarows ")), "the header states '300' rows"),
        (lambda p: coordinates(p, "l"), "no column of the right hip, such as hip_flexion_r or hip_r_on_femur_"),
        (lambda p: reactions(p, frame="ground"), "in the ground frame: let OpenSim express it in pelvis or femur"),
        (lambda p: coordinates(p), FORCE_COLUMN),
        (lambda p: opensim(p, {f"hip_r_on_{on}_in_pelvis_fx": PHASES for on in ("femur_r", "pelvis")}), "more than on"),
    ],
)
def test_opensim_files_that_are_not_a_cycle_are_rejected(tmp_path, make, message):
    refuses(f"walk.sto: .*{message}", read_cycle, make(tmp_path / "walk.sto"))


def test_tables_of_one_cycle_are_combined_at_the_times_of_the_first(tmp_path):
    angles = coordinates(tmp_path / "ik.mot")
    constant = np.tile([[0.0], [0.0], [-900.0]], 301)
    loads = reactions(tmp_path / "a.sto", force=constant, time=np.linspace(-0.1, 1.3, 301), header="nRows=301")
    assert read_cycle([angles, loads]).forces == pytest.approx(np.tile([0.0, 0.0, 900.0], (100, 1)))
    for time, span in ((0.9 * PHASES, "0 to 0.9"), (0.1 + 1.1 * PHASES, "0.1 to 1.2")):
        short = reactions(tmp_path / "short.sto", time=time)
        refuses(f"goes from 0 to 1.1, and another one only from {span}: use from and to", read_cycle, [angles, short])
    refuses("the column flexion is in two files", read_cycle, [angles, angles])
    with pytest.raises(ValueError, match="has angles, so the motion of iso-14242-1 cannot be used"):
        read_cycle([angles, reactions(tmp_path / "all.sto")], options=TableOptions(motion=ISO))
    by_phase = write_lines(tmp_path / "p.csv", "phase [%],force [N]", [f"{25 * k},5" for k in range(5)])
    refuses("one file has a column time and another one phase: they cannot be combined", read_cycle, [angles, by_phase])


# [cycle] and [[activity]]

ACTIVITY = '[[activity]]\nname = "{}"\ninstants = 16\nper_year = {}\n'
ACTIVITIES = ACTIVITY.format("walking", "1e6") + ACTIVITY.format("stairs-up", "5e4")


def parsed(folder=None, **cycle):
    return cycle_in({"cycle": cycle}, folder)


def cycle_in(content, folder=None):
    return cycle_of(read_table(content, CycleTables), folder)


def test_activities_in_a_hip_file(tmp_path):
    years = (COUNTS, 'body_weight = "750 N"\nyears = 2\nreport_years = [1, 2]\n')
    file = write_edited_file(tmp_path, years, (CYCLE, ACTIVITIES), ("[wear]", '[wear]\nring_width = "8 deg"'))
    hip = read_hip(file)
    assert isinstance(hip.use.cycle, Mix)
    assert hip.use.cycle.per_year == 1.05e6
    assert (hip.cycles, hip.report_at) == (2.1e6, (1.05e6, 2.1e6))
    history = hip.use.after(hip.cycles, hip.report_at).summary()["history"]
    assert [report["years"] for report in history] == pytest.approx([1.0, 2.0])
    assert "walking + stairs-up: slide" in run("hip", str(file)).stdout
    text = file.read_text(encoding="utf-8").replace("per_year = 1e6", "share = 0.9")
    shares = "cycles_per_year = 2e6\n" + text.replace("per_year = 5e4", "share = 0.1")
    mix = read_hip(write_edited_file(tmp_path, text=shares)).use.cycle
    assert (*mix.fractions, mix.per_year) == pytest.approx((0.9, 0.1, 2e6))


def test_a_cycle_has_instants_a_rotation_order_a_body_weight_and_parameters_with_units():
    assert (parsed(name="iso-14242-1").n_steps, parsed(name="iso-14242-1").order) == (100, "xyz")
    cycle = parsed(name="iso-14242-1", instants=24, rotation_order="rotation, adduction, flexion")
    assert (cycle.n_steps, cycle.order) == (24, "zyx")
    content = {"body_weight": "800 N", "cycle": {"name": "walking"}}
    assert cycle_in(content).largest_force == pytest.approx(1976.0, rel=1e-6)
    content["cycle"]["body_weight"] = "0.9 kN"
    assert cycle_in(content).largest_force == pytest.approx(2223.0, rel=1e-6)
    assert parsed(name="iso-14242-4", mismatch="3 mm").spring.mismatch == 3.0
    assert parsed(name="iso-14242-4", stiffness="80 N/mm").spring.stiffness == 80.0
    assert parsed(name="iso-14242-4", swing_load="0.1 kN").force(np.zeros(1))[0] == 100.0
    assert parsed(name="two-axis", force="1 kN").largest_force == pytest.approx(1000.0, abs=1e-3)
    assert parsed(name="constant-load", amplitude="10 deg").angles(np.zeros(1))[0, 0] == pytest.approx(radians(10))


@pytest.mark.parametrize("name", ["iso-14242-1", "walking"])
def test_loads_are_scaled_to_a_multiple_of_body_weight(name):
    for times, force in ((0.005, 4.0), (100, 8e4)):
        scaled = parsed(name=name, body_weight="800 N", times_body_weight=times)
        assert scaled.largest_force == pytest.approx(force, rel=1e-6)
    for times in (0, 101):
        with pytest.raises(ValueError, match="times_body_weight = .* not allowed: a load is above 0 and at most 100"):
            parsed(name=name, body_weight="800 N", times_body_weight=times)


def test_tables_beside_a_hip_file(tmp_path):
    files = coordinates(tmp_path / "ik.mot", "l"), reactions(tmp_path / "loads.sto", "l")
    words = {"file": ["ik.mot", "loads.sto"], "side": "left", "from": 0, "to": 1.1}
    cycle = parsed(tmp_path, **words)
    assert cycle.forces == pytest.approx(read_cycle(files, options=LEFT).forces, abs=0)
    assert cycle.name == "ik"
    for key in ("from", "to"):
        refuses("does not close", parsed, tmp_path, **words | {key: 0.5})
    refuses("closing = 0.6 is not allowed", parsed, tmp_path, **words, closing=0.6)
    refuses("side = 'lef' is not known; did you mean 'left'", parsed, tmp_path, **words | {"side": "lef"})


def test_the_motion_of_a_named_cycle_is_used(tmp_path):
    orthoload(tmp_path / "loads.csv", -FORCE)
    words = {"file": "loads.csv", "frame": "body", "rotation_order": "zyx", "instants": 40}
    cycle = parsed(tmp_path, **words, motion="two-axis")
    assert cycle.rotation_increments == pytest.approx(named_cycle("two-axis", 40, "zyx").rotation_increments, abs=1e-9)
    assert cycle.duration == pytest.approx(1.0)
    assert "the motion is that of two-axis" in cycle.notes
    standing = parsed(tmp_path, **words, motion="stand-up")
    assert standing.angles(np.zeros(1))[0, 0] == pytest.approx(radians(80.0))
    on_socket = parsed(tmp_path, **words, force_on="socket").forces
    assert on_socket == pytest.approx(-cycle.forces, abs=1e-9)
