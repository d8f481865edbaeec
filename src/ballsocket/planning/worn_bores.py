"""Worn volume and deepest wear of a bore from measured points, with their errors.

The original bore is the sphere through the part of the points that is not worn. A robust fit finds it: the sphere
with the smallest residuals of two fifths of the points (least trimmed squares, Rousseeuw and Van Driessen 2006,
doi:10.1007/s10618-005-0024-4).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, degrees, hypot, pi, radians

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.kinds import CUBIC_MILLIMETRES, MICROMETRES, MILLIMETRES, PERCENT
from ..core.records import Record
from ..core.unit_systems import Amount, Sentence
from ..elasticity.off_axis.directions import tangents
from ..elasticity.off_axis.scans import MIN_POINTS, MIN_REACH, fit_sphere
from .geometry import polar, robust_scale
from .implants import RADII
from .surfaces import PointCloud

_SEED = 20260103
_THINNING = radians(3.0)  # distance of the points for the first sphere: dense parts count as much as sparse ones
_STARTS, _FINALISTS, _STEPS, _LAST_STEPS = 300, 8, 2, 20  # spheres, best of them, and steps of the trimmed fit for both
_TRIMMED = 0.4  # share of the points whose residuals the trimmed fit minimises
_TRIMMED_SIGMA = 0.524  # largest residual in the trimmed share over the standard deviation, if no point is worn
_NEIGHBOURS = 12
_SMOOTHING = radians(5.0)  # radius of the neighbourhood in which deviations are smoothed, and margin around worn points
_MAX_NEIGHBOURS = 60
_WORN_SIGMAS = 3.0
_RESOLUTION = 2e-4  # smallest deviation in mm that is seen as wear
_PASSES = 12
_PATCH = radians(10.0)  # size of the patches of one error of form, and radius of the patch of the deepest wear
_MAX_GAP = radians(15.0)  # longest distance of neighbouring points; a wider gap is not covered
_SMOOTHED_AWAY = 1e-3  # largest relative error of the paraboloid at the deepest wear of a head
_MIN_UNWORN = 0.1  # least share of the covered surface that is not worn
_MIN_FLATNESS = 0.02  # smallest over largest scatter of points on a sphere; 0.1 at a reach of 25°
_MAX_FORM = 0.005  # largest scatter of the unworn part over its radius
_MAX_INSIDE = 0.02  # largest share of points clearly inside the sphere of the unworn part
_SMOOTHED_EDGE = 0.03  # largest error in mm of smoothed depths at the edge of deep wear between sparse points
_MAX_DEPTH = 0.3  # largest depth of wear over the radius
_SPHERICAL_WEAR = 0.04  # share of worn points from which they may be a sphere that was taken for worn by mistake
_MAX_EDGE = 0.25  # share of points outside the sphere, at their edge, which may be the only unworn ones
_MIN_SPHERE_POINTS = 30
_FORM_FACTOR = 3.0  # largest error over the error of form, where wear below the noise is taken for unworn
_SIGMAS = 2.0  # standard errors in a printed error: 95 %
_OUT_OF_ROUND = 2e-3  # error of the volume over the area, in mm, of a bore that is out of round by 1 µm
_GOOD_COVER = 0.9


@dataclass(frozen=True, kw_only=True, eq=False)
class WornBore(Record):
    """Wear of a bore from measured points. Errors are two standard errors (95 %).

    Attributes
    ----------
    volume, volume_error : float
        Worn volume in mm³ of the covered surface.
    depth, depth_error : float
        Deepest wear in mm, radially, averaged over 10°.
    radius, radius_error : float
        Radius in mm of the unworn sphere.
    centre : array (3,)
        Centre of the unworn sphere in mm, in the coordinates of the file.
    pole : array (3,)
        Unit vector from the centre to the middle of the points.
    deepest : array (3,)
        Unit vector from the centre to the deepest wear.
    noise : float
        Standard deviation in mm of single points.
    form : float
        Standard deviation in mm of the unworn surface from its sphere, over patches of 10°.
    unworn : float
        Share of the points' surface that is not worn.
    reach : float
        Polar angle in rad from the pole up to which there are points.
    cover : float
        Share of the surface within that angle that the points cover.
    points : int
        Number of points.
    ambiguous : bool
        True if the worn part is as good a sphere as the unworn one, with the same radius.
    hidden_shift : float
        Longest shift in mm of a head of the bore's radius that may have worn the sphere without a trace in the points.
        The errors contain it. 0 if the points, or a smaller head, exclude it.
    head_note : str
        Effect of a measured head on the numbers; empty without one.
    name : str
        Name of the file.
    """

    volume: float
    volume_error: float
    depth: float
    depth_error: float
    radius: float
    radius_error: float
    centre: Numbers
    pole: Numbers
    deepest: Numbers
    noise: float
    form: float
    unworn: float
    reach: float
    cover: float
    points: int
    ambiguous: bool
    name: str
    reading_notes: tuple[str, ...] = ()
    hidden_shift: float = 0.0
    head_note: str = ""

    @property
    def area(self) -> float:
        """Covered surface in mm²."""
        return 2.0 * pi * self.radius**2 * (1.0 - cos(self.reach)) * self.cover

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on what limits the numbers."""
        notes = [
            *self.reading_notes,
            Sentence(
                "{}: the original bore is the sphere through the unworn {} of the points' surface; creep counts as "
                "wear, and each {} that this bore was out of round adds about {} to the error",
                self.name,
                Amount(self.unworn, PERCENT, decimals=0),
                Amount(1e-3, MICROMETRES),
                Amount(_OUT_OF_ROUND * self.area, CUBIC_MILLIMETRES, 1),
            ),
        ]
        if self.volume < self.volume_error and self.depth < self.depth_error:
            notes.append(f"{self.name}: no wear is found above the error")
        if self.cover < _GOOD_COVER:
            notes.append(
                f"{self.name}: {100 * (1 - self.cover):.0f} % of the surface within {degrees(self.reach):.0f}° of the "
                f"pole have no points within {degrees(_MAX_GAP):.0f}°: their wear is not in the volume"
            )
        if self.hidden_shift:
            notes.append(
                Sentence(
                    "{}: the points do not show if the sphere is unworn: a head of its radius may have worn it, by a "
                    "shift of up to {}, which the errors contain; the measured diameter of the head (--head-diameter) "
                    "excludes this if it is more than {} below that of the bore, as does measured surface more than "
                    "90° from the direction of the load",
                    self.name,
                    Amount(self.hidden_shift, MILLIMETRES, 2),
                    Amount(2 * self.radius_error, MICROMETRES, 2),
                )
            )
        if self.head_note:
            notes.append(self.head_note)
        if self.ambiguous:
            notes.append(
                f"{self.name}: the worn part is a sphere too, of the same radius within its error: the errors contain "
                "the wear if it is the unworn part; look at the bore"
            )
        return tuple(notes)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Unworn:
    """Sphere of the unworn points (mask), and limit of their smoothed deviations."""

    centre: Numbers
    radius: float
    mask: Numbers
    limit: float


