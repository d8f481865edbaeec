"""Verdicts: a number with its error bar keeps a limit, exceeds it, or leaves it undecided.

Every comparison with a limit in this package is made here::

    bar = error_bar(contact, "max_pressure")      # value with lower and upper bound
    bar.verdict(high=25.0)                        # Verdict.KEPT, UNDECIDED or EXCEEDED
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import inf, nextafter, radians
from math import isfinite as is_finite_number

from ..core.arrays import Array, isfinite, where
from ..core.bounded import Bounded as Bounded
from ..core.bounded import Verdict as Verdict
from ..core.bounded import exact_number as exact_number
from ..core.quantities import STRENGTH
from ..problem import Joint, Material
from ..problem.cup import UP, Cup
from .closed_sphere import max_hemisphere_change
from .contact import Contact
from .model import RimLimited
from .strength import TABLE_ERROR, joint_ball_stress_ratio, rim_errors, unchecked_strength_reason, utilisation

EDGE_DISTANCE = "edge_distance"  # arc from the edge of the contact to the rim; its error is that of the `edge_margin`

_BALL_STRESS_ERROR = 0.02
"""Relative error of the largest von Mises stress in the ball, see `strength.ball_stress_ratio`."""

_PRESSURE_SHARE = 0.5  # increase of the largest pressure by a free rim over that of the stress
_HEMISPHERE_SAFETY = 1.5  # factor on the estimated change on a hemisphere
_NEARLY_HEMISPHERE = radians(80.0)  # angle between load and rim from which a cup counts as a hemisphere
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
        return bar._replace(high=bar.high * (1 + _rim_error(contact)))
    if name == EDGE_DISTANCE:
        error = errors["edge_margin"] * contact.joint.socket_radius
    elif name == "area":
        error = _AREA_ERRORS * errors.get("half_angle", 0.0) * value
    else:
        error = errors.get(name, 0.0) * abs(value)
    above = error + (_PRESSURE_SHARE * _rim_error(contact) * value if name == "max_pressure" else 0.0)
    return Bounded(value, *(where(isfinite(value), value + change, value) for change in (-error, above)))


def _rim_error(contact: Contact) -> Array:
    """Bound the relative increase of the largest von Mises stress by a free rim, for a model of a closed sphere.

    Finite elements of 120 hemispheres (ν 0.3 to 0.49, R2/L 1 to 10, ε 15° to 72°) exceed it by at most 0.1 %; it is
    0.2 % too large in the median, and 1.2 % for one of ten. Their largest pressure increases by at most half of it.
    """
    model, joint = contact.model, contact.joint
    if not model.is_closed_sphere:
        return 0.0
    cup, direction = (model.cup, model.direction) if isinstance(model, RimLimited) else (Cup(), UP)
    near_rim = rim_errors(joint, cup.edge_distance(joint.socket_radius, contact.half_angle, direction))[1] - TABLE_ERROR
    hemisphere = _HEMISPHERE_SAFETY * max_hemisphere_change(contact)
    is_wide = cup.rim - cup.tilt(direction) >= _NEARLY_HEMISPHERE
    return where((hemisphere < near_rim) & is_wide, hemisphere, near_rim)


def rim_verdict(contact: Contact) -> Verdict:
    """Decide if a single contact ends before the rim; undecided if its error bar contains the rim, or without load."""
    if not contact.half_angle > 0:
        return Verdict.UNDECIDED
    return error_bar(contact, EDGE_DISTANCE).verdict(low=nextafter(0.0, 1.0))  # at the rim it is edge loaded


@dataclass(frozen=True, kw_only=True)
class StrengthUse:
    """Comparison of a contact's stress with one strength of the liner or the ball."""

    part: str  # "liner" or "ball"
    strength: str  # name of the strength
    stress: Bounded  # stress of the contact in MPa with its error bar
    allowed: float  # strength in MPa

    @property
    def ratio(self) -> Bounded:
        """Ratio of stress to strength."""
        return self.stress.scaled(1 / self.allowed)

    @property
    def verdict(self) -> Verdict:
        """Verdict on the stress."""
        return self.ratio.verdict(high=1.0)

    def __str__(self) -> str:
        return f"{ratio_text(self.ratio)} the {self.title}"

    @property
    def title(self) -> str:
        """Strength in words, such as "yield stress of the liner"."""
        return f"{STRENGTH[self.strength].title} of the {self.part}"


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


