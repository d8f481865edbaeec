"""Construction of the tables of `Tabulated` from the contact equation, and measurement of their errors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from errno import EISDIR
from functools import partial
from math import degrees
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy

from ....contact.coordinates import half_angle_at
from ....core.arrays import Numbers
from ....core.chebyshev import chebyshev_coefficients, chebyshev_points
from ....core.storage.atomic_files import write_atomically
from ....core.threads import limit_threads
from ....problem import Joint, Material
from ....problem.gaps import LinearGap
from ..abel import AbelState
from ..grid import cached_grid
from ..kernel import Intervals, Kernel
from ..modes import ElasticBall, Shell, Socket
from . import chebyshev
from . import model as table

SHIPPED = Path(__file__).parents[3] / "data" / "exact_tables.npz"  # path of the tables of the package

BY_ANGLE = ("indentation", "force", "pole_pressure", "stiffness", "energy", "pressure_integral")
"""Quantities that are checked by half angle."""

BY_FORCE = ("half_angle", "indentation", "pole_pressure")  # quantities that are checked by force
QUANTITIES = (*BY_ANGLE, "half_angle")  # all quantities that are checked
_BALLS = (0.15, 0.27, 0.38)  # ν of the tabulated balls
_SHARE_POINTS = 5  # of the ball's share of the compliance
_PROFILE_POINTS = 11  # along the contact
_CLEARANCE = 0.005  # over the socket's radius in the checks; results scale with it
_LinerParameters = tuple[float, float]  # ν and R2/L


@dataclass(frozen=True, kw_only=True)
class LargestError:
    """Largest relative error of one quantity, and the contact in which it occurs."""

    quantity: str
    error: float
    location: str

    def __str__(self) -> str:
        return f"{self.quantity:<18} {self.error:.1e}  at {self.location}"


@dataclass(frozen=True, kw_only=True)
class TableAccuracy:
    """Largest errors of the tables at random contacts between the tabulated ones."""

    points: int
    size: int
    rigid: tuple[LargestError, ...]
    elastic: tuple[LargestError, ...]

    def __str__(self) -> str:
        head = f"{self.size} bytes; largest relative errors at {self.points} random contacts"
        parts = ("rigid ball:", *map(str, self.rigid), "elastic ball, E/E_ball up to 0.02:", *map(str, self.elastic))
        return "\n".join((head, *parts))


def build_tables(path: Path | str = SHIPPED, *, points: int = 10_000, workers: int = 2) -> TableAccuracy:
    """Compute the tables, write them to a file and check them.

    Parameters
    ----------
    path : path
        Path of the npz file; the default is that of the package.
    points : int
        Number of contacts in the check with a rigid ball; a fifth of them with an elastic one.
    workers : int
        Number of processes.

    Raises OSError: the file cannot be written.
    """
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(EISDIR, "a file is needed, but this is a folder", str(path))
    with write_atomically(path) as draft:  # raises an error at once if the file cannot be written
        with _process_pool(workers) as pool:
            stored = {name: spec.fit(pool.map) for name, spec in _TABLE_SPECS.items()}
        with draft.open("wb") as stream:
            numpy.savez_compressed(stream, allow_pickle=False, **stored)
    return check_tables(path, points=points, workers=workers)


@contextmanager
def _process_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Open a pool of processes with one thread each, so that sums have the same order for any number of them."""
    with limit_threads(), ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        yield pool


# Sampled functions: each takes ν, R2/L and returns an array (points of the ball ..., functions, angles)


def _solve_state(
    liner: _LinerParameters, angle: Numbers, points: int, ball_share: float = 0.0, ball_poisson: float = 0.3
) -> AbelState:
    """Solve the contacts of one liner with R2 = c = E = 1; `ball_share` is the ball's share of the compliance."""
    poisson, ratio = liner
    socket = Socket(radius=1.0, shells=(Shell(thickness=1 / ratio, young=1.0, poisson=poisson),))
    young = (1 - ball_poisson**2) / (1 - poisson**2) * (1 - ball_share) / ball_share if ball_share else 1.0
    ball = ElasticBall(radius=1.0, young=young, poisson=ball_poisson) if ball_share else None
    kernel = Kernel(socket=socket, ball=ball, tolerance=1e-13)
    gap = LinearGap(clearance=1.0, socket_radius=1.0)
    return AbelState(kernel=kernel, gap=gap, intervals=Intervals(half_angle=angle, grid=cached_grid(points=points)))


