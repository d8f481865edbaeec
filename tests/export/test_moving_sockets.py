"""Joints between two moving bodies in every program: forces on both, their levers, and derivatives."""

import os
import re
import subprocess
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.dynamics import Damping, ForceElement, Friction
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library

from ..joints import HIP
from .library import needs_compiler, skip_without, tools, written

pytestmark = [pytest.mark.long, needs_compiler]
LOSSES = {"damping": Damping(hysteresis=0.004), "friction": Friction(coefficient=0.05)}
PLAIN = ForceElement(bs.HessForsbach(), HIP)
LOSSY = ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(viscosity=1e-5), **LOSSES)
MEETINGS = {
    "lossy": (LOSSY, Rotation.identity()),
    "frictionless": (PLAIN, Rotation.identity()),
    "rim": (ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup(), **LOSSES), Rotation.from_euler("yx", [-0.7, 0.1])),
}
"""Elements, and the axes of their sockets in the frame of a box."""


class Body(NamedTuple):
    """A body in kg, m and s, with its spin in its own axes."""

    mass: float
    inertia: np.ndarray
    position: list
    velocity: list
    spin: list


CUP = Body(0.7, 0.7 / 12 * np.diag([0.0020, 0.0040, 0.0052]), [0.01, 0, 0], [0, 0, 0], [0.5, 1, -2])
BALL = Body(1.0, 0.4 * 0.018**2 * np.eye(3), [5e-5, 0, 2e-5], [0.06, 0.02, 0.08], [3, -2, 1])
SOCKET = [-0.01, 0.0, 0.0]
"""Centre of the socket in a box of 60 mm x 40 mm x 20 mm."""


def momentum(motions):
    """Linear and angular momentum of cup and ball from their places, velocities, spins and turns; the last velocity."""
    parts = []
    for body, (place, velocity, spin, turn) in zip((CUP, BALL), motions, strict=True):
        moment = np.cross(place, body.mass * velocity) + turn @ body.inertia @ spin
        parts.append(np.concatenate([body.mass * velocity, moment]))
    return sum(parts), velocity


def mujoco_momentum(folder, name, axes):
    import mujoco as mj

    box = '<geom type="box" size=".03 .02 .01" mass="0.7"/>'
    quat = " ".join(map(repr, axes.as_quat(scalar_first=True).tolist()))
    site = f'<site name="socket" pos="-0.01 0 0" quat="{quat}"/>'
    text = (folder / f"{name}.xml").read_text().replace("-9.81", "0")
    text = text.replace('<site name="socket"/>', f'<body pos="0.01 0 0"><freejoint/>{box}{site}</body>')
    mj.mj_loadPluginLibrary(str(next(folder.glob(f"_{name}_plugin*"))))
    model = mj.MjModel.from_xml_string(text)
    model.opt.timestep, model.opt.disableflags = 5e-6, mj.mjtDisableBit.mjDSBL_CONTACT
    data = mj.MjData(model)  # cup, then ball: places and turns, velocities and spins
    data.qpos[7:10], data.qvel[:] = BALL.position, [*CUP.velocity, *CUP.spin, *BALL.velocity, *BALL.spin]
    for steps in (0, 1000):
        for _ in range(steps):
            mj.mj_step(model, data)
        mj.mj_forward(model, data)
        mj.mj_subtreeVel(model, data)
        yield np.concatenate([1.7 * data.subtree_linvel[0], data.subtree_angmom[0]]), data.qvel[6:9].copy()


def drake_momentum(folder, name, axes):
    from pydrake.multibody.tree import SpatialInertia

    ball, cup = SpatialInertia.SolidSphereWithMass(1.0, 0.018), SpatialInertia.SolidBoxWithMass(0.7, 0.06, 0.04, 0.02)
    joint = (0, 1), {"socket_centre": SOCKET, "socket_axes": axes.as_matrix()}
    simulator, plant, context = tools.drake_simulator(folder, name, (ball, cup), [joint])
    simulator.get_mutable_integrator().request_initial_step_size_target(1e-5)
    simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    plant.SetPositions(context, [1, 0, 0, 0, *BALL.position, 1, 0, 0, 0, *CUP.position])
    plant.SetVelocities(context, [*BALL.spin, *BALL.velocity, *CUP.spin, *CUP.velocity])
    for time in (0.0, 0.005):
        simulator.AdvanceTo(time)
        found = plant.CalcSpatialMomentumInWorldAboutPoint(context, np.zeros(3))
        yield np.concatenate([found.translational(), found.rotational()]), plant.GetVelocities(context)[3:6]


def exudyn_body(mbs, body):
    import exudyn as exu
    from exudyn.utilities import RigidBodyInertia

    return mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=body.mass, inertiaTensor=body.inertia),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=body.position,
        initialVelocity=body.velocity,
        initialAngularVelocity=body.spin,
    )


