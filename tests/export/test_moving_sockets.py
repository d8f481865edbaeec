"""Joints between two moving bodies in every program: forces on both, their levers, and derivatives."""

import os
import re
import subprocess
from functools import cache
from importlib import import_module

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.dynamics import Damping, ForceElement, Friction
from ballsocket.export import TARGETS, ExportJob
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library

from ..joints import HIP
from ..places import ROOT
from .library import needs_compiler, skip_without

LOSSES = {"damping": Damping(hysteresis=0.004), "friction": Friction(coefficient=0.05)}
PLAIN = ForceElement(bs.HessForsbach(), HIP)
LOSSY = ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(viscosity=1e-5), **LOSSES)
MEETINGS = {
    "lossy": (LOSSY, Rotation.identity()),
    "frictionless": (PLAIN, Rotation.identity()),
    "rim": (ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup(), **LOSSES), Rotation.from_euler("yx", [-0.7, 0.1])),
}
"""Elements, and the axes of their sockets in the frame of a box."""


def written(target, element, folder, name="bouncing"):
    return TARGETS[target].write(ExportJob(element=element, name=name, depth=0.05), folder)


@pytest.fixture(scope="module")
def tools():
    """The benchmark that runs one bounce in every program."""
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.syspath_prepend(str(ROOT))
        return import_module("benchmarks.tools")


def mujoco_momentum(tools, folder, name, axes):
    import mujoco as mj

    box, site = (
        '<geom type="box" size=".03 .02 .01" mass="0.7"/>',
        '<site name="socket" pos="-0.01 0 0" quat="%r %r %r %r"/>',
    )
    site = site % tuple(axes.as_quat(scalar_first=True).tolist())
    text = (folder / f"{name}.xml").read_text().replace("-9.81", "0")
    text = text.replace('<site name="socket"/>', f'<body pos="0.01 0 0"><freejoint/>{box}{site}</body>')
    mj.mj_loadPluginLibrary(str(next(folder.glob(f"_{name}_plugin*"))))
    model = mj.MjModel.from_xml_string(text)
    model.opt.timestep, model.opt.disableflags = 5e-6, mj.mjtDisableBit.mjDSBL_CONTACT
    data = mj.MjData(model)  # cup, then ball: places and turns, velocities and spins
    data.qpos[7:10], data.qvel[:] = (5e-5, 0.0, 2e-5), (0, 0, 0, 0.5, 1, -2, 0.06, 0.02, 0.08, 3, -2, 1)
    for steps in (0, 1000):
        for _ in range(steps):
            mj.mj_step(model, data)
        mj.mj_forward(model, data)
        mj.mj_subtreeVel(model, data)
        yield np.concatenate([1.7 * data.subtree_linvel[0], data.subtree_angmom[0]]), data.qvel[6:9].copy()


def drake_simulator(tools, folder, name, inertias, joints):
    """Simulator, plant and context of bodies in drake, and of joints between two bodies or a body and the world."""
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    bodies = [plant.AddRigidBody(f"body{number}", inertia) for number, inertia in enumerate(inertias)]
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.Finalize()
    with tools.module(folder, name) as made:
        for numbers, options in joints:
            made.add_joint(builder, plant, *(bodies[number] for number in numbers), **options)
    simulator = Simulator(builder.Build())
    simulator.get_mutable_integrator().request_initial_step_size_target(1e-5)
    simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    return simulator, plant, plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())


def drake_momentum(tools, folder, name, axes):
    from pydrake.multibody.tree import SpatialInertia

    ball, cup = SpatialInertia.SolidSphereWithMass(1.0, 0.018), SpatialInertia.SolidBoxWithMass(0.7, 0.06, 0.04, 0.02)
    joint = (0, 1), {"socket_centre": (-0.01, 0.0, 0.0), "socket_axes": axes.as_matrix()}
    simulator, plant, context = drake_simulator(tools, folder, f"{name}_drake", (ball, cup), [joint])
    plant.SetPositions(context, [1, 0, 0, 0, 5e-5, 0, 2e-5, 1, 0, 0, 0, 0.01, 0, 0])
    plant.SetVelocities(context, [3, -2, 1, 0.06, 0.02, 0.08, 0.5, 1, -2, 0, 0, 0])
    for time in (0.0, 0.005):
        simulator.AdvanceTo(time)
        found = plant.CalcSpatialMomentumInWorldAboutPoint(context, np.zeros(3))
        yield np.concatenate([found.translational(), found.rotational()]), plant.GetVelocities(context)[3:6]


