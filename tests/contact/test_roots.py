"""Bracketed Newton iteration: roots of increasing functions, of numbers and of arrays."""

import numpy as np
import pytest

from ballsocket.contact.roots import increasing_root


def cube(x):
    return x * x * x, 3 * x * x


def steep(x):
    """Increase from -1 to 1 within 1e-3 of x = 0.3; Newton steps from outside leave the bracket."""
    bend = 1e4 * (x - 0.3)
    return np.arctan(bend), 1e4 / (1 + bend * bend)


def flat(x):
    """Have no slope below x = 1."""
    above = np.maximum(x - 1.0, 0.0)
    return above * above, 2 * above


CASES = {
    "cube": (cube, 5.0, 0.0, 4.0, 1.0, 5.0 ** (1 / 3)),
    "start at zero slope": (cube, 5.0, 0.0, 4.0, 0.0, 5.0 ** (1 / 3)),
    "steep": (steep, 0.5, -1.0, 2.0, 1.5, 0.3 + np.tan(0.5) * 1e-4),
    "flat": (flat, 4.0, 0.0, 10.0, 0.5, 3.0),
    "below the bracket": (cube, -1.0, 1.0, 4.0, 2.0, 1.0),
    "above the bracket": (cube, 100.0, 1.0, 4.0, 2.0, 4.0),
    "at the upper end": (cube, 64.0, 1.0, 4.0, 1.0, 4.0),
    "negative": (cube, -8.0, -3.0, -1.0, -1.5, -2.0),
}


@pytest.mark.parametrize(("law", "target", "low", "high", "start", "root"), CASES.values(), ids=CASES)
def test_roots_of_numbers_and_arrays(law, target, low, high, start, root):
    tolerance = 1e-6
    number = increasing_root(law, target, low, high, start)
    assert np.ndim(number) == 0
    assert number == pytest.approx(root, rel=tolerance)
    values = increasing_root(law, *(np.full(3, value) for value in (target, low, high, start)))
    np.testing.assert_allclose(values, root, rtol=tolerance)


@pytest.mark.parametrize("steps", [2, 60], ids=["unrolled", "loop"])
def test_traced_roots_have_exact_first_and_second_derivatives(steps):
    """The cube root of a, whose derivatives by a are known."""
    jax = pytest.importorskip("jax")

    def root(a):
        start = a ** (1 / 3) * (1 + 1e-6)
        return increasing_root(lambda x: (x * x * x, 3 * x * x), a, 0.0 * a, 0.0 * a + 9.0, start, steps=steps)

    def value_and_derivatives(a):
        slope = jax.grad(root)
        return root(a), slope(a), jax.jvp(slope, (a,), (1.0,))[1]

    with jax.enable_x64(True):
        a = np.array([5.0, 90.0])
        value, slope, bend = (np.asarray(part) for part in jax.jit(jax.vmap(value_and_derivatives))(a))
    assert value == pytest.approx(np.cbrt(a), rel=1e-14)
    assert slope == pytest.approx(np.cbrt(a) ** -2 / 3, rel=1e-12)
    assert bend == pytest.approx(-2 / 9 * np.cbrt(a) ** -5, rel=1e-12)
