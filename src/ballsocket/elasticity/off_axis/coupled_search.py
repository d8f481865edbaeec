"""Equilibrium of balls under prescribed loads: pressures and displacements together, by conjugate gradients.

Unknown are the displacement e of the ball's centre and the pressures p >= 0 of the cells. With the clearance and the
worn depth g, the normals n, the compliance S of the bore, a tether T and the load F, they satisfy

    r = n·e - g - S p = 0 where p > 0,   r <= 0 where p = 0,   (1)
    R2² ∫ p n dA + T e = F.                                    (2)

One iteration moves every ball by a Newton step Δe, and its pressures by a step of conjugate gradients under p >= 0
(Polonsky & Keer 1999, doi 10.1016/S0043-1648(99)00113-1). The Newton step needs the force that the pressures will have
once they have converged. To first order it is F(p) + R2² ∫ q r dA, with the present force F(p), the left side of (2),
the remaining overlap r and the derivative q of the pressures by the displacement: the compliance is symmetric, so q
also maps an overlap to its force. The step solves

    (∂F/∂e) Δe = F - F(p) - R2² ∫ q r dA.                      (3)

It does not wait for the pressures, and the pressures do not start again after each step.

The functions here are written for NumPy and JAX. Balls are lanes: fields are arrays (meridians, rings, lanes), vectors
(3, lanes). A lane does not depend on the others. Fields are divided into parts even and odd about φ = 0. Two small
matrices transform these parts to harmonics, which is faster than an FFT at this size, and needs no transposition.
Where loads and wear are symmetric about the plane of φ = 0, fields have half the meridians: see `fold_bore`.
"""

from __future__ import annotations

from functools import partial
from math import inf, sqrt
from typing import NamedTuple

import numpy

from ...core import arrays
from ...core.arrays import Array

COARSE_TOLERANCE = 1e-3  # residuals of forces and overlaps at the end of the search in wide cells
COARSE_ROUNDS = 4  # number of rounds of the search in wide cells; each starts with a new sensitivity
COARSE_ITERATIONS = 7  # number of iterations in a round
_WARM_UP_ITERATIONS = 2  # number of iterations at a fixed displacement before the first Newton step
SENSITIVITY_ITERATIONS = 3  # number of iterations for the sensitivity of the pressures in wide cells, for Newton steps

TANGENT_ITERATIONS = 4
"""Number of iterations for the tangent stiffness, whose error is the square of that of the sensitivity."""

_REGULARISATION = 1e-6
"""Fraction of the trace of a stiffness, added to each direction so that one without stiffness stays solvable."""

_MAX_STEP = 0.5  # largest Newton step, as a fraction of the largest overlap


class BoreArrays(NamedTuple):
    """Ball and bore as arrays of one library and data type.

    A folded bore has the meridians of one side alone, and the components of its parity in place of three.
    """

    # (half, half), from twice the even and odd parts of a field (half its meridians) to its cosine and sine
    # coefficients. A folded bore has one of them, from the part itself.
    cosines: Array
    sines: Array
    # (half + 1, rings, rings), matrices of `Compliance` for each harmonic; (half, rings, rings) of a folded bore
    softness: Array
    stiffness: Array
    normals: Array  # (cells, 3), mean outward normals of the cells
    gap: Array  # (meridians, rings, 1), clearance plus worn depth in mm
    areas: Array  # (rings,), area of a cell of each ring on a unit sphere
    force_weights: Array  # (3, cells), force in N by 1 MPa in a cell
    scale: Array  # (), area of the bore per area of a unit sphere, R2² in mm²
    tether: Array  # (3, 3), stiffness in N/mm of a spring parallel to the contact


class Lanes(NamedTuple):
    """State of a search, one lane per ball."""

    load: Array  # (3, lanes), prescribed force in N
    # (lanes,), force in N and overlap in mm to which residuals are relative
    force_scale: Array
    overlap_scale: Array
    displacement: Array  # (3, lanes), displacement of the ball's centre in mm
    pressure: Array  # (meridians, rings, lanes), pressure in MPa, at least 0
    # (meridians, rings, lanes), overlap in mm under these pressures, negative in a gap. It is updated by
    # increments, which keeps its accuracy.
    remaining: Array
    imbalance: Array  # (3, lanes), load minus force in N
    # (meridians, rings, lanes), remaining overlap of cells that touch or overlap, that of the last iteration, and
    # its search direction
    residual: Array
    previous_residual: Array
    direction: Array
    descent: Array  # (lanes,), descent of the last iteration along its gradient
    error: Array  # (lanes,), larger one of the relative residuals of overlap and force