def exudyn_march(mbs, steps):
    """Integrate over 5 ms."""
    import exudyn as exu

    mbs.SolveDynamic(tools.exudyn_settings(0.005, steps), solverType=exu.DynamicSolverType.RK44)


def exudyn_momentum(folder, name, axes):
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name

    mbs, kind = exu.SystemContainer().AddSystem(), exu.OutputVariableType
    cup, ball = (exudyn_body(mbs, body) for body in (CUP, BALL))
    socket = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=cup, localPosition=SOCKET))
    with tools.module(folder, f"{name}_exudyn") as made:
        marker = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ball))
        made.add_joint(mbs, socket, marker, socket_axes=axes.as_matrix())
    mbs.Assemble()

    def motion(number):
        kinds = kind.Position, kind.Velocity, kind.AngularVelocityLocal, kind.RotationMatrix
        *vectors, turn = (np.array(mbs.GetObjectOutputBody(number, each, [0, 0, 0])) for each in kinds)
        return *vectors, turn.reshape(3, 3)

    yield momentum([motion(cup), motion(ball)])
    exudyn_march(mbs, 1000)
    yield momentum([motion(cup), motion(ball)])


def opensim_momentum(folder, name, axes):
    """Expression forces act along the line of centres, so that the axes of their socket make no difference."""
    import opensim as osim

    expression = re.search("<expression>(.*)</expression>", (folder / f"{name}.osim").read_text())[1]
    ends = "/bodyset/cup", osim.Vec3(*SOCKET), "/bodyset/ball", osim.Vec3(0.0, 0.0, 1e-11)
    yield from opensim_meeting(osim.ExpressionBasedPointToPointForce(*ends, expression), axes)


def opensim_plugin_momentum(folder, name, axes):
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
    joint.updSocket("frame1").setConnecteePath("/bodyset/cup/at_socket")
    joint.updSocket("frame2").setConnecteePath("/bodyset/ball")
    yield from opensim_meeting(joint, axes)


def opensim_meeting(force, axes):
    """Meet in OpenSim by a force between the bodies "cup", with its frame "at_socket", and "ball"."""
    osim = tools.silent_opensim()
    model, bodies, joints = osim.Model(), [], []
    model.setGravity(osim.Vec3(0.0))
    for name, body in (("cup", CUP), ("ball", BALL)):
        inertia = osim.Inertia(*np.diag(body.inertia).tolist())
        bodies.append(osim.Body(name, body.mass, osim.Vec3(0.0), inertia))
        joints.append(osim.FreeJoint(f"{name}_free", model.getGround(), bodies[-1]))
        model.addBody(bodies[-1])
        model.addJoint(joints[-1])
    transform = osim.Transform(osim.Rotation(), osim.Vec3(*SOCKET))
    socket = osim.PhysicalOffsetFrame("at_socket", bodies[0], transform)
    socket.set_orientation(osim.Vec3(*axes.as_euler("XYZ").tolist()))
    bodies[0].addComponent(socket)
    force.setName("meeting")
    model.addForce(force)
    model.finalizeConnections()
    state = model.initSystem()
    for joint, body in zip(joints, (CUP, BALL), strict=True):
        start = zip([0, 0, 0, *body.position], [*body.spin, *body.velocity], strict=True)
        for index, (place, speed) in enumerate(start):
            joint.get_coordinates(index).setValue(state, place, False)
            joint.get_coordinates(index).setSpeedValue(state, speed)
    manager = tools.opensim_manager(model, state)

    def motion(body):
        pose, velocity = body.getTransformInGround(state), body.getVelocityInGround(state)
        turn = np.array([[pose.R().get(row, column) for column in range(3)] for row in range(3)])
        return pose.p().to_numpy(), velocity.get(1).to_numpy(), turn.T @ velocity.get(0).to_numpy(), turn

    model.realizeVelocity(state)
    yield momentum(map(motion, bodies))
    state = manager.integrate(0.005)
    model.realizeVelocity(state)
    yield momentum(map(motion, bodies))


