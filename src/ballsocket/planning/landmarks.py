"""Landmarks of a pelvis from files of 3D Slicer: named points in mm, to the right, to the front and upwards (RAS)."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import refusals_of, shown
from ..core.display import counted
from ..core.input_files import read_input
from ..core.records import Input
from ..files.cells import decode_text
from ..problem.cup import Side
from .surfaces import LENGTH_UNITS, MICRON

_MAX_FILE_SIZE = 10_000_000  # largest size of a landmark file in bytes
_MAX_POINTS = 10_000
_MAX_COORDINATE = 1e5  # mm
_SIGNS = MappingProxyType({"RAS": (1.0, 1.0, 1.0), "LPS": (-1.0, -1.0, 1.0)})  # factors to RAS
_NUMBERED_SYSTEMS = MappingProxyType({"0": "RAS", "1": "LPS"})  # coordinate systems by their numbers in older files
_SIDES = MappingProxyType({"right": ("right", "r"), "left": ("left", "l")})
_ASIS = ("asis", "sias", "anteriorsuperioriliacspine")
_TUBERCLE = ("pubictubercle", "tubercle", "pt")
_SYMPHYSIS = ("pubicsymphysis", "symphysis", "symphysispubis", "ps")
_RIM = re.compile("(?P<side>right|r|left|l)?(cup|liner|acetabular|acetabulum)?rim")


def _with_side(side: str, names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(text for word in _SIDES[side] for name in names for text in (word + name, name + word))


ROLES = MappingProxyType(
    {
        "right_asis": _with_side("right", _ASIS),
        "left_asis": _with_side("left", _ASIS),
        "symphysis": _SYMPHYSIS,
        "right_tubercle": _with_side("right", _TUBERCLE),
        "left_tubercle": _with_side("left", _TUBERCLE),
    }
)
"""Names of each landmark in files, in small letters without other characters."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Landmarks(Input):
    """Named points of a patient.

    Attributes
    ----------
    names : tuple of str
        Names as in the file; several points may have one name.
    points : array (n, 3)
        Coordinates in mm: to the right, to the front, upwards (RAS).
    """

    names: tuple[str, ...]
    points: Numbers

    def find(self, role: str) -> Numbers | None:
        """Return the point (3,) of a role, such as "right_asis"; None without one.

        Raises ValueError: several points have the role.
        """
        allowed = (_squeeze(role), *ROLES[role])
        indices = [index for index, name in enumerate(self.names) if _squeeze(name) in allowed]
        if len(indices) > 1:
            names = ", ".join(self.names[index] for index in indices)
            raise ValueError(f"{len(indices)} points are the landmark {role}: {names}; one is needed")
        return self.points[indices[0]] if indices else None

    def rim(self, side: Side | None = None) -> tuple[tuple[str, ...], Numbers, Side | None]:
        """Return the names and points of the cup's rim, and the side that their names have.

        Points of the rim have names that begin with "rim", after "cup", "liner" or "acetabular" and a side if needed:
        "rim-1", "cup rim 2", "left rim 3".

        Raises ValueError: points of both sides without `side`.
        """
        sides: dict[int, str | None] = {}
        for index, name in enumerate(map(_squeeze, self.names)):
            match = _RIM.match(name)
            if match is not None:  # the side stands before the rim, or is the last word
                begins, end = match["side"] or "", name.rstrip("0123456789")
                words = (word for word in _SIDES if begins[:1] == word[0] or end.endswith(word))
                sides[index] = next(words, None)
        stated = {word for word in sides.values() if word}
        if side is None and len(stated) > 1:
            raise ValueError("the landmarks have rim points of both sides: choose the side, right or left")
        chosen = side.value if side else next(iter(stated), None)
        indices = [index for index, word in sides.items() if word is None or word == chosen]
        named = Side(chosen) if chosen in stated else None
        return tuple(self.names[index] for index in indices), self.points[indices], named


def read_side(side: Side | str | None) -> Side | None:
    """Return a side of the body by its word; raise ValueError for another word."""
    try:
        return None if side is None else Side(side)
    except ValueError as error:
        raise ValueError(f"side = {shown(side)} is not allowed: right or left") from error


def _squeeze(name: str) -> str:
    """Return the letters and digits of a name, in small letters."""
    return "".join(char for char in name.lower() if char.isalnum())


def read_landmarks(
    *paths: str | Path, coordinates: str | None = None, rename: Mapping[str, str] | None = None
) -> Landmarks:
    """Read the points of 3D Slicer files, `.fcsv` or `.mrk.json`.

    Parameters
    ----------
    *paths : str or Path
        Files; their points are joined.
    coordinates : str, optional
        "RAS" or "LPS", for files that do not state their coordinate system. It is refused for other files.
    rename : mapping of str to str, optional
        Name of a point in a file by its landmark: `{"right_asis": "F-1"}`.

    Returns
    -------
    Landmarks
        Points in mm, RAS.

    Raises
    ------
    ValueError
        One sentence: the error, with the name of the file.
    OSError
        A file cannot be read.
    """
    if coordinates is not None and coordinates.upper() not in _SIGNS:
        raise ValueError(f"coordinates = {shown(coordinates)} is not allowed: RAS or LPS")
    named: list[tuple[str, Numbers]] = []
    for path in map(Path, paths):
        read = _READERS.get("".join(path.suffixes[-2:]).lower()) or _READERS.get(path.suffix.lower())
        if read is None:
            raise ValueError(f"{path.name}: landmarks are read from .fcsv and .mrk.json files of 3D Slicer")
        raw = read_input(path, _MAX_FILE_SIZE)
        with refusals_of(path.name, (ValueError, csv.Error)):
            points = list(read(decode_text(raw), coordinates and coordinates.upper()))
        if not points:
            raise ValueError(f"{path.name} has no points")
        named += points
    if len(named) > _MAX_POINTS:
        raise ValueError(f"{len(named)} landmarks: at most {_MAX_POINTS} are read")
    names = [name for name, _ in named]
    for role, name in (rename or {}).items():
        if role not in ROLES and not _RIM.match(_squeeze(role)):
            raise ValueError(f"landmark {shown(role)} is not known: {', '.join(ROLES)} or rim")
        if name not in names:
            raise ValueError(f"point {shown(name)} does not exist; the points are {_list(names)}")
        names = [role if present == name else present for present in names]
    return Landmarks(names=tuple(names), points=numpy.array([point for _, point in named]).reshape(-1, 3))


