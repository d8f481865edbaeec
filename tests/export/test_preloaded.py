"""A preloaded joint as C sources and as an FMU, against its element in Python."""

from math import radians

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import Damping, Friction, PreloadedElement
from ballsocket.export.fmu import Fmu, write_cross_check
from ballsocket.export.targets import TARGETS, ExportJob

from ..cli.command import refusal, run
from ..extent import some
from .library import Host, Library, description, needs_compiler, table

PRELOADED = ("--ball-radius", "13.5", "--interference", "0.03", "--liner-thickness", "2.5", "--liner", "pom")
JOINT = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM)


@pytest.fixture(scope="module")
def element():
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(240.0), inclination=0.2), ring_width=radians(6.0))
    losses = {"damping": Damping(hysteresis=1e-3, time=1e-5), "friction": Friction(coefficient=0.1)}
    return PreloadedElement(model, JOINT, **losses)


@needs_compiler
def test_the_c_program_has_the_loads_of_the_element_and_their_slopes(element, tmp_path):
    library = Library(element, tmp_path)
    states = np.random.default_rng(1).normal(size=(6, 3, 3)) * np.array([0.04, 5.0, 0.5])[:, None]
    for position, velocity, spin in states.tolist():
        library.check(element, position, velocity, spin, near=1e-11, near_contact=1e-11)
    assert library.load((1.0, 0.0, 0.0), (0.0,) * 3, (0.0,) * 3)[0] == 4
    direction, step = np.random.default_rng(3).normal(size=(3, 3)) * np.array([[1e-3], [1.0], [0.1]]), 1e-5
    ends = [element(*(states[0] + sign * step * direction).tolist()) for sign in (-1, 1)]
    loads = [[*end.force, *end.moment, end.energy, end.half_angle, end.max_pressure] for end in ends]
    status, slope = library.slope(*states[0].tolist(), direction.ravel().tolist())
    assert status == 1
    assert_allclose(slope, (np.array(loads[1]) - loads[0]) / (2 * step), rtol=1e-5, atol=1e-6)


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("version", some([3, 2], 1))
def test_a_host_receives_force_and_friction_of_the_preload(element, version, tmp_path):
    Fmu(element=element, name="rod", version=version).write(tmp_path / "rod.fmu")
    write_cross_check(element, tmp_path / "rod.fmu")
    host = Host(tmp_path / "rod.fmu", tmp_path)
    status, at_rest = host.get("force[1]", "force[2]", "force[3]")
    assert status == 0
    assert_allclose(at_rest, 0.0, atol=0.01)  # N, of 24 kN at the centre of the socket
    root = description(tmp_path / "rod.fmu")
    found = [float(node.get("start")) for node in root.iter() if node.get("start") is not None][:3]
    assert_allclose(found, 1e-3 * np.array(element.rest_position))
    assert element.rest_position[2] < 0
    assert "at rest" in root.get("description")
    host.set(position=(1e-5, 0.0, -2e-5), spin=(0.0, 0.0, 1.0))
    load = element((0.01, 0.0, -0.02), spin=(0.0, 0.0, 1.0))
    status, (force, moment) = host.get("force[1]", "moment[3]")
    assert status == 0
    assert_allclose((force, moment), (load.force[0], 1e-3 * load.moment[2]), rtol=1e-11)
    assert host.messages == []
    reference = table(tmp_path / "rod_ref.csv")
    assert np.isfinite(reference["force[1]"]).all()
    assert np.ptp(reference["energy"]) > 0


def test_a_table_has_the_forces_of_the_solver_along_two_axes(element):
    (text,) = TARGETS["table"].texts(ExportJob(element=element, name="rod", depth=0.1)).values()
    rows = np.genfromtxt(text.splitlines(), delimiter=",", names=True)[20::80]
    for name, column in (("along", 2), ("across", 0)):  # of the cup's frame, in which the solver has its forces
        centres = element.rest_position + rows["displacement_mm"][:, None] * np.array(element.model.cup.frame[column])
        solved = -element.model.press(JOINT, displacement=centres).force_vector[:, column]  # on the ball
        assert_allclose(rows[f"force_N_{name}"], solved, rtol=0.001, atol=0.01)
        assert solved[0] > 1e3 > -1e3 > solved[-1]


@pytest.mark.long
def test_the_commands_export_an_interference_but_not_as_a_central_force(tmp_path):
    finished = run("export", "c", *PRELOADED, "--out", "rod", folder=tmp_path)
    assert finished.stderr == "ballsocket: arc of cover 240° assumed for a preloaded joint; set arc_of_cover\n"
    assert "int rod_load(" in (tmp_path / "rod" / "rod.h").read_text("utf-8")
    refused = refusal("export", "opensim", *PRELOADED, "--arc-of-cover", "240", "--out", "hip", folder=tmp_path)
    assert "export c, drake, modelica or mujoco" in refused
    assert not (tmp_path / "hip").exists()
