"""What a study can vary, and how it changes a joint."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from types import MappingProxyType

from ..arrays import Array, where
from ..joint import Joint, Material


@dataclass(frozen=True)
class Parameter:
    """A number that varies: `kind` is what units it takes, `unit` and `title` are what a reader sees."""

    title: str
    symbol: str
    unit: str
    kind: str

    def allows(self, values: Array) -> Array:
        """Where a joint or a load may have these numbers."""
        if self.symbol in ("ν", "ν1"):
            return (values > -1) & (values <= 0.5)
        if self.kind == "angle":
            return (values >= 0) & (values < pi / 2)
        return values >= 0 if self.symbol in ("ΔR", "F", "δ") else values > 0


PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {
        "ball_radius": Parameter("ball radius", "R1", "mm", "length"),
        "socket_radius": Parameter("socket radius", "R2", "mm", "length"),
        "clearance": Parameter("radial clearance", "ΔR", "mm", "length"),
        "liner_thickness": Parameter("liner thickness", "L", "mm", "length"),
        "outer_radius": Parameter("outer radius of the liner", "R2 + L", "mm", "length"),
        "liner_young": Parameter("Young's modulus of the liner", "E", "MPa", "modulus"),
        "liner_poisson": Parameter("Poisson's ratio of the liner", "ν", "1", "number"),
        "ball_young": Parameter("Young's modulus of the ball", "E1", "MPa", "modulus"),
        "ball_poisson": Parameter("Poisson's ratio of the ball", "ν1", "1", "number"),
        "force": Parameter("normal force", "F", "N", "force"),
        "indentation": Parameter("indentation", "δ", "mm", "length"),
        "half_angle": Parameter("half angle", "ε", "rad", "angle"),
    }
)
"""By the name under which they are axes of a study."""

LOADS = ("force", "indentation", "half_angle")


def varied(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, Array]:
    """The joint with other numbers, and where they make one.

    Two of `ball_radius`, `socket_radius`, `clearance` fix the third; of those that are not given, the ball stays as it
    is, and else the clearance. `outer_radius` takes the place of `liner_thickness`. A combination that leaves no
    liner, or no clearance, is no joint: there the first answer is some joint and the second false.

    Parameters
    ----------
    joint : Joint
        Numbers that do not vary.
    values : mapping of str to array
        Names of `PARAMETERS` without the loads; arrays broadcast against each other.

    Raises
    ------
    ValueError
        A number that no joint may have, named with its value; names that contradict each other.
    """
    contradiction(values)
    for name in ("ball_young", "ball_poisson"):
        if name in values and joint.ball is None:
            raise ValueError(f"the ball of this joint is rigid: it has no {name}")
    radius, clearance = _radius_and_clearance(joint, values)
    thickness = values.get("liner_thickness", joint.liner_thickness)
    if "outer_radius" in values:
        thickness = values["outer_radius"] - (radius + clearance)
    possible = (clearance > -_ROUNDING * radius) & (thickness > _ROUNDING * radius)
    made = replace(
        joint,
        ball_radius=radius,
        clearance=where(possible & (clearance > 0), clearance, 0.0) if "socket_radius" in values else clearance,
        liner_thickness=where(possible, thickness, 1.0) if "outer_radius" in values else thickness,
        liner=_material(joint.liner, values, "liner"),
        ball=None if joint.ball is None else _material(joint.ball, values, "ball"),
    )
    return made, possible


def pressable(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, dict[str, Array], Array]:
    """The joint with other numbers, the load among them as the keyword of a press, and where they make a joint."""
    load = {name: value for name, value in values.items() if name in LOADS}
    made, possible = varied(joint, {name: value for name, value in values.items() if name not in LOADS})
    return made, load, possible


_ROUNDING = 1e-12


def contradiction(names: Mapping[str, object]) -> None:
    """Raise ValueError for names that cannot vary together."""
    if all(name in names for name in ("ball_radius", "socket_radius", "clearance")):
        raise ValueError("ball_radius, socket_radius and clearance are two too many: any two of them fix the third")
    if "outer_radius" in names and "liner_thickness" in names:
        raise ValueError("outer_radius and liner_thickness are one too many: either fixes the other")
    loads = [name for name in LOADS if name in names]
    if len(loads) > 1:
        raise ValueError(f"one load is needed, got {', '.join(loads)}")


def _radius_and_clearance(joint: Joint, values: Mapping[str, Array]) -> tuple[Array, Array]:
    radius, clearance = values.get("ball_radius", joint.ball_radius), values.get("clearance", joint.clearance)
    if "socket_radius" not in values:
        return radius, clearance
    if "clearance" in values:
        return values["socket_radius"] - clearance, clearance
    return radius, values["socket_radius"] - radius


def _material(material: Material, values: Mapping[str, Array], part: str) -> Material:
    young = values.get(f"{part}_young", material.young)
    poisson = values.get(f"{part}_poisson", material.poisson)
    same = young is material.young and poisson is material.poisson
    return material if same else replace(material, young=young, poisson=poisson)
