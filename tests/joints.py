"""Joints for tests: one of each kind, strategies for property tests, and large random samples."""

import numpy as np
from hypothesis import strategies as st

import ballsocket as bs

HIP = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=bs.UHMWPE, ball=bs.STEEL)
NUMERICAL = {"plane-layer", "exact", "tabulated"}
CLOSED_FORMS = {name: model for name, model in bs.catalogue.items() if name not in NUMERICAL}


def floats(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False, allow_infinity=False)


materials = st.builds(lambda power, nu: bs.Material(young=10.0**power, poisson=nu), floats(0, 5), floats(-0.5, 0.49))
joints = st.builds(
    lambda radius, clearance, thickness, liner, ball: bs.Joint(
        ball_radius=radius,
        clearance=radius * 10.0**clearance,
        liner_thickness=radius * 10.0**thickness,
        liner=liner,
        ball=ball,
    ),
    floats(0.5, 500.0),
    floats(-5.0, -1.5),
    floats(-1.2, 1.0),
    materials,
    st.none() | materials,
)


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
