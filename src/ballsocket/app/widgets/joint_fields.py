"""Inputs of the joint and its load; each edits one entry of the tables of a joint file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from html import escape
from math import degrees, inf, isinf
from typing import Any

from ...core.checks import check_names, check_text, shown
from ...core.quantities import LOADS, STRESS_LIMITS
from ...files.joint_file import JointFile, joint_of, read_aim
from ...files.joint_toml import Tables, tables_of
from ...problem import Joint, Layer, Support
from ...problem.cup import UP, Cup
from ...problem.presets import joints, materials
from ..state.screen import Screen
from .fields import Field, choice, segments, tick, words
from .numbers import ALLOWABLE, NUMBERS, THICKNESS, TILT, Number, load_of, number_of

_CUSTOM, _RIGID, _PRESET = "own", "rigid", ""
_OWN_NUMBERS = (_CUSTOM, "– own numbers –")
_CHANGED = " (changed)"
_MAX_NAME = 80
"""Characters of a design's name."""


def fields_of(screen: Screen) -> dict[str, Field]:
    """Return every input of the joint on the screen by name, in the order of the page."""
    file, joint = screen.file, screen.file.joint
    ((kind, _),) = file.load.items()
    named = tables_of(file)
    preset = joint.name if joints.get(joint.name) == joint else _PRESET
    ball = _RIGID if joint.ball is None else _chosen(named["ball"])
    listed = [
        words("name", "Design", joint.name),
        choice("preset", "Start from", [(_PRESET, "– choose –"), *joints], preset),
        *_numbers(screen, named, ("ball_radius", "clearance", "liner_thickness", "outer_radius")),
        *([] if joint.backing else [tick("massive", "Solid socket (no backing)", isinf(float(joint.liner_thickness)))]),
        segments("kind", "Load given as", [(name, LOADS[name].title) for name in LOADS], kind),
        load_of(kind).field("load", named["load"][kind], screen.reading),
        TILT.field("tilt", degrees(tilt_of(file)), screen.reading),
        choice("liner", "Liner", [_OWN_NUMBERS, *materials], _chosen(named["liner"])),
        *_numbers(screen, named, ("liner_young", "liner_poisson")),
        {**ALLOWABLE.field("allowable", joint.liner.allowable_pressure, screen.reading), "optional": True},
        *(
            _thickness_of(layer).field(f"layer{index}", float(layer.thickness), screen.reading)
            for index, layer in enumerate(joint.backing)
            if not isinf(float(layer.thickness))
        ),
        choice("ball", "Ball", [(_RIGID, "rigid"), _OWN_NUMBERS, *materials], ball),
        *_numbers(screen, named, ("ball_young", "ball_poisson")),
    ]
    return {field["name"]: field for field in listed}


def tilt_of(file: JointFile) -> float:
    """Return the angle in rad between the load and the axis of the cup."""
    return float(file.aim["tilt"]) if "tilt" in file.aim else _tilt_to(file.cup, tuple(file.aim.get("direction", UP)))


@lru_cache(maxsize=256)
def _tilt_to(cup: Cup, direction: tuple[float, ...]) -> float:
    return float(cup.tilt(direction))


def _thickness_of(layer: Layer) -> Number:
    return replace(THICKNESS, label=f"{layer.material.name or 'Layer'} thickness")


def behind(joint: Joint) -> str:
    """List the layers behind the liner as HTML."""
    layers = "".join(f"<li>{escape(str(layer))}</li>" for layer in joint.backing)
    return f"<p>Behind the liner:</p><ul>{layers}</ul>" if layers else ""


def _numbers(screen: Screen, named: Tables, names: tuple[str, ...]) -> list[Field]:
    """Return inputs of the finite numbers that the joint has."""
    joint = screen.file.joint
    tables: Tables = {"joint": {**named["joint"], "outer_radius": float(joint.outer_radius)}}
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


def _chosen(table: Tables) -> str:
    """Return the name of a material, or "own" if a number differs from it."""
    return str(table["material"]) if set(table) - set(STRESS_LIMITS) == {"material"} else _CUSTOM


def edited(screen: Screen, name: str, value: Any, load_alike: Callable[[str], dict[str, float]]) -> JointFile:
    """Return the joint after a change of one input of `fields_of`; `load_alike` converts the kind of load."""
    file = screen.file
    if name in NUMBERS:
        return _with_number(screen, number_of(name, screen.size), value)
    if name == "load":
        ((kind, _),) = file.load.items()
        return _with_number(screen, load_of(kind), value)
    layers = [f"layer{index}" for index in range(len(file.joint.backing))]
    if name in layers:
        return _thicker(screen, layers.index(name), value)
    if name == "tilt":
        return _turned(screen, value)
    check_names([name], _EDITS, "among the inputs")
    if name == "kind":
        check_names([value], LOADS, "as load")
        return replace(file, load=load_alike(value))
    return _EDITS[name](screen, value)


def _with_number(screen: Screen, spec: Number, value: Any) -> JointFile:
    def change(tables: Tables) -> None:
        if spec.key == "outer_radius":  # in place of the thickness that it fixes
            tables["joint"].pop("liner_thickness")
        tables.setdefault(spec.table, {})[spec.key] = spec.meant(value, screen.reading)

    return _changed(screen.file, change)


def _changed(file: JointFile, change: Callable[[Tables], Any]) -> JointFile:
    """Apply a change to the tables of a joint; drop its source if a number differs."""
    tables = tables_of(file)
    change(tables)
    made = joint_of(tables)
    unchanged = made.joint == file.joint or tables == tables_of(file)
    return made if unchanged else replace(made, joint=_as_changed(made.joint))


