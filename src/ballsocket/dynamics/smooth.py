"""The positive part of a number, sharp or rounded off."""

from __future__ import annotations

from ..core.arrays import Array, clip, where


def ramp(y: Array, width: float) -> tuple[Array, Array, Array]:
    """max(y, 0), its slope and its bend; between -width and width a polynomial, three times differentiable."""
    if width == 0.0:
        none = 0.0 * y
        return where(y > 0.0, y, none), where(y >= 0.0, none + 1.0, none), none
    t = clip((y + width) / (2.0 * width), 0.0, 1.0)
    bend = 15.0 * t * t * (1.0 - t) * (1.0 - t) / width
    return where(y >= width, y, 2.0 * width * _rounded(t)), t * t * t * (10.0 - 15.0 * t + 6.0 * t * t), bend


def positive(y: Array, width: Array) -> Array:
    """The value of `ramp` for a width that may be an array, 0 included."""
    span = where(width > 0.0, width, 1.0)
    t = clip((y + width) / (2.0 * span), 0.0, 1.0)
    return where(y >= width, y, 2.0 * width * _rounded(t))


def _rounded(t: Array) -> Array:
    # ∫ (10 t³ - 15 t⁴ + 6 t⁵) dt
    return t * t * t * t * (2.5 - 3.0 * t + t * t)