class Predictor(NamedTuple):
    """Linear model of the contacts, for the Newton steps."""

    # (meridians, rings, 3 * lanes), derivative of the pressures by each component of the displacement, in MPa/mm
    sensitivity: Array
    inverse_tangent: Array  # (lanes, 3, 3), displacement in mm by force in N

    def take(self, indices: Array) -> Predictor:
        """Return the predictor of the lanes at these indices."""
        count, _, components = self.inverse_tangent.shape
        fields = self.sensitivity.reshape(*self.sensitivity.shape[:2], components, count)[..., indices]
        return Predictor(fields.reshape(*fields.shape[:2], -1), self.inverse_tangent[indices])

    def store(self, indices: Array, part: Predictor) -> None:
        """Copy the predictor of some lanes to these indices, in NumPy arrays."""
        count, _, components = self.inverse_tangent.shape
        for axis, sensitivity in enumerate(numpy.split(part.sensitivity, components, axis=-1)):
            self.sensitivity[..., axis * count + indices] = sensitivity
        self.inverse_tangent[indices] = part.inverse_tangent


def fold_bore(bore: BoreArrays, *, even: bool) -> BoreArrays:
    """Return the arrays of a bore for NumPy fields on one side of the plane of φ = 0, even or odd about it.

    Displacements and forces have the components x and z in even problems, and y alone in odd ones.
    """
    half, components = len(bore.cosines), [0, 2] if even else [1]
    harmonics = slice(None, -1) if even else slice(1, None)
    cells = half * bore.gap.shape[1]
    folded = bore._replace(
        cosines=sqrt(2) * (bore.cosines if even else bore.sines),
        softness=bore.softness[harmonics],
        stiffness=bore.stiffness[harmonics],
        normals=bore.normals[:cells, components],
        gap=bore.gap[:half],
        areas=2 * bore.areas,
        force_weights=2 * bore.force_weights[components, :cells],
        tether=bore.tether[numpy.ix_(components, components)],
    )
    return BoreArrays(*(numpy.ascontiguousarray(array) for array in folded))


def unfold_fields(fields: Array) -> Array:
    """Return fields (meridians, rings, lanes) from the side of the plane of φ = 0 on which even ones were computed."""
    xp = arrays.namespace(fields)
    return xp.concat([fields, xp.flip(fields, axis=0)])


def apply_operator(bore: BoreArrays, matrices: Array, fields: Array) -> Array:
    """Apply the axisymmetric operator of these matrices to fields (meridians, rings, lanes)."""
    xp = arrays.namespace(fields)
    half = len(bore.cosines)
    if len(matrices) == half:
        return _apply_to_part(bore.cosines, matrices, fields)
    low, high = fields[:half], xp.flip(fields[half:], axis=0)
    even = _apply_to_part(bore.cosines, matrices[:-1], low + high)
    odd = _apply_to_part(bore.sines, matrices[1:], low - high)
    return xp.concat([even + odd, xp.flip(even - odd, axis=0)])


def _apply_to_part(transform: Array, matrices: Array, part: Array) -> Array:
    half, rings, lanes = part.shape
    waves = (transform @ part.reshape(half, rings * lanes)).reshape(half, rings, lanes)
    return (transform.T @ (matrices @ waves).reshape(half, rings * lanes)).reshape(half, rings, lanes)


def integrate(bore: BoreArrays, first: Array, second: Array) -> Array:
    """Integrate the product of two fields over a unit sphere: (lanes,)."""
    return bore.areas @ arrays.namespace(first).einsum("mrl,mrl->rl", first, second)


def largest(fields: Array) -> Array:
    """Compute the largest value of fields in each lane: (lanes,)."""
    xp = arrays.namespace(fields)
    return xp.max(xp.max(fields, axis=0), axis=0)


