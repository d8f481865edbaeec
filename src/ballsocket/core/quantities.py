"""Every quantity once: what it is called, how it is written and read, and what it may be.

Labels, units, tables, axes, figures, files, checks, the explorer and the glossary read this table. A quantity is added
by its entry here, and one of a contact by an attribute of `Contact` beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf, pi, radians
from types import MappingProxyType
from typing import Any

from .arrays import Array, all_true
from .checks import check_numeric, degrees_hint, first_invalid, require
from .kinds import Kind, Unit


def _anything(x: Array) -> Array:
    return x == x


_LEAST = 1e-300
"""A thickness that is smaller counts as 0: the ratio to it has no number."""


def _positive(x: Array) -> Array:
    return (x > 0) & (x < inf)


def _positive_or_infinite(x: Array) -> Array:
    return x > _LEAST


def _not_negative(x: Array) -> Array:
    return (x >= 0) & (x < inf)


def _up_to_the_equator(x: Array) -> Array:
    return (x >= 0) & (x < pi / 2)


def _half_a_turn(x: Array) -> Array:
    return abs(x) <= pi * (1 + 1e-6)  # single precision rounds pi up


def _ratio(x: Array) -> Array:
    return (x > -1) & (x <= 0.5)


def _turn(what: str, low: float, high: float) -> dict[str, Any]:
    """An angle between two ends in degrees."""
    least, most = radians(low), radians(high)
    said = f"{what} is {low:g} to {high:g} degrees, which are {least:.4g} to {most:.4g} radians"
    return {"allows": lambda x: (x >= least) & (x <= most), "allowed": said}


@dataclass(frozen=True)
class Quantity:
    """A number of a contact, a joint, a load or a cup, and all that is said of it anywhere.

    Attributes
    ----------
    name : str
        What code, files and links call it.
    symbol, title : str
        What tables and figures call it; a symbol may be empty.
    kind : Kind
        What it measures, which gives the units.
    meaning : str
        What the glossary says.
    handy : Unit or None
        What people read where numbers are for the eye alone; None is the unit that files have.
    allows : callable
        Where numbers may be those of a joint, load or cup: an array to its mask.
    allowed : str
        The same as the sentence of a refusal.

    Examples
    --------
    >>> QUANTITIES["indentation"].label()
    'indentation d [µm]'
    >>> QUANTITIES["poisson"].checked(0.6)
    Traceback (most recent call last):
    ValueError: poisson = 0.6 is not allowed: Poisson's ratio lies above -1, up to 0.5
    """

    name: str
    symbol: str
    title: str
    kind: Kind
    meaning: str
    handy: Unit | None = None
    allows: Callable[[Array], Array] = _anything
    allowed: str = ""

    @property
    def unit(self) -> str:
        """The unit inside, as the CF conventions spell it."""
        return self.kind.unit

    @property
    def key(self) -> str:
        """The name in JSON, where angles are in degrees and say so."""
        return f"{self.name}_deg" if self.kind is Kind.ANGLE else self.name

    @property
    def column(self) -> str:
        """The head of a column in CSV and data frames, which ends in the unit, "max_pressure_MPa"."""
        return f"{self.name}_{self.kind.suffix}" if self.kind.suffix else self.name

    @property
    def written(self) -> Unit:
        """The unit in JSON, in files and in tables of plain numbers."""
        return self.kind.written

    @property
    def shown(self) -> Unit:
        """The unit on axes, in the explorer and in a terminal."""
        return self.handy or self.kind.written

    def capital(self, unit: Unit | None = None) -> str:
        """The label of an input, "Radial clearance c [mm]"."""
        label = self.label(unit)
        return label[:1].upper() + label[1:]

    def head(self, unit: Unit | None = None) -> str:
        """The head of a column, "pmax [MPa]", in `shown` or another unit."""
        return f"{self.symbol}{(unit or self.shown).bracketed}".strip()

    def label(self, unit: Unit | None = None) -> str:
        """The label of an axis, "largest pressure pmax [MPa]", in `shown` or another unit."""
        return f"{self.title} {self.head(unit)}".strip()

    def checked(self, value: Any) -> Array:
        """`value`, if it is a number or an array that the quantity may have.

        Raises
        ------
        ValueError
            A number that is not allowed, named with its value.
        TypeError
            What is neither a number nor an array.
        """
        number = check_numeric(self.name, value)
        good = self.allows(number)
        if all_true(good) is False:
            require(self.name, number, good, self.allowed + self.meant(first_invalid(number, good)))
        return number

    def meant(self, value: float) -> str:
        """What a refusal adds where a number is an angle in degrees: the number in radians."""
        if self.kind is not Kind.ANGLE or not self.allows(radians(value)):
            return ""
        return f"; {degrees_hint(value)}"


def _table(*quantities: Quantity) -> Mapping[str, Quantity]:
    return MappingProxyType({each.name: each for each in quantities})


def _of(part: str, symbols: tuple[str, str, str]) -> Mapping[str, Quantity]:
    """The numbers of a part of the joint that can vary, by the names that they have beside those of another part."""
    return _table(
        *(
            replace(each, name=f"{part}_{each.name}", symbol=symbol, title=f"{each.title} of the {part}")
            for each, symbol in zip((*MATERIAL.values(), STRENGTH["yield_stress"]), symbols, strict=True)
        )
    )


# fmt: off
CONTACT = _table(
    Quantity("force", "F", "normal force", Kind.FORCE, "Along the axis of the load.", allows=_not_negative,
             allowed="a force (N) is 0 or more and finite"),
    Quantity("indentation", "d", "indentation", Kind.LENGTH,
             "Approach of the centres of ball and socket from first touch; with finite elements the path of the "
             "ball's equator, which contains the ball's own compression. The paper writes δ as well.",
             Unit("µm", 1e3), allows=_not_negative, allowed="an indentation (mm) is 0 or more and finite"),
    Quantity("half_angle", "ε", "half angle", Kind.ANGLE,
             "From the axis of the load to the edge of the contact, seen from the centre of the socket.",
             allows=_up_to_the_equator, allowed="a half angle (rad) is 0 or more and below pi/2"),
    Quantity("max_pressure", "pmax", "largest pressure", Kind.MODULUS, "Wherever it is; also peak pressure."),
    Quantity("area", "A", "contact area", Kind.AREA, "On the ball: 2π R1² (1 - cos ε), Eq. (19) of the paper."),
    Quantity("stiffness", "dF/dd", "tangent stiffness", Kind.STIFFNESS, "Slope of the force over the indentation.",
             Unit("kN/mm", 1e-3)),
    Quantity("energy", "U", "energy", Kind.ENERGY, "Work of the load from first touch, ∫ F dd."),
    Quantity("foundation_modulus", "K", "foundation modulus", Kind.FOUNDATION,
             "Pressure at the pole per indentation, p0/d, Eq. (16) of the paper."),
    Quantity("pole_pressure", "p0", "pressure at the pole", Kind.MODULUS,
             "Contact pressure where the axis of the load meets the contact; nearly always the largest."),
    Quantity("max_pressure_angle", "φmax", "angle of the largest pressure", Kind.ANGLE,
             "From the axis of the load to where the pressure is largest; 0 is the pole."),
)
"""What a contact is printed with, in this order."""

DERIVED = _table(
    Quantity("pressure_integral", "∫p dA", "pressure integral", Kind.FORCE,
             "Pressure summed over the area without its direction. Friction and wear need it."),
    Quantity("indentation_ratio", "d/L", "indentation ratio", Kind.NUMBER, "Indentation over liner thickness."),
    Quantity("depth_ratio", "d/min(L, R2)", "depth ratio", Kind.NUMBER,
             "Indentation over liner thickness or socket radius, whichever is less: how large strains are."),
    Quantity("width_ratio", "a/L", "width ratio", Kind.NUMBER, "Radius of the contact over liner thickness."),
    Quantity("conformity", "c/d", "conformity", Kind.NUMBER,
             "Clearance over indentation; 0 is a ball of the socket's own radius."),
    Quantity("thickness_ratio", "R2/L", "thickness ratio", Kind.NUMBER, "Socket radius over liner thickness."),
    Quantity("clearance_ratio", "c/R2", "clearance ratio", Kind.NUMBER, "Radial clearance over socket radius."),
    Quantity("modulus_ratio", "E/E_ball", "modulus ratio", Kind.NUMBER,
             "Young's modulus of the liner over that of the ball; 0 for a rigid ball."),
    Quantity("backing_ratio", "E/E_backing", "backing ratio", Kind.NUMBER,
             "Young's modulus of the liner over that of the softest layer behind it; 0 for a rigid backing, "
             "infinite where the outermost surface is free."),
    Quantity("effective_modulus", "E*", "effective modulus", Kind.MODULUS, "1/E* = (1 - ν²)/E + (1 - ν1²)/E1."),
    Quantity("edge_distance", "", "edge distance", Kind.LENGTH,
             "Arc along the socket's surface from the edge of the contact to the rim where that is nearest."),
)
"""What follows from the numbers of joint, cup and contact."""

JOINT = _table(
    Quantity("ball_radius", "R1", "ball radius", Kind.LENGTH, "Of the ball, the femoral head.", allows=_positive,
             allowed="a radius (mm) is above 0 and finite"),
    Quantity("head_diameter", "2 R1", "head diameter", Kind.LENGTH, "Of the ball, twice its radius.", allows=_positive,
             allowed="a diameter (mm) is above 0 and finite"),
    Quantity("socket_radius", "R2", "socket radius", Kind.LENGTH, "R1 + c, inner radius of the liner.",
             allows=_positive, allowed="a radius (mm) is above 0 and finite"),
    Quantity("clearance", "c", "radial clearance", Kind.LENGTH,
             "R2 - R1, half of the diametral clearance that implant papers usually quote. The paper writes ΔR.",
             allows=_not_negative,
             allowed="a radial clearance (mm) is 0 or more and finite; negative is a preloaded joint: an interference"),
    Quantity("diametral_clearance", "2 c", "diametral clearance", Kind.LENGTH,
             "Twice the radial clearance, the difference of the diameters.", allows=_not_negative,
             allowed="a diametral clearance (mm) is 0 or more and finite; negative is a preloaded joint"),
    Quantity("liner_thickness", "L", "liner thickness", Kind.LENGTH,
             "Of the elastic layer between the socket's surface and its backing; `inf` is a massive socket.",
             allows=_positive_or_infinite, allowed="a thickness (mm) is above 0; inf is a massive socket"),
    Quantity("outer_radius", "Ro", "outer radius", Kind.LENGTH,
             "Of the liner, R2 + L; where a layer of finite thickness is right behind it, of that shell.",
             allows=_positive, allowed="a radius (mm) is above 0 and finite"),
    Quantity("outer_diameter", "2 Ro", "outer diameter", Kind.LENGTH, "Twice the outer radius.", allows=_positive,
             allowed="a diameter (mm) is above 0 and finite"),
)
"""The dimensions of a joint."""

FIT = _table(
    Quantity("interference", "-c", "interference", Kind.LENGTH,
             "Of a preloaded joint, R1 - R2: how much larger the ball is than its socket, in place of a clearance.",
             allows=_positive, allowed="an interference (mm) is above 0 and finite"),
)
"""What takes the place of a clearance where ball and socket press on each other at rest."""

MATERIAL = _table(
    Quantity("young", "E", "Young's modulus", Kind.MODULUS, "Stress per strain of a bar that is pulled.",
             allows=_positive, allowed="Young's modulus (MPa) is above 0 and finite"),
    Quantity("poisson", "ν", "Poisson's ratio", Kind.NUMBER,
             "How much a bar that is pulled narrows for its stretch; 0.5 keeps its volume.", allows=_ratio,
             allowed="Poisson's ratio lies above -1, up to 0.5"),
)
"""The elastic numbers of a material."""

LINEARITY = _table(
    Quantity("proportional_limit", "σp", "proportional limit", Kind.MODULUS,
             "Stress up to which strain is proportional to stress. Above it the secant modulus is lower than E.",
             allows=_positive, allowed="a proportional limit (MPa) is above 0 and finite"),
)
"""Optional proportional limit of a material."""

STRENGTH = _table(
    Quantity("yield_stress", "σy", "yield stress", Kind.MODULUS,
             "Von Mises stress at which a material begins to flow. Not needed; where it is known, contacts tell how "
             "near to it they are.", allows=_positive, allowed="a yield stress (MPa) is above 0 and finite"),
    Quantity("fatigue_limit", "σf", "fatigue limit", Kind.MODULUS,
             "Von Mises stress that a material bears again and again.", allows=_positive,
             allowed="a fatigue limit (MPa) is above 0 and finite"),
    Quantity("allowable_pressure", "pa", "allowable pressure", Kind.MODULUS,
             "Contact pressure that a material may have, by its maker or a rule of design.", allows=_positive,
             allowed="an allowable pressure (MPa) is above 0 and finite"),
)
"""What a material bears; each of them may be left out."""

STRESS_LIMITS = MappingProxyType({**LINEARITY, **STRENGTH})
"""Stress limits of a material."""

BEARING = _table(
    Quantity("von_mises", "σv", "von Mises stress", Kind.MODULUS,
             "The largest in the liner: where a model knows the inside of the socket from there, else a share of the "
             "largest pressure that is fitted to the exact answer."),
    Quantity("utilisation", "σv/σy", "utilisation", Kind.NUMBER,
             "Largest von Mises stress over yield stress, of the liner or of the ball, whichever is more; unknown "
             "where neither has a yield stress."),
)
"""How a contact bears its load."""

FIELD = _table(
    Quantity("angle", "φ", "polar angle", Kind.ANGLE, "From the axis of the load, seen from the centre of the socket.",
             allows=_half_a_turn, allowed="a polar angle lies between -pi and pi, in radians"),
    Quantity("pressure", "p", "contact pressure", Kind.MODULUS, "Of the ball on the socket, at a polar angle."),
)
"""What varies along a contact."""

LAYER = _table(
    Quantity("thickness", "", "thickness", Kind.LENGTH, "Of a layer behind the liner; `inf` is a massive body.",
             allows=_positive_or_infinite, allowed="a thickness (mm) is above 0; inf is a massive body"),
)
"""What a layer behind the liner has beside its material."""

CUP = _table(
    Quantity("arc_of_cover", "", "arc of cover", Kind.ANGLE, "From rim to rim of the cup; 180° is a hemisphere.",
             **_turn("an arc of cover", 40.0, 340.0)),
    Quantity("chamfer", "", "chamfer", Kind.LENGTH,
             "Of the rim's inner edge, at 45°: so much is taken away along the bore and into the depth.",
             allows=_not_negative, allowed="a chamfer (mm) is 0 or more and finite"),
    Quantity("inclination", "", "inclination", Kind.ANGLE,
             "Of the cup on radiographs: between the body's axis and the cup's, seen from the front.",
             **_turn("an inclination", 0.0, 90.0)),
    Quantity("anteversion", "", "anteversion", Kind.ANGLE,
             "Of the cup on radiographs: between the cup's axis and the frontal plane.",
             **_turn("an anteversion", -90.0, 90.0)),
)
"""How far the socket reaches around the ball, and where it faces."""

AIM = _table(
    Quantity("tilt", "γ", "tilt", Kind.ANGLE, "Between load and cup's own axis.", **_turn("a tilt", 0.0, 180.0)),
    Quantity("azimuth", "", "azimuth", Kind.ANGLE, "Of a tilted load around the cup's axis, from where the cup leans.",
             **_turn("an azimuth", 0.0, 360.0)),
)
"""Where a load points that does not go along the cup's axis."""
# fmt: on

PARTS = MappingProxyType({**_of("liner", ("E", "ν", "σy")), **_of("ball", ("E1", "ν1", "σy1"))})
"""Moduli and yield stresses of liner and ball."""

LOADS = MappingProxyType({name: CONTACT[name] for name in ("force", "indentation", "half_angle")})
"""What presses a ball, one of them at a time."""

HEADLINE = ("force", "indentation", "half_angle", "max_pressure", "area", "stiffness")
"""What a table of a contact shows that has no room for all."""

QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        **CONTACT,
        **BEARING,
        **JOINT,
        **FIT,
        **MATERIAL,
        **STRESS_LIMITS,
        **PARTS,
        **LAYER,
        **CUP,
        **AIM,
        **FIELD,
        **DERIVED,
    }
)
"""All of them by their names."""
