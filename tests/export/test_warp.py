"""The module of Warp: its formulas on a stand-in for Warp, and its functions in Warp, Newton and MuJoCo Warp."""

import math
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.dynamics import Damping, ForceElement, Friction

from ..joints import HIP
from .library import load_module, needs_compiler, skip_without, written

LOSSY = ForceElement(bs.HessForsbach(), HIP, Damping(hysteresis=0.004), Friction(coefficient=0.05), cup=bs.Cup())
SMOOTH = ForceElement(bs.Tabulated(), HIP)


def states(count=300):
    """Positions from far inside the clearance to a deep contact, on all sides, in mm, mm/s and rad/s."""
    random = np.random.default_rng(1)
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    depth = np.append(10 ** random.uniform(-6.0, -1.2, count - 2), [-0.05, -HIP.clearance])
    return direction * (HIP.clearance + depth)[:, None], *random.normal(size=(2, count, 3)) * [[[20.0]], [[2.0]]]


def stand_in():
    """Names of Warp that a module needs, as functions of Python's numbers in double precision."""

    class Vector(np.ndarray):
        def __new__(cls, *parts):
            return np.array(parts or (0.0,) * 4, dtype=float).view(cls)

    numbers = {name: getattr(math, name) for name in ("sqrt", "exp", "log", "atan2", "inf", "nan")}
    types = dict.fromkeys(("vec3", "mat33", "spatial_vector", "transform"), SimpleNamespace)
    return SimpleNamespace(
        float32=np.float32,
        float64=float,
        int32=int,
        int64=int,
        constant=lambda value: value,
        func=lambda function: function,
        kernel=lambda function: function,
        array=lambda data=None, **words: data,
        array2d=lambda **words: None,
        cast=lambda number, kind: int(np.float64(number).view(np.int64)),
        clamp=lambda number, low, high: min(max(number, low), high),
        where=lambda condition, a, b: a if condition else b,
        types=SimpleNamespace(vector=lambda *size: Vector, matrix=lambda *size: Vector),
        **{"abs": abs, "max": max, "min": min, **numbers, **types},
    )


@pytest.mark.parametrize("element", [LOSSY, SMOOTH], ids=["lossy", "smooth"])
def test_the_formulas_of_the_module_are_those_of_the_element(element, tmp_path, monkeypatch):
    """The curve of the energy is within 1e-9 of the law."""
    monkeypatch.setitem(sys.modules, "warp", stand_in())
    written("warp", element, tmp_path, name="hip")
    module = load_module(tmp_path, "hip_warp")
    laws = module.laws(float)
    positions, velocities, spins = states(100)
    load, table = element(positions, velocities, spins), laws.table_on()
    for index, (r, v, w) in enumerate(zip(1e-3 * positions, 1e-3 * velocities, spins, strict=True)):
        force, moment, energy = laws.load(table, r, v, w)
        assert_allclose(force, load.force[index], rtol=1e-8, atol=1e-8)
        assert_allclose(moment, 1e-3 * load.moment[index], rtol=1e-8, atol=1e-10)
        assert energy == pytest.approx(1e-3 * load.energy[index], rel=1e-8, abs=1e-15)
        tangent = np.reshape(laws.tangent(table, r), (3, 3))
        assert_allclose(tangent, 1e3 * np.array(load.tangent[index]), rtol=1e-6, atol=1.0)  # N/m of 1e8


@pytest.fixture(scope="module")
def lossy(tmp_path_factory):
    skip_without("warp")
    folder = tmp_path_factory.mktemp("warp")
    written("warp", LOSSY, folder, name="hip")
    return load_module(folder, "hip_warp")


@pytest.mark.long
@pytest.mark.parametrize(("precision", "near"), [("float64", 1e-8), ("float32", 2e-6)])
def test_warp_computes_loads_and_tangent_in_both_precisions(precision, near, lossy):
    """Single precision has seven digits of the distance between the centres."""
    import warp as wp

    real, (positions, velocities, spins) = getattr(wp, precision), states()
    laws, matrix = lossy.laws(real), wp.types.matrix((3, 3), real)
    vector = laws.vec3

    @wp.kernel
    def solve(
        table: wp.array2d(dtype=real),
        r: wp.array(dtype=vector),
        v: wp.array(dtype=vector),
        w: wp.array(dtype=vector),
        forces: wp.array(dtype=vector),
        moments: wp.array(dtype=vector),
        tangents: wp.array(dtype=matrix),
    ):
        i = wp.tid()
        force, moment, _ = laws.load(table, r[i], v[i], w[i])
        forces[i] = force
        moments[i] = moment
        tangents[i] = laws.tangent(table, r[i])

    given = [wp.array(part, dtype=vector) for part in (1e-3 * positions, 1e-3 * velocities, spins)]
    found = [wp.zeros(len(spins), dtype=kind) for kind in (vector, vector, matrix)]
    wp.launch(solve, len(spins), [laws.table_on(), *given], found)
    load = LOSSY(positions, velocities, spins)
    for got, wanted in zip(found, (load.force, 1e-3 * load.moment, 1e3 * np.array(load.tangent)), strict=True):
        assert_allclose(got.numpy(), wanted, atol=near * abs(wanted).max())


