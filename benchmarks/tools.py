"""A ball that bounces in its socket, in every program that a joint is exported to: one function a program.

Each takes the bounce and the folder that `ballsocket export` wrote into, and returns positions in mm at the times asked
for. All forces come from what was exported; the package itself takes no part.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy

import ballsocket as bs

Path3 = numpy.ndarray
NAME = "bouncing"


@dataclass(frozen=True, kw_only=True)
class Bounce:
    """A ball of 1 kg under its weight along -z: where and how fast it begins in mm and mm/s, and the times in s.

    `gravity` is in m/s².
    """

    element: bs.ForceElement
    position: tuple[float, float, float] = (0.05, 0.0, 0.02)
    velocity: tuple[float, float, float] = (60.0, 20.0, 80.0)
    duration: float = 0.02
    samples: int = 201
    gravity: float = 9.81

    @property
    def times(self) -> numpy.ndarray:
        return numpy.linspace(0.0, self.duration, self.samples)

    @property
    def radius(self) -> float:
        """Radius of the ball in m."""
        return 1e-3 * self.element.constants.ball_radius

    @property
    def turning(self) -> float:
        """The moment of inertia in kg m²: a solid ball."""
        return 0.4 * self.radius**2

    @property
    def si(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Position and velocity in m and m/s."""
        return 1e-3 * numpy.array(self.position), 1e-3 * numpy.array(self.velocity)


def by_load(bounce: Bounce, load: Callable[[Any, Any, Any], tuple[Any, Any]]) -> Path3:
    """Dormand and Prince of order 8 on a load in SI units, tolerance 1e-11."""
    from scipy.integrate import solve_ivp

    def rate(_: float, y: numpy.ndarray) -> numpy.ndarray:
        force, moment = load(y[:3], y[3:6], y[6:])
        pulled = numpy.array(force) - [0.0, 0.0, bounce.gravity]
        return numpy.concatenate([y[3:6], pulled, numpy.array(moment) / bounce.turning])

    start = numpy.concatenate([*bounce.si, numpy.zeros(3)])
    options: dict[str, Any] = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "max_step": 1e-4}
    found = solve_ivp(rate, (0.0, bounce.duration), start, t_eval=bounce.times, **options)
    return 1e3 * found.y[:3].T


def mujoco(bounce: Bounce, folder: Path) -> Path3:
    """The plug-in, with Runge and Kutta's steps of 2 µs."""
    import mujoco as mj

    with module(folder, f"{NAME}_mujoco") as made:
        if f"ballsocket.{NAME}" not in _LOADED:
            made.load_plugin()
            _LOADED.add(f"ballsocket.{NAME}")
    model = mj.MjModel.from_xml_path(str(folder / f"{NAME}.xml"))
    model.opt.timestep = 2e-6
    return _mujoco_steps(mj, bounce, model)


_LOADED: set[str] = set()


def _mujoco_steps(mj: Any, bounce: Bounce, model: Any) -> Path3:
    model.opt.gravity[:] = (0.0, 0.0, -bounce.gravity)
    data = mj.MjData(model)
    data.qpos[:3], data.qvel[:3] = bounce.si
    found = [1e3 * data.qpos[:3].copy()]
    steps = round(bounce.duration / (bounce.samples - 1) / model.opt.timestep)
    for _ in bounce.times[1:]:
        mj.mj_step(model, data, steps)
        found.append(1e3 * data.qpos[:3].copy())
    return numpy.array(found)


def mujoco_callback(bounce: Bounce, folder: Path) -> Path3:
    """The callback, in steps of 10 µs, in a model without the plug-in."""
    import mujoco as mj

    ball = f'<freejoint/><geom type="sphere" size="{bounce.radius!r}" mass="1" contype="0"/><site name="ball"/>'
    model = mj.MjModel.from_xml_string(
        '<mujoco><option integrator="RK4" timestep="1e-5" gravity="0 0 -9.81"/><worldbody><site name="socket"/>'
        f"<body>{ball}</body></worldbody></mujoco>"
    )
    with module(folder, f"{NAME}_mujoco") as made:
        sites = [mj.mj_name2id(model, mj.mjtObj.mjOBJ_SITE, name) for name in ("ball", "socket")]
        mj.set_mjcb_passive(made.callback(*sites))
        try:
            return _mujoco_steps(mj, bounce, model)
        finally:
            mj.set_mjcb_passive(None)