def project_on_normals(bore: BoreArrays, displacement: Array) -> Array:
    """Compute the component of displacements (3, lanes) along the normal of each cell: (meridians, rings, lanes)."""
    return (bore.normals @ displacement).reshape(*bore.gap.shape[:2], -1)


def compute_force(bore: BoreArrays, pressure: Array) -> Array:
    """Compute the force on the bore in N, (3, lanes)."""
    return bore.force_weights @ pressure.reshape(-1, pressure.shape[-1])


def estimate_pressure(bore: BoreArrays, displacement: Array) -> Array:
    """Estimate the pressures from the stiffness of a bore under pressure everywhere; 0 outside the overlap."""
    xp = arrays.namespace(displacement)
    overlap = project_on_normals(bore, displacement) - bore.gap
    pressure = apply_operator(bore, bore.stiffness, xp.maximum(overlap, 0.0 * overlap))
    return pressure * ((overlap > 0) & (pressure > 0))


class ContactBalance(NamedTuple):
    """Residuals of Eqs. (1) and (2) at displacements and pressures of balls."""

    overlap_scale: Array  # (lanes,), largest undeformed overlap in mm
    remaining: Array  # (meridians, rings, lanes), overlap in mm under the pressures
    imbalance: Array  # (3, lanes), load minus force in N


def balance_contacts(bore: BoreArrays, load: Array, displacement: Array, pressure: Array) -> ContactBalance:
    """Compute the residuals at displacements (3, lanes) and pressures (meridians, rings, lanes)."""
    overlap = project_on_normals(bore, displacement) - bore.gap
    return ContactBalance(
        overlap_scale=largest(overlap),
        remaining=overlap - apply_operator(bore, bore.softness, pressure),
        imbalance=load - compute_force(bore, pressure) - bore.tether @ displacement,
    )


def start_lanes(bore: BoreArrays, load: Array, force_scale: Array, displacement: Array, pressure: Array) -> Lanes:
    """Start a search at displacements (3, lanes) and pressures (meridians, rings, lanes)."""
    balance = balance_contacts(bore, load, displacement, pressure)
    return make_lanes(load, force_scale, displacement, pressure, balance)


def make_lanes(load: Array, force_scale: Array, displacement: Array, pressure: Array, balance: ContactBalance) -> Lanes:
    """Make the state at the start of a search from displacements and pressures with their residuals."""
    zero = 0.0 * pressure
    lanes = Lanes(
        load=load,
        force_scale=force_scale,
        displacement=displacement,
        pressure=pressure,
        **balance._asdict(),
        residual=zero,
        previous_residual=zero,
        direction=zero,
        descent=arrays.namespace(pressure).full_like(force_scale, inf),
        error=0.0 * force_scale,
    )
    return update_residuals(lanes)


def update_residuals(lanes: Lanes) -> Lanes:
    """Compute the residual overlaps, and the errors of overlap and force."""
    xp = arrays.namespace(lanes.pressure)
    residual = lanes.remaining * ((lanes.pressure > 0) | (lanes.remaining > 0))
    gap_error = largest(abs(residual)) / lanes.overlap_scale
    force_error = xp.sqrt(xp.sum(lanes.imbalance * lanes.imbalance, axis=0)) / lanes.force_scale
    return lanes._replace(residual=residual, error=xp.maximum(gap_error, force_error))


def start_coarse(bore: BoreArrays, load: Array, force_scale: Array, start: Array) -> Lanes:
    """Start a search in wide cells at displacements (3, lanes), with pressures from a few iterations."""
    pressure = estimate_pressure(bore, start)
    lanes = start_lanes(bore, load, force_scale, start, pressure)
    return arrays.repeat_step(partial(advance_lanes, bore, 0.0 * start), lanes, _WARM_UP_ITERATIONS)


class PressureSensitivity(NamedTuple):
    """Derivative of pressures and forces by the displacement, in fixed touching cells."""

    pressure: Array  # (meridians, rings, 3 * lanes), in MPa/mm, for each component of the displacement
    tangent: Array  # (lanes, 3, 3), tangent stiffness in N/mm, with that of the tether


