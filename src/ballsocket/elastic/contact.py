"""The answer of the elastic solution: a contact that knows its own error and the inside of the socket."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from .. import arrays
from ..arrays import Array
from ..checks import numeric, require
from ..model.per_joint import Piece, SolvedContact
from ..quantities import QUANTITIES
from ..stress import Peak, Stress
from .abel import State
from .fitted_state import FittedState
from .subsurface import NARROWEST, OFF, about_von_mises, largest_von_mises, peak, stress, surface_displacement


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class ElasticContact(SolvedContact):
    """A contact that knows, where it is a single one, displacements and stresses in the socket."""

    def displacement(self, angle: Array) -> Array:
        """Radial displacement in mm of the socket's surface at polar angles (rad), inside and outside the contact.

        Outwards is positive; of the shape of `angle`. NumPy; by the sum of modes, to about 1e-5 of the indentation
        (1e-8 for half angles above 40 degrees).

        Raises
        ------
        ValueError
            More than one contact, or one that is narrower than 1 degree: there the half-space (`Hertz`) answers.
        """
        angles = numpy.asarray(arrays.to_numpy(QUANTITIES["angle"].checked(angle)), dtype=float)
        values = surface_displacement(self._single, angles)
        return values if angles.ndim else float(values)

    def stress(self, angle: Array, depth: Array) -> Stress:
        """Stresses in the liner and its backing at polar angles (rad) and depths (mm) below the socket's surface.

        NumPy; angle and depth broadcast against each other. By the sum of modes: at the surface to about 1e-4 of the
        peak pressure away from the edge of the contact, below it to 1e-8.

        Raises
        ------
        ValueError
            More than one contact, or one that is narrower than 1 degree; a depth above the surface or beyond the
            outermost layer.
        """
        angles, depths = (
            numpy.asarray(value, dtype=float) for value in (QUANTITIES["angle"].checked(angle), numeric("depth", depth))
        )
        thickness = sum(shell.thickness for shell in self._single.kernel.socket.shells)
        good = (depths >= 0) & (depths <= thickness * (1 + 1e-9))
        require("depth", depths, good, f"a depth (mm) lies between 0 and {thickness:g}, where the socket ends")
        found = stress(self._single, angles, depths)
        if angles.ndim or depths.ndim:
            return found
        numbers: Any = {name: float(part) for name, part in vars(found).items()}
        return Stress(**numbers)

    @cached_property
    def peak_stress(self) -> Peak:
        """The largest von Mises stress in the liner, with its depth and polar angle.

        Raises
        ------
        ValueError
            More than one contact, or one without load or narrower than 1 degree.
        """
        return peak(self._single, float(self.joint.liner_thickness))

    @cached_property
    def von_mises_between(self) -> tuple[Array, Array]:
        least, most = super().von_mises_between
        if arrays.truth(arrays.isfinite(most) | self._failed) is not False:
            return least, most
        about = self._answer(lambda: self.laws.located(lambda place, piece: self._about_von_mises(piece)))
        return (1 - OFF) * about, (1 + OFF) * about

    def _about_von_mises(self, piece: Piece) -> numpy.ndarray:
        return about_von_mises(piece.state)

    def _von_mises_of(self, place: numpy.ndarray, piece: Piece) -> numpy.ndarray:
        return largest_von_mises(piece.state, piece.reached)

    @property
    def _single(self) -> State:
        state: State = self.single_state.alone(0)
        width = float(state.half_angle[0])
        require("half_angle", width, width >= NARROWEST, "inside a contact of less than 1 degree ask hertz")
        return state


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class CurveContact(ElasticContact):
    """An `ElasticContact` whose largest stress in the liner lies on a curve of its joint too, to about 1e-3."""

    def _about_von_mises(self, piece: Piece) -> numpy.ndarray:
        return self._von_mises_of(numpy.empty(0), piece)

    def _von_mises_of(self, place: numpy.ndarray, piece: Piece) -> numpy.ndarray:
        if isinstance(piece.state, FittedState):
            return piece.state.largest_von_mises(piece.reached)
        return super()._von_mises_of(place, piece)
