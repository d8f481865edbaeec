"""A joint as the tables of a joint file, and as its text: what `files` reads, written."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, inf, isinf, nextafter, radians
from typing import Any

from ..core.arrays import is_plain_number
from ..core.checks import needs
from ..core.kinds import Kind
from ..core.quantities import CUP, QUANTITIES
from ..problem import Layer, Material, Support
from ..problem.cup import Cup, Side
from ..problem.presets import materials
from .joint_file import JointFile

Tables = dict[str, Any]


def tables_of(file: JointFile) -> Tables:
    """The tables of a joint file, with bare numbers in mm, N, MPa, degrees; `files.joint_of` takes them back.

    Raises
    ------
    ValueError
        A joint of arrays.
    """
    joint = file.joint
    if not all(map(is_plain_number, joint.numbers())):
        raise ValueError("a joint file holds one joint, and this one has arrays of numbers")
    tables: Tables = {
        "joint": {name: float(getattr(joint, name)) for name in ("ball_radius", "clearance", "liner_thickness")},
        "liner": _material(joint.liner),
    }
    tables |= {name: getattr(joint, name) for name in ("name", "source") if getattr(joint, name)}
    if joint.support is not Support.FIXED:
        tables["joint"]["support"] = joint.support.value
    if joint.ball is not None:
        tables["ball"] = _material(joint.ball)
    if joint.backing:
        tables["backing"] = [_layer(layer) for layer in joint.backing]
    if file.cup != Cup() or file.cup.oriented:
        tables["cup"] = cup_table(file.cup)
    if file.load:
        tables["load"] = {name: _bare(name, value) for name, value in file.load.items()}
    if file.aim:
        tables.setdefault("load", {}).update(_aim(file.aim))
    return tables


def cup_table(cup: Cup) -> Tables:
    """Return the table `cup` of a joint file, without default angles."""
    numbers = {name: _bare(name, getattr(cup, name)) for name in CUP if cup.oriented or name not in _ORIENTATION}
    side = {"side": cup.side.value} if cup.oriented or cup.side is not Side.RIGHT else {}
    return {**numbers, "interface": cup.interface.value, **side}


_ORIENTATION = ("inclination", "anteversion")


def _aim(aim: Mapping[str, Any]) -> Tables:
    """Where a load points, as the table `load` has it: three numbers with commas between, or an angle."""
    words = {"direction": lambda way: ", ".join(map(repr, way)), "tilt": lambda angle: _bare("tilt", angle)}
    return {name: words[name](each) for name, each in aim.items()}


def _bare(name: str, value: float) -> float:
    """A quantity as a bare number of the file."""
    return _degrees(value) if QUANTITIES[name].kind is Kind.ANGLE else value


def _degrees(value: float) -> float:
    """Degrees that are read as that angle to the last digit, where there are such; round ones before others."""
    near = degrees(value)
    above, below = nextafter(near, inf), nextafter(near, -inf)
    those = (round(near, 9), near, above, below, nextafter(above, inf), nextafter(below, -inf))
    return next((each for each in those if radians(each) == value), near)


def toml_of(file: JointFile) -> str:
    """The text of a joint file, with units.

    Raises
    ------
    ImportError
        The writer of TOML is not installed.
    ValueError
        A joint of arrays.
    """
    needs("app", "tomli_w")
    import tomli_w

    return tomli_w.dumps(_with_units(tables_of(file)))


def _with_units(part: Any) -> Any:
    if isinstance(part, list):
        return [_with_units(each) for each in part]
    return {
        name: _with_units(value) if isinstance(value, dict | list) else _text(name, value)
        for name, value in part.items()
    }


def _text(name: str, value: Any) -> Any:
    """A number with its unit, if it has any; the names of joints and materials have none."""
    unit = QUANTITIES[name].kind.typed if name in QUANTITIES else ""
    return f"{value!r} {unit}" if unit and not isinf(value) else value


def _layer(layer: Layer) -> Tables:
    return {"thickness": float(layer.thickness), **_material(layer.material)}


def _material(material: Material) -> Tables:
    """By its name where it is a preset; with the numbers that differ where it has a preset's name."""
    numbers = {"young": material.young, "poisson": material.poisson, **material.stress_limits}
    numbers = {name: float(value) for name, value in numbers.items()}
    for key, preset in materials.items():
        if preset.name == material.name and set(preset.stress_limits) <= set(numbers):
            changed = {name: value for name, value in numbers.items() if getattr(preset, name) != value}
            return {"material": key, **changed}
    return numbers
