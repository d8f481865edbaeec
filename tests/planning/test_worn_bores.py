"""Wear of a bore from points: a ball that is shifted into a sphere removes a volume of closed form."""

import re

import numpy as np
import pytest

from ballsocket.planning import PointCloud, measure_wear, read_points

from ..cli.command import answer, printed, refusal
from ..extent import some
from . import scans

SHAPES = {
    "small part worn": {"head": 15.8, "shift": 0.25, "tilt": 30.0},
    "most of the bore worn": {"head": 15.9, "shift": 0.4, "tilt": 10.0},
    "rim of the points unworn": {"head": 15.7, "shift": 0.5, "tilt": 20.0, "cover": 75.0},
    "deep": {"head": 15.9, "shift": 1.5, "tilt": 5.0, "cover": 95.0},
    "near the noise": {"head": 15.95, "shift": 0.1, "tilt": 5.0},
    "unworn": {"head": 15.9, "shift": 0.1},
}
SCANS = [(name, noise, count) for name in SHAPES for noise, count in ((0.0, 1500), (0.02, 4000), (0.005, 1500))]


@pytest.mark.parametrize(("name", "noise", "count"), some(SCANS, 3))
def test_the_errors_contain_the_removed_volume_and_the_penetration(name, noise, count):
    shape = SHAPES[name]
    head = shape["head"] if name == "unworn" else None  # a bore without wear shows this with its head alone
    wear = measure_wear(PointCloud(scans.worn_bore(count=count, noise=noise, **shape)), head_radius=head)
    volume, depth = scans.removed_volume(shape["head"], shape["shift"]), shape["shift"] + shape["head"] - 16.0
    # two standard errors: the truth is outside in 5 of 100 scans, outside twice as much in none
    assert abs(wear.volume - volume) < 2.0 * wear.volume_error
    assert abs(wear.depth - depth) < 2.0 * wear.depth_error
    assert abs(wear.radius - 16.0) < 2.0 * wear.radius_error
    assert name == "near the noise" or noise == 0.02 or wear.volume_error < 0.15 * volume + 5.0


@pytest.mark.parametrize(("tilt", "cover"), some([(0.0, 75.0), (10.0, 90.0), (0.0, 95.0), (60.0, 90.0)], 2))
def test_wear_by_a_head_of_the_bores_own_radius_is_in_the_errors(tilt, cover):
    """It leaves one sphere, or two of which either may be the unworn one; below the rim is (1 + cos tilt)/2 of it."""
    wear = measure_wear(PointCloud(scans.worn_bore(head=16.0, shift=0.1, tilt=tilt, cover=cover, noise=0.004)))
    volume = scans.removed_volume(16.0, 0.1) * (1.0 + np.cos(np.radians(tilt))) / 2.0
    assert abs(wear.volume - volume) < 1.5 * wear.volume_error
    assert abs(wear.depth - 0.1) < 1.5 * wear.depth_error
    sentence = "the worn part is a sphere too" if tilt == 60.0 else "the points do not show if the sphere is unworn"
    assert any(sentence in note for note in wear.notes)


def test_a_gap_in_the_points_is_named():
    points = scans.worn_bore(head=15.8, shift=0.25, tilt=0.0)
    gap = (points - scans.CENTRE) @ [1.0, 0.0, -1.0] > 16.0 * np.sqrt(2.0) * np.cos(np.radians(20.0))
    wear = measure_wear(PointCloud(points[~gap]))
    # the gap takes 1 - cos(20 deg) of the hemisphere, and moves the middle of the points
    assert wear.cover * (1.0 - np.cos(wear.reach)) == pytest.approx(np.cos(np.radians(20.0)), abs=0.02)
    assert any("their wear is not in the volume" in note for note in wear.notes)


POINTS = scans.worn_bore(head=15.8, shift=0.25, count=1000)
ROWS = [[f"{number:.4f}" for number in point] for point in POINTS]
PLAIN = "\n".join(" ".join(row) for row in ROWS)
TEXTS = {
    "a.xyz": PLAIN,
    "a.pts": f"{len(ROWS)}\n" + PLAIN.replace("\n", " 0.5\n"),
    "a.csv": "id,z [mm],y [mm],x [mm]\n" + "\n".join(",".join(["1", *row[::-1]]) for row in ROWS),
    "a.txt": "X;Y;Z\n" + PLAIN.replace(" ", ";").replace(".", ","),
    "a.asc": "// scan\n" + PLAIN.replace(" ", "\t").replace(".", ","),
    "b.csv": '"Prüfling","x","y","z"\n"","mm","mm","mm"\n' + "\n".join(f'"µ1",{",".join(row)}' for row in ROWS),
    "b.txt": PLAIN.replace(".", ","),
    "b.xyz": f"% µm\n{PLAIN}".replace(" ", ", "),
}


