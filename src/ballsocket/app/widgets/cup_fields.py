"""Inputs for the orientation of a cup and the direction of its load."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import atan2, degrees, radians, tan
from typing import Any

from ...core.checks import check_names, require
from ...core.kinds import Kind, Unit
from ...core.quantities import CUP
from ...files.joint_file import JointFile, read_aim, read_cup
from ...files.joint_toml import cup_table
from ...problem.cup import UP, Side
from ..state.screen import Screen
from .fields import Field, number, segments, typed

_ENDS = {
    "inclination": (0.0, 90.0, 1.0),
    "anteversion": (-30.0, 60.0, 1.0),
    "arc_of_cover": (120.0, 220.0, 1.0),
    "chamfer": (0.0, 3.0, 0.1),
    "tilt": (0.0, 90.0, 1.0),
    "inwards": (-45.0, 45.0, 1.0),
    "forwards": (-45.0, 45.0, 1.0),
}
TILT_LABEL = "Load from the cup's axis γ"
_LEANS = {"inwards": "Load leans to the middle", "forwards": "Load leans to the front"}
_STEEPEST = 80.0  # degrees of a lean that is typed
_BODY, _AXIS = "body", "axis"


def cup_fields(screen: Screen) -> dict[str, Field]:
    """Return every input of the cup by name; inputs without effect are hidden."""
    file, tilted = screen.file, "tilt" in screen.file.aim
    aims = ((_BODY, "in the body"), (_AXIS, "from the cup's axis"))
    in_body = [_of_cup(screen, "inclination"), _of_cup(screen, "anteversion"), *_leans(screen)]
    listed = [
        *({**field, "hidden": tilted} for field in in_body),
        {**_angle(screen, "tilt", TILT_LABEL, degrees(file.aim.get("tilt", 0.0))), "hidden": not tilted},
        *(_of_cup(screen, name) for name in ("arc_of_cover", "chamfer")),
        segments("cup.aim", "Load is aimed", aims, _AXIS if tilted else _BODY),
        segments("cup.side", "Side of the body", [(side.value, side.value) for side in Side], file.cup.side.value),
    ]
    return {field["name"]: field for field in listed}


def _of_cup(screen: Screen, name: str) -> Field:
    value = getattr(screen.file.cup, name)
    title = CUP[name].title.capitalize()
    if CUP[name].kind is Kind.ANGLE:
        return _angle(screen, name, title, degrees(value))
    low, high, step = _ENDS[name]
    unit = screen.reading.unit(CUP[name])
    low, high, step = (end * unit.factor for end in (low, high, step))
    return number(f"cup.{name}", title, unit, (low, high), step, value * unit.factor)


def _angle(screen: Screen, name: str, title: str, value: float) -> Field:
    """Return the input of an angle in degrees, shown in the chosen unit."""
    factor = _factor(screen)
    low, high, step = (end * factor for end in _ENDS[name])
    unit = screen.reading.unit(CUP["inclination"])
    return number(f"cup.{name}", title, unit, (low, high), step, (round(value, 9) + 0.0) * factor)


def _factor(screen: Screen) -> float:
    return 1.0 if screen.angle == "degrees" else radians(1.0)


def _leans(screen: Screen) -> list[Field]:
    leans = zip(_LEANS.items(), leaning(screen.file), strict=True)
    return [_angle(screen, name, title, value) for (name, title), value in leans]


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
    check_names([key], _EDITS, "among the inputs of a cup")
    return _EDITS[key](screen, key, value)


def _degrees(screen: Screen, key: str, value: Any) -> float:
    return typed(key, value, Unit(screen.reading.unit(CUP["inclination"]).text, _factor(screen)), Kind.ANGLE)


def _edit_cup(screen: Screen, key: str, value: Any) -> JointFile:
    length = CUP[key].kind is Kind.LENGTH
    meant = typed(key, value, screen.reading.unit(CUP[key]), Kind.LENGTH) if length else _degrees(screen, key, value)
    return replace(screen.file, cup=read_cup({**cup_table(screen.file.cup), key: meant}))


def _edit_side(screen: Screen, key: str, value: Any) -> JointFile:
    """Change the side of the body; a medial load stays medial."""
    file = screen.file
    turned = replace(file, cup=read_cup({**cup_table(file.cup), key: value}))
    return turned if "direction" not in file.aim else _aimed(turned, *leaning(file))


def _edit_lean(screen: Screen, key: str, value: Any) -> JointFile:
    angle = _degrees(screen, key, value)
    steep = -_STEEPEST <= angle <= _STEEPEST
    require(_LEANS[key].lower(), angle, steep, f"a load leans {-_STEEPEST:g} to {_STEEPEST:g} degrees")
    leans = {**dict(zip(_LEANS, leaning(screen.file), strict=True)), key: angle}
    return _aimed(screen.file, **leans)


def _edit_tilt(screen: Screen, key: str, value: Any) -> JointFile:
    return replace(screen.file, aim=read_aim({key: _degrees(screen, key, value)}))


def _edit_aim(screen: Screen, key: str, value: Any) -> JointFile:
    """Change how the load is aimed, and keep its angle to the cup's axis where possible."""
    check_names([value], (_BODY, _AXIS), "as aim")
    if value == _BODY:
        return replace(screen.file, aim={})
    tilt = screen.file.cup.tilt(screen.file.aim.get("direction", UP))
    return replace(screen.file, aim=screen.file.aim if "tilt" in screen.file.aim else {"tilt": float(tilt)})


_EDITS: Mapping[str, Callable[[Screen, str, Any], JointFile]] = {
    **dict.fromkeys(CUP, _edit_cup),
    **dict.fromkeys(_LEANS, _edit_lean),
    "side": _edit_side,
    "tilt": _edit_tilt,
    "aim": _edit_aim,
}
