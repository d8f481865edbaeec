"""The answer of the elastic solution: a contact that knows its own error and the inside of the socket."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from .. import arrays
from ..arrays import Array
from ..checks import numeric, require
from ..contact import Contact
from .abel import State
from .inside import Peak, Stress, peak, stress, surface_displacement


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class ElasticContact(Contact):
    """A `Contact` with error estimates, and for a single contact displacements and stresses in the socket."""

    laws: Any

    @cached_property
    def error(self) -> dict[str, Array]:
        """Estimated relative error of each quantity, by name, from the solution itself."""
        return {name: self._plain(error) for name, error in self.laws.error.items()}

    def displacement(self, angle: Array) -> Array:
        """Radial displacement in mm of the socket's surface at polar angles (rad), inside and outside the contact.

        Outwards is positive. NumPy; by 2000 modes, to about 1e-8 of the indentation.

        Raises
        ------
        ValueError
            More than one contact: press it alone.
        """
        angles = numpy.asarray(arrays.to_numpy(numeric("angle", angle)), dtype=float)
        values = surface_displacement(self._single, angles) if self._pressed else 0.0 * angles
        return values if angles.ndim else float(values)

    def stress(self, angle: Array, depth: Array) -> Stress:
        """Stresses in the liner and its backing at polar angles (rad) and depths (mm) below the socket's surface.

        NumPy; angle and depth broadcast against each other. By up to 2000 modes: at the surface to about 1e-4 of the
        peak pressure away from the edge of the contact, below it to 1e-8.

        Raises
        ------
        ValueError
            More than one contact; a depth above the surface or beyond the outermost layer.
        """
        angles, depths = (
            numpy.asarray(numeric(name, value), dtype=float) for name, value in (("angle", angle), ("depth", depth))
        )
        require("depth", depths, depths >= 0, "a depth (mm) is 0 or more")
        return stress(self._single, angles, depths)

    @cached_property
    def peak_stress(self) -> Peak:
        """The largest von Mises stress in the liner, with its depth and polar angle.

        Raises
        ------
        ValueError
            More than one contact, or one without load.
        """
        return peak(self._single, float(self.joint.liner_thickness))

    @property
    def _pressed(self) -> bool:
        return bool(arrays.to_numpy(self.indentation > 0).all())

    @property
    def _single(self) -> State:
        if int(numpy.prod(self.laws.shape)) != 1:
            raise ValueError(f"displacements and stresses are for one contact, not {self.laws.shape}: press it alone")
        if not self._pressed:
            raise ValueError("displacements and stresses need a contact under load")
        state: State = self.laws.pieces[0][1].state
        return state
