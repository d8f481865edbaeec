"""Displacements of a hemispherical socket whose equator carries the tractions of the closed sphere, reversed.

At its equator the closed socket carries tractions t. A hemisphere has none. Its additional displacement u1 is caused
by the tractions -t in the hemisphere, which is fixed outside. Ritz' method finds u1 in polynomials of
ln r (1/r in an infinite layer) in each layer and of cos φ. The pressures of a contact fade towards the equator, so a
few modes suffice, and u1 is smooth along the bore.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf, log
from typing import Any

import numpy
from numpy.polynomial import legendre

from ...core.arrays import Numbers, gauss_legendre
from ...core.stress import Stress
from ...problem import Support
from .modes import Socket

MODES = 40  # number of modes of pressure whose tractions on the equator are released
POLAR_TERMS = 12  # number of polynomials along the meridian
_RADIAL = 5  # degree of the polynomials through each layer


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeFace:
    """Additional displacements and stresses of a hemispherical socket whose equator is free of traction.

    They are added to those of the closed sphere, whose tractions at the equator they cancel.
    """

    socket: Socket

    @cached_property
    def _radial_functions(self) -> tuple[Numbers, Numbers, Numbers, Numbers, Numbers]:
        """Radial shape functions of the displacements, at quadrature points.

        The arrays are radii r in mm, weights, functions and derivatives (points, functions), and the layer of a point.

        The first functions, one for each layer, are 1 at its inner surface. The others vanish at the layer surfaces.
        """
        layers = [self._layer_functions(number) for number in range(len(self.socket.shells))]
        r, w, f, slope = (numpy.concatenate(parts) for parts in zip(*layers, strict=True))
        return r, w, f, slope, numpy.repeat(numpy.arange(len(layers)), _RADIAL + 4)

    def _layer_functions(self, number: int) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Compute radii (mm), weights, and the radial shape functions with their derivatives in one layer."""
        shells = self.socket.shells
        bounds = numpy.cumsum([self.socket.radius, *(shell.thickness for shell in shells)])
        nodes, weights = (numpy.array(values) for values in gauss_legendre(_RADIAL + 4))
        count, bubbles = len(shells), _RADIAL - 1
        shapes, rates = _shifted_legendre(nodes, _RADIAL + 1)
        functions = numpy.zeros((2, len(nodes), count * _RADIAL))
        span = slice(count + number * bubbles, count + (number + 1) * bubbles)
        a = bounds[number]
        if shells[number].thickness == inf:  # functions of s = a/r that vanish at infinity
            radii, steps, rate = a / nodes, a / nodes**2, -(nodes**2) / a
            functions[0, :, number], functions[1, :, number] = nodes, rate
            hump = nodes * (1 - nodes)
            functions[0, :, span] = hump[:, None] * shapes[:, :bubbles]
            slopes = ((1 - 2 * nodes)[:, None] * shapes + hump[:, None] * rates) * rate[:, None]
            functions[1, :, span] = slopes[:, :bubbles]
        else:
            log_ratio = log(bounds[number + 1] / a)
            radii = a * numpy.exp(log_ratio * nodes)
            steps, rate = log_ratio * radii, 1 / (log_ratio * radii)
            functions[0, :, number], functions[1, :, number] = 1 - nodes, -rate
            if number + 1 < count:
                functions[0, :, number + 1], functions[1, :, number + 1] = nodes, rate
            scale = numpy.sqrt(2 * numpy.arange(1, _RADIAL) + 1)
            functions[0, :, span] = (shapes[:, 2:] - shapes[:, :-2]) / (2 * scale)
            functions[1, :, span] = scale * shapes[:, 1:-1] * rate[:, None]
        return radii, weights * steps, functions[0], functions[1]

    @cached_property
    def _stiffness_matrix(self) -> Numbers:
        """Stiffness over 2π, for coefficients of u_r = f(r) P(cos φ), then of u_φ = f(r) sin φ P(cos φ)."""
        r, w, f, slope, layer = self._radial_functions
        young, nu = numpy.array([(shell.young, shell.poisson) for shell in self.socket.shells])[layer].T
        lame, shear = _lame_constants(young, nu)
        x, weight = (numpy.array(part) for part in gauss_legendre(POLAR_TERMS + 3))
        P, P_rate, Q, Q_rate, Q_cot = _polar_functions(x)
        hoop, g = Q_rate + Q_cot, slope * r[:, None]

        def polar(a: Numbers, b: Numbers) -> Numbers:  # integrals along the meridian: (a, b)
            return a.T @ (weight[:, None] * b)

        def radial(a: Numbers, b: Numbers, factor: Numbers) -> Numbers:  # integrals over the radius: (a, b)
            return a.T @ ((w * factor)[:, None] * b)

        # rr, rp, pp: blocks of the radial, mixed and polar displacement coefficients
        mixed, kron = radial(g, f, lame), numpy.kron
        stretch = radial(g, g, lame + 2 * shear) + 2 * (mixed + mixed.T) + radial(f, f, 4 * (lame + shear))
        rr = kron(stretch, polar(P, P)) + kron(radial(f, f, shear), polar(P_rate, P_rate))
        rp = kron(mixed + radial(f, f, 2 * (lame + shear)), polar(P, hoop))
        rp = rp + kron(radial(f, g - f, shear), polar(P_rate, Q))
        pp = kron(radial(f, f, lame), polar(hoop, hoop))
        pp = pp + kron(radial(f, f, 2 * shear), polar(Q_rate, Q_rate) + polar(Q_cot, Q_cot))
        pp = pp + kron(radial(g - f, g - f, shear), polar(Q, Q))
        return numpy.block([[rr, rp], [rp.T, pp]])

    @cached_property
    def displacement_coefficients(self) -> Numbers:
        """Coefficients of the additional displacements u_r and u_φ per unit of each pressure mode p_n.

        The shape is (2, radial functions, polar functions, modes).
        """
        r, w, f, _, _ = self._radial_functions
        n, P = numpy.arange(MODES), numpy.zeros(MODES)  # P_n(0), and slopes P_n'(0)
        P[0] = 1.0
        for k in range(2, MODES, 2):
            P[k] = -(k - 1) / k * P[k - 2]
        slope = n * numpy.concatenate([[0.0], P[:-1]])
        fields = self.socket.fields(n, r)
        factor = w * r
        corner = _shifted_legendre(numpy.zeros(1), POLAR_TERMS)[0][0]
        # work of the reversed tractions -t of the equator on each function, over 2π
        sideways = (slope[:, None] * fields.sigma_rphi * factor) @ f  # dP_n/dφ = -slope
        meridional = -(P[:, None] * fields.sigma_phiphi * factor) @ f
        loads = numpy.concatenate([numpy.kron(work, corner) for work in (sideways, meridional)], axis=1).T
        return numpy.linalg.solve(self._stiffness_matrix, loads).reshape(2, -1, POLAR_TERMS, MODES)

    def liner_stress(self, pressure: Numbers, angle: Numbers) -> Stress:
        """Compute the additional stresses in the liner in MPa from pressure modes: (angles, `liner_radii`)."""
        shell, count = self.socket.shells[0], len(self.liner_radii)
        r, _, f, slope, _ = (part[:count] for part in self._radial_functions)
        radial, sideways = self.displacement_coefficients @ pressure
        P, P_rate, Q, Q_rate, Q_cot = _polar_functions(numpy.cos(angle))
        radial_displacement = P @ (f @ radial).T
        strain_r = P @ (slope @ radial).T
        strain_phi, strain_theta = ((radial_displacement + rate @ (f @ sideways).T) / r for rate in (Q_rate, Q_cot))
        shear = P_rate @ (f @ radial / r[:, None]).T + Q @ ((slope - f / r[:, None]) @ sideways).T
        lame, rigidity = _lame_constants(shell.young, shell.poisson)
        volumetric = lame * (strain_r + strain_phi + strain_theta)
        return Stress(
            radial=volumetric + 2 * rigidity * strain_r,
            meridional=volumetric + 2 * rigidity * strain_phi,
            hoop=volumetric + 2 * rigidity * strain_theta,
            shear=rigidity * shear,
        )

    @property
    def liner_radii(self) -> Numbers:
        """Radii in mm at which the stresses in the liner are computed."""
        return self._radial_functions[0][: _RADIAL + 4]

    @cached_property
    def bore_displacement(self) -> Numbers:
        """Legendre coefficients of the additional radial displacement of the bore, per unit of p_n: (terms, modes)."""
        # coefficients of P_n(x) in each polynomial P_k(2x - 1)
        x, weight = legendre.leggauss(POLAR_TERMS)
        waves = legendre.legvander(x, POLAR_TERMS - 1)
        half_range = legendre.legvander(2 * x - 1, POLAR_TERMS - 1)
        full_range = ((numpy.arange(POLAR_TERMS) + 0.5)[:, None] * waves.T * weight) @ half_range
        return full_range @ self.displacement_coefficients[0, 0]