def warp(bounce: Bounce, folder: Path) -> Path3:
    """The functions of Warp in double precision, with steps of 0.2 µs of second order."""
    import warp as wp

    with module(folder, f"{NAME}_warp") as made:
        laws = made.laws(wp.float64)
    vector, count = laws.vec3, round(bounce.duration / (bounce.samples - 1) / 2e-7)
    half = wp.constant(wp.float64(0.5 * bounce.duration / (bounce.samples - 1) / count))
    weight, turning = wp.constant(wp.float64(bounce.gravity)), wp.constant(wp.float64(bounce.turning))

    @wp.kernel
    def march(table: wp.array2d(dtype=wp.float64), state: wp.array(dtype=vector), steps: int):  # type: ignore
        r, v, w = state[0] + vector(), state[1] + vector(), state[2] + vector()
        half_v, half_w = vector(), vector()  # changes of velocity and spin in the half of a step, of the step before
        for _ in range(steps):
            r += half * v
            force, moment, _energy = laws.load(table, r, v + half_v, w + half_w)
            force[2] -= weight
            half_v, half_w = half * force, half / turning * moment
            v += wp.float64(2.0) * half_v
            w += wp.float64(2.0) * half_w
            r += half * v
        state[0] = r
        state[1] = v
        state[2] = w

    state, table = wp.array(numpy.array([*bounce.si, numpy.zeros(3)]), dtype=vector, device="cpu"), laws.table_on("cpu")
    found = [1e3 * bounce.si[0]]
    for _ in bounce.times[1:]:
        wp.launch(march, 1, [table, state, count], device="cpu")
        found.append(1e3 * state.numpy()[0])
    return numpy.array(found)


def c(bounce: Bounce, folder: Path) -> Path3:
    """The program in C by its module of Python, order 8."""
    with module(folder, NAME) as made:
        return by_load(bounce, lambda r, v, w: made.load(r, v, w)[:2])


def drake(bounce: Bounce, folder: Path) -> Path3:
    """The LeafSystem, with Runge and Kutta's third order, accuracy 1e-10."""
    from pydrake.multibody.tree import SpatialInertia
    from pydrake.systems.analysis import ResetIntegratorFromFlags

    ball = SpatialInertia.SolidSphereWithMass(1.0, bounce.radius)
    simulator, plant, context = drake_simulator(folder, NAME, [ball], [((0,), {})], bounce.gravity)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", 1e-4)
    integrator = simulator.get_mutable_integrator()
    integrator.set_target_accuracy(1e-10)
    integrator.set_maximum_step_size(2e-5)
    position, velocity = bounce.si
    plant.SetPositions(context, [1.0, 0.0, 0.0, 0.0, *position])
    plant.SetVelocities(context, [0.0, 0.0, 0.0, *velocity])
    found = []
    for time in bounce.times:
        simulator.AdvanceTo(time)
        found.append(1e3 * plant.GetPositions(context)[4:])
    return numpy.array(found)


def drake_simulator(folder: Path, name: str, inertias: Any, joints: Any, gravity: float = 0.0) -> tuple[Any, Any, Any]:
    """Simulator, plant and context; a joint is the numbers of its one or two bodies and options of `add_joint`."""
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    bodies = [plant.AddRigidBody(f"body{number}", inertia) for number, inertia in enumerate(inertias)]
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -gravity])
    plant.Finalize()
    with module(folder, f"{name}_drake") as made:
        for numbers, options in joints:
            made.add_joint(builder, plant, *(bodies[number] for number in numbers), **options)
    simulator = Simulator(builder.Build())
    return simulator, plant, plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())