@cache
def velocity_after(meeting):
    """Integrate Newton's and Euler's equations of box and ball around the element in Python, to order 8."""
    element, axes = MEETINGS[meeting]

    def rate(_, y):
        (x0, v0, w0, A0), (x1, v1, w1, A1) = ((s[:3], s[3:6], s[6:9], s[9:].reshape(3, 3)) for s in (y[:18], y[18:]))
        arm = x1 - x0  # of the ball's centre from the box's
        seen = v1 - v0 - np.cross(A0 @ w0, arm)
        spin = A1 @ w1 - A0 @ w0
        turn = A0 @ axes.as_matrix()
        load = element(1e3 * axes.as_matrix().T @ (A0.T @ arm - SOCKET), 1e3 * (turn.T @ seen), turn.T @ spin)
        force, moment = turn @ load.force, 1e-3 * (turn @ load.moment)
        torques = A0.T @ (-moment - np.cross(arm, force)), A1.T @ moment
        motions = zip((CUP, BALL), (v0, v1), (w0, w1), (A0, A1), (-force, force), torques, strict=True)
        rates = []
        for body, v, w, A, F, T in motions:
            turning = np.linalg.solve(body.inertia, T - np.cross(w, body.inertia @ w))
            rates += [v, F / body.mass, turning, (A @ np.cross(np.eye(3), w)).ravel()]
        return np.concatenate(rates)

    start = [[*body.position, *body.velocity, *body.spin, *np.eye(3).ravel()] for body in (CUP, BALL)]
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-13, "max_step": 1e-4}
    return solve_ivp(rate, (0.0, 0.005), np.ravel(start), **options).y[21:24, -1]


MOMENTA = mujoco_momentum, drake_momentum, exudyn_momentum, opensim_momentum, opensim_plugin_momentum


@pytest.mark.parametrize("meeting", MEETINGS)
@pytest.mark.parametrize("meet", MOMENTA)
def test_ball_and_free_socket_conserve_linear_and_angular_momentum(meet, meeting, tmp_path):
    """The socket rotates: action equals reaction, their levers are right, and velocities are those that it sees."""
    target = meet.__name__.partition("_")[0]
    skip_without(target)
    element, axes = MEETINGS[meeting]
    if meet is opensim_plugin_momentum and "OPENSIM_INCLUDE" not in os.environ:
        pytest.skip("OPENSIM_INCLUDE does not name the headers of OpenSim's SDK")
    if meet is opensim_momentum and meeting != "frictionless":
        pytest.skip("an expression force of OpenSim has no friction and no rim")
    notes = written(target, element, tmp_path, name=f"meeting_{meeting}")[1]
    assert (notes == "") == (target != "opensim")
    (before, speed), (after, slowed) = meet(tmp_path, f"meeting_{meeting}", axes)
    assert np.linalg.norm(slowed - speed) > 0.005  # they met
    assert_allclose(after, before, atol=1e-14)
    assert_allclose(slowed, velocity_after(meeting), atol=1e-6)


def test_a_ball_in_an_elastic_socket_of_exudyn_conserves_momentum(tmp_path):
    """Four masses and six springs hold the socket; a torque of friction on such a marker is of first order only."""
    skip_without("exudyn")
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name

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
    place = weights @ corners + BALL.position
    ball = exudyn_body(mbs, BALL._replace(position=place.tolist(), spin=[0, 0, 0]))
    with tools.module(tmp_path, "elastic_exudyn") as made:
        made.add_joint(mbs, socket, mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ball)))
    mbs.Assemble()

    def total_momentum():
        """The ball does not turn: no friction acts on it."""
        kind = kinds.Position, kinds.Velocity
        motions = [[mbs.GetNodeOutput(node, each) for each in kind] for node in nodes]
        motions.append([mbs.GetObjectOutputBody(ball, each, [0, 0, 0]) for each in kind])
        masses, (places, speeds) = np.array([[0.2]] * 4 + [[1.0]]), np.moveaxis(np.array(motions), 1, 0)
        return np.hstack([masses * speeds, masses * np.cross(places, speeds)]).sum(axis=0), speeds[-1]

    before, speed = total_momentum()
    exudyn_march(mbs, 2000)
    after, slowed = total_momentum()
    assert np.linalg.norm(slowed - speed) > 0.01  # they met
    assert_allclose(after, before, atol=1e-14)


def test_drake_differentiates_the_forces_of_two_joints_which_are_independent(tmp_path):
    """Minus the gradient of the acceleration is the stiffness over the mass, at rest and without friction."""
    skip_without("drake")
    from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
    from pydrake.multibody.tree import SpatialInertia

    cup = ForceElement(bs.HessForsbach(), HIP, cup=bs.Cup())
    written("drake", cup, tmp_path, name="smooth")
    bodies, turn = [SpatialInertia.SolidSphereWithMass(2.0, 0.018)] * 2, MEETINGS["rim"][1].as_matrix()
    joints = [((0,), {}), ((1,), {"socket_axes": turn})]
    simulator, plant, _ = tools.drake_simulator(tmp_path, "smooth", bodies, joints)
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
        gradients = ExtractGradient(rates)[rows]
        other, own = (slice(7 * body + 4, 7 * body + 7) for body in (1 - index, index))
        assert not gradients[:, other].any()
        assert_allclose(gradients[:, own], -1e3 * axes @ np.array(load.tangent) @ axes.T / 2.0, rtol=1e-6, atol=1.0)
