"""Bores that are no spheres: ovals, tables of a measured depth, scans."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import inf, pi, radians
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers
from ..checks import needs, require
from .directions import polar_angle, tangents

if TYPE_CHECKING:
    from scipy.interpolate import RegularGridInterpolator


@dataclass(frozen=True, kw_only=True)
class Pinched:
    """A bore that a press fit has squeezed to an oval, by as much at the equator as the diameter lost.

    Parameters
    ----------
    squeeze : float
        In mm: the diameter across the press fit is smaller by this, the one across it larger.
    direction : float
        Azimuth in rad of the squeezed diameter, from the cup's x.

    Raises
    ------
    ValueError
        A number that is not finite.

    Examples
    --------
    A shell that its press fit pinches by 60 µm in diameter:

    >>> import numpy
    >>> Pinched(squeeze=0.06).depth(numpy.eye(3)).round(3) + 0.0
    array([-0.03,  0.03,  0.  ])
    """

    squeeze: float
    direction: float = 0.0

    def __post_init__(self) -> None:
        require("squeeze", self.squeeze, abs(self.squeeze) < inf, "a squeeze (mm) is finite")
        require("direction", self.direction, abs(self.direction) <= 2 * pi, "a direction (rad) is at most 2 pi")

    def depth(self, directions: Numbers) -> Numbers:
        x, y, _ = directions
        twice = (x * x - y * y) * numpy.cos(2 * self.direction) + 2 * x * y * numpy.sin(2 * self.direction)
        depth: Numbers = -self.squeeze / 2 * twice
        return depth


class _Measured:
    """A depth between measured points, which takes its time: that at the last directions is remembered."""

    def depth(self, directions: Numbers) -> Numbers:
        """In mm, positive where material is missing, at unit vectors (3, ...) in the cup's frame."""
        if directions.flags.writeable:
            return self._between_points(directions)
        last, found = vars(self).get("_last", (None, None))
        if last is not directions:
            found = self._between_points(directions)
            vars(self)["_last"] = directions, found
        depth: Numbers = found
        return depth

    @abstractmethod
    def _between_points(self, directions: Numbers) -> Numbers:
        """The depth in mm at unit vectors (3, ...)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DepthTable(_Measured):
    """A depth that is known at polar angles and azimuths, linear between them.

    Parameters
    ----------
    polar : array (angles,)
        From the dome's pole in rad, ascending; beyond the last the depth is that at the last.
    azimuth : array (azimuths,)
        Around the cup's axis from its x in rad, ascending within one turn; it closes upon itself.
    values : array (angles, azimuths)
        In mm, positive where material is missing.

    Raises
    ------
    ValueError
        Shapes that do not fit, angles that do not ascend or can only be degrees, a depth that is not finite.
    """

    polar: Numbers
    azimuth: Numbers
    values: Numbers

    def __post_init__(self) -> None:
        for name in ("polar", "azimuth", "values"):
            object.__setattr__(self, name, numpy.asarray(getattr(self, name), dtype=float))
        for name, most in (("polar", pi), ("azimuth", 2 * pi)):
            angles = getattr(self, name)
            if angles.ndim != 1 or len(angles) < 2:
                raise ValueError(f"{name} of shape {angles.shape} is not allowed: two angles and more in a row")
            require(name, angles, abs(angles) <= most + 1e-9, f"an angle is in radians, at most {most:.4g}")
            require(name, angles, numpy.append(True, numpy.diff(angles) > 0), "angles ascend")
        if self.values.shape != (len(self.polar), len(self.azimuth)):
            raise ValueError(
                f"values of shape {self.values.shape} are not allowed: one row a polar angle, one column an azimuth"
            )
        require("values", self.values, numpy.isfinite(self.values), "a depth (mm) is finite")

    @cached_property
    def _between(self) -> RegularGridInterpolator:
        from scipy.interpolate import RegularGridInterpolator

        around = numpy.concatenate([self.azimuth, [self.azimuth[0] + 2 * pi]])
        rows = numpy.hstack([self.values, self.values[:, :1]])
        if self.azimuth[-1] - self.azimuth[0] >= 2 * pi - 1e-9:
            around, rows = self.azimuth, self.values
        return RegularGridInterpolator((self.polar, around), rows)

    def _between_points(self, directions: Numbers) -> Numbers:
        x, y, _ = directions
        polar = numpy.clip(polar_angle(directions), self.polar[0], self.polar[-1])
        first = self._between.grid[1][0]
        azimuth = first + (numpy.arctan2(y, x) - first) % (2 * pi)
        table: Numbers = self._between(numpy.stack([polar, azimuth], axis=-1))
        return table


@dataclass(frozen=True, kw_only=True, eq=False)
class Scan(_Measured):
    """A bore as it was measured: the sphere that fits it best, and how the surface deviates from that.

    Attributes
    ----------
    radius : float
        Of the sphere in mm.
    centre : array (3,)
        In mm, in the scan's frame.
    axis : array (3,)
        Unit vector from the centre to the middle of what was scanned: the dome's pole.
    reach : float
        The polar angle in rad that the scan covers.
    roughness : float
        Root mean square of the deviations, in mm.
    directions, deviation : array (3, points), (points,)
        Unit vectors in the cup's frame, and how much deeper than the sphere the surface is there, in mm.
    """

    radius: float
    centre: Numbers
    axis: Numbers
    reach: float
    roughness: float
    directions: Numbers
    deviation: Numbers

    def _between_points(self, directions: Numbers) -> Numbers:
        """From the nearest points, weighted by the inverse square of their distance; as far as the scan goes."""
        far, which = self._tree.query(numpy.moveaxis(directions, 0, -1), k=_NEAREST)
        weights = 1 / (far**2 + (_BLUNT * self._spacing) ** 2)
        depth: Numbers = (weights * self.deviation[which]).sum(axis=-1) / weights.sum(axis=-1)
        return depth

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(self.directions.T)

    @property
    def _spacing(self) -> float:
        """About how far the points are from each other, in rad."""
        return float(numpy.sqrt(2 * pi * (1 - numpy.cos(self.reach)) / len(self.deviation)))


_NEAREST, _BLUNT = 6, 0.5
_FEWEST = 200
_NARROWEST = radians(25.0)
_ROUGHEST = 0.03


def read_scan(path: str | Path) -> Scan:
    """A scan of a bore from a mesh of triangles (STL, PLY, OBJ) in mm.

    The sphere is the least-squares fit to the points; the cup's axis runs from its centre to the middle of what was
    scanned. Only the bore may be in the file, not the cup's outside.

    Raises
    ------
    ValueError
        What is no mesh; fewer than 200 points; points that lie on no sphere, or on a piece of one that is narrower
        than 25° or seen from outside.
    OSError
        The file cannot be read.
    """
    needs("fem", "meshio")
    import meshio

    path = Path(path)
    try:
        with numpy.errstate(all="ignore"):
            mesh = meshio.read(path)
    except (meshio.ReadError, ValueError, KeyError, IndexError, UnicodeDecodeError, SystemExit) as error:
        raise ValueError(f"{path.name} is no mesh that can be read: {error or type(error).__name__}") from error
    return scan_of(numpy.unique(numpy.asarray(mesh.points, dtype=float)[:, :3], axis=0), path.name)


def scan_of(points: Numbers, name: str = "the scan") -> Scan:
    """A scan from its points (points, 3) in mm; see `read_scan`."""
    require(f"points of {name}", len(points), len(points) >= _FEWEST, f"a scan has {_FEWEST} points and more")
    require(f"points of {name}", points, numpy.isfinite(points), "a point is finite")
    centre, radius = _fitted(points)
    out = points - centre
    length = numpy.linalg.norm(out, axis=1)
    roughness = float(numpy.sqrt(numpy.mean((length - radius) ** 2)))
    round_enough = f"{name} is not a bore: its points lie {roughness:.3g} mm off a sphere of {radius:.4g} mm"
    if not roughness < _ROUGHEST * radius:
        raise ValueError(round_enough)
    middle = (out / length[:, None]).mean(axis=0)
    size = float(numpy.linalg.norm(middle))
    if size < 1e-3:
        raise ValueError(f"{name} is not a bore: its points go all around")
    axis = middle / size
    directions = numpy.stack([*tangents(axis), axis]) @ (out / length[:, None]).T
    reach = float(numpy.arccos(numpy.clip(directions[2], -1, 1)).max())
    if reach < _NARROWEST:
        raise ValueError(f"{name} covers {numpy.degrees(reach):.0f}° around its pole; a bore takes 25° and more")
    return Scan(
        radius=radius,
        centre=centre,
        axis=axis,
        reach=reach,
        roughness=roughness,
        directions=directions,
        deviation=length - radius,
    )


def _fitted(points: Numbers) -> tuple[Numbers, float]:
    """Centre and radius of the sphere nearest to the points: linear least squares, then of the distances."""
    from scipy.optimize import least_squares

    rows = numpy.hstack([2 * points, numpy.ones((len(points), 1))])
    first = numpy.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
    start = numpy.append(first[:3], numpy.sqrt(max(first[3] + first[:3] @ first[:3], 1e-12)))

    def off(x: Numbers) -> Numbers:
        away: Numbers = numpy.linalg.norm(points - x[:3], axis=1) - x[3]
        return away

    found = least_squares(off, start).x
    return found[:3], float(found[3])