def exudyn(bounce: Bounce, folder: Path) -> Path3:
    """The user function, with Runge and Kutta's steps of 2 µs."""
    with module(folder, f"{NAME}_exudyn") as made:
        return _exudyn(bounce, made.add_joint)


def exudyn_hollow_sphere(bounce: Bounce, folder: Path) -> Path3:
    """Exudyn's own hollow sphere, with the k and n that come nearest, in the same steps."""
    with module(folder, f"{NAME}_exudyn") as made:
        return _exudyn(bounce, made.add_hollow_sphere)


def _exudyn(bounce: Bounce, add: Callable[..., Any]) -> Path3:
    import exudyn as exu
    from exudyn import itemInterface as items  # noqa: N813 - a module's name
    from exudyn.utilities import InertiaSphere

    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(items.ObjectGround())
    socket = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[0.0, 0.0, 0.0]))
    position, velocity = bounce.si
    ball = mbs.CreateRigidBody(
        inertia=InertiaSphere(1.0, bounce.radius),
        nodeType=exu.NodeType.RotationRotationVector,
        referencePosition=[0.0, 0.0, 0.0],
        initialDisplacement=list(position),
        initialVelocity=list(velocity),
        gravity=[0.0, 0.0, -bounce.gravity],
    )
    add(mbs, socket, mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=ball, localPosition=[0.0, 0.0, 0.0])))
    place = mbs.AddSensor(
        items.SensorBody(bodyNumber=ball, storeInternal=True, outputVariableType=exu.OutputVariableType.Displacement)
    )
    mbs.Assemble()
    settings = exudyn_settings(bounce.duration, 50 * (bounce.samples - 1), bounce.samples)
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    return 1e3 * mbs.GetSensorStoredData(place)[:, 1:4]


def exudyn_settings(duration: float, steps: int, samples: int = 2) -> Any:
    """Equal steps, and times at which sensors are read."""
    import exudyn as exu

    settings = exu.SimulationSettings()
    march = settings.timeIntegration
    march.endTime, march.numberOfSteps, march.automaticStepSize, march.verboseMode = duration, steps, False, 0
    march.discontinuous.maxIterations = 1  # what a contact with a state of its own asks for
    march.discontinuous.ignoreMaxIterations = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = duration / (samples - 1)
    return settings


def opensim(bounce: Bounce, folder: Path) -> Path3:
    """The expression force."""
    osim = silent_opensim()
    model = osim.Model(str(folder / f"{NAME}.osim"))
    model.setGravity(osim.Vec3(0.0, 0.0, -bounce.gravity))
    state = model.initSystem()
    coordinates = [model.getCoordinateSet().get(name) for name in ("x", "y", "z")]
    for coordinate, place, speed in zip(coordinates, *bounce.si, strict=True):
        coordinate.setValue(state, float(place), False)
        coordinate.setSpeedValue(state, float(speed))
    manager = opensim_manager(model, state)
    found = [1e3 * bounce.si[0]]
    for time in bounce.times[1:]:
        state = manager.integrate(float(time))
        found.append(numpy.array([1e3 * coordinate.getValue(state) for coordinate in coordinates]))
    return numpy.array(found)


def silent_opensim() -> Any:
    import opensim

    opensim.Logger.setLevelString("Error")
    opensim.Logger.removeFileSink()  # no opensim.log in the working directory
    return opensim


def opensim_manager(model: Any, state: Any) -> Any:
    """Runge, Kutta and Merson's steps, accuracy 1e-10."""
    manager = silent_opensim().Manager(model)
    manager.setIntegratorAccuracy(1e-10)
    manager.setIntegratorMaximumStepSize(2e-5)
    manager.setWriteToStorage(False)
    manager.initialize(state)
    return manager


@contextmanager
def module(folder: Path, name: str) -> Any:
    """A module of a folder, and what it imports from there."""
    known = set(sys.modules)
    sys.path.insert(0, str(folder))
    try:
        yield import_module(name)
    finally:
        sys.path.remove(str(folder))
        for each in set(sys.modules) - known:
            if each.startswith(name.partition("_")[0]):
                del sys.modules[each]