BOX_INERTIA = 0.7 / 12 * np.diag([0.04**2 + 0.02**2, 0.06**2 + 0.02**2, 0.06**2 + 0.04**2])
BALL_INERTIA = 0.4 * 0.018**2 * np.eye(3)


def exudyn_momentum(tools, folder, name, axes):
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name
    from exudyn.utilities import RigidBodyInertia

    mbs = exu.SystemContainer().AddSystem()
    kinds = exu.OutputVariableType
    masses, inertias = (0.7, 1.0), (BOX_INERTIA, BALL_INERTIA)
    starts = ([0.01, 0, 0], [0, 0, 0], [0.5, 1, -2]), ([5e-5, 0, 2e-5], [0.06, 0.02, 0.08], [3, -2, 1])
    names = ("referencePosition", "initialVelocity", "initialAngularVelocity")
    cup, ball = (
        mbs.CreateRigidBody(
            inertia=RigidBodyInertia(mass=mass, inertiaTensor=inertia),
            nodeType=exu.NodeType.RotationRotationVector,
            **dict(zip(names, start, strict=True)),
        )
        for mass, inertia, start in zip(masses, inertias, starts, strict=True)
    )
    markers = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=number, localPosition=centre))
        for number, centre in ((cup, [-0.01, 0, 0]), (ball, [0, 0, 0]))
    ]
    with tools.module(folder, f"{name}_exudyn") as made:
        made.add_joint(mbs, *markers, socket_axes=axes.as_matrix())
    mbs.Assemble()

    def momentum():
        linear, angular = np.zeros(3), np.zeros(3)
        for number, mass, inertia in zip((cup, ball), masses, inertias, strict=True):
            names = (kinds.Position, kinds.Velocity, kinds.AngularVelocityLocal, kinds.RotationMatrix)
            position, velocity, spin, axes = (mbs.GetObjectOutputBody(number, name, [0, 0, 0]) for name in names)
            linear += mass * velocity
            angular += mass * np.cross(position, velocity) + axes.reshape(3, 3) @ inertia @ spin
        return np.concatenate([linear, angular]), np.array(velocity)

    yield momentum()
    settings = exu.SimulationSettings()
    settings.timeIntegration.endTime = 0.005
    settings.timeIntegration.numberOfSteps = 1000
    settings.timeIntegration.automaticStepSize = False
    settings.solution.file.write = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    yield momentum()


def opensim_momentum(tools, folder, name, axes):
    """Expression forces act along the line of centres, so that the axes of their socket make no difference."""
    import opensim as osim

    expression = re.search("<expression>(.*)</expression>", (folder / f"{name}.osim").read_text())[1]
    ends = "/bodyset/cup", osim.Vec3(-0.01, 0.0, 0.0), "/bodyset/ball", osim.Vec3(0.0, 0.0, 1e-11)
    force = osim.ExpressionBasedPointToPointForce(*ends, expression)
    force.setName("meeting")
    yield from opensim_meeting(force)


def opensim_plugin_momentum(tools, folder, name, axes):
    import opensim as osim

    package = os.path.dirname(osim.__file__)
    libraries = "osimSimulation", "osimCommon", "SimTKsimbody", "SimTKmath", "SimTKcommon"
    words = ["-std=c++20", "-O0", "-shared", "-fPIC", "-I", os.environ["OPENSIM_INCLUDE"], f"-L{package}"]
    library = shared_library([f"{name}.c"], folder / f"{name}{LIBRARY_ENDING}", folder)
    plugin = folder / f"{name}_plugin.so"
    sources = f"{name}_opensim.cpp", library, f"-Wl,-rpath,{folder}:{package}"
    linked = [f"-l{library}" for library in libraries]
    subprocess.run(["c++", *words, *sources, *linked, "-o", plugin], cwd=folder, check=True)
    assert osim.LoadOpenSimLibraryExact(str(plugin))
    joint = osim.Force.safeDownCast(osim.OpenSimObject.newInstanceOfType(f"{name.capitalize()}Joint"))
    joint.setName("meeting")
    angles = osim.Vec3(*axes.as_euler("XYZ").tolist())
    transform = osim.Transform(osim.Rotation(), osim.Vec3(-0.01, 0.0, 0.0))
    socket = osim.PhysicalOffsetFrame()
    socket.setName("at_socket")
    socket.setOffsetTransform(transform)
    socket.set_orientation(angles)
    joint.updSocket("frame1").setConnecteePath("/bodyset/cup/at_socket")
    joint.updSocket("frame2").setConnecteePath("/bodyset/ball")
    yield from opensim_meeting(joint, socket)


