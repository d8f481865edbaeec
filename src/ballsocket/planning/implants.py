"""Liners and heads from triangles: spheres of the bearing and of the outer surface, opening, and wall thickness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import acos, cos, degrees, pi, radians

import numpy

from ..core.arrays import Numbers
from ..core.kinds import MILLIMETRES, Kind
from ..core.unit_systems import Amount, Sentence
from ..elasticity.off_axis.scans import fit_sphere
from .geometry import angle_between, polar, robust_scale
from .rims import (
    DISTINCT_AXES,
    RIM_TOLERANCE,
    RimPlane,
    edge_points,
    farthest_points,
    fit_rim,
    main_plane_first,
    rim_deviation,
    rim_planes,
)
from .surfaces import Mesh

RADII = (7.0, 40.0)
"""Allowed radius of a head or bore in mm; heads have diameters of 22 to 60 mm."""

_RADII_TEXT = f"radius {RADII[0]:g} to {RADII[1]:g} mm"
_MAX_OUTER_RADIUS = 60.0  # mm
_SEED = 20260101
_SAMPLE = 1200
_BATCH, _MAX_BATCHES = 4000, 15
_CANDIDATES = 60  # number of spheres through four corners from which the best is chosen
_FINALISTS = 4
_START_TOLERANCE, _MAX_TOLERANCE = 0.004, 0.02
"""Distance from a sphere over its radius, up to which a facet belongs to it: at first, and at most."""

_MIN_RESOLUTION = 3e-4  # smallest distance from the fitted sphere over its radius, up to which a facet belongs to it
_SIGMAS = 4.0
_MIN_ALIGNMENT = 0.9  # least cosine between the normal of a facet and the radial direction at its corners
_MIN_COVERAGE = 0.06  # least share of the full sphere that facets must cover
_MAX_ROUGHNESS = 0.015  # largest standard deviation of a bearing from its sphere, over the radius
_MIN_OPENING = 0.005  # distance of a sphere's centroid from its centre over the radius, below which it is complete
_FLAT_FACETS = 0.02  # depth in mm of facets below the sphere through their corners from which a note is given
_TANGENT_BAND = radians(20.0)  # width of the band at the rim in which a cylinder may continue the sphere
_MIN_TANGENT = radians(0.4)  # smallest polar angle in rad of a cylinder that is left out
_MIN_GAIN = 25.0  # least decrease of the sum of squares over its mean per facet that is evidence for a cylinder
_UNEVEN_RIM = radians(3.0)  # deviation of the rim from a plane from which the rim has a lip
_MIN_OUTWARDS = 0.35  # least cosine between the normal of an outer surface and the direction from the bore's centre


@dataclass(frozen=True, kw_only=True, eq=False)
class ImplantFit:
    """Fitted bearing of a liner or head.

    Attributes
    ----------
    radius : float
        Radius in mm of the sphere through the corners of the facets.
    centre : array (3,)
        Centre in mm, in the coordinates of the file.
    residual : float
        Root mean square distance in mm of these corners from the sphere.
    axis : array (3,) or None
        Unit vector from the centre out of the opening; None for a complete sphere. A plane rim gives it by its normal.
        For a liner with a lip it is the axis around which the surfaces outside the bore are turned.
    arc_of_cover : float
        Angle in rad that the spherical surface covers in a section through its axis; 2π for a complete sphere.
    rim_deviation : float
        Largest angle in rad of the end of the surface from a plane rim.
    rim : tuple of RimPlane
        Main plane of the rim and that of its lip, if it has one; empty for a complete sphere.
    ambiguous : bool
        True if both planes of the rim may be the main one: the outer surface does not decide.
    facet_depth : float
        Mean depth in mm of the middle of the facets below the sphere through their corners.
    wall_thickness : float or None
        Wall of a liner at the pole in mm, to the sphere of the outer surface; None for a head or without such a sphere.
    wall_range : tuple of float or None
        Smallest and largest distance in mm of both spheres within 80 % of the polar angle of the rim.
    wall_residual : float or None
        Root mean square distance in mm of the outer surface from its sphere.
    name : str
        Name of the file.
    """

    radius: float
    centre: Numbers
    residual: float
    axis: Numbers | None
    arc_of_cover: float
    rim_deviation: float
    facet_depth: float
    rim: tuple[RimPlane, ...] = ()
    ambiguous: bool = False
    wall_thickness: float | None = None
    wall_range: tuple[float, float] | None = None
    wall_residual: float | None = None
    name: str = "mesh"

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on facets and rims that limit the accuracy."""
        notes: list[str] = []
        if self.facet_depth > _FLAT_FACETS:
            notes.append(
                Sentence(
                    "{}: the radius is that of the sphere through the corners of the facets, whose middles lie {} "
                    "inside it; a mesh whose facets straddle the surface has a smaller one",
                    self.name,
                    Amount(self.facet_depth, MILLIMETRES, 2),
                )
            )
        if len(self.rim) > 1:
            text = "{}: the rim lies in two planes, {} apart: the arc of cover ends at the main one"
            notes.append(Sentence(text, self.name, self.rim_step))
        elif self.rim_deviation > _UNEVEN_RIM:
            notes.append(
                f"{self.name}: the end of the sphere is not plane and deviates by up to "
                f"{degrees(self.rim_deviation):.0f}°; the arc of cover is that of most of the rim"
            )
        if self.ambiguous:
            notes.append(
                Sentence(
                    "{}: the outer surface does not show which plane of the rim is the main one: if it is the lip, the "
                    "axis is {} off; look at the liner",
                    self.name,
                    self.rim_step,
                )
            )
        return tuple(notes)

    @property
    def lip_angle(self) -> float | None:
        """Angle in rad between the planes of the main rim and of the lip; None without a lip."""
        return angle_between(self.rim[0].normal, self.rim[1].normal) if len(self.rim) > 1 else None

    @property
    def rim_step(self) -> Amount:
        """Angle between both planes of the rim; if they are parallel, their distance."""
        main, lip = self.rim
        angle = angle_between(main.normal, lip.normal)
        if angle > DISTINCT_AXES:
            return Amount(angle, Kind.ANGLE.written, decimals=1)
        return Amount(abs(lip.height - main.height), MILLIMETRES, decimals=1)