def measure_wear(cloud: PointCloud, *, head_radius: float | None = None) -> WornBore:
    """Measure the wear of a bore.

    The volume is the integral of the depth over triangles between the points. Its error follows from the scatter of
    single points and of patches of the unworn part, through the fit of the sphere, from the volumes of two halves of
    the points, and from wear that the form of the unworn part may hide.

    Parameters
    ----------
    cloud : PointCloud
        Points of the bore alone: with some unworn surface, and without rim and outer surface.
    head_radius : float, optional
        Measured radius in mm of the head. It wears the bore to spheres of its radius: a sphere that is larger by more
        than its error is unworn.

    Raises
    ------
    ValueError
        A head that is larger than the bore, or has no positive radius.
        Points that are no bore: fewer than 200, off a sphere, inside the sphere of the others, or within 25° of their
        middle.
    """
    points, name = cloud.points, cloud.name
    require(f"points of {name}", len(points), len(points) >= MIN_POINTS, f"a bore has at least {MIN_POINTS} points")
    extents = numpy.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if extents[2] < _MIN_FLATNESS * extents[0]:
        raise ValueError(f"{name} is not a bore: its points lie in a plane or on a line")
    radius = fit_sphere(points)[1]
    if not RADII[0] / 2.0 < radius < 2.0 * RADII[1]:
        raise ValueError(
            f"{name} is not a bore: its best sphere has a radius of {radius:.3g} mm; a bore has {RADII[0]:g} to "
            f"{RADII[1]:g} mm"
        )
    local = _Neighbourhoods.of(points)
    spheres = _find_unworn(local, name)
    bores = [_integrate(cloud, local, sphere) for sphere in spheres]
    unworn = bores[0]
    head_note = ""
    if head_radius is not None:
        if not 0.0 < head_radius <= unworn.radius + unworn.radius_error:
            raise ValueError(
                f"head_diameter = {2 * head_radius:.6g} mm is not allowed: the bore of {name} has a diameter of "
                f"{2 * unworn.radius:.6g} ± {2 * unworn.radius_error:.2g} mm; check the head and --stl-units"
            )
        head, bore = (Amount(2 * radius, MILLIMETRES, 6) for radius in (head_radius, unworn.radius))
        head_note = Sentence("{}: the head, of {} in a bore of {}, changes no number", name, head, bore)
    if len(bores) == 1:
        shifted = _add_hidden_shift(unworn, local, spheres[0])
        excludes = head_radius is not None and unworn.radius - head_radius > unworn.radius_error
        if not (excludes and shifted.hidden_shift):
            return replace(shifted, head_note=head_note)
        length = Amount(shifted.hidden_shift, MILLIMETRES, 2)
        return replace(unworn, head_note=Sentence(_HEAD_EXCLUDES, name, length))
    errors = {}
    for quantity in ("volume", "depth"):
        difference = abs(getattr(bores[0], quantity) - getattr(bores[1], quantity))
        own, other = (getattr(bore, f"{quantity}_error") for bore in bores)
        errors[f"{quantity}_error"] = max(difference + other, own)
    return replace(unworn, **errors, ambiguous=True, head_note=head_note)


