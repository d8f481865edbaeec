"""Export of a study to NetCDF, CSV, Parquet or Zarr, and access to its points in chunks."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Verdict
from ..core.checks import needs
from ..core.quantities import QUANTITIES
from ..core.storage.atomic_files import address_of, check_parent_folder, write_atomically
from ..core.storage.folders import folder_at, open_address
from ..core.validity import Status
from .metadata import derived_lengths, invalid_reasons, missing_reasons
from .task import BOUNDS, VERDICT, Blocks

if TYPE_CHECKING:
    import xarray

SUFFIXES = (".nc", ".csv", ".parquet", ".zarr")
"""Endings of the file names of exports."""

_MAX_CHUNK_POINTS = 1 << 18  # largest number of points of a chunk


def _chunk_blocks(study: xarray.Dataset) -> Blocks:
    return Blocks.divide(tuple(study.sizes[dim] for dim in study.status.dims), _MAX_CHUNK_POINTS)


def iterate_chunks(study: xarray.Dataset) -> Iterator[xarray.Dataset]:
    """Load the chunks of a study one after the other, in the order of the points; the last dimension varies fastest."""
    dims, blocks = study.status.dims, _chunk_blocks(study)
    for number in range(len(blocks)):
        yield study.isel(dict(zip(dims, blocks[number], strict=True))).load()


def check_suffix(path: Path) -> None:
    """Check that a path ends like a format of exports, and that a file can be written there.

    Raises ValueError: another ending, a folder that does not exist, or a Zarr group that exists.
    Raises ImportError: the library of a format, or of the remote store of an address, is missing.
    Raises OSError: the remote store of an address does not respond.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise ValueError(f"{str(path)!r} must end in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}")
    needs("study", *_LIBRARIES.get(suffix, ()))
    address = address_of(path)
    if address is None:
        check_parent_folder(path)
    if folder_at(path).exists() and suffix == ".zarr":
        raise ValueError(f"{address or path} exists: choose another name for the Zarr group, or remove it")


_LIBRARIES = {".nc": ("h5netcdf",), ".parquet": ("pyarrow",), ".zarr": ("zarr",)}


def export(study: xarray.Dataset, path: str | Path) -> None:
    """Write a study to a NetCDF (.nc), CSV (.csv), Parquet (.parquet) or Zarr (.zarr) file, in chunks.

    The file appears when it is complete. CSV and Parquet have a row for each point: first the parameters in the order
    of the design, then the lengths that follow from them, the quantities, and `why_not_valid`, the reason of an invalid
    point. A missing utilisation has its reason in `why_no_utilisation`. Column names end in their units:
    `ball_radius_mm`, `max_pressure_MPa`, `half_angle_deg`. NetCDF and Zarr have the labelled arrays of the study in mm,
    N, MPa, rad.

    Parameters
    ----------
    study : xarray.Dataset
        Result of `study`.
    path : path or str
        Local path, or address of a remote store that fsspec knows, such as "s3://bucket/hips.parquet". A file for an
        address is first written to a temporary folder.

    Raises
    ------
    ValueError
        A path with another ending, no such folder, or a Zarr group that exists.
    ImportError
        The library of a format, or of a remote store, is missing.
    OSError
        The file cannot be written.
    """
    check_suffix(Path(path))
    address = address_of(path)
    if address is not None:
        _upload(study, address)
        return
    path = Path(path)
    write: dict[str, Callable[[xarray.Dataset, Path], Any]] = {
        ".nc": lambda study, draft: _plain_dataset(study).to_netcdf(draft, engine="h5netcdf"),
        ".csv": _write_csv,
        ".parquet": _write_parquet,
        ".zarr": lambda study, draft: (
            _plain_dataset(study).drop_encoding().to_zarr(draft, zarr_format=3, consolidated=False)
        ),
    }
    with write_atomically(path) as draft:
        write[path.suffix.lower()](study, draft)


def _upload(study: xarray.Dataset, address: str) -> None:
    with TemporaryDirectory() as folder:
        local = Path(folder) / address.rpartition("/")[2]
        export(study, local)
        system, target = open_address(address)
        slash = "/" if local.is_dir() else ""
        try:
            system.put(f"{local}{slash}", f"{target}{slash}", recursive=True)
        except Exception as error:  # each store raises errors of its own
            raise OSError(None, f"cannot be written: {error}", address) from error


def _plain_dataset(study: xarray.Dataset) -> xarray.Dataset:
    """Return a study in chunks, with attributes of text only and without the encoding of its store."""
    plain = study.assign_attrs({key: value for key, value in study.attrs.items() if isinstance(value, str)})
    plain.attrs.pop("study", None)
    return plain.chunk(dict(zip(study.status.dims, _chunk_blocks(study).size, strict=True)))


def _write_parquet(study: xarray.Dataset, path: Path) -> None:
    import pyarrow
    from pyarrow import parquet

    metadata = {key: value for key, value in study.attrs.items() if isinstance(value, str)}
    writer = None
    try:
        for columns in _iterate_columns(study):
            table = pyarrow.table(columns)
            if writer is None:
                writer = parquet.ParquetWriter(path, table.schema.with_metadata(metadata), compression="zstd")
            writer.write_table(table.cast(writer.schema))
    finally:
        if writer is not None:
            writer.close()


def _iterate_columns(study: xarray.Dataset) -> Iterator[dict[str, numpy.ndarray]]:
    """Yield the columns of each chunk by their heads, in the units of files."""
    dims, reasons = study.status.dims, invalid_reasons(study)
    words = numpy.array([*(verdict.word for verdict in Verdict), "no result"])
    for chunk in iterate_chunks(study):
        variables: dict[Any, xarray.DataArray] = {**chunk.coords, **derived_lengths(chunk), **chunk.data_vars}
        values = {
            str(name): variable.broadcast_like(chunk.status).transpose(*dims).values.ravel()
            for name, variable in variables.items()
        }
        kinds = zip(values["status"].tolist(), values.pop("broken_limit").tolist(), strict=True)
        why = [reasons.get(kind, "") for kind in kinds]
        written = {}
        for name, column in values.items():
            quantity = BOUNDS.get(name) or QUANTITIES.get(name)
            if quantity is not None:
                written[quantity.column] = column * quantity.written.factor
            else:
                written[name] = words[column] if name == VERDICT else column
        missing = {
            f"why_no_{name}": numpy.where(numpy.isnan(values[name]) & (values["status"] == int(Status.OK)), reason, "")
            for name, reason in missing_reasons(study).items()
        }
        yield {**written, "why_not_valid": numpy.array(why), **missing}


def _write_csv(study: xarray.Dataset, path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        for number, columns in enumerate(_iterate_columns(study)):
            if number == 0:
                writer.writerow(columns)
            numbers = (column.astype(int) if column.dtype.kind == "b" else column for column in columns.values())
            writer.writerows(zip(*(column.tolist() for column in numbers), strict=True))