@dataclass(frozen=True, kw_only=True, eq=False)
class _SphereFit:
    """Sphere in a mesh: centre, radius, mask (n,) of its facets, and residual of their corners."""

    centre: Numbers
    radius: float
    facets: Numbers
    residual: float


def fit_liner(mesh: Mesh) -> ImplantFit:
    """Fit bore, opening and outer surface of a liner.

    The bore is the largest concave spherical surface. Its radius is that of the corners of the facets, which a CAD
    program puts on the surface. Chamfers, holes, ribs and cylinders are left out.

    Raises ValueError: a mesh without a bore, or with one that no hip has.
    """
    bore = _find_sphere(mesh, -1.0, RADII)
    if bore is None:
        solid = _find_sphere(mesh, 1.0, RADII)
        seen = f"; its sphere of radius {solid.radius:.4g} mm is convex, as of a head" if solid is not None else ""
        raise ValueError(f"{mesh.name} has no bore, no concave spherical surface of {_RADII_TEXT}{seen}")
    fit, bore = _describe(mesh, bore)
    if fit.axis is None:
        raise ValueError(f"{mesh.name}: the bore of radius {bore.radius:.4g} mm has no opening")
    return _with_wall(mesh, _with_lip(mesh, bore, fit) if fit.rim_deviation > RIM_TOLERANCE else fit)