_HEAD_EXCLUDES = (
    "{}: the head is smaller than the bore, so that it cannot have worn the sphere of the bore without a trace: the "
    "errors contain no such shift, which could else be up to {}"
)


def _integrate(cloud: PointCloud, local: _Neighbourhoods, sphere: _Unworn) -> WornBore:
    points, name = cloud.points, cloud.name
    radial, distance = polar(points, sphere.centre)
    depth = distance - sphere.radius
    pole = radial[_thin(radial)].mean(axis=0)  # dense parts count as much as sparse ones
    pole /= max(float(numpy.linalg.norm(pole)), 1e-12)
    reach = float(numpy.arccos(numpy.clip(radial @ pole, -1.0, 1.0)).max())
    if reach < MIN_REACH:
        raise ValueError(
            f"{name} has points up to {degrees(reach):.0f}° from its middle; a bore needs {degrees(MIN_REACH):.0f}°"
        )
    areas = _vertex_areas(radial, pole)
    covered = float(areas.sum())
    errors = _Errors.of(local, sphere)
    form = errors.form + _RESOLUTION
    integrand = (distance**3 - sphere.radius**3) / 3.0
    volume = float(areas @ integrand)
    half = numpy.random.default_rng(_SEED).permutation(len(points)) < len(points) // 2
    halves = [float(_vertex_areas(radial[part], pole) @ integrand[part]) for part in (half, ~half)]
    hidden = _SIGMAS * form * covered * sphere.radius**2
    deepest, deepest_depth, weights = _deepest(radial, depth, local.smooth(depth))
    return WornBore(
        volume=volume,
        volume_error=_SIGMAS * errors.of_sum(areas * distance**2) + abs(sum(halves) / 2.0 - volume) + hidden,
        depth=deepest_depth,
        depth_error=_SIGMAS * errors.of_sum(weights) + _FORM_FACTOR * form + _SMOOTHED_AWAY * abs(deepest_depth),
        radius=sphere.radius,
        radius_error=errors.of_radius(),
        centre=sphere.centre,
        pole=pole,
        deepest=deepest,
        noise=errors.noise,
        form=errors.form,
        unworn=float(areas[sphere.mask].sum()) / covered,
        reach=reach,
        cover=covered / (2.0 * pi * (1.0 - cos(reach))),
        points=len(points),
        ambiguous=False,
        name=name,
        reading_notes=cloud.notes,
    )


