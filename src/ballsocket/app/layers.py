"""What lies behind the liner, from bone to shell, as inputs: layers are added, made of something else, taken away."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..core.checks import check_names, shown
from ..files.joint_file import JointFile
from ..problem import Joint, Layer, Support
from ..problem.presets import materials
from .fields import Field, choice, segments

_NONE, _AWAY, _OWN = "", "away", "own"
_THICK = 3.0
"""mm of a layer that is added."""

_MOST = 20


def layer_fields(joint: Joint) -> dict[str, Field]:
    """A list of materials for each layer, one more to add a layer, and what holds the last one."""
    made_of = [(name, name) for name in materials]
    listed = [
        choice(
            f"behind.{place}",
            f"Layer {place + 1} behind the liner",
            [*_own(layer), *made_of, (_AWAY, "– take away –")],
            _named(layer),
        )
        for place, layer in enumerate(joint.backing)
    ]
    listed.append(choice("behind.add", "Add a layer behind", [(_NONE, "– choose –"), *made_of], _NONE))
    if joint.backing:
        held = [(one.value, one.value) for one in Support]
        listed.append(segments("behind.support", "Outermost surface", held, joint.support.value))
    return {field["name"]: field for field in listed}


def _named(layer: Layer) -> str:
    return next((name for name, material in materials.items() if material == layer.material), _OWN)


def _own(layer: Layer) -> list[tuple[str, str]]:
    return [(_OWN, layer.material.name or "– own numbers –")] if _named(layer) == _OWN else []


def layers_edited(file: JointFile, key: str, value: Any) -> JointFile:
    """The joint on the screen with other layers behind its liner; it has no name then.

    Parameters
    ----------
    file : JointFile
    key : str
        The place of a layer, "add" or "support".
    value : str
        What was chosen.

    Raises
    ------
    ValueError
        There is no such layer or material, and why.
    """
    layers = list(file.joint.backing)
    check_names([key], [*map(str, range(len(layers))), "add", "support"], "among the layers")
    if key == "support":
        check_names([value], [one.value for one in Support], "as support")
        return _with(file, support=Support(value))
    if value in (_NONE, _OWN):
        return file
    if key != "add" and value == _AWAY:
        del layers[int(key)]
    else:
        check_names([value], materials, "as material")
        if key == "add":
            layers.append(_added(layers, value))
        else:
            layers[int(key)] = replace(layers[int(key)], material=materials[value])
    return _with(file, backing=tuple(layers), **({} if layers else {"support": Support.FIXED}))


def _added(layers: list[Layer], name: str) -> Layer:
    if len(layers) >= _MOST:
        raise ValueError(f"{shown(name)} is one layer too many: at most {_MOST}")
    return Layer(thickness=_THICK, material=materials[name])


def _with(file: JointFile, **changes: Any) -> JointFile:
    return replace(file, joint=replace(file.joint, name="", source="", **changes))