def refine_sensitivity(bore: BoreArrays, touching: Array, sensitivity: Array) -> PressureSensitivity:
    """Transfer a sensitivity (meridians, rings, 3 * lanes) from cells twice as wide to those that touch."""
    mask = arrays.namespace(touching).tile(touching, (1, 1, len(bore.tether)))
    change = refine_fields(bore, sensitivity) * mask
    return PressureSensitivity(pressure=change, tangent=_symmetric(_forces_by_axis(bore, change)) + bore.tether)


def solve_sensitivity(
    bore: BoreArrays, share: Array, iterations: int, edge_compliance: Array = 1.0
) -> PressureSensitivity:
    """Compute the sensitivity of pressures in cells in contact (meridians, rings, lanes) by conjugate gradients.

    With the residual r = n - S q of the derivative q, the tangent n·q + q·r is accurate to the square of the residual.
    See `solve_change` for the shares of the cells in contact.
    """
    xp = arrays.namespace(share)
    components = len(bore.tether)
    shares = xp.tile(share, (1, 1, components))
    normals = xp.repeat(bore.normals.reshape(*share.shape[:2], components), share.shape[-1], axis=-1)
    change, residual = solve_change(bore, shares, normals, iterations, edge_compliance)
    changes, residuals = (xp.split(fields, components, axis=-1) for fields in (change, residual))
    missing = xp.stack([xp.stack([integrate(bore, q, r) for r in residuals]) for q in changes])
    tangent = _forces_by_axis(bore, change) + bore.scale * missing.transpose(2, 0, 1)
    return PressureSensitivity(pressure=change, tangent=_symmetric(tangent) + bore.tether)


def solve_change(
    bore: BoreArrays, share: Array, overlap: Array, iterations: int, edge_compliance: Array = 1.0
) -> tuple[Array, Array]:
    """Compute changes of pressure in cells in contact under overlaps (mm), and the overlaps that remain.

    Both are fields (meridians, rings, lanes), from preconditioned conjugate gradients. `share` is the mask of the cells
    in contact, or the share w of each cell in contact, 0 to 1. With t² = w and the compliance C (mm/MPa) of a ring next
    to the contact, the pressures are t u of (t S t + C (1 - w)) u = t overlap: the solution for a mask of 0 and 1, and
    in between it changes steadily as the edge crosses a cell.
    """
    xp = arrays.namespace(overlap)
    root = xp.sqrt(share + 0.0 * overlap)
    open_part = 1.0 - root * root
    open_compliance, open_stiffness = open_part * edge_compliance, open_part / edge_compliance
    target = overlap * root

    def precondition(residual: Array) -> Array:
        return apply_operator(bore, bore.stiffness, residual * root) * root + open_stiffness * residual

    def respond(change: Array) -> Array:
        return apply_operator(bore, bore.softness, change * root) * root + open_compliance * change

    change = precondition(target)
    residual = target - respond(change)

    def advance(state: tuple[Array, ...]) -> tuple[Array, ...]:
        change, residual, direction, descent = state
        gradient = precondition(residual)
        next_descent = integrate(bore, residual, gradient)
        direction = gradient + next_descent / descent * direction
        response = respond(direction)
        length = next_descent / positive_or_one(integrate(bore, direction, response))
        return change + length * direction, residual - length * response, direction, positive_or_one(next_descent)

    start = change, residual, 0.0 * change, xp.full_like(change[0, 0], inf)
    change, residual, *_ = arrays.repeat_step(advance, start, iterations)
    return change * root, residual / xp.where(share > 0, root, 1.0)


def _forces_by_axis(bore: BoreArrays, change: Array) -> Array:
    components = len(bore.tether)
    return compute_force(bore, change).reshape(components, components, -1).transpose(2, 0, 1)


def _symmetric(matrices: Array) -> Array:
    return (matrices + matrices.swapaxes(1, 2)) / 2


