"""Mesh and stresses of a finite-element solution in section, and its pressure beside the exact one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy

from ....core.quantities import BEARING, JOINT
from ....elasticity.finite_elements.model import MeshedContact
from ....elasticity.finite_elements.section import Part
from ....files.joint_file import JointFile
from ....model_catalogue import JUDGE, reference
from ....reports.style import line_of
from ...pictures import svg
from ...pictures.chart import legend
from ...pressing import pressure_chart
from ...widgets.reading import Reading

_WIDTH, _MIDDLE, _REACH = 480.0, 240.0, 225.0
_TOP = 34.0
_MAX_EXTENT = 40.0  # largest distance (mm) behind the bore that is drawn; a massive socket has no end

_MAX_SHARE = 99.5
"""Percentile of the stresses in ball or backing at the end of the colours, which leaves out sharp corners."""

_MOVE, _CLOSE = 1, 79  # codes of a path in matplotlib


@dataclass(frozen=True, kw_only=True)
class StressBands:
    """Levels (MPa) of the von Mises stress in one kind of part, and the path of each band."""

    levels: tuple[float, ...]
    paths: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class SectionDrawing:
    """Mesh at the left and stresses at the right, as paths of a picture."""

    height: float
    mesh: str
    bands: Mapping[str, StressBands]


def section_drawing(contact: MeshedContact) -> SectionDrawing:
    """Draw mesh and stresses of a contact as paths."""
    section = contact.section
    parts = section.parts
    extent = min(max(float(part.position[0].max()) for part in parts), section.socket_radius + _MAX_EXTENT)
    scale, highest = _REACH / extent, max(float(part.position[1].max()) for part in parts)
    lowest = max(min(float(part.position[1].min()) for part in parts), -extent)

    def project(position: Any, side: float) -> numpy.ndarray:
        """Return picture coordinates (points, 2) of positions (2, points) at the left (-1) or right (1)."""
        return numpy.stack([_MIDDLE + side * scale * position[0], _TOP + scale * (highest - position[1])], axis=-1)

    bands = {}
    for kind in ("liner", "ball", "backing"):
        drawn = [part for part in parts if part.name.startswith(kind)]
        if drawn:
            peak = (
                section.peak_stress.von_mises
                if kind == "liner"
                else max(float(numpy.percentile(part.stress.von_mises, _MAX_SHARE)) for part in drawn)
            )
            levels = svg.levels_between(0.0, peak, 6)
            paths = zip(*(_bands(part, levels, project) for part in drawn), strict=True)
            bands[kind] = StressBands(levels=tuple(levels), paths=tuple("".join(parts) for parts in paths))
    mesh = "".join(_edges(part, project(part.position, -1.0)) for part in parts)
    return SectionDrawing(height=_TOP + scale * (highest - lowest) + 8, mesh=mesh, bands=bands)


def _edges(part: Part, points: numpy.ndarray) -> str:
    """Draw every edge of the elements once."""
    corners = part.elements[:4]
    edges = numpy.concatenate([numpy.stack([corners[a], corners[(a + 1) % 4]], axis=-1) for a in range(4)])
    starts, ends = points[numpy.unique(numpy.sort(edges, axis=1), axis=0).T]
    return "".join(
        f"M{x:.1f},{y:.1f}l{dx:.1f},{dy:.1f}" for (x, y), (dx, dy) in zip(starts, ends - starts, strict=True)
    )


def _bands(part: Part, levels: list[float], project: Any) -> list[str]:
    """Return the path of each band of the von Mises stress, the last one without an upper end."""
    from matplotlib.figure import Figure
    from matplotlib.tri import Triangulation

    a, b, c, d = part.elements[:4]
    triangles = numpy.concatenate([numpy.stack([a, b, c], -1), numpy.stack([a, c, d], -1)])
    triangulation = Triangulation(part.position[0], part.position[1], triangles)
    ends = [*levels[:-1], max(levels[-1], float(part.stress.von_mises.max()) * (1 + 1e-9))]
    filled = Figure().subplots().tricontourf(triangulation, part.stress.von_mises, levels=ends)
    return ["".join(_strokes(path, project)) for path in filled.get_paths()]


def _strokes(path: Any, project: Any) -> Iterator[str]:
    """Write a path of matplotlib as that of a picture."""
    if path.codes is None:
        return
    for (x, y), code in zip(project(path.vertices.T, 1.0), path.codes, strict=True):
        yield "Z" if code == _CLOSE else f"{'M' if code == _MOVE else 'L'}{x:.1f},{y:.1f}"


def section_picture(drawing: SectionDrawing, file: JointFile, reading: Reading) -> str:
    """Draw mesh and stresses with a colour scale for each kind of part, in the units of the page."""
    unit, count = reading.unit(BEARING["von_mises"]), len(drawing.bands)
    span = (_WIDTH - 20) / count
    parts = [
        f'<path class="mesh" d="{drawing.mesh}"/>',
        *(part for bands in drawing.bands.values() for part in _coloured(bands)),
        svg.line(_MIDDLE, 24, _MIDDLE, drawing.height, "edge"),
        svg.text(_MIDDLE - 12, 16, "mesh", "label", "end"),
        svg.text(_MIDDLE + 12, 16, "von Mises stress", "label", "start"),
    ]
    for number, (kind, bands) in enumerate(drawing.bands.items()):
        levels = [level * unit.factor for level in bands.levels]
        parts += svg.scale(levels, f"{kind} [{unit.text}]", 14 + span * number, drawing.height + 26, span - 28)
    sizes = [
        f"{JOINT[name].title} {reading.with_unit(JOINT[name], float(getattr(file.joint, name)))}"
        for name in ("head_diameter", "outer_diameter", "diametral_clearance")
    ]
    label = f"mesh and von Mises stress in section: {', '.join(sizes)}"
    return svg.picture((_WIDTH, drawing.height + 56), label, parts)


def _coloured(bands: StressBands) -> Iterator[str]:
    last = len(bands.paths) - 1
    for number, path in enumerate(bands.paths):
        yield f'<path fill="{svg.heat(number / max(last, 1))}" fill-rule="evenodd" d="{path}"/>'


def pressure_picture(pressures: Mapping[str, tuple[numpy.ndarray, numpy.ndarray]], reading: Reading) -> str:
    """Draw pressures (MPa) over angles (rad) by the names of their models."""
    names = {JUDGE: "finite elements", reference.name: "exact"}
    lines = {names[model]: line_of(model) for model in pressures}
    profiles = {names[model]: (*profile, True) for model, profile in pressures.items()}
    return f"{pressure_chart(profiles, lines, reading)}<p class='legend'>{legend(lines)}</p>"