def _as_changed(joint: Joint) -> Joint:
    """Return a joint that differs from its source, with a preset marked as changed in its name."""
    base = joint.name.removesuffix(_CHANGED)
    if base not in joints:
        return replace(joint, source="")
    preset = joints[base]
    same = replace(joint, name=preset.name, source=preset.source) == preset
    return preset if same else replace(joint, name=base + _CHANGED, source="")


def _rename(screen: Screen, value: Any) -> JointFile:
    """Change the name of the design."""
    name = " ".join(check_text("the name", value).split())
    if len(name) > _MAX_NAME:
        raise ValueError(f"the name must have at most {_MAX_NAME} characters, got {len(name)}")
    return replace(screen.file, joint=replace(screen.file.joint, name=name))


def _thicker(screen: Screen, index: int, value: Any) -> JointFile:
    meant = _thickness_of(screen.file.joint.backing[index]).meant(value, screen.reading)
    return _changed(screen.file, lambda tables: tables["backing"][index].update(thickness=meant))


def _turned(screen: Screen, value: Any) -> JointFile:
    """Replace the direction of the load by another tilt."""
    tilt, file = TILT.meant(value, screen.reading), screen.file
    along = tilt == 0 and float(file.cup.tilt(UP)) == 0
    return replace(file, aim={} if along else read_aim({"tilt": tilt}))


def _bears(screen: Screen, value: Any) -> JointFile:
    """Change the allowable pressure of the liner; an empty box removes it."""

    def change(tables: Tables) -> None:
        tables["liner"].pop("allowable_pressure", None)
        if value != "":
            tables["liner"]["allowable_pressure"] = ALLOWABLE.meant(value, screen.reading)

    return _changed(screen.file, change)


def _choose_preset(screen: Screen, name: Any) -> JointFile:
    file = screen.file
    if name == _PRESET:
        return file
    check_names([name], joints, "as preset")
    return replace(file, joint=joints[name])


def _massive(screen: Screen, value: Any) -> JointFile:
    if not isinstance(value, bool):
        raise ValueError(f"massive = {shown(value)} must be true or false")
    file = screen.file
    thickness = inf if value else round(float(file.joint.socket_radius) / 3, 1)
    return _changed(file, lambda tables: tables["joint"].update(liner_thickness=thickness))


def _made_of(part: str, screen: Screen, chosen: Any) -> JointFile:
    """Change a material; custom numbers start from those of the previous material."""
    if not isinstance(chosen, str):
        raise ValueError(f"{part} = {shown(chosen)} is not a material")
    file = screen.file
    if chosen == _RIGID and part == "ball":
        return _changed(file, lambda tables: tables.pop(part, None))
    if chosen != _CUSTOM:
        return _changed(file, lambda tables: tables.update({part: {"material": chosen}}))
    material = getattr(file.joint, part)
    numbers = {"young": 2e5, "poisson": 0.3}
    if material is not None:
        numbers = {"young": float(material.young), "poisson": float(material.poisson)}
    return _changed(file, lambda tables: tables.update({part: numbers}))


_EDITS: dict[str, Callable[[Screen, Any], JointFile]] = {
    "name": _rename,
    "preset": _choose_preset,
    "massive": _massive,
    "allowable": _bears,
    "liner": lambda screen, value: _made_of("liner", screen, value),
    "ball": lambda screen, value: _made_of("ball", screen, value),
    "kind": lambda screen, value: screen.file,
}
"""Functions that apply inputs other than numbers."""


_NO_CHOICE, _REMOVE = "", "away"
_NEW_THICKNESS, _MAX_LAYERS = 3.0, 20  # mm of a layer that is added; number of layers


def layer_fields(joint: Joint) -> dict[str, Field]:
    """Return a material list for each layer, one to add a layer, and the support of the outermost."""
    listed = []
    for index, layer in enumerate(joint.backing):
        named = next((name for name, material in materials.items() if material == layer.material), _CUSTOM)
        own = [(_CUSTOM, layer.material.name or "– own numbers –")] if named == _CUSTOM else []
        options = [*own, *materials, (_REMOVE, "– take away –")]
        listed.append(choice(f"behind.{index}", f"Layer {index + 1} behind the liner", options, named))
    listed.append(choice("behind.add", "Add a layer behind", [(_NO_CHOICE, "– choose –"), *materials], _NO_CHOICE))
    if joint.backing:
        held = [support.value for support in Support]
        listed.append(segments("behind.support", "Outermost surface", held, joint.support.value))
    return {field["name"]: field for field in listed}


def layers_edited(file: JointFile, key: str, value: Any) -> JointFile:
    """Return the joint after a change of a layer by its index, of "add" or of "support"."""
    layers = list(file.joint.backing)
    check_names([key], [*map(str, range(len(layers))), "add", "support"], "among the layers")
    if key == "support":
        check_names([value], [support.value for support in Support], "as support")
        return _with_joint(file, support=Support(value))
    if value in (_NO_CHOICE, _CUSTOM):
        return file
    if key != "add" and value == _REMOVE:
        del layers[int(key)]
    else:
        check_names([value], materials, "as material")
        if key == "add":
            if len(layers) >= _MAX_LAYERS:
                raise ValueError(f"{shown(value)} is one layer too many: at most {_MAX_LAYERS}")
            layers.append(Layer(thickness=_NEW_THICKNESS, material=materials[value]))
        else:
            layers[int(key)] = replace(layers[int(key)], material=materials[value])
    return _with_joint(file, backing=tuple(layers), **({} if layers else {"support": Support.FIXED}))


def _with_joint(file: JointFile, **changes: Any) -> JointFile:
    return replace(file, joint=_as_changed(replace(file.joint, **changes)))
