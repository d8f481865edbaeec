"""The tables against the equation that they were made from."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval, chebvander

import ballsocket as bs
from ballsocket.contact.coordinates import LIMIT
from ballsocket.core import arrays
from ballsocket.core.chebyshev import chebyshev_points
from ballsocket.elasticity.exact.tabulated import build as build_tables
from ballsocket.elasticity.exact.tabulated import chebyshev

from ...extent import either
from ...joints import HIP
from ...refusals import refused_calls

RIGID = replace(HIP, ball=None)
NAMES = ("indentation", "force", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral")


def close(found, expected, rtol):
    for name in NAMES:
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=rtol, err_msg=name)


@pytest.mark.parametrize(("elastic", "rtol"), [(False, 1e-5), (True, 2e-4)])
def test_random_joints_agree_with_the_exact_solution(elastic, rtol):
    angle, *numbers = build_tables.random_contacts(either(quick=20, long=120), seed=1, elastic=elastic)
    joint = build_tables.make_joints(*numbers, clearance=0.02)
    exact = bs.Exact(tolerance=1e-8, gap=bs.LinearGap).press(joint, half_angle=angle)
    good = exact.status == bs.Status.OK
    assert good.mean() > 0.99
    tabulated = bs.Tabulated()
    for found in (tabulated.press(joint, half_angle=angle), tabulated.press(joint, force=exact.force)):
        for name in NAMES:
            np.testing.assert_allclose(getattr(found, name)[good], getattr(exact, name)[good], rtol=rtol, err_msg=name)


@pytest.mark.parametrize("joint", [RIGID, HIP])
def test_small_contacts_agree_with_the_exact_solution(joint):
    angle = np.radians([0.01, 0.1, 0.5, 1.0, 2.0])
    exact = bs.Exact(tolerance=1e-8, gap=bs.LinearGap).press(joint, half_angle=angle)
    close(bs.Tabulated().press(joint, half_angle=angle), exact, 1e-5)
    close(bs.Tabulated().press(joint, force=exact.force), exact, 1e-5)


def test_a_point_contact_is_that_of_hertz():
    joint = replace(RIGID, clearance=1e-4)  # under the linear gap R1 counts as R2
    tiny = bs.Tabulated().press(joint, half_angle=1e-6)
    hertz = bs.Hertz().press(joint, force=tiny.force)
    assert tiny.max_pressure == pytest.approx(hertz.max_pressure, rel=1e-5)
    assert tiny.half_angle == pytest.approx(hertz.half_angle, rel=1e-5)
    assert tiny.max_pressure_angle == 0.0
    assert bs.Tabulated().press(joint, force=0.0).foundation_modulus == np.inf


@pytest.mark.parametrize("joint", [RIGID, HIP])
@pytest.mark.parametrize("half_angle", [5.0, 40.0, 75.0])
def test_the_pressure_profile_agrees_with_the_exact_solution(joint, half_angle):
    half_angle = np.radians(half_angle)
    share = np.linspace(0.0, 1.0, 101)
    found, exact = (model.press(joint, half_angle=half_angle) for model in (bs.Tabulated(), bs.Exact(tolerance=1e-8)))
    error = np.abs(found.pressure(share * half_angle) - exact.pressure(share * half_angle))
    assert error.max() < 1e-4 * exact.max_pressure


def pressed(**change):
    return lambda: bs.Tabulated().press(HIP.replace(**change), force=1000.0)


test_joints_outside_the_tables_are_refused = refused_calls(
    (pressed(liner_thickness=200.0), "R2/L = 0.09: outside the tables: use exact"),
    (pressed(liner_thickness=0.5), "R2/L = 36"),
    (pressed(liner=bs.Material(young=1000.0, poisson=0.4995)), "ν = 0.4995"),
    (pressed(ball=bs.Material(young=20000.0, poisson=0.3)), "E/E_ball = 0.05"),
    (pressed(backing=(bs.Layer(thickness=3.0, material=bs.TITANIUM),)), "layers behind the liner = 1: .*use exact"),
    (pressed(support=bs.Support.FREE), "a free outer surface is not in the tables"),
)


def test_one_joint_of_several_beyond_the_tables_has_a_status():
    assert not bs.Tabulated().press(replace(HIP, ball=bs.Material(young=2e5, poisson=0.45)), force=1000.0).valid
    joints = bs.Tabulated().press(replace(HIP, liner_thickness=np.array([6.75, 200.0])), force=1000.0)
    assert joints.status.tolist() == [bs.Status.OK, bs.Status.OUTSIDE_DOMAIN]
    assert np.isnan(joints.indentation[1])


def test_loads_near_the_perfect_fit_are_solved():
    """In a thick liner indentations of a thousand clearances change the half angle by fractions of a degree."""
    thick = replace(RIGID, liner_thickness=80.0, clearance=1e-3)
    depth = 1e-3 * np.array([50.0, 150.0, 1000.0, 5000.0])
    found, exact = (model.press(thick, indentation=depth) for model in (bs.Tabulated(), bs.Exact()))
    assert found.status.tolist() == [bs.Status.OK] * 4
    np.testing.assert_allclose(found.force, exact.force, rtol=1e-6)
    again = bs.Tabulated().press(thick, force=found.force)
    assert again.status.tolist() == [bs.Status.OK] * 4
    np.testing.assert_allclose(again.indentation, depth, rtol=1e-10)


def test_every_field_has_derivatives_in_jax_and_a_traced_load_without_a_contact_no_solution():
    jax = pytest.importorskip("jax")
    fields = ("indentation", "max_pressure", "half_angle", "stiffness")

    def answer(numbers):
        contact = bs.Tabulated().press(HIP.with_numbers(list(numbers[1:])), force=numbers[0] * np.array([0.0, 1.0]))
        xp = jax.numpy if isinstance(numbers, jax.Array) else np
        return xp.stack([getattr(contact, name)[1] for name in fields])  # beside a point without load

    numbers = np.array([3000.0, *HIP.numbers()])
    with jax.enable_x64(True):
        slopes = np.array(jax.jit(jax.jacfwd(answer))(jax.numpy.asarray(numbers)))
    for k, number in enumerate(numbers):
        step = 1e-5 * number * (np.arange(len(numbers)) == k)
        expected = (answer(numbers + step) - answer(numbers - step)) / (2 * step[k])
        tolerance = 1e-6 * answer(numbers).max()
        np.testing.assert_allclose(slopes[:, k] * number, expected * number, rtol=1e-6, atol=tolerance)
    with jax.enable_x64(True):
        press = jax.jit(lambda force: bs.Tabulated().press(HIP, force=force).max_pressure)
        pressures = [float(press(force)) for force in (-1.0, 0.0, 1e3)]
    assert pressures == pytest.approx([np.nan, 0.0, bs.Tabulated().press(HIP, force=1e3).max_pressure], nan_ok=True)


def test_the_largest_errors_of_the_report_are_within_the_promise():
    report = build_tables.check_tables(points=8, workers=1)
    assert max(worst.error for worst in report.rigid) < 1e-5
    assert max(worst.error for worst in report.elastic) < 2e-4


@pytest.mark.parametrize("name", build_tables._TABLE_SPECS)
def test_the_builder_samples_the_functions_of_the_shipped_tables(name):
    spec, liner = build_tables._TABLE_SPECS[name], (0.3, 2.5)
    with np.load(build_tables.SHIPPED) as stored:
        coefficients = stored[name].astype(float)  # ν, R2/L, ball share, ball ν, function, angle
    for coordinate in (chebyshev.poisson_coordinate(liner[0]), chebyshev.thickness_coordinate(liner[1])):
        coefficients = chebval(coordinate, coefficients)
    sampled, balls = spec.sample(liner).reshape(coefficients.shape), np.array(spec.balls or (0.3,))
    shares, _, _, angles = (chebyshev_points(count) for count in sampled.shape)
    points = (shares, chebyshev.ball_shrinkage(balls), angles)
    series = (chebvander(x, len(x) - 1) for x in points)
    found = np.einsum("ijfk,Ii,Jj,Kk->IJfK", coefficients, *series)
    np.testing.assert_allclose(found, sampled, atol=1e-6 if name == "rigid" else 3e-5)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"\x93NUMPY", b"tables"])
def test_a_file_without_tables_is_refused_before_any_computation(content, tmp_path):
    (tmp_path / "tables.npz").write_bytes(content)
    with pytest.raises(ValueError, match="tables.npz holds no tables"):
        build_tables.check_tables(tmp_path / "tables.npz", workers=0)
    np.savez(tmp_path / "tables.npz", rigid=np.ones(3))
    with pytest.raises(ValueError, match="tables.npz holds no tables"):
        bs.Tabulated(file=str(tmp_path / "tables.npz")).press(bs.joints["hip-28"], force=1.0)


def test_an_unwritable_file_of_tables_is_refused_before_any_computation(tmp_path):
    for place in (tmp_path, tmp_path / "none" / "tables.npz"):
        with pytest.raises(OSError, match="this is a folder|No such file"):
            build_tables.build_tables(place, workers=0)


def test_a_small_table_interpolates_its_function_by_products_of_limited_order():
    def sample(liner):
        x, y = chebyshev.poisson_coordinate(liner[0]), chebyshev.thickness_coordinate(liner[1])
        return np.array([[x + 2 * y, 0.5 * x * y], [1.0 + x, y]])  # (functions, angles)

    spec = build_tables._TableSpec(sample=sample, counts=(3, 4), order=4, single=False)
    stored = spec.fit(lambda function, liners, chunksize: map(function, liners))
    assert stored.shape == (3, 4, 1, 1, 2, 2)
    table = chebyshev.compress_coefficients(stored, angles=5)
    nu, ratio = np.array([0.3]), np.array([2.5])
    coordinates = [chebyshev.poisson_coordinate(nu), chebyshev.thickness_coordinate(ratio)]
    values = table.coefficients_at(coordinates)[:, :, 0]
    assert values.shape == (2, 5)
    points = chebyshev_points(2)
    expected = sample((0.3, 2.5))
    for function in (0, 1):
        np.testing.assert_allclose(chebval(points, values[function]), expected[function], rtol=1e-6, atol=1e-7)
    single = table.coefficients_of_one([float(part[0]) for part in coordinates])
    np.testing.assert_allclose(single, values, atol=1e-12)
    spec = build_tables._TableSpec(sample=lambda liner: np.ones((1, 1)) * np.exp(liner[0]), counts=(4, 4), order=2)
    stored = spec.fit(lambda function, liners, chunksize: map(function, liners))
    assert stored.dtype == np.float32
    first, second = np.nonzero(stored[:, :, 0, 0, 0, 0])
    assert (first + second <= 2).all()
    assert abs(stored[2, 0]).max() > 0


def test_results_do_not_depend_on_the_number_of_joints_and_are_empty_without_contacts():
    """Few joints with many loads share their functions. The curve of one joint is accurate to 1e-9."""
    contact = bs.Tabulated().press(HIP, force=np.empty((0, 3)))
    assert contact.indentation.shape == (0, 3)
    assert contact.pressure(0.1 + np.empty((0, 3))).shape == (0, 3)
    thickness, force, model = np.array([[4.0], [6.75]]), np.geomspace(0.1, 4000.0, 1500), bs.Tabulated()
    grid = model.press(replace(HIP, liner_thickness=thickness), force=force)
    for row, value in enumerate(thickness[:, 0].tolist()):
        single = model.press(replace(HIP, liner_thickness=value), force=force)
        each = model.press(replace(HIP, liner_thickness=np.full(1500, value)), force=force)
        close(each, single, 1e-9)
        for name in NAMES:
            np.testing.assert_allclose(getattr(grid, name)[row], getattr(each, name), rtol=1e-12, err_msg=name)
        np.testing.assert_allclose(grid.pressure(0.1)[row], single.pressure(0.1), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("elastic", [False, True], ids=["rigid ball", "elastic ball"])
@pytest.mark.parametrize("kind", ["force", "indentation"])
def test_few_steps_from_the_start_solve_loads_of_all_sizes(kind, elastic):
    """The half angle of a load that follows from a half angle, from a millionth of the largest to all of it."""
    _, *numbers = build_tables.random_contacts(either(2000, 6000), seed=4, elastic=elastic)
    angle = LIMIT * np.geomspace(1e-6, 1 - 1e-9, numbers[0].size)
    joint = build_tables.make_joints(*numbers)
    known = bs.Tabulated().press(joint, half_angle=angle)
    reached = known.indentation < 20 * joint.clearance  # beyond, the indentation is ill-conditioned in the half angle
    assert np.count_nonzero(reached) > 0.8 * reached.size
    found = bs.Tabulated().press(joint, **{kind: np.where(reached, getattr(known, kind), 0.0)})
    assert np.all(found.status[reached] == bs.Status.OK)
    np.testing.assert_allclose(found.half_angle[reached], angle[reached], rtol=1e-12)
    np.testing.assert_allclose(found.force[reached], known.force[reached], rtol=2e-12)


def test_blocks_inside_jit_equal_one_block(monkeypatch):
    jax = pytest.importorskip("jax")
    monkeypatch.setitem(arrays._JAX_BLOCKS, "cpu", 40)
    thickness, force = np.linspace(4.0, 12.0, 100), np.linspace(0.0, 4000.0, 100)
    with jax.enable_x64(True):

        def press(thickness, force):
            joint = replace(RIGID, liner_thickness=thickness)
            contact = bs.Tabulated().press(joint, force=force)
            return [getattr(contact, name) for name in ("indentation", "half_angle", "max_pressure", "stiffness")]

        found = jax.jit(press)(jax.numpy.asarray(thickness), jax.numpy.asarray(force))
    for value, expected in zip(found, press(thickness, force), strict=True):
        np.testing.assert_allclose(value, expected, rtol=1e-11)
