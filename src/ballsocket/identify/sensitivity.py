"""Sensitivity of the estimates to machine errors that the fit neglects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from .measured import MACHINE, Machine, Measured

if TYPE_CHECKING:
    from .parameters import Identified

SIZES: Mapping[str, float] = MappingProxyType({"offset": 1e-3, "compliance": 1e-6, "drift": 1e-4})
"""Assumed machine errors in mm and mm/N: 1 µm of zero, 1 µm/kN of compliance, 0.1 µm per reading of drift."""

_PHRASES = {"offset": "a zero offset of {}", "compliance": "a compliance of {}", "drift": "a drift of {} per reading"}
_UNNAMED = "(machine)"  # name for an unnamed machine
_STEP = 1e-2  # finite-difference step over the size of an error


@dataclass(frozen=True)
class Sensitivity:
    """Shift of the estimates by one error of a machine.

    Attributes
    ----------
    machine : str
        Name of the machine; empty for an unnamed machine.
    part : str
        "offset", "compliance" or "drift".
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
        """Description of the error, such as "a zero offset of 1 µm"."""
        shown = MACHINE[self.part].shown
        of_machine = f" in {self.machine}" if self.machine else ""
        return f"{_PHRASES[self.part].format(f'{shown.factor * self.size:g} {shown.text}')}{of_machine}"

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON in mm, N, MPa, rad; an undetermined shift is None."""
        shifts = {name: shift if shift == shift else None for name, shift in self.shifts.items()}
        return {"machine": self.machine, "error": self.part, "size": self.size, "shifts": shifts}


def sensitivities(identified: Identified) -> tuple[Sensitivity, ...]:
    """Compute the shifts of all estimates by errors of the machines that read indentations.

    The shifts are linear at the best point: δθ = (Jᵀ W J)⁻¹ Jᵀ W δ, with the errors δ of the values. Errors that are
    unknowns of the fit are omitted.
    """
    cases = list(_cases(identified))
    if not cases:
        return ()
    theta, scales, answers = identified.best.places, identified.scales, identified.misfit.answers
    values = scales.values(theta[None])
    answers_at_best = answers.at(values)[0]
    errors = numpy.stack([_error(identified, machine, part, values, answers_at_best) for machine, part in cases])
    moves = identified.information.covariance @ identified.misfit.shifts(theta, errors)
    shifts = scales.growth(theta)[:, None] * moves
    unidentifiable = [name in identified.information.unidentifiable for name in scales.names]
    shifts[unidentifiable] = numpy.nan
    return tuple(
        Sensitivity(machine, part, SIZES[part], dict(zip(scales.names, column.tolist(), strict=True)))
        for (machine, part), column in zip(cases, shifts.T, strict=True)
    )


def _cases(identified: Identified) -> Iterator[tuple[str, str]]:
    """Yield machines and their error parts that are not unknowns."""
    machines = {measured.machine.name: measured.machine for measured in identified.data if _reads_indentation(measured)}
    for name, machine in machines.items():
        for part in SIZES:
            if machine.key(part) not in machine.unknowns:
                yield name, part


def _reads_indentation(measured: Measured) -> bool:
    return "indentation" in (measured.quantity, measured.load)


def _error(identified: Identified, name: str, part: str, values: Numbers, answers_at_best: Numbers) -> Numbers:
    """Compute the change of the results by an error, (data,)."""
    data = tuple(
        _with_error(measured, part) if _reads_indentation(measured) and measured.machine.name == name else measured
        for measured in identified.data
    )
    answers_with_error = replace(identified.misfit.answers, data=data).at(values)[0]
    return (answers_with_error - answers_at_best) / _STEP


def _with_error(measured: Measured, part: str) -> Measured:
    machine = measured.machine if measured.machine.name else Machine(name=_UNNAMED)
    error: dict[str, Any] = {part: getattr(machine, part) + _STEP * SIZES[part]}
    return replace(measured, machine=replace(machine, **error))
