"""A linear problem whose profile likelihood, information and gains are known in closed form."""

from dataclasses import dataclass

import numpy as np

import ballsocket as bs
from ballsocket.core.quantities import QUANTITIES
from ballsocket.identify import Measured
from ballsocket.identify.misfit import Misfit, by_differences
from ballsocket.identify.scatter import NormalScatter
from ballsocket.identify.unknowns import ParameterTransform, Unknown
from ballsocket.studies import Rectangular

MATRIX = np.array([[1.0, 0.5], [0.3, 2.0], [-1.0, 1.0], [0.5, 0.5], [2.0, -0.3]])
TRUTH = np.array([0.1, -0.2])
NAMES = ("liner_poisson", "ball_poisson")


@dataclass(frozen=True)
class LinearForward:
    """Forward model with results that are linear in the unknowns."""

    data: tuple
    matrix: np.ndarray
    model: object = bs.HessForsbach()

    def results_at(self, values, load_perturbation=0.0):
        return values @ self.matrix.T * (1 + load_perturbation)


def unknown(name, prior=None, low=-0.9, high=0.45):
    prior = prior or Rectangular(low=low, high=high)
    return Unknown(name=name, quantity=QUANTITIES[name], prior=prior, low=low, high=high, logarithmic=False)


def linear_misfit(noise=0.0, unknowns=None, scatter=None, matrix=MATRIX, uncertainty=0.02, saturation=np.inf):
    """Return the misfit of five values, shifted by 5 so that none is negative."""
    unknowns = unknowns or tuple(unknown(name) for name in NAMES)
    values = matrix @ TRUTH[: matrix.shape[1]] + noise
    data = Measured(quantity="force", values=values + 5.0, uncertainty=uncertainty, indentation=np.ones(len(values)))
    object.__setattr__(data, "values", values)
    object.__setattr__(data, "saturation", saturation)
    forward = LinearForward((data,), matrix)
    transform = ParameterTransform(tuple(unknowns))
    return Misfit(forward, transform, scatter or NormalScatter(), by_differences, np.full(len(values), uncertainty))


def scaled_covariance(misfit, matrix=MATRIX, uncertainty=0.02):
    """Return the covariance of theta."""
    spans = np.array([unknown.prior_deviation for unknown in misfit.transform.unknowns])
    slopes = matrix * spans / uncertainty
    return np.linalg.inv(slopes.T @ slopes)
