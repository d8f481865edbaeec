"""Stress-strain curve of UHMWPE: the three-network model of Bergström & Bischoff 2010 in a bar.

Parameters of the paper for 300 K, as Ansys 2024 R2 prints them in its Verification Manual, VM314. The bar is
incompressible (bulk modulus 6000 MPa over shear moduli of 500 MPa).
"""

from __future__ import annotations

from math import exp, sqrt

import numpy

MU_A, MU_B, MU_B_FINAL, MU_C = 200.0, 293.0, 79.1, 10.0  # MPa
LOCKING_STRETCH, SECOND_INVARIANT_SHARE, EVOLUTION_RATE = 3.25, 0.23, 31.9
FLOW_A, FLOW_B, EXPONENT, PRESSURE_SHARE = 3.25, 20.1, 20.0, 0.073  # MPa, MPa, -, -


def compressed_bar(rate: float, strain: float = 0.045, steps: int = 4000) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Return true strains and true stresses (MPa, positive) of a bar in compression at a strain rate (1/s)."""
    flow_a, flow_b, mu_b, stresses = 0.0, 0.0, MU_B, []  # plastic log strains of the networks A and B
    step = strain / rate / steps
    for number in range(1, steps + 1):
        total = -number * strain / steps
        stress_a, stress_b = _eight_chain(MU_A, total - flow_a), _eight_chain(mu_b, total - flow_b)
        stresses.append(-(stress_a + stress_b + _network_c(total)))
        rate_a, rate_b = _flow_rate(stress_a, FLOW_A), _flow_rate(stress_b, FLOW_B)
        flow_a -= sqrt(2 / 3) * rate_a * step
        flow_b -= sqrt(2 / 3) * rate_b * step
        mu_b -= EVOLUTION_RATE * (mu_b - MU_B_FINAL) * rate_a * step
    return strain / steps * numpy.arange(1, steps + 1), numpy.array(stresses)


def _flow_rate(stress: float, resistance: float) -> float:
    """Effective rate (1/s), (tau/(tau_flow + a p))^m, under an axial stress: tau is the norm of its deviator."""
    return (sqrt(2 / 3) * abs(stress) / (resistance - PRESSURE_SHARE * stress / 3)) ** EXPONENT


def _inverse_langevin(x: float) -> float:
    return x * (3 - x * x) / (1 - x * x)


def _eight_chain(modulus: float, strain: float) -> float:
    """Axial minus lateral stress of the eight-chain model at a log strain."""
    axial, lateral = exp(2 * strain), exp(-strain)
    stretch = sqrt((axial + 2 * lateral) / 3)
    chain = _inverse_langevin(stretch / LOCKING_STRETCH) / _inverse_langevin(1 / LOCKING_STRETCH)
    return modulus / stretch * chain * (axial - lateral)


def _network_c(strain: float) -> float:
    axial, lateral = exp(2 * strain), exp(-strain)
    first = axial + 2 * lateral
    second = MU_C * (first * (axial - lateral) - (axial**2 - lateral**2))
    return (_eight_chain(MU_C, strain) + SECOND_INVARIANT_SHARE * second) / (1 + SECOND_INVARIANT_SHARE)
