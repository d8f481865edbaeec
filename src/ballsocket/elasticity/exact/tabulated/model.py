"""Exact solution interpolated from small tables: contacts by their loads, block by block, with energy and pressure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import inf, pi, prod
from typing import Any, ClassVar

import numpy

from ....contact import Model
from ....contact.assembly import SolverResult
from ....contact.closed_sphere import HEMISPHERE_NOTE, LIKE_HEMISPHERE
from ....contact.coordinates import LIMIT
from ....core import arrays
from ....core.arrays import Array, broadcast, clip, convert_like, gauss_legendre, safe_divisor, sin, sqrt, where
from ....core.chebyshev import chebyshev_polynomials, sum_series
from ....core.lazy import cached_property
from ....core.sources import Source
from ....core.validity import SMALL_STRAIN, Promise, Range, Status
from ....problem import Joint
from ....problem.gaps import LINEAR_GAP, LINEAR_GAP_REMARK
from .chebyshev import POISSON, THICKNESS_RATIO, angle_coordinate, chebyshev_values
from .curves import SMALL_LOAD, JointCurves, contact_quantities, plain_joint_curves
from .inverse import solve_state

_BLOCK = 4000  # contacts in one block, which fits into the cache; powers of two collide in the cache


@dataclass(frozen=True, eq=False)
class TableSolution:
    """Contacts interpolated from the tables, with the quantities that a `Contact` delegates to."""

    file: str
    joint: Joint
    half_angle: Array  # ε in rad
    indentation: Array  # d in mm
    force: Array  # F in N
    pole_pressure: Array  # p0 in MPa
    stiffness: Array  # dF/dd in N/mm

    @property
    def max_pressure(self) -> Array:
        """Largest pressure in MPa, which lies at the pole for all joints in the tables."""
        return self.pole_pressure

    @property
    def max_pressure_angle(self) -> Array:
        """Polar angle of the largest pressure in rad: 0."""
        return 0.0 * self.half_angle

    @property
    def foundation_modulus(self) -> Array:
        """Foundation modulus p0/d in MPa/mm."""
        return where(self.indentation == 0, inf, self.pole_pressure / safe_divisor(self.indentation))

    @cached_property
    def energy(self) -> Array:
        """Energy U = ∫ F dd in N mm, the work of the force during indentation."""
        (energy,) = _compute_in_blocks(self.file, self.joint, self.half_angle, _integrate_work)
        return where(self.half_angle > 0, energy, 0.0 * self.half_angle)

    @property
    def pressure_integral(self) -> Array:
        """Integral of the pressure over the contact area, ∫ p dA, in N.

        It follows from U = (d F - c ∫ p (1 - cos φ) dA)/2 and F = ∫ p cos φ dA.
        """
        d, F = self.indentation, self.force
        return F + (d * F - 2 * self.energy) / self.joint.clearance

    @cached_property
    def _profile_coefficients(self) -> Array:
        """Chebyshev coefficients of the pressure profile p/(p0 sqrt(1 - v)), along the first axis.

        The argument is 2v - 1 with v = sin²(φ/2)/sin²(ε/2).
        """
        (series,) = _compute_in_blocks(self.file, self.joint, self.half_angle, _profile_coefficients)
        return series

    @cached_property
    def _profile_correction(self) -> tuple[Array, Array]:
        """Corrections a and b of p = p0 sqrt(1 - v) [q(v) + a + b v], which is 1 at the pole and has the force F."""
        q = [self._profile_coefficients[k, ...] for k in range(self._profile_coefficients.shape[0])]
        F, p0 = self.force, self.pole_pressure
        height = sin(safe_divisor(self.half_angle) / 2) ** 2
        plain, tilted = _profile_moments(len(q))
        carries = [even - 2 * height * odd for even, odd in zip(plain, tilted, strict=True)]
        pole_correction = 1 - arrays.weighted_sum(q, [(-1.0) ** k for k in range(len(q))])
        target = F / safe_divisor(4 * pi * self.joint.socket_radius**2 * p0 * height)
        carried = sum(
            (coefficient * moment for coefficient, moment in zip(q, carries, strict=False)),
            pole_correction * carries[0],
        )
        return pole_correction, (target - carried) / carries[-1]

    def pressure(self, angle: Array) -> Array:
        """Compute the contact pressure p(φ) in MPa at polar angles (rad); 0 outside the contact."""
        pole_correction, tilt = self._profile_correction
        half, height = sin(angle / 2), sin(safe_divisor(self.half_angle) / 2) ** 2
        v = half * half / height
        total = _evaluate_series(self._profile_coefficients, clip(2 * v - 1, -1.0, 1.0)) + pole_correction + tilt * v
        inside = (v < 1) & (abs(angle) < pi) & (self.half_angle > 0)
        return where(inside, self.pole_pressure * sqrt(clip(1 - v, 0.0, 1.0)) * clip(total, 0.0, inf), 0.0)


def _evaluate_series(series: Array, x: Array) -> Array:
    """Evaluate the Chebyshev series Σ series[k] T_k(x) by Clenshaw's recurrence."""
    following = current = 0.0 * x
    for k in range(series.shape[0] - 1, 0, -1):
        current, following = series[k, ...] + 2 * x * current - following, current
    return series[0, ...] + x * current - following


