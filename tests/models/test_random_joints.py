"""200 000 wildly different joints and loads through every closed form."""

import numpy as np
import pytest

import ballsocket as bs

from ..extent import either
from ..joints import CLOSED_FORMS, random_joint

SIZE = either(quick=20_000, long=200_000)
JOINT = random_joint(SIZE, seed=20211125)
FORCE = JOINT.liner.young * JOINT.ball_radius**2 * 10 ** np.random.default_rng(1).uniform(-12, 0, SIZE)


LEAST_SHARES = {"bartel": 0.95, "bonded-layer-exact": 0.95, "refined": 0.85}
"""Share of loads with an answer: others lie beyond the perfect fit of a ball in its socket."""


@pytest.mark.parametrize("model", CLOSED_FORMS.values(), ids=CLOSED_FORMS)
def test_every_random_point_has_numbers_or_a_status(model):
    contact = model.press(JOINT, force=FORCE)
    answered = (contact.status == bs.Status.OK) | (contact.status == bs.Status.BEYOND_EQUATOR)
    for name in ("indentation", "half_angle", "max_pressure", "area", "stiffness", "energy", "foundation_modulus"):
        assert not np.any(np.isnan(getattr(contact, name)[answered])), name
    assert np.all(np.isnan(contact.indentation[~answered]))
    assert not np.any(contact.status == bs.Status.NOT_CONVERGED)
    assert np.mean(answered) > LEAST_SHARES.get(model.name, 0.999999)
    back = model.press(JOINT, indentation=np.where(answered, contact.indentation, 0.0))
    # with adhesion a small force is the difference of large ones: there the indentation is what is known to 1e-12
    scale = contact.stiffness * contact.indentation if model.name == "adhesive" else FORCE
    assert np.max(np.abs(back.force - FORCE)[answered] / scale[answered]) < 1e-12
    harder = model.press(JOINT, force=1.001 * FORCE)
    both = answered & ~np.isnan(harder.indentation)
    assert np.all(harder.indentation[both] >= contact.indentation[both])
    assert np.mean(harder.indentation[both] > contact.indentation[both]) > 0.999999
    wider = harder.half_angle[both] >= (1 - 1e-12) * contact.half_angle[both]
    assert np.all(wider) or model.name in {"bartel", "bonded-layer-exact"}


@pytest.mark.long
def test_force_and_indentation_of_random_plane_layers_are_inverse():
    """The one numerical model of the catalogue, on fewer."""
    size = either(quick=200, long=1_000)
    joint = random_joint(size, seed=3, clearance=(-5.0, -2.0), thickness=(-0.7, 1.0))
    force = joint.liner.young * joint.ball_radius**2 * 10 ** np.random.default_rng(2).uniform(-9, -2, size)
    contact = bs.PlaneLayer().press(joint, force=force)
    answered = contact.status == bs.Status.OK
    assert np.all(answered | (contact.status == bs.Status.NOT_REACHED))
    assert np.mean(answered) > 0.8
    back = bs.PlaneLayer().press(joint, indentation=np.where(answered, contact.indentation, 0.0))
    np.testing.assert_allclose(back.force[answered], force[answered], rtol=1e-7)
    assert not np.any(np.isnan(contact.max_pressure[answered]))
