"""Makes the tables of `Tabulated` from the contact equation, and measures what they are worth."""

from __future__ import annotations

import os
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

from ....core.arrays import Numbers
from ....core.storage.atomic_files import write_atomically
from ....problem import Joint, Material
from ....problem.gaps import LinearGap
from ..abel import State
from ..grid import grid
from ..intervals import Intervals
from ..kernel import Kernel
from ..modes import Ball, Shell, Socket
from . import chebyshev
from . import model as table

SHIPPED = Path(__file__).parents[3] / "data" / "exact_tables.npz"
"""The tables that come with the package."""

BY_ANGLE = ("indentation", "force", "pole_pressure", "stiffness", "energy", "pressure_integral")
BY_FORCE = ("half_angle", "indentation", "pole_pressure")
QUANTITIES = (*BY_ANGLE, "half_angle")
_BALLS = (0.15, 0.27, 0.38)  # ν of the tabulated balls
_SHARES = 5  # how soft they are
_PROFILE = 11  # places along the contact
_CLEARANCE = 0.005  # of the socket's radius, of the joints that check the tables: the answer scales with it
_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
_Liner = tuple[float, float]  # ν and R2/L


@dataclass(frozen=True, kw_only=True)
class Worst:
    """The largest relative error of one quantity, and the contact that has it."""

    quantity: str
    error: float
    where: str

    def __str__(self) -> str:
        return f"{self.quantity:<18} {self.error:.1e}  at {self.where}"


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """The tables against the equation at random contacts between the tabulated ones."""

    points: int
    size: int
    rigid: tuple[Worst, ...]
    elastic: tuple[Worst, ...]

    def __str__(self) -> str:
        head = f"{self.size} bytes; largest relative errors at {self.points} random contacts"
        parts = ("rigid ball:", *map(str, self.rigid), "elastic ball, E/E_ball up to 0.02:", *map(str, self.elastic))
        return "\n".join((head, *parts))


def build(path: Path | str = SHIPPED, *, points: int = 10_000, workers: int = 2) -> Accuracy:
    """Write the tables and check them.

    Parameters
    ----------
    path : path
        Where to, an npz file; by default that of the package.
    points : int
        Contacts that the tables are checked at, for a rigid ball; a fifth of them for an elastic one.
    workers : int
        Processes.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(EISDIR, "a file is needed, and this is a folder", str(path))
    with write_atomically(path) as draft:  # now, and not after two minutes, it is told where nothing can be written
        stored: dict[str, Numbers] = {}
        with _pool(workers) as pool:
            for name, kind in _KINDS.items():
                stored[name] = kind.fitted(pool.map)
        with draft.open("wb") as stream:
            numpy.savez_compressed(stream, allow_pickle=False, **stored)
    return check(path, points=points, workers=workers)


@contextmanager
def _pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Processes of one thread each: as many as there are, the sums inside are taken in the same order."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
            yield pool
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


# What is sampled: each takes ν, R2/L and answers with (places of the ball ..., functions, angles)


def _poisson_at(place: Numbers) -> Numbers:
    near, far = (float(numpy.log(1 - 2 * end)) for end in chebyshev.POISSON[::-1])
    return (1 - numpy.exp((far + near - place * (far - near)) / 2)) / 2


def _ratio_at(place: Numbers) -> Numbers:
    low, high = (float(numpy.log(end + chebyshev.SHIFT)) for end in chebyshev.THICKNESS_RATIO)
    return numpy.exp((low + high + place * (high - low)) / 2) - chebyshev.SHIFT


def _share_at(place: float, poisson: float, ratio: float) -> float:
    scale = chebyshev.ball_scale(poisson, ratio)
    return float(scale * numpy.expm1((place + 1) / 2 * numpy.log1p(chebyshev.STIFFEST_SHARE / scale)))


def _state(liner: _Liner, angle: Numbers, points: int, share: float = 0.0, ball_poisson: float = 0.3) -> State:
    """Contacts with R2 = c = E = 1; `share` is the ball's of the compliance."""
    poisson, ratio = liner
    socket = Socket(radius=1.0, shells=(Shell(thickness=1 / ratio, young=1.0, poisson=poisson),))
    young = (1 - ball_poisson**2) / (1 - poisson**2) * (1 - share) / share if share else 1.0
    ball = Ball(radius=1.0, young=young, poisson=ball_poisson) if share else None
    kernel = Kernel(socket=socket, ball=ball, tolerance=1e-13)
    gap = LinearGap(clearance=1.0, socket_radius=1.0)
    return State(kernel=kernel, gap=gap, intervals=Intervals(half_angle=angle, grid=grid(points)))