def _add_hidden_shift(bore: WornBore, local: _Neighbourhoods, sphere: _Unworn) -> WornBore:
    """Add the wear to the errors that a head of the bore's own radius may have left as a shifted sphere.

    A shift s wears the depth n·s in each direction n with n·s > 0, and leaves the sphere of the others outside by -n·s.
    It is possible as long as the points outside the found sphere are few, and deepest at the edge of the points. Its
    largest length towards the pole is that of which the points with n·s < 0 show nothing else.
    """
    radial, _ = polar(local.points, sphere.centre)
    outside = float((local.depth(sphere.centre, sphere.radius) > sphere.limit).mean())
    at_edge = bore.deepest @ bore.pole < cos(bore.reach - _PATCH)
    if outside > (_MAX_EDGE if at_edge else _SPHERICAL_WEAR):
        return bore
    away = -float(numpy.quantile(radial @ bore.pole, outside + _SPHERICAL_WEAR))
    length = min(sphere.limit / max(away, 1e-9), _MAX_DEPTH * sphere.radius)
    facing = numpy.maximum(radial @ bore.pole, 0.0)
    volume = length * sphere.radius**2 * float(_vertex_areas(radial, bore.pole) @ facing)
    return replace(
        bore,
        volume_error=bore.volume_error + volume,
        depth_error=bore.depth_error + length,
        hidden_shift=length,
    )


def _boxes(radial: Numbers, size: float) -> Numbers:
    """Return the number of the box of this size in which each unit vector (n, 3) lies."""
    index = numpy.unique(numpy.floor(radial / size).astype(int), axis=0, return_inverse=True)[1]
    return numpy.asarray(index).ravel()


def _thin(radial: Numbers) -> Numbers:
    """Return the indices of points with about the same distance."""
    return numpy.unique(_boxes(radial, _THINNING), return_index=True)[1]


@dataclass(frozen=True, eq=False)
class _Neighbourhoods:
    """Points (n, 3), the nearest ones of each (n, k), itself included, and their weights in its smoothed value."""

    points: Numbers
    index: Numbers
    weights: Numbers

    @classmethod
    def of(cls, points: Numbers) -> _Neighbourhoods:
        """Find the neighbours within a few degrees."""
        from scipy.spatial import cKDTree  # slow to import

        centre, radius = fit_sphere(points)
        tree = cKDTree(points)
        sample = points[numpy.random.default_rng(_SEED).permutation(len(points))[:200]]
        near = tree.query_ball_point(sample, radius * _SMOOTHING, return_length=True)
        count = int(numpy.clip(numpy.median(near), _NEIGHBOURS, _MAX_NEIGHBOURS))
        distance, index = tree.query(points, k=count)
        axes = numpy.stack(tangents(polar(points, centre)[0].T)).transpose(2, 1, 0)  # (n, 3, 2)
        offset = (points[index] - points[:, None]) / numpy.maximum(distance[:, -1:, None], 1e-12)
        terms = numpy.concatenate([numpy.ones((*index.shape, 1)), offset @ axes], axis=2)
        normal_matrix = terms.swapaxes(1, 2) @ terms + 1e-9 * numpy.eye(3)
        weights = (numpy.linalg.inv(normal_matrix)[:, :1] @ terms.swapaxes(1, 2))[:, 0]
        return cls(points, index, weights)

    def smooth(self, values: Numbers) -> Numbers:
        """Return the values (n,) of planes through the neighbours."""
        smoothed: Numbers = numpy.einsum("nk,nk->n", self.weights, values[self.index])
        return smoothed

    def depth(self, centre: Numbers, radius: float) -> Numbers:
        """Return the smoothed distances (n,) of the points outside a sphere."""
        return self.smooth(polar(self.points, centre)[1] - radius)

    def noise(self, values: Numbers, mask: Numbers) -> float:
        """Estimate the standard deviation of single values (n,), of a mask, from their distances from the planes."""
        residual = values - self.smooth(values)
        own = self.weights[:, 0]  # a point is its own nearest neighbour
        return robust_scale((residual / numpy.sqrt(numpy.maximum(1.0 - own, 0.1)))[mask])