def _tabulated_functions(state: AbelState) -> Numbers:
    angle, d, C = state.half_angle, state.indentation, state.kernel.compliance
    opening = d / (1 + d) / (2 * numpy.sin(angle / 2) ** 2)
    load, pole = state.force / angle**3, state.pole_pressure / angle
    return numpy.log([opening, load * C / (1 + d), pole * C / (1 + d)])


def _profile_coefficients(state: AbelState) -> Numbers:
    """Compute the Chebyshev coefficients of the pressure profile p/(p0 sqrt(1 - v)) in 2v - 1."""
    v = (1 + chebyshev_points(_PROFILE_POINTS)[:, None]) / 2
    angle = 2 * numpy.arcsin(numpy.sqrt(v) * numpy.sin(state.half_angle / 2))
    return chebyshev_coefficients(state.pressure(angle) / state.pole_pressure / numpy.sqrt(1 - v), 0)


def _sample_rigid_ball(
    liner: _LinerParameters, *, function: Callable[[AbelState], Numbers], angles: int, points: int
) -> Numbers:
    """Sample a function of contacts with a rigid ball, at Chebyshev points of the half angle."""
    return function(_solve_state(liner, half_angle_at(chebyshev_points(angles), liner[1]), points))


def _sample_ball_change(
    liner: _LinerParameters,
    *,
    function: Callable[[AbelState], Numbers],
    angles: int,
    points: int,
    shares: int,
    balls: Sequence[float],
) -> Numbers:
    """Sample the change of a function by balls of several shares and ν, divided by the coordinate of the share."""
    angle = half_angle_at(chebyshev_points(angles), liner[1])
    rigid, scale = function(_solve_state(liner, angle, points)), chebyshev.ball_scale(*liner)

    def function_change(coordinate: float, ball_poisson: float) -> Numbers:
        share = float(scale * numpy.expm1((coordinate + 1) / 2 * numpy.log1p(chebyshev.MAX_BALL_SHARE / scale)))
        state = _solve_state(liner, angle, points, share, ball_poisson)
        return (function(state) - rigid) * (2 / (1 + coordinate))

    coordinates = [float(coordinate) for coordinate in chebyshev_points(shares)]
    return numpy.array([[function_change(coordinate, nu) for nu in balls] for coordinate in coordinates])


@dataclass(frozen=True, kw_only=True)
class _TableSpec:
    """Specification of one table: sampled function, numbers of points, and highest order of products."""

    sample: Callable[[_LinerParameters], Numbers]
    counts: tuple[int, int]
    order: int
    single: bool = True
    balls: tuple[float, ...] = ()

    def fit(self, map_function: Callable[..., Any]) -> Numbers:
        """Compute the coefficients of this table: (ν, R2/L, ball share, ball ν, function, angle)."""
        low, high = (float(numpy.log(1 - 2 * end)) for end in chebyshev.POISSON[::-1])
        poisson = (1 - numpy.exp((high + low - chebyshev_points(self.counts[0]) * (high - low)) / 2)) / 2
        ratio = chebyshev.thickness_ratio_at(chebyshev_points(self.counts[1]))
        liners = [(float(nu), float(z)) for nu in poisson for z in ratio]
        sampled = numpy.array(list(map_function(self.sample, liners, chunksize=4)))
        values = sampled.reshape(*self.counts, *((1, 1) if not self.balls else ()), *sampled.shape[1:])
        for axis in (0, 1, 2, 5):
            values = chebyshev_coefficients(values, axis)
        if self.balls:
            shrinkage = chebyshev.ball_shrinkage(numpy.array(self.balls))
            basis = numpy.polynomial.chebyshev.chebvander(shrinkage, len(self.balls) - 1)
            coefficients = numpy.tensordot(numpy.linalg.inv(basis), numpy.moveaxis(values, 3, 0), 1)
            values = numpy.moveaxis(coefficients, 0, 3)
        orders = numpy.ogrid[tuple(slice(n) for n in values.shape[:4])]
        total = orders[0] + orders[1] + 2 * orders[2] + 2 * orders[3]
        values = numpy.where((total <= self.order)[..., None, None], values, 0.0)
        return values.astype(numpy.float32 if self.single else numpy.float64)


_TABLE_SPECS = {
    "rigid": _TableSpec(
        sample=partial(_sample_rigid_ball, function=_tabulated_functions, angles=32, points=40),
        counts=(19, 21),
        order=33,
        single=False,
    ),
    "ball": _TableSpec(
        sample=partial(
            _sample_ball_change, function=_tabulated_functions, angles=24, points=30, shares=_SHARE_POINTS, balls=_BALLS
        ),
        counts=(15, 16),
        order=22,
        balls=_BALLS,
    ),
    "profile": _TableSpec(
        sample=partial(_sample_rigid_ball, function=_profile_coefficients, angles=24, points=30),
        counts=(12, 13),
        order=16,
    ),
    "profile_ball": _TableSpec(
        sample=partial(
            _sample_ball_change, function=_profile_coefficients, angles=20, points=28, shares=3, balls=_BALLS[1:2]
        ),
        counts=(9, 10),
        order=14,
        balls=_BALLS[1:2],
    ),
}


