"""A model whose presses of large arrays are compiled, and whose law compiled programs can call."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy

from ..contact import Contact, ModelWrapper
from ..contact.assembly import SolverResult, as_arrays, broadcast_load, check_joint, check_load
from ..core import arrays
from ..core.arrays import Array
from ..core.checks import reject_unnamed_loads, shown
from ..core.validity import Status, check_domain
from ..elasticity.exact.tabulated.model import Tabulated
from ..models.closed_form import Bound
from ..models.foundation import RadialFoundation
from ..models.refined import Refined
from ..problem import Joint
from . import foundation, refined, tabulated
from .law import CompiledLaw, compiled_law


@dataclass(frozen=True, kw_only=True)
class Compiled(ModelWrapper):
    """A model whose presses of NumPy float64 arrays are compiled: by force, and by indentation where that is solved.

    Everything else (half angles, other array libraries, dtypes, plain numbers) is passed on to the model. `law(joint)`
    can be called by compiled programs.

    Parameters
    ----------
    model : RadialFoundation, Refined or Tabulated
        For instance `HessForsbach()`.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.compiled import Compiled
    >>> fast = Compiled(model=bs.HessForsbach())
    >>> contact = fast.press(bs.joints["hess-forsbach"], force=numpy.array([1000.0, 3000.0]))
    >>> contact.max_pressure.round(3)
    array([ 5.921, 11.27 ])
    """

    model: RadialFoundation | Refined | Tabulated

    def __post_init__(self) -> None:
        if not isinstance(self.model, RadialFoundation | Refined | Tabulated):
            kinds = "a RadialFoundation, such as HessForsbach(), Refined() or Tabulated()"
            raise TypeError(f"model must be {kinds}, got {shown(self.model)}")

    def press(
        self,
        joint: Joint,
        *unnamed: Any,
        force: Array | None = None,
        indentation: Array | None = None,
        half_angle: Array | None = None,
    ) -> Contact:
        reject_unnamed_loads(unnamed)
        check_joint(joint)
        kind, given = check_load(force=force, indentation=indentation, half_angle=half_angle)
        given = broadcast_load(given, joint.strengths())
        if kind == "force" and isinstance(self.model, RadialFoundation) and self._in_one_pass(joint, given):
            return self._passed(self.model, joint, given)
        return super().press(joint, force=force, indentation=indentation, half_angle=half_angle)

    def _in_one_pass(self, joint: Joint, load: Array) -> bool:
        large = [number for number in (*joint.numbers(), load) if not arrays.is_plain(number)]
        return bool(large) and all(map(_is_float64, large)) and all(map(arrays.is_plain, self.parameters))

    def _passed(self, model: RadialFoundation, joint: Joint, force: Array) -> Contact:
        _, whole, load = as_arrays(joint, force)
        points = check_domain((*self.fits, *self.domain), whole, self.name)
        d, p0, angle, status = foundation.passed(model, whole, load)
        if not arrays.all_true(points):
            status = numpy.where(points, status, numpy.int8(Status.OUTSIDE_DOMAIN))
            d, p0, angle = (numpy.where(points, part, numpy.nan) for part in (d, p0, angle))
        contact = Contact(
            model=self,
            laws=Bound(model=model, joint=whole, indentation=d),
            joint=whole,
            force=numpy.broadcast_to(load, d.shape),
            indentation=d,
            status=status,
        )
        vars(contact).update(max_pressure=p0, half_angle=angle)
        return contact

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        if kind != "half_angle" and all(map(_is_float64, (*joint.numbers(), load))):
            if isinstance(self.model, Refined):
                return refined.solved(joint, kind, load)
            if isinstance(self.model, Tabulated):
                return tabulated.solved(self.model, joint, kind, load)
        return super()._solve(joint, kind, load)

    def _law(self, joint: Joint) -> CompiledLaw:
        return compiled_law(super()._law(joint))


def _is_float64(number: Any) -> bool:
    return isinstance(number, numpy.ndarray) and number.dtype == numpy.float64
