"""Random cups, loads and directions: each contact obeys the laws of contact or has a status.

Six cups, or twenty with `--long`; the environment variable BALLSOCKET_CUPS sets another number.
"""

import os
from math import radians

import numpy as np
import pytest

import ballsocket as bs

from ...extent import either

LOADS = 5
COUNT = int(os.environ.get("BALLSOCKET_CUPS", "0")) or either(quick=6, long=20)
SIZES = ("force", "indentation", "half_angle", "pole_pressure", "stiffness", "energy", "pressure_integral")
PLACES = ("edge_distance", "edge_margin", "rim_distance", "tilt", "max_pressure_angle", "max_pressure_at")
VECTORS = ("displacement", "moment", "force_vector", "stiffness_matrix")
"""Quantities that are finite in every solution; the largest pressure may be unbounded."""


def draw_joint(random):
    radius = 10 ** random.uniform(0.5, 2.0)
    thickness, material = radius * random.uniform(0.1, 0.5), random.choice([bs.TITANIUM, bs.CANCELLOUS_BONE])
    return bs.Joint(
        ball_radius=radius,
        clearance=radius * 10 ** random.uniform(-4.0, -1.3),
        liner_thickness=radius * 10 ** random.uniform(-1.0, 0.5),
        liner=bs.Material(young=10 ** random.uniform(0.0, 5.5), poisson=random.choice([0.0, 0.3, 0.45, 0.49, 0.4999])),
        ball=random.choice([None, bs.STEEL, bs.UHMWPE]),
        backing=(bs.Layer(thickness=thickness, material=material),) if random.random() < 0.3 else (),
    )


def draw_model(random, joint):
    radius = float(joint.ball_radius)
    cup = bs.Cup(
        arc_of_cover=radians(random.uniform(60.0, 340.0)),
        chamfer=random.choice([0.0, 0.0, 0.02 * radius]),
        interface=random.choice(list(bs.Interface)),
        inclination=radians(random.uniform(0.0, 90.0)),
        anteversion=radians(random.uniform(-60.0, 60.0)),
        side=random.choice(list(bs.Side)),
    )
    worn = bs.BoreDeviation(of=lambda n: 0.5 * joint.clearance * n[0] ** 2)
    shapes = [None, None, bs.OvalBore(squeeze=float(joint.clearance)), worn]
    surface = [bs.RealCup(), bs.RealCup(), bs.RealCup(), bs.ClosedShell(), bs.Springs()]
    return bs.Sphere(
        cup=cup,
        surface=surface[random.integers(5)],
        ring_width=radians(random.uniform(5.0, 6.0)),
        gap=random.choice([bs.LinearGap, bs.CircularGap]),
        worn=shapes[random.integers(4)],
    )


def draw_load(random, joint):
    """Draw loads from far below to far above those that make a contact of this joint."""
    size = float(joint.liner.young) * float(joint.ball_radius) ** 2
    kind = random.choice(["force", "force", "indentation", "half_angle"])
    return kind, {
        "force": size * 10 ** random.uniform(-8.0, -0.5, LOADS),
        "indentation": float(joint.clearance) * 10 ** random.uniform(-2.0, 1.2, LOADS),
        "half_angle": random.uniform(0.05, 1.5, LOADS),
    }[kind]


def draw(seed):
    random = np.random.default_rng(seed)
    joint = draw_joint(random)
    model = draw_model(random, joint)
    spread = random.choice([0.3, 1.0, 10.0])  # from about the dome to anywhere
    direction = random.normal(size=(LOADS, 3)) * spread + np.array(model.cup.dome)
    return model, joint, *draw_load(random, joint), direction


@pytest.mark.parametrize("tenth", range(min(COUNT, 10)))
def test_random_contacts_obey_the_laws_of_contact_or_have_a_status(tenth):
    for seed in range(tenth, COUNT, 10):
        model, joint, kind, load, direction = draw(seed)
        contact = model.press(joint, direction=direction, **{kind: load})
        in_cup = direction @ np.array(model.cup.frame).T
        in_cup /= np.linalg.norm(in_cup, axis=-1, keepdims=True)
        check_numbers(contact, kind, seed)
        check_laws(contact, in_cup, seed)
        if kind == "force":
            residual = np.linalg.norm(contact.force_vector - load[:, None] * in_cup, axis=-1)
            assert (residual <= 1e-5 * load)[contact.status == 0].all(), seed


def check_numbers(contact, kind, seed):
    solved = contact.status == 0
    for name in SIZES + PLACES + VECTORS:
        value = getattr(contact, name)
        assert np.isfinite(value[solved]).all(), (seed, name)
        assert name == kind or name in ("tilt", "rim_distance") or np.isnan(value[~solved]).all(), (seed, name)
    largest = contact.max_pressure
    assert (largest[solved] >= 0).all(), seed
    assert (np.isfinite(largest) | contact.edge_loaded)[solved].all(), seed


def check_laws(contact, direction, seed):
    """Check that no pressure pulls or lies outside the bore, and that pressures carry the load."""
    solved, reach = contact.status == 0, float(contact.model.reach_of(contact.joint))
    size = np.linalg.norm(contact.force_vector, axis=-1)
    along = (contact.force_vector * direction).sum(axis=-1)
    assert (along >= -1e-9 * size)[solved].all(), seed
    loaded = solved & (size > 0)
    assert (contact.edge_loaded == (contact.edge_margin <= 0))[loaded].all(), seed
    polar = np.arccos(np.clip(contact.max_pressure_at[..., 2], -1, 1))
    assert (polar <= reach + 1e-6)[loaded].all(), seed
    for state in (piece.state for _, piece in contact.laws.pieces):
        assert (state.equilibrium.pressure >= 0).all(), seed
        converged = state.equilibrium.converged & ~state.dislocated
        carried = state.bore.force(state.equilibrium.pressure)[converged]
        assert carried == pytest.approx(state.force_vector.T[converged])
        touch = converged & (state.equilibrium.pressure > 0).any(axis=(1, 2))
        for patch in (patch for patch, touches in zip(state.patches, touch, strict=True) if touches):
            assert (patch.outline[:, 2] >= np.cos(reach) - 1e-6).all(), seed