def _list(names: list[str] | tuple[str, ...]) -> str:
    return ", ".join(shown(name)[1:-1] for name in names[:20]) + (" ..." if len(names) > 20 else "") or "none"


def missing_landmarks(landmarks: Landmarks, needed: str) -> ValueError:
    """Create the error for landmarks that do not exist, with the names of those that do."""
    return ValueError(f"the landmarks lack {needed}; the points are {_list(landmarks.names)}")


def _signs(stated: Any, coordinates: str | None) -> Numbers:
    if stated is None and coordinates is None:
        raise ValueError("the file states no coordinate system: give it, RAS or LPS")
    if stated is None:
        return numpy.array(_SIGNS[str(coordinates)])
    word = str(stated).strip().upper()
    system = _NUMBERED_SYSTEMS.get(word, word)
    if system not in _SIGNS:
        raise ValueError(f"coordinate system {shown(stated)} is not read: RAS (0) or LPS (1)")
    if coordinates is not None and system != coordinates:
        raise ValueError(f"the file states {system} coordinates, not {coordinates}")
    return numpy.array(_SIGNS[system])


def _point(name: str, values: Any) -> Numbers:
    try:
        point = numpy.array([float(value) for value in values])
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"point {shown(name)} has no three numbers: {shown(values)}") from error
    if point.shape != (3,):
        raise ValueError(f"point {shown(name)} needs three coordinates, got {len(point)}")
    if not (abs(point) <= _MAX_COORDINATE).all():
        text = ", ".join(f"{value:g}" for value in point)
        raise ValueError(f"point {shown(name)} at {text} is not allowed: coordinates are finite, at most 100 m")
    return point


_DEFAULT_COLUMNS = ("id", "x", "y", "z", "ow", "ox", "oy", "oz", "vis", "sel", "lock", "label")


def _read_fcsv(text: str, coordinates: str | None) -> Iterator[tuple[str, Numbers]]:
    """Yield names and points of an .fcsv file: version 4 with ids, or 3 with the label first."""
    header, rows = {}, []
    for line in text.splitlines():
        if line.startswith("#"):
            key, _, value = line[1:].partition("=")
            header[key.strip().lower()] = value.strip()
        elif line.strip():
            rows.append(line)
    columns = tuple(word.strip().lower() for word in header.get("columns", ",".join(_DEFAULT_COLUMNS)).split(","))
    missing = [name for name in ("x", "y", "z", "label") if name not in columns]
    if missing:
        raise ValueError(f"the columns lack {', '.join(missing)}: {shown(header['columns'])}")
    signs = _signs(header.get("coordinatesystem"), coordinates)
    for cells in csv.reader(rows):
        if len(cells) <= max(columns.index(name) for name in ("x", "y", "z", "label")):
            raise ValueError(f"a row of {counted(len(cells), 'column')} is incomplete: {shown(','.join(cells))}")
        name = cells[columns.index("label")].strip()
        yield name, signs * _point(name, [cells[columns.index(axis)] for axis in "xyz"])


def _read_markups(text: str, coordinates: str | None) -> Iterator[tuple[str, Numbers]]:
    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError("not JSON, or truncated") from error
    markups = content.get("markups") if isinstance(content, dict) else None
    if not isinstance(markups, list) or not all(isinstance(markup, dict) for markup in markups):
        raise ValueError("the list `markups` of a 3D Slicer file is missing")
    for markup in markups:
        signs, unit = _signs(markup.get("coordinateSystem"), coordinates), markup.get("coordinateUnits", "mm")
        units = {MICRON.get(str(word), str(word)) for word in (unit if isinstance(unit, list) else [unit])}
        if len(units) != 1 or not units <= set(LENGTH_UNITS):
            raise ValueError(f"coordinateUnits = {shown(unit)} is not allowed: {', '.join(LENGTH_UNITS)}")
        (length,) = (LENGTH_UNITS[word] for word in units)
        for point in markup.get("controlPoints") or ():
            if not isinstance(point, dict):
                raise ValueError(f"a control point is not an object: {shown(point)}")
            if point.get("positionStatus", "defined") == "defined":
                name = str(point.get("label", ""))
                yield name, signs * length * _point(name, point.get("position"))


_READERS = {".fcsv": _read_fcsv, ".mrk.json": _read_markups, ".json": _read_markups}
