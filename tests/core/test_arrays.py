"""Functions of numbers and arrays outside their domain, dtypes, quadrature, copies of arrays, and stresses."""

import math

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core import arrays
from ballsocket.core.stress import Stress
from ballsocket.hip import KelvinVoigtChain
from ballsocket.hip.measured_wear import MeasuredWear
from ballsocket.hip.simulator_cycles import iso_14242_1
from ballsocket.identification.measured import Measured
from ballsocket.planning import PointCloud

VALUES = np.array([0.0, 0.2, 0.7, 1.0, 2.5])


def test_floats_outside_a_domain_become_nan_or_infinite():
    assert (arrays.exp(1000.0), arrays.log(0.0)) == (math.inf, -math.inf)
    missing = arrays.log(-1.0), arrays.asin(1.5), arrays.sqrt(-1.0), arrays.power(-1.0, 1.5)
    assert all(map(math.isnan, missing))
    assert arrays.sqrt(0.0) == arrays.power(0.0, 1.5) == 0.0


def test_common_arrays_have_the_dtype_of_the_arrays():
    one, two = arrays.to_common_arrays([1, 2], np.ones(2, dtype=np.float32))
    assert one.dtype == two.dtype == np.float32
    single, number = arrays.to_common_arrays(np.ones(2, dtype=np.float32), 3)
    assert (single.dtype, number.dtype) == (np.float32, np.float32)
    integers, number = arrays.to_common_arrays(np.array([1, 2]), 0.5)
    assert integers.dtype == number.dtype == np.float64
    assert [value.dtype for value in arrays.to_common_arrays(1, 2.5)] == [np.float64, np.float64]
    assert [arrays.machine_epsilon(x) for x in (1.0, np.ones(2), single)] == [2.0**-52, 2.0**-52, 2.0**-23]
    assert [arrays.all_true(x) for x in (True, np.array([True, False]), np.ones(2) > 0)] == [True, False, True]
    with pytest.raises(TypeError, match="all arrays must be of one library, got array_api_strict.Array, n"):
        arrays.namespace(np.ones(1), pytest.importorskip("array_api_strict").ones(1))


def test_quadrature_is_exact_for_polynomials():
    for degree in range(8):
        assert arrays.integral(lambda x, n=degree: x**n, 4) == pytest.approx(1 / (degree + 1), rel=1e-13)
    nodes, weights = arrays.gauss_legendre(5)
    assert sum(weights) == pytest.approx(1.0, rel=1e-14)
    assert all(0 < node < 1 for node in nodes)
    np.testing.assert_allclose(arrays.weighted_sum([VALUES, 2 * VALUES], [3.0, 0.5]), 4 * VALUES)


def test_lists_for_json_have_no_nan_and_no_infinity():
    assert arrays.to_list(np.array([[1.0, np.nan], [np.inf, -np.inf]])) == [[1.0, None], ["inf", "inf"]]
    assert [arrays.to_list(x) for x in (2.5, np.array([True, False]))] == [2.5, [True, False]]


def test_the_series_of_a_short_sine_is_accurate_to_rounding():
    x = np.linspace(-0.75, 0.75, 3001)
    np.testing.assert_allclose(arrays.short_sine(x), np.sin(x), rtol=3e-16)
    assert arrays.short_sine(0.5) == np.sin(0.5)


def test_principal_stresses_are_eigenvalues_and_hydrostatic_pressure_has_no_von_mises_stress():
    random = np.random.default_rng(1)
    components = random.normal(size=(4, 20))
    state = Stress(**dict(zip(("radial", "meridional", "hoop", "shear"), components, strict=True)))
    for number in range(20):
        r, m, h, s = components[:, number]
        values = np.linalg.eigvalsh([[r, s, 0.0], [s, m, 0.0], [0.0, 0.0, h]])
        assert [principal[number] for principal in state.principal] == pytest.approx(values[::-1].tolist(), abs=1e-12)
        deviator = values - values.mean()
        assert state.von_mises[number] == pytest.approx(np.sqrt(1.5 * np.sum(deviator**2)), rel=1e-12)
    pressure = np.asarray(-5.0)
    state = Stress(radial=pressure, meridional=pressure, hoop=pressure, shear=0.0 * pressure)
    assert state.von_mises == 0.0
    assert state.principal == pytest.approx((-5.0, -5.0, -5.0))


def _law(numbers):
    return KelvinVoigtChain(compliances=numbers, times=numbers + 1.0).elements


OWNERS = {
    "joint": lambda numbers: bs.joints["hip-28"].replace(clearance=numbers).clearance,
    "material": lambda numbers: bs.Material(young=numbers, poisson=0.4).young,
    "measured": lambda numbers: Measured(quantity="indentation", values=numbers, force=numbers).force,
    "wear": lambda numbers: MeasuredWear(quantity="volume", values=numbers, cycles=numbers).values,
    "points": lambda numbers: PointCloud(numbers[:, None]).points[:, 0],
    "law": _law,
    "orientations": lambda numbers: bs.orient(bs.joints["hip-28"], force=0.0, inclination=numbers / 3).inclination * 3,
}


@pytest.mark.parametrize("make", OWNERS.values(), ids=OWNERS)
def test_an_array_that_its_caller_uses_again_changes_nothing(make):
    numbers = np.array([0.1, 0.2])
    stored = make(numbers)
    numbers[:] = 9.0
    assert np.ravel(stored)[:2] == pytest.approx([0.1, 0.2])


def test_fields_of_results_are_read_only():
    oriented = bs.orient(bs.joints["hip-28"], force=0.0, inclination=[0.1, 0.2], anteversion=0.1)
    forces = iso_14242_1(12).forces
    error = bs.HessForsbach().press(bs.joints["hip-28"], force=np.array([1e3, 2e3])).error["von_mises"]
    for array in (oriented.max_pressure, oriented.inclination, forces, error):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
