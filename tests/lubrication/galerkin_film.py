"""Steady film of a ball on springs by finite elements: a check of the finite volumes by another method.

Galerkin's method with quadratic elements in polar angle and azimuth, in half of the bore; the motion is along the plane
of symmetry. The film is not upwinded. Negative pressures are limited by a penalty, which is Reynolds' condition.

`python -m tests.lubrication.galerkin_film` prints centre and least film in nm: 515.2 and 433.0 at 10 rad/s, 1774.2 and
1456.1 at 100 rad/s. At 10 rad/s, 27 105 unknowns in place of 11 613 change neither.
"""

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from skfem import Basis, BilinearForm, ElementQuad2, LinearForm, MeshQuad

from ballsocket.lubrication.mesh import graded_rings

RADIUS, CLEARANCE, MODULUS, VISCOSITY, FORCE = 18.0, 0.1, 276.67, 2.5e-9, 1500.0
INDENTATION = 0.02697957310829604
EDGE = np.arccos(CLEARANCE / (CLEARANCE + INDENTATION))
PENALTY = 1e5
"""Volume per area, time and negative pressure in mm/(s MPa)."""


class GalerkinFilm:
    """Film of a ball that turns about x at a rate in rad/s, loaded along z."""

    def __init__(self, rate, finest, coarsest, meridians, growth):
        rings = graded_rings(EDGE, finest=np.radians(finest), coarsest=np.radians(coarsest), growth=growth)
        mesh = MeshQuad.init_tensor(rings, np.linspace(-np.pi / 2, np.pi / 2, meridians + 1))
        self.basis = Basis(mesh, ElementQuad2(), intorder=5)
        self.theta, self.phi = self.basis.doflocs
        theta, phi = self.basis.global_coordinates()
        self.rate, self.sine = rate, np.sin(theta)
        self.area = RADIUS**2 * self.sine
        self.velocity = -RADIUS * rate * np.sin(phi), -RADIUS * rate * np.cos(theta) * np.cos(phi)
        self.normal = np.stack([self.sine * np.sin(phi), np.cos(theta)])  # y and z
        self.pole = np.flatnonzero(self.theta < 1e-12)
        self.reduction = self.reduce()
        weights = [LinearForm(lambda v, w, n=n: n * v * self.area).assemble(self.basis) for n in self.normal]
        self.weight = np.stack(weights)

    def reduce(self):
        """Matrix from unknowns to nodes: one value at the pole, and none at the rim."""
        rim = np.flatnonzero(self.theta > np.pi / 2 - 1e-9)
        number = np.arange(self.basis.N)
        number[self.pole] = self.pole[0]
        free = np.setdiff1d(np.arange(self.basis.N), np.union1d(rim, self.pole[1:]))
        position = np.full(self.basis.N, -1)
        position[free] = np.arange(len(free))
        rows = np.setdiff1d(np.arange(self.basis.N), rim)
        return scipy.sparse.csr_matrix((np.ones(len(rows)), (rows, position[number[rows]])), (self.basis.N, len(free)))

    def slopes(self, field):
        """Slopes along the meridian and around in 1/mm."""
        along, around = field.grad
        return along / RADIUS, around / self.sine / RADIUS

    def film(self, pressure, shift):
        """Film thickness in mm at the points of integration."""
        springs = np.asarray(self.basis.interpolate(pressure)) / MODULUS
        return CLEARANCE - np.einsum("i,ijk->jk", shift, self.normal) + springs

    def newton_step(self, pressure, shift, old, step):
        """Changes of pressure in MPa and of the displacement in mm in a time step."""
        field, film = self.basis.interpolate(pressure), self.film(pressure, shift)
        slope, value = self.slopes(field), np.asarray(field)
        along, around = self.velocity

        def flow(thickness_factor, gradient, carried, v):
            test = self.slopes(v)
            pressed = thickness_factor / (12 * VISCOSITY) * (gradient[0] * test[0] + gradient[1] * test[1])
            return pressed - 0.5 * carried * (along * test[0] + around * test[1])

        def residual(v, w):
            stored = (film - old) / step + PENALTY * np.minimum(value, 0)
            return (flow(film**3, slope, film, v) + stored * v) * self.area

        def by_film(change, v):
            return flow(3 * film**2 * change, slope, change, v) + change / step * v

        def by_pressure(u, v, w):
            pressed = flow(film**3, self.slopes(u), 0.0, v) + PENALTY * (value < 0) * u * v
            return (pressed + by_film(u / MODULUS, v)) * self.area

        basis, reduce = self.basis, self.reduction
        right = reduce.T @ LinearForm(residual).assemble(basis)
        matrix = (reduce.T @ BilinearForm(by_pressure).assemble(basis) @ reduce).tocsc()
        by_shift = [LinearForm(lambda v, w, n=n: by_film(-n, v) * self.area).assemble(basis) for n in self.normal]
        factor = scipy.sparse.linalg.splu(matrix)
        alone = -(reduce @ factor.solve(right))
        response = -(reduce @ factor.solve(reduce.T @ np.stack(by_shift, axis=1)))
        missing = np.array([0.0, FORCE / 2]) - self.weight @ (pressure + alone)
        shift_change = np.linalg.solve(self.weight @ response, missing)
        return alone + response @ shift_change, shift_change

    def advance(self, pressure, shift, step):
        """Pressure and displacement after a time step."""
        old = self.film(pressure, shift)
        for _ in range(30):
            film = self.film(pressure, shift)
            change, move = self.newton_step(pressure, shift, old, step)
            fall = -(self.film(pressure + change, shift + move) - film)
            thin = fall > 0.6 * film
            length = (0.6 * film[thin] / fall[thin]).min() if thin.any() else 1.0
            pressure, shift = pressure + length * change, shift + length * move
            if length == 1.0 and np.abs(change).max() < 1e-7 * pressure.max():
                break
        return pressure, shift

    def solve(self):
        """Centre and least film in mm, by time steps that grow."""
        depth = CLEARANCE + INDENTATION
        pressure = MODULUS * np.maximum(depth * np.cos(self.theta) - CLEARANCE, 0.0)
        shift, step = np.array([0.0, depth - 5e-4 * np.sqrt(self.rate / 10)]), 2e-3 / self.rate
        while step < 3 / self.rate:
            pressure, shift = self.advance(pressure, shift, step)
            step *= 1.8
        pressure, shift = self.advance(pressure, shift, 1e12)
        side = np.sin(self.theta) * np.sin(self.phi)
        film = CLEARANCE - shift[0] * side - shift[1] * np.cos(self.theta) + pressure / MODULUS
        return film[self.pole[0]], film[self.theta < EDGE].min()


if __name__ == "__main__":
    for rate, finest in ((10.0, 0.06), (100.0, 0.2)):
        print(rate, 1e6 * np.array(GalerkinFilm(rate, finest, 1.0, 24, 1.15).solve()))
