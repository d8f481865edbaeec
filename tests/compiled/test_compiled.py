"""The compiled path is the same model."""

import numpy as np
import pytest

import ballsocket as bs

from ..extent import some
from ..joints import HIP, random_joint

pytest.importorskip("numba")
import numba

from ballsocket.compiled import Compiled, compiled_law, overloads, table_kernel
from ballsocket.contact.roots import increasing_root

KINEMATICS = (bs.linear_kinematics, bs.exact_kinematics, bs.cosine_kinematics)
MODULI = (bs.hess_forsbach, bs.spherical_vessel, bs.bonded_layer, bs.polynomial(1.0, 1.2, 0.1), bs.constant(250.0))
MODELS = [bs.RadialFoundation(modulus=modulus, kinematics=way) for modulus in MODULI for way in KINEMATICS]
NAMES = ("force", "indentation", "half_angle", "max_pressure", "area", "stiffness", "energy", "status", "valid")
SOLVED = ("pole_pressure", "foundation_modulus", "pressure_integral")


def assert_same(one: bs.Contact, other: bs.Contact, names: tuple[str, ...] = NAMES, rtol: float = 2e-14) -> None:
    assert one.indentation.shape == other.indentation.shape
    for name in names:
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=rtol, err_msg=name)


@pytest.mark.parametrize("model", some(MODELS, 1), ids=lambda model: f"{model.modulus.name}-{model.kinematics.name}")
def test_compiled_and_python_models_agree_on_random_joints(model):
    joint = random_joint(2_000, seed=11)
    force = joint.liner.young * joint.ball_radius**2 * 1e-6
    assert_same(Compiled(model=model).press(joint, force=force), model.press(joint, force=force))


def test_compiled_presses_accept_shapes_numbers_strides_and_arrays_of_strengths():
    fast, model = Compiled(model=bs.HessForsbach()), bs.HessForsbach()
    force = np.linspace(0.0, 4000.0, 24).reshape(4, 6)
    column = HIP.replace(ball_radius=np.array([[14.0], [16.0]]))
    for joint, load in ((HIP, force), (HIP, force[::2, ::-1].T), (column, force[:, 0])):
        assert_same(fast.press(joint, force=load), model.press(joint, force=load))
    joint = HIP.replace(liner=bs.Material(young=800.0, poisson=0.45, yield_stress=np.array([[15.0], [20.0]])))
    force = np.array([500.0, 1000.0, 2000.0])
    one, other = (model.press(joint, force=force) for model in (Compiled(model=bs.HessForsbach()), bs.HessForsbach()))
    assert one.utilisation.shape == one.force.shape == (2, 3)
    np.testing.assert_allclose(one.utilisation, other.utilisation, rtol=1e-12)


def test_loads_that_are_not_compiled_use_the_python_model():
    fast, model = Compiled(model=bs.Bartel()), bs.Bartel()
    assert fast.press(HIP, force=3000.0).indentation == model.press(HIP, force=3000.0).indentation
    for load in ({"indentation": np.array([0.01, 0.02])}, {"half_angle": np.array([0.3])}):
        assert_same(fast.press(HIP, **load), model.press(HIP, **load))
    single = fast.press(HIP, force=np.array([3000.0], dtype=np.float32))
    assert single.max_pressure.dtype == np.float32


def test_compiled_presses_fail_as_the_python_model():
    fast, model = Compiled(model=MODELS[0]), MODELS[0]
    force = np.array([3000.0, 1e13])
    assert_same(fast.press(HIP, force=force), model.press(HIP, force=force))
    joint = HIP.replace(liner=bs.Material(young=1e3, poisson=np.array([0.4, 0.5])))
    assert_same(fast.press(joint, force=force[:1]), model.press(joint, force=force[:1]))
    tight = bs.Joint(ball_radius=16.0, interference=0.01, liner_thickness=6.0, liner=bs.UHMWPE)
    with pytest.raises(bs.OutsideDomainError, match="preloaded"):
        fast.press(tight, force=force)
    with pytest.raises(ValueError, match="force = -1|force.0. = -1"):
        fast.press(HIP, force=np.array([-1.0]))


