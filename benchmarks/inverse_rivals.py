"""The same inverse solve as other people would run it: the formulas in JAX, and Eq. (13) handed to SciPy.

JAX runs this package's own formulas. The SciPy rivals share nothing with it but the printed numbers of Table 3: the
modulus is `PchipInterpolator` through them, the root of Eq. (13) is bracketed by 0 and the liner's thickness.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence

import numpy
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, elementwise

import ballsocket as bs
from ballsocket.models.table_3 import table_3

Answer = tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]
"""Indentation, maximum pressure, half angle."""


def joint_of(inputs: Sequence[numpy.ndarray]) -> bs.Joint:
    """A joint of arrays from ball radius, clearance, thickness, Young's modulus and Poisson's ratio."""
    radius, clearance, thickness, young, poisson = inputs[:5]
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner)


def jax_solver(inputs: Sequence[numpy.ndarray]) -> Callable[[], Answer] | None:
    """A call that runs the jitted press on arrays that JAX already holds; None without JAX."""
    if importlib.util.find_spec("jax") is None:
        return None
    import jax

    jax.config.update("jax_enable_x64", True)

    @jax.jit
    def press(*numbers: numpy.ndarray) -> tuple[numpy.ndarray, ...]:
        contact = bs.HessForsbach().press(joint_of(numbers), force=numbers[5])
        return contact.indentation, contact.max_pressure, contact.half_angle, contact.status

    held = [jax.numpy.asarray(part) for part in inputs]

    def solve() -> Answer:
        d, p0, angle, _ = jax.block_until_ready(press(*held))
        return d, p0, angle

    return solve


def _constants(inputs: Sequence[numpy.ndarray]) -> tuple[numpy.ndarray, ...]:
    """R2, c, K, F with Eq. (18)."""
    radius, clearance, thickness, young, poisson, force = inputs
    table = table_3()
    c1, c2, c3 = PchipInterpolator(table["poisson"], [table[name] for name in ("C1", "C2", "C3")], axis=1)(poisson)
    socket = radius + clearance
    return socket, clearance, young / socket * (c1 + c2 * socket / thickness + c3 * (socket / thickness) ** 2), force


def _excess(d, R2, c, K, F):  # type: ignore[no-untyped-def]
    """Eq. (13) as printed, less the force that is asked for."""
    return numpy.pi * R2**2 * K / 3 * (2 * d - c + c * (c / (c + d)) ** 2) - F


def _answer(d: numpy.ndarray, constants: Sequence[numpy.ndarray]) -> Answer:
    _, clearance, K, _ = constants
    return d, K * d, numpy.arccos(clearance / (clearance + d))


def brentq_solve(inputs: Sequence[numpy.ndarray]) -> Answer:
    """One root after the other, in plain floats."""
    constants = _constants(inputs)
    rows = zip(*(part.tolist() for part in (*constants, inputs[2])), strict=True)
    d = [brentq(_excess, 0.0, thickness, args=tuple(numbers), xtol=1e-15, rtol=1e-15) for *numbers, thickness in rows]
    return _answer(numpy.array(d), constants)


def find_root_solve(inputs: Sequence[numpy.ndarray]) -> Answer:
    """All roots at once."""
    constants = _constants(inputs)
    found = elementwise.find_root(_excess, (0.0 * inputs[2], inputs[2]), args=constants)
    return _answer(found.x, constants)
