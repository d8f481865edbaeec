"""Inlet of a thin film under an elastic half-space: a nonlinear eigenvalue problem, solved to four digits.

h* is the film that is carried in. With X = x/l, l = (h* E*/(2 A))^(2/3), H = h/h* and P = p/(A sqrt(l)) it obeys

    dP/dX = λ (H - 1)/H³,    H = 1 + (2/3)(-X)_+^(3/2) - (1/π) ∫ (P - sqrt(X_+)) ln|X - S| dS,

where sqrt(X) is the dry pressure. Far upstream P ~ (9/8) λ/X². Far within the contact P - sqrt(X) ~ (α - ln X/(4 π λ))
X^(-3/2), and ∫ (P - sqrt(X_+)) dX = 0. There is a solution for one λ = 6 η U l^(1/2)/(A h*²), so that
h* = (6/(2^(1/3) λ))^(3/5) (η U)^(3/5) E*^(1/5) A^(-4/5).

Newton's method on a graded grid: P is linear between its points, H is taken at the middles.
`python -m tests.lubrication.inlet_problem` prints C on three grids: 1.50052, 1.50059, 1.50060.
"""

import itertools

import numpy as np

UPSTREAM, DOWNSTREAM = 200.0, 400.0
"""Ends of the grid."""

GAUSS = np.polynomial.legendre.leggauss(24)


def estimate(points):
    """First estimate of P, with its powers on both sides."""
    return np.sqrt((points + np.hypot(points, 0.69)) / 2) / (1 + (np.minimum(points, 0.0) / 1.5) ** 2)


def make_grid(finest):
    """Points that are `finest` apart near the edge and grow apart in proportion further out."""

    def side(end):
        points, step = [0.0], finest
        while points[-1] < end:
            points.append(points[-1] + step)
            step *= 1 + finest if points[-1] > 1.5 else 1.0
        return np.array(points)

    return np.concatenate([-side(UPSTREAM)[::-1], side(DOWNSTREAM)[1:]])


def second_antiderivative(u):
    """Second antiderivative of ln|u|."""
    size = np.abs(u)
    return np.where(size > 0, size**2 / 2 * np.log(np.where(size > 0, size, 1.0)) - 0.75 * size**2, 0.0)


def hat_potentials(points, middles):
    """∫ hat_j(S) ln|X - S| dS at the middles; the ends of the grid have no hat."""
    slope = -np.diff(second_antiderivative(middles[:, None] - points[None, :])) / np.diff(points)
    hats = np.zeros((len(middles), len(points)))
    hats[:, 1:-1] = -np.diff(slope)
    return hats


def gauss_points(low, high):
    """Points and weights between two ends; the weights crowd at the lower end as a square."""
    t, weight = (GAUSS[0] + 1) / 2, GAUSS[1] / 2
    return low + (high - low) * t * t, weight * 2 * t * (high - low)


def root_correction(points, middles):
    """Potential of the piecewise linear form of sqrt(S) less that of sqrt(S) itself, which has an infinite slope."""
    potential = np.zeros(len(middles))
    for low, high in itertools.pairwise(points):
        if low < 0 or low > 60:
            continue
        for start, end in ((low, (low + high) / 2), (high, (low + high) / 2)):
            nodes, weights = gauss_points(end, start) if low > 0 else gauss_points(start, end)
            slope = (np.sqrt(high) - np.sqrt(low)) / (high - low)
            excess = np.sqrt(low) + slope * (nodes - low) - np.sqrt(nodes)
            distance = np.abs(middles[:, None] - nodes[None, :])
            potential += np.log(np.maximum(distance, 1e-300)) @ (excess * np.abs(weights))
    return potential


