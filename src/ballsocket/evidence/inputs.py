"""What goes in: every number with its unit, tolerance and source, and what computes with them."""

from __future__ import annotations

import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from ..joint import Joint, Material
from ..joint.dimensions import DIAMETERS
from ..quantities import JOINT, MATERIAL, STRENGTH
from .question import Question

_LIBRARIES = ("numpy", "scipy", "scikit-fem", "array-api-compat")
_LENGTHS = ("ball_radius", "clearance", "liner_thickness")


def inputs(question: Question) -> list[dict[str, Any]]:
    """Every number that goes in, with unit, tolerance and source."""
    joint = question.file.joint
    listed = [(name, getattr(joint, name), JOINT[name].written.text) for name in _LENGTHS]
    for part in ("liner", "ball"):
        listed += _material(part, getattr(joint, part))
    for number, layer in enumerate(joint.backing):
        listed += [(f"backing[{number}].thickness", layer.thickness, "mm")]
        listed += _material(f"backing[{number}]", layer.material)
    if question.friction is not None:
        listed.append(("friction.coefficient", question.friction, ""))
    return [
        {
            "name": name,
            "value": value if value is None or abs(value) < float("inf") else "inf",
            "unit": unit,
            "tolerance": _tolerance(question, name),
            "source": _source(question, joint, name),
        }
        for name, value, unit in listed
    ]


def _material(part: str, material: Material | None) -> list[tuple[str, Any, str]]:
    if material is None:
        return []
    numbers = {**MATERIAL, **STRENGTH}
    return [
        (f"{part}_{name}", getattr(material, name), each.written.text)
        for name, each in numbers.items()
        if getattr(material, name) is not None
    ]


def _tolerance(question: Question, name: str) -> str:
    spread = question.tolerances.get(name)
    if spread is None:
        varied = {DIAMETERS.get(each, each) for each in question.axes}
        return "varied in the matrix" if name in varied else ""
    low, high = (float(spread.frozen.ppf(share)) for share in (0.0, 1.0))
    return f"{low:g} to {high:g}"


def _source(question: Question, joint: Joint, name: str) -> str:
    """Where a number comes from: as the question says of it or its part, else the preset."""
    part = "joint" if name in _LENGTHS else name.split("_")[0].split("[")[0]
    said = question.sources.get(name) or question.sources.get(part)
    if said:
        return said
    described = joint if part == "joint" else getattr(joint, part, None)
    return described.source if isinstance(described, Joint | Material) else ""


def made_with() -> dict[str, str]:
    """Versions and machine."""
    versions = {}
    for name in _LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            continue
    return {"python": platform.python_version(), "system": f"{sys.platform} {platform.machine()}", **versions}
