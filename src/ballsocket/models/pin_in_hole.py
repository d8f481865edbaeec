"""Contact of a pin in a hole, the plane counterpart of a ball in a socket, per unit of length."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf, pi
from typing import Any, ClassVar

import numpy

from ..contact.assembly import as_arrays, check_joint
from ..contact.outcome import ModelInfo, Outcome
from ..contact.roots import increasing_root
from ..core import arrays
from ..core.arrays import Array, asinh, atan, broadcast, clip, log, safe_divisor, sqrt, tan, where
from ..core.checks import check_numeric, require, select_load
from ..core.lazy import cached_property
from ..core.sources import Source
from ..core.validity import Range, Status
from ..problem import Joint


@dataclass(frozen=True, kw_only=True)
class PinInHole(ModelInfo):
    """Persson's (1964) pin in a hole of nearly its radius: infinite plate, same material, plane strain.

    With β = tan(ε/2) and E1 = E/(1 - ν²), the line load Q obeys E1 c/Q = [2 - ln(1 + β²) - 2β⁴]/[π (1 + β²) β²]; the
    perfect fit (c = 0) has ε = 84.83° at any load. A `Joint` describes the pin: `ball_radius` is its radius,
    `clearance` is radial, `liner` is the material of both. The liner thickness has no effect. There is no indentation,
    because a line load has no finite approach in an infinite plate. The class is therefore not a `Model`, but it is
    listed and cited with the models.

    References
    ----------
    Persson 1964; Ciavarella & Decuzzi 2001, doi 10.1016/S0020-7683(00)00289-4.
    """

    name: ClassVar[str] = "pin-in-hole"
    title: ClassVar[str] = "pin in a hole in an infinite plate, per length (2-D)"
    sources: ClassVar[tuple[Source, ...]] = (Source("persson1964"), Source("ciavarella2001"))

    @property
    def validity(self) -> tuple[Range, ...]:
        """Validity ranges: pin and plate of one material, and an infinite plate."""
        same = "pin and plate of one material (a rigid pin is none)"
        massive = "an infinite plate"
        return (
            Range(quantity="joint.modulus_ratio", symbol="E/E_pin", low=0.99, high=1.01, why=same),
            Range(quantity="joint.thickness_ratio", high=0.1, why=massive),
        )

    def press(
        self, joint: Joint, *unnamed: Any, line_load: Array | None = None, half_angle: Array | None = None
    ) -> LineContact:
        """Solve the contact of the pin for exactly one given quantity: a line load or a half angle.

        Parameters
        ----------
        joint : Joint
        line_load : float or array, optional
            Line load Q in N/mm, zero or more, finite.
        half_angle : float or array, optional
            Half angle in rad, from 0 to below 84.83 degrees, the perfect fit.

        Returns
        -------
        LineContact
            Contact in the common shape of joint and load.

        Raises
        ------
        ValueError
            Not exactly one load; a line load that is negative or infinite; a half angle outside 0 to 84.83 degrees.
        """
        if unnamed:
            raise TypeError("a load needs its name: line_load in N/mm or half_angle in rad")
        check_joint(joint)
        kind, value = select_load(line_load=line_load, half_angle=half_angle)
        load = check_numeric(kind, value)
        if kind == "line_load":
            require(kind, load, (load >= 0) & (load < numpy.inf), "a line load (N/mm) must be 0 or more and finite")
        else:
            limit = f"a half angle (rad) must be 0 or more and below {PERFECT_FIT:.6f} (perfect fit)"
            require(kind, load, (load >= 0) & (load < PERFECT_FIT), limit)
        plain, joint, load = as_arrays(joint, load)
        with numpy.errstate(all="ignore"):
            stiffness = joint.liner.young / (1 - joint.liner.poisson**2) * joint.clearance
            if kind == "line_load":
                line_load, angle = load, 2 * atan(sqrt(_solve_squared_tangent(stiffness, load)))
            else:
                s = tan(load / 2) ** 2
                reached = stiffness / ((2 - log(1 + s) - 2 * s * s) / (pi * (1 + s) * safe_divisor(s)))
                line_load, angle = where((stiffness > 0) | (load == 0), reached, numpy.nan), load
        line_load, angle = broadcast(line_load, angle), broadcast(angle, line_load)
        is_finite = arrays.isfinite(line_load) & arrays.isfinite(angle)
        status = where(is_finite, int(Status.OK), int(Status.NOT_REACHED))
        if plain:
            line_load, angle, status = float(line_load), float(angle), Status(int(status))
        return LineContact(model=self, joint=joint, line_load=line_load, half_angle=angle, status=status)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LineContact(Outcome):
    """Contact of a pin in its hole per unit of length, with its line load, half angle and pressure.

    `line_load` is in N/mm, `half_angle` in rad and `max_pressure` in MPa.

    As for a `Contact`, `status`, `valid` and `notes` describe its validity.
    """

    line_load: Array
    half_angle: Array

    @property
    def _load(self) -> Array:
        return self.line_load

    @cached_property
    def max_pressure(self) -> Array:
        """Largest pressure p(0) in MPa."""
        return self.pressure(0.0)

    def pressure(self, angle: Array) -> Array:
        """Compute the contact pressure p(φ) in MPa at a polar angle; 0 outside the contact.

        `angle` in rad broadcasts against the contact's shape.
        """
        return self._mask_failed(lambda: self.line_load / self.joint.socket_radius * self._scaled_pressure(angle))

    def _scaled_pressure(self, angle: Array) -> Array:
        """Compute the scaled pressure p R2/Q at a polar angle, with the line load Q."""
        square = tan(self.half_angle / 2) ** 2
        y = tan(angle / 2) ** 2
        remainder = clip(square - y, 0.0, inf)
        ends = 1 + square
        smooth = 2 / pi * sqrt(remainder / ends) / (1 + y)
        peak = asinh(sqrt(remainder / (1 + y))) / (pi * safe_divisor(square) * ends)
        return where((y < square) & (abs(angle) < pi), smooth + peak, 0.0)

    def __repr__(self) -> str:
        angle, peak = arrays.to_numpy(self.half_angle), arrays.to_numpy(self.max_pressure)
        lines = [f"{self.model.name} on {self.joint}", f"  line_load     {arrays.to_numpy(self.line_load)} N/mm"]
        lines += [f"  half_angle    {angle * degrees(1.0)} deg", f"  max_pressure  {peak} MPa"]
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])


def _solve_squared_tangent(stiffness: Array, load: Array) -> Array:
    """Solve for the squared half-angle tangent β² = tan²(ε/2) of a line load; `stiffness` is E1 c."""
    ratio = stiffness / safe_divisor(load)

    def load_residual(s: Array) -> tuple[Array, Array]:
        """Compute the residual of the line load and its slope at s = tan²(ε/2)."""
        value = log(1 + s) + 2 * s * s - 2 + pi * (s + s * s) * ratio
        return value, 1 / (1 + s) + 4 * s + pi * (1 + 2 * s) * ratio

    ratio = broadcast(ratio, load)
    start = 2 / (pi * ratio + 2.4)  # right for light loads, at most 4 % off
    root = increasing_root(load_residual, 0.0 * ratio, 0.0 * ratio, 0.0 * ratio + 1.0, start)
    return where(load > 0, root, 0.0 * root)


PERFECT_FIT = float(2 * atan(sqrt(_solve_squared_tangent(numpy.float64(0.0), numpy.float64(1.0)))))
"""Half angle in rad without clearance: 84.83 degrees."""