def fit_head(mesh: Mesh) -> ImplantFit:
    """Fit the sphere and the taper's opening of a head.

    Raises ValueError: a mesh without a ball, or with one that no hip has.
    """
    ball = _find_sphere(mesh, 1.0, RADII)
    if ball is None:
        raise ValueError(f"{mesh.name} has no ball, no convex spherical surface of {_RADII_TEXT}")
    return _describe(mesh, ball)[0]


def _find_sphere(mesh: Mesh, sign: float, radii: tuple[float, float]) -> _SphereFit | None:
    """Find the sphere with the largest surface in a mesh: convex (sign 1) or concave (-1); None without one.

    Candidates pass through four random corners. The best ones are fitted to their facets, with a tolerance that
    follows their scatter.
    """
    generator = numpy.random.default_rng(_SEED)
    if len(mesh.triangles) < 4:
        return None
    chosen = generator.choice(len(mesh.areas), size=_SAMPLE, p=mesh.areas / mesh.areas.sum())
    sample = mesh.part(chosen, equal_areas=True)
    candidates: list[tuple[Numbers, float]] = []
    for _ in range(_MAX_BATCHES):
        candidates += _candidates(sample, sign, radii, generator)
        if len(candidates) >= _CANDIDATES:
            break
    scores = [
        _belonging(sample, centre, radius, _START_TOLERANCE * radius, sign).sum() for centre, radius in candidates
    ]
    ranked = [candidates[index] for index in numpy.argsort(scores, kind="stable")[::-1]]
    spheres = [_refine(sample, centre, radius, sign) for centre, radius in ranked[:_FINALISTS]]
    best = max((sphere for sphere in spheres if sphere), key=lambda sphere: sphere.facets.sum(), default=None)
    sphere = best and _refine(mesh, best.centre, best.radius, sign)
    if sphere is None or not radii[0] <= sphere.radius <= radii[1] or sphere.residual > _MAX_ROUGHNESS * sphere.radius:
        return None
    covered = mesh.areas[sphere.facets].sum() / (4 * pi * sphere.radius**2)
    return sphere if covered >= _MIN_COVERAGE else None


def _candidates(
    sample: Mesh, sign: float, radii: tuple[float, float], generator: numpy.random.Generator
) -> list[tuple[Numbers, float]]:
    """Return centres and radii of spheres through four random corners, whose normals fit."""
    indices = generator.integers(len(sample.triangles), size=(_BATCH, 4))
    points, normals = sample.triangles[indices, 0], sample.normals[indices]
    edges = points[:, 1:] - points[:, :1]
    size = numpy.linalg.norm(edges, axis=2).max(axis=1)
    solid = abs(numpy.linalg.det(edges)) > 1e-3 * size**3
    points, normals, edges = points[solid], normals[solid], edges[solid]
    offset = numpy.linalg.solve(2 * edges, numpy.sum(edges**2, axis=2)[..., None])[..., 0]
    radius = numpy.linalg.norm(offset, axis=1)
    centre = points[:, 0] + offset
    radial = (points - centre[:, None]) / radius[:, None, None]
    good = (sign * numpy.sum(radial * normals, axis=2) > _MIN_ALIGNMENT).all(axis=1)
    good &= (radius > 0.8 * radii[0]) & (radius < 1.2 * radii[1])
    return list(zip(centre[good], radius[good].tolist(), strict=True))[:_CANDIDATES]


def _belonging(mesh: Mesh, centre: Numbers, radius: float, tolerance: float, sign: float) -> Numbers:
    """Return the mask of the facets whose corners lie on a sphere and whose normals are radial."""
    offset = mesh.triangles - centre
    close = (abs(numpy.linalg.norm(offset, axis=2) - radius) < tolerance).all(axis=1)
    height = numpy.sum(offset[:, 0] * mesh.normals, axis=1)
    mask: Numbers = close & (sign * height > _MIN_ALIGNMENT * radius)
    return mask