def _profile_coefficients(curves: JointCurves, angle: Array) -> tuple[Array]:
    series = curves.table_series("profile")
    if series.ndim == 2:
        return (series @ chebyshev_values(angle_coordinate(angle, curves.ratio), series.shape[1]),)
    waves = chebyshev_polynomials(angle_coordinate(angle, curves.ratio), series.shape[1])
    return (arrays.namespace(angle).stack([sum_series(series[k, ...], waves) for k in range(series.shape[0])]),)


def _integrate_work(curves: JointCurves, angle: Array) -> tuple[Array]:
    """Compute the work ∫ F dd in N mm; with half angles ε sin²(πy/2) the integrand has no singular ends."""
    nodes, weights = (numpy.array(numbers) for numbers in gauss_legendre(32))
    shares, factors = numpy.sin(pi / 2 * nodes) ** 2, pi * weights / numpy.tan(pi / 2 * nodes)
    if arrays.all_true(angle == angle) is None:  # all nodes at once, which compiles in a tenth of the time
        xp = arrays.namespace(angle)
        _, F, _, _, deepening = curves.contact_quantities(convert_like(shares, angle)[:, None] * angle)
        return (xp.sum(convert_like(factors, angle)[:, None] * F * deepening, axis=0),)
    total = 0.0 * angle
    for share, factor in zip(shares.tolist(), factors.tolist(), strict=True):
        _, F, _, _, deepening = curves.contact_quantities(share * angle)
        total = total + factor * F * deepening
    return (total,)


@cache
def _profile_moments(size: int) -> tuple[list[float], list[float]]:
    """Compute two moments of each profile function f: ∫ sqrt(1 - v) f dv and ∫ sqrt(1 - v) f v dv over [0, 1].

    The functions are f = T_0(2v - 1) ... T_size-1 and f = v.
    """
    y, w = (numpy.array(function) for function in gauss_legendre(2 * size + 4))
    v, w = 1 - y * y, 2 * y * y * w
    functions = [*numpy.polynomial.chebyshev.chebvander(2 * v - 1, size - 1).T, v]
    return [float(w @ function) for function in functions], [float(w @ (function * v)) for function in functions]


CurveReader = Callable[[JointCurves, Array], tuple[Array, ...]]
"""Function of the curves of joints and the loads of contacts (contacts,) that returns arrays (contacts,)."""


def curve_reader(kind: str) -> CurveReader:
    """Return a function that computes ε, d, F, p0, dF/dd and the last change of ε from curves and loads of one kind."""

    def read_half_angle(curves: JointCurves, load: Array) -> tuple[Array, ...]:
        angle = where(load <= LIMIT, load, math.nan)
        return (angle, *curves.contact_quantities(angle)[:4], 0.0 * angle)

    def solve_load(curves: JointCurves, load: Array) -> tuple[Array, ...]:
        state, shift = solve_state(curves, kind, load)
        return (state.angle, *contact_quantities(state, curves.scale)[:4], shift)

    return read_half_angle if kind == "half_angle" else solve_load


