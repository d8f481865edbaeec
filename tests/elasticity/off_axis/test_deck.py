"""Tilted deck: its mesh, its text, and forces computed by CalculiX."""

from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.deck import SphericalBlock, TiltedDeck, run

from ...cli.command import run as command
from ...extent import either
from ..calculix import needs_ccx

JOINT = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.Material(young=1000.0, poisson=0.4))


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


@pytest.mark.long
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


DECK = TiltedDeck(joint=JOINT, cup=bs.Cup(), indentation=0.04, tilt=0.5, element_size=radians(15.0))


def section(keyword, text):
    """Return the numbers in the lines below a keyword of a deck."""
    lines = text[text.index(keyword) :].splitlines()[1:]
    end = next(i for i, line in enumerate(lines) if line.startswith("*"))
    return [[float(number) for number in line.split(",") if number.strip()] for line in lines[:end]]


def test_deck_has_the_geometry_of_cup_and_ball():
    nodes = np.array(section("*NODE, NSET=ALL", DECK.text()))
    count = DECK.socket.last_number
    assert nodes[:, 0].tolist() == list(range(1, DECK.ball.last_number + 1))
    radius = np.linalg.norm(nodes[:count, 1:], axis=1)
    assert radius.min() == pytest.approx(JOINT.socket_radius)
    assert radius.max() == pytest.approx(JOINT.socket_radius + JOINT.liner_thickness)
    assert nodes[:, 2].min() > -1e-9  # half of the bodies
    assert nodes[:count, 3].min() == pytest.approx(0.0, abs=1e-9)
    first_touch = 1e-3 * JOINT.clearance * np.array([np.sin(0.5), 0.0, np.cos(0.5)])
    skin = np.linalg.norm(nodes[count:, 1:] - first_touch, axis=1)
    ball = JOINT.socket_radius - 1e-3 * JOINT.clearance
    assert skin.max() == pytest.approx(ball)
    assert skin.min() == pytest.approx(0.9 * ball)


def test_deck_scales_the_displacement_and_the_contact_stiffness():
    text = DECK.text()
    x, z = (float(line.rsplit(",", 1)[1]) for line in text.splitlines() if line.startswith("PUSHED, ") and "." in line)
    assert (x, z) == pytest.approx((4e-5 * np.sin(0.5), 4e-5 * np.cos(0.5)))
    stiffness = section("*SURFACE BEHAVIOR", text)[0][0]
    assert stiffness == pytest.approx(500 * DECK.expected["max_pressure"] / 0.04, rel=1e-5)
    assert section("*ELASTIC", text) == [[pytest.approx(1000.0), pytest.approx(0.4)]]
    assert "1000000, 0.3" in text  # the skin


def test_deck_loads_the_inner_face_and_fixes_the_outer_one():
    text, socket = DECK.text(), DECK.socket
    inner = [number for number, _, (_, _, k), _ in socket.elements() if k == 0]
    lined = text[text.index("NAME=LINED") :].splitlines()[1 : len(inner) + 1]
    assert lined == [f"{number}, S1" for number in inner]
    fixed = {int(node) for row in section("NSET=OUTSIDE", text) for node in row}
    assert fixed == set(socket.number[:, :, -1].ravel().tolist()) - {0}
    mirrored = {int(node) for row in section("NSET=MIRROR", text) for node in row}
    nodes = np.array(section("*NODE, NSET=ALL", text))
    flat = {int(node) for node in nodes[: socket.last_number][abs(nodes[: socket.last_number, 2]) < 1e-9, 0]}
    assert mirrored == flat


def test_elements_fill_the_half_shell():
    """Volumes of hexahedra from the corners approach that of the shell; wedges at the pole included."""
    socket = DECK.socket
    elements = list(socket.elements())
    assert [number for number, *_ in elements] == list(range(1, len(elements) + 1))
    assert len(elements) == (len(socket.polar) - 1) * (len(socket.azimuth) - 1) * (len(socket.radius) - 1)
    assert {kind for _, kind, (i, _, _), _ in elements if i == 0} == {"C3D15"}
    assert {kind for _, kind, (i, _, _), _ in elements if i} == {"C3D20R"}
    used = {node for *_, nodes in elements for node in nodes}
    assert used == set(socket.number.ravel().tolist()) - {0}
    first_of_ball = next(DECK.ball.elements())[0]
    assert first_of_ball == len(elements) + 1


