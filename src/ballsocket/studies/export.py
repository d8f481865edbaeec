"""A study as a file for other programs: NetCDF, or CSV with a row a point."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy

from ..core.checks import needs
from ..core.quantities import QUANTITIES
from ..core.storage.atomic_files import check_parent_folder, write_atomically
from .pieces import blocks_of, dims_of, pieces

if TYPE_CHECKING:
    import xarray

_SPECIAL = set(',"\r\n')  # what only a cell in quotes may have
SUFFIXES = (".nc", ".csv")


def check_suffix(path: Path) -> None:
    """Raise ValueError unless `path` ends like a format that is written, in a folder that is there."""
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{str(path)!r} must end in {' or '.join(SUFFIXES)}")
    check_parent_folder(path)


def export(study: xarray.Dataset, path: str | Path) -> None:
    """Write a study as NetCDF (.nc) or CSV (.csv), part by part. The file appears at once.

    CSV has a row a point, the parameters first, in the order of the design; the names of its columns end in their
    units, `ball_radius_mm`, `max_pressure_MPa`, `half_angle_deg`.

    Raises
    ------
    ValueError
        A path that ends like no known format.
    OSError
        It cannot be written.
    """
    path = Path(path)
    check_suffix(path)
    with write_atomically(path) as draft:
        if path.suffix.lower() == ".nc":
            needs("study", "h5netcdf")
            plain = study.assign_attrs({key: value for key, value in study.attrs.items() if isinstance(value, str)})
            plain.attrs.pop("study", None)
            parted = plain.chunk(dict(zip(dims_of(study), blocks_of(study).size, strict=True)))
            parted.to_netcdf(draft, engine="h5netcdf")
        else:
            _write_csv(study, draft)


def _write_csv(study: xarray.Dataset, path: Path) -> None:
    names = [str(name) for name in (*study.coords, *study.data_vars)]
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(map(_head, names)) + "\n")
        for part in pieces(study):
            wide = (variable.broadcast_like(part[names[-1]]) for variable in map(part.__getitem__, names))
            columns = [each.transpose(*dims_of(study)).values.ravel() for each in wide]
            read = (_read(name, column) for name, column in zip(names, columns, strict=True))
            stream.writelines(",".join(map(_cell, row)) + "\n" for row in zip(*read, strict=True))


def _head(name: str) -> str:
    return QUANTITIES[name].column if name in QUANTITIES else name


def _read(name: str, column: numpy.ndarray) -> numpy.ndarray:
    return column * QUANTITIES[name].written.factor if name in QUANTITIES else column


def _cell(value: object) -> str:
    if isinstance(value, numpy.bool_):
        return "1" if value else "0"
    if isinstance(value, str):
        return '"{}"'.format(value.replace('"', '""')) if _SPECIAL & set(value) else str(value)
    return repr(value.item()) if isinstance(value, numpy.generic) else str(value)
