"""`Sphere` in JAX: one step of the search, agreement with NumPy, derivatives, refused inputs."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.jax_sphere import JaxSphere

from ...joints import HIP
from .shapes import COARSE

jax = pytest.importorskip("jax")

MODEL = bs.Sphere(surface=bs.ClosedShell(), ring_width=radians(3.0))
TILT = np.array([0.1, 0.7, 1.1, 0.4])
FORCE = np.array([600.0, 3000.0, 1500.0, 2500.0])
DIRECTION = np.stack([np.sin(TILT), 0.1 * TILT, np.cos(TILT)], axis=-1)


@pytest.mark.long
def test_single_precision_agrees_with_numpy():
    contacts = JaxSphere(model=MODEL, joint=HIP).press(FORCE, DIRECTION)
    expected = MODEL.press(HIP, force=FORCE, direction=DIRECTION)
    assert np.asarray(contacts.converged).all()
    assert np.asarray(contacts.error).max() <= 2e-5
    assert np.asarray(contacts.displacement) == pytest.approx(expected.displacement, abs=2e-5 * 0.2)
    force = np.linalg.norm(contacts.force_vector - expected.force_vector, axis=1)
    assert (force <= 2e-5 * FORCE).all()
    assert np.asarray(contacts.max_pressure) == pytest.approx(expected.max_pressure, rel=2e-5)
    assert np.asarray(contacts.half_angle) == pytest.approx(expected.half_angle, abs=5e-4)
    assert np.asarray(contacts.edge_loaded).tolist() == expected.edge_loaded.tolist()
    margin = np.maximum(expected.edge_margin, 0.0)
    assert np.asarray(contacts.edge_margin) == pytest.approx(margin, abs=5e-4)
    scale = abs(expected.stiffness_matrix).max()
    assert np.asarray(contacts.stiffness_matrix) == pytest.approx(expected.stiffness_matrix, abs=1e-3 * scale)


LINER = ("young", "poisson", "liner_thickness")
NUMBERS = {"force": 3000.0, "x": 0.0, "y": 0.05, "z": 0.0, "clearance": 0.1, "depth": 0.0, "inclination": 0.1}
NUMBERS |= {"anteversion": -0.05, "young": HIP.liner.young, "poisson": HIP.liner.poisson}
NUMBERS |= {"liner_thickness": HIP.liner_thickness}
"""Inputs of a press: N, direction, mm, factor of a worn depth in mm, angles of the cup, and the liner's numbers."""

RIM = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(170.0)), ring_width=radians(3.0))
"""Real cup whose contacts reach the rim at a tilt of about 46°."""

OUTPUTS = ("displacement", "force_vector", "pressure", "max_pressure", "half_angle", "edge_margin")


def slope_scale(output, name, difference):
    """Return the largest slope, or a physical one where it vanishes: far from the rim a contact moves with the load."""
    vanishing = {"force_vector": 100.0}
    if name in (*"xyz", "inclination", "anteversion"):
        vanishing = {"max_pressure": 10.0, "half_angle": 0.1, "edge_margin": 0.1}
    return max(np.max(abs(difference)), vanishing.get(output, 1e-12))


@pytest.fixture
def double_precision():
    """Set double precision in all threads: JAX may call NumPy back in another one."""
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", False)


@pytest.mark.long
def test_a_real_cup_has_the_contact_of_numpy_and_its_slopes(double_precision):
    """Near the rim, and cut off by it.

    Slopes are central differences over 5e-5, in which an edge hardly ever passes a cell, within 1e-3 of the largest.
    Edges, which few secants find, and sums over the cells that they pass are known to 1e-2.
    """
    cup = JaxSphere(model=RIM, joint=HIP, tolerance=1e-9, dtype="float64")
    grid = RIM.bore_contact(HIP).compliance.grid
    worn, weights = np.maximum(grid.centroids[2], 0.0) ** 2, grid.areas * (1.0 + grid.centroids[0])

    def press(values):
        direction = jax.numpy.stack([values[name] for name in "xyz"])[None]
        inputs = {name: values[name] for name in ("clearance", "inclination", "anteversion", *LINER)}
        c = cup.press(values["force"][None], direction, depth=values["depth"] * worn, **inputs)
        outputs = {name: getattr(c, name)[0] for name in OUTPUTS}
        outputs |= {"pressure": (c.pressure[0] * weights).sum()}
        return outputs, outputs

    press_with_slopes = jax.jit(jax.jacrev(press, has_aux=True))  # compiled once
    cup_of_values = replace(RIM.cup, **{name: NUMBERS[name] for name in ("inclination", "anteversion")})
    for tilt in (0.72, 1.1):
        values = jax.tree.map(jax.numpy.asarray, NUMBERS | {"x": np.sin(tilt), "z": np.cos(tilt)})
        direction = [float(values[name]) for name in "xyz"]
        known = replace(RIM, cup=cup_of_values).press(HIP, force=3000.0, direction=direction)
        slopes, pressed = press_with_slopes(values)
        for output in ("displacement", "force_vector", "max_pressure", "half_angle"):
            expected = getattr(known, output)
            assert np.asarray(pressed[output]) == pytest.approx(expected, abs=1e-3 * np.max(abs(expected))), output
        assert float(pressed["edge_margin"]) == pytest.approx(max(float(known.edge_margin), 0.0), abs=1e-3)
        for name, value in values.items():
            step = 5e-5 * max(abs(float(value)), 0.1)
            low, high = (press_with_slopes(values | {name: value + change})[1] for change in (-step, step))
            for output in OUTPUTS:
                difference = np.asarray(high[output] - low[output]) / (2 * step)
                error = np.max(abs(slopes[output][name] - difference)) / slope_scale(output, name, difference)
                limit = 1e-3 if output in ("displacement", "force_vector", "max_pressure") else 1e-2
                assert error < limit, (tilt, name, output)


