"""Default model of a study: tabulated, or exact for joints outside the tables."""

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
from .parameters import LOADS, press_arguments

_TABULATED, _EXACT_CURVE = Tabulated(), ExactCurve()


def default_model(joint: Joint, ranges: Mapping[str, Any]) -> Model:
    """Choose the model for a joint with varied parameters.

    It is `tabulated` unless none of the joints is in its domain. Otherwise it is `exact`, or `exact-curve` for a
    single joint.

    Parameters
    ----------
    joint : Joint
        Parameters that do not vary.
    ranges : mapping of str to sequence
        Ends of the range or all values of each varied parameter; materials by `liner` or `ball`.
    """
    try:
        check_model_domain(_TABULATED, joint, ranges)
    except OutsideDomainError:
        return _EXACT_CURVE if all(name in LOADS for name in ranges) else reference
    return _TABULATED


def check_model_domain(model: Model, joint: Joint, ranges: Mapping[str, Any]) -> None:
    """Check that some joint of a range is in the domain of a model.

    Raises
    ------
    OutsideDomainError
        No joint is in the domain; the message has the reason.
    """
    check_domain((*model.fits, *model.domain), joint_of_arrays(joint, ranges), model.name)


def joint_of_arrays(joint: Joint, ranges: Mapping[str, Any]) -> Joint:
    """Return all joints of a range as one joint of arrays; parameters are those of `default_model`."""
    design = grid(**ranges)
    check_values(design)
    return press_arguments(joint, design.values_in([slice(None)] * len(design.axes)))[0]