# Checks


def check_tables(path: Path | str = SHIPPED, *, points: int = 10_000, workers: int = 2) -> TableAccuracy:
    """Compare the tables in a file with solutions of the contact equation for random contacts.

    Half angles are 2 to 80 degrees, ν is 0 to 0.499, and R2/L is 0.2 to 20.
    """
    chebyshev.load_tables(str(path))  # raises an error at once for a file without tables
    rigid, elastic = random_contacts(points, seed=2021), random_contacts(max(points // 5, 1), seed=2022, elastic=True)
    with _process_pool(workers) as pool:
        known = [list(pool.map(_solve_exact, zip(*of, strict=True), chunksize=50)) for of in (rigid, elastic)]
    model = table.Tabulated(file=str(path))
    errors = [_largest_errors(model, of, numpy.array(k).T) for of, k in zip((rigid, elastic), known, strict=True)]
    return TableAccuracy(points=points, size=Path(path).stat().st_size, rigid=errors[0], elastic=errors[1])


def random_contacts(count: int, *, seed: int, elastic: bool = False) -> tuple[Numbers, ...]:
    """Draw uniform random ε, ν, ln(R2/L), E/E_ball and ν of the ball; return an array of each, of R2/L itself."""
    random = numpy.random.default_rng(seed)
    angle, poisson = numpy.radians(random.uniform(2, 80, count)), random.uniform(0, 0.499, count)
    ratio = numpy.exp(random.uniform(numpy.log(0.2), numpy.log(20), count))
    softness = random.uniform(0, 0.02, count) if elastic else numpy.zeros(count)
    return angle, poisson, ratio, softness, random.uniform(0.2, 0.35, count)


def make_joints(
    poisson: Numbers, ratio: Numbers, softness: Numbers, ball_poisson: Numbers, *, clearance: float = _CLEARANCE
) -> Joint:
    """Make joints with R2 = E = 1 from arrays of parameters; `softness` is E/E_ball, 0 for rigid balls."""
    ball = Material(young=1 / softness, poisson=ball_poisson) if numpy.all(softness > 0) else None
    liner = Material(young=1.0, poisson=poisson)
    return Joint(ball_radius=1 - clearance, clearance=clearance, liner_thickness=1 / ratio, liner=liner, ball=ball)


def _solve_exact(numbers: tuple[float, ...]) -> list[float]:
    angle, poisson, ratio, softness, ball_poisson = map(float, numbers)
    plane = (1 - ball_poisson**2) / (1 - poisson**2) * softness * (1 - _CLEARANCE)
    state = _solve_state((poisson, ratio), numpy.array([angle]), 40, plane / (1 + plane), ball_poisson)
    powers = {"half_angle": 0, "energy": 2}
    return [float(getattr(state, name)[0]) * _CLEARANCE ** powers.get(name, 1) for name in QUANTITIES]


def _largest_errors(model: table.Tabulated, numbers: tuple[Numbers, ...], exact: Numbers) -> tuple[LargestError, ...]:
    known = dict(zip(QUANTITIES, exact, strict=True))
    known["stiffness"] = known["stiffness"] / _CLEARANCE
    joint = make_joints(*numbers[1:])
    by_angle, by_force = model.press(joint, half_angle=numbers[0]), model.press(joint, force=known["force"])
    results = [(name, getattr(by_angle, name), known[name], "") for name in BY_ANGLE]
    results += [(name, getattr(by_force, name), known[name], " by force") for name in BY_FORCE]
    largest = []
    for name, value, expected, suffix in results:
        error = abs(value / expected - 1)
        k = int(numpy.argmax(numpy.nan_to_num(error, nan=numpy.inf)))
        angle, poisson, ratio, softness, ball_poisson = (float(values[k]) for values in numbers)
        ball = f", E/E_ball {softness:.4f}, ν_ball {ball_poisson:.3f}" if softness else ""
        text = f"ε {degrees(angle):.2f}°, ν {poisson:.4f}, R2/L {ratio:.3f}{ball}"
        largest.append(LargestError(quantity=name + suffix, error=float(error[k]), location=text))
    return tuple(largest)