def _find_unworn(local: _Neighbourhoods, name: str) -> list[_Unworn]:
    """Find the sphere of the unworn part; return two, the larger first, if the worn part may be the unworn one.

    A worn part with the shape of a head is a sphere too. No points lie inside the unworn one, and it has the larger
    radius: the head had clearance.
    """
    points = local.points
    sphere = _refine(local, _trimmed_sphere(points))
    _check_bore(local, sphere, name)
    worn = ~_grown(points, sphere.centre, abs(local.depth(sphere.centre, sphere.radius)) >= sphere.limit, 0.0)
    if worn.sum() < max(_SPHERICAL_WEAR * len(points), _MIN_SPHERE_POINTS):
        return [sphere]
    other = _refine(local, _trimmed_sphere(points[worn]))
    same = numpy.linalg.norm(other.centre - sphere.centre) < 0.5 * (sphere.limit + other.limit)
    rough = other.limit > _WORN_SIGMAS * _MAX_FORM * other.radius
    inside = local.depth(other.centre, other.radius) < -max(2.0 * other.limit, _SMOOTHED_EDGE)
    if same or rough or inside.mean() > _MAX_INSIDE or other.mask.sum() < _MIN_SPHERE_POINTS / 2:
        return [sphere]
    larger, smaller = sorted((sphere, other), key=lambda part: -part.radius)
    errors = (_Errors.of(local, part).of_radius() for part in (larger, smaller))
    return [larger] if larger.radius - smaller.radius > hypot(*errors) else [larger, smaller]


def _trimmed_sphere(points: Numbers) -> tuple[Numbers, float, float]:
    """Return centre, radius and scatter of the sphere with the smallest residuals of two fifths of the points."""
    centre, _ = fit_sphere(points)
    chosen = points[_thin(polar(points, centre)[0])]
    size = max(int(_TRIMMED * len(chosen)), 8)
    generator = numpy.random.default_rng(_SEED)
    terms = numpy.column_stack([2.0 * (chosen - centre), numpy.ones(len(chosen))])
    squares = numpy.sum((chosen - centre) ** 2, axis=1)
    subsets = generator.integers(len(chosen), size=(_STARTS, 4))
    for steps in (_STEPS, _LAST_STEPS):
        for _ in range(steps):
            matrix, right = terms[subsets], squares[subsets]
            normal = matrix.swapaxes(1, 2) @ matrix + 1e-9 * numpy.eye(4)
            solution = numpy.linalg.solve(normal, (matrix.swapaxes(1, 2) @ right[..., None]))[..., 0]
            radii = numpy.sqrt(numpy.maximum(solution[:, 3] + numpy.sum(solution[:, :3] ** 2, axis=1), 0.0))
            offset = (chosen - centre) - solution[:, None, :3]
            residuals = abs(numpy.linalg.norm(offset, axis=2) - radii[:, None])
            subsets = numpy.argpartition(residuals, size, axis=1)[:, :size]
        sums = numpy.take_along_axis(residuals, subsets, axis=1)
        order = numpy.sum(sums**2, axis=1).argsort(kind="stable")[:_FINALISTS]
        subsets = subsets[order]
    best = order[0]
    scatter = float(numpy.partition(residuals[best], size)[size]) / _TRIMMED_SIGMA
    return centre + solution[best, :3], float(radii[best]), scatter


