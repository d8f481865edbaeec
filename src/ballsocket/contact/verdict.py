"""Error bars of a contact, for comparisons with limits; `design_checks` has the verdicts.

Every comparison of a contact's number with a limit takes its error bar::

    bar = error_bar(contact, "max_pressure")      # value with lower and upper bound
    bar.verdict(high=25.0)                        # Verdict.KEPT, UNDECIDED or EXCEEDED
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, nextafter
from math import isfinite as is_finite_number

from ..core.arrays import isfinite, where
from ..core.bounded import Bounded as Bounded
from ..core.bounded import Verdict as Verdict
from ..core.bounded import exact_number as exact_number
from ..problem import Joint
from .contact import Contact
from .strength import joint_ball_stress_ratio, utilisation

EDGE_DISTANCE = "edge_distance"  # arc from the edge of the contact to the rim; its error is that of the `edge_margin`

_BALL_STRESS_ERROR = 0.02
"""Relative error of the largest von Mises stress in the ball, see `strength.ball_stress_ratio`."""

_PRESSURE_SHARE = 0.5  # increase of the largest pressure by a free rim over that of the stress
_AREA_ERRORS = 2.0  # relative error of the area 2π R1² (1 - cos ε), at most twice that of the half angle ε


def error_bar(contact: Contact, name: str) -> Bounded:
    """Return a quantity of a contact with its error bar, in internal units.

    The bar of the von Mises stress and the utilisation is that of `contact.quick_von_mises`, or the error of a solved
    stress, with the error of the pressure; a model that states no error of its pressure has no bound. A utilisation of
    the ball alone has no upper end. Other quantities have the error that solver or model state; without one the bar has
    no width. For models of a closed sphere, stress and largest pressure may be higher in a cup with a free rim, a
    hemisphere by default: their bars end above it.

    Parameters
    ----------
    contact : Contact
    name : str
        Name of a quantity of the contact, such as "max_pressure", "utilisation", "edge_distance".
    """
    errors, value = contact.stated_error, getattr(contact, name)
    if name == "utilisation":
        stress = "max_pressure" if contact.joint.liner.yield_stress is None else "von_mises"
        ends = zip(error_bar(contact, stress), error_bar(contact, "max_pressure"), strict=True)
        bar = Bounded(*(utilisation(contact.joint, *stresses) for stresses in ends))
        return bar if stress == "von_mises" else bar._replace(high=inf + 0.0 * bar.high)
    if name in ("von_mises", "quick_von_mises"):
        is_solved = name == "von_mises" and contact.stress_error is not None
        bar = exact_number(value).scaled(1.0, contact.stress_error or 0.0) if is_solved else contact.quick_von_mises
        if "max_pressure" not in errors:
            return Bounded(bar.value, 0.0 * bar.value, inf + 0.0 * bar.value)
        bar = bar.scaled(1.0, errors["max_pressure"])
        return bar._replace(high=bar.high * (1 + contact._rim_error))
    if name == EDGE_DISTANCE:
        error = errors["edge_margin"] * contact.joint.socket_radius
        error = where(contact.half_angle > 0, error, nan)  # nothing is known without a contact
    elif name == "area":
        error = _AREA_ERRORS * errors.get("half_angle", 0.0) * value
    else:
        error = errors.get(name, 0.0) * abs(value)
    above = error + (_PRESSURE_SHARE * contact._rim_error * value if name == "max_pressure" else 0.0)
    return Bounded(value, *(where(isfinite(value), value + change, value) for change in (-error, above)))


def rim_verdict(contact: Contact) -> Verdict:
    """Decide if a single contact ends before the rim; undecided if its error bar contains the rim, or without load."""
    return error_bar(contact, EDGE_DISTANCE).verdict(low=nextafter(0.0, 1.0))  # at the rim it is edge loaded


def bar_text(bar: Bounded, write: Callable[[float], str]) -> str:
    """Write the bar of an estimate, such as "estimate, 13.5 MPa to 20.3 MPa"; empty for an accurate number."""
    if not bar.is_estimate:
        return ""
    if not is_finite_number(bar.high):
        return "estimate without a known bound"
    return f"estimate, {write(bar.low)} to {write(bar.high)}"


def ratio_text(ratio: Bounded) -> str:
    """Write a ratio of demand to capacity: "81 % of", "1.4 times", "an estimated 95 % (76 to 115 %) of".

    A bar is written if it makes the number an estimate, or contains 1.
    """
    words, of = (f"{percent(ratio.value)} %", " of") if ratio.value <= 1 else (f"{ratio.value:.3g} times", "")
    estimated = "an estimated " if ratio.is_estimate else ""
    if not estimated and ratio.verdict(high=1.0) is not Verdict.UNDECIDED:
        return f"{words}{of}"
    return f"{estimated}{words} ({range_text(ratio)}){of}"


def range_text(ratio: Bounded) -> str:
    """Write the bar of a ratio, such as "76 to 115 %", or "1.2 to 1.6" for a ratio above 1."""
    if not is_finite_number(ratio.high):
        return "without a known bound"
    if ratio.value > 1:
        return f"{ratio.low:.4g} to {ratio.high:.4g}"
    return f"{percent(ratio.low)} to {percent(ratio.high)} %"


def percent(ratio: float) -> str:
    """Write a ratio in percent; never 100 for another ratio."""
    text = f"{100 * ratio:.0f}"
    return text if text != "100" or ratio == 1 else f"{100 * ratio:.4g}"


def ball_von_mises(joint: Joint, pressure: Bounded) -> Bounded:
    """Estimate the largest von Mises stress in the ball in MPa from the largest pressure; 0 for a rigid ball."""
    return pressure.scaled(float(joint_ball_stress_ratio(joint)), _BALL_STRESS_ERROR)
