"""Export of a study to NetCDF or CSV, and access to its points in chunks."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy

from ..core.checks import needs
from ..core.quantities import QUANTITIES
from ..core.storage.atomic_files import check_parent_folder, write_atomically
from .task import Blocks

if TYPE_CHECKING:
    import xarray

SUFFIXES = (".nc", ".csv")
"""Endings of the file names of exports."""

_MAX_CHUNK_POINTS = 1 << 18
"""Largest number of points of a chunk."""

_QUOTED_CHARACTERS = set(',"\r\n')
"""Characters that only a quoted cell may contain."""


def dimension_names(study: xarray.Dataset) -> tuple[str, ...]:
    """Return the names of the dimensions of a study, in the order of its arrays."""
    return tuple(str(dim) for dim in next(iter(study.data_vars.values())).dims)


def _chunk_blocks(study: xarray.Dataset) -> Blocks:
    """Divide a study into chunks that fit into the memory."""
    return Blocks.divide(tuple(study.sizes[dim] for dim in dimension_names(study)), _MAX_CHUNK_POINTS)


def iterate_chunks(study: xarray.Dataset) -> Iterator[xarray.Dataset]:
    """Load the chunks of a study one after the other, in the order of the points; the last dimension varies fastest."""
    dims, blocks = dimension_names(study), _chunk_blocks(study)
    for number in range(len(blocks)):
        yield study.isel(dict(zip(dims, blocks[number], strict=True))).load()


def check_suffix(path: Path) -> None:
    """Check that a path ends like a format of exports, and that its folder exists; raise ValueError otherwise."""
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{str(path)!r} must end in {' or '.join(SUFFIXES)}")
    check_parent_folder(path)


def export(study: xarray.Dataset, path: str | Path) -> None:
    """Write a study to a NetCDF (.nc) or CSV (.csv) file, in chunks; the file appears when it is complete.

    CSV has a row for each point: first the parameters in the order of the design, then the quantities. Column names
    end in their units: `ball_radius_mm`, `max_pressure_MPa`, `half_angle_deg`.

    Raises
    ------
    ValueError
        A path with another ending, or no such folder.
    OSError
        The file cannot be written.
    """
    path = Path(path)
    check_suffix(path)
    with write_atomically(path) as draft:
        if path.suffix.lower() == ".nc":
            needs("study", "h5netcdf")
            plain = study.assign_attrs({key: value for key, value in study.attrs.items() if isinstance(value, str)})
            plain.attrs.pop("study", None)
            chunked = plain.chunk(dict(zip(dimension_names(study), _chunk_blocks(study).size, strict=True)))
            chunked.to_netcdf(draft, engine="h5netcdf")
        else:
            _write_csv(study, draft)


def _write_csv(study: xarray.Dataset, path: Path) -> None:
    """Write a study to a CSV file."""
    names = [str(name) for name in (*study.coords, *study.data_vars)]
    dims = dimension_names(study)
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(map(_column_head, names)) + "\n")
        for chunk in iterate_chunks(study):
            variables = (variable.broadcast_like(chunk[names[-1]]) for variable in map(chunk.__getitem__, names))
            columns = [variable.transpose(*dims).values.ravel() for variable in variables]
            written = (_in_written_unit(name, column) for name, column in zip(names, columns, strict=True))
            stream.writelines(",".join(map(_cell_text, row)) + "\n" for row in zip(*written, strict=True))


def _column_head(name: str) -> str:
    """Return the head of a variable's column, with its unit."""
    return QUANTITIES[name].column if name in QUANTITIES else name


def _in_written_unit(name: str, column: numpy.ndarray) -> numpy.ndarray:
    """Convert a column from internal units to the units of files."""
    return column * QUANTITIES[name].written.factor if name in QUANTITIES else column


def _cell_text(value: object) -> str:
    """Format a value as a cell of a CSV file."""
    if isinstance(value, numpy.bool_):
        return "1" if value else "0"
    if isinstance(value, str):
        return '"{}"'.format(value.replace('"', '""')) if _QUOTED_CHARACTERS & set(value) else str(value)
    return repr(value.item()) if isinstance(value, numpy.generic) else str(value)
