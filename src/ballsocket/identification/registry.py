"""Registry of the unknowns of an identification: numbers of the joint, model, machine and observable.

A new number of a model or an observable, or error of a machine, is one definition and one line of a tuple below. It is
then available in Python, in files and on the command line, in tables, notes, figures and JSON.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ..core.quantities import Quantity
from ..studies.parameters import AIMS, LOADS, PARAMETERS
from .observables import FRICTION_COEFFICIENT
from .unknown_kinds import COMPLIANCE, DRIFT, OFFSET, WORK_OF_ADHESION, MachineError, ModelNumber

_MODEL_NUMBERS = (
    WORK_OF_ADHESION,
)  # fmt: skip

_MACHINE_ERRORS = (
    COMPLIANCE,
    OFFSET,
    DRIFT,
)

_OBSERVABLE_NUMBERS = (
    FRICTION_COEFFICIENT,
)  # fmt: skip

MODEL_NUMBERS: Mapping[str, ModelNumber] = MappingProxyType({number.name: number for number in _MODEL_NUMBERS})
"""Numbers of models by name."""

MACHINE_ERRORS: Mapping[str, MachineError] = MappingProxyType({error.name: error for error in _MACHINE_ERRORS})
"""Errors of machines by name."""

OBSERVABLE_NUMBERS: Mapping[str, Quantity] = MappingProxyType({number.name: number for number in _OBSERVABLE_NUMBERS})
"""Numbers of custom observables by name."""

JOINT_NUMBERS: Mapping[str, Quantity] = MappingProxyType(
    {name: quantity for name, quantity in PARAMETERS.items() if name not in LOADS and name not in AIMS}
)
"""Numbers of the joint by their names in studies."""

FREE_NUMBERS: Mapping[str, Quantity] = MappingProxyType(
    {**JOINT_NUMBERS, **{name: number.quantity for name, number in MODEL_NUMBERS.items()}, **OBSERVABLE_NUMBERS}
)
"""Unknowns that a caller or a file names as free; those of a machine are stated by the machine."""
