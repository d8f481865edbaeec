"""A study as a file for other programs: NetCDF, or CSV with a row a point."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy

from ..checks import needs
from ..written import at_once

if TYPE_CHECKING:
    import xarray

SUFFIXES = (".nc", ".csv")
_ROWS = 1 << 18


def check_suffix(path: Path) -> None:
    """Raise ValueError unless `path` ends like a format that is written."""
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{str(path)!r} must end in {' or '.join(SUFFIXES)}")


def export(study: xarray.Dataset, path: str | Path) -> None:
    """Write a study as NetCDF (.nc) or CSV (.csv). The file appears at once.

    CSV has a row a point, the parameters first, in mm, N and MPa; half angles are in degrees, in a column whose name
    ends in `_deg`.

    Raises
    ------
    ValueError
        A path that ends like no known format.
    OSError
        It cannot be written.
    """
    path = Path(path)
    check_suffix(path)
    with at_once(path) as draft:
        if path.suffix.lower() == ".nc":
            needs("study", "h5netcdf")
            plain = study.assign_attrs({key: value for key, value in study.attrs.items() if isinstance(value, str)})
            plain.attrs.pop("study", None)
            plain.to_netcdf(draft, engine="h5netcdf")
        else:
            _write_csv(study, draft)


def _write_csv(study: xarray.Dataset, path: Path) -> None:
    names = [*study.coords, *study.data_vars]
    heads = [f"{name}_deg" if name == "half_angle" else str(name) for name in names]
    shape = tuple(study.sizes.values())
    columns = [numpy.broadcast_to(*_aligned(study[name], study)).ravel() for name in names]
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(heads) + "\n")
        for first in range(0, int(numpy.prod(shape)), _ROWS):
            part = [
                numpy.degrees(column[first : first + _ROWS]) if name == "half_angle" else column[first : first + _ROWS]
                for name, column in zip(names, columns, strict=True)
            ]
            stream.writelines(",".join(map(_cell, row)) + "\n" for row in zip(*part, strict=True))


def _aligned(variable: xarray.DataArray, study: xarray.Dataset) -> tuple[numpy.ndarray, tuple[int, ...]]:
    """Values with as many dimensions as the study, and its shape."""
    dims = tuple(study.sizes)
    shape = [study.sizes[dim] if dim in variable.dims else 1 for dim in dims]
    order = [dim for dim in dims if dim in variable.dims]
    return variable.transpose(*order).values.reshape(shape), tuple(study.sizes.values())


def _cell(value: object) -> str:
    if isinstance(value, numpy.bool_):
        return "1" if value else "0"
    return repr(value.item()) if isinstance(value, numpy.generic) else str(value)