def test_first_press_may_be_traced():
    """The arrays of the bore are cached with their numbers; tracers would be invalid after the trace."""
    cup = JaxSphere(model=MODEL, joint=HIP)
    jax.eval_shape(lambda force: cup.press(force, DIRECTION), FORCE)
    assert np.asarray(cup._bores.frame) == pytest.approx(np.array(MODEL.cup.frame))


def test_an_angle_that_is_not_stated_is_that_of_the_cup():
    left = replace(RIM, cup=bs.Cup(inclination=0.2, side=bs.Side.LEFT))
    with jax.enable_x64(True):
        frame = np.asarray(JaxSphere(model=left, joint=HIP, dtype="float64")._orient(None, 0.3))
    assert frame == pytest.approx(np.array(replace(left.cup, anteversion=0.3).frame), abs=1e-12)


REFUSALS = [
    # of the bore
    ({"model": "sphere"}, TypeError, "model must be Sphere, got 'sphere'"),
    ({"joint": "hip-36"}, TypeError, r"joint must be a Joint, got 'hip-36'; use bs.joints\['hip-36'\]"),
    ({"joint": HIP.replace(clearance=np.array([0.1, 0.2]))}, TypeError, "joint must have plain numbers"),
    ({"joint": HIP.replace(liner=bs.Material(young=750.0, poisson=0.5))}, ValueError, "no answer for ν = 0.5"),
    ({"dtype": "float16"}, ValueError, "dtype = 'float16' is not allowed: it is 'float32' or 'float64'"),
    ({"dtype": None}, ValueError, "dtype = None is not allowed"),
    ({"tolerance": 0.1}, ValueError, "tolerance = 0.1 is not allowed: a tolerance is 1e-9 to 1e-2"),
    # of the loads
    ({"model": COARSE}, ValueError, "JaxSphere needs LinearGap and rings of 3 deg"),
    ({"dtype": "float64"}, ValueError, "float64.* needs jax.config.update.*jax_enable_x64"),
    ({"force": 1000.0}, ValueError, r"force of shape \(\) is not allowed: it is a row \(loads,\)"),
    ({"force": []}, ValueError, r"force of shape \(0,\) is not allowed"),
    ({"force": "3 kN"}, TypeError, "force must be a number or an array of real numbers"),
    ({"direction": [[0.0, 1.0]]}, ValueError, r"direction of shape \(1, 2\) is not allowed: its last axis holds x"),
    ({"direction": np.ones((3, 3))}, ValueError, r"direction of shape \(3, 3\) is not allowed: its shape is"),
    ({"clearance": [0.1, 0.2]}, ValueError, r"clearance of shape \(2,\) is not allowed: its shape is \(\)"),
    ({"depth": 0.01}, ValueError, r"depth of shape \(\) is not allowed: its shape is \(34, 120\)"),
    ({"young": [700.0, 800.0]}, ValueError, r"young of shape \(2,\) is not allowed"),
    ({"poisson": 0.5}, ValueError, "sphere has no answer for ν = 0.5: an incompressible body"),
    ({"inclination": [0.7, 0.8]}, ValueError, r"inclination of shape \(2,\) is not allowed"),
]


@pytest.mark.parametrize(("inputs", "error", "message"), REFUSALS)
def test_wrong_bores_and_loads_are_refused(inputs, error, message):
    fields = {"model": MODEL, "joint": HIP, "dtype": "float32", "tolerance": 2e-5}
    bore = {name: inputs.get(name, value) for name, value in fields.items()}
    loads = {name: value for name, value in inputs.items() if name not in fields}
    with pytest.raises(error, match=message):
        JaxSphere(**bore).press(**{"force": FORCE, "direction": DIRECTION} | loads)


@pytest.mark.long
def test_loads_that_the_bore_does_not_hold_have_not_converged():
    """The length of a direction does not matter; a load that no cell carries is not balanced."""
    direction = np.zeros((4, 3))
    direction[:, 2] = 1e30, 1e-30, 1.0, 1.0
    contacts = JaxSphere(model=MODEL, joint=HIP).press([1000.0, 1000.0, 1e-30, 1e9], direction)
    expected = MODEL.press(HIP, force=1000.0).max_pressure
    assert np.asarray(contacts.converged).tolist() == [True, True, False, False]
    assert np.asarray(contacts.max_pressure)[:2] == pytest.approx(expected, rel=1e-4)
    assert np.isnan(np.asarray(contacts.max_pressure)[2:]).all()
