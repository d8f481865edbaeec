"""Limit of the film ratio below which the surfaces of a hip wear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_number, require
from ..core.display import finite_or_none
from ..lubrication import Lubricant

CYCLES = 300  # default number of uninterrupted cycles from a flooded bore


@dataclass(frozen=True, kw_only=True)
class FilmLimit:
    """Film ratio λ below which the surfaces wear.

    The limit is sharp: in each instant a cell of the bore wears by the wear law, or not at all. λ is the film by the
    kinematic wave in the cell over the combined roughness. It is that of the unworn bore during the whole run. A cell
    outside the unworn contact of an instant takes the film of the nearest cell in it.

    Parameters
    ----------
    ratio : float
        λ below which the surfaces wear, 1 by default; infinity wears everywhere, 0 nowhere.
    lubricant : Lubricant
    cycles : int
        Number of uninterrupted cycles since the bore was flooded; 300 by default.

    Raises
    ------
    TypeError
        A ratio that is not one number.
    ValueError
        A ratio below 0; a number of cycles below 1.
    """

    ratio: float = 1.0
    lubricant: Lubricant = Lubricant()  # noqa: RUF009 (frozen)
    cycles: int = CYCLES

    def __post_init__(self) -> None:
        ratio = check_number("film_limit", self.ratio)
        require("film_limit", ratio, ratio >= 0, "a film ratio is at least 0, such as 1")
        cycles = check_number("cycles", self.cycles)
        require("cycles", cycles, cycles >= 1 and cycles % 1 == 0, "a number of cycles is a whole number from 1")

    def wearing_cells(self, thickness: Numbers, directions: Numbers) -> Numbers:
        """Compute the mask of the cells that wear: (instants, cells).

        Parameters
        ----------
        thickness : array (instants, cells)
            Film in mm; NaN outside the contacts.
        directions : array (3, cells)
            Unit vectors to the cells.
        """
        from scipy.spatial import cKDTree  # slow to import

        film = numpy.zeros_like(thickness)  # 0 in instants without any film; outside a contact that of the nearest cell
        for row, values in zip(film, thickness, strict=True):
            inside = numpy.isfinite(values)
            if inside.any():
                row[:] = values[inside][cKDTree(directions[:, inside].T).query(directions.T)[1]]
        return ~(film >= self.ratio * self.lubricant.roughness)

    def note(self, excluded_share: float) -> str:
        """Return a sentence on the limit and the share of the sliding work without wear, for reports."""
        return (
            f"wear counts only where λ is below {self.ratio:g}, by the film on the unworn bore: "
            f"{100 * excluded_share:.3g} % of the sliding work of the first cycle are without wear"
        )

    def summary(self, excluded_share: float) -> dict[str, Any]:
        """Return the limit and the share of the sliding work without wear for JSON; an infinite limit is null."""
        return {"lambda": finite_or_none(self.ratio), "excluded_work_share": excluded_share}
