"""The joint and its load as inputs: each edits one entry of the tables of a joint file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from html import escape
from math import inf, isinf, radians
from typing import Any

from ..checks import check_names, shown
from ..cup import UP
from ..io.joint_file import JointFile, joint_of, read_aim
from ..io.joint_toml import Tables, tables_of
from ..joint import Joint
from ..kinds import Kind, Unit
from ..presets import joints, materials
from ..quantities import AIM, LAYER, LOADS, STRENGTH
from .fields import Field, choice, number, segments, tick, typed, unknown
from .numbers import NUMBERS, Number, load_of, number_of
from .screen import Screen
from .words import unit_of

_OWN, _RIGID, _PRESET = "own", "rigid", ""
_OWN_NUMBERS = (_OWN, "– own numbers –")


def fields_of(screen: Screen) -> dict[str, Field]:
    """Every input of the joint on the screen, by its name and in the order of the page."""
    file, joint = screen.file, screen.file.joint
    ((kind, _),) = file.load.items()
    named = tables_of(file)
    listed = [
        choice("preset", "Start from", [(_PRESET, "– choose –"), *((name, name) for name in joints)], _preset(joint)),
        *_numbers(screen, ("ball_radius", "clearance", "liner_thickness", "outer_radius")),
        *([] if joint.backing else [tick("massive", "massive socket (L = ∞)", isinf(float(joint.liner_thickness)))]),
        segments("kind", "Load given as", [(name, LOADS[name].title) for name in LOADS], kind),
        _field("load", load_of(kind, screen.angle), named["load"][kind]),
        _tilt(screen),
        choice("liner", "Liner", [_OWN_NUMBERS, *_materials()], _chosen(named["liner"])),
        *_numbers(screen, ("liner_young", "liner_poisson")),
        _allowable(joint),
        *_layers(joint),
        choice("ball", "Ball", [(_RIGID, "rigid"), _OWN_NUMBERS, *_materials()], _ball(joint, named)),
        *_numbers(screen, ("ball_young", "ball_poisson")),
    ]
    return {field["name"]: field for field in listed}


def tilt_of(file: JointFile) -> float:
    """The angle in rad between load and cup's axis."""
    return float(file.aim["tilt"]) if "tilt" in file.aim else float(file.cup.tilt(file.aim.get("direction", UP)))


def _tilt(screen: Screen) -> Field:
    unit = unit_of(AIM["tilt"], screen.angle)
    ends = (0.0, round(radians(90.0) * unit.factor, 3))
    step = 1.0 if screen.angle == "degrees" else 0.02
    return number("tilt", "Load from the cup's axis γ", unit, ends, step, tilt_of(screen.file) * unit.factor)


def _allowable(joint: Joint) -> Field:
    """The pressure that the liner may have; without one there is only its yield stress, if that is known."""
    quantity, value = STRENGTH["allowable_pressure"], joint.liner.allowable_pressure
    label, unit = "Allowable pressure pa", quantity.shown
    if value is None:
        return unknown("allowable", label, unit.text)
    return number("allowable", label, unit, (1.0, 100.0), 0.5, float(value) * unit.factor)


def _layers(joint: Joint) -> list[Field]:
    """The thickness of each layer behind the liner."""
    unit = LAYER["thickness"].shown
    return [
        number(
            f"layer{place}",
            f"{layer.material.name or 'Layer'} behind",
            unit,
            (0.5, 10.0),
            0.1,
            float(layer.thickness) * unit.factor,
        )
        for place, layer in enumerate(joint.backing)
        if not isinf(float(layer.thickness))
    ]


def behind(joint: Joint) -> str:
    """What lies behind the liner, as HTML."""
    layers = "".join(f"<li>{escape(str(layer))}</li>" for layer in joint.backing)
    return f"<p>Behind the liner:</p><ul>{layers}</ul>" if layers else ""


def _numbers(screen: Screen, names: tuple[str, ...]) -> list[Field]:
    """Those that the joint has: an infinite thickness has no slider, nor has a rigid ball a modulus."""
    joint = screen.file.joint
    tables: Tables = {"joint": {**tables_of(screen.file)["joint"], "outer_radius": float(joint.outer_radius)}}
    for part in ("liner", "ball"):
        material = getattr(joint, part)
        if material is not None:
            tables[part] = {"young": float(material.young), "poisson": float(material.poisson)}
    specs = {name: number_of(name, screen.size) for name in names}
    values = {name: tables.get(spec.table, {}).get(spec.key) for name, spec in specs.items()}
    return [_field(name, specs[name], value) for name, value in values.items() if value is not None and value < inf]


def _field(name: str, spec: Number, value: float) -> Field:
    unit = Unit(spec.unit, spec.factor)
    return number(name, spec.label, unit, (spec.low, spec.high), spec.step, value * spec.factor)


def _materials() -> list[tuple[str, str]]:
    return [(name, name) for name in materials]


def _preset(joint: Joint) -> str:
    return joint.name if joints.get(joint.name) == joint else _PRESET


