"""Random cups, loads and directions: each ends in an answer that obeys the laws of contact, or in a status.

Twelve cups, or sixty (with `--long`); the environment's BALLSOCKET_CUPS is another number.
"""

import os
from math import radians

import numpy as np
import pytest

import ballsocket as bs

from ...extent import either

LOADS = 5
COUNT = int(os.environ.get("BALLSOCKET_CUPS", "0")) or either(quick=12, long=60)
NUMBERS = (
    "force",
    "indentation",
    "half_angle",
    "pole_pressure",
    "max_pressure_angle",
    "stiffness",
    "energy",
    "pressure_integral",
    "edge_distance",
    "edge_margin",
    "rim_distance",
    "tilt",
    "displacement",
    "moment",
    "force_vector",
    "max_pressure_at",
    "stiffness_matrix",
)
"""That are finite where there is an answer; the largest pressure may be unbounded."""


def drawn_joint(random):
    radius = 10 ** random.uniform(0.5, 2.0)
    layer = bs.Layer(
        thickness=radius * random.uniform(0.1, 0.5), material=random.choice([bs.TITANIUM, bs.CANCELLOUS_BONE])
    )
    return bs.Joint(
        ball_radius=radius,
        clearance=radius * 10 ** random.uniform(-4.0, -1.3),
        liner_thickness=radius * 10 ** random.uniform(-1.0, 0.5),
        liner=bs.Material(young=10 ** random.uniform(0.0, 5.5), poisson=random.choice([0.0, 0.3, 0.45, 0.49, 0.4999])),
        ball=random.choice([None, bs.STEEL, bs.UHMWPE]),
        backing=(layer,) if random.random() < 0.3 else (),
    )


def drawn_model(random, joint):
    radius = float(joint.ball_radius)
    cup = bs.Cup(
        arc_of_cover=radians(random.uniform(60.0, 340.0)),
        chamfer=random.choice([0.0, 0.0, 0.02 * radius]),
        interface=random.choice(list(bs.Interface)),
        inclination=radians(random.uniform(0.0, 90.0)),
        anteversion=radians(random.uniform(-60.0, 60.0)),
        side=random.choice(list(bs.Side)),
    )
    form = [
        None,
        None,
        bs.Pinched(squeeze=float(joint.clearance)),
        bs.Worn(of=lambda n: 0.5 * joint.clearance * n[0] ** 2),
    ]
    surface = [bs.RealCup(), bs.RealCup(), bs.RealCup(), bs.ClosedShell(), bs.Springs()]
    return bs.Sphere(
        cup=cup,
        surface=surface[random.integers(5)],
        ring_width=radians(random.uniform(5.0, 6.0)),
        gap=random.choice([bs.LinearGap, bs.CircularGap]),
        worn=form[random.integers(4)],
    )


def drawn_load(random, joint):
    """Around what makes a contact of this joint, and far from it."""
    size = float(joint.liner.young) * float(joint.ball_radius) ** 2
    kind = random.choice(["force", "force", "indentation", "half_angle"])
    return kind, {
        "force": size * 10 ** random.uniform(-8.0, -0.5, LOADS),
        "indentation": float(joint.clearance) * 10 ** random.uniform(-2.0, 1.2, LOADS),
        "half_angle": random.uniform(0.05, 1.5, LOADS),
    }[kind]


def drawn(seed):
    random = np.random.default_rng(seed)
    joint = drawn_joint(random)
    model = drawn_model(random, joint)
    spread = random.choice([0.3, 1.0, 10.0])  # from about the dome to anywhere
    direction = random.normal(size=(LOADS, 3)) * spread + np.array(model.cup.dome)
    return model, joint, *drawn_load(random, joint), direction


@pytest.mark.parametrize("tenth", range(10))
def test_random_cups_loads_and_directions_end_in_an_answer_or_a_status(tenth):
    for seed in range(tenth, COUNT, 10):
        model, joint, kind, load, direction = drawn(seed)
        contact = model.press(joint, direction=direction, **{kind: load})
        check_numbers(contact, kind, seed)
        check_laws(contact, direction @ np.array(model.cup.frame).T, seed)
        if kind == "force":
            check_balance(contact, load, direction @ np.array(model.cup.frame).T, seed)


def check_numbers(contact, kind, seed):
    good = contact.status == 0
    for name in NUMBERS:
        value = getattr(contact, name)
        assert np.isfinite(value[good]).all(), (seed, name)
        assert name == kind or name in ("tilt", "rim_distance") or np.isnan(value[~good]).all(), (seed, name)
    largest = contact.max_pressure
    assert (largest[good] >= 0).all(), seed
    assert (np.isfinite(largest) | contact.edge_loaded)[good].all(), seed


def check_laws(contact, direction, seed):
    """Nothing pulls, nothing lies outside of the bore, and a load is carried."""
    good = contact.status == 0
    size = np.linalg.norm(contact.force_vector, axis=-1)
    along = (contact.force_vector * direction).sum(axis=-1) / np.linalg.norm(direction, axis=-1)
    assert (along[good] >= -1e-9 * size[good]).all(), seed
    assert (contact.edge_loaded == (contact.edge_margin <= 0))[good & (size > 0)].all(), seed
    reach = float(contact.model.reach_of(contact.joint))
    assert (np.arccos(np.clip(contact.max_pressure_at[good][:, 2], -1, 1)) <= reach + 1e-6)[size[good] > 0].all(), seed
    for state in (piece.state for _, piece in contact.laws.pieces):
        assert (state.rest.pressure >= 0).all(), seed
        found = state.rest.found & ~state.dislocated
        carried = state.bed.force(state.rest.pressure)[found]
        assert carried == pytest.approx(state.force_vector.T[found])
        touch = found & (state.rest.pressure > 0).any(axis=(1, 2))
        for patch in (each for each, held in zip(state.patches, touch, strict=True) if held):
            assert (patch.outline[:, 2] >= np.cos(reach) - 1e-6).all(), seed


def check_balance(contact, load, direction, seed):
    good = contact.status == 0
    asked = load[:, None] * direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    missing = np.linalg.norm(contact.force_vector - asked, axis=-1)
    assert (missing[good] <= 1e-5 * load[good]).all(), seed