@pytest.mark.parametrize("count", [2, 3])
def test_blocks_of_series_are_chebyshev_series_with_their_slopes(count):
    functions, x = np.random.default_rng(6).normal(size=(count, 8, 3)), np.array([-0.9, 0.1, 0.8])
    rows = np.zeros((25, 3))
    rows[0] = x
    table_kernel.sum_series_with_slopes(functions, count, 0, 3, rows, 0, 1, 7, 13)
    values, slopes = rows[1 : 1 + count].copy(), rows[4 : 4 + count].copy()
    for value, slope, series in zip(values, slopes, functions, strict=True):
        table_kernel.sum_series(series, 0, 3, rows, 0, 11, 7, 13)
        for j, coefficients in enumerate(series.T):
            chebyshev = np.polynomial.chebyshev.Chebyshev(coefficients)
            np.testing.assert_allclose([value[j], rows[11, j]], [chebyshev(x[j])] * 2, rtol=1e-12)
            np.testing.assert_allclose(slope[j], chebyshev.deriv()(x[j]), rtol=1e-12)


SPECIAL = [0.0, -1.0, 1.0, np.inf, -np.inf, np.nan]
RANGES = {
    "exp": [*np.linspace(-740.0, 709.0, 20_000), *SPECIAL, -800.0, 800.0],
    "log": [*np.exp(np.linspace(-740.0, 709.0, 20_000)), *SPECIAL, 5e-324],
    "log1p": [*np.exp(np.linspace(-80.0, 50.0, 20_000)), *SPECIAL],
    "sin": [*np.linspace(-7.0, 7.0, 20_000), 0.0, np.nan],
    "cos": [*np.linspace(-7.0, 7.0, 20_000), 0.0, np.nan],
}


@pytest.mark.parametrize("name", RANGES)
def test_functions_without_branches_are_accurate_to_two_units_in_the_last_place(name):
    function, x = overloads.VECTOR_FUNCTIONS[name], np.array(RANGES[name])

    @numba.njit(error_model="numpy")
    def evaluate(x, values):  # type: ignore[no-untyped-def]
        for i in range(x.size):
            values[i] = function(x[i])

    values = np.empty_like(x)
    evaluate(x, values)
    with np.errstate(all="ignore"):
        expected = getattr(np, name)(x)
    np.testing.assert_allclose(values, expected, rtol=4.5e-16, atol=5e-324)


def liners(size: int, ball: bs.Material | None = None) -> bs.Joint:
    """Bonded liners of hips, each its own, some of them beyond what is tabulated."""
    rng = np.random.default_rng(5)
    liner = bs.Material(young=rng.uniform(500.0, 1500.0, size), poisson=rng.uniform(0.25, 0.5, size))
    lengths = {"ball_radius": (11.0, 23.0), "clearance": (0.02, 0.4), "liner_thickness": (0.8, 12.0)}
    sizes = {name: rng.uniform(*limits, size) for name, limits in lengths.items()}
    return bs.Joint(**sizes, liner=liner, ball=ball)


@pytest.mark.long
@pytest.mark.parametrize("ball", [bs.COCR, None], ids=["elastic ball", "rigid ball"])
def test_compiled_tables_agree_to_eleven_digits(ball):
    model, joint = bs.Tabulated(), liners(3_000, ball)
    fast = Compiled(model=model)
    force = np.random.default_rng(1).uniform(-1.0, 1.0, 3_000).clip(0.0) * 1e5  # a half of them without load
    force[:4] = 1e-6, 0.01, 0.5, 2.0
    by_force = model.press(joint, force=force)
    depth = np.where(np.isnan(by_force.indentation), 50.0, by_force.indentation)
    assert set(np.unique(by_force.status)) >= {bs.Status.OK, bs.Status.NOT_REACHED}
    for load in ({"force": force}, {"indentation": depth}):
        one, other = fast.press(joint, **load), model.press(joint, **load)
        assert_same(one, other, (*NAMES, *SOLVED), rtol=1e-11)
        assert one.notes == other.notes