def opensim_meeting(force, socket=None):
    """Meet in OpenSim by a force between the bodies "cup" and "ball"."""
    import opensim as osim

    osim.Logger.setLevelString("Error")
    osim.Logger.removeFileSink()
    model, bodies = osim.Model(), []
    model.setGravity(osim.Vec3(0.0))
    for name, mass, inertia in (("cup", 0.7, BOX_INERTIA), ("ball", 1.0, BALL_INERTIA)):
        bodies.append(osim.Body(name, mass, osim.Vec3(0.0), osim.Inertia(*np.diag(inertia).tolist())))
        model.addBody(bodies[-1])
        model.addJoint(osim.FreeJoint(f"{name}_free", model.getGround(), bodies[-1]))
    if socket is not None:
        socket.setParentFrame(bodies[0])
        bodies[0].addComponent(socket)
    model.addForce(force)
    model.finalizeConnections()
    state = model.initSystem()
    starts = ([0, 0, 0, 0.01, 0, 0], [0.5, 1, -2, 0, 0, 0]), ([0, 0, 0, 5e-5, 0, 2e-5], [3, -2, 1, 0.06, 0.02, 0.08])
    for body, (places, speeds) in zip(bodies, starts, strict=True):
        for index, (place, speed) in enumerate(zip(places, speeds, strict=True)):
            path = f"/jointset/{body.getName()}_free/{body.getName()}_free_coord_{index}"
            model.setStateVariableValue(state, f"{path}/value", place)
            model.setStateVariableValue(state, f"{path}/speed", speed)
    manager = osim.Manager(model)
    manager.setIntegratorAccuracy(1e-10)
    manager.setIntegratorMaximumStepSize(2e-5)
    manager.setWriteToStorage(False)
    manager.initialize(state)
    for time in (0.0, 0.005):
        if time:
            state = manager.integrate(time)
        model.realizeVelocity(state)
        linear, angular = np.zeros(3), np.zeros(3)
        for body, mass, inertia in zip(bodies, (0.7, 1.0), (BOX_INERTIA, BALL_INERTIA), strict=True):
            pose, motion = body.getTransformInGround(state), body.getVelocityInGround(state)
            turn = np.array([[pose.R().get(row, column) for column in range(3)] for row in range(3)])
            spin, speed, place = (part.to_numpy() for part in (motion.get(0), motion.get(1), pose.p()))
            linear += mass * speed
            angular += mass * np.cross(place, speed) + turn @ inertia @ turn.T @ spin
        yield np.concatenate([linear, angular]), speed


@cache
def velocity_after(meeting):
    """Integrate Newton's and Euler's equations of box and ball around the element in Python, to order 8."""
    element, axes = MEETINGS[meeting]
    masses, inertias = (0.7, 1.0), (BOX_INERTIA, BALL_INERTIA)
    lever = np.array([-0.01, 0.0, 0.0])  # of the socket's centre in the box

    def rate(_, y):
        (x0, v0, w0, A0), (x1, v1, w1, A1) = ((s[:3], s[3:6], s[6:9], s[9:].reshape(3, 3)) for s in (y[:18], y[18:]))
        arm = x1 - x0  # of the ball's centre from the box's
        seen = v1 - v0 - np.cross(A0 @ w0, arm)
        spin = A1 @ w1 - A0 @ w0
        turn = A0 @ axes.as_matrix()
        load = element(1e3 * axes.as_matrix().T @ (A0.T @ arm - lever), 1e3 * (turn.T @ seen), turn.T @ spin)
        force, moment = turn @ load.force, 1e-3 * (turn @ load.moment)
        torques = A0.T @ (-moment - np.cross(arm, force)), A1.T @ moment
        bodies = zip(masses, inertias, (v0, v1), (w0, w1), (A0, A1), (-force, force), torques, strict=True)
        rates = [
            [v, F / mass, np.linalg.solve(inertia, T - np.cross(w, inertia @ w)), (A @ np.cross(np.eye(3), w)).ravel()]
            for mass, inertia, v, w, A, F, T in bodies
        ]
        return np.concatenate([*rates[0], *rates[1]])

    upright = np.eye(3).ravel()
    box = [0.01, 0, 0, 0, 0, 0, 0.5, 1, -2, *upright]
    ball = [5e-5, 0, 2e-5, 0.06, 0.02, 0.08, 3, -2, 1, *upright]
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-13, "max_step": 1e-4}
    return solve_ivp(rate, (0.0, 0.005), np.array([*box, *ball], dtype=float), **options).y[21:24, -1]


