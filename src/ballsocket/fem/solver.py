"""From a joint and the settings of the finite elements to the curve of its contacts."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import inf, pi, radians
from typing import TYPE_CHECKING

from ..checks import require
from ..joint import Joint, Support
from .bodies import ball_compliance, socket_compliance
from .cup import Interface
from .curve import COARSE, Curve
from .memory import check_memory, mesh_size
from .pair import Pair, Surface
from .progress import tell
from .shapes import Resolution, socket_shape
from .spacing import Spacing, Uniform

if TYPE_CHECKING:
    from .model import FiniteElement as Settings

LIMIT = radians(88.0)
"""The widest contact where the socket reaches further."""

LEAST, MOST = 24, 100_000
"""Elements of one size along the bore."""


@lru_cache(maxsize=32)
def curve(model: Settings, joint: Joint) -> Curve:
    """The curve of a joint of plain numbers; kept, since more loads on it are likely."""
    _check(model, joint)
    radius, bore = float(joint.socket_radius), socket_shape(joint, model.cup).reach
    ends_at_rim = bore <= pi / 2 + 1e-12
    widest = bore if ends_at_rim else LIMIT
    classes = model.spacing.classes(widest, radius)

    thickness, order = float(joint.liner_thickness), model.element.value

    def resolution(spacing: Spacing, number: int, mesh: int) -> Resolution:
        coarse = spacing.coarse(classes[number], radius, thickness, order)
        return coarse if mesh == COARSE else replace(coarse, halvings=1)

    @lru_cache(maxsize=2 * len(classes))
    def pair(number: int, mesh: int) -> Pair:
        socket, ball = (resolution(one, number, mesh) for one in (model.spacing, model.ball_spacing or model.spacing))
        return _pair(model, joint, socket, ball, min(1.2 * classes[number], widest))

    gap = model.gap(clearance=float(joint.clearance), socket_radius=radius)
    return Curve(pairs=pair, classes=classes, gap=gap, ends_at_rim=ends_at_rim, meshes=model.meshes, order=order)


def _check(model: Settings, joint: Joint) -> None:
    """Raise ValueError for a geometry that cannot be meshed."""
    thicknesses = {"liner_thickness": joint.liner_thickness}
    thicknesses |= {f"backing[{number}].thickness": layer.thickness for number, layer in enumerate(joint.backing)}
    for name, thickness in thicknesses.items():
        if isinstance(model.spacing, Uniform):
            size = model.spacing.size
            require(name, thickness, thickness >= 2 * size, f"elements of {size:g} mm need two of them in a layer")
    if isinstance(model.spacing, Uniform):
        size, bore = model.spacing.size, float(joint.socket_radius) * socket_shape(joint, model.cup).reach
        allowed = f"the bore is {bore:.4g} mm long: it takes {LEAST} to {MOST} elements"
        require("size", size, bore / MOST <= size <= bore / LEAST, allowed)
    if model.cup.interface is Interface.SLIDING and not joint.backing:
        ground = joint.support is Support.FIXED and float(joint.liner_thickness) < inf
        if not ground:
            raise ValueError("interface = 'sliding' is not allowed: there is nothing behind the liner to slide on")
    chamfer, liner = model.cup.chamfer, float(joint.liner_thickness)
    require("chamfer", chamfer, chamfer < 0.9 * liner, f"a chamfer leaves a tenth of the liner, which is {liner:g} mm")
    bore = socket_shape(joint, model.cup).reach
    require("chamfer", chamfer, chamfer == 0 or chamfer > 1e-3 * liner, "a chamfer is 0 or a thousandth of the liner")
    require("chamfer", chamfer, bore > model.cup.rim / 2, "a chamfer leaves half of the bore")


def _pair(model: Settings, joint: Joint, resolution: Resolution, ball_resolution: Resolution, reach: float) -> Pair:
    size = mesh_size(joint, model.cup, resolution, ball_resolution)
    check_memory(size, resolution.order)
    tell(f"condensing {size.elements} elements, {size.nodes} nodes")
    R2, order = float(joint.socket_radius), resolution.order  # the ball, too, is pressed on a patch of the radius R2
    angle, compliance = socket_compliance(socket_shape(joint, model.cup), resolution)
    surfaces = [Surface(angle=angle, order=order, compliance=compliance / (R2 * float(joint.liner.young)))]
    if joint.ball is not None:
        angle, compliance = ball_compliance(float(joint.ball.poisson), ball_resolution)
        surfaces.append(Surface(angle=angle, order=order, compliance=compliance / (R2 * float(joint.ball.young))))
    return Pair(
        surfaces=tuple(surfaces), radius=R2, reach=reach, resolution=resolution, ball_resolution=ball_resolution
    )
