"""A number with its derivative: formulas that carry their own slope."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .. import arrays
from ..arrays import Array, where


@dataclass(frozen=True, slots=True, eq=False)
class Dual:
    """A number and its derivative by ln ε, carried along through the formulas; arrays stand to its right."""

    value: Array
    slope: Array

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.slope)

    def __add__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.slope + other.slope)
        return Dual(self.value + other, self.slope)

    def __sub__(self, other: Dual | Array) -> Dual:
        return self + -other

    def __rsub__(self, other: Array) -> Dual:
        return -self + other

    def __mul__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)
        return Dual(self.value * other, self.slope * other)

    def __truediv__(self, other: Dual | Array) -> Dual:
        if isinstance(other, Dual):
            quotient = self.value / other.value
            return Dual(quotient, (self.slope - quotient * other.slope) / other.value)
        return Dual(self.value / other, self.slope / other)

    __radd__ = __add__
    __rmul__ = __mul__

    def __rtruediv__(self, other: Array) -> Dual:
        quotient = other / self.value
        return Dual(quotient, -quotient * self.slope / self.value)

    def sqrt(self) -> Dual:
        root = arrays.sqrt(self.value)
        return Dual(root, self.slope / (2 * root))

    def exp(self) -> Dual:
        power = arrays.exp(self.value)
        return Dual(power, power * self.slope)

    def log(self) -> Dual:
        return Dual(arrays.log(self.value), self.slope / self.value)


def either(condition: Array, this: Dual, that: Dual) -> Dual:
    return Dual(where(condition, this.value, that.value), where(condition, this.slope, that.slope))


def horner(x: Dual, falling: Sequence[Array]) -> Dual:
    """The polynomial of x with these coefficients, the highest power first."""
    total = x * falling[0] + falling[1]
    for coefficient in falling[2:]:
        total = total * x + coefficient
    return total
