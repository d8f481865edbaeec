"""Inputs for the orientation of a cup and the direction of its load."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, degrees, radians, tan
from typing import Any

from ...core.checks import check_names
from ...files.joint_file import JointFile, varied
from ...problem.cup import UP, Side
from ...question import complete
from ..state.screen import Screen
from .fields import Field, segments
from .numbers import CUP_NUMBERS, choice_of

_BODY, _AXIS = "body", "axis"
_LEANS = ("inwards", "forwards")


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
