"""Joints and models for tests, and large random samples."""

import numpy as np

import ballsocket as bs

HIP = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
NUMERICAL = {"plane-layer", "exact", "tabulated"}
CLOSED_FORMS = {name: model for name, model in bs.catalogue.items() if name not in NUMERICAL}


def lined(poisson=0.4, thickness=6.75, *, ball_radius=17.9, clearance=0.1, young=1000.0, **others) -> bs.Joint:
    """A rigid ball in the liner of a hip, with some of its numbers replaced."""
    liner = bs.Material(young=young, poisson=poisson)
    return bs.Joint(ball_radius=ball_radius, clearance=clearance, liner_thickness=thickness, liner=liner, **others)


def random_joint(
    size: int, seed: int, *, clearance: tuple[float, float] = (-6.0, -1.0), thickness: tuple[float, float] = (-1.5, 1.5)
) -> bs.Joint:
    """Wildly different joints in one: log-uniform sizes and moduli; clearance and thickness as powers of the radius."""
    rng = np.random.default_rng(seed)
    radius = 10 ** rng.uniform(-1, 3, size)
    return bs.Joint(
        ball_radius=radius,
        clearance=radius * 10 ** rng.uniform(*clearance, size),
        liner_thickness=radius * 10 ** rng.uniform(*thickness, size),
        liner=bs.Material(young=10 ** rng.uniform(-1, 6, size), poisson=rng.uniform(-0.9, 0.4999, size)),
        ball=bs.Material(young=10 ** rng.uniform(3, 6, size), poisson=rng.uniform(0.0, 0.5, size)),
    )
