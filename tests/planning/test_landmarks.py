"""Landmarks of a pelvis: files of 3D Slicer, pelvic frame, side and angles of a cup, and refusals."""

import json
from math import degrees, radians

import numpy as np
import pytest

from ballsocket.planning import HipPlan, Landmarks, cup_orientation, make_plan, orientation_of_axis, pelvic_frame
from ballsocket.planning.landmarks import read_landmarks
from ballsocket.problem.cup import Side

from ..refusals import refused_calls
from . import scans

NAMES, POINTS = scans.pelvis()


def oriented(names, points, **frame):
    landmarks = Landmarks(names=tuple(names), points=np.array(points))
    return cup_orientation(landmarks, pelvic_frame(landmarks, **frame))


def angles(cup):
    return degrees(cup.inclination), degrees(cup.anteversion)


def test_every_file_of_slicer_gives_the_same_points(tmp_path):
    for name, text in (
        *(("a.fcsv", scans.fcsv(NAMES, POINTS, system)) for system in ("LPS", "RAS", "0", "1")),
        *(("a.mrk.json", scans.markups(NAMES, POINTS, system)) for system in ("LPS", "RAS")),
        ("a.mrk.json", scans.markups(NAMES, POINTS, "LPS", unit="m", scale=1e-3)),
        ("a.mrk.json", scans.markups(NAMES, POINTS, "LPS", unit=["mm", "mm", "mm"])),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
        landmarks = read_landmarks(tmp_path / name)
        assert landmarks.names == tuple(NAMES)
        np.testing.assert_allclose(landmarks.points, POINTS, atol=1e-4)


def test_files_of_slicer_3_need_a_coordinate_system_and_points_without_a_position_are_skipped(tmp_path):
    path = tmp_path / "old.fcsv"
    path.write_text("# name = F\n# columns = label,x,y,z,sel,visible\nright ASIS,1,2,3,1,1\n")
    with pytest.raises(ValueError, match=r"old\.fcsv: the file states no coordinate system: give it, RAS or LPS"):
        read_landmarks(path)
    assert read_landmarks(path, coordinates="lps").points.tolist() == [[-1.0, -2.0, 3.0]]
    content = json.loads(scans.markups(NAMES, POINTS))
    content["markups"][0]["controlPoints"][3]["positionStatus"] = "undefined"
    (tmp_path / "a.mrk.json").write_text(json.dumps(content))
    assert len(read_landmarks(tmp_path / "a.mrk.json").names) == len(NAMES) - 1


@pytest.mark.parametrize("side", Side)
@pytest.mark.parametrize("pair", [(40.0, 15.0), (60.0, -5.0), (20.0, 35.0)])
def test_angles_in_the_pelvic_plane_do_not_depend_on_the_pose_in_the_scanner(side, pair):
    turn = scans.rotated(pitch=-12.0, roll=6.0, yaw=-9.0)
    found = oriented(*scans.pelvis(*pair, side=side.value, turn=turn, shift=(12.0, 200.0, -900.0)))
    assert angles(found.cup()) == pytest.approx(pair, abs=1e-9)
    assert found.side == found.cup().side == side
    assert found.residual == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("tilt", [-15.0, 0.0, 8.0])
def test_pelvic_tilt_to_the_front_reduces_the_operative_anteversion_by_its_own_size(tilt):
    """The pelvis rotates about the transverse axis, as the operative anteversion does (Murray 1993)."""
    names, points = scans.pelvis(45.0, 15.0, turn=scans.rotated(pitch=tilt, yaw=4.0))
    found = oriented(names, points, vertical=(0.0, 0.0, 2.0))
    _, front, up = found.frame.body_axes @ found.axis
    assert np.degrees([found.frame.tilt, found.frame.obliquity]) == pytest.approx([tilt, 0.0], abs=1e-9)
    assert degrees(np.arctan2(front, -up)) == pytest.approx(20.7536 - tilt, abs=1e-3)
    stated = oriented(names, points, pelvic_tilt=radians(tilt))
    assert angles(stated.cup()) == pytest.approx(angles(found.cup()), abs=1e-9)
    assert angles(found.cup(upright=False)) == pytest.approx((45.0, 15.0), abs=1e-9)


def test_a_symphysis_beside_the_middle_leaves_the_pelvic_plane_and_tubercles_of_any_spelling_replace_it():
    names, points = scans.pelvis(turn=scans.rotated(roll=6.0, yaw=-9.0))
    middle = oriented(names, points).frame.axes
    points[names.index("pubic symphysis")] += 3.0 * middle[0]
    np.testing.assert_allclose(oriented(names, points).frame.axes, middle, atol=1e-9)
    names = ["RASIS", "ASIS_L", "R pubic tubercle", "tubercle left", *(f"Cup Rim {k}" for k in range(8))]
    tubercles = POINTS[2] + [[25.0, 0, 0], [-25.0, 0, 0]]
    found = oriented(names, np.concatenate([POINTS[:2], tubercles, POINTS[3:]]))
    assert angles(found.cup()) == pytest.approx((42.0, 17.0), abs=1e-9)
    assert found.frame.tubercle_offset == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(ValueError, match="the right pubic tubercle lies to the left of the left one"):
        oriented(names, np.concatenate([POINTS[:2], tubercles[::-1], POINTS[3:]]))


def test_pelvic_obliquity_adds_to_the_inclination_of_the_higher_side():
    names, points = scans.pelvis(45.0, 0.0, turn=scans.rotated(roll=5.0))
    raised = oriented(names, points, vertical=(0.0, 0.0, 1.0))
    assert degrees(raised.frame.obliquity) == pytest.approx(5.0, abs=1e-9)
    assert angles(raised.cup()) == pytest.approx((50.0, 0.0), abs=1e-9)


def test_scatter_of_rim_points_gives_the_error_of_the_angles():
    """The standard error is that of repeated measurements."""
    noise = [np.random.default_rng(seed).normal(0.0, 0.8, (len(POINTS) - 3, 3)) for seed in range(60)]
    results = [oriented(NAMES, np.concatenate([POINTS[:3], POINTS[3:] + errors])) for errors in noise]
    scatter = np.std([angles(found.cup()) for found in results], axis=0)
    stated = degrees(np.sqrt(np.mean([found.angle_error**2 for found in results])))
    assert stated == pytest.approx(1.8 / 1.4, rel=0.4)
    assert scatter == pytest.approx([stated, stated], rel=0.35)
    assert make_plan(frame=results[0].frame).notes[0].startswith("the orientation of the cup is not known")


def test_notes_name_what_limits_the_angles():
    names, raised = [*SPINES, "right tubercle", "left tubercle", *NAMES[3:]], POINTS.copy()
    raised[5] += 8.0 * scans.axis(42.0, 17.0)
    uneven = np.concatenate([POINTS[:2], POINTS[2] + [[25.0, 0, 0], [-25.0, 0, 12.0]], POINTS[3:]])
    for landmarks, parts in (
        ((NAMES, raised), ("mm from their plane (rms), 'rim-3' ", "a standard error of ", "pelvic tilt is not known")),
        ((NAMES[:6], POINTS[:6]), ("three points on the rim leave no residual",)),
        ((names, uneven), ("tubercles are 12 mm apart across the line of the spines",)),
    ):
        found = oriented(*landmarks)
        notes = " ".join(map(str, HipPlan(frame=found.frame, orientation=found).notes))
        assert all(part in notes for part in parts), notes


def test_names_are_replaced_and_rims_of_both_sides_need_a_choice(tmp_path):
    both = [*("F-1", "F-2", "F-3"), *(f"right {name}" for name in NAMES[3:]), *(f"left rim {k}" for k in range(8))]
    points = np.concatenate([POINTS, scans.pelvis(50.0, 10.0, side="left")[1][3:]])
    path = tmp_path / "a.fcsv"
    path.write_text(scans.fcsv(both, points))
    landmarks = read_landmarks(path, rename={"right_asis": "F-1", "left_asis": "F-2", "symphysis": "F-3"})
    frame = pelvic_frame(landmarks)
    for side, expected in (("left", (50.0, 10.0)), ("right", (42.0, 17.0))):
        assert angles(cup_orientation(landmarks, frame, side=side).cup()) == pytest.approx(expected, abs=1e-4)
    for call, message in (
        (lambda: cup_orientation(landmarks, frame), "rim points of both sides: choose the side, right or left"),
        (lambda: cup_orientation(landmarks, frame, side="port"), "side = 'port' is not allowed: right or left"),
        (lambda: read_landmarks(path, coordinates="ijk"), "coordinates = 'ijk' is not allowed: RAS or LPS"),
        (lambda: read_landmarks(path, rename={"asis": "F-1"}), "landmark 'asis' is not known"),
        (lambda: read_landmarks(path, rename={"rim": "F-9"}), "point 'F-9' does not"),
    ):
        with pytest.raises(ValueError, match=message):
            call()


def changed(row, point):
    return np.concatenate([POINTS[:row], [point], POINTS[row + 1 :]])


def inwards():
    """Plan of a cup that opens to the middle."""
    frame = pelvic_frame(Landmarks(names=tuple(NAMES), points=POINTS))
    axis = orientation_of_axis(np.array([-0.5, 0.0, -0.87]), np.array([90.0, 0, 0]), frame, signed=True)
    return HipPlan(frame=frame, orientation=axis)


SPINES, RIM = ["RASIS", "LASIS"], POINTS[3:] - [90.0, 0, 0]


test_impossible_landmarks_are_refused_in_a_sentence = refused_calls(
    (lambda: oriented(NAMES[1:], POINTS[1:]), "the landmarks lack the right ASIS; the points are left ASIS, pubic"),
    (lambda: oriented(["a", "b", "c"], POINTS[:3]), "lack the right ASIS, the left ASIS, the pubic symphysis or"),
    (lambda: oriented([*SPINES, "left tubercle", *NAMES[3:]], POINTS), "the pubic symphysis or both pubic tuberc"),
    (lambda: oriented(NAMES[:5], POINTS[:5]), "lack the cup's rim: 2 of at least 3 points with names like rim-1"),
    (lambda: oriented([NAMES[1], NAMES[0], *NAMES[2:]], POINTS), "right ASIS lies to the left of the left one"),
    (lambda: oriented(NAMES, POINTS * [-1.0, -1.0, 1.0]), "mirrored, or the file is in LPS coordinates where it"),
    (lambda: oriented(NAMES, POINTS * [1.0, 1.0, -1.0]), "the pubis lies above the spines"),
    (lambda: oriented(NAMES, changed(2, POINTS[:2].mean(axis=0))), "pubis is .* mm from the line through both"),
    (lambda: oriented(NAMES, POINTS / 1000.0), r"spines are 0\.2\d* mm apart: 100 to 400 mm are allowed"),
    (lambda: oriented([*NAMES, "RASIS"], [*POINTS, POINTS[0]]), "2 points are the landmark right_asis"),
    (lambda: oriented(NAMES[:6], changed(5, 2 * POINTS[4] - POINTS[3])[:6]), "3 points of the rim lie on a line"),
    (lambda: oriented([*NAMES[:3], *(f"left {n}" for n in NAMES[3:])], POINTS), "90 mm to the right of the middle"),
    (lambda: oriented(NAMES, np.concatenate([POINTS[:3], RIM])), " mm from the middle of the pelvis: state"),
    (lambda: oriented(NAMES, POINTS, vertical=(0, 0, -1)), "vertical is 180° from the pelvic plane's up: at most"),
    (lambda: oriented(NAMES, POINTS, vertical=(0, 0, 0)), "a direction with a length"),
    (lambda: oriented(NAMES, POINTS, vertical=(0, 0, 1), pelvic_tilt=0.1), "vertical or pelvic_tilt .* got both"),
    (lambda: oriented(NAMES, POINTS, pelvic_tilt=float("nan")), "at most 60° are allowed"),
    (inwards, r"inclination is -[23]\d\.\d°: 0 to 90° are allowed, opening downwards and to the r"),
)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "", "landmarks are read from .fcsv and .mrk.json files"),
        ("a.fcsv", "# CoordinateSystem = RAS\n", "a.fcsv has no points"),
        ("a.fcsv", scans.fcsv(NAMES, POINTS, "2"), "coordinate system '2' is not read: RAS"),
        ("a.fcsv", scans.fcsv(NAMES, POINTS)[:-25], "a row of .* columns is incomplete"),
        ("a.fcsv", scans.fcsv(NAMES, POINTS * np.nan), "'right ASIS' at nan, nan, nan is not allowed"),
        ("a.fcsv", scans.fcsv(NAMES, POINTS).replace("-125.0000", "12mm", 1), "point 'right ASIS' has no three numb"),
        ("a.fcsv", scans.fcsv(NAMES, POINTS).replace(",label", ",name"), "the columns lack label"),
        ("a.mrk.json", scans.markups(NAMES, POINTS)[:-60], "a.mrk.json: not JSON, or truncated"),
        ("a.mrk.json", "[" * 100_000, "not JSON, or truncated"),
        ("a.mrk.json", "[]", "the list `markups` of a 3D Slicer file is missing"),
        ("a.mrk.json", '{"markups": [{"coordinateSystem": "LPS", "controlPoints": [3]}]}', "not an object: 3"),
        ("a.mrk.json", scans.markups(NAMES, POINTS, unit="inch"), "coordinateUnits = 'inch' is not allowed"),
        ("a.mrk.json", scans.markups(NAMES, POINTS, scale=np.inf), "is not allowed: coordinates are finite"),
        ("a.mrk.json", scans.markups(NAMES, POINTS).replace("[-125.0", "[1.0, -125.0", 1), "three coordinates, got 4"),
        ("a.mrk.json", "x" * 10_000_001, "has more than 10 MB, the most that is read"),
    ],
)
def test_damaged_files_are_refused_with_their_name(tmp_path, name, text, message):
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_landmarks(tmp_path / name)
