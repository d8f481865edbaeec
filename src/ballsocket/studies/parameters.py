"""What a study can vary, and how it changes a joint."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

from ..contact import Model
from ..core import quantities
from ..core.arrays import Array, where
from ..core.quantities import JOINT, MATERIAL, PARTS, STRESS_LIMITS, Quantity
from ..problem import Joint, Material
from ..problem.dimensions import DIAMETERS, STORED_LENGTHS, check_unique_lengths, derive_lengths

AIMS: Mapping[str, Quantity] = MappingProxyType(
    {**quantities.AIM, **{name: quantities.CUP[name] for name in ("inclination", "anteversion")}}
)
"""Where the load points, or the cup faces: for models that press off the axis."""

PARAMETERS: Mapping[str, Quantity] = MappingProxyType({**JOINT, **PARTS, **quantities.LOADS, **AIMS})
"""By the name under which they are axes of a study."""

LOADS = tuple(quantities.LOADS)

PARTS_OF = ("liner", "ball")
"""What is of a material: axes of a study by these names take materials."""


def varied(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, Array]:
    """The joint with other numbers, and where they make one.

    Two of `ball_radius`, `socket_radius`, `clearance` fix the third; of those that are not given, the ball stays as it
    is, and else the clearance. `outer_radius`, that of the shell where there is one, takes the place of
    `liner_thickness`, and a diameter that of its radius. A combination that leaves no liner, or no clearance, is no
    joint: there the first answer is some joint and the second false.

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
    given_of_ball = [name for name in PARTS if name.startswith("ball_") and name in values]
    if joint.ball is None and given_of_ball and not all(f"ball_{number}" in values for number in MATERIAL):
        raise ValueError(f"the ball of this joint is rigid: it has no {given_of_ball[0]}")
    given = {name: value for name, value in values.items() if name in JOINT}
    said = {DIAMETERS.get(name, name) for name in given}
    lengths = derive_lengths(given, {name: getattr(joint, name) for name in STORED_LENGTHS}, joint.shell)
    radius, clearance, thickness = (lengths[name] for name in STORED_LENGTHS)
    possible = (clearance > -_ROUNDING * radius) & (thickness > _ROUNDING * radius)
    made = replace(
        joint,
        ball_radius=radius,
        clearance=where(possible & (clearance > 0), clearance, 0.0) if "socket_radius" in said else clearance,
        liner_thickness=where(possible, thickness, 1.0) if "outer_radius" in said else thickness,
        liner=_material(joint.liner, values, "liner") or joint.liner,
        ball=_material(joint.ball, values, "ball"),
    )
    return made, possible


def nominal(joint: Joint, name: str) -> float | None:
    """Return a joint parameter by its study name; None for a parameter of a rigid ball."""
    if name in JOINT:
        return float(getattr(joint, name))
    part, _, number = name.partition("_")
    material = getattr(joint, part)
    value = None if material is None else getattr(material, number)
    return None if value is None else float(value)


def pressable(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, dict[str, Array], Array]:
    """The joint with other numbers, load and aim among them as keywords of a press, and where they make a joint."""
    load = {name: value for name, value in values.items() if name in (*LOADS, *AIMS)}
    made, possible = varied(joint, {name: value for name, value in values.items() if name not in load})
    return made, load, possible


def check_aims(model: Model, names: Iterable[str]) -> None:
    """Raise ValueError where what varies says where the load points, and the model does not know it."""
    for name in names:
        if name in AIMS and not model.off_axis:
            raise ValueError(f"{name} does not vary for {model.name}, which presses along the axis: take sphere")


_ROUNDING = 1e-12  # of a radius


def contradiction(names: Mapping[str, object]) -> None:
    """Raise ValueError for names that cannot vary together."""
    check_unique_lengths([name for name in names if name in JOINT])
    loads = [name for name in LOADS if name in names]
    if len(loads) > 1:
        raise ValueError(f"one load is needed, got {', '.join(loads)}")
    if "tilt" in names and ("inclination" in names or "anteversion" in names):
        raise ValueError("tilt and the cup's orientation are one too many: either says where the load points")
    if "azimuth" in names and "tilt" not in names:
        raise ValueError("an azimuth turns a tilted load around the cup's axis: a tilt is needed besides")


def _material(material: Material | None, values: Mapping[str, Array], part: str) -> Material | None:
    """A part's material with other numbers; another one altogether is as strong as is said of it."""
    names = (*MATERIAL, "yield_stress")
    given = {number: values[f"{part}_{number}"] for number in names if f"{part}_{number}" in values}
    if not given:
        return material
    limits = dict.fromkeys(STRESS_LIMITS) if all(number in given for number in MATERIAL) else {}
    return Material(**given) if material is None else replace(material, **{**limits, **given})
