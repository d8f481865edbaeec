"""Calibration of a foundation modulus to a reference model, with the error of the closed form, and its description."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ..contact import Model
from ..core import arrays
from ..core.answers import Answer, Column, Row, Table
from ..core.arrays import Array
from ..core.kinds import NEWTONS, PERCENT, PLAIN, Kind
from ..core.unit_systems import Amount, Sentence
from ..model_catalogue import reference as exact
from ..models.foundation import RadialFoundation
from ..models.modulus import Modulus, constant, corrected_vessel, polynomial, spherical_vessel
from ..problem import Joint

Form = Callable[[Joint, numpy.ndarray], Modulus]
"""Function from a joint (numbers or arrays) and the target K in MPa/mm to a modulus."""

FORCES = (1000.0, 2000.0, 3000.0)
"""Default loads in N, over which p0/d is averaged, as in the paper."""


def as_constant(joint: Joint, wanted: numpy.ndarray) -> Modulus:
    """Fit a constant foundation modulus: the mean of the target moduli `wanted` in MPa/mm."""
    return constant(float(numpy.mean(wanted)))


def as_polynomial(joint: Joint, wanted: numpy.ndarray) -> Modulus:
    """Fit a foundation modulus K R2/E that is a polynomial of R2/L, Eq. (18), to moduli `wanted` in MPa/mm.

    K R2/E = C1 + C2 (R2/L) + C3 (R2/L)².

    The constants are 0 or more.

    Raises ValueError: a joint with fewer than three thicknesses.
    """
    from scipy.optimize import nnls

    thicknesses = numpy.unique(_to_floats(joint.thickness_ratio)).size
    if thicknesses < 3:
        raise ValueError(
            f"liner_thickness has {thicknesses} different values, but Eq. (18) has three constants: give 3 or more"
        )
    thickness_ratio, scaled_moduli = numpy.broadcast_arrays(
        _to_floats(joint.thickness_ratio), wanted * _to_floats(joint.socket_radius)
    )
    scaled_moduli = scaled_moduli / _to_floats(joint.liner.young)
    basis = numpy.stack([thickness_ratio.ravel() ** k for k in range(3)], axis=-1) / scaled_moduli.ravel()[:, None]
    constants, _ = nnls(basis, numpy.ones(scaled_moduli.size))
    return polynomial(*map(float, constants), source="fitted")


def as_corrected_vessel(joint: Joint, wanted: numpy.ndarray) -> Modulus:
    """Fit a foundation modulus K_B (a0 + a1 κ + a2 κ²) to target moduli `wanted` in MPa/mm.

    κ = R2/(R2 + L), and K_B is the modulus of a spherical vessel.
    """
    thickness_ratio = _to_floats(joint.thickness_ratio)
    kappa, correction_factor = numpy.broadcast_arrays(
        thickness_ratio / (1 + thickness_ratio), wanted / _to_floats(spherical_vessel(joint))
    )
    term_count = min(3, numpy.unique(kappa).size)  # one thickness determines one constant
    basis = numpy.stack([kappa.ravel() ** k for k in range(term_count)], axis=-1)
    constants = numpy.linalg.lstsq(basis, correction_factor.ravel(), rcond=None)[0]
    return corrected_vessel(*map(float, numpy.pad(constants, (0, 3 - term_count))), source="this project's fit")


@dataclass(frozen=True, kw_only=True, eq=False)
class Calibration:
    """Foundation modulus fitted to a reference model, with its errors.

    Attributes
    ----------
    modulus : Modulus
        Fitted modulus; `model` is the closed form with it.
    joint : Joint
        Joints of the fit (numbers or arrays).
    force : array
        Loads in N.
    wanted : array
        Target: p0/d of the reference in MPa/mm, averaged over the loads; shape of the joint.
    spread : float
        Largest relative deviation of p0/d at a single load from that mean.
    reference : Model
    """

    modulus: Modulus
    joint: Joint
    force: numpy.ndarray
    wanted: numpy.ndarray
    spread: float
    reference: Model

    @property
    def model(self) -> RadialFoundation:
        """Contact model of radial springs with the fitted modulus."""
        return RadialFoundation(modulus=self.modulus)

    @property
    def residual(self) -> numpy.ndarray:
        """Relative residual of the fitted foundation modulus: fitted over target modulus, minus 1.

        It has the shape of the joint.
        """
        return _to_floats(self.modulus(self.joint)) / self.wanted - 1

    @cached_property
    def error(self) -> dict[str, float]:
        """Largest relative error of the calibrated model over joints and loads, by quantity.

        In indentation, peak pressure and half angle at equal force; in force at equal indentation.
        """
        force = self.force.reshape(-1, *(1 for _ in numpy.shape(self.wanted)))
        reference_contact = self.reference.press(self.joint, force=force)
        contact_at_force = self.model.press(self.joint, force=force)
        contact_at_depth = self.model.press(self.joint, indentation=reference_contact.indentation)
        errors = {
            name: max_relative_error(getattr(contact_at_force, name), getattr(reference_contact, name))
            for name in ("indentation", "max_pressure", "half_angle")
        }
        return {**errors, "force": max_relative_error(contact_at_depth.force, reference_contact.force)}

    def summary(self) -> dict[str, Any]:
        """Return the calibration as a dictionary for JSON."""
        return {
            "reference": self.reference.name,
            "modulus": self.modulus.name,
            "constants": [float(constant_value) for constant_value in self.modulus.constants],
            "force": self.force.tolist(),
            "foundation_modulus": numpy.asarray(self.wanted).tolist(),
            "spread_over_load": self.spread,
            "residual": float(numpy.max(abs(self.residual))),
            "error": self.error,
        }


def calibrate(
    joint: Joint, *, force: Array = FORCES, form: Form = as_constant, reference: Model | None = None
) -> Calibration:
    """Fit a foundation modulus to a reference model, to the mean ratio of pole pressure to indentation.

    The paper fits its modulus to finite elements in the same way.

    Parameters
    ----------
    joint : Joint
        Geometry and layers; arrays (such as thicknesses) for a modulus that covers a family of joints.
    force : array
        Loads in N, all above 0.
    form : function
        `as_constant`, `as_polynomial` or `as_corrected_vessel`.
    reference : Model
        `Exact()` by default.

    Raises
    ------
    ValueError
        A load that is not above 0; a joint or load for which the reference has no result.

    Examples
    --------
    >>> import ballsocket as bs
    >>> hip = bs.joints["hess-forsbach"]
    >>> fit = bs.calibrate(hip)
    >>> round(fit.modulus(hip), 1), round(fit.model.press(hip, force=3000.0).max_pressure, 2)
    (278.0, 11.29)
    """
    model = exact if reference is None else reference
    loads = numpy.atleast_1d(numpy.asarray(force, dtype=float))
    if loads.size == 0 or not numpy.all(loads > 0):
        raise ValueError(f"force = {loads.tolist()} is not allowed: a calibration needs loads (N) above 0")
    joint_shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in joint.numbers()))
    contact = model.press(joint, force=loads.reshape(-1, *(1 for _ in joint_shape)))
    moduli = _to_floats(contact.foundation_modulus)
    if not numpy.all(numpy.isfinite(moduli)):
        raise ValueError(f"{model.name} has no result for some joints or loads: {'; '.join(contact.notes)}")
    wanted = numpy.mean(moduli, axis=0)
    return Calibration(
        modulus=form(joint, wanted),
        joint=joint,
        force=loads,
        wanted=wanted,
        spread=float(numpy.max(abs(moduli / wanted - 1))),
        reference=model,
    )


def describe_calibration(fit: Calibration) -> Answer:
    """Describe a fitted modulus with its residual and the error of the closed form that uses it."""
    foundation = Kind.FOUNDATION.written
    unit = foundation if fit.modulus.name == "constant" else PLAIN
    amounts = [(fit.modulus.name, Amount(constant, unit, 6)) for constant in map(float, fit.modulus.constants)]
    ends = dict.fromkeys([float(numpy.min(fit.wanted)), float(numpy.max(fit.wanted))])
    amounts += [("K = p0/d of the reference", Amount(end, foundation, 5)) for end in ends]
    low, high = (Amount(float(end), NEWTONS) for end in (fit.force.min(), fit.force.max()))
    shares = {
        Sentence("spread over {} to {}", low, high): fit.spread,
        "largest residual of the fit": float(numpy.max(abs(fit.residual))),
    }
    shares |= {f"closed form, worst error in {name.replace('_', ' ')}": error for name, error in fit.error.items()}
    amounts += [(title, Amount(share, PERCENT, 3)) for title, share in shares.items()]
    columns = [Column.of_words("number"), Column.of_number("value")]
    return Answer(
        title=str(fit.joint),
        tables=[Table("calibration", "Calibration", columns, [Row(cells) for cells in amounts])],
    )


def _to_floats(numbers: Array) -> numpy.ndarray:
    return numpy.asarray(arrays.to_numpy(numbers), dtype=float)


def max_relative_error(value: Array, truth: Array) -> float:
    """Compute the largest relative error of values against true values."""
    return float(numpy.max(abs(_to_floats(value) / _to_floats(truth) - 1)))
