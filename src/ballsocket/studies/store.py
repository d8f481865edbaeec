"""Store of a study: a Zarr group that xarray reads, written in blocks with checksums."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy

from ..core.arrays import Numbers
from ..core.storage.folders import ResultFolder, folder_at
from ..core.storage.pieces import PieceStore
from .distributions import CHUNK_SIZE
from .metadata import list_differences, order_coordinates, study_attributes, study_identity, variable_attributes
from .task import DTYPES, VERDICT, Task

if TYPE_CHECKING:
    import xarray


CHECKSUM = "block_checksum"
"""Array with the checksum of each block, or -1 for a missing block."""

NOT_COMPUTED = -1
"""Status of the points of a missing block."""

_IDENTITY = "study"  # attribute with the identity of the study
_LABEL_FILE = "zarr.json"  # file with the attributes of the group
_MAX_LABEL_BYTES = 10_000_000  # largest size in bytes of the file with the attributes
_MAX_DIFFERENCES = 8  # number of differences in a message
_MISSING_FILE_ERRORS = (FileNotFoundError, NotADirectoryError, IsADirectoryError)


def read(path: str | Path) -> xarray.Dataset:
    """Open a stored study at a path or an address; its numbers are read when they are used.

    Raises OSError: the store does not exist or does not respond.
    Raises ValueError: the path is not a study.
    """
    import xarray

    folder = folder_at(path)
    if folder.exists():
        _read_identity(folder)
    try:
        with folder.errors():
            options: Any = {"engine": "zarr", "zarr_format": 3, "consolidated": False, "chunks": None}
            dataset = xarray.open_dataset(folder.zarr_store(), **options)
    except UnicodeError as error:
        raise ValueError(f"{path} is a damaged store: {error}; run its study again to repair it") from error
    return order_coordinates(dataset[[name for name in DTYPES if name in dataset.data_vars]])


def _read_identity(folder: ResultFolder) -> Mapping[str, Any]:
    """Read the identity of a stored study; raise ValueError if the folder is not a study."""
    try:
        identity = json.loads(folder.read(_LABEL_FILE, _MAX_LABEL_BYTES))["attributes"][_IDENTITY]
    except (*_MISSING_FILE_ERRORS, ValueError, LookupError, TypeError, RecursionError) as error:
        raise ValueError(f"{folder} exists and is not a study") from error
    if not isinstance(identity, Mapping):
        raise ValueError(f"{folder} exists and is not a study")
    return identity


@dataclass(frozen=True, eq=False)
class StudyStore(PieceStore):
    """Store of the blocks of a study in a Zarr group, from which xarray reads them."""

    task: Task
    folder: ResultFolder

    def prepare(self) -> None:
        """Create the group with labels and without results, or check that it has the study of the task.

        Raises ValueError: the folder has another study, a study of another version, or something else.
        Raises OSError: the folder is not writable.
        """
        requested = json.loads(json.dumps(study_identity(self.task)))
        if not self.folder.exists():
            try:
                self.folder.create(lambda draft: _write_group(draft, self.task, requested))
                return
            except OSError:
                if not self.folder.exists():  # else another process created it first
                    raise
        stored = _read_identity(self.folder)
        if stored != requested:
            differences = "; ".join(list_differences(stored, requested)[:_MAX_DIFFERENCES])
            raise ValueError(
                f"{self.folder} has another study: {differences}. Choose another folder, or remove this one"
            )
        self._repair_labels(requested)

    def _repair_labels(self, identity: Mapping[str, Any]) -> None:
        """Write damaged or missing labels again; they are all files of a group without results."""
        # a temporary folder, since the store may be read-only
        with TemporaryDirectory() as temporary_folder:
            draft = Path(temporary_folder) / "draft"
            _write_group(draft, self.task, identity)
            for label in filter(Path.is_file, draft.rglob("*")):
                name, content = label.relative_to(draft).as_posix(), label.read_bytes()
                try:
                    is_intact = self.folder.read(name) == content
                except _MISSING_FILE_ERRORS:
                    is_intact = False
                if not is_intact:
                    self.folder.write(name, content)

    def _open_group(self, mode: Any) -> Any:
        import zarr

        return zarr.open_group(self.folder.zarr_store(), mode=mode, zarr_format=3)

    def load(self, numbers: Sequence[int]) -> dict[int, None]:
        """Return the numbers of those blocks that are stored with a correct checksum, without their values."""
        group = self._open_group("r")
        try:
            checksums = group[CHECKSUM][:]
        except Exception:  # without the list of checksums, every block is computed again
            return {}

        def is_stored(number: int) -> bool:
            try:
                stored = {name: group[name][self.task.blocks[number]] for name in self.task.variables}
            except Exception:  # a damaged file can raise any error in its decoder; the block is computed again
                return False
            return self._checksum(stored) == checksums[number]

        return {number: None for number in numbers if checksums[number] >= 0 and is_stored(number)}

    def save(self, number: int, result: Mapping[str, Numbers]) -> None:
        """Write the values of a block, and last its checksum."""
        with self.folder.errors():
            group = self._open_group("r+")
            for name, values in result.items():
                group[name][self.task.blocks[number]] = values
            group[CHECKSUM][number] = self._checksum(result)

    def _checksum(self, results: Mapping[str, Numbers]) -> int:
        checksum = 0
        for name in self.task.variables:
            checksum = crc32(numpy.ascontiguousarray(results[name]).view(numpy.uint8).data, checksum)
        return checksum


def _write_group(path: Path, task: Task, identity: Mapping[str, Any]) -> None:
    import zarr
    from zarr.codecs import BloscCodec

    codec: Any = BloscCodec(cname="lz4", clevel=1, shuffle="shuffle")
    attributes: Any = {**study_attributes(task), _IDENTITY: identity, "coordinates": " ".join(task.design.names)}
    group = zarr.create_group(path, attributes=attributes)
    for name, value in task.design.constants.items():
        group.create_array(name, shape=(), dtype="float64", attributes=variable_attributes(name))[...] = value
    for axis in task.design.axes:
        coordinates = {
            name: group.create_array(
                name,
                shape=(len(axis),),
                chunks=(min(len(axis), CHUNK_SIZE),),
                dtype="float64",
                dimension_names=(axis.name,),
                attributes=variable_attributes(name),
            )
            for name in axis.names
        }
        for section in axis.sections:  # large axes of samples are not held in memory
            for name, values in axis.values_in(section).items():
                coordinates[name][section] = values
    for name in task.variables:
        dtype = numpy.dtype(DTYPES[name])
        group.create_array(
            name,
            shape=task.design.shape,
            chunks=task.blocks.size,
            dtype=dtype,
            fill_value=numpy.nan if dtype.kind == "f" else NOT_COMPUTED if name in ("status", VERDICT) else 0,
            dimension_names=task.design.dims,
            compressors=codec,
            attributes=variable_attributes(name),
        )
    group.create_array(
        CHECKSUM, shape=(len(task.blocks),), chunks=(1,), dtype="int64", fill_value=-1, dimension_names=("block",)
    )
