"""The joint and its load as inputs: each edits one entry of the tables of a joint file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from html import escape
from math import degrees, inf, isinf
from typing import Any

from ..core.checks import check_names, shown
from ..core.quantities import LOADS, STRESS_LIMITS
from ..files.joint_file import JointFile, joint_of, read_aim
from ..files.joint_toml import Tables, tables_of
from ..problem import Joint
from ..problem.cup import UP
from ..problem.presets import joints, materials
from .fields import Field, choice, segments, tick, unknown
from .numbers import ALLOWABLE, NUMBERS, THICKNESS, TILT, Number, load_of, number_of
from .reading import Reading
from .screen import Screen

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
        load_of(kind).field("load", named["load"][kind], screen.reading),
        {**TILT.field("tilt", degrees(tilt_of(file)), screen.reading), "label": "Load from the cup's axis γ"},
        choice("liner", "Liner", [_OWN_NUMBERS, *_materials()], _chosen(named["liner"])),
        *_numbers(screen, ("liner_young", "liner_poisson")),
        _allowable(joint, screen.reading),
        *_layers(joint, screen.reading),
        choice("ball", "Ball", [(_RIGID, "rigid"), _OWN_NUMBERS, *_materials()], _ball(joint, named)),
        *_numbers(screen, ("ball_young", "ball_poisson")),
    ]
    return {field["name"]: field for field in listed}


def tilt_of(file: JointFile) -> float:
    """The angle in rad between load and cup's axis."""
    return float(file.aim["tilt"]) if "tilt" in file.aim else float(file.cup.tilt(file.aim.get("direction", UP)))


def _allowable(joint: Joint, reading: Reading) -> Field:
    """The pressure that the liner may have; without one there is only its yield stress, if that is known."""
    value = joint.liner.allowable_pressure
    if value is None:
        return unknown("allowable", ALLOWABLE.label, ALLOWABLE.unit(reading).text)
    return ALLOWABLE.field("allowable", float(value), reading)


def _layers(joint: Joint, reading: Reading) -> list[Field]:
    """The thickness of each layer behind the liner."""
    return [
        {
            **THICKNESS.field(f"layer{place}", float(layer.thickness), reading),
            "label": f"{layer.material.name or 'Layer'} behind",
        }
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
    return [
        specs[name].field(name, value, screen.reading)
        for name, value in values.items()
        if value is not None and value < inf
    ]


def _materials() -> list[tuple[str, str]]:
    return [(name, name) for name in materials]


def _preset(joint: Joint) -> str:
    return joint.name if joints.get(joint.name) == joint else _PRESET


def _ball(joint: Joint, named: Tables) -> str:
    return _RIGID if joint.ball is None else _chosen(named["ball"])


def _chosen(table: Tables) -> str:
    """The material's name, unless a number differs from it."""
    return str(table["material"]) if set(table) - set(STRESS_LIMITS) == {"material"} else _OWN


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
        return _with_number(screen, number_of(name, screen.size), value)
    if name == "load":
        ((kind, _),) = file.load.items()
        return _with_number(screen, load_of(kind), value)
    if name.startswith("layer") and name[5:].isdecimal() and int(name[5:]) < len(file.joint.backing):
        return _thicker(screen, int(name[5:]), value)
    if name == "tilt":
        return _turned(screen, value)
    check_names([name], _OTHERS, "among the inputs")
    if name == "kind":
        check_names([value], LOADS, "as load")
        return replace(file, load=load_alike(value))
    return _OTHERS[name](screen, value)


def _with_number(screen: Screen, spec: Number, value: Any) -> JointFile:
    def change(tables: Tables) -> None:
        if spec.key == "outer_radius":  # in place of the thickness that it fixes
            tables["joint"].pop("liner_thickness")
        tables.setdefault(spec.table, {})[spec.key] = spec.meant(value, screen.reading)

    return _changed(screen.file, change)


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


def _thicker(screen: Screen, place: int, value: Any) -> JointFile:
    meant = THICKNESS.meant(value, screen.reading)
    return _changed(screen.file, lambda tables: tables["backing"][place].update(thickness=meant))


def _turned(screen: Screen, value: Any) -> JointFile:
    """Another tilt of the load, in place of a direction."""
    turn, file = TILT.meant(value, screen.reading), screen.file
    along = turn == 0 and float(file.cup.tilt(UP)) == 0
    return replace(file, aim={} if along else read_aim({"tilt": turn}))


def _bears(screen: Screen, value: Any) -> JointFile:
    """Another allowable pressure of the liner; an emptied box is one that is not known."""

    def change(tables: Tables) -> None:
        tables["liner"].pop("allowable_pressure", None)
        if value != "":
            tables["liner"]["allowable_pressure"] = ALLOWABLE.meant(value, screen.reading)

    return _changed(screen.file, change)


def _start(screen: Screen, name: Any) -> JointFile:
    file = screen.file
    if name == _PRESET:
        return file
    check_names([name], joints, "as preset")
    return replace(file, joint=joints[name])


def _massive(screen: Screen, value: Any) -> JointFile:
    file = screen.file
    thickness = inf if value is True else round(float(file.joint.socket_radius) / 3, 1)
    return _changed(file, lambda tables: tables["joint"].update(liner_thickness=thickness))


def _made_of(part: str, screen: Screen, chosen: Any) -> JointFile:
    """Another material; numbers of its own are those of the one before."""
    if not isinstance(chosen, str):
        raise ValueError(f"{part} = {shown(chosen)} is no material")
    file = screen.file
    if chosen == _RIGID and part == "ball":
        return _changed(file, lambda tables: tables.pop(part, None))
    if chosen != _OWN:
        return _changed(file, lambda tables: tables.update({part: {"material": chosen}}))
    material = getattr(file.joint, part)
    numbers = {"young": 2e5, "poisson": 0.3}
    if material is not None:
        numbers = {"young": float(material.young), "poisson": float(material.poisson)}
    return _changed(file, lambda tables: tables.update({part: numbers}))


_OTHERS: dict[str, Callable[[Screen, Any], JointFile]] = {
    "preset": _start,
    "massive": _massive,
    "allowable": _bears,
    "liner": lambda screen, value: _made_of("liner", screen, value),
    "ball": lambda screen, value: _made_of("ball", screen, value),
    "kind": lambda screen, value: screen.file,
}
"""Inputs that are no numbers."""