@pytest.mark.long
def test_compiled_tables_broadcast_joints_and_loads():
    model, row = bs.Tabulated(), np.array([500.0, 3000.0])
    fast = Compiled(model=model)
    for pressed, force in ((liners(2), row[:, None]), (HIP, row), (HIP, row[:0]), (HIP, np.array(500.0))):
        assert_same(fast.press(pressed, force=force), model.press(pressed, force=force), ("indentation",), 1e-13)
    assert fast.press(HIP, force=3000.0).indentation == model.press(HIP, force=3000.0).indentation


@numba.njit
def evaluate_compiled(law, depths):  # type: ignore[no-untyped-def]
    results = np.empty((depths.size, 2))
    for i in range(depths.size):
        results[i] = law(depths[i])
    return results


DEPTHS = np.concatenate([[-1.0, 0.0, np.nan, np.inf, 1e3], np.geomspace(1e-9, 10.0, 300)])


@pytest.mark.parametrize("model", some([*MODELS[:3], bs.Tabulated()], 1), ids=lambda model: model.name)
def test_compiled_law_equals_the_python_law_in_both_kinds_of_programs(model):
    law, plain = Compiled(model=model).law(HIP), model.law(HIP)
    results = np.array([plain(depth) for depth in DEPTHS.tolist()])
    np.testing.assert_allclose(evaluate_compiled(law, DEPTHS), results, rtol=1e-13)
    np.testing.assert_array_equal([law(depth) for depth in DEPTHS.tolist()], evaluate_compiled(law, DEPTHS))


@pytest.mark.parametrize("name", some(["exact", "plane-layer", "hertz", "liu-reconstruction"], 2))
def test_the_law_of_any_model_compiles(name):
    plain = bs.catalogue[name].law(HIP)
    depths = np.geomspace(1e-6, 0.1, 100)
    expected = [plain(depth) for depth in depths.tolist()]
    np.testing.assert_allclose(evaluate_compiled(compiled_law(plain), depths), expected, rtol=1e-7)


def test_compiled_model_has_the_attributes_of_its_model_and_some_laws_and_models_do_not_compile():
    with pytest.raises(TypeError, match="must be above 0 N"):
        compiled_law(bs.AdhesiveSocket().law(HIP))
    with pytest.raises(TypeError, match="law must be"):
        compiled_law(lambda depth: (depth, 1.0))
    cup = bs.Cup(arc_of_cover=2.0)
    for model in (bs.Bartel(), bs.Tabulated()):
        fast = Compiled(model=model)
        for name in dir(bs.Model):
            if not (name.startswith("_") or callable(getattr(bs.Model, name))):
                assert getattr(fast, name) == getattr(model, name)
        assert fast.in_cup(cup).press(HIP, force=3000.0).notes == model.in_cup(cup).press(HIP, force=3000.0).notes
    with pytest.raises(TypeError, match=r"got Exact\(.*use Tabulated\(\)"):
        Compiled(model=bs.Exact())


def test_compiled_root_finder_stops_after_the_steps_and_at_the_tolerance_of_python():
    """Without a slope each of the 60 steps halves the bracket."""
    cubic = numba.njit(lambda x: (x * x * x, 3.0 * x * x))
    without_slope = numba.njit(lambda x: (x, 0.0))

    @numba.njit
    def roots():  # type: ignore[no-untyped-def]
        return increasing_root(cubic, 5.0, 0.0, 4.0, 4.0), increasing_root(without_slope, 0.0, 0.0, 1.0, 1.0)

    root, bisected = roots()
    assert root == increasing_root(cubic, 5.0, 0.0, 4.0, 4.0) == pytest.approx(5.0 ** (1 / 3), rel=1e-14)
    assert bisected == increasing_root(without_slope, 0.0, 0.0, 1.0, 1.0) == 2.0**-60