def _compute_in_blocks(file: str, joint: Joint, load: Array, compute_quantities: CurveReader) -> tuple[Array, ...]:
    """Compute quantities of contacts block by block with a function of curves; replace loads that are not positive."""
    if type(load) is float:
        return compute_quantities(plain_joint_curves(file, joint), load if load > 0 else SMALL_LOAD)
    xp, numbers = arrays.namespace(load), joint.numbers()
    shape = numpy.broadcast_shapes(*(tuple(part.shape) for part in (load, *numbers)))
    if not prod(shape):  # read one contact for the shape, and remove it
        unit_load = xp.ones((1,), dtype=load.dtype)
        single = compute_quantities(JointCurves(file, joint.with_numbers([unit_load for _ in numbers])), unit_load)
        return tuple(xp.reshape(part[..., :0], (*part.shape[:-1], *shape)) for part in single)
    is_single_joint = all(prod(part.shape) == 1 for part in numbers)
    shared, indices = (None, None) if is_single_joint else _shared_curves(file, joint, shape)
    broadcasted = (part if prod(part.shape) == 1 else arrays.broadcast_to(part, shape) for part in numbers)
    flat = [xp.reshape(part, (-1,)) for part in broadcasted]
    loads = xp.reshape(arrays.broadcast_to(where(load > 0, load, SMALL_LOAD), shape), (-1,))
    if arrays.is_jax_array(loads) and arrays.all_true(loads == loads) is None:
        values = _map_blocks_in_jax(file, joint, [*flat, loads], compute_quantities)
        return tuple(xp.reshape(part, (*part.shape[:-1], *shape)) for part in values)
    all_curves = JointCurves(file, joint.with_numbers(flat))
    size = _BLOCK * (1 if xp is numpy else 64)
    results = []
    for first in range(0, max(prod(shape), 1), size):
        block = slice(first, min(first + size, prod(shape)))
        block_indices = None if indices is None else indices[block]
        parts = [part if part.shape[0] == 1 else part[block] for part in flat]
        curves = all_curves if is_single_joint else JointCurves(file, joint.with_numbers(parts), shared, block_indices)
        results.append(compute_quantities(curves, loads[block]))
    joined = (xp.concat(parts, axis=-1) if len(parts) > 1 else parts[0] for parts in zip(*results, strict=True))
    return tuple(xp.reshape(part, (*part.shape[:-1], *shape)) for part in joined)


_SERIES_NUMBERS = 128
"""Number of stored values of a contact with a joint of its own: three series of 32 terms, and that of the start."""


def _map_blocks_in_jax(
    file: str, joint: Joint, rows: list[Array], compute_quantities: CurveReader
) -> tuple[Array, ...]:
    """Compute quantities block by block inside `jax.jit`; rows of joint and loads are (1,) or (contacts,)."""

    def compute_block(*parts: Array) -> tuple[Array, ...]:
        return compute_quantities(JointCurves(file, joint.with_numbers(list(parts[:-1]))), parts[-1])

    if all(row.shape[0] == 1 for row in rows[:-1]):
        return compute_block(*rows)
    return arrays.map_jax_blocks(compute_block, rows, _SERIES_NUMBERS)


def _shared_curves(file: str, joint: Joint, shape: tuple[int, ...]) -> tuple[JointCurves | None, Array | None]:
    """Return the curves of the joints of a grid and the joint of each contact, or None if sharing saves no time."""
    numbers = joint.numbers()
    inner = numpy.broadcast_shapes(*(tuple(part.shape) for part in numbers))
    shares = prod(inner) * _MIN_CONTACTS_PER_JOINT <= prod(shape) and prod(inner) <= _BLOCK
    if not shares or arrays.namespace(*numbers) is not numpy:
        return None, None
    flat = [numpy.broadcast_to(part, inner).ravel() for part in numbers]
    indices = numpy.broadcast_to(numpy.arange(prod(inner)).reshape(inner), shape).ravel()
    return JointCurves(file, joint.with_numbers(flat)), indices


_MIN_CONTACTS_PER_JOINT = 4


def _ball_poisson(contact: Any) -> Array:
    """Return Poisson's ratio of the ball, or 0.3 for a rigid ball, whose ν has no effect."""
    joint = contact.joint
    return 0.3 + 0.0 * joint.liner.young if joint.ball is None else joint.ball.poisson + 0.0 * joint.liner.young


_NOT_TABULATED = "outside the tables: use exact"


