"""Tilted deck: its mesh, its text, and forces computed by CalculiX."""

from functools import cache
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import SphericalBlock, TiltedDeck, run

from ...cli.command import printed
from ...joints import lined
from ..calculix import needs_ccx

JOINT = lined()


def deck_of(degrees=15.0, tilt=0.5, joint=JOINT, cup=bs.Cup()):  # noqa: B008
    return TiltedDeck(joint=joint, cup=cup, indentation=0.04, tilt=tilt, element_size=radians(degrees))


DECK = deck_of()


@cache
def deck_text():
    return DECK.text()


def section(keyword):
    """Return the numbers in the lines below a keyword of the deck."""
    lines = deck_text()[deck_text().index(keyword) :].splitlines()[1:]
    end = next(i for i, line in enumerate(lines) if line.startswith("*"))
    return [[float(number) for number in line.split(",") if number.strip()] for line in lines[:end]]


def node_set(name):
    return [int(node) for row in section(f"NSET={name}") for node in row]


def numbers_of(nodes):
    return set(nodes.ravel().tolist()) - {0}


@pytest.mark.long
@needs_ccx
def test_calculix_gives_the_same_forces_in_three_dimensions(tmp_path):
    deck = deck_of(7.5, radians(60.0))
    deck.write(tmp_path)
    calculix, sphere = run(tmp_path)["force_vector"], deck.expected["force_vector"]
    assert np.linalg.norm(np.subtract(sphere, calculix)) < 3e-3 * np.linalg.norm(calculix)


def test_the_command_writes_a_tilted_deck(tmp_path):
    load = ("--tilt", "45", "--indentation", "40 um", "--element-size", "4 mm")
    printed("deck", "hip-36", *load, "--out", str(tmp_path))
    text = (tmp_path / "ballsocket.inp").read_text("ascii")
    assert max(map(len, text.splitlines())) <= 132
    assert "*ELEMENT, TYPE=C3D15" in text


def test_bricks_and_wedges_share_nodes_and_have_positive_volume():
    angles = {"polar": np.linspace(0.0, pi / 2, 4), "azimuth": np.linspace(0.0, pi, 5)}
    block = SphericalBlock(**angles, radius=np.array([1.0, 1.2]), centre=np.zeros(3))
    points = {int(number): block.points[:, *index] for index, number in np.ndenumerate(block.number) if number}
    for _, kind, _, nodes in block.elements():
        corners, count = (4, 20) if kind == "C3D20R" else (3, 15)
        assert len(set(nodes)) == len(nodes) == count
        face = [points[node] for node in nodes[:corners]]
        assert np.cross(face[1] - face[0], face[-1] - face[0]) @ (points[nodes[corners]] - face[0]) > 0
        assert points[nodes[2 * corners]] == pytest.approx((face[0] + face[1]) / 2, abs=0.05)


def test_deck_has_the_geometry_of_cup_and_ball():
    nodes, count = np.array(section("*NODE, NSET=ALL")), DECK.socket.last_number
    assert nodes[:, 0].tolist() == list(range(1, DECK.ball.last_number + 1))
    radius = np.linalg.norm(nodes[:count, 1:], axis=1)
    assert radius.min() == pytest.approx(JOINT.socket_radius)
    assert radius.max() == pytest.approx(JOINT.socket_radius + JOINT.liner_thickness)
    assert nodes[:, 2].min() > -1e-9  # half of the bodies
    assert nodes[:count, 3].min() == pytest.approx(0.0, abs=1e-9)
    first_touch = 1e-3 * JOINT.clearance * np.array([np.sin(0.5), 0.0, np.cos(0.5)])
    skin = np.linalg.norm(nodes[count:, 1:] - first_touch, axis=1)
    ball = JOINT.socket_radius - 1e-3 * JOINT.clearance
    assert (skin.min(), skin.max()) == pytest.approx((0.9 * ball, ball))


def test_deck_scales_its_displacement_and_stiffness_loads_the_inner_face_and_fixes_the_outer_one():
    pushed = [line for line in deck_text().splitlines() if line.startswith("PUSHED, ") and "." in line]
    x, z = (float(line.rsplit(",", 1)[1]) for line in pushed)
    assert (x, z) == pytest.approx((4e-5 * np.sin(0.5), 4e-5 * np.cos(0.5)))
    stiffness = section("*SURFACE BEHAVIOR")[0][0]
    assert stiffness == pytest.approx(500 * DECK.expected["max_pressure"] / 0.04, rel=1e-5)
    assert section("*ELASTIC") == [[pytest.approx(1000.0), pytest.approx(0.4)]]
    assert "1000000, 0.3" in deck_text()  # the skin
    socket = DECK.socket
    inner = [number for number, _, (_, _, k), _ in socket.elements() if k == 0]
    lining = deck_text()[deck_text().index("NAME=LINED") :].splitlines()[1 : len(inner) + 1]
    assert lining == [f"{number}, S1" for number in inner]
    assert set(node_set("OUTSIDE")) == numbers_of(socket.number[:, :, -1])
    nodes = np.array(section("*NODE, NSET=ALL"))[: socket.last_number]
    assert set(node_set("MIRROR")) == set(nodes[abs(nodes[:, 2]) < 1e-9, 0].astype(int).tolist())
    assert node_set("PUSHED") == sorted(numbers_of(DECK.ball.number))


def test_elements_divide_the_angles_evenly_grow_by_half_across_an_interface_and_are_three_in_a_thin_layer():
    """The backing is thick enough to continue the growth of the liner's elements."""
    assert np.diff(DECK.socket.radius) == pytest.approx(np.full(3, JOINT.liner_thickness / 3))
    backed = JOINT.replace(backing=(bs.Layer(thickness=40.0, material=bs.TITANIUM),))
    radius = deck_of(3.0, joint=backed).socket.radius
    steps = np.diff(radius)
    assert steps[0] == pytest.approx(radians(3.0) * JOINT.socket_radius, rel=0.25)
    ratios = steps[1:] / steps[:-1]
    assert ratios.max() < 1.6
    assert ratios[abs(radius - 24.75).argmin() - 1] > 1.2
    assert (len(DECK.socket.polar), len(DECK.socket.azimuth)) == (6 + 1, 12 + 1)
    assert np.diff(DECK.socket.polar) == pytest.approx(radians(15.0))
    narrow = deck_of(12.0, tilt=0.1, cup=bs.Cup(arc_of_cover=radians(50.0)))
    assert len(narrow.socket.polar) == 4 + 1


@pytest.mark.long
def test_layers_of_the_backing_are_sets_of_elements():
    backed = JOINT.replace(backing=(bs.Layer(thickness=4.0, material=bs.TITANIUM),))
    deck = deck_of(joint=backed)
    text, radii = deck.text(), deck.socket.radius
    sets = {line.split("ELSET=")[1] for line in text.splitlines() if "*ELEMENT," in line}
    assert sets == {"LAYER0", "LAYER1", "SKIN"}
    assert radii[abs(radii - 24.75).argmin()] == pytest.approx(24.75)
    assert radii[-1] == pytest.approx(24.75 + 4.0)
    assert f"{bs.TITANIUM.young:.12g}, {bs.TITANIUM.poisson:.12g}" in text