@pytest.mark.long
def test_a_ball_settles_in_newton_under_a_tilted_load_as_deep_as_the_model(lossy):
    newton, wp = pytest.importorskip("newton"), pytest.importorskip("warp")
    tilts, builder = np.radians([0.0, 30.0, 45.0]), newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    for _ in tilts:
        builder.add_body(mass=1.0, inertia=wp.mat33(*np.diag([1.28e-4] * 3).ravel()))
    model = builder.finalize(device="cpu")
    joints, solver = lossy.Joints(model, range(3)), newton.solvers.SolverSemiImplicit(model, angular_damping=0.0)
    state, following, control = model.state(), model.state(), model.control()
    load = 3000.0 * np.array([np.sin(tilts), 0.0 * tilts, np.cos(tilts)]).T
    pull = wp.array(np.hstack([load, 0.0 * load]), dtype=wp.spatial_vector)
    for _ in range(2000):
        wp.copy(state.body_f, pull)
        joints.apply(state)
        solver.step(state, following, control, None, 1e-5)
        state, following = following, state
    positions = 1e3 * state.body_q.numpy()[:, :3]
    depths = np.linalg.norm(positions, axis=1) - HIP.clearance
    assert_allclose(depths, LOSSY.model.press(HIP, force=3000.0).indentation, rtol=1e-3)  # 1 % is promised
    assert_allclose(np.arctan2(positions[:, 0], positions[:, 2]), tilts, atol=1e-3)


@pytest.mark.long
def test_forces_on_ball_and_socket_are_opposite_and_leave_the_angular_momentum(lossy):
    """Both bodies turn, and neither has its centre of mass at its end of the joint."""
    newton, wp = pytest.importorskip("newton"), pytest.importorskip("warp")
    builder, turned = newton.ModelBuilder(), wp.quat_from_axis_angle(wp.normalize(wp.vec3(1.0, 2.0, 3.0)), 0.7)
    inertia, frame = wp.mat33(*np.eye(3).ravel()), wp.transform(wp.vec3(0.02, 0.0, -0.03), wp.quat_identity())
    place = wp.transform(wp.vec3(0.0), turned)
    builder.add_body(xform=place, com=wp.vec3(0.01, 0.0, 0.0), mass=2.0, inertia=inertia)
    centre = wp.transform_point(wp.transform_multiply(place, frame), wp.vec3(5e-5, 2e-5, 1.2e-4))
    builder.add_body(
        xform=wp.transform(centre, wp.quat_identity()), com=wp.vec3(0.0, 0.05, 0.0), mass=1.0, inertia=inertia
    )
    model = builder.finalize(device="cpu")
    state = model.state()
    state.body_qd.assign(np.array([[0.1, 0.2, 0.3, 1.0, 2.0, 3.0], [0.4, 0.1, 0.2, 3.0, 1.0, 2.0]], np.float32))
    state.clear_forces()
    lossy.Joints(model, [1], [0], socket_frames=[frame]).apply(state)
    (pushed, turning), (pull, twist) = state.body_f.numpy().reshape(2, 2, 3).astype(float)
    poses, coms = state.body_q.numpy(), model.body_com.numpy()
    points = [
        np.array(wp.transform_point(wp.transform(*pose), wp.vec3(*com))) for pose, com in zip(poses, coms, strict=True)
    ]
    assert np.linalg.norm(pull) > 100.0
    assert_allclose(pushed, -pull, rtol=1e-6)
    total = turning + twist + np.cross(points[0], pushed) + np.cross(points[1], pull)
    assert_allclose(total, 0.0, atol=1e-5 * np.linalg.norm(turning))
    axes = np.array(wp.quat_to_matrix(turned)).reshape(3, 3)
    velocities = state.body_qd.numpy().astype(float)
    origin = np.array(wp.transform_get_translation(wp.transform_multiply(place, frame)))
    held, spin = velocities[:, 3:]
    speed = velocities[1, :3] + np.cross(spin, np.array(centre) - points[1])
    speed = speed - velocities[0, :3] - np.cross(held, np.array(centre) - points[0])
    arm = np.array(centre) - origin
    load = LOSSY(*(scale * axes.T @ part for scale, part in ((1e3, arm), (1e3, speed), (1.0, spin - held))))
    assert_allclose(pull, axes @ np.array(load.force), rtol=1e-3)  # the position has seven digits of 40 mm


@pytest.mark.long
@needs_compiler
def test_the_callback_of_mujoco_warp_has_the_passive_forces_of_mujoco(lossy, tmp_path, monkeypatch):
    mujoco, mjw = pytest.importorskip("mujoco"), pytest.importorskip("mujoco_warp")
    written("mujoco", LOSSY, tmp_path, name="beside_warp")
    cup = '<geom size=".03" mass="2" contype="0"/><site name="socket" pos=".01 0 .002"/>'
    ball = '<geom size=".0179" mass="1" contype="0"/><site name="ball"/>'
    bodies = f'<body euler="10 20 30"><freejoint/>{cup}</body><body><freejoint/>{ball}</body>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    ball, socket = (mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) for name in ("ball", "socket"))
    data.qpos[7:10] = data.site_xpos[socket] + [5e-5, 2e-5, 1.2e-4]
    data.qvel[:] = [0.1, 0.2, 0.3, 1.0, 2.0, 3.0, 0.4, 0.1, 0.2, 3.0, 1.0, 2.0]
    compiled, device_data = mjw.put_model(model), mjw.put_data(model, data)
    compiled.callback.passive = lossy.mujoco_callback([ball], [socket])
    mjw.forward(compiled, device_data)
    monkeypatch.syspath_prepend(str(tmp_path))
    mujoco.set_mjcb_passive(load_module(tmp_path, "beside_warp_mujoco").callback(ball, socket))
    try:
        mujoco.mj_forward(model, data)
    finally:
        mujoco.set_mjcb_passive(None)
    assert np.linalg.norm(data.qfrc_passive) > 100.0
    assert_allclose(device_data.qfrc_passive.numpy()[0], data.qfrc_passive, rtol=1e-3, atol=1e-3)
