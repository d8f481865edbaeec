"""A joint file: TOML with units in, `Joint` and load out. Strict: what is not known is named, with what is near it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from math import degrees, hypot, inf, pi
from pathlib import Path
from typing import Any

from ..contact.assembly import check_load
from ..core.checks import check_text, known_name, nearest, require, shown
from ..core.kinds import Kind
from ..core.quantities import CUP, LAYER, LOADS, MATERIAL, STRESS_LIMITS
from ..problem import Joint, Layer, Material, Support
from ..problem.cup import Cup, Interface, Side
from ..problem.dimensions import LENGTHS
from ..problem.presets import materials
from .toml import parse_toml, read_toml, table_of
from .units import as_given, parse

_CHOICES: dict[str, type[Enum]] = {"interface": Interface, "side": Side}
_AIM = ("tilt", "direction")
_TABLES = {
    "": ("name", "source", "joint", "liner", "ball", "backing", "cup", "load"),
    "joint": (*LENGTHS, "support"),
    "liner": ("material", *MATERIAL, *STRESS_LIMITS),
    "ball": ("material", *MATERIAL, *STRESS_LIMITS),
    "cup": (*CUP, *_CHOICES),
    "load": (*LOADS, *_AIM),
}
KEYS: Mapping[str, Sequence[str]] = {**_TABLES, "backing": (*LAYER, "material", *MATERIAL, *STRESS_LIMITS)}
_HEADS = {"backing": "[[backing]]"}
_MOST_LAYERS = 20


@dataclass(frozen=True)
class JointFile:
    """What a joint file holds: the joint, its load (empty, or one of force, indentation, half_angle), and its cup.

    `aim` says where the load points, as the keyword of `Sphere.press`: empty, or one of tilt and direction.
    """

    joint: Joint
    load: dict[str, float]
    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    aim: dict[str, Any] = field(default_factory=dict)


def read_joint(path: str | Path) -> JointFile:
    """Read a joint file.

    The file is TOML: a table `joint` with two of `ball_radius`, `socket_radius`, `clearance` (or `head_diameter`,
    `diametral_clearance` in their places) and `liner_thickness` (or `outer_radius`, `outer_diameter`: of the liner, or
    of the shell where one is right behind it); tables `liner` and (for a ball that is not rigid) `ball`, each with a
    `material` by name or `young` and `poisson`, or both, where the numbers win, and the limits `proportional_limit`,
    `yield_stress`, `fatigue_limit`, `allowable_pressure`, which may be left out; a table `load` with one of `force`,
    `indentation`, `half_angle`. What is behind the liner is rigid, or is an array of tables `[[backing]]` from the
    liner outwards, each with a `thickness` and a material as above; `support` in the table `joint` says whether its
    outermost surface is "fixed" (without a word) or "free". A table `cup` holds what finite elements ask for,
    `arc_of_cover`, `chamfer`, and `interface`, which is "bonded" or "sliding", and where the cup faces: `inclination`,
    `anteversion`, and `side`, which is "right" or "left". Values are text with a unit ("16 mm", "3 kN", "1 GPa", "40
    deg") or bare numbers in mm, N, MPa, degrees.

    Returns
    -------
    JointFile
        With everything in mm, N, MPa and rad.

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        The file cannot be read.
    """
    return read_toml(Path(path), "joint", joint_of)


def parse_joint(raw: bytes, title: str) -> JointFile:
    """A joint file's content; see `read_joint`."""
    return parse_toml(raw, title, "joint", joint_of)


def joint_of(table: Mapping[str, Any]) -> JointFile:
    """Joint and load from the tables of a joint file, or of the command line; see `read_joint`."""
    for name in _TABLES:
        part = table_of(table, name) if name else table
        check_keys(part, name, f"in [{name}]" if name else "at the top", KEYS)
    for name in ("name", "source"):
        check_text(name, table.get(name, ""))
    joint = _joint(
        table.get("joint", {}),
        liner=_material("liner", table.get("liner", {})),
        ball=_material("ball", table["ball"]) if "ball" in table else None,
        backing=_backing(table.get("backing", [])),
        name=table.get("name", ""),
        source=table.get("source", ""),
    )
    load = table.get("load", {})
    pressed = {name: value for name, value in load.items() if name not in _AIM}
    return JointFile(joint, read_load(pressed), read_cup(table.get("cup", {})), read_aim(load))


def varied(file: JointFile, tables: Mapping[str, Any]) -> JointFile:
    """A joint file with other lengths or materials, by tables as those of a joint file.

    Raises
    ------
    ValueError
        As of `read_joint`; numbers of a ball that is rigid, without a material.
    """
    lengths, joint = tables.get("joint", {}), file.joint
    changes: dict[str, Any] = {name: parse(name, value, LENGTHS[name].kind) for name, value in lengths.items()}
    for part in ("liner", "ball"):
        if part in tables:
            changes[part] = _material(part, tables[part], getattr(joint, part))
    with as_given(lengths):
        return replace(file, joint=joint.replace(**changes))


def read_load(table: Mapping[str, Any]) -> dict[str, float]:
    """At most one of force, indentation, half_angle, as the keyword of a press."""
    if len(table) > 1:
        raise ValueError(f"one load is needed, got {', '.join(table)}")
    load = {name: parse(name, value, LOADS[name].kind) for name, value in table.items()}
    with as_given(table):
        return dict([check_load(**load)]) if load else {}


def read_aim(table: Mapping[str, Any]) -> dict[str, Any]:
    """At most one of tilt and direction, as the keyword of `Sphere.press`; other names are passed over."""
    given = {name: table[name] for name in _AIM if name in table}
    if len(given) > 1:
        raise ValueError("either a tilt or a direction is needed, got both")
    if "tilt" in given:
        tilt = parse("tilt", given["tilt"], Kind.ANGLE)
        require("tilt", degrees(tilt), 0 <= tilt <= pi, "a tilt is 0 to 180 degrees from the cup's axis")
        return {"tilt": tilt}
    return {"direction": _direction(given["direction"])} if given else {}


def _direction(value: Any) -> tuple[float, ...]:
    """Three numbers, as a list or as text with commas between."""
    parts = value.split(",") if isinstance(value, str) else value
    if not isinstance(parts, list | tuple) or len(parts) != 3:
        raise ValueError(f"direction = {shown(value)} must be three numbers: to the right, to the front, upwards")
    found = tuple(parse("direction", part, Kind.NUMBER) for part in parts)
    length = hypot(*found)
    require("length of direction", length, 0 < length < inf, "a direction points somewhere")
    return found


def read_cup(table: Mapping[str, Any]) -> Cup:
    """A cup from the names of its parameters, none of which is needed."""
    words: dict[str, Any] = {name: parse(name, table[name], CUP[name].kind) for name in CUP if name in table}
    words |= {name: kind(_one_of(name, table[name], kind)) for name, kind in _CHOICES.items() if name in table}
    with as_given(table):
        return Cup(**words)


def check_keys(part: Mapping[str, Any], name: str, where: str, tables: Mapping[str, Sequence[str]]) -> None:
    """Raise ValueError for a key that the table of that name does not know, with the tables that do."""
    for key in part:
        if key not in tables[name]:
            raise ValueError(f"{shown(key)} {where} is not known{_place(key, name, tables)}")


def _place(key: str, name: str, tables: Mapping[str, Sequence[str]]) -> str:
    """A hint: the tables that know a key, or that it is one, or the nearest key of its own."""
    if others := [_HEADS.get(other, f"[{other}]") for other, known in tables.items() if other and key in known]:
        return f"; it belongs in {' or '.join(others)}"
    if key and key in tables:
        return f"; it is a table of its own, {_HEADS.get(key, f'[{key}]')}"
    return nearest(key, tables[name])


def _joint(table: Mapping[str, Any], **words: Any) -> Joint:
    lengths: Any = {name: parse(name, value, LENGTHS[name].kind) for name, value in table.items() if name in LENGTHS}
    support = Support(_one_of("support", table.get("support", Support.FIXED.value), Support))
    with as_given(table):
        return Joint(**lengths, support=support, **words)


def _one_of(name: str, chosen: Any, kind: type[Enum]) -> Any:
    """`chosen`, if one of the kind has that value, in any spelling of capitals."""
    known = [one.value for one in kind]
    chosen = chosen.lower() if isinstance(chosen, str) else chosen
    if chosen not in known:
        raise ValueError(f"{name} = {shown(chosen)} is not allowed: {' or '.join(map(repr, known))}")
    return chosen


def _backing(tables: Any) -> tuple[Layer, ...]:
    if not (isinstance(tables, list | tuple) and all(isinstance(table, Mapping) for table in tables)):
        raise ValueError(f"backing = {shown(tables)} must be an array of tables: [[backing]] before each layer")
    if len(tables) > _MOST_LAYERS:
        raise ValueError(f"{len(tables)} layers are behind the liner; at most {_MOST_LAYERS} are read")
    return tuple(_layer(f"backing[{number}]", table) for number, table in enumerate(tables))


def _layer(name: str, table: Mapping[str, Any]) -> Layer:
    check_keys(table, "backing", f"in {name}", KEYS)
    if "thickness" not in table:
        raise ValueError(f"{name}.thickness is missing; inf is a massive body")
    thickness = parse(f"{name}.thickness", table["thickness"], LAYER["thickness"].kind)
    material = _material(name, table)
    with as_given(table, f"{name}."):
        return Layer(thickness=thickness, material=material)


def _material(name: str, table: Mapping[str, Any], standing: Material | None = None) -> Material:
    """A material from a table with `material` (by name), numbers that win over its own, or both; else what stands."""
    known = {**MATERIAL, **STRESS_LIMITS}
    numbers: dict[str, Any] = {
        key: parse(f"{name}.{key}", table[key], quantity.kind) for key, quantity in known.items() if key in table
    }
    preset = named_material(name, table["material"]) if "material" in table else standing
    missing = [key for key in MATERIAL if key not in numbers]
    if missing and preset is None:
        raise ValueError(f"the {name} needs a material, or young and poisson; missing: {', '.join(missing)}")
    with as_given(table, f"{name}."):
        return replace(preset, **numbers) if preset else Material(**numbers)


def named_material(name: str, chosen: Any) -> Material:
    """The preset material called `chosen`, in any spelling of capitals."""
    if isinstance(chosen, str) and "," in chosen:
        raise ValueError(f"{name} material {shown(chosen)} are several, and one is needed: optimise and studies choose")
    return materials[known_name(f"{name} material", check_text(f"{name}.material", chosen), materials)]
