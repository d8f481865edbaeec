"""Exact solution for many loads on few joints, interpolated on a curve of each joint."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy

from ...contact import Contact, ModelWrapper
from ...contact.assembly import SolverResult
from ...contact.per_joint import JointContacts
from ...core.arrays import Array
from ...core.checks import shown
from ...problem import Joint
from ...problem.gaps import CircularGap, LinearGap
from .chebyshev_curve import ChebyshevState
from .contact import ElasticContact
from .model import Exact


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class CurveContact(ElasticContact):
    """Contact of the elastic solution with an interpolated largest stress in the liner."""

    def _joint_von_mises(self, position: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
        if isinstance(contacts.state, ChebyshevState):
            return contacts.state.largest_von_mises(contacts.reached)
        return super()._joint_von_mises(position, contacts)

    _estimate_von_mises = _joint_von_mises


@dataclass(frozen=True, kw_only=True)
class ExactCurve(ModelWrapper):
    """Exact solution for many loads on few joints, interpolated in about a microsecond per load.

    The first load on a joint costs 32 to 72 exact solutions, a hundredth of a second for most joints. Chebyshev series
    through them in the half angle give all further loads. They are accurate to a tenth of the model's tolerance, as
    reported in `contact.error`. If a joint's series do not reach that, its loads are solved one by one. Stresses inside
    the socket are those of `Exact`. Joints may have backing layers.

    Parameters
    ----------
    model : Exact
        A model whose gap is not circular; it becomes linear for every clearance.

    Raises
    ------
    TypeError
        The model is not an `Exact`.
    ValueError
        The model has a circular gap.

    Examples
    --------
    >>> import numpy
    >>> import ballsocket as bs
    >>> shell = bs.Layer(thickness=3.0, material=bs.TITANIUM)
    >>> contact = bs.ExactCurve().press(bs.joints["hip-28"].replace(backing=(shell,)), force=numpy.array([1e3, 3e3]))
    >>> contact.max_pressure.round(3)
    array([ 8.728, 16.905])
    """

    model: Exact = Exact()  # noqa: RUF009 (frozen)

    seconds_a_press: ClassVar[float] = 2e-6
    has_curve: ClassVar[bool] = True
    contact_type: ClassVar[type[Contact]] = CurveContact

    def __post_init__(self) -> None:
        if not isinstance(self.model, Exact):
            raise TypeError(f"model must be an Exact, got {shown(self.model)}")
        if self.model.gap is CircularGap:
            raise ValueError("ExactCurve needs gap=LinearGap, got a circular gap: use Exact")
        object.__setattr__(self, "model", replace(self.model, gap=LinearGap))

    def _solve(self, joint: Joint, kind: str, load: Array) -> SolverResult:
        return self.model._solve_curve_points(joint, kind, load)


def exact_stress_ratio(joint: Joint, half_angle: Array) -> Array:
    """Compute the ratio of largest von Mises stress in the liner to largest pressure, of axial contacts of a joint.

    The ratio does not depend on the clearance, which may be a preload. It is NaN for half angles (rad) that the exact
    solution does not reach.
    """
    with_clearance = joint.replace(clearance=abs(joint.clearance)).without_strengths()
    contact = ExactCurve().press(with_clearance, half_angle=half_angle)
    return contact.von_mises / contact.max_pressure