MOMENTA = mujoco_momentum, drake_momentum, exudyn_momentum, opensim_momentum, opensim_plugin_momentum


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("meeting", MEETINGS)
@pytest.mark.parametrize("momentum", MOMENTA)
def test_ball_and_free_socket_conserve_linear_and_angular_momentum(momentum, meeting, tools, tmp_path):
    """The socket rotates: action equals reaction, their levers are right, and velocities are those that it sees."""
    target = momentum.__name__.partition("_")[0]
    skip_without({"drake": "pydrake"}.get(target, target))
    element, axes = MEETINGS[meeting]
    if momentum is opensim_plugin_momentum and "OPENSIM_INCLUDE" not in os.environ:
        pytest.skip("OPENSIM_INCLUDE does not name the headers of OpenSim's SDK")
    if momentum is opensim_momentum and meeting != "frictionless":
        pytest.skip("an expression force of OpenSim has no friction and no rim")
    notes = written(target, element, tmp_path, name=f"meeting_{meeting}")[1]
    assert (notes == "") == (target != "opensim")
    (before, speed), (after, slowed) = momentum(tools, tmp_path, f"meeting_{meeting}", axes)
    assert np.linalg.norm(slowed - speed) > 0.005  # they met
    assert_allclose(after, before, atol=1e-14)
    assert_allclose(slowed, velocity_after(meeting), atol=1e-6)


@pytest.mark.long
@needs_compiler
def test_a_ball_in_an_elastic_socket_of_exudyn_conserves_momentum(tools, tmp_path):
    """Four masses and six springs hold the socket; a torque of friction on such a marker is of first order only."""
    skip_without("exudyn")
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name
    from exudyn.utilities import RigidBodyInertia

    written("exudyn", MEETINGS["frictionless"][0], tmp_path, name="elastic")
    mbs, kinds = exu.SystemContainer().AddSystem(), exu.OutputVariableType
    corners = 0.02 * np.array([[1, 0, 0], [-0.5, 0.8, 0], [-0.5, -0.8, 0], [0, 0, 1]])
    weights, spin = [0.25] * 4, [0.5, 1, -2]
    nodes = [
        mbs.AddNode(items.NodePoint(referenceCoordinates=list(corner), initialVelocities=list(np.cross(spin, corner))))
        for corner in corners
    ]
    held = [mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)) for node in nodes]
    for i, j in zip(*np.triu_indices(4, 1), strict=True):
        length = np.linalg.norm(corners[i] - corners[j])
        ends = {"markerNumbers": [held[i], held[j]], "referenceLength": length}
        mbs.AddObject(items.ObjectConnectorSpringDamper(stiffness=2e5, **ends))
    matrices = {"massMatrix": 0.2 * np.eye(12), "stiffnessMatrix": np.zeros((12, 12))}
    body = mbs.AddObject(items.ObjectGenericODE2(nodeNumbers=nodes, **matrices))
    around = {"meshNodeNumbers": [0, 1, 2, 3], "weightingFactors": weights}
    socket = mbs.AddMarker(items.MarkerSuperElementRigid(bodyNumber=body, **around))
    ball = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=1.0, inertiaTensor=BALL_INERTIA),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=list(weights @ corners + [5e-5, 0, 2e-5]),
        initialVelocity=[0.06, 0.02, 0.08],
    )
    with tools.module(tmp_path, "elastic_exudyn") as made:
        made.add_joint(mbs, socket, mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ball)))
    mbs.Assemble()

    def momentum():
        """The ball does not turn: no friction acts on it."""
        kind = kinds.Position, kinds.Velocity
        motions = [[mbs.GetNodeOutput(node, each) for each in kind] for node in nodes]
        motions.append([mbs.GetObjectOutputBody(ball, each, [0, 0, 0]) for each in kind])
        masses, (places, speeds) = np.array([[0.2]] * 4 + [[1.0]]), np.moveaxis(np.array(motions), 1, 0)
        return np.hstack([masses * speeds, masses * np.cross(places, speeds)]).sum(axis=0), speeds[-1]

    (before, speed), settings = momentum(), exu.SimulationSettings()
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = 0.005, 2000
    settings.timeIntegration.automaticStepSize = settings.solution.file.write = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    after, slowed = momentum()
    assert np.linalg.norm(slowed - speed) > 0.01  # they met
    assert_allclose(after, before, atol=1e-14)


