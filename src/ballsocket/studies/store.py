"""A study on disk: a Zarr group that xarray reads, written block by block, each block with its checksum."""

from __future__ import annotations

import filecmp
import json
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import gettempdir
from typing import Any
from zlib import crc32

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from ..core.storage.atomic_files import make_draft_folder, write_atomically
from ..core.storage.pieces import PieceStore
from .identity import differences, identity
from .labels import attributes, coordinates, described
from .task import DTYPES, Task

CHECKSUM = "block_checksum"
"""An array with a number for each block: its checksum, or -1 as long as the block is not there."""

NOT_COMPUTED = -1
"""The status of a point whose block is not there yet."""

_STUDY = "study"
"""The attribute that says which study this is."""

_LABEL, _LONGEST = "zarr.json", 10_000_000
"""The file with the attributes, and the bytes that it may have."""

_TOLD = 8  # differences
_NO_FILE = (FileNotFoundError, NotADirectoryError, IsADirectoryError)


@dataclass(frozen=True)
class Store:
    """The Zarr group of one study."""

    path: Path

    def prepare(self, task: Task) -> None:
        """Make the group, with labels and without answers, unless it is there already.

        Raises
        ------
        ValueError
            There is another study, another version's, or something else.
        OSError
            It cannot be written.
        """
        needs("study", "zarr")
        asked = json.loads(json.dumps(identity(task)))
        if not self.path.exists():
            self.path.parent.mkdir(parents=True, exist_ok=True)
            if self._made(task, asked):
                return
        kept = self.study()
        if kept == asked:
            self._label(task, asked)
        else:
            apart = "; ".join(differences(kept, asked)[:_TOLD])
            raise ValueError(f"{self.path} holds another study: {apart}. Choose another folder, or remove this one")

    def _made(self, task: Task, asked: Mapping[str, Any]) -> bool:
        """Make the group; false where another process was quicker, and nothing is made."""
        try:
            with write_atomically(self.path) as draft:
                _make(draft, task, asked)
        except OSError:
            if not self.path.exists():
                raise
            return False
        return True

    def _label(self, task: Task, asked: Mapping[str, Any]) -> None:
        """Put every label, which is all that a store without answers has, where it is damaged or gone."""
        with make_draft_folder(Path(gettempdir()) / self.path.name) as folder:  # where the store is may be read-only
            draft = folder / self.path.name
            _make(draft, task, asked)
            for fresh in draft.rglob("*"):
                here = self.path / fresh.relative_to(draft)
                if fresh.is_file() and not (here.is_file() and filecmp.cmp(fresh, here, shallow=False)):
                    here.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(fresh, here)

    def study(self) -> Mapping[str, Any]:
        """Which study it is.

        Raises
        ------
        ValueError
            It is no study.
        """
        try:
            with (self.path / _LABEL).open("rb") as stream:
                found = json.loads(stream.read(_LONGEST))["attributes"][_STUDY]
        except (*_NO_FILE, ValueError, LookupError, TypeError, RecursionError) as error:
            raise ValueError(f"{self.path} is there already and is no study") from error
        if not isinstance(found, Mapping):
            raise ValueError(f"{self.path} is there already and is no study")
        return found

    def intact_blocks(self, task: Task, numbers: Sequence[int]) -> list[int]:
        """Return the numbers of those blocks that are stored and have their checksum."""
        import zarr

        group = zarr.open_group(self.path, mode="r")
        try:
            checksums = numpy.asarray(group[CHECKSUM][:])  # type: ignore[index]
        except Exception:  # without the list of checksums, every block is computed again
            return []
        return [
            number
            for number in numbers
            if checksums[number] >= 0 and checksums[number] == _checksum_of(group, task, number)
        ]

    def write(self, task: Task, number: int, answers: Mapping[str, Numbers]) -> None:
        """Write a block, and last its checksum.

        Raises
        ------
        OSError
            It cannot be written: the disk is full, or the store is read-only.
        """
        import zarr

        group = zarr.open_group(self.path, mode="r+")
        for name, values in answers.items():
            group[name][task.blocks[number]] = values  # type: ignore[index]
        group[CHECKSUM][number] = _checksum(answers, task)  # type: ignore[index]


@dataclass(frozen=True, eq=False)
class BlockStore(PieceStore):
    """Store of the blocks of a study in its Zarr group, from which xarray reads them."""

    task: Task
    store: Store

    def load(self, numbers: Sequence[int]) -> dict[int, None]:
        """Return the numbers of the intact blocks, without their values."""
        return dict.fromkeys(self.store.intact_blocks(self.task, numbers))

    def save(self, number: int, result: Mapping[str, Numbers]) -> None:
        """Write the values of a block.

        Raises
        ------
        OSError
            The store is not writable or the disk is full.
        """
        self.store.write(self.task, number, result)


def _make(path: Path, task: Task, study: Mapping[str, Any]) -> None:
    import zarr
    from zarr.codecs import BloscCodec

    quick: Any = BloscCodec(cname="lz4", clevel=1, shuffle="shuffle")
    attrs: Any = {**attributes(task), _STUDY: study, "coordinates": " ".join(task.design.names)}
    group = zarr.create_group(path, attributes=attrs)
    for name, (dims, values) in coordinates(task.design).items():
        made = group.create_array(
            name, shape=values.shape, dtype=values.dtype, dimension_names=dims, attributes=described(name)
        )
        made[...] = values
    for name in task.variables:
        dtype = numpy.dtype(DTYPES[name])
        group.create_array(
            name,
            shape=task.design.shape,
            chunks=task.blocks.size,
            dtype=dtype,
            fill_value=numpy.nan if dtype.kind == "f" else NOT_COMPUTED if name == "status" else 0,
            dimension_names=task.design.dims,
            compressors=quick,
            attributes=described(name),
        )
    group.create_array(
        CHECKSUM, shape=(len(task.blocks),), chunks=(1,), dtype="int64", fill_value=-1, dimension_names=("block",)
    )


def _checksum_of(group: Any, task: Task, number: int) -> int | None:
    """Checksum of what lies there; None where it cannot be read."""
    try:
        return _checksum({name: group[name][task.blocks[number]] for name in task.variables}, task)
    except Exception:  # whatever a damaged file makes of its decoder: the block is computed anew
        return None


def _checksum(answers: Mapping[str, Numbers], task: Task) -> int:
    total = 0
    for name in task.variables:
        total = crc32(numpy.ascontiguousarray(answers[name]).view(numpy.uint8).data, total)
    return total