def test_thin_layer_has_three_equal_elements():
    radii = DECK.socket.radius
    assert np.diff(radii) == pytest.approx(np.full(3, JOINT.liner_thickness / 3))


def test_elements_grow_by_half_across_an_interface():
    """The backing is thick enough to continue the growth of the liner's elements."""
    backed = JOINT.replace(backing=(bs.Layer(thickness=40.0, material=bs.TITANIUM),))
    deck = TiltedDeck(joint=backed, cup=bs.Cup(), indentation=0.04, tilt=0.5, element_size=radians(3.0))
    steps = np.diff(deck.socket.radius)
    assert steps[0] == pytest.approx(radians(3.0) * JOINT.socket_radius, rel=0.25)
    ratios = steps[1:] / steps[:-1]
    assert ratios.max() < 1.6
    interface = abs(deck.socket.radius - 24.75).argmin()
    assert ratios[interface - 1] > 1.2


def test_element_sizes_divide_the_angles_evenly():
    assert len(DECK.socket.polar) == 6 + 1
    assert len(DECK.socket.azimuth) == 12 + 1
    assert np.diff(DECK.socket.polar) == pytest.approx(radians(15.0))
    narrow = TiltedDeck(
        joint=JOINT, cup=bs.Cup(arc_of_cover=radians(50.0)), indentation=0.04, tilt=0.1, element_size=radians(12.0)
    )
    assert len(narrow.socket.polar) == 4 + 1


@pytest.mark.parametrize(("degrees", "allowed"), [(0.49, False), (0.51, True), (14.9, True), (15.1, False)])
def test_elements_are_half_a_degree_to_fifteen_wide(degrees, allowed):
    make = {"joint": JOINT, "cup": bs.Cup(), "indentation": 0.04, "tilt": 0.5, "element_size": radians(degrees)}
    if allowed:
        assert TiltedDeck(**make).element_size == radians(degrees)
    else:
        with pytest.raises(ValueError, match="an element is 0.5 to 15 degrees wide"):
            TiltedDeck(**make)


@pytest.mark.parametrize(("scale", "allowed"), [(0.0, False), (1.0, True), (1.05, False)])
def test_scale_is_at_most_one(scale, allowed):
    make = {"joint": JOINT, "cup": bs.Cup(), "indentation": 0.04, "tilt": 0.5, "scale": scale}
    if allowed:
        assert TiltedDeck(**make).scale == scale
    else:
        with pytest.raises(ValueError, match="a scale lies above 0 and is at most 1"):
            TiltedDeck(**make)


def test_lines_of_a_deck_hold_their_numbers():
    """CalculiX reads at most 16 entries of a line; a row that continues ends with a comma."""
    lines = DECK.text().splitlines()
    start = lines.index(next(line for line in lines if line.startswith("*ELEMENT, TYPE=C3D20R")))
    first, second = lines[start + 1 : start + 3]
    assert first.endswith(",")
    assert len(first.rstrip(",").split(",")) == 12
    assert len(second.split(",")) == 9
    outside = lines[lines.index("*NSET, NSET=OUTSIDE") + 1]
    assert len(outside.split(",")) == 16
    numbers = [int(node) for row in section("NSET=PUSHED", DECK.text()) for node in row]
    assert numbers == sorted(set(DECK.ball.number.ravel().tolist()) - {0})


@pytest.mark.long
def test_layers_of_the_backing_are_sets_of_elements():
    backed = JOINT.replace(backing=(bs.Layer(thickness=4.0, material=bs.TITANIUM),))
    deck = TiltedDeck(joint=backed, cup=bs.Cup(), indentation=0.04, tilt=0.5, element_size=radians(15.0))
    text = deck.text()
    assert {"LAYER0", "LAYER1", "SKIN"} == {
        line.split("ELSET=")[1] for line in text.splitlines() if "*ELEMENT," in line
    }
    radii = deck.socket.radius
    assert backed.socket_radius + backed.liner_thickness == pytest.approx(radii[abs(radii - 24.75).argmin()])
    assert radii[-1] == pytest.approx(24.75 + 4.0)
    assert f"{bs.TITANIUM.young:.12g}, {bs.TITANIUM.poisson:.12g}" in text