def strength_uses(contact: Contact) -> tuple[StrengthUse, ...]:
    """Compare the stresses of a single contact with all strengths of its materials, in descending order of ratio."""
    joint, pressure = contact.joint, error_bar(contact, "max_pressure")
    von_mises = error_bar(contact, "von_mises") if joint.liner.strengths else exact_number(0.0)
    uses = list(_compare_with_material_strengths("liner", joint.liner, pressure, von_mises))
    if joint.ball is not None:
        uses += _compare_with_material_strengths("ball", joint.ball, pressure, ball_von_mises(joint, pressure))
    return tuple(sorted(uses, key=lambda use: -use.ratio.value))


def ball_von_mises(joint: Joint, pressure: Bounded) -> Bounded:
    """Estimate the largest von Mises stress in the ball in MPa from the largest pressure; 0 for a rigid ball."""
    return pressure.scaled(float(joint_ball_stress_ratio(joint)), _BALL_STRESS_ERROR)


def _compare_with_material_strengths(
    body: str, material: Material, pressure: Bounded, von_mises: Bounded
) -> Iterator[StrengthUse]:
    for name, strength in material.strengths.items():
        stress = pressure if name == "allowable_pressure" else von_mises
        yield StrengthUse(part=body, strength=name, stress=Bounded(*map(float, stress)), allowed=float(strength))


@dataclass(frozen=True, kw_only=True)
class StrengthVerdict:
    """Verdict on the strength of a contact, with its reason.

    Attributes
    ----------
    verdict : Verdict
        Kept below all strengths, exceeded above one of them. Undecided if an error bar contains a strength, without a
        valid result, or without a strength of the liner.
    words : str
        Reason in one sentence.
    use : StrengthUse or None
        Comparison that decides; None without a valid result, or without a strength of the liner.
    """

    verdict: Verdict
    words: str
    use: StrengthUse | None = None


def assess_strength(contact: Contact) -> StrengthVerdict:
    """Decide if the stresses of a single contact are below the strengths of its materials.

    Parameters
    ----------
    contact : Contact
        Contact of one joint under one load.

    Returns
    -------
    StrengthVerdict

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.contact.verdict import assess_strength
    >>> assess_strength(bs.Exact().press(bs.joints["hip-36"], force=2000.0)).verdict.word
    'kept'
    """
    if contact.status.failed:
        return _undecided(f"no answer: {contact.status.sentence}")
    uses = strength_uses(contact)
    worst = max(uses, key=lambda use: (use.verdict, use.ratio.value), default=None)
    if worst is not None and worst.verdict is Verdict.EXCEEDED:
        return StrengthVerdict(verdict=Verdict.EXCEEDED, words=f"exceeded: {worst}", use=worst)
    if not contact.valid:
        return _undecided(f"result not valid: {'; '.join(contact.notes)}")
    if worst is None or not contact.joint.liner.strengths:
        return _undecided(unchecked_strength_reason(contact.joint))
    return StrengthVerdict(verdict=worst.verdict, words=f"{worst.verdict.word}: {worst}", use=worst)


def strength_lines(contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Yield the verdicts on single contacts by name on each strength that decides, one line for each strength."""
    verdicts: dict[str, list[str]] = {}
    for name, contact in contacts.items():
        strength = assess_strength(contact)
        if strength.use is not None:
            words = f"{name} {strength.verdict.word}, {ratio_text(strength.use.ratio).removesuffix(' of')}"
            verdicts.setdefault(strength.use.title, []).append(words)
    yield from (f"{title}: {'; '.join(words)}" for title, words in verdicts.items())


def _undecided(reason: str) -> StrengthVerdict:
    return StrengthVerdict(verdict=Verdict.UNDECIDED, words=f"undecided: {reason}")