def tail_potentials(end, middles):
    """Potentials and integrals beyond the grid of S^(-3/2) and of S^(-3/2) ln S."""
    marks = [0.0, *(10.0**-k for k in range(8, 0, -1)), 0.5, *(1 - 10.0**-k for k in range(1, 9)), 1.0]
    nodes, weights = np.polynomial.legendre.leggauss(40)
    t = np.concatenate([(b - a) / 2 * nodes + (a + b) / 2 for a, b in itertools.pairwise(marks)])
    w = np.concatenate([(b - a) / 2 * weights for a, b in itertools.pairwise(marks)])
    place, weight = end / t**2, 2 * end**-0.5 * w  # S = end/t²
    logarithms = np.log(np.abs(middles[:, None] - place))
    forms = weight, weight * np.log(place)
    return [logarithms @ form for form in forms], [form.sum() for form in forms]


def solve_inlet(finest):
    """Solve the inlet on a grid; return λ and the largest residual of the last step."""
    points = make_grid(finest)
    middles, step, count, end = (points[1:] + points[:-1]) / 2, np.diff(points), len(points), points[-1]
    hats, dry = hat_potentials(points, middles), np.sqrt(np.maximum(points, 0.0))
    rigid = 1 + 2 / 3 * np.maximum(-middles, 0.0) ** 1.5
    root = root_correction(points, middles)
    (tail, log_tail), (mass, log_mass) = tail_potentials(end, middles)
    slope = (np.eye(count)[1:] - np.eye(count)[:-1]) / step[:, None]
    weight = (np.append(step, 0.0) + np.append(0.0, step)) / 2
    dry_excess = weight @ dry - 2 / 3 * end**1.5
    pressure, eigenvalue = estimate(points), 2.42
    last = np.zeros(count)
    last[-1] = end**1.5  # derivative of α by the last pressure
    for _ in range(60):
        excess, decay = pressure - dry, 1 / (4 * np.pi * eigenvalue)
        alpha = excess[-1] * end**1.5 + decay * np.log(end)
        film = rigid - (hats @ excess + root + alpha * tail - decay * log_tail) / np.pi
        film = np.maximum(film, 0.3)
        film_by_pressure = -(hats + np.outer(tail, last)) / np.pi
        film_by_eigenvalue = (tail * np.log(end) - log_tail) * decay / eigenvalue / np.pi
        gain = -eigenvalue * (1 / film**3 - 3 * (film - 1) / film**4)
        matrix, right = np.zeros((count + 1, count + 1)), np.zeros(count + 1)
        matrix[: count - 1, :count] = slope + gain[:, None] * film_by_pressure
        matrix[: count - 1, count] = -(film - 1) / film**3 + gain * film_by_eigenvalue
        right[: count - 1] = -(slope @ pressure - eigenvalue * (film - 1) / film**3)
        matrix[count - 1, 0], matrix[count - 1, count] = 1.0, -9 / 8 / points[0] ** 2
        right[count - 1] = -(pressure[0] - eigenvalue * 9 / 8 / points[0] ** 2)
        matrix[count, :count] = weight + mass * last
        matrix[count, count] = -(mass * np.log(end) - log_mass) * decay / eigenvalue + 9 / 8 / abs(points[0])
        right[count] = -(weight @ excess + dry_excess + alpha * mass - decay * log_mass)
        right[count] -= eigenvalue * 9 / 8 / abs(points[0])
        scale = 1 / np.abs(matrix).max(axis=1)
        change = np.linalg.solve(matrix * scale[:, None], right * scale)
        fall = film_by_pressure @ change[:-1] + film_by_eigenvalue * change[-1]
        thin = fall < -0.5 * film
        length = max(0.1, (0.5 * film[thin] / -fall[thin]).min()) if thin.any() else 1.0
        pressure, eigenvalue = pressure + length * change[:-1], eigenvalue + length * change[-1]
        if length == 1.0 and np.abs(change).max() < 1e-11:
            break
    return eigenvalue, np.abs(change).max()


def inlet_coefficient(eigenvalue):
    """C in h* = C (η U)^(3/5) E*^(1/5) A^(-4/5)."""
    return (6 / (2 ** (1 / 3) * eigenvalue)) ** 0.6


if __name__ == "__main__":
    for spacing in (0.05, 0.025, 0.0125):
        number, error = solve_inlet(spacing)
        print(f"{spacing:7.4f}  λ {number:.6f}  C {inlet_coefficient(number):.5f}  last change {error:.1e}")
