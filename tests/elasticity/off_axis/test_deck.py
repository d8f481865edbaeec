"""Tilted deck: its mesh, its text, and forces computed by CalculiX."""

import shutil
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import SphericalBlock, TiltedDeck, run

from ...cli.command import run as command
from ...extent import either

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")


def test_bricks_and_wedges_share_nodes_and_have_positive_volume():
    block = SphericalBlock(
        polar=np.linspace(0.0, pi / 2, 4),
        azimuth=np.linspace(0.0, pi, 5),
        radius=np.array([1.0, 1.2]),
        centre=np.zeros(3),
    )
    points = {int(number): block.points[:, *index] for index, number in np.ndenumerate(block.number) if number}
    for _, kind, _, nodes in block.elements():
        assert len(set(nodes)) == len(nodes) == {"C3D20R": 20, "C3D15": 15}[kind]
        corners = [points[node] for node in nodes[: 4 if kind == "C3D20R" else 3]]
        above = points[nodes[4 if kind == "C3D20R" else 3]]
        across = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
        assert across @ (above - corners[0]) > 0
        middle = points[nodes[8 if kind == "C3D20R" else 6]]
        assert middle == pytest.approx((corners[0] + corners[1]) / 2, abs=0.05)


@needs_ccx
@pytest.mark.parametrize(
    ("tilt", "size", "tolerance"),
    either(quick=[(45.0, 11.25, 0.01)], long=[(tilt, 7.5, 3e-3) for tilt in (0.0, 30.0, 60.0)]),
)
def test_calculix_gives_the_same_forces_in_three_dimensions(tilt, size, tolerance, tmp_path):
    deck = TiltedDeck(joint=JOINT, cup=bs.Cup(), indentation=0.04, tilt=radians(tilt), element_size=radians(size))
    deck.write(tmp_path)
    calculix, sphere = run(tmp_path)["force_vector"], deck.expected["force_vector"]
    assert np.linalg.norm(np.subtract(sphere, calculix)) < tolerance * np.linalg.norm(calculix)


def test_invalid_tilted_decks_raise(tmp_path):
    valid = {"joint": JOINT, "cup": bs.Cup(), "indentation": 0.04, "tilt": 0.5}
    for change, message in (
        ({"joint": JOINT.replace(ball=bs.STEEL)}, "rigid ball"),
        ({"cup": bs.Cup(interface=bs.Interface.SLIDING)}, "bonded liner"),
        ({"indentation": 0.0}, "indentation"),
        ({"tilt": 45.0}, "radians"),
        ({"element_size": 1.0}, "degrees wide"),
    ):
        with pytest.raises(ValueError, match=message):
            TiltedDeck(**valid | change)
    process = command("deck", "hip-36", "--tilt", "45", "--force", "3kN", "--out", str(tmp_path))
    assert process.returncode == 2
    assert "give an indentation" in process.stderr


def test_command_writes_a_tilted_deck(tmp_path):
    load = ("--tilt", "45", "--indentation", "40 um", "--element-size", "4 mm")
    process = command("deck", "hip-36", *load, "--out", str(tmp_path))
    assert process.returncode == 0
    text = (tmp_path / "ballsocket.inp").read_text("ascii")
    assert max(map(len, text.splitlines())) <= 132
    assert "*ELEMENT, TYPE=C3D15" in text
