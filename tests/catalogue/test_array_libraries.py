"""Equal results in every array library, in the caller's dtype, with derivatives."""

from dataclasses import replace

import array_api_strict
import numpy as np
import pytest

import ballsocket as bs

from ..extent import either, some
from ..joints import HIP

FORCES = [0.0, 100.0, 3000.0]
TOTALS = ("force", "indentation", "half_angle", "area", "stiffness", "energy")
NAMES = (*TOTALS, "max_pressure", "max_pressure_angle", "pole_pressure", "foundation_modulus", "pressure_integral")
EVERY = pytest.mark.parametrize("model", bs.catalogue.values(), ids=bs.catalogue)
SOME = pytest.mark.parametrize("model", some(bs.catalogue.values(), 3), ids=lambda model: model.name)
SMOOTH = [model for model in bs.catalogue.values() if model.name != "exact"]
DIFFERENTIABLE = pytest.mark.parametrize("model", SMOOTH, ids=lambda model: model.name)
TRACED = ("hess-forsbach", "bartel", "adhesive", *either((), ("refined", "plane-layer")))
"""Models with each kind of inversion: closed, bracketed, with tension, fitted, iterated; JAX compiles for seconds."""

INPUTS = (3000.0, 17.9, 0.1, 6.75, 1000.0, 0.41, 230000.0, 0.3)  # 0.41: between the columns of Table 3


def joint_of(radius, clearance, thickness=6.75, young=1000.0, poisson=0.4, *ball):
    ball = bs.Material(young=ball[0], poisson=ball[1]) if ball else None
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner, ball=ball)


def of_numbers(model, force, *numbers):
    return model.press(joint_of(*numbers), force=force).max_pressure


def central_differences(model, function=of_numbers):
    shifts = 1e-5 * np.diag(INPUTS)
    above, below = ([function(model, *(INPUTS + side * shift)) for shift in shifts] for side in (1, -1))
    return (np.array(above) - below) / (2e-5 * np.array(INPUTS))


@SOME
def test_models_need_only_the_array_api_standard(model):
    expected = model.press(HIP, force=np.array(FORCES))
    contact = model.press(HIP, force=array_api_strict.asarray(FORCES))
    for name in NAMES:
        value = getattr(contact, name)
        assert type(value) is type(contact.force), name
        assert value.dtype == array_api_strict.float64
        np.testing.assert_allclose(np.from_dlpack(value), getattr(expected, name), rtol=1e-12, err_msg=name)
    angle = array_api_strict.asarray([0.1, 0.2, 0.3])
    np.testing.assert_allclose(np.from_dlpack(contact.pressure(angle)), expected.pressure(np.array([0.1, 0.2, 0.3])))
    np.testing.assert_allclose(np.from_dlpack(contact.friction_torque(0.05)), expected.friction_torque(0.05))
    displacement = array_api_strict.asarray([[0.1, 0.1, 0.0]])
    assert model.force_vector(HIP, displacement).shape == (1, 3)
    for load in ("indentation", "half_angle"):
        assert model.press(HIP, **{load: array_api_strict.asarray([0.01])}).force.dtype == array_api_strict.float64
    assert contact.summary()["model"] == model.name
    assert model.name in repr(contact)


@EVERY
def test_single_precision_is_preserved(model):
    contact = model.press(HIP, force=np.array(FORCES, dtype=np.float32))
    expected = model.press(HIP, force=np.array(FORCES))
    for name in NAMES:
        assert getattr(contact, name).dtype == np.float32, name
        np.testing.assert_allclose(getattr(contact, name)[1:], getattr(expected, name)[1:], rtol=2e-4, err_msg=name)
    assert np.all(contact.status == bs.Status.OK) or model.name == "cosine-limit"