def _three(state: State) -> Numbers:
    angle, d, C = state.half_angle, state.indentation, state.kernel.compliance
    share = d / (1 + d) / (2 * numpy.sin(angle / 2) ** 2)
    load, pole = state.force / angle**3, state.pole_pressure / angle
    return numpy.log([share, load * C / (1 + d), pole * C / (1 + d)])


def _profile(state: State) -> Numbers:
    """Chebyshev coefficients of p/(p0 sqrt(1 - v)) in 2v - 1."""
    v = (1 + chebyshev.places(_PROFILE)[:, None]) / 2
    angle = 2 * numpy.arcsin(numpy.sqrt(v) * numpy.sin(state.half_angle / 2))
    return chebyshev.coefficients(state.pressure(angle) / state.pole_pressure / numpy.sqrt(1 - v), 0)


def _rigid(liner: _Liner, *, what: Callable[[State], Numbers], angles: int, points: int) -> Numbers:
    return what(_state(liner, chebyshev.angle_at(chebyshev.places(angles), liner[1]), points))


def _ball(
    liner: _Liner, *, what: Callable[[State], Numbers], angles: int, points: int, shares: int, balls: Sequence[float]
) -> Numbers:
    """What a ball of each softness and ν adds, over how soft it is."""
    angle = chebyshev.angle_at(chebyshev.places(angles), liner[1])
    rigid = what(_state(liner, angle, points))

    def added(place: float, ball_poisson: float) -> Numbers:
        state = _state(liner, angle, points, _share_at(place, *liner), ball_poisson)
        return (what(state) - rigid) * (2 / (1 + place))

    return numpy.array([[added(float(place), nu) for nu in balls] for place in chebyshev.places(shares)])


@dataclass(frozen=True, kw_only=True)
class _Kind:
    """One table: what is sampled at how many places, and which products are kept."""

    sample: Callable[[_Liner], Numbers]
    counts: tuple[int, int]
    order: int
    single: bool = True
    balls: tuple[float, ...] = ()

    def fitted(self, spread: Callable[..., Any]) -> Numbers:
        """Coefficients (ν, R2/L, share, roundness, function, angle)."""
        poisson, ratio = _poisson_at(chebyshev.places(self.counts[0])), _ratio_at(chebyshev.places(self.counts[1]))
        liners = [(float(nu), float(z)) for nu in poisson for z in ratio]
        sampled = numpy.array(list(spread(self.sample, liners, chunksize=4)))
        values = sampled.reshape(*self.counts, *((1, 1) if not self.balls else ()), *sampled.shape[1:])
        for axis in (0, 1, 2, 5):
            values = chebyshev.coefficients(values, axis)
        if self.balls:
            values = numpy.moveaxis(_in_roundness(self.balls, numpy.moveaxis(values, 3, 0)), 0, 3)
        orders = numpy.ogrid[tuple(slice(n) for n in values.shape[:4])]
        total = orders[0] + orders[1] + 2 * orders[2] + 2 * orders[3]
        values = numpy.where((total <= self.order)[..., None, None], values, 0.0)
        return values.astype(numpy.float32 if self.single else numpy.float64)


def _in_roundness(balls: tuple[float, ...], values: Numbers) -> Numbers:
    """Chebyshev coefficients in the roundness of the ball, from values (balls, ...)."""
    basis = numpy.polynomial.chebyshev.chebvander(chebyshev.roundness(numpy.array(balls)), len(balls) - 1)
    return numpy.tensordot(numpy.linalg.inv(basis), values, 1)


_KINDS = {
    "rigid": _Kind(sample=partial(_rigid, what=_three, angles=32, points=40), counts=(19, 21), order=33, single=False),
    "ball": _Kind(
        sample=partial(_ball, what=_three, angles=24, points=30, shares=_SHARES, balls=_BALLS),
        counts=(15, 16),
        order=22,
        balls=_BALLS,
    ),
    "profile": _Kind(sample=partial(_rigid, what=_profile, angles=24, points=30), counts=(12, 13), order=16),
    "profile_ball": _Kind(
        sample=partial(_ball, what=_profile, angles=20, points=28, shares=3, balls=_BALLS[1:2]),
        counts=(9, 10),
        order=14,
        balls=_BALLS[1:2],
    ),
}