def _refine(mesh: Mesh, centre: Numbers, radius: float, sign: float) -> _SphereFit | None:
    """Fit a sphere to the facets near it, until they stay the same; None if too few are left."""
    tolerance, before = _START_TOLERANCE * radius, numpy.zeros(len(mesh.triangles), dtype=bool)
    for _ in range(25):
        mask = _belonging(mesh, centre, radius, tolerance, sign)
        if mask.sum() < 4:
            return None
        sphere = _fit_facets(mesh, mask)
        centre, radius = sphere.centre, sphere.radius
        residuals = numpy.linalg.norm(mesh.triangles[mask] - centre, axis=2) - radius
        if (mask == before).all():
            break
        before = mask
        tolerance = max(min(_SIGMAS * robust_scale(residuals), _MAX_TOLERANCE * radius), _MIN_RESOLUTION * radius)
    return sphere


def _fit_facets(mesh: Mesh, facets: Numbers) -> _SphereFit:
    points, weights = mesh.triangles[facets].reshape(-1, 3), numpy.repeat(mesh.areas[facets], 3)
    centre, radius = fit_sphere(points, weights)
    residuals = numpy.linalg.norm(points - centre, axis=1) - radius
    residual = float(numpy.sqrt(weights @ residuals**2 / weights.sum()))
    return _SphereFit(centre=centre, radius=radius, facets=facets, residual=residual)


def _describe(mesh: Mesh, sphere: _SphereFit, passes: int = 2) -> tuple[ImplantFit, _SphereFit]:
    """Return the fit of a sphere with its opening, and the sphere without a cylinder that continues it."""
    part = mesh.part(sphere.facets)
    corners = (part.triangles - sphere.centre) / sphere.radius
    middles, weights = corners.mean(axis=1), part.areas / part.areas.sum()
    axis, angle, deviation = None, pi, 0.0
    if numpy.linalg.norm(weights @ middles) >= _MIN_OPENING:
        axis, angle, deviation = fit_rim(corners, weights @ middles, mesh.name)
        end = _find_tangent_end(corners, part, -axis, angle)
        inner = middles @ -axis > cos(end) * numpy.linalg.norm(middles, axis=1)
        if passes and end < angle and not inner.all():
            facets = sphere.facets.copy()
            facets[facets] = inner
            return _describe(mesh, _fit_facets(mesh, facets), passes - 1)
    fit = ImplantFit(
        radius=sphere.radius,
        centre=sphere.centre,
        residual=sphere.residual,
        axis=axis,
        arc_of_cover=2 * angle,
        rim_deviation=deviation,
        rim=() if axis is None else (RimPlane(normal=axis, height=-sphere.radius * cos(angle), share=1.0),),
        facet_depth=sphere.radius * (1.0 - float(weights @ numpy.linalg.norm(middles, axis=1))),
        name=mesh.name,
    )
    return fit, sphere


def _find_tangent_end(corners: Numbers, part: Mesh, dome: Numbers, angle: float) -> float:
    """Find the polar angle in rad from which a cylinder continues the sphere; `angle` of the rim without one.

    The distances from the sphere do not show a short cylinder in their scatter. Its normals do: their polar angle
    stays that of the end of the sphere.
    """
    polar = numpy.arccos(numpy.clip(corners @ dome / numpy.linalg.norm(corners, axis=2), -1.0, 1.0))
    middle = (polar.min(axis=1) + polar.max(axis=1)) / 2
    band = (middle > angle - _TANGENT_BAND) & (middle < angle)
    if not band.any():
        return angle
    outward = numpy.sign(numpy.sum(part.normals * corners[:, 0], axis=1))
    slopes = (numpy.arccos(numpy.clip(outward * (part.normals @ dome), -1.0, 1.0)) - middle)[band]
    weights, middle = part.areas[band] / part.areas[band].sum(), middle[band]
    ends = numpy.linspace(angle - _TANGENT_BAND, angle, 200)
    misfits = numpy.array([weights @ (slopes + numpy.clip(middle - end, 0.0, None)) ** 2 for end in ends])
    best, floor = int(misfits.argmin()), _MIN_TANGENT**2 / 16
    gain = (misfits[-1] - misfits[best]) * len(slopes) / (misfits[best] + floor)
    edges = numpy.linalg.norm(corners - numpy.roll(corners, -1, axis=1), axis=2).max(axis=1)
    facet_error = float(numpy.median(edges)) ** 2 / 8  # angle between a facet and the sphere
    beyond = middle > ends[best]
    evident = beyond.any() and -numpy.average(slopes[beyond], weights=weights[beyond]) > 3 * facet_error
    return float(ends[best]) if evident and gain > _MIN_GAIN and angle - ends[best] > _MIN_TANGENT else angle


