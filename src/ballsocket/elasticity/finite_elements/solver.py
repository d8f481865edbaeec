"""Load curves of joints from the settings of the finite element model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import inf, pi, radians

from ...core.checks import require
from ...problem import Joint, Support
from ...problem.cup import Cup, Interface
from ...problem.gaps import CircularGap, LinearGap
from .bodies import ball_compliance, socket_compliance
from .load_curve import COARSE, MeshedLoadCurve
from .memory import check_memory, mesh_size
from .progress import report_progress
from .shapes import Resolution, socket_shape
from .spacing import Spacing, Uniform
from .surfaces import ContactSurface, SurfacePair

LIMIT = radians(88.0)
"""Largest half angle in rad that is solved."""

_REACH_FACTOR = 1.2  # of a class's widest contact: extent of its pressure nodes

MIN_ELEMENTS, MAX_ELEMENTS = 24, 100_000
"""Limits on the number of elements of one size along the bore."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of a `FiniteElement` model by their names; `order` is that of the elements."""

    cup: Cup
    spacing: Spacing
    ball_spacing: Spacing
    order: int
    meshes: int
    gap: type[LinearGap] | type[CircularGap]


@lru_cache(maxsize=32)
def load_curve_of(settings: Settings, joint: Joint) -> MeshedLoadCurve:
    """Return the load curve of a joint with scalar parameters; it is cached for further loads."""
    _check_geometry(settings, joint)
    radius, bore = float(joint.socket_radius), socket_shape(joint, settings.cup).reach
    ends_at_rim = bore <= pi / 2 + 1e-12
    widest = bore if ends_at_rim else LIMIT
    class_limits = settings.spacing.classes(widest, radius)

    thickness, order = float(joint.liner_thickness), settings.order

    def make_resolution(spacing: Spacing, class_index: int, mesh: int) -> Resolution:
        """Make the coarse or the fine mesh resolution of a class of half angles."""
        coarse = spacing.coarse(class_limits[class_index], radius, thickness, order)
        return coarse if mesh == COARSE else replace(coarse, halvings=1)

    def make_pair(class_index: int, mesh: int) -> SurfacePair:
        """Make the meshed surfaces of socket and ball for a class of half angles."""
        socket, ball = (
            make_resolution(spacing, class_index, mesh) for spacing in (settings.spacing, settings.ball_spacing)
        )
        return _make_surface_pair(settings, joint, socket, ball, min(_REACH_FACTOR * class_limits[class_index], widest))

    gap = settings.gap(clearance=float(joint.clearance), socket_radius=radius)
    return MeshedLoadCurve(
        pairs=make_pair, classes=class_limits, gap=gap, ends_at_rim=ends_at_rim, meshes=settings.meshes, order=order
    )


def _check_geometry(settings: Settings, joint: Joint) -> None:
    """Raise ValueError for a geometry that cannot be meshed."""
    if isinstance(settings.spacing, Uniform):
        bore = socket_shape(joint, settings.cup).reach
        _check_element_size(settings.spacing.size, joint, float(joint.socket_radius) * bore)
    check_cup(settings.cup, joint)


def check_cup(cup: Cup, joint: Joint) -> None:
    """Raise ValueError for a cup that does not fit the joint."""
    if cup.interface is Interface.SLIDING and not joint.backing:
        ground = joint.support is Support.FIXED and float(joint.liner_thickness) < inf
        if not ground:
            raise ValueError("interface = 'sliding' needs a backing or a fixed outer surface behind the liner")
    chamfer, liner, bore = cup.chamfer, float(joint.liner_thickness), socket_shape(joint, cup).reach
    require(
        "chamfer", chamfer, chamfer < 0.9 * liner, f"a chamfer must leave a tenth of the liner thickness, {liner:g} mm"
    )
    require(
        "chamfer",
        chamfer,
        chamfer == 0 or chamfer > 1e-3 * liner,
        "a chamfer must be 0 or above a thousandth of the liner thickness",
    )
    require("chamfer", chamfer, bore > cup.rim / 2, "a chamfer must leave half of the bore")


def _check_element_size(size: float, joint: Joint, bore: float) -> None:
    """Raise ValueError for an element size in mm that does not fit the layers or the length of the bore."""
    thicknesses = {"liner_thickness": joint.liner_thickness}
    thicknesses |= {f"backing[{number}].thickness": layer.thickness for number, layer in enumerate(joint.backing)}
    for name, thickness in thicknesses.items():
        require(name, thickness, thickness >= 2 * size, f"a layer must have at least two elements of {size:g} mm")
    allowed = f"the bore of {bore:.4g} mm allows {MIN_ELEMENTS} to {MAX_ELEMENTS} elements"
    require("size", size, bore / MAX_ELEMENTS <= size <= bore / MIN_ELEMENTS, allowed)


def _make_surface_pair(
    settings: Settings, joint: Joint, resolution: Resolution, ball_resolution: Resolution, reach: float
) -> SurfacePair:
    """Mesh both bodies up to the angle `reach` (rad) and condense them onto their contact surfaces."""
    size = mesh_size(joint, settings.cup, resolution, ball_resolution)
    check_memory(size, resolution.order)
    report_progress(f"condensing {size.elements} elements, {size.nodes} nodes")
    R2, order = float(joint.socket_radius), resolution.order  # the ball, too, is pressed on a patch of the radius R2
    angle, compliance = socket_compliance(socket_shape(joint, settings.cup), resolution)
    surfaces = [ContactSurface(angle=angle, order=order, compliance=compliance / (R2 * float(joint.liner.young)))]
    if joint.ball is not None:
        angle, compliance = ball_compliance(float(joint.ball.poisson), ball_resolution)
        surfaces.append(
            ContactSurface(angle=angle, order=order, compliance=compliance / (R2 * float(joint.ball.young)))
        )
    return SurfacePair(
        surfaces=tuple(surfaces), radius=R2, reach=reach, resolution=resolution, ball_resolution=ball_resolution
    )
