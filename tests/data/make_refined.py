"""Fit the 23 coefficients of `Refined` to `Exact` and print them, or print the points that the fit has not seen.

    python tests/data/make_refined.py                                                    # one minute
    python tests/data/make_refined.py --reference > tests/data/refined_reference.csv

Least squares from a rough start, then the smallest worst error by successive linear programs: the errors are those of
ln d, ln p0, ln F at a given half angle and of ln d, ln p0 at a given force, on a grid over the box of validity; points
outside it count with a weight of 0.07. What it prints is `data/refined.toml`. The optimum is flat: another grid moves
the second or third digit of the coefficients.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import pairwise, product

import numpy as np
from scipy.optimize import least_squares, linprog

import ballsocket as bs
from ballsocket.models.liner_compliance import liner_coefficients
from ballsocket.models.refined import FIT, scaled_contact

SIZES = {"waves": 4, "level": 4, "edge": 10, "exponent": 5}
ROUGH = np.array([0.6, 2.0, 4.0, 20.0, *[0.0] * 4, 0.1, 0.25, *[0.0] * 8, -0.3, -0.5, *[0.0] * 3])


def joint_of(poisson, ratio) -> bs.Joint:
    """R2 = 18 mm, c = 0.01 mm, E = 1000 MPa, a rigid ball: the scaled answer does not depend on these."""
    liner = bs.Material(young=1000.0, poisson=poisson)
    return bs.Joint(ball_radius=17.99, clearance=0.01, liner_thickness=18.0 / ratio, liner=liner)


def chebyshev(low: float, high: float, count: int) -> np.ndarray:
    return (low + high) / 2 - (high - low) / 2 * np.cos(np.pi * np.arange(count) / (count - 1))


class Points:
    """Half angles of several joints with the exact ln d, ln p0, ln F."""

    def __init__(self, angles: np.ndarray, pairs: list[tuple[float, float]], weight: float):
        contacts = [bs.Exact(tolerance=1e-5).press(joint_of(*pair), half_angle=np.radians(angles)) for pair in pairs]
        self.angle = np.tile(np.radians(angles), len(pairs))
        self.pairs = np.repeat(np.array(pairs), len(angles), axis=0)
        self.logs = np.log([np.concatenate([getattr(c, name) for c in contacts]) for name in NAMES])
        self.weight = np.full(len(self.angle), weight)
        self.slopes = np.repeat([[2.0], [1.0], [3.0]], len(self.angle), axis=1)


NAMES = ("indentation", "max_pressure", "force")


def grid() -> Points:
    poisson = np.unique([*np.round(0.5 - 0.5 * np.exp(chebyshev(np.log(0.03), np.log(0.44), 11)), 3), 0.3, 0.48])
    ratio = np.unique([*np.exp(chebyshev(np.log(0.9), np.log(7.0), 12)), 1.0, 6.5])
    inside = [(nu, r) for nu, r in product(poisson, ratio) if 0.3 <= nu <= 0.48 and 1.0 <= r <= 6.5]
    angles = np.unique([*chebyshev(15.0, 60.0, 19), 18.0, 20.0])
    rng = np.random.default_rng(2)
    wide = list(zip(rng.uniform(0.0, 0.49, 60), np.exp(rng.uniform(np.log(0.5), np.log(10.0), 60)), strict=True))
    points, outside = Points(angles, inside, 1.0), Points(rng.uniform(3.0, 75.0, 12), wide, 0.07)
    for name, axis in {"angle": 0, "pairs": 0, "weight": 0, "logs": 1, "slopes": 1}.items():
        setattr(points, name, np.concatenate([getattr(points, name), getattr(outside, name)], axis=axis))
    return points


def fit_from(x: np.ndarray) -> dict[str, list[float]]:
    """The coefficients by their names."""
    ends = np.cumsum([0, *SIZES.values()])
    parts = {name: x[first:last].tolist() for name, (first, last) in zip(SIZES, pairwise(ends), strict=True)}
    return {**parts, "plane": FIT["plane"]}


def logs_of(x: np.ndarray, points: Points, angle: np.ndarray, which: np.ndarray) -> np.ndarray:
    """ln d, ln p0, ln F of `Refined` with these coefficients at half angles."""
    joint = joint_of(*points.pairs[which].T)
    with np.errstate(all="ignore"):
        liner = liner_coefficients(joint.liner.poisson, 1 + joint.liner_thickness / joint.socket_radius)
        at = scaled_contact(angle, liner, fit_from(x))
        d = joint.clearance * at.indentation
        p0 = d * joint.liner.young / (joint.socket_radius * at.compliance)
        force = d * joint.liner.young * joint.socket_radius * at.secant[0]
        return np.log([d, p0, force])


def errors(x: np.ndarray, points: Points, which: np.ndarray) -> np.ndarray:
    """Five rows: of d, p0, F at the half angle, of d, p0 at the force."""
    d, p0, force = logs_of(x, points, points.angle[which], which) - points.logs[:, which]
    slope = points.slopes[:, which]
    shift = force / slope[2]
    rows = np.stack([d, p0, force, d - shift * slope[0], p0 - shift * slope[1]]) * points.weight[which]
    return np.nan_to_num(rows, nan=1.0, posinf=1.0, neginf=1.0)


def update_slopes(x: np.ndarray, points: Points) -> None:
    every, step = np.arange(len(points.angle)), 1e-5
    above, below = (logs_of(x, points, points.angle * np.exp(sign * step), every) for sign in (1, -1))
    points.slopes = (above - below) / (2 * step)


def jacobian(residual: Callable, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    start = residual(x)
    steps = 1e-6 * np.maximum(1.0, np.abs(x))
    columns = [(residual(x + step * unit) - start) / step for step, unit in zip(steps, np.eye(len(x)), strict=True)]
    return start, np.stack(columns, axis=1)


def smallest_worst(residual: Callable, x: np.ndarray, rounds: int = 15) -> tuple[np.ndarray, float]:
    """min max |residual| by linear programs inside a trust region."""
    region, best = 0.01, np.abs(residual(x)).max()
    for _ in range(rounds):
        start, slopes = jacobian(residual, x)
        scale = 1 / np.maximum(np.abs(slopes).max(axis=0), 1e-9)
        one, cost, before = np.ones((len(start), 1)), np.zeros(len(x) + 1), best
        cost[-1] = 1.0
        rows, right = np.block([[slopes * scale, -one], [-slopes * scale, -one]]), np.concatenate([-start, start])
        for _ in range(6):
            bounds = [(-region, region)] * len(x) + [(0, None)]
            answer = linprog(cost, A_ub=rows, b_ub=right, bounds=bounds, method="highs")
            tried = x + scale * answer.x[:-1]
            worst = np.abs(residual(tried)).max()
            if worst < best - 1e-9:
                gain = (best - worst) / (best - answer.x[-1] + 1e-15)
                x, best, region = tried, worst, region * (2.0 if gain > 0.7 else 0.5 if gain < 0.3 else 1.0)
                break
            region /= 4
        if before - best < 1e-4 * before:
            break
    return x, best


def fit() -> None:
    points, x, rng = grid(), ROUGH, np.random.default_rng(0)
    every = np.arange(len(points.angle))
    print(f"# {len(every)} points, {int((points.weight == 1).sum())} of them in the box", file=sys.stderr)
    for _ in range(3):
        few = rng.choice(every, min(len(every), 900), replace=False)
        x = least_squares(lambda y, few=few: errors(y, points, few).ravel(), x, x_scale="jac", max_nfev=40).x
        update_slopes(x, points)
    chosen = rng.choice(every, 250, replace=False)
    for count in range(7):
        chosen = np.union1d(chosen, np.argsort(-np.abs(errors(x, points, every)).max(axis=0))[:120])
        x, best = smallest_worst(lambda y, chosen=chosen: errors(y, points, chosen).ravel(), x)
        update_slopes(x, points)
        worst = np.abs(errors(x, points, every)).max()
        report = f"{100 * best:.3f} % on {len(chosen)} points, {100 * worst:.3f} % on all"
        print(f"# round {count}: {report}", file=sys.stderr)
        if worst < 1.003 * best and count > 2:
            break
    x = np.round(x, 4)
    print(f"# worst error with 4 decimals: {100 * np.abs(errors(x, points, every)).max():.3f} %")
    for name, part in zip(SIZES, np.split(x, np.cumsum(list(SIZES.values()))[:-1]), strict=True):
        print(f"{name} = {part.tolist()}")


def reference() -> None:
    """Held-out points, half of them on faces and corners of the box, at 1e-8."""
    rng = np.random.default_rng(77)
    print("# make_refined.py --reference: R2 18 mm, c 0.01 mm, E 1000 MPa, rigid ball; Exact(tolerance=1e-8)")
    print("poisson,thickness_ratio,half_angle_deg,indentation,max_pressure,force,at_25,at_50,at_75,at_90,at_97")
    for number in range(150):
        poisson, ratio = rng.uniform(0.3, 0.48), float(np.exp(rng.uniform(0.0, np.log(6.5))))
        if number < 75:
            poisson = (0.3, 0.48, poisson)[number % 3]
            ratio = (1.0, 6.5, ratio)[number // 3 % 3]
        for degrees in (15.0, *rng.uniform(15.0, 60.0, 2), 60.0):
            contact = bs.Exact(tolerance=1e-8).press(joint_of(poisson, ratio), half_angle=np.radians(degrees))
            shares = [contact.pressure(share * np.radians(degrees)) for share in (0.25, 0.5, 0.75, 0.9, 0.97)]
            row = (contact.indentation, contact.max_pressure, contact.force, *shares)
            print(f"{poisson:.17g},{ratio:.17g},{degrees:.17g}," + ",".join(f"{value:.9g}" for value in row))


if __name__ == "__main__":
    reference() if "--reference" in sys.argv else fit()