def _ball(joint: Joint, named: Tables) -> str:
    return _RIGID if joint.ball is None else _chosen(named["ball"])


def _chosen(table: Tables) -> str:
    """The material's name, unless a number differs from it."""
    return str(table["material"]) if set(table) - set(STRENGTH) == {"material"} else _OWN


def edited(screen: Screen, name: str, value: Any, load_alike: Callable[[str], dict[str, float]]) -> JointFile:
    """The joint on the screen after one input has been changed.

    Parameters
    ----------
    screen : Screen
    name : str
        Of the input, as in `fields_of`.
    value : str, float or bool
        What was typed, chosen or ticked.
    load_alike : callable
        Asked for the load of another kind that presses the joint as much as now.

    Raises
    ------
    ValueError
        There is no such joint, and why.
    """
    file = screen.file
    if name in NUMBERS:
        return _with_number(file, number_of(name, screen.size), value)
    if name == "load":
        ((kind, _),) = file.load.items()
        return _with_number(file, load_of(kind, screen.angle), value)
    if name.startswith("layer") and name[5:].isdecimal() and int(name[5:]) < len(file.joint.backing):
        return _thicker(file, int(name[5:]), value)
    if name == "tilt":
        return _turned(file, value, screen.angle)
    check_names([name], _OTHERS, "among the inputs")
    if name == "kind":
        check_names([value], LOADS, "as load")
        return replace(file, load=load_alike(value))
    return _OTHERS[name](file, value)


def _with_number(file: JointFile, spec: Number, value: Any) -> JointFile:
    def change(tables: Tables) -> None:
        if spec.key == "outer_radius":  # in place of the thickness that it fixes
            tables["joint"].pop("liner_thickness")
        meant = typed(spec.quantity.name, value, spec.unit, spec.factor, spec.quantity.kind)
        tables.setdefault(spec.table, {})[spec.key] = meant

    return _changed(file, change)


def _changed(file: JointFile, change: Callable[[Tables], Any]) -> JointFile:
    """The joint with a change to its tables; its preset's name goes with the first number that differs."""
    tables = tables_of(file)
    before = joint_of(tables).joint
    change(tables)
    made = joint_of(tables)
    if made.joint == before:
        return made
    tables.pop("name", None)
    tables.pop("source", None)
    return joint_of(tables)


def _thicker(file: JointFile, place: int, value: Any) -> JointFile:
    unit = LAYER["thickness"].shown
    meant = typed("thickness", value, unit.text, unit.factor, Kind.LENGTH)
    return _changed(file, lambda tables: tables["backing"][place].update(thickness=meant))


def _turned(file: JointFile, value: Any, angle: str) -> JointFile:
    """Another tilt of the load, in place of a direction."""
    unit = unit_of(AIM["tilt"], angle)
    turn = typed("tilt", value, unit.text, unit.factor / AIM["tilt"].written.factor, Kind.ANGLE)
    along = turn == 0 and float(file.cup.tilt(UP)) == 0
    return replace(file, aim={} if along else read_aim({"tilt": turn}))


def _bears(file: JointFile, value: Any) -> JointFile:
    """Another allowable pressure of the liner; an emptied box is one that is not known."""
    unit = STRENGTH["allowable_pressure"].shown

    def change(tables: Tables) -> None:
        tables["liner"].pop("allowable_pressure", None)
        if value != "":
            meant = typed("allowable_pressure", value, unit.text, unit.factor, Kind.MODULUS)
            tables["liner"]["allowable_pressure"] = meant

    return _changed(file, change)


def _start(file: JointFile, name: Any) -> JointFile:
    if name == _PRESET:
        return file
    check_names([name], joints, "as preset")
    return replace(file, joint=joints[name])


def _massive(file: JointFile, value: Any) -> JointFile:
    thickness = inf if value is True else round(float(file.joint.socket_radius) / 3, 1)
    return _changed(file, lambda tables: tables["joint"].update(liner_thickness=thickness))


def _made_of(part: str, file: JointFile, chosen: Any) -> JointFile:
    """Another material; numbers of its own are those of the one before."""
    if not isinstance(chosen, str):
        raise ValueError(f"{part} = {shown(chosen)} is no material")
    if chosen == _RIGID and part == "ball":
        return _changed(file, lambda tables: tables.pop(part, None))
    if chosen != _OWN:
        return _changed(file, lambda tables: tables.update({part: {"material": chosen}}))
    material = getattr(file.joint, part)
    numbers = {"young": 2e5, "poisson": 0.3}
    if material is not None:
        numbers = {"young": float(material.young), "poisson": float(material.poisson)}
    return _changed(file, lambda tables: tables.update({part: numbers}))


_OTHERS: dict[str, Callable[[JointFile, Any], JointFile]] = {
    "preset": _start,
    "massive": _massive,
    "allowable": _bears,
    "liner": lambda file, value: _made_of("liner", file, value),
    "ball": lambda file, value: _made_of("ball", file, value),
    "kind": lambda file, value: file,
}
"""Inputs that are no numbers."""