def _shifted_legendre(x: Numbers, count: int) -> tuple[Numbers, Numbers]:
    """Compute the Legendre polynomials P_k(2x - 1) and their derivatives by x: (points, count)."""
    values = legendre.legvander(2 * x - 1, count - 1)
    rates = numpy.zeros_like(values)
    for k in range(1, count):  # P_k' = P_k-2' + (2k - 1) P_k-1
        rates[:, k] = 2 * (2 * k - 1) * values[:, k - 1] + (rates[:, k - 2] if k > 1 else 0.0)
    return values, rates


def _polar_functions(x: Numbers) -> tuple[Numbers, Numbers, Numbers, Numbers, Numbers]:
    """Compute the shape functions of the displacements along the meridian, and their derivatives by φ.

    They are those of u_r and their derivatives, then those of u_φ, their derivatives and their products with cot φ.
    """
    P, rates = _shifted_legendre(x, POLAR_TERMS)
    sine, cosine = numpy.sqrt(1 - x * x)[:, None], x[:, None]
    return P, -sine * rates, sine * P, cosine * P - sine**2 * rates, cosine * P


def _lame_constants(young: Any, poisson: Any) -> tuple[Any, Any]:
    """Compute Lamé's constants λ and G in MPa; G is the shear modulus."""
    return young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))


@lru_cache(maxsize=8)
def free_face_of(socket: Socket) -> FreeFace | None:
    """Return the correction of a socket for a free equator, from a cache; None if it stands on its rim."""
    stands_on_rim = socket.support is Support.FREE and socket.shells[-1].thickness < inf
    return None if stands_on_rim else FreeFace(socket=socket)
