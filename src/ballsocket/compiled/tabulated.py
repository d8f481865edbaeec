"""`Tabulated` by force or indentation: each contact found and read on its joint's curve in a compiled loop."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy
from numba.extending import overload

from ..contact.assembly import SolverResult
from ..core.arrays import Numbers
from ..elasticity.exact.tabulated import chebyshev, formulas
from ..elasticity.exact.tabulated.curves import JointCurves
from ..elasticity.exact.tabulated.formulas import (
    CurveCoefficients,
    Scale,
    angle_of_force,
    angle_of_indentation,
    contact,
)
from ..elasticity.exact.tabulated.model import Tabulated
from ..problem import Joint
from .teaching import compilable, compiled, flat, pick, taught


def solved(model: Tabulated, joint: Joint, kind: str, load: Numbers) -> SolverResult:
    """The answer to a load of a joint of arrays."""

    def read(curves: JointCurves, given: Numbers) -> tuple[Numbers, ...]:
        """ε, d, F, p0 and dF/dd of contacts (contacts,)."""
        inputs = (curves.scaled_load(kind, given), curves.ratio, *curves.scale)
        found = numpy.empty((5, len(given)))
        _kernel(kind)(*(flat(part, given.shape) for part in inputs), curves.functions, found)
        return tuple(found)

    return model.answer(joint, kind, load, read)


@cache
def _kernel(kind: str) -> Any:
    """The compiled loop for loads of one kind."""
    find = angle_of_force if kind == "force" else angle_of_indentation

    def run(load, ratio, clearance, area, compliance, series, found):  # type: ignore[no-untyped-def]
        step = 0 if series.shape[2] == 1 else 1
        functions = series[:, :, 0].copy()
        for i in range(found.shape[1]):
            functions[:] = series[:, :, step * i]
            curve = CurveCoefficients(pick(ratio, i), functions, functions)
            angle = find(pick(load, i), curve)
            scale = Scale(pick(clearance, i), pick(area, i), pick(compliance, i))
            d, F, p0, stiffness, _ = contact(angle, curve, scale)
            found[0, i], found[1, i], found[2, i], found[3, i], found[4, i] = angle, d, F, p0, stiffness

    return compiled(run)


@overload(formulas.evaluate, strict=False)
def _at(angle: Any, curve: Any, rows: Any) -> Callable[..., Any]:
    if rows.count == 1:
        return lambda angle, curve, rows: _functions(angle, curve)[:1]
    if rows.count == 2:
        return lambda angle, curve, rows: _functions(angle, curve)[:2]
    return lambda angle, curve, rows: _functions(angle, curve)


@compilable
def _functions(angle, curve):  # type: ignore[no-untyped-def]
    """The three functions and their slopes by ln ε, from T_k+1 = 2x T_k - T_k-1 and T_k' = k U_k-1."""
    root = chebyshev.angle_root(angle, curve.ratio)
    x = 2 * root - 1
    c, twice = curve.functions, 2 * x
    T, T_next, U, U_next = 1.0, x, 1.0, twice
    share, force, pole = c[0, 0] + c[0, 1] * x, c[1, 0] + c[1, 1] * x, c[2, 0] + c[2, 1] * x
    share_slope, force_slope, pole_slope = c[0, 1], c[1, 1], c[2, 1]
    for k in range(2, c.shape[1]):
        T, T_next = T_next, twice * T_next - T
        rise = k * U_next
        share += c[0, k] * T_next
        force += c[1, k] * T_next
        pole += c[2, k] * T_next
        share_slope += c[0, k] * rise
        force_slope += c[1, k] * rise
        pole_slope += c[2, k] * rise
        U, U_next = U_next, twice * U_next - U
    widening = formulas.angle_derivative(angle, root, curve.ratio)
    return (share, widening * share_slope), (force, widening * force_slope), (pole, widening * pole_slope)


for _formula in (
    chebyshev.angle_root,
    formulas.angle_derivative,
    formulas.opening,
    formulas.contact,
    formulas._solve_angle,
    formulas._indentation_residual,
    formulas._force_residual,
    formulas.angle_of_indentation,
    formulas.angle_of_force,
):
    taught(_formula)
