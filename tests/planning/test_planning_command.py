"""Command `planning`: table, joint file, JSON, and the refusal to derive a clearance."""

import re
from math import degrees, radians

import numpy as np
import pytest

from ballsocket import Cup, read_joint
from ballsocket.planning import HipPlan, fit_head, fit_liner, read_mesh

from ..cli.command import answer, printed, refusal
from . import scans


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plan")
    names, points = scans.pelvis(scatter=0.3, turn=scans.rotated(pitch=8.0))
    (folder / "pelvis.mrk.json").write_text(scans.markups(names, points))
    (folder / "anatomy.fcsv").write_text(scans.fcsv(names[:3], points[:3]))
    axis = scans.axis(42.0, 17.0)
    _, x, y = np.linalg.qr(np.column_stack([axis, [0, 1, 0], [0, 0, 1]]))[0].T
    turn = np.column_stack([x * np.sign(np.linalg.det([x, y, axis])), y, axis])
    liner = scans.liner(steps=24, segments=48)
    scan = (liner @ turn.T + [90.0, -40.0, -85.0]) @ scans.rotated(pitch=8.0).T + [5.0, -40.0, 900.0]
    (folder / "liner.stl").write_bytes(scans.binary(liner))
    (folder / "placed.stl").write_bytes(scans.binary(scan * [-1, -1, 1], b"3D Slicer output. SPACE=LPS"))
    (folder / "head.stl").write_bytes(scans.ascii_stl(scans.head(steps=16, segments=32)))
    (folder / "small.stl").write_bytes(scans.binary(scans.head(radius=14.0, steps=16, segments=32)))
    return folder


LANDMARKS, LINER, HEAD = ("--landmarks", "pelvis.mrk.json"), ("--liner", "liner.stl"), ("--head", "head.stl")


def test_a_stated_clearance_makes_a_joint_that_press_reads(folder):
    words = (*LANDMARKS, *LINER, *HEAD, "--clearance", "0.15 mm", "--pelvic-tilt", "8 deg", "--out", "joint.toml")
    text = printed("planning", *words, "--force", "3 kN", "--head-material", "cocr", folder=folder)
    assert re.search(r"inclination +4\d\.\d° +±0\.\d°, 8 rim points", text)
    file = read_joint(folder / "joint.toml")
    assert (file.joint.clearance, file.load) == (0.15, {"force": 3000.0})
    assert (file.joint.ball_radius, file.joint.liner_thickness) == pytest.approx((16.0, 8.0), abs=0.001)
    assert degrees(file.cup.arc_of_cover) == pytest.approx(170.0, abs=0.01)
    planned = Cup.from_angles(radians(42.0), radians(17.0), pelvic_tilt=radians(8.0))
    assert file.cup.inclination == pytest.approx(planned.inclination, abs=radians(0.5))
    assert file.cup.anteversion == pytest.approx(planned.anteversion, abs=radians(0.5))
    assert printed("press", "joint.toml", "--model", "hess-forsbach", folder=folder)


def test_json_has_all_results_and_an_stl_file_in_the_scan_orients_the_cup(folder):
    words = ("--landmarks", "anatomy.fcsv", "--liner", "placed.stl", "--vertical", "0,0,1")
    said = answer("planning", *words, folder=folder)
    assert {"valid", "error", "notes", "sources", "next"} <= set(said)
    assert (said["side"], said["pelvis"]["tilt_deg"]) == ("right", pytest.approx(8.0, abs=0.01))
    angles = said["cup"]["pelvic_inclination_deg"], said["cup"]["pelvic_anteversion_deg"]
    assert angles == pytest.approx((42.0, 17.0), abs=0.1)
    assert (said["liner"]["wall_thickness"], said["head"]) == (pytest.approx(8.0, abs=0.01), None)


def test_no_clearance_is_derived_from_two_files_which_must_fit(folder):
    sentence = "no clearance is derived from two files, because their radii are nominal: public sets give -0.098"
    small = refusal("planning", *LINER, "--head", "small.stl", folder=folder)
    assert re.search(r"radius 1[34]\.\d+ mm does not belong to the bore of radius 1[56]\.\d+ mm", small)
    assert sentence in " ".join(printed("planning", *LINER, *HEAD, folder=folder).split())


def test_a_joint_file_of_a_liner_alone_has_the_ball_that_the_clearance_leaves(folder):
    plan = HipPlan(liner=fit_liner(read_mesh(folder / "liner.stl")))
    file = plan.joint_file(0.1, ball="cocr")
    assert (file.joint.ball_radius, file.joint.socket_radius) == pytest.approx((15.9, 16.0), abs=1e-3)
    assert not file.cup.oriented
    assert "no clearance" not in " ".join(plan.notes)
    head = HipPlan(head=fit_head(read_mesh(folder / "head.stl")))
    assert head.joint_file(0.1, liner_thickness=6.0).joint.liner_thickness == 6.0