@dataclass(frozen=True, kw_only=True)
class Tabulated(Model):
    """Exact solution interpolated from tables: vectorised, differentiable, about 1 µs for each contact.

    Arrays may come from any array library. The tables contain the linear gap (Eq. 6 of Heß & Forsbach 2021) and one
    liner bonded to a rigid backing. Half angles reach up to 85 degrees. Results are within 1e-5 of `Exact` for a rigid
    ball, within 2e-4 for an elastic one.

    Parameters
    ----------
    file : str
        Path of tables made by `build.build`; the default is the tables of the package.

    References
    ----------
    The equation behind the tables is derived in the docs (theory).

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.Tabulated().press(bs.joints["hip-28"], force=3000.0)
    >>> round(contact.max_pressure, 2)  # MPa
    16.94
    """

    file: str = ""

    seconds_a_press: ClassVar[float] = 4e-6
    is_closed_sphere: ClassVar[bool] = True
    accepts_floats: ClassVar[bool] = True
    has_curve: ClassVar[bool] = True
    name: ClassVar[str] = "tabulated"
    title: ClassVar[str] = "elastic ball and bonded liner, from tables of the exact answer"
    sources: ClassVar[tuple[Source, ...]] = (Source("hess2021", "(6)"), Source("goodman1965"))
    domain: ClassVar[tuple[Range, ...]] = (
        Range(quantity="joint.clearance", low=0.0, why="no clearance: use cosine-limit"),
        Range(quantity="joint.liner.poisson", low=POISSON[0], high=POISSON[1], why=_NOT_TABULATED),
        Range(quantity="joint.thickness_ratio", low=THICKNESS_RATIO[0], high=THICKNESS_RATIO[1], why=_NOT_TABULATED),
        Range(quantity="joint.modulus_ratio", high=0.0201, why=_NOT_TABULATED),
        Range(quantity=_ball_poisson, symbol="ν_ball", low=-0.01, high=0.501, why=_NOT_TABULATED),
        Range(
            quantity=lambda contact: len(contact.joint.backing) + 0.0 * contact.joint.liner.young,
            symbol="layers behind the liner",
            high=1.0,
            why=_NOT_TABULATED,
        ),
        Range(quantity="joint.backing_ratio", high=1.0, why="a free outer surface is not in the tables: use exact"),
    )
    validity: ClassVar[tuple[Range, ...]] = (
        Range(
            quantity=_ball_poisson,
            symbol="ν_ball",
            low=0.15,
            high=0.4,
            why="the tables hold balls of ν 0.15, 0.27 and 0.38 and keep 2e-4 between them",
        ),
        LINEAR_GAP,
        SMALL_STRAIN,
        LIKE_HEMISPHERE,
    )
    remarks: ClassVar[tuple[Range, ...]] = (LINEAR_GAP_REMARK, HEMISPHERE_NOTE)

    promise: ClassVar[Promise] = Promise(within=2e-4, quantities=("indentation", "half_angle", "max_pressure"))

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self.solve_with_reader(joint, kind, load, curve_reader(kind))

    def solve_with_reader(self, joint: Joint, kind: str, load: Array, read: CurveReader) -> SolverResult:
        """Solve the contacts for loads of one kind; NaN beyond the range of the tables.

        The function `read` evaluates the curves of joints, see `curve_reader`.
        """
        *values, shift = _compute_in_blocks(self.file, joint, load, read)
        fits = arrays.logical_not(values[1] < 0)  # a negative indentation is wider than the perfect fit
        loads = broadcast(load, values[1])
        is_loaded = loads > 0
        if arrays.all_true(fits & is_loaded) is not True:
            rest = where(loads == 0, 0.0 * loads, math.nan)  # no solution for a traced load below 0
            values = [where(is_loaded, where(fits, value, math.nan), rest) for value in values]
        solution = TableSolution(self.file, joint, *values)
        tolerance = _ROUNDING_ERRORS * arrays.machine_epsilon(load)
        return SolverResult(
            laws=solution,
            force=solution.force,
            indentation=solution.indentation,
            failures={Status.NOT_CONVERGED: arrays.logical_not(shift * shift <= tolerance)},
        )


_ROUNDING_ERRORS = 1e4
"""Largest relative error of a converged half angle over that of rounding; a correction leaves its square as error."""
