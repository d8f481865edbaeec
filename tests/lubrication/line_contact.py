"""Isoviscous film of an elastic cylinder on a plane: centre, and constriction of the outlet.

Lengths over the half width a of the dry contact, pressures over its maximum p_H, and film H = h R/a² obey

    (H³ P')' = λ H',    H = H0 + X²/2 - (1/π) ∫ P ln|X - S| dS,    ∫ P dS = π/2,    P >= 0,

with λ = 6 η U R²/(a³ p_H). For λ -> 0 inlet and outlet are those of a half-space, A = sqrt(2) p_H/sqrt(a) and
E* = 2 p_H R/a.

`python -m tests.lubrication.line_contact` prints λ, C at the centre and the ratio of the outlet. They are 1.5237 and
0.794 at 1e-3, 1.5097 and 0.795 at 1e-4, 1.5041 and 0.795 at 1e-5. The error of the grid is about 1e-3.
"""

import numpy as np

from .inlet_problem import hat_potentials

LEFT, RIGHT, COARSEST = -4.0, 2.0, 0.02


def graded_points(finest):
    """Points that are finest at both edges of the dry contact."""

    def line(start, end):
        points, step, sign = [start], finest, np.sign(end - start)
        while (end - points[-1]) * sign > 0:
            points.append(points[-1] + sign * step)
            step = min(1.06 * step, COARSEST)
        return np.array(points)

    parts = [line(-1.0, LEFT), line(-1.0, 0.0)[:-1], line(1.0, 0.0)[:-1], line(1.0, RIGHT)]
    return np.unique(np.concatenate(parts).round(12))


def solve_contact(number, start=None):
    """Solve the film at λ = `number`; return points, pressure, film and its level H0."""
    points = graded_points(max(0.0375 * number**0.4 + 2e-5, 2e-4))
    count, step, bend = len(points), np.diff(points), -hat_potentials(points, points) / np.pi
    pressure = np.sqrt(np.maximum(1 - points**2, 0.0)) if start is None else np.interp(points, *start[:2])
    level = -0.25 if start is None else start[3]
    weight = (np.append(step, 0.0) + np.append(0.0, step)) / 2
    slope = (np.eye(count)[1:] - np.eye(count)[:-1]) / step[:, None]
    middle = (bend[1:] + bend[:-1]) / 2
    for _ in range(100):
        film = level + points**2 / 2 + bend @ pressure
        at_middle = (film[1:] + film[:-1]) / 2
        fall = slope @ pressure
        residual, by_film = at_middle**3 * fall - number * at_middle, 3 * at_middle**2 * fall - number
        jacobian = by_film[:, None] * middle + (at_middle**3)[:, None] * slope
        balance = np.concatenate([[0.0], np.diff(residual), [0.0]])
        active = (pressure > 0) | (balance > 1e-14)
        active[[0, -1]] = False
        cells = np.flatnonzero(active)
        matrix = np.zeros((len(cells) + 1, len(cells) + 1))
        matrix[:-1, :-1] = np.diff(jacobian, axis=0)[cells - 1][:, cells]
        matrix[:-1, -1] = np.diff(by_film)[cells - 1]
        matrix[-1, :-1] = weight[cells]
        right = np.append(-balance[cells], np.pi / 2 - weight @ pressure)
        scale = 1 / np.abs(matrix).max(axis=1)
        solution = np.linalg.solve(matrix * scale[:, None], right * scale)
        change = np.zeros(count)
        change[cells] = solution[:-1]
        growth = solution[-1] + bend @ change
        thin = growth < -0.5 * film
        length = max(0.02, (0.5 * film[thin] / -growth[thin]).min()) if thin.any() else 1.0
        later = np.maximum(pressure + length * change, 0.0)
        error = np.abs(later - pressure).max()
        pressure, level = later, level + length * solution[-1]
        if length == 1.0 and error < 1e-10:
            break
    return points, pressure, level + points**2 / 2 + bend @ pressure, level


def contact_films(least):
    """λ, C at the centre and ratio of the outlet for λ from 0.1 to the least one."""
    rows, state, number = [], None, 0.1
    while number > 0.99 * least:
        state = solve_contact(number, state)
        points, pressure, film, _ = state
        centre = np.interp(0.0, points, film)
        coefficient = centre / ((number / 6) ** 0.6 * 2**0.2 * 2**-0.4)
        rows.append((number, coefficient, film[pressure > 1e-3].min() / centre))
        number /= np.sqrt(10)
    return np.array(rows)


if __name__ == "__main__":
    for row in contact_films(1e-5):
        print("{:.1e}  C {:.4f}  outlet {:.4f}".format(*row))
