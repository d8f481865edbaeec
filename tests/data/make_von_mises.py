"""Make `data/von_mises.npz`: largest von Mises stress in a liner over the largest pressure, from the exact solution.

Run `python tests/data/make_von_mises.py`; it takes some ten minutes on two processors.
"""

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from importlib.resources import files
from itertools import product
from math import inf, radians

import numpy as np

from ballsocket.contact.coordinates import half_angle_at
from ballsocket.contact.stress_ratio import NODES, poisson_at, thickness_ratio_at
from ballsocket.elasticity.exact.abel import AbelState
from ballsocket.elasticity.exact.grid import cached_grid
from ballsocket.elasticity.exact.kernel import Intervals, Kernel
from ballsocket.elasticity.exact.modes import Shell, Socket
from ballsocket.elasticity.exact.subsurface import stress
from ballsocket.problem.gaps import LinearGap

NARROW = radians(0.15)  # below it the ratio is linear between that of Hertz on a half-space and this one
DIGITS = 5


def hertz_ratio(poisson: float) -> float:
    """On the axis of a half-space under the pressure of Hertz (Johnson 1985, section 4.2)."""
    z = np.linspace(0.3, 0.7, 4001)
    return float(np.max(1.5 / (1 + z**2) - (1 + poisson) * (1 - z * np.arctan(1 / z))))


def largest(function: Callable[[np.ndarray], np.ndarray], points: np.ndarray) -> float:
    """The largest value on a row of points, then on a finer one about it."""
    best = int(np.argmax(function(points)))
    low, high = points[max(best - 1, 0)], points[min(best + 1, len(points) - 1)]
    return float(function(np.linspace(low, high, 9)).max())


def stress_ratios(state: AbelState, thickness: float) -> list[float]:
    """The largest stress on the axis and that at the interface, over the largest pressure, of one contact."""
    angle, pole = float(state.half_angle[0]), float(state.max_pressure[0])
    if not pole > 0:
        return [np.nan, np.nan]  # the ball fills its socket before
    depth = min(thickness, 2 * np.sin(angle))
    axis = largest(lambda d: stress(state, np.zeros((1, 1)), d[None]).von_mises[0], depth * np.linspace(0, 1, 21))
    if thickness > 8 * np.sin(angle):
        return [axis / pole, 0.0]
    end = np.full((1, 1), thickness)
    interface = largest(lambda a: stress(state, a[:, None], end).von_mises[:, 0], angle * np.linspace(0, 1.1, 23))
    return [axis / pole, interface / pole]


def liner_ratios(liner: tuple[float, float]) -> np.ndarray:
    """The ratios of one ν and R2/L: (half angles, 2)."""
    poisson, ratio = liner
    thickness = 1 / ratio if ratio else inf
    kernel = Kernel(
        socket=Socket(radius=1.0, shells=(Shell(thickness=thickness, young=1.0, poisson=poisson),)),
        ball=None,
        tolerance=1e-13,
    )
    angles = half_angle_at(np.linspace(-1, 1, NODES[2]), ratio)
    wide = angles > NARROW
    intervals = Intervals(half_angle=np.append(NARROW, angles[wide]), grid=cached_grid(points=40))
    state = AbelState(kernel=kernel, gap=LinearGap(clearance=1.0, socket_radius=1.0), intervals=intervals)
    solved = np.array([stress_ratios(state.single_contact(k), thickness) for k in range(1 + wide.sum())])
    hertz = np.array([hertz_ratio(poisson), 0.0])
    narrow = hertz + (solved[0] - hertz) * angles[~wide, None] / NARROW
    ratios = np.concatenate([narrow, solved[1:]])
    solved_count = int(np.isfinite(ratios[:, 0]).sum())
    for row in range(solved_count, len(ratios)):  # contacts that do not exist continue the last two
        ratios[row] = 2 * ratios[row - 1] - ratios[row - 2]
    return ratios


def main() -> None:
    poisson, ratio = (
        f(np.linspace(0, 1, count)) for f, count in zip((poisson_at, thickness_ratio_at), NODES[:2], strict=True)
    )
    with ProcessPoolExecutor() as pool:
        rows = list(pool.map(liner_ratios, product(poisson.tolist(), ratio.tolist())))
    table = np.round(np.array(rows).reshape(*NODES, 2), DIGITS).astype(np.float32)
    np.savez_compressed(str(files("ballsocket") / "data" / "von_mises.npz"), ratios=table)


if __name__ == "__main__":
    main()