def _with_lip(mesh: Mesh, bore: _SphereFit, fit: ImplantFit) -> ImplantFit:
    """Describe a liner whose rim is not plane: axis of the outer surface, main plane and plane of the lip.

    A rim without two planes keeps its fit.
    """
    part, centre = mesh.part(bore.facets), bore.centre
    points = edge_points((part.triangles - centre) / bore.radius)
    radial, distances = polar(mesh.middles, centre)
    outwards = numpy.sum(radial * mesh.normals, axis=1) > _MIN_OUTWARDS
    outer = mesh.part(outwards & (distances > 1.02 * bore.radius))
    normals, sphere = outer.normals, _find_sphere(outer, 1.0, (RADII[0], _MAX_OUTER_RADIUS))
    if sphere is not None:
        normals = numpy.where(sphere.facets[:, None], polar(outer.middles, sphere.centre)[0], normals)
    moments = numpy.cross(outer.middles - centre, normals) * outer.areas[:, None]
    axis, ambiguous = numpy.asarray(fit.axis), False
    for _ in range(3):
        ends = farthest_points(points, -axis)
        planes = rim_planes(ends, axis, bore.radius)
        if len(planes) < 2:
            return fit
        if angle_between(planes[0].normal, planes[1].normal) > DISTINCT_AXES:
            planes, axis, ambiguous = main_plane_first(planes, outer, moments, centre)
        else:
            axis = planes[0].normal
    angle = acos(float(numpy.clip(-planes[0].height / bore.radius, -1.0, 1.0)))
    deviation = rim_deviation(ends, -planes[0].normal, angle)
    return replace(fit, axis=axis, arc_of_cover=2 * angle, rim_deviation=deviation, rim=planes, ambiguous=ambiguous)


def _with_wall(mesh: Mesh, fit: ImplantFit) -> ImplantFit:
    """Add the wall thickness of a liner to its fit, if the outer surface is a sphere."""
    dome = -numpy.asarray(fit.axis)
    radial, distance = polar(mesh.middles, fit.centre)
    behind = (distance > 1.02 * fit.radius) & (radial @ dome > cos(fit.arc_of_cover / 2))
    outwards = numpy.sum(radial * mesh.normals, axis=1) > 0
    outer = _find_sphere(mesh.part(behind & outwards), 1.0, (fit.radius, _MAX_OUTER_RADIUS))
    if outer is None or numpy.linalg.norm(outer.centre - fit.centre) > 0.5 * fit.radius:
        return fit
    angles = numpy.linspace(0.0, 0.8 * min(fit.arc_of_cover / 2, pi / 2), 9)
    shift = outer.centre - fit.centre
    along = float(shift @ dome)
    across = float(numpy.sqrt(max(shift @ shift - along**2, 0.0)))
    projections = numpy.array([along * numpy.cos(angles) + sign * across * numpy.sin(angles) for sign in (1.0, -1.0)])
    walls = projections + numpy.sqrt(projections**2 + outer.radius**2 - shift @ shift) - fit.radius
    return replace(
        fit,
        wall_thickness=float(walls[0, 0]),
        wall_range=(float(walls.min()), float(walls.max())),
        wall_residual=outer.residual,
    )
