"""The tables against the equation that they were made from."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core import arrays
from ballsocket.core.chebyshev import chebyshev_points, traced_series
from ballsocket.elasticity.exact.tabulated import build as build_tables
from ballsocket.elasticity.exact.tabulated import chebyshev, inverse
from ballsocket.elasticity.exact.tabulated.curves import JointCurves

from ...extent import either
from ...joints import HIP

RIGID = replace(HIP, ball=None)
NAMES = ("indentation", "force", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral")


def close(found, expected, rtol):
    for name in NAMES:
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=rtol, err_msg=name)


def random(count, seed, **more):
    angle, *numbers = build_tables.random_contacts(count, seed=seed, **more)
    return angle, numbers


@pytest.mark.parametrize(("elastic", "rtol"), [(False, 1e-5), (True, 2e-4)])
def test_random_joints_agree_with_the_exact_solution(elastic, rtol):
    angle, numbers = random(either(quick=20, long=300), 1, elastic=elastic)
    joint = build_tables.make_joints(*numbers, clearance=0.02)
    exact = bs.Exact(tolerance=1e-8).press(joint, half_angle=angle)
    good = exact.status == bs.Status.OK
    assert good.mean() > 0.99
    tabulated = bs.Tabulated()
    for found in (tabulated.press(joint, half_angle=angle), tabulated.press(joint, force=exact.force)):
        for name in NAMES:
            np.testing.assert_allclose(getattr(found, name)[good], getattr(exact, name)[good], rtol=rtol, err_msg=name)


@pytest.mark.parametrize("joint", [RIGID, HIP])
def test_small_contacts_agree_with_the_exact_solution(joint):
    angle = np.radians([0.01, 0.1, 0.5, 1.0, 2.0])
    exact = bs.Exact(tolerance=1e-8).press(joint, half_angle=angle)
    close(bs.Tabulated().press(joint, half_angle=angle), exact, 1e-5)
    close(bs.Tabulated().press(joint, force=exact.force), exact, 1e-5)


def test_a_point_contact_is_that_of_hertz():
    joint = replace(RIGID, clearance=1e-4)  # under the linear gap R1 counts as R2
    tiny = bs.Tabulated().press(joint, half_angle=1e-6)
    hertz = bs.Hertz().press(joint, force=tiny.force)
    assert tiny.max_pressure == pytest.approx(hertz.max_pressure, rel=1e-5)
    assert tiny.half_angle == pytest.approx(hertz.half_angle, rel=1e-5)
    assert tiny.max_pressure_angle == 0.0


@pytest.mark.parametrize("joint", [RIGID, HIP])
@pytest.mark.parametrize("half_angle", [5.0, 40.0, 75.0])
def test_the_pressure_profile_agrees_with_the_exact_solution(joint, half_angle):
    half_angle = np.radians(half_angle)
    share = np.linspace(0.0, 1.0, 101)
    found, exact = (model.press(joint, half_angle=half_angle) for model in (bs.Tabulated(), bs.Exact(tolerance=1e-8)))
    error = np.abs(found.pressure(share * half_angle) - exact.pressure(share * half_angle))
    assert error.max() < 1e-4 * exact.max_pressure


@pytest.mark.parametrize("elastic", [False, True])
def test_forces_and_indentations_are_inverse(elastic):
    angle, numbers = random(2000, 3, elastic=elastic)
    joint, model = build_tables.make_joints(*numbers), bs.Tabulated()
    contact = model.press(joint, half_angle=angle)
    again = model.press(joint, force=contact.force)
    assert np.all(again.status == bs.Status.OK)
    np.testing.assert_allclose(again.half_angle, angle, rtol=1e-12)
    back = model.press(joint, indentation=again.indentation)
    np.testing.assert_allclose(back.force, contact.force, rtol=1e-12)


def test_one_joint_and_many_joints_have_equal_results():
    force = np.geomspace(0.1, 4000.0, 1500)
    many = replace(HIP, clearance=np.full(1500, HIP.clearance))
    close(bs.Tabulated().press(many, force=force), bs.Tabulated().press(HIP, force=force), 1e-12)


def test_joints_outside_the_tables_are_refused():
    shell = bs.Layer(thickness=3.0, material=bs.TITANIUM)
    model = bs.Tabulated()
    for other, message in (
        (replace(HIP, liner_thickness=200.0), "R2/L = 0.09: outside the tables: use exact"),
        (replace(HIP, liner_thickness=0.5), "R2/L = 36"),
        (replace(HIP, liner=bs.Material(young=1000.0, poisson=0.4995)), "ν = 0.4995"),
        (replace(HIP, ball=bs.Material(young=20000.0, poisson=0.3)), "E/E_ball = 0.05"),
        (replace(HIP, backing=(shell,)), "layers behind the liner = 1: .*use exact"),
        (replace(HIP, support=bs.Support.FREE), "a free outer surface is not in the tables"),
    ):
        with pytest.raises(ValueError, match=message):
            model.press(other, force=1000.0)
    thickness = np.array([6.75, 200.0])
    contact = model.press(replace(HIP, liner_thickness=thickness), force=1000.0)
    assert contact.status.tolist() == [bs.Status.OK, bs.Status.OUTSIDE_DOMAIN]
    assert np.isnan(contact.indentation[1])


def test_loads_beyond_the_tables_have_a_status():
    contact = bs.Tabulated().press(HIP, half_angle=np.radians([84.9, 86.0]))
    assert contact.status.tolist() == [bs.Status.OK, bs.Status.NOT_REACHED]
    assert bs.Tabulated().press(HIP, force=1e9).status is bs.Status.NOT_REACHED
    assert not bs.Tabulated().press(replace(HIP, ball=bs.Material(young=2e5, poisson=0.45)), force=1000.0).valid


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


def test_every_field_has_derivatives_in_jax():
    jax = pytest.importorskip("jax")
    fields = ("indentation", "max_pressure", "half_angle", "stiffness")

    def answer(numbers):
        contact = bs.Tabulated().press(HIP.with_numbers(list(numbers[1:])), force=numbers[0])
        xp = jax.numpy if isinstance(numbers, jax.Array) else np
        return xp.stack([getattr(contact, name) for name in fields])

    numbers = np.array([3000.0, *HIP.numbers()])
    with jax.enable_x64(True):
        slopes = np.array(jax.jit(jax.jacfwd(answer))(jax.numpy.asarray(numbers)))
    for k, number in enumerate(numbers):
        step = 1e-5 * number * (np.arange(len(numbers)) == k)
        expected = (answer(numbers + step) - answer(numbers - step)) / (2 * step[k])
        np.testing.assert_allclose(
            slopes[:, k] * number, expected * number, rtol=1e-6, atol=1e-6 * answer(numbers).max()
        )


def test_the_tables_are_smaller_than_two_megabytes():
    assert build_tables.SHIPPED.stat().st_size < 2_000_000


@pytest.mark.long
def test_the_builder_reproduces_the_shipped_profile():
    built = build_tables._TABLE_SPECS["profile"].fit(lambda sample, liners, chunksize: map(sample, liners))
    with np.load(build_tables.SHIPPED) as stored:
        np.testing.assert_allclose(built, stored["profile"], atol=1e-6)


def test_the_report_names_the_joint_of_the_largest_error():
    report = build_tables.check_tables(points=either(quick=8, long=50), workers=1)
    assert max(worst.error for worst in report.rigid) < 1e-5
    assert "pressure_integral" in str(report)
    assert "R2/L" in str(report)


def test_coordinates_and_angles_are_inverse():
    place, ratio = np.linspace(-0.9, 1.0, 9), np.array([[0.2], [20.0]])
    np.testing.assert_allclose(
        chebyshev.angle_coordinate(chebyshev.half_angle_at(place, ratio), ratio), np.tile(place, (2, 1)), rtol=1e-9
    )


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


def test_builder_coordinates_invert_those_of_the_tables():
    coordinate = np.linspace(-1.0, 1.0, 9)
    poisson, ratio = build_tables._poisson_at(coordinate), chebyshev.thickness_ratio_at(coordinate)
    np.testing.assert_allclose(chebyshev.poisson_coordinate(poisson), coordinate, atol=1e-10)
    np.testing.assert_allclose(chebyshev.thickness_coordinate(ratio), coordinate, atol=1e-10)
    assert poisson[[0, -1]] == pytest.approx(chebyshev.POISSON[:: 1 if poisson[0] < 0 else -1])
    assert ratio[[0, -1]] == pytest.approx(chebyshev.THICKNESS_RATIO)
    for place in (-1.0, 0.2, 1.0):
        share = build_tables._ball_share_at(place, 0.4, 3.0)
        assert chebyshev.ball_coordinate(share, 0.4, 3.0) == pytest.approx(place, abs=1e-10)
    assert build_tables._ball_share_at(1.0, 0.4, 3.0) == pytest.approx(chebyshev.MAX_BALL_SHARE)


def test_sampled_functions_are_those_of_the_exact_solution():
    liner, angle = (0.4, 18.0 / 6.75), np.radians([10.0, 40.0])
    state = build_tables._solve_state(liner, angle, 40)
    joint = build_tables.make_joints(0.4, 18.0 / 6.75, 0.0, 0.3)
    exact = bs.Exact(tolerance=1e-9).press(joint, half_angle=angle)
    np.testing.assert_allclose(state.indentation * 0.005, exact.indentation, rtol=1e-7)
    np.testing.assert_allclose(state.force * 0.005, exact.force, rtol=1e-7)
    opening, force, pole = np.exp(build_tables._tabulated_functions(state))
    total, C = 0.005 + exact.indentation, 2 * (1 - 0.4**2)
    np.testing.assert_allclose(opening * (1 - np.cos(angle)), exact.indentation / total, rtol=1e-7)
    np.testing.assert_allclose(force * total * angle**3 / C, exact.force, rtol=1e-7)
    np.testing.assert_allclose(pole * total * angle / C, exact.pole_pressure, rtol=1e-7)
    series = build_tables._profile_coefficients(state)
    for v in (0.05, 0.5, 0.95):
        phi = 2 * np.arcsin(np.sqrt(v) * np.sin(angle / 2))
        profile = np.polynomial.chebyshev.chebval(2 * v - 1, series)
        np.testing.assert_allclose(
            profile * np.sqrt(1 - v) * exact.pole_pressure,
            np.diag(exact.pressure(phi[:, None] + 0 * angle)),
            rtol=2e-4,
        )
    elastic = build_tables._solve_state(liner, angle, 40, 0.01, 0.3)
    share = elastic.kernel.ball.asymptote / elastic.kernel.compliance
    assert share == pytest.approx(0.01)


def test_a_small_table_interpolates_its_function():
    """A specification with few points reproduces a polynomial of the coordinates."""

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
        found = np.polynomial.chebyshev.chebval(points, values[function])
        np.testing.assert_allclose(found, expected[function], rtol=1e-6, atol=1e-7)
    single = table.coefficients_of_one([float(part[0]) for part in coordinates])
    np.testing.assert_allclose(single, values, atol=1e-12)


def test_orders_of_products_are_limited():
    spec = build_tables._TableSpec(sample=lambda liner: np.ones((1, 1)) * np.exp(liner[0]), counts=(4, 4), order=2)
    stored = spec.fit(lambda function, liners, chunksize: map(function, liners))
    assert stored.dtype == np.float32
    first, second = np.nonzero(stored[:, :, 0, 0, 0, 0])
    assert (first + second <= 2).all()
    assert abs(stored[2, 0]).max() > 0


def test_balls_are_interpolated_in_their_shrinkage():
    balls = (0.15, 0.27, 0.38)
    values = np.array([[1.0 + 2.0 * chebyshev.ball_shrinkage(nu)] for nu in balls])
    series = build_tables._shrinkage_coefficients(balls, values)
    np.testing.assert_allclose(series[:, 0], [1.0, 2.0, 0.0], atol=1e-12)


def test_exact_values_of_the_check_have_the_units_of_the_joint():
    numbers = (np.radians(40.0), 0.4, 2.5, 0.01, 0.3)
    expected = dict(zip(build_tables.QUANTITIES, build_tables._solve_exact(numbers), strict=True))
    joint = build_tables.make_joints(*numbers[1:])
    assert joint.clearance_ratio == pytest.approx(0.005)
    contact = bs.Exact(tolerance=1e-9).press(joint, half_angle=numbers[0])
    for name in ("indentation", "force", "pole_pressure", "energy", "pressure_integral", "half_angle"):
        assert getattr(contact, name) == pytest.approx(expected[name], rel=1e-5), name
    assert contact.stiffness == pytest.approx(expected["stiffness"] / 0.005, rel=1e-5)


def test_the_largest_error_names_its_contact():
    numbers = tuple(
        np.array(column) for column in zip((0.1, 0.3, 1.0, 0.0, 0.3), (0.2, 0.4, 2.0, 0.01, 0.25), strict=True)
    )
    worst = build_tables._largest_error("force", np.array([1e-6, 2e-6]), numbers)
    assert worst.error == 2e-6
    assert str(worst) == "force              2.0e-06  at ε 11.46°, ν 0.4000, R2/L 2.000, E/E_ball 0.0100, ν_ball 0.250"
    missing = build_tables._largest_error("force", np.array([np.nan, 2e-6]), numbers)
    assert "ν 0.3000" in missing.location
    assert "ball" not in missing.location


def test_random_contacts_lie_in_their_ranges():
    angle, poisson, ratio, softness, ball = build_tables.random_contacts(2000, seed=4, elastic=True)
    for values, low, high in (
        (np.degrees(angle), 2, 80),
        (poisson, 0, 0.499),
        (ratio, 0.2, 20),
        (softness, 0, 0.02),
        (ball, 0.2, 0.35),
    ):
        assert low <= values.min() < low + 0.05 * (high - low)
        assert high - 0.05 * (high - low) < values.max() <= high
    assert not build_tables.random_contacts(5, seed=4)[3].any()
    assert np.median(ratio) == pytest.approx(2.0, rel=0.15)


def test_one_joint_without_contacts_has_empty_results():
    contact = bs.Tabulated().press(HIP, force=np.empty((0, 3)))
    assert contact.indentation.shape == (0, 3)
    assert contact.pressure(0.1 + np.empty((0, 3))).shape == (0, 3)


def test_many_loads_on_a_grid_of_joints_are_those_of_single_joints():
    """Few joints with many loads share their curves; the result does not depend on that."""
    thickness = np.array([[4.0], [6.75]])
    joints, force = replace(HIP, liner_thickness=thickness), np.geomspace(10.0, 3000.0, 3000)
    grid = bs.Tabulated().press(joints, force=force)
    for row, value in enumerate(thickness[:, 0]):
        single = bs.Tabulated().press(replace(HIP, liner_thickness=float(value)), force=force)
        np.testing.assert_allclose(grid.indentation[row], single.indentation, rtol=1e-12)
        np.testing.assert_allclose(grid.energy[row], single.energy, rtol=1e-12)
        np.testing.assert_allclose(grid.pressure(0.1)[row], single.pressure(0.1), rtol=1e-9, atol=1e-9)


def test_foundation_modulus_and_pressure_integral_follow_from_their_definitions():
    contact = bs.Tabulated().press(RIGID, force=np.array([0.0, 2000.0]))
    assert contact.foundation_modulus[0] == np.inf
    assert contact.foundation_modulus[1] == pytest.approx(contact.pole_pressure[1] / contact.indentation[1])
    edge = contact.half_angle[1]
    x, w = np.polynomial.legendre.leggauss(200)
    angle = edge * np.sin(np.pi / 4 * (1 + x))
    jacobian = edge * np.pi / 4 * np.cos(np.pi / 4 * (1 + x)) * w
    single = bs.Tabulated().press(RIGID, force=2000.0)
    ring = 2 * np.pi * RIGID.socket_radius**2 * np.sin(angle) * single.pressure(angle) * jacobian
    assert ring.sum() == pytest.approx(contact.pressure_integral[1], rel=1e-4)
    assert (ring * np.cos(angle)).sum() == pytest.approx(2000.0, rel=1e-4)
    assert contact.pressure_integral[0] == 0


@pytest.mark.parametrize("elastic", [False, True], ids=["rigid ball", "elastic ball"])
@pytest.mark.parametrize("kind", ["force", "indentation"])
def test_few_steps_from_the_start_solve_loads_of_all_sizes(kind, elastic):
    """The half angle of a load that follows from a half angle, from a millionth of the largest to all of it."""
    _, *numbers = build_tables.random_contacts(either(2000, 20_000), seed=4, elastic=elastic)
    angle = chebyshev.LIMIT * np.geomspace(1e-6, 1 - 1e-9, numbers[0].size)
    joint = build_tables.make_joints(*numbers)
    known = bs.Tabulated().press(joint, half_angle=angle)
    reached = known.indentation < 20 * joint.clearance  # beyond, the indentation is ill-conditioned in the half angle
    assert np.count_nonzero(reached) > 0.8 * reached.size
    found = bs.Tabulated().press(joint, **{kind: np.where(reached, getattr(known, kind), 0.0)})
    np.testing.assert_allclose(found.half_angle[reached], angle[reached], rtol=1e-12)


def test_traced_series_have_the_derivatives_of_the_polynomial():
    jax = pytest.importorskip("jax")
    coefficients, x = np.random.default_rng(2).normal(size=(6, 1)), 0.3
    polynomial = np.polynomial.chebyshev.Chebyshev(coefficients[:, 0])
    with jax.enable_x64(True):
        values = jax.jit(lambda c, x: traced_series(c, x[None]))(coefficients, x)
        np.testing.assert_allclose(np.ravel(values), [polynomial(x), polynomial.deriv()(x)], rtol=1e-13)
        bend = jax.jit(jax.grad(jax.grad(lambda x: traced_series(jax.numpy.asarray(coefficients), x[None])[1][0])))(x)
        assert float(bend) == pytest.approx(polynomial.deriv(3)(x), rel=1e-10)
        by_coefficient = jax.jit(jax.grad(lambda c: traced_series(c, jax.numpy.asarray([x]))[1][0]))(coefficients)
        expected = [np.polynomial.chebyshev.Chebyshev.basis(k).deriv()(x) for k in range(6)]
        np.testing.assert_allclose(by_coefficient[:, 0], expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(("elastic", "largest"), [(False, 1e-8), (True, 1e-6)])
@pytest.mark.parametrize("kind", ["force", "indentation"])
def test_the_last_correction_is_small_and_its_square_is_what_is_left(kind, elastic, largest):
    """The status takes a point as converged by the size of the correction; the error left is of the size squared."""
    angle, *numbers = build_tables.random_contacts(2000, seed=7, elastic=elastic)
    joint = build_tables.make_joints(*numbers)
    joint = joint.with_numbers([np.broadcast_to(number, angle.shape) for number in joint.numbers()])
    curves = JointCurves("", joint)
    depth, force, *_ = curves.contact_quantities(angle)
    reached = (depth > 0) & (depth < 20 * joint.clearance)
    load = np.where(reached, force if kind == "force" else depth, 1e-9)
    state, shift = inverse.solve_state(curves, kind, load)
    assert np.max(abs(shift[reached])) < largest
    np.testing.assert_allclose(state.angle[reached], angle[reached], rtol=1e-12)


@pytest.mark.parametrize("model", [bs.Tabulated(), bs.Refined()], ids=lambda model: model.name)
def test_blocks_inside_jit_equal_one_block(model, monkeypatch):
    """Two full blocks and a part of a third, with a joint for each load."""
    jax = pytest.importorskip("jax")
    monkeypatch.setitem(arrays._JAX_BLOCKS, "cpu", 40)
    thickness, force = np.linspace(4.0, 12.0, 100), np.linspace(0.0, 4000.0, 100)
    with jax.enable_x64(True):

        def press(thickness, force):
            joint = replace(RIGID, liner_thickness=thickness)
            contact = model.press(joint, force=force)
            return [getattr(contact, name) for name in ("indentation", "half_angle", "max_pressure", "stiffness")]

        found = jax.jit(press)(jax.numpy.asarray(thickness), jax.numpy.asarray(force))
    for value, expected in zip(found, press(thickness, force), strict=True):
        np.testing.assert_allclose(value, expected, rtol=1e-11)