def _refine(local: _Neighbourhoods, start: tuple[Numbers, float, float]) -> _Unworn:
    """Fit the sphere to all points that are not worn, without a margin around the worn ones."""
    points, (centre, radius, scatter) = local.points, start
    limit, before = _WORN_SIGMAS * max(scatter, _RESOLUTION), numpy.zeros(len(points), dtype=bool)
    for _ in range(_PASSES):
        mask = abs(local.depth(centre, radius)) < limit
        if mask.sum() < 8:
            break
        inner = _grown(points, centre, ~mask, _SMOOTHING)
        mask = inner if inner.sum() > 0.5 * mask.sum() else mask
        if (mask == before).all():
            break
        before = mask
        centre, radius = fit_sphere(points[mask])
        limit = _WORN_SIGMAS * max(robust_scale(local.depth(centre, radius)[mask]), _RESOLUTION)
    return _Unworn(centre=centre, radius=radius, mask=mask, limit=limit)


def _grown(points: Numbers, centre: Numbers, off: Numbers, margin: float) -> Numbers:
    """Return the mask of the points that are farther than a margin in rad from those off the sphere.

    A point without neighbours off the sphere does not count as off it.
    """
    from scipy.spatial import cKDTree  # slow to import

    if not off.any() or off.all():
        return ~off
    radial, _ = polar(points, centre)
    neighbours = cKDTree(radial).query(radial[off], k=min(_NEIGHBOURS, len(points)))[1]
    worn = radial[off][off[neighbours].mean(axis=1) > 0.5]
    if not len(worn):
        return numpy.ones(len(points), dtype=bool)
    distance, _ = cKDTree(worn).query(radial)
    mask: Numbers = distance > margin
    return mask


def _check_bore(local: _Neighbourhoods, sphere: _Unworn, name: str) -> None:
    low, high = RADII
    depth = polar(local.points, sphere.centre)[1] - sphere.radius
    smoothed = local.smooth(depth)
    scatter = sphere.limit / _WORN_SIGMAS
    if not low <= sphere.radius <= high or scatter > _MAX_FORM * sphere.radius:
        raise ValueError(
            f"{name} is not a bore: its points lie {scatter:.2g} mm (standard deviation) off the best sphere, of "
            f"radius {sphere.radius:.4g} mm; a bore has {low:g} to {high:g} mm, and its file nothing else"
        )
    unworn = float(numpy.mean(sphere.mask))
    if unworn < _MIN_UNWORN:
        raise ValueError(
            f"{name}: only {100 * unworn:.0f} % of the points lie on a common sphere: without an unworn part the "
            "original bore is not known"
        )
    inside = smoothed < -2.0 * sphere.limit
    if inside.mean() > _MAX_INSIDE:
        raise ValueError(
            f"{name} is not a worn bore: {100 * float(inside.mean()):.0f} % of its points lie inside the sphere of "
            f"radius {sphere.radius:.2f} mm of the others, by up to {-smoothed.min():.2g} mm; wear makes a bore "
            "larger: leave out everything but the bore"
        )
    if numpy.quantile(depth, 0.99) > _MAX_DEPTH * sphere.radius:
        raise ValueError(
            f"{name} has points {depth.max():.3g} mm outside the sphere of radius {sphere.radius:.2f} mm of its bore: "
            "leave out everything but the bore"
        )


