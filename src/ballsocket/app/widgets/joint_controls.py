"""Inputs of joint, load, layers and cup."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from html import escape
from math import atan2, degrees, inf, isinf, pi, radians, tan
from typing import Any

from ...core.checks import check_text, shown
from ...core.quantities import LOADS, STRESS_LIMITS
from ...files.joint_file import JointFile, varied
from ...files.joint_toml import Tables, tables_of
from ...problem import Joint, Layer, Material, Support
from ...problem.cup import UP, Side
from ...problem.dimensions import DIAMETERS, LENGTHS, give
from ...problem.presets import joints, material_label, materials
from ...question import complete
from ..pressing import same_load
from ..state.screen import Screen
from .controls import Control, Number, choice, file_choice, number_of, segments, tick, words

_CUSTOM, _RIGID, _PRESET = "own", "rigid", ""
_CUSTOM_NUMBERS = "– custom numbers –"
_NAMED = [(name, material_label(material, name)) for name, material in materials.items()]
_MATERIALS = ((_CUSTOM, _CUSTOM_NUMBERS), *_NAMED)
_CHANGED = " (changed)"
_DIAMETERS = {single: double for double, single in DIAMETERS.items()}
_MAX_NAME = 80  # characters of a design's name
_NO_CHOICE, _REMOVE = "", "away"
_NEW_THICKNESS, _MAX_LAYERS = 3.0, 20  # mm of a layer that is added; number of layers
_BODY, _AXIS = "body", "axis"
_AIMS = {_BODY: "in the body", _AXIS: "from the cup's axis"}
_HARDENING = "Hardening, MPa:plastic strain"
_ALLOWABLE = number_of("liner.allowable_pressure")
_TILT = number_of("load.tilt", label="Tilt of the load")
_MEDIAL = {Side.RIGHT: -1.0, Side.LEFT: 1.0}  # sign of the body's x axis that points medially
_LEANS = {
    name: number_of("load.direction", quantity=_TILT.quantity, label=f"Load direction, {side}")
    for name, side in (("inwards", "medial"), ("forwards", "anterior"))
}


def joint_controls(screen: Screen) -> list[Control]:
    """List the inputs of the joint on the screen and of its load, in the order of the page."""
    file, tables, joint = screen.file, tables_of(screen.file), screen.file.joint
    ((kind_of_load, _),) = file.load.items()
    presets = [(_PRESET, "– choose –"), *joints]
    preset = joint.name if joints.get(joint.name) == joint else _PRESET
    kinds = segments("kind", "Load given as", [(name, LOADS[name].title) for name in LOADS], kind_of_load)
    solid = tick("massive", "Solid socket (no backing)", isinf(float(joint.liner_thickness)))
    liner, ball = _chosen(tables["liner"]), _chosen(tables["ball"]) if joint.ball else _RIGID
    limited, load = partial(_with_number, file, "liner", "allowable_pressure"), number_of(f"load.{kind_of_load}")
    if kind_of_load == "force":
        stiffest = float(joint.liner.young) * pi * float(joint.socket_radius) ** 2
        load = replace(load, largest=stiffest, reason="a mean pressure of Young's modulus of the liner")
    allowable = _number(screen, "allowable", _ALLOWABLE, joint.liner.allowable_pressure, limited).but(optional=True)
    unlimited = partial(_with_joint, file, liner=replace(joint.liner, allowable_pressure=None))

    def with_load(value: float) -> JointFile:
        return varied(file, {"load": {kind_of_load: value}})

    return [
        _control(words("name", "Design", joint.name), partial(_with_name, file)),
        _control(
            choice("preset", "Start from", presets, preset), lambda name: replace(file, joint=joints.get(name, joint))
        ),
        *_lengths(screen),
        *([] if joint.backing else [_control(solid, partial(_with_solid_socket, file))]),
        _control(kinds, lambda kind: replace(file, load=same_load(file, screen.answered_by, kind))),
        _number(screen, "load", load, tables["load"][kind_of_load], with_load),
        _number(screen, "tilt", _TILT, degrees(file.tilt), partial(_with_tilt, file)),
        _control(choice("liner", "Liner", _MATERIALS, liner), partial(_with_material, file, "liner")),
        *_moduli(screen, "liner"),
        Control(allowable.field, lambda value: {"file": unlimited()} if value == "" else allowable.read(value)),
        _control(words("hardening", _HARDENING, str(joint.liner.hardening or "")), partial(_with_hardening, file)),
        *_thicknesses(screen),
        _control(choice("ball", "Ball", ((_RIGID, "rigid"), *_MATERIALS), ball), partial(_with_material, file, "ball")),
        *_moduli(screen, "ball"),
    ]


def _control(field: dict[str, Any], edit: Callable[[Any], JointFile]) -> Control:
    """Return an input whose edit to a value makes another joint file."""
    return Control(field, lambda value: {"file": edit(value)})


def _number(screen: Screen, name: str, spec: Number, value: Any, edit: Callable[[float], JointFile]) -> Control:
    """Return the input of a number, of which an edit makes another joint file."""
    return spec.control(name, value, screen.reading, lambda number: {"file": edit(number)})


def _lengths(screen: Screen) -> Iterator[Control]:
    """Yield the lengths of the joint: an interference is no clearance, and a solid socket has no thickness."""
    joint, as_diameters = screen.file.joint, screen.size == "diameter"
    for name in ("ball_radius", "clearance", "liner_thickness", "outer_radius"):
        key = _DIAMETERS.get(name, name) if as_diameters else name
        value = float(getattr(joint, key))
        if 0 <= value < inf:
            yield _number(screen, name, number_of(f"joint.{key}"), value, partial(_with_length, screen.file, key))


def _moduli(screen: Screen, part: str) -> Iterator[Control]:
    material = getattr(screen.file.joint, part)
    for key in ("young", "poisson") if material else ():
        edit = partial(_with_number, screen.file, part, key)
        yield _number(screen, f"{part}_{key}", number_of(f"{part}.{key}"), float(getattr(material, key)), edit)


def _thicknesses(screen: Screen) -> Iterator[Control]:
    for index, layer in enumerate(screen.file.joint.backing):
        if not isinf(float(layer.thickness)):
            spec = number_of("backing.thickness", label=f"{material_label(layer.material, 'Layer')} thickness")
            edit = partial(_with_thickness, screen.file, index)
            yield _number(screen, f"layer{index}", spec, float(layer.thickness), edit)


def _chosen(table: Tables) -> str:
    """Return the name of a material, or "own" if a number differs from it."""
    return str(table["material"]) if set(table) - {*STRESS_LIMITS, "hardening"} == {"material"} else _CUSTOM


def joint_words(joint: Joint) -> str:
    """List the lengths that stay while others change, and the layers behind the liner, as HTML."""
    given = ", ".join(LENGTHS[name].title for name in joint.given_lengths)
    layers = "".join(f"<li>{escape(str(layer))}</li>" for layer in joint.backing)
    behind = f"<p>Behind the liner:</p><ul>{layers}</ul>" if layers else ""
    return f"<p>Held while other lengths change: {given}.</p>{behind}"


def _with_number(file: JointFile, part: str, key: str, value: float) -> JointFile:
    """Set a number of the material of liner or ball."""
    return _with_joint(file, **{part: getattr(varied(file, {part: {key: value}}).joint, part)})


def _with_hardening(file: JointFile, text: Any) -> JointFile:
    """Change the hardening of the liner; empty is a liner without one."""
    if text == "":
        return _with_joint(file, liner=replace(file.joint.liner, hardening=None))
    return _with_joint(file, liner=varied(file, {"liner": {"hardening": text}}).joint.liner)


def _with_thickness(file: JointFile, index: int, value: float) -> JointFile:
    layers = list(file.joint.backing)
    layers[index] = replace(layers[index], thickness=value)
    return _with_joint(file, backing=tuple(layers))


def _with_length(file: JointFile, key: str, value: float) -> JointFile:
    """Set a length, which takes the place of the one that would follow from it; a diameter sets its radius."""
    name, given = DIAMETERS.get(key, key), file.joint.given_lengths
    held = {length: given[length] for length in give(name, list(given)) if length in given}
    return _with_joint(file, **{**held, name: value if name == key else value / 2})


def _as_changed(joint: Joint) -> Joint:
    """Return a joint that differs from its source, with a preset marked as changed in its name."""
    base = joint.name.removesuffix(_CHANGED)
    if base not in joints:
        return joint.replace(name=joint.name, source="")
    preset = joints[base]
    same = joint.replace(name=preset.name, source=preset.source) == preset
    return preset if same else joint.replace(name=base + _CHANGED, source="")


def _with_name(file: JointFile, value: Any) -> JointFile:
    name = " ".join(check_text("the name", value).split())
    if len(name) > _MAX_NAME:
        raise ValueError(f"the name must have at most {_MAX_NAME} characters, got {len(name)}")
    return replace(file, joint=file.joint.replace(name=name, source=file.joint.source))


def _with_solid_socket(file: JointFile, value: Any) -> JointFile:
    """Make the liner a solid socket, or one of a third of the radius."""
    if not isinstance(value, bool):
        raise ValueError(f"massive = {shown(value)} must be true or false")
    return _with_length(file, "liner_thickness", inf if value else round(float(file.joint.socket_radius) / 3, 1))


def _with_tilt(file: JointFile, tilt: float) -> JointFile:
    along = tilt == 0 and replace(file, aim={}).tilt == 0
    return replace(file, aim={}) if along else varied(file, {"load": {"tilt": tilt}})


def _with_material(file: JointFile, part: str, chosen: Any) -> JointFile:
    """Change the material of liner or ball; custom numbers start from those of the previous material."""
    if chosen == _RIGID:
        return _with_joint(file, **{part: None})
    if chosen != _CUSTOM:
        return _with_joint(file, **{part: materials[chosen]})
    material = getattr(file.joint, part) or Material(young=2e5, poisson=0.3)
    return _with_joint(file, **{part: Material(young=material.young, poisson=material.poisson)})


def layer_controls(screen: Screen) -> list[Control]:
    """List a material for each layer behind the liner, one to add a layer, and the support of the outermost."""
    file, listed = screen.file, []
    for index, layer in enumerate(file.joint.backing):
        known = next((name for name, material in materials.items() if material == layer.material), _CUSTOM)
        custom = [(_CUSTOM, material_label(layer.material, _CUSTOM_NUMBERS))] if known == _CUSTOM else []
        options = [*custom, *_NAMED, (_REMOVE, "– remove –")]
        field = choice(f"behind.{index}", f"Layer {index + 1} behind the liner", options, known)
        listed.append(_control(field, partial(_with_layer, file, index)))
    additions = [(_NO_CHOICE, "– choose –"), *_NAMED]
    added = choice("behind.add", "Add a layer behind the liner", additions, _NO_CHOICE)
    listed.append(_control(added, partial(_with_new_layer, file)))
    if file.joint.backing:
        support = file_choice("joint.support", file.joint.support.value, "behind.support")
        listed.append(_control(support, lambda value: _with_joint(file, support=Support(value))))
    return listed


def _with_layer(file: JointFile, index: int, value: Any) -> JointFile:
    """Change the material of a layer, or remove it; without layers the outside is fixed."""
    if value == _CUSTOM:
        return file
    layers = list(file.joint.backing)
    if value == _REMOVE:
        del layers[index]
    else:
        layers[index] = replace(layers[index], material=materials[value])
    return _with_joint(file, backing=tuple(layers), **({} if layers else {"support": Support.FIXED}))


def _with_new_layer(file: JointFile, value: Any) -> JointFile:
    if value == _NO_CHOICE:
        return file
    if len(file.joint.backing) >= _MAX_LAYERS:
        raise ValueError(f"{shown(value)} is one layer too many: at most {_MAX_LAYERS}")
    return _with_joint(file, backing=(*file.joint.backing, Layer(thickness=_NEW_THICKNESS, material=materials[value])))


def _with_joint(file: JointFile, **changes: Any) -> JointFile:
    """Change lengths or parts of the joint; drop its source if a number differs."""
    joint = file.joint.replace(**changes, name=file.joint.name, source=file.joint.source)
    return replace(file, joint=joint if joint == file.joint else _as_changed(joint))


def cup_controls(screen: Screen) -> list[Control]:
    """List the inputs of the cup and of the direction of its load; those without effect are hidden."""
    file, cup, tilted = screen.file, complete(screen.file)[0].cup, "tilt" in screen.file.aim
    leans = dict(zip(_LEANS, leaning(file), strict=True))
    aims = segments("aim", "Load direction given", _AIMS.items(), _AXIS if tilted else _BODY)

    def angle(name: str, spec: Number, value: float, hidden: bool, edit: Callable[[float], JointFile]) -> Control:
        return _number(screen, name, spec, round(value, 9) + 0.0, edit).but(hidden=hidden)

    def turned(value: float) -> JointFile:
        return varied(file, {"load": {"tilt": value}})

    def of_cup(name: str, hidden: bool = False) -> Control:
        value = cup.chamfer if name == "chamfer" else degrees(getattr(cup, name))
        return angle(name, number_of(f"cup.{name}"), value, hidden, partial(_with_cup, file, name))

    return [
        *(of_cup(name, tilted) for name in ("inclination", "anteversion")),
        angle("tilt", _TILT, degrees(file.aim.get("tilt", 0.0)), not tilted, turned),
        *(angle(name, _LEANS[name], leans[name], tilted, partial(_with_lean, file, name)) for name in _LEANS),
        *(of_cup(name) for name in ("arc_of_cover", "chamfer")),
        _control(aims, lambda aim: replace(file, aim={} if aim == _BODY else {"tilt": file.tilt})),
        _control(file_choice("cup.side", cup.side.value), partial(_with_cup, file, "side")),
        _control(file_choice("cup.interface", cup.interface.value), partial(_with_cup, file, "interface")),
    ]


def leaning(file: JointFile) -> tuple[float, float]:
    """Compute the angles in degrees by which a load leans medially and anteriorly."""
    x, y, z = file.aim.get("direction", UP)
    return degrees(atan2(_MEDIAL[file.cup.side] * x, z)), degrees(atan2(y, z))


def _aimed(file: JointFile, inwards: float, forwards: float) -> JointFile:
    direction = (_MEDIAL[file.cup.side] * tan(radians(inwards)), tan(radians(forwards)), 1.0)
    return replace(file, aim={} if direction[:2] == (0.0, 0.0) else {"direction": direction})


def _with_lean(file: JointFile, name: str, angle: float) -> JointFile:
    return _aimed(file, **{**dict(zip(_LEANS, leaning(file), strict=True)), name: angle})


def _with_cup(file: JointFile, key: str, value: Any) -> JointFile:
    """Change a value of the cup; on the other side the load leans medially as before."""
    changed = varied(file, {"cup": {key: value}})
    return _aimed(changed, *leaning(file)) if key == "side" and "direction" in file.aim else changed
