"""The tables against the equation that they were made from."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.tabulated import build as build_tables
from ballsocket.elasticity.exact.tabulated import chebyshev

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
def test_random_joints_agree_with_the_exact_answer(elastic, rtol):
    angle, numbers = random(either(quick=60, long=300), 1, elastic=elastic)
    joint = build_tables.joint_of(*numbers, clearance=0.02)
    exact = bs.Exact(tolerance=1e-8).press(joint, half_angle=angle)
    good = exact.status == bs.Status.OK
    assert good.mean() > 0.99
    tabulated = bs.Tabulated()
    for found in (tabulated.press(joint, half_angle=angle), tabulated.press(joint, force=exact.force)):
        for name in NAMES:
            np.testing.assert_allclose(getattr(found, name)[good], getattr(exact, name)[good], rtol=rtol, err_msg=name)


@pytest.mark.parametrize("joint", [RIGID, HIP])
def test_small_contacts_agree_too(joint):
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


@pytest.mark.parametrize("joint", [RIGID, HIP])
@pytest.mark.parametrize("half_angle", [5.0, 40.0, 75.0])
def test_the_profile_agrees(joint, half_angle):
    half_angle = np.radians(half_angle)
    share = np.linspace(0.0, 1.0, 101)
    found, exact = (model.press(joint, half_angle=half_angle) for model in (bs.Tabulated(), bs.Exact(tolerance=1e-8)))
    error = np.abs(found.pressure(share * half_angle) - exact.pressure(share * half_angle))
    assert error.max() < 1e-4 * exact.max_pressure


@pytest.mark.parametrize("elastic", [False, True])
def test_forces_and_indentations_find_each_other(elastic):
    angle, numbers = random(2000, 3, elastic=elastic)
    joint, model = build_tables.joint_of(*numbers), bs.Tabulated()
    contact = model.press(joint, half_angle=angle)
    again = model.press(joint, force=contact.force)
    assert np.all(again.status == bs.Status.OK)
    np.testing.assert_allclose(again.half_angle, angle, rtol=1e-12)
    back = model.press(joint, indentation=again.indentation)
    np.testing.assert_allclose(back.force, contact.force, rtol=1e-12)


def test_one_joint_and_many_joints_are_one_formula():
    force = np.geomspace(0.1, 4000.0, 1500)
    many = replace(HIP, clearance=np.full(1500, HIP.clearance))
    close(bs.Tabulated().press(many, force=force), bs.Tabulated().press(HIP, force=force), 1e-12)


def test_a_joint_that_is_not_in_the_tables_is_refused():
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


def test_beyond_the_tables_is_a_status():
    contact = bs.Tabulated().press(HIP, half_angle=np.radians([84.9, 86.0]))
    assert contact.status.tolist() == [bs.Status.OK, bs.Status.NOT_REACHED]
    assert bs.Tabulated().press(HIP, force=1e9).status is bs.Status.NOT_REACHED
    assert not bs.Tabulated().press(replace(HIP, ball=bs.Material(young=2e5, poisson=0.45)), force=1000.0).valid


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


def test_the_tables_are_small():
    assert build_tables.SHIPPED.stat().st_size < 2_000_000


@pytest.mark.long
def test_the_builder_reproduces_the_shipped_profile():
    built = build_tables._TABLE_SPECS["profile"].fit(lambda sample, liners, chunksize: map(sample, liners))
    with np.load(build_tables.SHIPPED) as stored:
        np.testing.assert_allclose(built, stored["profile"], atol=1e-6)


def test_the_report_names_where_it_is_worst():
    report = build_tables.check(points=either(quick=20, long=50), workers=1)
    assert max(worst.error for worst in report.rigid) < 1e-5
    assert "pressure_integral" in str(report)
    assert "R2/L" in str(report)


def test_places_and_angles_are_inverse():
    place, ratio = np.linspace(-0.9, 1.0, 9), np.array([[0.2], [20.0]])
    np.testing.assert_allclose(
        chebyshev.angle_coordinate(chebyshev.angle_at(place, ratio), ratio), np.tile(place, (2, 1)), rtol=1e-9
    )


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"\x93NUMPY", b"tables"])
def test_a_file_without_tables_is_told_before_anything_is_computed(content, tmp_path):
    (tmp_path / "tables.npz").write_bytes(content)
    with pytest.raises(ValueError, match="tables.npz holds no tables"):
        build_tables.check(tmp_path / "tables.npz", workers=0)
    np.savez(tmp_path / "tables.npz", rigid=np.ones(3))
    with pytest.raises(ValueError, match="tables.npz holds no tables"):
        bs.Tabulated(file=str(tmp_path / "tables.npz")).press(bs.joints["hip-28"], force=1.0)


def test_where_tables_cannot_be_written_is_told_before_anything_is_computed(tmp_path):
    for place in (tmp_path, tmp_path / "none" / "tables.npz"):
        with pytest.raises(OSError, match="this is a folder|No such file"):
            build_tables.build(place, workers=0)