# Checks


def check(path: Path | str = SHIPPED, *, points: int = 10_000, workers: int = 2) -> Accuracy:
    """The tables in a file against the equation: half angles 2 to 80 degrees, ν 0 to 0.499, R2/L 0.2 to 20."""
    chebyshev.tables(str(path))  # a file that holds none is told at once
    rigid, elastic = random_contacts(points, seed=2021), random_contacts(max(points // 5, 1), seed=2022, elastic=True)
    with _pool(workers) as pool:
        known = [
            numpy.array(list(pool.map(_exact, zip(*numbers, strict=True), chunksize=50))).T
            for numbers in (rigid, elastic)
        ]
    model = table.Tabulated(file=str(path))
    worst = [_worst(model, numbers, exact) for numbers, exact in zip((rigid, elastic), known, strict=True)]
    return Accuracy(points=points, size=Path(path).stat().st_size, rigid=worst[0], elastic=worst[1])


def random_contacts(count: int, *, seed: int, elastic: bool = False) -> tuple[Numbers, ...]:
    """ε, ν, R2/L, E/E_ball and the ball's ν, uniform (R2/L: in its logarithm); c/R2 is 0.005."""
    random = numpy.random.default_rng(seed)
    angle, poisson = numpy.radians(random.uniform(2, 80, count)), random.uniform(0, 0.499, count)
    ratio = numpy.exp(random.uniform(numpy.log(0.2), numpy.log(20), count))
    softness = random.uniform(0, 0.02, count) if elastic else numpy.zeros(count)
    return angle, poisson, ratio, softness, random.uniform(0.2, 0.35, count)


def joint_of(
    poisson: Numbers, ratio: Numbers, softness: Numbers, ball_poisson: Numbers, *, clearance: float = _CLEARANCE
) -> Joint:
    """Joints of R2 = E = 1; the ball is rigid where all of them are."""
    ball = Material(young=1 / softness, poisson=ball_poisson) if numpy.all(softness > 0) else None
    liner = Material(young=1.0, poisson=poisson)
    return Joint(ball_radius=1 - clearance, clearance=clearance, liner_thickness=1 / ratio, liner=liner, ball=ball)


def _exact(numbers: tuple[float, ...]) -> list[float]:
    """QUANTITIES at a half angle, with R2 = E = 1."""
    angle, poisson, ratio, softness, ball_poisson = map(float, numbers)
    plane = (1 - ball_poisson**2) / (1 - poisson**2) * softness * (1 - _CLEARANCE)
    state = _state((poisson, ratio), numpy.array([angle]), 40, plane / (1 + plane), ball_poisson)
    powers = {"half_angle": 0, "energy": 2}
    return [float(getattr(state, name)[0]) * _CLEARANCE ** powers.get(name, 1) for name in QUANTITIES]


def _worst(model: table.Tabulated, numbers: tuple[Numbers, ...], exact: Numbers) -> tuple[Worst, ...]:
    known = dict(zip(QUANTITIES, exact, strict=True))
    known["stiffness"] = known["stiffness"] / _CLEARANCE
    joint = joint_of(*numbers[1:])
    by_angle, by_force = model.press(joint, half_angle=numbers[0]), model.press(joint, force=known["force"])
    found = [(name, getattr(by_angle, name), known[name], "") for name in BY_ANGLE]
    found += [(name, getattr(by_force, name), known[name], " by force") for name in BY_FORCE]
    return tuple(_place(name + how, abs(value / right - 1), numbers) for name, value, right, how in found)


def _place(name: str, error: Numbers, numbers: tuple[Numbers, ...]) -> Worst:
    k = int(numpy.argmax(numpy.nan_to_num(error, nan=numpy.inf)))
    angle, poisson, ratio, softness, ball_poisson = (float(part[k]) for part in numbers)
    ball = f", E/E_ball {softness:.4f}, ν_ball {ball_poisson:.3f}" if softness else ""
    text = f"ε {degrees(angle):.2f}°, ν {poisson:.4f}, R2/L {ratio:.3f}{ball}"
    return Worst(quantity=name, error=float(error[k]), where=text)
