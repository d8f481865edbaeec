"""Model with compiled solutions of large arrays, and a force law for compiled programs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy

from ..contact import Contact, Model, ModelWrapper
from ..contact.assembly import SolverResult, as_arrays, broadcast_load, check_joint, select_and_check_load
from ..contact.joint_curve import solve_by_curve
from ..contact.octave_curve import OctaveCurve
from ..core import arrays
from ..core.arrays import Array, Numbers
from ..core.checks import reject_unnamed_loads, shown
from ..core.validity import Status, check_domain
from ..elasticity.exact.tabulated.model import Tabulated
from ..models.closed_form import ClosedFormSolution
from ..models.foundation import RadialFoundation
from ..models.modulus import FunctionModulus
from ..problem import Joint
from . import kernels
from .law import CompiledLaw, compiled_law
from .overloads import compile_loop, frexp
from .table_kernel import solve_tabulated


@dataclass(frozen=True, kw_only=True)
class Compiled(ModelWrapper):
    """Wrapped model that solves NumPy float64 arrays of loads in compiled loops.

    Compiled loops apply to forces, and to indentations of models that need an iteration: many loads on one joint are
    read from its curve, and `Tabulated` also solves arrays of joints.

    The wrapped model solves everything else (half angles, other array libraries, dtypes, plain numbers). Compiled
    programs can call `law(joint)`.

    Parameters
    ----------
    model : RadialFoundation, Tabulated, Refined or ExactCurve
        Wrapped model, for instance `HessForsbach()`.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.compiled import Compiled
    >>> fast = Compiled(model=bs.HessForsbach())
    >>> contact = fast.press(bs.joints["hess-forsbach"], force=numpy.array([1000.0, 3000.0]))
    >>> contact.max_pressure.round(3)
    array([ 5.921, 11.27 ])
    """

    model: Model

    def __post_init__(self) -> None:
        if not (isinstance(self.model, RadialFoundation) or getattr(self.model, "has_curve", False)):
            raise TypeError(
                f"model must be a RadialFoundation, such as HessForsbach(), or Tabulated(), Refined(), ExactCurve(), "
                f"got {shown(self.model)}; use Tabulated() for the exact solution"
            )

    def press(
        self,
        joint: Joint,
        *unnamed: Any,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
    ) -> Contact:
        """Solve the contact for one load, by compiled loops where possible; see `Model.press`."""
        reject_unnamed_loads(unnamed)
        check_joint(joint)
        kind, load = select_and_check_load(force=force, indentation=indentation, half_angle=half_angle)
        load = broadcast_load(load, joint.strengths())
        large = [number for number in (*joint.numbers(), load) if not arrays.is_plain_number(number)]
        if (
            kind == "force"
            and isinstance(self.model, RadialFoundation)
            and not isinstance(self.model.modulus, FunctionModulus)
            and large
            and all(map(_is_float64, large))
            and all(map(arrays.is_plain_number, self.parameters))
        ):
            return self._solve_forces(self.model, joint, load)
        return super().press(joint, force=force, indentation=indentation, half_angle=half_angle)

    def _solve_forces(self, model: RadialFoundation, joint: Joint, force: Array) -> Contact:
        """Solve the contacts of a radial foundation for forces in one compiled loop."""
        _, array_joint, load = as_arrays(joint, force)
        in_domain = check_domain((*self.fits, *self.domain), array_joint, self.name)
        d, p0, angle, status = kernels.solve_forces(model, array_joint, load)
        if not arrays.all_true(in_domain):
            status = numpy.where(in_domain, status, numpy.int8(Status.OUTSIDE_DOMAIN))
            d, p0, angle = (numpy.where(in_domain, values, numpy.nan) for values in (d, p0, angle))
        contact = Contact(
            model=self,
            laws=ClosedFormSolution(model=model, joint=array_joint, indentation=d),
            joint=array_joint,
            force=numpy.broadcast_to(load, d.shape),
            indentation=d,
            status=status,
        )
        vars(contact).update(max_pressure=p0, half_angle=angle)
        return contact

    def _solve_by_curve(self, joint: Joint, kind: str, load: Array) -> SolverResult | None:
        return solve_by_curve(self.model, joint, kind, load, evaluate_curve) if self.has_curve else None

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        """Solve the contacts of arrays of joints by `Tabulated` in a compiled loop, if all arrays are float64."""
        is_compilable = kind != "half_angle" and all(map(_is_float64, (*joint.numbers(), load)))
        has_many_joints = max(numpy.size(number) for number in joint.numbers()) > 1
        if is_compilable and has_many_joints and isinstance(self.model, Tabulated):
            return solve_tabulated(self.model, joint, kind, load)
        return super()._solve(joint, kind, load)

    def _law(self, joint: Joint) -> CompiledLaw:
        return compiled_law(super()._law(joint))


def _is_float64(number: Any) -> bool:
    """Check if a value is a NumPy array of float64."""
    return isinstance(number, numpy.ndarray) and number.dtype == numpy.float64


def evaluate_curve(curve: OctaveCurve, x: Numbers) -> Numbers:
    """Evaluate all quantities of a curve (quantities, n) at numbers (n,) between both ends."""
    quantities, terms, _ = curve.coefficients.shape
    values = numpy.empty((quantities, len(x)))
    rows = numpy.ascontiguousarray(curve.coefficients.transpose(2, 0, 1))
    _curve_loop(quantities, terms)(x, curve.first, curve.density, curve.origins, rows, values)
    return values


@cache
def _curve_loop(quantities: int, terms: int) -> Any:
    """Return the compiled loop over numbers; the counts are constants of it, so that inner loops are unrolled."""

    def evaluate(x, first, density, origins, rows, values):  # type: ignore[no-untyped-def]
        """Evaluate the polynomials of the piece of each number."""
        for j in range(len(x)):
            mantissa, exponent = frexp(x[j])
            piece = min(int(2 * density * mantissa) + density * exponent - first, len(origins) - 1)
            offset = x[j] - origins[piece]
            for row in range(quantities):
                total = rows[piece, row, 0]
                for term in range(1, terms):
                    total = total * offset + rows[piece, row, term]
                values[row, j] = total

    return compile_loop(evaluate)
