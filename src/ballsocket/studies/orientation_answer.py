"""Orientations of a cup within limits, and their description: a table of inclination and anteversion for each field."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import degrees
from typing import Any

import numpy

from ..core.answers import Answer, Column, Judged, Row, Table
from ..core.arrays import Numbers
from ..core.bounded import Verdict
from ..core.display import counted
from ..core.kinds import MILLIMETRES
from ..core.quantities import CONTACT, DERIVED
from ..core.unit_systems import Amount, Sentence
from ..core.validity import Status
from ..elasticity.off_axis.orientations import Orientations
from .limits import Limit

LIMITED_FIELDS = ("edge_distance", "max_pressure", "half_angle")  # fields of orientations that can be limited


def describe_orientations(orientations: Orientations, limits: Sequence[Limit] = ()) -> Answer:
    """Describe distance to the rim and largest pressure by orientation, the orientations within limits, the best ones.

    The half angle is a table if it has a limit. A number has the verdict on the limits of its quantity, or on all
    limits if its quantity has none; it is missing where the bore does not hold the ball.
    """
    tables = []
    limited = {limit.name for limit in limits}
    for quantity in (DERIVED["edge_distance"], CONTACT["max_pressure"], CONTACT["half_angle"]):
        if quantity.name == "half_angle" and quantity.name not in limited:
            continue
        marking = [limit for limit in limits if limit.name == quantity.name] or limits
        codes = verdicts(orientations, marking)
        heads = [angle_text(angle) for angle in orientations.inclination]
        column = replace(Column.of(quantity), decimals=1, title="")  # known to about 0.1 mm and 0.1 MPa
        columns = [replace(column, key=head, name=head, head=head) for head in heads]
        values = numpy.where(orientations.held, getattr(orientations, quantity.name), numpy.nan)
        rows = [
            Row([angle_text(angle), *(Judged(float(number), Verdict(code)) for number, code in pairs)])
            for angle, pairs in zip(orientations.anteversion, numpy.dstack([values.T, codes.T]), strict=True)
        ]
        corner = Column.of_words("anteversion", quantity.title)
        marks = Sentence("; marks: {}", _joined(marking)) if len(limits) > 1 else ""
        lines = [Sentence("columns: inclination, rows: anteversion{}", marks)]
        tables.append(Table(quantity.key, quantity.title, [corner, *columns], rows, lines))
    return Answer(
        title=str(orientations.joint),
        lines=[load_sentence(orientations)],
        tables=tables,
        notes=[*(_limit_sentences(orientations, limits) if limits else ()), *_sentences(orientations)],
    )


def load_sentence(orientations: Orientations) -> Sentence:
    """Describe the load with its direction in the body."""
    ((name, value),) = orientations.load.items()
    along = ", ".join(f"{part:g}" for part in orientations.model.direction)
    arc = angle_text(orientations.model.cup.arc_of_cover)
    load = Amount(value, CONTACT[name].shown)
    return Sentence("{} {} along {}; arc of cover {}", CONTACT[name].symbol, load, f"({along})", arc)


def verdicts(orientations: Orientations, limits: Sequence[Limit]) -> Numbers:
    """Return the code of the `Verdict` on all limits for each orientation.

    They are exceeded where the ball is not held, and limits are at best undecided where the model is not valid.
    """
    codes = numpy.where(orientations.held, int(Verdict.KEPT), int(Verdict.EXCEEDED))
    if limits:
        codes = numpy.where(orientations.held & ~orientations.valid, int(Verdict.UNDECIDED), codes)
    for limit in limits:
        codes = numpy.maximum(codes, orientations.error_bar(limit.name).decide(**limit.ends))
    return codes


def inclination_ranges(orientations: Orientations, codes: Numbers) -> list[tuple[float, float] | None]:
    """Find the inclinations whose `verdicts` are kept, for each anteversion.

    Returns
    -------
    list
        Ends in rad of the longest row of neighbouring inclinations within the limits; None without one.
    """
    ranges: list[tuple[float, float] | None] = []
    for within in (codes == Verdict.KEPT).T:
        edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[False], within, [False]]).astype(int)))
        pairs = list(zip(edges[::2], edges[1::2] - 1, strict=True))
        first, last = max(pairs, key=lambda pair: pair[1] - pair[0], default=(0, -1))
        ends = float(orientations.inclination[first]), float(orientations.inclination[last])
        ranges.append(ends if pairs else None)
    return ranges


def limits_summary(orientations: Orientations, limits: Sequence[Limit]) -> dict[str, Any]:
    """Return the limits and the orientations within them for JSON; empty without limits."""
    if not limits:
        return {}
    codes = verdicts(orientations, limits)
    rows = zip(orientations.anteversion, inclination_ranges(orientations, codes), strict=True)
    return {
        "limits": [str(limit) for limit in limits],
        "within_limits": (codes == Verdict.KEPT).tolist(),
        "verdicts": _verdict_words(codes),
        "verdicts_by_limit": {str(limit): _verdict_words(verdicts(orientations, [limit])) for limit in limits},
        "inclination_ranges": [
            {
                "anteversion_deg": round(degrees(angle), 9),
                "inclination_deg": None if ends is None else [round(degrees(end), 9) for end in ends],
            }
            for angle, ends in rows
        ],
    }


def _verdict_words(codes: Numbers) -> list[list[str]]:
    return [[Verdict(code).word for code in row] for row in codes.tolist()]


def _joined(limits: Sequence[Limit]) -> Sentence:
    return Sentence(" and ".join("{}" for _ in limits), *map(str, limits))


def _counts(codes: Numbers) -> list[int]:
    return [int((codes == verdict).sum()) for verdict in Verdict]


def _limit_sentences(orientations: Orientations, limits: Sequence[Limit]) -> Iterator[str]:
    """Yield sentences on the limits together and each, and on the inclinations within them.

    One sentence is for neighbouring anteversions of the same range.
    """
    codes = verdicts(orientations, limits)
    kept, undecided, _ = _counts(codes)
    text = f"kept in {kept} of {counted(codes.size, 'orientation')}, exceeded where *"
    yield Sentence("limit: {}; {}", _joined(limits), text)
    if undecided:
        orientations_text = counted(undecided, "orientation")
        yield f"undecided in {orientations_text} with ?: by the error bar, or outside the range of the model"
    for limit in limits if len(limits) > 1 else ():
        counts = zip(Verdict, _counts(verdicts(orientations, [limit])), strict=True)
        text = ", ".join(f"{verdict.word} in {count}" for verdict, count in counts if count)
        yield Sentence("{}: {}", str(limit), text)
    ranges = inclination_ranges(orientations, codes)
    starts = [row for row in range(len(ranges)) if row == 0 or ranges[row] != ranges[row - 1]]
    for first, following in zip(starts, [*starts[1:], len(ranges)], strict=True):
        angles = [angle_text(orientations.anteversion[row]) for row in (first, following - 1)]
        rows = angles[0] if following == first + 1 else f"{angles[0]} to {angles[1]}"
        yield f"at {rows} anteversion the limit is kept for certain {_range_text(orientations, ranges[first])}"


def _range_text(orientations: Orientations, ends: tuple[float, float] | None) -> str:
    low, high = (angle_text(orientations.inclination[index]) for index in (0, -1))
    if ends is None:
        return f"at no inclination from {low} to {high}"
    first, last = map(angle_text, ends)
    if (first, last) == (low, high):
        return f"at every inclination from {low} to {high}"
    step = angle_text(float(numpy.diff(orientations.inclination).max()))
    reach = f"up to {last}" if first == low else f"from {first} to {last}"
    return f"{reach} inclination (steps of {step})"


def _sentences(orientations: Orientations) -> Iterator[str]:
    """Yield sentences about the best orientations, loaded rims, failures and the duration."""
    distance, pressure, size = orientations.edge_distance, orientations.max_pressure, orientations.status.size
    if orientations.held.any():
        *angles, index = orientations.best(distance)
        farthest = Amount(float(distance.flat[index]), MILLIMETRES, decimals=1)
        yield Sentence(f"furthest from the rim: {{}} {_orientation_text(*angles)}", farthest)
    if (orientations.held & numpy.isfinite(pressure)).any():
        *angles, index = orientations.best(-pressure)
        least = Amount(float(pressure.flat[index]), CONTACT["max_pressure"].shown)
        yield Sentence(f"least pressure: {{}} {_orientation_text(*angles)}", least)
    loaded = int((orientations.edge_loaded & orientations.held).sum())
    if loaded:
        yield f"the rim is loaded in {loaded} of {counted(size, 'orientation')} (below 0: how far beyond first touch)"
    if numpy.isposinf(pressure).any():
        yield "inf: the end of the bore digs in, where the pressure is unbounded"
    yield from orientations.notes
    for status in Status:
        count = int((orientations.status == int(status)).sum())
        if status.failed and count:
            yield f"{count} of {size}: {status.sentence}"
    rings = angle_text(orientations.model.ring_width)
    yield f"{orientations.model.name}: rings of {rings}, {counted(size, 'orientation')} in {orientations.seconds:.2f} s"


def _orientation_text(inclination: float, anteversion: float) -> str:
    return f"at inclination {angle_text(inclination)}, anteversion {angle_text(anteversion)}"


def angle_text(angle: float) -> str:
    """Write an angle (rad) in degrees."""
    return f"{degrees(angle):.4g}°"
