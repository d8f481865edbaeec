"""The model of a study for which none is named: from tables, or exact where these know none of the joints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..catalogue import reference
from ..contact import Model
from ..core.validity import OutsideDomainError, check_domain
from ..elasticity.exact.exact_curve import ExactCurve
from ..elasticity.exact.tabulated.model import Tabulated
from ..problem import Joint
from .design import check_values, grid
from .parameters import LOADS, pressable

_QUICK, _CURVE = Tabulated(), ExactCurve()


def usual(joint: Joint, ends: Mapping[str, Any]) -> Model:
    """`tabulated`, or where that has no answer for any of the joints `exact`, on a curve if it is one joint.

    Parameters
    ----------
    joint : Joint
        Numbers that do not vary.
    ends : mapping of str to sequence
        Between what numbers the others vary, or which there are; materials by `liner` or `ball`.
    """
    try:
        check_known(_QUICK, joint, ends)
    except OutsideDomainError:
        return _CURVE if all(name in LOADS for name in ends) else reference
    return _QUICK


def check_known(model: Model, joint: Joint, ends: Mapping[str, Any]) -> None:
    """Raise OutsideDomainError, with the reason, where a model has no answer for any of the joints of `usual`."""
    check_domain((*model.fits, *model.domain), joints_of(joint, ends), model.name)


def joints_of(joint: Joint, ends: Mapping[str, Any]) -> Joint:
    """The joints of `usual` as one of arrays."""
    design = grid(**ends)
    check_values(design)
    return pressable(joint, design.part([slice(None)] * len(design.axes)))[0]
