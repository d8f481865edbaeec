"""Inputs of joint, load, cup and layers, each with its field and its edit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from html import escape
from math import atan2, degrees, inf, isinf, radians, tan
from typing import Any

from ...core.checks import check_names, check_text, shown
from ...core.quantities import LOADS, STRESS_LIMITS
from ...files.joint_file import JointFile, joint_of, varied
from ...files.joint_toml import Tables, tables_of
from ...problem import Joint, Layer, Material, Support
from ...problem.cup import UP, Side
from ...problem.dimensions import DIAMETERS, LENGTHS, give
from ...problem.presets import joints, materials
from ...question import complete
from ..pressing import same_load
from ..state.screen import Screen
from .fields import Field, choice, segments, tick, words
from .numbers import ALLOWABLE, CUP_NUMBERS, THICKNESS, TILT, Number, choice_of, number_of, of_parameter

_CUSTOM, _RIGID, _PRESET = "own", "rigid", ""
_CUSTOM_NUMBERS = "– custom numbers –"
_MATERIALS = ((_CUSTOM, _CUSTOM_NUMBERS), *materials)
_CHANGED = " (changed)"
_LENGTHS = ("ball_radius", "clearance", "liner_thickness", "outer_radius")  # lengths of the joint with an input
_MAX_NAME = 80  # characters of a design's name
_NO_CHOICE, _REMOVE = "", "away"
_NEW_THICKNESS, _MAX_LAYERS = 3.0, 20  # mm of a layer that is added; number of layers
_BODY, _AXIS = "body", "axis"
_LEANS = ("inwards", "forwards")


@dataclass(frozen=True)
class JointInput:
    """Input of the joint on the screen: its field, and the joint file after an edit to a typed or chosen value."""

    field: Field
    edit: Callable[[Any], JointFile]


def joint_inputs(screen: Screen) -> dict[str, JointInput]:
    """Return every input of the joint on the screen by name, in the order of the page."""
    file, tables, joint = screen.file, tables_of(screen.file), screen.file.joint
    ((kind_of_load, _),) = file.load.items()
    presets = [(_PRESET, "– choose –"), *joints]
    preset = joint.name if joints.get(joint.name) == joint else _PRESET
    kinds = segments("kind", "Load given as", [(name, LOADS[name].title) for name in LOADS], kind_of_load)
    solid = tick("massive", "Solid socket (no backing)", isinf(float(joint.liner_thickness)))
    allowable = ALLOWABLE.field("allowable", joint.liner.allowable_pressure, screen.reading)
    liner, ball = _chosen(tables["liner"]), _chosen(tables["ball"]) if joint.ball else _RIGID
    listed = [
        JointInput(words("name", "Design", joint.name), partial(_with_name, file)),
        JointInput(choice("preset", "Start from", presets, preset), partial(_with_preset, file)),
        *_number_inputs(screen, _LENGTHS),
        *([] if joint.backing else [JointInput(solid, partial(_with_solid_socket, file))]),
        JointInput(kinds, partial(_with_kind_of_load, screen)),
        _number_input(screen, "load", of_parameter(kind_of_load), tables["load"][kind_of_load]),
        JointInput(TILT.field("tilt", degrees(file.tilt), screen.reading), partial(_with_tilt, screen)),
        JointInput(choice("liner", "Liner", _MATERIALS, liner), partial(_with_material, file, "liner")),
        *_number_inputs(screen, ("liner_young", "liner_poisson")),
        JointInput({**allowable, "optional": True}, partial(_with_allowable, screen)),
        *(
            _thickness_input(screen, index, layer)
            for index, layer in enumerate(joint.backing)
            if not isinf(float(layer.thickness))
        ),
        JointInput(choice("ball", "Ball", (_RIGID, *_MATERIALS), ball), partial(_with_material, file, "ball")),
        *_number_inputs(screen, ("ball_young", "ball_poisson")),
    ]
    return {entry.field["name"]: entry for entry in listed}


def _number_inputs(screen: Screen, names: Sequence[str]) -> list[JointInput]:
    """Return the inputs of finite numbers; a rigid ball has none, and an interference is no clearance."""
    joint, inputs = screen.file.joint, []
    owners = {"joint": joint, "liner": joint.liner, "ball": joint.ball}
    for name in names:
        spec = number_of(name, screen.size)
        value = float(getattr(owners[spec.entry.part], spec.entry.key, inf))
        if value < inf and (spec.entry.part != "joint" or value >= 0):
            inputs.append(_number_input(screen, name, spec, value))
    return inputs


def _number_input(screen: Screen, name: str, spec: Number, value: float) -> JointInput:
    """Return the input of a number of a table; a diameter sets its radius."""
    part, key = spec.entry.part, spec.entry.key

    def edit(typed: Any) -> JointFile:
        meant = spec.meant(typed, screen.reading)
        if part != "joint":
            return _changed(screen.file, lambda tables: tables.setdefault(part, {}).update({key: meant}))
        single = DIAMETERS.get(key, key)
        length = meant if single == key else meant / 2
        return _changed(screen.file, lambda tables: _set_length(tables["joint"], single, length))

    return JointInput(spec.field(name, value, screen.reading), edit)


def _set_length(lengths: Tables, name: str, value: float) -> None:
    """Set a length of the table [joint]; it takes the place of the one that would follow from it."""
    kept = give(name, [key for key in lengths if key in LENGTHS])
    for key in [key for key in lengths if key in LENGTHS and key not in kept]:
        del lengths[key]
    lengths[name] = value


def _thickness_input(screen: Screen, index: int, layer: Layer) -> JointInput:
    spec = replace(THICKNESS, label=f"{layer.material.name or 'Layer'} thickness")

    def edit(typed: Any) -> JointFile:
        thickness = spec.meant(typed, screen.reading)
        return _changed(screen.file, lambda tables: tables["backing"][index].update(thickness=thickness))

    return JointInput(spec.field(f"layer{index}", float(layer.thickness), screen.reading), edit)


def _chosen(table: Tables) -> str:
    """Return the name of a material, or "own" if a number differs from it."""
    return str(table["material"]) if set(table) - set(STRESS_LIMITS) == {"material"} else _CUSTOM


def joint_words(joint: Joint) -> str:
    """List the lengths that stay while others change, and the layers behind the liner, as HTML."""
    given = ", ".join(LENGTHS[name].title for name in joint.given_lengths)
    layers = "".join(f"<li>{escape(str(layer))}</li>" for layer in joint.backing)
    behind = f"<p>Behind the liner:</p><ul>{layers}</ul>" if layers else ""
    return f"<p>Held while other lengths change: {given}.</p>{behind}"


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
        return joint.replace(name=joint.name, source="")
    preset = joints[base]
    same = joint.replace(name=preset.name, source=preset.source) == preset
    return preset if same else joint.replace(name=base + _CHANGED, source="")


def _with_name(file: JointFile, value: Any) -> JointFile:
    name = " ".join(check_text("the name", value).split())
    if len(name) > _MAX_NAME:
        raise ValueError(f"the name must have at most {_MAX_NAME} characters, got {len(name)}")
    return replace(file, joint=file.joint.replace(name=name, source=file.joint.source))


def _with_preset(file: JointFile, name: Any) -> JointFile:
    """Replace the joint by a preset, under the same load in the same cup."""
    if name == _PRESET:
        return file
    check_names([name], joints, "as preset")
    return replace(file, joint=joints[name])


def _with_solid_socket(file: JointFile, value: Any) -> JointFile:
    """Make the liner a solid socket, or one of a third of the radius."""
    if not isinstance(value, bool):
        raise ValueError(f"massive = {shown(value)} must be true or false")
    thickness = inf if value else round(float(file.joint.socket_radius) / 3, 1)
    return _changed(file, lambda tables: _set_length(tables["joint"], "liner_thickness", thickness))


def _with_kind_of_load(screen: Screen, kind: Any) -> JointFile:
    """State the load as force, indentation or half angle, with the same contact."""
    check_names([kind], LOADS, "as load")
    return replace(screen.file, load=same_load(screen.file, screen.answered_by, kind))


def _with_tilt(screen: Screen, value: Any) -> JointFile:
    tilt, file = TILT.meant(value, screen.reading), screen.file
    along = tilt == 0 and replace(file, aim={}).tilt == 0
    return replace(file, aim={}) if along else varied(file, {"load": {"tilt": tilt}})


def _with_allowable(screen: Screen, value: Any) -> JointFile:
    """Change the allowable pressure of the liner; an empty box removes it."""
    if value == "":
        return _changed(screen.file, lambda tables: tables["liner"].pop("allowable_pressure", None))
    pressure = ALLOWABLE.meant(value, screen.reading)
    return _changed(screen.file, lambda tables: tables["liner"].update(allowable_pressure=pressure))


def _with_material(file: JointFile, part: str, chosen: Any) -> JointFile:
    """Change the material of liner or ball; custom numbers start from those of the previous material."""
    if not isinstance(chosen, str):
        raise ValueError(f"{part} = {shown(chosen)} is not a material")
    if chosen == _RIGID and part == "ball":
        return _changed(file, lambda tables: tables.pop(part, None))
    if chosen != _CUSTOM:
        return _changed(file, lambda tables: tables.update({part: {"material": chosen}}))
    material = getattr(file.joint, part) or Material(young=2e5, poisson=0.3)
    numbers = {"young": float(material.young), "poisson": float(material.poisson)}
    return _changed(file, lambda tables: tables.update({part: numbers}))


def layer_fields(joint: Joint) -> dict[str, Field]:
    """Return a material list for each layer, one to add a layer, and the support of the outermost."""
    listed = []
    for index, layer in enumerate(joint.backing):
        named = next((name for name, material in materials.items() if material == layer.material), _CUSTOM)
        custom = [(_CUSTOM, layer.material.name or _CUSTOM_NUMBERS)] if named == _CUSTOM else []
        options = [*custom, *materials, (_REMOVE, "– remove –")]
        listed.append(choice(f"behind.{index}", f"Layer {index + 1} behind the liner", options, named))
    additions = [(_NO_CHOICE, "– choose –"), *materials]
    listed.append(choice("behind.add", "Add a layer behind the liner", additions, _NO_CHOICE))
    if joint.backing:
        listed.append({**choice_of("joint.support", joint.support.value), "name": "behind.support"})
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
    joint = file.joint.replace(**changes, name=file.joint.name, source=file.joint.source)
    return replace(file, joint=_as_changed(joint))


def cup_fields(screen: Screen, view: str = "cup") -> dict[str, Field]:
    """Return every input of the cup by name, which begins with that of the view; inputs without effect are hidden."""
    file, cup, tilted = screen.file, complete(screen.file)[0].cup, "tilt" in screen.file.aim
    numbers = {
        "inclination": (degrees(cup.inclination), tilted),
        "anteversion": (degrees(cup.anteversion), tilted),
        **{name: (lean, tilted) for name, lean in zip(_LEANS, leaning(file), strict=True)},
        "tilt": (degrees(file.aim.get("tilt", 0.0)), not tilted),
        "arc_of_cover": (degrees(cup.arc_of_cover), False),
        "chamfer": (cup.chamfer, False),
    }
    aims = ((_BODY, "in the body"), (_AXIS, "from the cup's axis"))
    listed = [
        *(
            {**CUP_NUMBERS[name].field(name, round(value, 9) + 0.0, screen.reading), "hidden": hidden}
            for name, (value, hidden) in numbers.items()
        ),
        segments("aim", "Load direction given", aims, _AXIS if tilted else _BODY),
        choice_of("cup.side", cup.side.value),
        choice_of("cup.interface", cup.interface.value),
    ]
    return {f"{view}.{field['name']}": {**field, "name": f"{view}.{field['name']}"} for field in listed}


def leaning(file: JointFile) -> tuple[float, float]:
    """Compute the angles in degrees by which a load leans medially and anteriorly."""
    x, y, z = file.aim.get("direction", UP)
    return degrees(atan2(_inwards(file) * x, z)), degrees(atan2(y, z))


def _inwards(file: JointFile) -> float:
    """Return the sign of the body's x axis that points medially."""
    return -1.0 if file.cup.side is Side.RIGHT else 1.0


def _aimed(file: JointFile, inwards: float, forwards: float) -> JointFile:
    direction = (_inwards(file) * tan(radians(inwards)), tan(radians(forwards)), 1.0)
    return replace(file, aim={} if direction[:2] == (0.0, 0.0) else {"direction": direction})


def cup_edited(screen: Screen, key: str, value: Any) -> JointFile:
    """Return the joint file after a change of one input of `cup_fields`, named without its prefix."""
    check_names([key], (*CUP_NUMBERS, "side", "interface", "aim"), "among the inputs of a cup")
    file = screen.file
    if key in CUP_NUMBERS:
        value = CUP_NUMBERS[key].meant(value, screen.reading)
    if key == "tilt":
        return varied(file, {"load": {key: value}})
    if key in _LEANS:
        return _aimed(file, **{**dict(zip(_LEANS, leaning(file), strict=True)), key: value})
    if key == "aim":  # the load keeps its angle to the cup's axis where possible
        check_names([value], (_BODY, _AXIS), "as aim")
        return replace(file, aim={} if value == _BODY else {"tilt": file.tilt})
    changed = varied(file, {"cup": {key: value}})
    return _aimed(changed, *leaning(file)) if key == "side" and "direction" in file.aim else changed  # medial stays so
