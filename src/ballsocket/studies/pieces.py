"""A study in parts that fit into memory, each read when its turn comes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from .blocks import Blocks

if TYPE_CHECKING:
    import xarray

MOST = 1 << 18
"""Points of a part."""


def dims_of(study: xarray.Dataset) -> tuple[str, ...]:
    """The dimensions in the order of the answers."""
    return tuple(str(dim) for dim in next(iter(study.data_vars.values())).dims)


def blocks_of(study: xarray.Dataset) -> Blocks:
    """How the study is parted."""
    return Blocks.of(tuple(study.sizes[dim] for dim in dims_of(study)), MOST)


def pieces(study: xarray.Dataset) -> Iterator[xarray.Dataset]:
    """The parts one after the other, in the order of the points: the last dimension runs first."""
    dims, blocks = dims_of(study), blocks_of(study)
    for number in range(len(blocks)):
        yield study.isel(dict(zip(dims, blocks[number], strict=True))).load()
