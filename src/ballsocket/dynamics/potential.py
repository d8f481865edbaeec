"""Elastic energy of a joint over the indentation, with its first and second derivatives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy

from ..contact import Model
from ..contact.law import CurveLaw, ForceLaw, PolynomialPieces, fit_curve_law
from ..core import arrays
from ..core.arrays import Array, Numbers, clip, exp, log, where
from ..core.checks import require
from ..models.adhesion import AdhesiveSocket
from ..models.closed_form import ClosedForm, ClosedLaw
from ..models.foundation import FoundationLaw
from ..problem import Joint

Slopes = tuple[Array, Array, Array]  # energy U in N mm, force F = dU/dd in N, and stiffness k = dF/dd in N/mm


class Potential(Protocol):
    """Elastic energy of a joint and its two derivatives at an indentation in mm, 0 or more: a number or an array.

    `deepest` is the largest indentation in mm with a result.
    """

    @property
    def deepest(self) -> float: ...

    def __call__(self, indentation: Array) -> Slopes: ...


@dataclass(frozen=True, kw_only=True)
class SpringPotential:
    """Elastic energy of a radial foundation by its formulas."""

    springs: FoundationLaw
    deepest: float = math.inf

    def __call__(self, indentation: Array) -> Slopes:
        springs = self.springs
        motion, numbers = springs.kinematics, (springs.socket_radius, springs.clearance, springs.modulus, indentation)
        return motion.energy(*numbers), motion.force(*numbers), motion.stiffness(*numbers)


@dataclass(frozen=True, kw_only=True)
class FormulaPotential:
    """Elastic energy of a closed-form model by its formulas."""

    model: ClosedForm
    joint: Joint
    deepest: float = math.inf

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation
        return self.model.energy(*arguments), self.model.force(*arguments), self.model.stiffness(*arguments)


@dataclass(frozen=True, kw_only=True, eq=False)
class CurvePotential:
    """Elastic energy as a curve: piecewise polynomials of ln U over ln d, whose derivatives give F and k.

    Below the curve's `shallowest` indentation U is a power of d. Beyond its `deepest` indentation U is NaN.
    """

    curve: CurveLaw

    @property
    def deepest(self) -> float:
        """Largest indentation in mm of the fitted curve."""
        return self.curve.deepest

    @cached_property
    def _coefficient_rows(self) -> PolynomialPieces:
        return tuple(map(tuple, self.curve.pieces.tolist()))

    def __call__(self, indentation: Array) -> Slopes:
        curve = self.curve
        if type(indentation) is float:
            ends = curve.shallowest, curve.deepest, curve.first, curve.density
            return energy_derivatives_of_number(indentation, *ends, self._coefficient_rows)
        return energy_derivatives_of_array(indentation, curve)


def energy_derivatives_of_number(
    indentation: float, shallowest: float, deepest: float, first: float, density: float, pieces: PolynomialPieces
) -> tuple[float, float, float]:
    """Evaluate a fitted energy curve at one indentation in mm: energy, force and stiffness."""
    if indentation <= 0.0:
        return 0.0, 0.0, 0.0
    if not indentation <= deepest:
        return math.nan, math.nan, math.nan
    piece_position = (math.log(max(indentation, shallowest)) - first) * density
    piece_index = min(max(int(piece_position), 0), len(pieces) - 1)
    coordinate = 2.0 * (piece_position - piece_index) - 1.0
    log_energy, log_energy_slope, log_energy_bend = 0.0, 0.0, 0.0
    for coefficient in pieces[piece_index]:
        log_energy_bend = log_energy_bend * coordinate + log_energy_slope
        log_energy_slope = log_energy_slope * coordinate + log_energy
        log_energy = log_energy * coordinate + coefficient
    exponent, curvature = 2.0 * density * log_energy_slope, 8.0 * density * density * log_energy_bend
    energy = math.exp(log_energy)
    if indentation < shallowest:
        energy, curvature = energy * (indentation / shallowest) ** exponent, 0.0
    inverse_indentation = 1.0 / indentation
    force = energy * inverse_indentation * exponent
    return energy, force, (force * (exponent - 1.0) + energy * inverse_indentation * curvature) * inverse_indentation


_MIN_INDENTATION = 1e-150  # smallest indentation in mm whose energy does not underflow in an intermediate result


def energy_derivatives_of_array(indentation: Array, curve: CurveLaw) -> Slopes:
    """Evaluate a fitted energy curve at an array of indentations in mm: energy, force and stiffness."""
    xp, shallowest, deepest, density = arrays.namespace(indentation), curve.shallowest, curve.deepest, curve.density
    coefficient_table = xp.asarray(curve.pieces, dtype=indentation.dtype, device=arrays.device(indentation))
    d = where(indentation == indentation, clip(indentation, _MIN_INDENTATION, deepest), deepest)
    piece_position = (log(clip(d, shallowest, deepest)) - curve.first) * density
    piece_index = xp.astype(
        clip(xp.floor(arrays.stop_gradient(piece_position)), 0.0, coefficient_table.shape[0] - 1.0), xp.int64
    )
    coordinate = 2.0 * (piece_position - xp.astype(piece_index, d.dtype)) - 1.0
    flat_indices = xp.reshape(piece_index, (-1,))
    log_energy, log_energy_slope, log_energy_bend = 0.0 * coordinate, 0.0 * coordinate, 0.0 * coordinate
    for term in range(coefficient_table.shape[1]):
        log_energy_bend = log_energy_bend * coordinate + log_energy_slope
        log_energy_slope = log_energy_slope * coordinate + log_energy
        log_energy = log_energy * coordinate + xp.reshape(
            xp.take(coefficient_table[:, term], flat_indices), tuple(d.shape)
        )
    exponent, curvature = 2.0 * density * log_energy_slope, 8.0 * density * density * log_energy_bend
    below = d < shallowest
    energy = exp(log_energy + where(below, exponent * log(where(below, d, shallowest) / shallowest), 0.0))
    force = energy / d * exponent
    stiffness = force / d * (exponent - 1.0) + where(below, 0.0, energy / d / d * curvature)
    inside = indentation <= deepest
    return where(inside, energy, math.nan), where(inside, force, math.nan), where(inside, stiffness, math.nan)


def potential_of(model: Model, joint: Joint) -> Potential:
    """Return the elastic energy of a joint as a function of the indentation, for a model with a force law."""
    law = model.law(joint)
    if isinstance(law, FoundationLaw):
        return SpringPotential(springs=law)
    if isinstance(law, ClosedLaw):
        return FormulaPotential(model=law.model, joint=law.joint)
    ends = (law.shallowest, law.deepest) if isinstance(law, CurveLaw) else curve_range(joint)
    return CurvePotential(curve=energy_curve(law, *ends))


def curve_range(joint: Joint) -> tuple[float, float]:
    """Return the indentations in mm between which quantities of a joint are fitted by curves."""
    return 1e-6 * (joint.clearance or joint.socket_radius), joint.socket_radius


def energy_curve(law: ForceLaw, shallowest: float, deepest: float) -> CurveLaw:
    """Integrate a force law over the indentation to the elastic energy, and fit the energy by a curve."""
    return fit_curve_law(lambda depths: _integrate_force(law, depths, shallowest), shallowest, deepest)


def _integrate_force(law: ForceLaw, depths: Numbers, shallowest: float) -> Numbers:
    """Integrate a force law up to each of some increasing indentations in mm: elastic energies in N mm.

    Up to the first indentation it is a power law; beyond, Gauss points over ln d.
    """
    force, stiffness = law(shallowest)
    initial_work = force * shallowest / (1.0 + stiffness * shallowest / force)
    log_depths = numpy.log(numpy.concatenate([[shallowest], depths]))
    nodes, weights = map(numpy.array, arrays.gauss_legendre(_GAUSS_NODES))
    gauss_indentations = numpy.exp(log_depths[:-1, None] + numpy.diff(log_depths)[:, None] * nodes)
    forces = numpy.array([law(float(depth))[0] for depth in gauss_indentations.ravel()]).reshape(
        gauss_indentations.shape
    )
    return initial_work + numpy.cumsum(numpy.diff(log_depths) * ((forces * gauss_indentations) @ weights))


_GAUSS_NODES = 16  # number of Gauss points between two indentations


@dataclass(frozen=True, kw_only=True)
class AdhesionPotential:
    """Elastic energy of an adhesive socket over d + u_c, zero at separation (d = -u_c) and negative at first touch."""

    model: AdhesiveSocket
    joint: Joint
    deepest: float

    @cached_property
    def stretch(self) -> float:
        """Largest stretch u_c of a spring in mm."""
        return float(self.model.critical_stretch(self.joint))

    @cached_property
    def _separation_energy(self) -> float:
        return float(self.model.energy(self.joint, -self.stretch))

    def __call__(self, indentation: Array) -> Slopes:
        arguments = self.joint, indentation - self.stretch
        return (
            self.model.energy(*arguments) - self._separation_energy,
            self.model.force(*arguments),
            self.model.stiffness(*arguments),
        )


def adhesion_potential(model: AdhesiveSocket, joint: Joint) -> AdhesionPotential:
    """Return the elastic energy of an adhesive joint, measured from the separation of the ball.

    Raises ValueError: an adhesion number η = u_c/c of 1 or more: the hemisphere sticks as a unit and never separates
    gradually.
    """
    model.law(joint)  # raises for arrays and for joints outside the domain
    joint = joint.with_floats()
    number, sticks = float(model.adhesion_number(joint)), "otherwise the entire hemisphere sticks"
    allowed = f"it must be below 1; {sticks}, and the rim determines the separation"
    require("the adhesion number", number, number < 1.0, allowed)
    return AdhesionPotential(model=model, joint=joint, deepest=joint.socket_radius)


def fit_quantity_curve(model: Model, joint: Joint, quantity: str) -> CurveLaw:
    """Fit a curve to a contact quantity over the indentation, from almost 0 to the socket radius."""
    joint = joint.with_floats()
    return fit_curve_law(lambda depths: getattr(model.press(joint, indentation=depths), quantity), *curve_range(joint))


def evaluate_curve(curve: CurveLaw, indentation: Array) -> Array:
    """Evaluate a fitted curve at indentations in mm; 0 without contact, NaN beyond the end of the curve."""
    if type(indentation) is float:
        return curve(indentation)[0]
    return where(indentation > 0.0, energy_derivatives_of_array(indentation, curve)[0], 0.0)
