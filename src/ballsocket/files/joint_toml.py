"""Joints as the tables of a joint file, and as its text."""

from __future__ import annotations

from typing import Any

from ..core.arrays import is_plain_number
from ..problem import Joint, Material
from ..problem.cup import Cup, Side
from ..problem.presets import materials
from .joint_file import (
    NO_DETAILS,
    CupTable,
    Direction,
    HardeningCurve,
    JointFile,
    JointFileTable,
    LayerTable,
    LengthsTable,
    LinerTable,
    LoadTable,
    MaterialName,
    MaterialTable,
)
from .schema import Angle, Force, Length, PlainNumber, Pressure, Text
from .tables import write_table
from .toml import toml_text

Tables = dict[str, Any]


def tables_of(file: JointFile) -> Tables:
    """Return the tables of a joint file, with bare numbers in mm, N, MPa, degrees; `joint_of` reads them.

    Raises ValueError: a joint of arrays.
    """
    return write_table(_file_table(file))


def written_tables(file: JointFile) -> Tables:
    """Return the tables of a joint file, with units; ValueError for a joint of arrays."""
    return write_table(_file_table(file), with_units=True)


def toml_of(file: JointFile) -> str:
    """Return the text of a joint file, with units.

    Raises ValueError: a joint of arrays.
    """
    return toml_text(written_tables(file))


def _file_table(file: JointFile) -> JointFileTable:
    joint, liner = file.joint, file.joint.liner
    if not all(map(is_plain_number, joint.numbers())):
        raise ValueError("a joint file holds one joint, and this one has arrays of numbers")
    preset = _preset_name(liner)
    has_own_curve = liner.hardening is not None and (preset is None or materials[preset].hardening != liner.hardening)
    hardening: dict[str, Any] = {"hardening": HardeningCurve(liner.hardening)} if has_own_curve else {}
    return JointFileTable(
        name=Text(joint.name) if joint.name else None,
        report=file.report if file.report != NO_DETAILS else None,
        source=Text(joint.source) if joint.source else None,
        joint=LengthsTable(**{name: Length(value) for name, value in _lengths(joint).items()}, support=joint.support),
        liner=LinerTable(**_material(liner), **hardening),
        ball=None if joint.ball is None else MaterialTable(**_material(joint.ball)),
        backing=[LayerTable(thickness=Length(layer.thickness), **_material(layer.material)) for layer in joint.backing]
        or None,
        cup=_cup(file.cup) if file.cup != Cup() or file.cup.oriented or file.cup.has_stated_arc else None,
        load=_load(file) if file.load or file.aim else None,
    )


def _lengths(joint: Joint) -> dict[str, float]:
    """Return the lengths in mm that a joint gives, without the thickness of the liner if all walls are given."""
    lengths = dict(joint.given_lengths)
    if joint.clearance < 0 and "clearance" in lengths:
        lengths["interference"] = -lengths.pop("clearance")
    if "liner_thickness" in lengths and ("outer_radius" in lengths or "outer_diameter" in lengths) and len(lengths) > 3:
        del lengths["liner_thickness"]  # the layers of the file have their thickness
    return lengths


def _cup(cup: Cup) -> CupTable:
    """Return the table of a cup, without the default orientation."""
    return CupTable(
        arc_of_cover=Angle(cup.arc_of_cover) if cup.has_stated_arc else None,
        chamfer=Length(cup.chamfer),
        inclination=Angle(cup.inclination) if cup.oriented else None,
        anteversion=Angle(cup.anteversion) if cup.oriented else None,
        interface=cup.interface,
        side=cup.side if cup.oriented or cup.side is not Side.RIGHT else None,
    )


def _load(file: JointFile) -> LoadTable:
    kinds: Any = {"force": Force, "indentation": Length, "direction": Direction}
    return LoadTable(**{key: kinds.get(key, Angle)(value) for key, value in (file.load | file.aim).items()})


def _material(material: Material) -> dict[str, Any]:
    """Return the keys of a material: the name of its preset with the numbers that differ, or all numbers."""
    numbers = {"young": material.young, "poisson": material.poisson, **material.stress_limits}
    values = {name: (PlainNumber if name == "poisson" else Pressure)(value) for name, value in numbers.items()}
    key = _preset_name(material)
    if key is None:
        return values
    return {
        "material": MaterialName(key),
        **{name: value for name, value in values.items() if getattr(materials[key], name) != value},
    }


def _preset_name(material: Material) -> str | None:
    """Return the preset that a file can change into the material; it cannot take a strength or the hardening away."""
    for key, preset in materials.items():
        has_all = set(preset.stress_limits) <= set(material.stress_limits) and (
            material.hardening or not preset.hardening
        )
        if preset.name == material.name and has_all:
            return key
    return None