def _vertex_areas(radial: Numbers, pole: Numbers) -> Numbers:
    """Return the solid angle in sr of each of the unit vectors (n, 3), from triangles between them.

    The triangles are those of the convex hull that the antipode of the pole is not outside of: Delaunay's in the
    stereographic plane. Triangles across wide gaps are left out. Solid angles follow Van Oosterom and Strackee (1983,
    doi:10.1109/TBME.1983.325207).
    """
    from scipy.spatial import ConvexHull  # slow to import

    hull = ConvexHull(radial)
    corners = hull.simplices[hull.equations @ [*-pole, 1.0] <= 0.0]
    a, b, c = radial[corners].transpose(1, 0, 2)
    sides = numpy.stack(
        [numpy.linalg.norm(a - b, axis=1), numpy.linalg.norm(b - c, axis=1), numpy.linalg.norm(c - a, axis=1)]
    )
    volume = abs(numpy.sum(a * numpy.cross(b, c), axis=1))
    solid = 2.0 * numpy.arctan2(volume, 1.0 + numpy.sum(a * b + b * c + c * a, axis=1))
    solid[sides.max(axis=0) > _MAX_GAP] = 0.0
    return numpy.bincount(corners.ravel(), numpy.repeat(solid / 3.0, 3), minlength=len(radial))


def _deepest(radial: Numbers, depth: Numbers, smoothed: Numbers) -> tuple[Numbers, float, Numbers]:
    """Find direction, depth and weights (n,) of the deepest wear, by a paraboloid within 10° of the deepest point."""
    top = radial[smoothed.argmax()]
    x, y = (radial @ tangent for tangent in tangents(top))
    near = numpy.flatnonzero(radial @ top > min(cos(_PATCH), float(numpy.sort(radial @ top)[-30])) - 1e-12)
    terms = numpy.column_stack([numpy.ones(len(near)), x[near], y[near], x[near] ** 2, x[near] * y[near], y[near] ** 2])
    inverse = numpy.linalg.pinv(terms)
    hat = terms @ inverse
    place = int((hat @ depth[near]).argmax())
    weights = numpy.zeros(len(radial))
    weights[near] = hat[place]
    return radial[near[place]], float(weights @ depth), weights


@dataclass(frozen=True, eq=False)
class _Errors:
    """Propagation of the scatter of points, and of patches of the unworn part, to sums over the depths."""

    jacobian: Numbers
    inverse: Numbers
    mask: Numbers
    boxes: Numbers
    noise: float
    form: float

    @classmethod
    def of(cls, local: _Neighbourhoods, sphere: _Unworn) -> _Errors:
        """Estimate the errors of form from the mean depths of patches of the unworn part."""
        radial, distance = polar(local.points, sphere.centre)
        depth, mask = distance - sphere.radius, sphere.mask
        noise = local.noise(depth, mask)
        jacobian = numpy.column_stack([radial, numpy.ones(len(radial))])
        boxes = _boxes(radial, _PATCH)
        counts = numpy.bincount(boxes, mask)
        patches = counts >= 3
        means = numpy.bincount(boxes, mask * depth)[patches] / counts[patches]
        freedom = max(len(means) - 4, 1)
        excess = float(numpy.sum(means**2)) / freedom - float(numpy.mean(noise**2 / counts[patches]))
        inverse = numpy.linalg.pinv(jacobian[mask].T @ jacobian[mask])
        return cls(jacobian, inverse, mask, boxes, noise, float(numpy.sqrt(max(excess, 0.0))))

    def of_sum(self, weights: Numbers) -> float:
        """Return the standard error of a sum of depths with weights (n,)."""
        return self._scatter(weights - self.mask * (self.jacobian @ (self.inverse @ (weights @ self.jacobian))))

    def of_radius(self) -> float:
        """Return the error of the radius in mm: two standard errors, and the error of form."""
        scatter = self._scatter(self.mask * (self.jacobian @ self.inverse[:, 3]))
        return _SIGMAS * scatter + _FORM_FACTOR * (self.form + _RESOLUTION)

    def _scatter(self, factors: Numbers) -> float:
        """Return the standard deviation of a sum of errors with factors (n,): of points, and the same in a patch."""
        patches = numpy.bincount(self.boxes, factors)
        return float(numpy.sqrt(self.noise**2 * (factors @ factors) + self.form**2 * (patches @ patches)))
