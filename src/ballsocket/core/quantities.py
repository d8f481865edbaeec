"""Table of quantities: name, symbol, unit, meaning and allowed values of each.

Labels, units, tables, axes, figures, files, checks, the explorer and the glossary read this table. A new quantity needs
one entry here; a quantity of a contact also needs an attribute of `Contact`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import inf, pi, radians
from types import MappingProxyType
from typing import Any

from .arrays import Array, all_true
from .checks import check_numeric, degrees_hint, first_invalid, require
from .kinds import MILLIONS, Kind, Unit

Limits = dict[str, Any]  # arguments `allows` and `allowed` of a `Quantity`


# named functions: other processes receive quantities
def _is_not_nan(x: Array) -> Array:
    return x == x


def _is_positive(x: Array) -> Array:
    return (x > 0) & (x < inf)


def _is_not_negative(x: Array) -> Array:
    return (x >= 0) & (x < inf)


def _is_thickness(x: Array) -> Array:
    return x > 1e-300  # ratios to a smaller one overflow


def _is_below_quarter_turn(x: Array) -> Array:
    return (x >= 0) & (x < pi / 2)


def _is_within_half_turn(x: Array) -> Array:
    return abs(x) <= pi * (1 + 1e-6)  # single precision rounds pi up


def _is_poisson_ratio(x: Array) -> Array:
    return (x > -1) & (x <= 0.5)


def _positive(subject: str, remark: str = "") -> Limits:
    """Allow positive finite numbers; `subject` has their unit, such as "a radius (mm)"."""
    return {"allows": _is_positive, "allowed": f"{subject} is above 0 and finite{remark}"}


def _not_negative(subject: str, remark: str = "") -> Limits:
    return {"allows": _is_not_negative, "allowed": f"{subject} is 0 or more and finite{remark}"}


def _angle(subject: str, low: float, high: float) -> Limits:
    """Allow angles between two limits in degrees."""
    minimum, maximum = radians(low), radians(high)
    allowed = f"{subject} is {low:g} to {high:g} degrees, which are {minimum:.4g} to {maximum:.4g} radians"
    return {"allows": lambda x: (x >= minimum) & (x <= maximum), "allowed": allowed}


@dataclass(frozen=True)
class Quantity:
    """Physical quantity of a contact, joint, load or cup, with its symbol, unit and allowed values.

    Attributes
    ----------
    name : str
        Name in code, files and links.
    symbol, title : str
        Symbol and name in tables and figures; a symbol may be empty.
    kind : Kind
        Physical kind, which determines the units.
    meaning : str
        Definition in the glossary.
    display_unit : Unit or None
        Unit on axes, in the explorer and in a terminal; None is the unit of files.
    allows : callable
        Function that returns the mask of the allowed numbers of an array.
    allowed : str
        Description of the allowed numbers in messages.

    Examples
    --------
    >>> QUANTITIES["indentation"].label()
    'indentation d [µm]'
    >>> QUANTITIES["poisson"].check(0.6)
    Traceback (most recent call last):
    ValueError: poisson = 0.6 is not allowed: Poisson's ratio lies above -1, up to 0.5
    """

    name: str
    symbol: str
    title: str
    kind: Kind
    meaning: str
    display_unit: Unit | None = None
    allows: Callable[[Array], Array] = _is_not_nan
    allowed: str = ""

    @property
    def unit(self) -> str:
        """Internal unit in the spelling of the CF conventions, such as "mm2"."""
        return self.kind.unit

    @property
    def key(self) -> str:
        """Key in JSON: the name, which ends in "_deg" for an angle."""
        return f"{self.name}_deg" if self.kind is Kind.ANGLE else self.name

    @property
    def column(self) -> str:
        """Column name in CSV and data frames, with the unit at its end, such as "max_pressure_MPa"."""
        unit = self.kind.column_suffix
        return self.name if unit in ("", self.name) else f"{self.name}_{unit}"

    @property
    def written(self) -> Unit:
        """Unit in JSON, files and plain tables."""
        return self.kind.written

    @property
    def shown(self) -> Unit:
        """Unit displayed on axes, in the explorer and in a terminal."""
        return self.display_unit or self.kind.written

    def input_label(self, unit: Unit | None = None) -> str:
        """Format the label of an input field, such as "Radial clearance c [mm]"."""
        label = self.label(unit)
        return label[:1].upper() + label[1:]

    def head(self, unit: Unit | None = None) -> str:
        """Format a column head of symbol and unit, by default `shown`, such as "pmax [MPa]"."""
        return f"{self.symbol}{(unit or self.shown).text_in_brackets}".strip()

    def label(self, unit: Unit | None = None) -> str:
        """Format an axis label of title, symbol and unit, such as "largest pressure pmax [MPa]".

        The unit is `shown` by default.
        """
        return f"{self.title} {self.head(unit)}".strip()

    def check(self, value: Any) -> Array:
        """Check that a number or array has only allowed values, and return it.

        Raises ValueError: a number that is not allowed; the message has its value.
        Raises TypeError: a value that is neither a number nor an array of numbers.
        """
        if isinstance(value, float) and self.allows(value):
            return value
        number = check_numeric(self.name, value)
        valid = self.allows(number)
        if all_true(valid) is False:
            require(self.name, number, valid, self.allowed + self.radian_hint(first_invalid(number, valid)))
        return number

    def radian_hint(self, value: float) -> str:
        """Format a hint on radians for an invalid angle that would be valid in degrees; otherwise empty."""
        if self.kind is not Kind.ANGLE or not self.allows(radians(value)):
            return ""
        return f"; {degrees_hint(value)}"


def _make_quantity_table(*quantities: Quantity) -> Mapping[str, Quantity]:
    return MappingProxyType({quantity.name: quantity for quantity in quantities})


_PRELOADED = "; a preloaded joint has an interference instead"

# fmt: off
CONTACT = _make_quantity_table(
    Quantity("force", "F", "normal force", Kind.FORCE, "Force along the axis of the load.",
             **_not_negative("a force (N)")),
    Quantity("indentation", "d", "indentation", Kind.LENGTH,
             "Approach of the centres of ball and socket from first touch; with finite elements the path of the "
             "ball's equator, which contains the ball's own compression. The paper writes δ as well.",
             Unit("µm", 1e3), **_not_negative("an indentation (mm)")),
    Quantity("half_angle", "ε", "half angle", Kind.ANGLE,
             "Polar angle from the axis of the load to the edge of the contact, at the centre of the socket.",
             allows=_is_below_quarter_turn, allowed="a half angle (rad) is 0 or more and below pi/2"),
    Quantity("max_pressure", "pmax", "largest pressure", Kind.MODULUS,
             "Largest contact pressure, at any angle; also called peak pressure."),
    Quantity("area", "A", "contact area", Kind.AREA,
             "Contact area on the ball, 2π R1² (1 - cos ε), Eq. (19) of the paper."),
    Quantity("stiffness", "dF/dd", "tangent stiffness", Kind.STIFFNESS,
             "Derivative of the force with respect to the indentation.",
             Unit("kN/mm", 1e-3)),
    Quantity("energy", "U", "energy", Kind.ENERGY, "Work of the load from first touch, ∫ F dd."),
    Quantity("foundation_modulus", "K", "foundation modulus", Kind.FOUNDATION,
             "Pressure at the pole per indentation, p0/d, Eq. (16) of the paper."),
    Quantity("pole_pressure", "p0", "pressure at the pole", Kind.MODULUS,
             "Contact pressure on the axis of the load; in most joints the largest."),
    Quantity("max_pressure_angle", "φmax", "angle of the largest pressure", Kind.ANGLE,
             "Polar angle of the largest pressure from the axis of the load; 0 is the pole."),
)
"""Printed quantities of a contact, in this order."""

DERIVED = _make_quantity_table(
    Quantity("pressure_integral", "∫p dA", "pressure integral", Kind.FORCE,
             "Integral of the pressure over the area, regardless of direction. Friction and wear need it."),
    Quantity("indentation_ratio", "d/L", "indentation ratio", Kind.NUMBER, "Indentation over liner thickness."),
    Quantity("depth_ratio", "d/min(L, R2)", "depth ratio", Kind.NUMBER,
             "Indentation over the smaller of liner thickness and socket radius, a measure of the strains."),
    Quantity("width_ratio", "a/L", "width ratio", Kind.NUMBER, "Radius of the contact over liner thickness."),
    Quantity("conformity", "c/d", "conformity", Kind.NUMBER,
             "Clearance over indentation; 0 for equal radii of ball and socket."),
    Quantity("thickness_ratio", "R2/L", "thickness ratio", Kind.NUMBER, "Socket radius over liner thickness."),
    Quantity("clearance_ratio", "c/R2", "clearance ratio", Kind.NUMBER, "Radial clearance over socket radius."),
    Quantity("modulus_ratio", "E/E_ball", "modulus ratio", Kind.NUMBER,
             "Young's modulus of the liner over that of the ball; 0 for a rigid ball."),
    Quantity("backing_ratio", "E/E_backing", "backing ratio", Kind.NUMBER,
             "Young's modulus of the liner over that of the softest layer behind it; 0 for a rigid backing, "
             "infinite where the outermost surface is free."),
    Quantity("effective_modulus", "E*", "effective modulus", Kind.MODULUS, "1/E* = (1 - ν²)/E + (1 - ν1²)/E1."),
    Quantity("edge_distance", "", "edge distance", Kind.LENGTH,
             "Shortest arc along the socket's surface from the edge of the contact to the rim."),
    Quantity("edge_slope", "G", "edge slope of the pressure", Kind.FOUNDATION,
             "Slope of the pressure at the edge of a contact on springs, p = G s with the arc s from the edge."),
    Quantity("edge_coefficient", "Ae", "edge coefficient of the pressure", Kind.EDGE_COEFFICIENT,
             "Coefficient of the pressure at the edge of an elastic contact, p = Ae sqrt(s) with the arc s."),
)
"""Quantities derived from joint, cup and contact."""

JOINT = _make_quantity_table(
    Quantity("ball_radius", "R1", "ball radius", Kind.LENGTH, "Radius of the ball, the femoral head.",
             **_positive("a radius (mm)")),
    Quantity("head_diameter", "2 R1", "head diameter", Kind.LENGTH, "Twice the radius of the ball.",
             **_positive("a diameter (mm)")),
    Quantity("socket_radius", "R2", "socket radius", Kind.LENGTH, "R1 + c, inner radius of the liner.",
             **_positive("a radius (mm)")),
    Quantity("clearance", "c", "radial clearance", Kind.LENGTH,
             "R2 - R1, half of the diametral clearance that implant papers usually quote. The paper writes ΔR.",
             **_not_negative("a radial clearance (mm)", _PRELOADED)),
    Quantity("diametral_clearance", "2 c", "diametral clearance", Kind.LENGTH,
             "Difference of the diameters, twice the radial clearance.",
             **_not_negative("a diametral clearance (mm)", _PRELOADED)),
    Quantity("liner_thickness", "L", "liner thickness", Kind.LENGTH,
             "Thickness of the elastic layer between the socket's surface and its backing; `inf` is a massive socket.",
             allows=_is_thickness, allowed="a thickness (mm) is above 0; inf is a massive socket"),
    Quantity("outer_radius", "Ro", "outer radius", Kind.LENGTH,
             "Outer radius of the liner, R2 + L, or of a shell of finite thickness right behind it.",
             **_positive("a radius (mm)")),
    Quantity("outer_diameter", "2 Ro", "outer diameter", Kind.LENGTH, "Twice the outer radius.",
             **_positive("a diameter (mm)")),
)
"""The dimensions of a joint."""

FIT = _make_quantity_table(
    Quantity("interference", "-c", "interference", Kind.LENGTH,
             "Excess R1 - R2 of the ball's radius over the socket's in a preloaded joint, in place of a clearance.",
             **_positive("an interference (mm)", "; a ball of the socket's radius has clearance 0")),
)
"""Alternative to the clearance for a joint that is preloaded without a load."""

SHELL = _make_quantity_table(
    Quantity("shell_thickness", "Ls", "shell thickness", Kind.LENGTH,
             "Thickness of the layer of finite thickness right behind the liner.",
             **_positive("the thickness of a shell (mm)")),
)
"""Dimension of a shell behind the liner."""

MATERIAL = _make_quantity_table(
    Quantity("young", "E", "Young's modulus", Kind.MODULUS, "Stress over strain of a bar in tension.",
             **_positive("Young's modulus (MPa)")),
    Quantity("poisson", "ν", "Poisson's ratio", Kind.NUMBER,
             "Lateral contraction over extension of a bar in tension; 0.5 is incompressible.",
             allows=_is_poisson_ratio, allowed="Poisson's ratio lies above -1, up to 0.5"),
)
"""Elastic constants of a material."""

LINEARITY = _make_quantity_table(
    Quantity("proportional_limit", "σp", "proportional limit", Kind.MODULUS,
             "Stress up to which strain is proportional to stress. Above it the secant modulus is lower than E.",
             **_positive("a proportional limit (MPa)")),
)
"""Optional proportional limit of a material."""

STRENGTH = _make_quantity_table(
    Quantity("yield_stress", "σy", "yield stress", Kind.MODULUS,
             "Von Mises stress at which a material begins to yield. Optional; contacts are compared with it.",
             **_positive("a yield stress (MPa)")),
    Quantity("fatigue_limit", "σf", "fatigue limit", Kind.MODULUS,
             "Von Mises stress that a material endures in cyclic loading.", **_positive("a fatigue limit (MPa)")),
    Quantity("allowable_pressure", "pa", "allowable pressure", Kind.MODULUS,
             "Contact pressure allowed by the manufacturer of a material or by a design rule.",
             **_positive("an allowable pressure (MPa)")),
)
"""Strengths of a material; each is optional."""

STRESS_LIMITS = MappingProxyType({**LINEARITY, **STRENGTH})
"""Stress limits of a material."""

BEARING = _make_quantity_table(
    Quantity("von_mises", "σv", "von Mises stress", Kind.MODULUS,
             "Largest von Mises stress in the liner: computed by models that solve for the stresses, else a "
             "fraction of the largest pressure that is fitted to the exact solution."),
    Quantity("utilisation", "σv/σy", "utilisation", Kind.NUMBER,
             "Largest von Mises stress over yield stress, the larger of liner and ball; NaN if neither has a yield "
             "stress."),
)
"""Stresses of a contact relative to the strengths."""

SHAKEDOWN_WORK = 1e-4  # relative plastic work below which a repeated load is elastic

PLASTIC = _make_quantity_table(
    Quantity("permanent_set", "us", "permanent set", Kind.LENGTH,
             "Largest outward displacement of the bore that remains after the load is removed.", Unit("µm", 1e3)),
    Quantity("plastic_strain", "εp", "plastic strain", Kind.NUMBER, "Largest equivalent plastic strain in the liner."),
    Quantity("plastic_fraction", "Vp/V", "plastic fraction", Kind.NUMBER,
             "Fraction of the liner's volume that has yielded."),
    Quantity("plastic_work", "Wp", "plastic work", Kind.ENERGY,
             "Work that yielding has dissipated since the first load."),
    Quantity("repeated_work", "ΔWp/Wp", "repeated plastic work", Kind.NUMBER,
             "Plastic work that a load adds when it is repeated up to 20 times, over the work until then; below 1e-4 "
             "the socket shakes down, above it ratchets."),
)
"""Results of a liner that yields."""

YIELD_LIMITS = _make_quantity_table(
    Quantity("yield_load", "Fy", "load of first yield", Kind.FORCE,
             "Largest force under which a liner that may yield remains elastic."),
    Quantity("shakedown_load", "Fs", "shakedown load", Kind.FORCE,
             "Largest force whose repetitions add no plastic work to a yielding liner."),
    Quantity("collapse_load", "Fc", "collapse load", Kind.FORCE, "Largest force that a yielding liner bears."),
    Quantity("minimum_thickness", "Lmin", "minimum thickness", Kind.LENGTH,
             "Smallest thickness of the liner that remains elastic under the force, in the same bore; 0 if one of "
             "R2/25 or the least that cup and elements allow does, infinite if one of 4 R2 or the most does not."),
)
"""Limits of a liner that yields, found by bisection on request."""

FIELD = _make_quantity_table(
    Quantity("angle", "φ", "polar angle", Kind.ANGLE, "Angle from the axis of the load, at the centre of the socket.",
             allows=_is_within_half_turn, allowed="a polar angle lies between -pi and pi, in radians"),
    Quantity("pressure", "p", "contact pressure", Kind.MODULUS, "Pressure of the ball on the socket at a polar angle."),
)
"""Quantities that vary along a contact."""

LAYER = _make_quantity_table(
    Quantity("thickness", "", "thickness", Kind.LENGTH,
             "Thickness of a layer behind the liner; `inf` is a massive body.",
             allows=_is_thickness, allowed="a thickness (mm) is above 0; inf is a massive body"),
)
"""Dimension of a layer behind the liner."""

CUP = _make_quantity_table(
    Quantity("arc_of_cover", "", "arc of cover", Kind.ANGLE, "Angle from rim to rim of the cup; 180° is a hemisphere.",
             **_angle("an arc of cover", 40.0, 340.0)),
    Quantity("chamfer", "", "chamfer", Kind.LENGTH,
             "Width of the 45° chamfer of the rim's inner edge, along the bore and in depth.",
             **_not_negative("a chamfer (mm)")),
    Quantity("inclination", "", "inclination", Kind.ANGLE,
             "Radiographic inclination of the cup: angle between the axes of body and cup in the frontal view.",
             **_angle("an inclination", 0.0, 90.0)),
    Quantity("anteversion", "", "anteversion", Kind.ANGLE,
             "Radiographic anteversion of the cup: angle between the cup's axis and the frontal plane.",
             **_angle("an anteversion", -90.0, 90.0)),
)
"""Rim and orientation of a cup."""

WEAR = _make_quantity_table(
    Quantity("cycles", "cycles", "number of cycles", Kind.CYCLES, "Cycles of the loading since the start.",
             MILLIONS),
    Quantity("years", "time", "time", Kind.TIME, "Time since the start at the given number of cycles a year."),
    Quantity("volume", "volume", "worn volume", Kind.VOLUME, "Volume of the liner that is worn away."),
    Quantity("depth", "depth", "worn depth", Kind.LENGTH, "Largest worn depth of the liner."),
    Quantity("penetration", "penetration", "penetration", Kind.LENGTH,
             "Distance by which the ball's centre has moved since the first cycle, by wear and creep."),
    Quantity("penetration_of_wear", "by wear", "penetration by wear", Kind.LENGTH,
             "Penetration into a bore with the wear alone."),
    Quantity("penetration_of_creep", "by creep", "penetration by creep", Kind.LENGTH,
             "Penetration into a bore with the creep alone."),
    Quantity("radiographic_penetration", "in a radiograph", "penetration in a radiograph", Kind.LENGTH,
             "Penetration in the plane of a radiograph from the front, as ASTM F2385 measures it."),
    Quantity("creep_depth", "creep", "depth of creep", Kind.LENGTH, "Largest depth of creep of the liner."),
    Quantity("ball_volume", "volume of the ball", "worn volume of the ball", Kind.VOLUME,
             "Volume of the ball that is worn away."),
    Quantity("ball_depth", "depth of the ball", "worn depth of the ball", Kind.LENGTH,
             "Largest worn depth of the ball."),
    Quantity("edge_pressure", "at the rim", "pressure at the rim", Kind.MODULUS,
             "Largest pressure in the outermost ring of the bore."),
)
"""Results of wear over many cycles."""

AIM = _make_quantity_table(
    Quantity("tilt", "γ", "tilt", Kind.ANGLE, "Angle between the load and the axis of the cup.",
             **_angle("a tilt", 0.0, 180.0)),
    Quantity("azimuth", "", "azimuth", Kind.ANGLE,
             "Direction of a tilted load around the axis of the cup, from the direction of its tilt.",
             **_angle("an azimuth", 0.0, 360.0)),
)
"""Direction of a load relative to the axis of the cup."""
# fmt: on

PARTS = _make_quantity_table(
    *(
        replace(quantity, name=f"{body}_{quantity.name}", symbol=symbol, title=f"{quantity.title} of the {body}")
        for body, symbols in (("liner", ("E", "ν", "σy")), ("ball", ("E1", "ν1", "σy1")))
        for quantity, symbol in zip((*MATERIAL.values(), STRENGTH["yield_stress"]), symbols, strict=True)
    )
)
"""Moduli and yield stresses of liner and ball."""

LOADS = MappingProxyType({name: CONTACT[name] for name in ("force", "indentation", "half_angle")})
"""Loads; a press takes one of them."""

HEADLINE = ("force", "indentation", "half_angle", "max_pressure", "area", "stiffness")
"""Quantities of a short table of contacts."""

QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        **CONTACT,
        **BEARING,
        **PLASTIC,
        **YIELD_LIMITS,
        **JOINT,
        **FIT,
        **SHELL,
        **MATERIAL,
        **STRESS_LIMITS,
        **PARTS,
        **LAYER,
        **CUP,
        **AIM,
    }
    | {**FIELD, **DERIVED, **WEAR}
)
"""All quantities by name."""
