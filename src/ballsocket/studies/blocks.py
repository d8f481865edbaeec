"""How a study is cut: blocks of many points, each computed, written and resumed as one."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, prod

import numpy


@dataclass(frozen=True)
class Blocks:
    """A box of points cut into smaller ones, all alike but the last along each dimension.

    `shape` and `size` count points along each dimension: of all, and of one block.
    """

    shape: tuple[int, ...]
    size: tuple[int, ...]

    @classmethod
    def of(cls, shape: tuple[int, ...], most: int) -> Blocks:
        """Blocks of at most so many points (at least one), whole along the last dimensions."""
        sizes = []
        left = max(1, most)
        for length in reversed(shape):
            size = max(1, min(length, left))
            sizes.append(_even(length, size))
            left //= size
        return cls(shape, tuple(reversed(sizes)))

    @property
    def counts(self) -> tuple[int, ...]:
        """Blocks along each dimension."""
        return tuple(ceil(length / size) for length, size in zip(self.shape, self.size, strict=True))

    def __len__(self) -> int:
        return prod(self.counts)

    def __getitem__(self, number: int) -> tuple[slice, ...]:
        """Where a block lies."""
        if not 0 <= number < len(self):
            raise IndexError(number)
        place = numpy.unravel_index(number, self.counts)
        return tuple(
            slice(int(at) * size, min((int(at) + 1) * size, length))
            for at, size, length in zip(place, self.size, self.shape, strict=True)
        )

    def points(self, number: int) -> int:
        """How many points a block has."""
        return prod(part.stop - part.start for part in self[number])


def _even(length: int, size: int) -> int:
    """At most `size`, such that all blocks are about as long."""
    return ceil(length / ceil(length / size)) if length else 1