@pytest.mark.long
@needs_compiler
def test_drake_differentiates_the_force_of_a_joint_between_two_bodies(tools, tmp_path):
    """Minus the gradient of the acceleration is the stiffness over the mass, at rest and without friction."""
    skip_without("pydrake")
    from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
    from pydrake.multibody.tree import SpatialInertia

    cup = ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup())
    written("drake", cup, tmp_path, name="smooth")
    bodies, turn = [SpatialInertia.SolidSphereWithMass(2.0, 0.018)] * 2, MEETINGS["rim"][1].as_matrix()
    joints = [((0,), {}), ((1,), {"socket_axes": turn})]
    simulator, plant, _ = drake_simulator(tools, tmp_path, "smooth_drake", bodies, joints)
    diagram = simulator.get_system().ToAutoDiffXd()
    context = diagram.CreateDefaultContext()
    places = np.array([[1e-5, 4e-5, 1.2e-4], [1.3e-4, 1e-5, 2e-5]])
    positions = np.concatenate([[1.0, 0.0, 0.0, 0.0, *place] for place in places])
    differentiable = diagram.GetSubsystemByName(plant.get_name())
    state = InitializeAutoDiff(np.concatenate([positions, np.zeros(12)])).ravel()
    differentiable.SetPositionsAndVelocities(differentiable.GetMyMutableContextFromRoot(context), state)
    rates = diagram.EvalTimeDerivatives(context).CopyToVector()
    for index, (place, axes) in enumerate(zip(places, (np.eye(3), turn), strict=True)):
        rows = slice(14 + 6 * index + 3, 14 + 6 * index + 6)
        load = cup(1e3 * axes.T @ place)
        assert_allclose(ExtractValue(rates)[rows].ravel(), axes @ load.force / 2.0, rtol=1e-9)
        gradient = ExtractGradient(rates)[rows, 7 * index + 4 : 7 * index + 7]
        assert_allclose(gradient, -1e3 * axes @ np.array(load.tangent) @ axes.T / 2.0, rtol=1e-6, atol=1.0)


@pytest.mark.long
@needs_compiler
def test_two_joints_on_one_plant_of_drake_act_independently(tools, tmp_path):
    skip_without("pydrake")
    from pydrake.multibody.tree import SpatialInertia

    written("drake", LOSSY, tmp_path, name="pair")

    def final_positions(starts):
        balls = [SpatialInertia.SolidSphereWithMass(1.0, 0.018)] * len(starts)
        joints = [((number,), {}) for number in range(len(starts))]
        simulator, plant, context = drake_simulator(tools, tmp_path, "pair_drake", balls, joints)
        plant.SetPositions(context, np.concatenate([[1, 0, 0, 0, *start] for start in starts]))
        simulator.AdvanceTo(0.003)
        return plant.GetPositions(context).reshape(-1, 7)[:, 4:]

    starts = [(1.3e-4, 0.0, 0.0), (0.0, 1.2e-4, 3e-5), (0.0, 0.0, -1.25e-4)]
    alone = [final_positions([start])[0] for start in starts]
    assert_allclose(final_positions(starts), alone, atol=1e-9)
    assert np.linalg.norm(alone - np.array(starts), axis=1).min() > 1e-5
