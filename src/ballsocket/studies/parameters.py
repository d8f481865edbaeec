"""Parameters of a study, and joints and presses with varied parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from ..contact import Model
from ..core import quantities
from ..core.arrays import Array, all_true, where
from ..core.quantities import MATERIAL, PARTS, SHELL, STRENGTH, STRESS_LIMITS, Quantity
from ..problem import Joint, Material
from ..problem.dimensions import LENGTHS, STORED_LENGTHS, canonical, check_unique_lengths, derive_lengths, held_lengths
from ..problem.material import make_unchecked

AIMS: Mapping[str, Quantity] = MappingProxyType(
    {**quantities.AIM, **{name: quantities.CUP[name] for name in ("inclination", "anteversion")}}
)
"""Directions of the load and of the cup, for models with loads off the axis."""

PARAMETERS: Mapping[str, Quantity] = MappingProxyType({**LENGTHS, **SHELL, **PARTS, **quantities.LOADS, **AIMS})
"""Parameters that a study can vary, by the name of their axis."""

LOADS = tuple(quantities.LOADS)
"""Names of the loads."""

MATERIAL_PARTS = ("liner", "ball")
"""Parts of the joint whose axes have materials as values."""

_ROUNDING = 1e-12  # rounding error of a length relative to the radius of the ball


def vary_joint(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, Array]:
    """Replace dimensions and material properties of a joint, and mark possible joints.

    The joint keeps the lengths that it was made from, see `hold`. A combination without a ball, clearance or thickness
    of the liner is impossible; it gets placeholder dimensions.

    The values by names of `PARAMETERS`, without the loads, are in mm and MPa; arrays broadcast against each other.
    Returns the joint of arrays, and a bool array that is False for an impossible joint.

    Raises ValueError: a number outside its range, names that contradict each other, lengths of which several could
    stay, or a property of a rigid ball or of a missing shell.
    """
    check_contradictions(values)
    ball_names = [name for name in PARTS if name.startswith("ball_") and name in values]
    if joint.ball is None and ball_names and not all(f"ball_{number}" in values for number in MATERIAL):
        raise ValueError(f"the ball of this joint is rigid: it has no {ball_names[0]}")
    lengths, possible = _vary_lengths(joint, {name: values[name] for name in values if name in (*LENGTHS, *SHELL)})
    liner = _vary_material(joint.liner, values, "liner") or joint.liner
    parts = {**vars(joint), "liner": liner, "ball": _vary_material(joint.ball, values, "ball")}
    shell = values.get("shell_thickness", joint.shell)
    if all_true(shell == joint.shell) is not True:
        parts["backing"] = (replace(joint.backing[0], thickness=shell), *joint.backing[1:])
    if not lengths:
        return make_unchecked(Joint, **parts), possible
    return Joint(**{name: part for name, part in parts.items() if name not in STORED_LENGTHS} | lengths), possible


def hold(joint: Joint, names: Iterable[str]) -> dict[str, float]:
    """Return the lengths in mm of a joint that stay while others vary; empty if none varies.

    Three lengths determine a joint. It keeps those that it was made from, as far as the varied ones allow.

    Raises ValueError: several of them could stay.
    """
    varied = [name for name in names if name in (*LENGTHS, *SHELL)]
    if "shell_thickness" in varied and not joint.shell:
        raise ValueError("the joint has no shell, so that shell_thickness cannot vary: give it one in [shell]")
    held = held_lengths(varied, joint.given_lengths) if varied else {}
    if "interference" in held:
        held["clearance"] = -held.pop("interference")
    return {**held, **({"shell_thickness": joint.shell} if held and joint.shell and not {*SHELL} & {*varied} else {})}


def _vary_lengths(joint: Joint, varied: Mapping[str, Array]) -> tuple[dict[str, Any], Array]:
    """Return the lengths of a varied joint, and a mask of possible joints; the others have placeholders."""
    lengths = {**hold(joint, varied), **varied}
    if not varied:
        return {}, True
    stored = derive_lengths(lengths, lengths.pop("shell_thickness", joint.shell))
    radius, clearance, thickness = (stored[name] for name in STORED_LENGTHS)
    fit, gap = ("interference", -clearance) if all_true(clearance < 0) else ("clearance", clearance)
    possible = (radius > 0) & (gap > -_ROUNDING * radius) & (thickness > _ROUNDING * radius)
    usable = {
        "ball_radius": where(possible, radius, 1.0),
        fit: where(possible & (gap > 0), gap, 0.0 if fit == "clearance" else _ROUNDING),
        "liner_thickness": where(possible, thickness, 1.0),
    }
    stated = {canonical(name) for name in lengths}
    raw = {**stored, "interference": -clearance}
    made = {name: raw[name] if canonical(name) in stated else length for name, length in usable.items()}
    return {**made, "given": tuple(lengths)}, possible


def _vary_material(material: Material | None, values: Mapping[str, Array], part: str) -> Material | None:
    """Replace properties of a part's material.

    It keeps its strength, unless its yield stress is replaced together with its elastic properties: that is another
    material. A yield stress of NaN is unknown.
    """
    names = (*MATERIAL, "yield_stress")
    replaced = {number: values[f"{part}_{number}"] for number in names if f"{part}_{number}" in values}
    if not replaced:
        return material
    limits = dict.fromkeys(STRESS_LIMITS) if all(number in replaced for number in names) else {}
    stress = replaced.pop("yield_stress", None)
    varied = Material(**replaced) if material is None else replace(material, **{**limits, **replaced})
    if stress is None or all_true(stress != stress) is True:
        return varied
    STRENGTH["yield_stress"].check(where(stress == stress, stress, 1.0))
    return make_unchecked(Material, **{**vars(varied), "yield_stress": stress})


def nominal_value(joint: Joint, name: str) -> float | None:
    """Return the value of a parameter in a joint; None for a property of a rigid ball."""
    if name in LENGTHS:
        return float(getattr(joint, name))
    if name in SHELL:
        return float(joint.shell) or None
    part, _, number = name.partition("_")
    material = getattr(joint, part)
    value = None if material is None else getattr(material, number)
    return None if value is None else float(value)


def press_arguments(joint: Joint, values: Mapping[str, Array]) -> tuple[Joint, dict[str, Array], Array]:
    """Return the varied joint, the keywords of its press (load and its direction), and a mask of possible joints.

    See `vary_joint`.
    """
    load = {name: value for name, value in values.items() if name in (*LOADS, *AIMS)}
    varied_joint, possible = vary_joint(joint, {name: value for name, value in values.items() if name not in load})
    return varied_joint, load, possible


def check_aims(model: Model, names: Iterable[str]) -> None:
    """Check that a model presses off the axis if the direction of the load varies; raise ValueError otherwise."""
    for name in names:
        if name in AIMS and not model.off_axis:
            raise ValueError(f"{name} cannot vary for {model.name}, which presses along the axis: use sphere")


def check_contradictions(names: Mapping[str, object]) -> None:
    """Check that parameters can vary together; raise ValueError otherwise."""
    check_unique_lengths([name for name in names if name in LENGTHS])
    loads = [name for name in LOADS if name in names]
    if len(loads) > 1:
        raise ValueError(f"one load is needed, got {', '.join(loads)}")
    if "tilt" in names and ("inclination" in names or "anteversion" in names):
        raise ValueError("tilt and the orientation of the cup both set the direction of the load: use one of them")
    if "azimuth" in names and "tilt" not in names:
        raise ValueError("azimuth rotates a tilted load around the axis of the cup: a tilt is needed too")
