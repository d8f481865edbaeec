"""The tilted deck: its mesh, and what CalculiX makes of it."""

import shutil
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.bricks import Bricks
from ballsocket.elasticity.off_axis.deck import TiltedDeck, run

from ...cli.command import run as command
from ...extent import either

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")


def test_bricks_and_wedges_share_their_nodes_and_turn_the_right_way():
    block = Bricks(
        polar=np.linspace(0.0, pi / 2, 4),
        azimuth=np.linspace(0.0, pi, 5),
        radius=np.array([1.0, 1.2]),
        centre=np.zeros(3),
    )
    places = {int(number): block.places[:, *at] for at, number in np.ndenumerate(block.number) if number}
    for _, kind, _, nodes in block.elements():
        assert len(set(nodes)) == len(nodes) == {"C3D20R": 20, "C3D15": 15}[kind]
        corners = [places[node] for node in nodes[: 4 if kind == "C3D20R" else 3]]
        above = places[nodes[4 if kind == "C3D20R" else 3]]
        across = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
        assert across @ (above - corners[0]) > 0
        middle = places[nodes[8 if kind == "C3D20R" else 6]]
        assert middle == pytest.approx((corners[0] + corners[1]) / 2, abs=0.05)


@needs_ccx
@pytest.mark.parametrize(
    ("tilt", "size", "within"),
    either(quick=[(45.0, 11.25, 0.01)], long=[(each, 7.5, 3e-3) for each in (0.0, 30.0, 60.0)]),
)
def test_calculix_in_three_dimensions_gives_the_same_forces(tilt, size, within, tmp_path):
    deck = TiltedDeck(joint=JOINT, cup=bs.Cup(), indentation=0.04, tilt=radians(tilt), element_size=radians(size))
    deck.write(tmp_path)
    theirs, ours = run(tmp_path)["force_vector"], deck.expected["force_vector"]
    assert np.linalg.norm(np.subtract(ours, theirs)) < within * np.linalg.norm(theirs)


def test_what_a_tilted_deck_cannot_be_is_refused(tmp_path):
    good = {"joint": JOINT, "cup": bs.Cup(), "indentation": 0.04, "tilt": 0.5}
    for change, said in (
        ({"joint": JOINT.replace(ball=bs.STEEL)}, "rigid ball"),
        ({"cup": bs.Cup(interface=bs.Interface.SLIDING)}, "bonded"),
        ({"indentation": 0.0}, "indentation"),
        ({"tilt": 45.0}, "radians"),
        ({"element_size": 1.0}, "degrees wide"),
    ):
        with pytest.raises(ValueError, match=said):
            TiltedDeck(**good | change)
    done = command("deck", "hip-36", "--tilt", "45", "--force", "3kN", "--out", str(tmp_path))
    assert done.returncode == 2
    assert "give an indentation" in done.stderr


def test_the_command_writes_a_tilted_deck(tmp_path):
    load = ("--tilt", "45", "--indentation", "40 um", "--element-size", "4 mm")
    done = command("deck", "hip-36", *load, "--out", str(tmp_path))
    assert done.returncode == 0
    text = (tmp_path / "ballsocket.inp").read_text("ascii")
    assert max(map(len, text.splitlines())) <= 132
    assert "*ELEMENT, TYPE=C3D15" in text