@pytest.mark.parametrize("name", TEXTS)
def test_points_are_read_as_machines_write_them(tmp_path, name):
    (tmp_path / name).write_text(TEXTS[name], encoding="cp1252")
    cloud = read_points(tmp_path / name)
    np.testing.assert_allclose(cloud.points, np.unique(POINTS.round(4), axis=0), atol=1e-9)
    assert bool(cloud.notes) == (name == "a.pts")


def text(points, head=""):
    return head + "\n".join(" ".join(f"{number:.6f}" for number in point) for point in points)


HEAD = POINTS - scans.CENTRE
HEAD = HEAD * (32.0 / np.linalg.norm(HEAD, axis=1) - 1.0)[:, None]
REFUSED = {
    "two columns": (text(POINTS[:, :2]), "line 1 has 2 cells, the line of heads 3"),
    "metres": (text(POINTS / 1000.0), r"0\.03\d* mm large: .* its unit may be m \(3\d(\.\d)? mm\)"),
    "metres in heads": (text(POINTS, "x_m y_m z_m\n"), "states the unit 'm' .* state --stl-units m"),
    "mixed units": (text(POINTS, "x_mm y_mm z_m\n"), "columns in different units, m and mm"),
    "other heads": (text(POINTS, "a b c\n"), "has the columns 'a', 'b', 'c': name three of them x, y and z"),
    "a word": (text(POINTS) + "\n1 2 x", "line 1001 has '1 2 x': that is no point"),
    "decimal commas between commas": (PLAIN.replace(".", ",").replace(" ", ","), "may separate numbers or decimals"),
    "two decimal marks": (PLAIN.replace(" ", ";") + "\n1,5;2;3", "it has decimal points and decimal commas"),
    "other number": ("2000\n" + text(POINTS), "first line states 2000 points, and it has 1000: save it again"),
    "few": (text(POINTS[:50]), "at least 200 points"),
    "plane": (text(POINTS * [1.0, 1.0, 0.0]), "is not a bore"),
    "head": (text(HEAD), "% of its points lie inside the sphere"),
    "radius of 100 mm": (text(scans.worn_bore(head=100.0, shift=0.0, radius=100.0, cover=40.0)), "a radius of 100 mm;"),
    "radius of 5 mm": (text(scans.worn_bore(head=6.5, shift=0.0, radius=6.5)), "of radius 6.5 mm; a bore has 7"),
    "cap": (text(scans.worn_bore(head=30.0, shift=0.0, cover=20.0, radius=30.0)), "a bore needs 25°"),
    "depth": (text(scans.worn_bore(head=12.0, shift=10.0)), "mm outside the sphere of radius 16.00 mm of its bore"),
    "whole liner": (text(scans.liner(steps=12, segments=24).reshape(-1, 3)), "is not a bore: its points lie"),
    "no points": ("# nothing", "has no points"),
}


@pytest.mark.parametrize(("content", "message"), REFUSED.values(), ids=REFUSED)
def test_points_of_no_bore_are_refused(tmp_path, content, message):
    (tmp_path / "a.xyz").write_text(content, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        measure_wear(read_points(tmp_path / "a.xyz"))


def test_the_command_prints_the_wear_with_its_error(tmp_path):
    (tmp_path / "a.xyz").write_text(PLAIN, encoding="utf-8")
    words = "planning", "--worn", "a.xyz"
    worn = answer(*words, "--head-diameter", "31.6", folder=tmp_path)["worn"]
    assert abs(worn["volume"] - scans.removed_volume(15.8, 0.25)) < worn["volume_error"]
    cover = re.search(r"points cover (\d+) % within 9\d° of their middle", printed(*words, folder=tmp_path))
    assert 90 < float(cover[1]) <= 100
    assert "head_diameter = 34 mm is not allowed" in refusal(*words, "--head-diameter", "34", folder=tmp_path)


def test_a_measured_head_acts_or_the_notes_say_that_it_does_not():
    """A head of the bore's own radius may hide a shift in an unworn sphere; the points of a worn bore exclude it."""
    unworn, worn = PointCloud(scans.worn_bore(shift=0.1, count=1500)), PointCloud(POINTS)
    alone, measured = measure_wear(unworn), measure_wear(unworn, head_radius=15.9)
    assert measured.volume_error < alone.volume_error
    assert measured.head_note in measured.notes
    assert "cannot have worn the sphere" in measured.head_note
    equal = measure_wear(unworn, head_radius=16.0)
    assert equal.volume_error == alone.volume_error
    same = measure_wear(worn, head_radius=14.0)
    assert (same.volume, same.volume_error) == (measure_wear(worn).volume, measure_wear(worn).volume_error)
    for bore in (equal, same):
        assert "changes no number" in bore.head_note
    assert re.search(r"the head, of 28 mm in a bore of 3[12]\.?\d* mm, changes", same.head_note)
