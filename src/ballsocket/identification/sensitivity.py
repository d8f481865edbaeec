"""Sensitivity of the estimates to machine errors that the fit neglects."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.unit_systems import Amount, Sentence
from .fit import FittedModel
from .measured import Machine, Measured
from .registry import MACHINE_ERRORS
from .unknown_kinds import MachineError

_DEFAULT_NAME = "(machine)"  # name of an unnamed machine
_RELATIVE_STEP = 1e-2  # finite-difference step over the size of an error
_TYPICAL_FORCE = 500.0  # force in N of the reading by which errors are ordered


@dataclass(frozen=True)
class Sensitivity:
    """Shifts of the estimates by one machine error of assumed size.

    Attributes
    ----------
    machine : str
        Name of the machine; empty for an unnamed machine.
    part : str
        Name of the error: "offset", "compliance" or "drift".
    size : float
        Size of the error in mm or mm/N.
    shifts : dict of str to float
        Shift of each estimate in its unit, by unknown; NaN for an unidentifiable unknown.
    """

    machine: str
    part: str
    size: float
    shifts: dict[str, float]

    @property
    def title(self) -> str:
        """Description of the machine error in words, such as "a zero offset of 1 µm"."""
        error = MACHINE_ERRORS[self.part]
        of_machine = f" in {self.machine}" if self.machine else ""
        return Sentence("{}{}", Sentence(error.phrase, Amount(self.size, error.quantity.shown)), of_machine)

    def summary(self) -> dict[str, Any]:
        """Return machine error and shifts as a dictionary for JSON, in mm, N, MPa and rad.

        The shift of an unidentifiable unknown is None.
        """
        shifts = {name: shift if shift == shift else None for name, shift in self.shifts.items()}
        return {"machine": self.machine, "error": self.part, "size": self.size, "shifts": shifts}


def sensitivities(fitted: FittedModel) -> tuple[Sensitivity, ...]:
    """Compute the shifts of all estimates by machine errors of assumed size.

    The shifts are linear at the best point: δθ = (Jᵀ W J)⁻¹ Jᵀ W δ, with the errors δ of the values. Errors that are
    unknowns of the fit are omitted. Their sizes are those assumed in the registry.
    """
    machines = {measured.machine.name: measured.machine for measured in fitted.data if _reads_indentation(measured)}
    registered = sorted(  # in descending order of the effect
        MACHINE_ERRORS.values(), key=lambda error: -error.assumed * abs(error.effect(_TYPICAL_FORCE, 1.0))
    )
    neglected_errors = [
        (name, error)
        for name, machine in machines.items()
        for error in registered
        if machine.key(error.name) not in machine.unknown_errors
    ]
    if not neglected_errors:
        return ()
    theta, transform, forward = fitted.best.theta, fitted.transform, fitted.misfit.forward
    values = transform.to_values(theta[None])
    results = forward.results_at(values)[0]
    errors = numpy.stack(
        [_change_by_machine_error(fitted, machine, error, values, results) for machine, error in neglected_errors]
    )
    theta_shifts = fitted.information.covariance @ fitted.misfit.weighted_slopes(theta)[1] @ errors.T
    shifts = transform.derivatives(theta)[:, None] * theta_shifts
    unidentifiable = [name in fitted.information.unidentifiable for name in transform.names]
    shifts[unidentifiable] = numpy.nan
    return tuple(
        Sensitivity(machine, error.name, error.assumed, dict(zip(transform.names, shift_column.tolist(), strict=True)))
        for (machine, error), shift_column in zip(neglected_errors, shifts.T, strict=True)
    )


def _reads_indentation(measured: Measured) -> bool:
    return "indentation" in (measured.quantity, measured.load)


def _change_by_machine_error(
    fitted: FittedModel, machine_name: str, error: MachineError, values: Numbers, results: Numbers
) -> Numbers:
    """Compute the change of the model results (data,) by a machine error of assumed size."""
    data = list(fitted.data)
    for index, measured in enumerate(data):
        if _reads_indentation(measured) and measured.machine.name == machine_name:
            machine = measured.machine if machine_name else Machine(name=_DEFAULT_NAME)
            size: dict[str, Any] = {error.name: getattr(machine, error.name) + _RELATIVE_STEP * error.assumed}
            data[index] = replace(measured, machine=replace(machine, **size))
    changed_results = replace(fitted.misfit.forward, data=tuple(data)).results_at(values)[0]
    return (changed_results - results) / _RELATIVE_STEP