def test_mixed_array_libraries_are_refused():
    joint = bs.Joint(ball_radius=np.array([16.0]), clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    with pytest.raises(TypeError, match="all arrays must be of one library, got array_api_strict.Array, numpy.ndarray"):
        bs.Hertz().press(joint, force=array_api_strict.asarray([1.0]))


def of_loads(model, force, *numbers):
    """Sum of the largest pressures at a load and at none, and of pressures beyond both edges, which are zero."""
    contact = model.press(joint_of(*numbers), force=force * np.array([0.0, 1.0]))
    return contact.max_pressure.sum() + contact.pressure(1.4).sum()


@pytest.mark.parametrize("name", TRACED)
def test_jax_gradients_equal_differences_with_and_without_jit_also_beside_a_point_without_load(name):
    jax, model = pytest.importorskip("jax"), bs.catalogue[name]
    with jax.enable_x64(True):
        numbers = [jax.numpy.asarray(value) for value in INPUTS]
        derive = jax.value_and_grad(lambda *values: of_loads(model, *values), argnums=tuple(range(len(INPUTS))))
        largest, expected = of_loads(model, *INPUTS), central_differences(model, of_loads)
        ways = {"hess-forsbach": (derive, jax.jit(derive)), "plane-layer": (derive,)}  # it compiles for 15 s with jit
        for way in ways.get(name, (jax.jit(derive),)):
            pressure, slopes = way(*numbers)
            assert float(pressure) == pytest.approx(largest, rel=1e-9)
            assert np.max(np.abs(np.array(slopes) - expected) * np.array(INPUTS)) < 1e-7 * largest


def test_jax_arrays_stay_in_jax_and_bad_loads_become_a_status_under_jit():
    jax, model = pytest.importorskip("jax"), bs.HessForsbach()
    contact = model.press(HIP, force=jax.numpy.asarray(FORCES))
    assert isinstance(contact.energy, jax.Array)
    assert contact.energy.dtype == jax.numpy.asarray(FORCES).dtype
    assert jax.jit(lambda force: model.press(HIP, force=force).status)(-1.0) == bs.Status.NOT_REACHED
    with pytest.raises(TypeError, match="exact cannot be traced by JAX: use tabulated or refined"):
        jax.grad(lambda force: bs.Exact().press(HIP, force=force).max_pressure)(3000.0)


LAYERS = bs.Layer(thickness=3.0, material=bs.TITANIUM), bs.Layer(thickness=2.0, material=bs.BONE_CEMENT)
BACKED = replace(HIP, backing=LAYERS)


def test_joints_with_their_layers_and_contacts_are_jax_trees():
    jax = pytest.importorskip("jax")
    import ballsocket.compiled.pytrees  # noqa: F401 - registers the words

    with jax.enable_x64(True):
        slopes = jax.grad(lambda joint: bs.HessForsbach().press(joint, force=3000.0).max_pressure)(HIP)
        assert isinstance(slopes, bs.Joint)
        assert float(slopes.ball.young) == 0.0  # the paper's model has a rigid ball
        above, below = (of_numbers(bs.HessForsbach(), 3000.0, 17.9, 0.1 + side * 1e-6) for side in (1, -1))
        assert float(slopes.clearance) == pytest.approx((above - below) / 2e-6, rel=1e-6)
        pressed = jax.jit(lambda joint: bs.HessForsbach().press(joint, force=3000.0))(HIP)
        assert isinstance(pressed, bs.Contact)
        expected = bs.HessForsbach().press(HIP, force=3000.0).max_pressure
        assert float(pressed.max_pressure) == pytest.approx(expected, rel=1e-9)
        many = jax.vmap(lambda force: bs.Bartel().press(HIP, force=force).max_pressure)(jax.numpy.asarray(FORCES[1:]))
        np.testing.assert_allclose(many, bs.Bartel().press(HIP, force=np.array(FORCES[1:])).max_pressure, rtol=1e-12)
    behind = (strength for layer in BACKED.backing for strength in layer.material.strengths.values())
    known = [*BACKED.numbers(), *BACKED.strengths(), *behind]
    assert sorted(jax.tree_util.tree_leaves(BACKED)) == sorted(known)
    slopes = jax.grad(lambda joint: joint.backing_ratio)(BACKED)
    softest = slopes.backing[1].material
    assert float(softest.young) == pytest.approx(-1000.0 / 2300.0**2)
    assert float(slopes.backing[0].material.young) == 0.0
    free = jax.jit(lambda joint: joint.backing_ratio)(replace(BACKED, support=bs.Support.FREE))
    assert float(free) == np.inf
    assert not bool(jax.jit(lambda joint: bs.Vessel().press(joint, force=3000.0).valid)(BACKED))


def test_a_backing_of_arrays_is_validated_in_their_library():
    torch = pytest.importorskip("torch")
    for asarray in (np.asarray, array_api_strict.asarray, torch.tensor):
        young = asarray([1e3, 1e5])
        layer = bs.Layer(thickness=asarray([2.0, np.inf]), material=bs.Material(young=young, poisson=0.3))
        for support, expected in ((bs.Support.FIXED, [False, True]), (bs.Support.FREE, [False, True])):
            contact = bs.Vessel().press(replace(HIP, backing=(layer,), support=support), force=3000.0)
            assert type(contact.max_pressure) is type(young)
            assert np.asarray(contact.valid).tolist() == expected


@DIFFERENTIABLE
def test_torch_gradients_equal_differences(model):
    torch = pytest.importorskip("torch")
    numbers = [torch.tensor(value, dtype=torch.float64, requires_grad=True) for value in INPUTS]
    of_numbers(model, *numbers).backward()
    slopes = np.array([0.0 if number.grad is None else float(number.grad) for number in numbers])
    scale = np.abs(of_numbers(model, *INPUTS) / np.array(INPUTS))
    assert np.max(np.abs(slopes - central_differences(model)) / scale) < 1e-7


@EVERY
def test_torch_tensors_preserve_their_dtype(model):
    torch = pytest.importorskip("torch")
    contact = model.press(HIP, force=torch.tensor(FORCES))
    for name in NAMES:
        assert getattr(contact, name).dtype == torch.float32, name
    assert contact.valid.shape == (3,)


def test_an_inverted_law_has_its_second_derivative_and_a_massive_socket_a_first_one():
    """d²d/dF² = -S'/S³, through the bracketed inversion of the adhesive socket."""
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        model = bs.AdhesiveSocket(work_of_adhesion=1e-3)
        second = jax.grad(jax.grad(lambda force: model.press(HIP, force=force).indentation))(3000.0)
        above, below = (1 / model.press(HIP, force=force).stiffness for force in (3001.0, 2999.0))
        assert float(second) == pytest.approx((above - below) / 2, rel=1e-5)
        slope = jax.grad(lambda radius: of_numbers(bs.Vessel(), 3000.0, radius, 0.1, np.inf))(17.9)
        assert np.isfinite(float(slope))


def test_contacts_of_plain_numbers_accept_arrays_of_any_library():
    jax, torch = pytest.importorskip("jax"), pytest.importorskip("torch")
    model = bs.HessForsbach()
    contact = model.press(HIP, force=3000.0)
    for angle in (jax.numpy.asarray(0.3), torch.tensor(0.3)):
        assert float(contact.pressure(angle)) == pytest.approx(contact.pressure(0.3), rel=1e-5)
    pushed = model.force_vector(HIP, torch.tensor([0.0, 0.0, -0.14], dtype=torch.float64))
    assert isinstance(pushed, torch.Tensor)
    single = np.asarray(model.force_vector(HIP, jax.numpy.asarray([0.0, 0.0, -0.14])))
    np.testing.assert_allclose(single, pushed.numpy(), rtol=1e-4, atol=1e-2)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore")  # tracing warns of caches in array_api_compat
def test_a_press_is_one_graph_of_torch():
    """`fullgraph` raises an error where tracing has to leave the graph."""
    torch, model = pytest.importorskip("torch"), bs.HessForsbach()

    def press(force, clearance):
        joint = bs.Joint(ball_radius=16.0, clearance=clearance, liner_thickness=6.0, liner=bs.UHMWPE)
        contact = model.press(joint, force=force)
        return contact.max_pressure, contact.indentation

    inputs = torch.tensor([500.0, 3000.0], dtype=torch.float64), torch.tensor([0.05, 0.1], dtype=torch.float64)
    compiled = torch.compile(press, fullgraph=True, backend="eager")
    for value, expected in zip(compiled(*inputs), press(*inputs), strict=True):
        assert value.tolist() == pytest.approx(expected.tolist(), rel=1e-14)