def make_predictor(sensitivity: PressureSensitivity) -> Predictor:
    """Make the predictor of a sensitivity."""
    xp = arrays.namespace(sensitivity.tangent)
    tangent = sensitivity.tangent
    trace = positive_or_one(xp.trace(tangent, axis1=1, axis2=2))
    regularised = tangent + (_REGULARISATION * trace)[:, None, None] * xp.eye(tangent.shape[-1], dtype=tangent.dtype)
    return Predictor(sensitivity=sensitivity.pressure, inverse_tangent=xp.linalg.inv(regularised))


def positive_or_one(values: Array) -> Array:
    """Replace values that are not positive by 1."""
    return arrays.where(values > 0, values, 1.0)


def newton_step(bore: BoreArrays, lanes: Lanes, predictor: Predictor) -> Array:
    """Compute the Newton steps in mm, (3, lanes), towards the loads that the converged pressures will balance."""
    xp = arrays.namespace(lanes.pressure)
    count = lanes.pressure.shape[-1]
    parts = [predictor.sensitivity[..., axis * count :][..., :count] for axis in range(len(bore.tether))]
    missing = xp.stack([integrate(bore, part, lanes.residual) for part in parts])
    # Eq. (3): what the pressures will still add on their own is not asked of the ball
    imbalance = lanes.imbalance - bore.scale * missing
    step = xp.sum(predictor.inverse_tangent.transpose(1, 2, 0) * imbalance, axis=1)
    length = xp.sqrt(xp.sum(step * step, axis=0))
    return step * xp.minimum(_MAX_STEP * lanes.overlap_scale / positive_or_one(length), xp.ones_like(length))


def advance_lanes(bore: BoreArrays, step: Array, lanes: Lanes) -> Lanes:
    """Move the balls by steps (3, lanes) in mm, and make one step of conjugate gradients for the pressures."""
    xp = arrays.namespace(lanes.pressure)
    moved = project_on_normals(bore, step)
    touching, active = lanes.pressure > 0, lanes.residual != 0
    # residual r + n·Δe of the active cells, and its preconditioned gradient z, without cells that would part
    residual = moved * active
    residual += lanes.residual
    gradient = apply_operator(bore, bore.stiffness, residual)
    gradient *= active & (touching | (gradient > 0))
    # direction t = z + β t with β = max(<r - r', z>/<r', z'>, 0) (Polak & Ribière): it forgets a changed contact
    factor = integrate(bore, residual - lanes.previous_residual, gradient) / lanes.descent
    descent = integrate(bore, residual, gradient)
    direction = lanes.direction * active
    direction *= xp.maximum(factor, 0.0 * factor)
    direction += gradient
    # line search p + α t with α = <r, t>/<t, S t>, then p >= 0
    response = apply_operator(bore, bore.softness, direction)
    length = integrate(bore, residual, direction) / positive_or_one(integrate(bore, direction, response))
    unlimited = lanes.pressure + length * direction
    pressure = xp.maximum(unlimited, 0.0 * length)
    # r + n·Δe - α S t, corrected for the pressures that were cut off at 0
    response *= length
    moved -= response
    moved += lanes.remaining
    remaining = subtract_response(bore, moved, pressure - unlimited)
    change = compute_force(bore, pressure - lanes.pressure) + bore.tether @ step
    return update_residuals(
        lanes._replace(
            displacement=lanes.displacement + step,
            pressure=pressure,
            remaining=remaining,
            imbalance=lanes.imbalance - change,
            previous_residual=residual,
            direction=direction,
            descent=positive_or_one(descent),
        )
    )


def subtract_response(bore: BoreArrays, remaining: Array, correction: Array) -> Array:
    """Subtract the displacements by pressure corrections from overlaps; in NumPy, only of lanes with corrections."""
    if arrays.namespace(correction) is not numpy:
        return remaining - apply_operator(bore, bore.softness, correction)
    corrected = correction.any(axis=0).any(axis=0)
    if corrected.any():
        remaining[..., corrected] -= apply_operator(bore, bore.softness, correction[..., corrected])
    return remaining


def refine_fields(bore: BoreArrays, fields: Array) -> Array:
    """Transfer fields (meridians, rings, lanes) from cells twice as wide to the bore's."""
    xp = arrays.namespace(fields)
    return xp.repeat(xp.repeat(fields, 2, axis=1)[:, : bore.gap.shape[1]], 2, axis=0)
