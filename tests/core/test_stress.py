"""Von Mises and principal stresses, from uniaxial, shear and hydrostatic states."""

import numpy as np
import pytest

from ballsocket.core.stress import Stress


def stress(**components):
    zero = {"radial": 0.0, "meridional": 0.0, "hoop": 0.0, "shear": 0.0}
    return Stress(**{name: np.asarray(value) for name, value in (zero | components).items()})


@pytest.mark.parametrize("component", ["radial", "meridional", "hoop"])
def test_uniaxial_stress_is_its_von_mises_stress(component):
    state = stress(**{component: -7.0})
    assert state.von_mises == pytest.approx(7.0)
    assert state.principal == pytest.approx((0.0, 0.0, -7.0))


def test_pure_shear():
    state = stress(shear=4.0)
    assert state.von_mises == pytest.approx(4.0 * np.sqrt(3))
    assert state.principal == pytest.approx((4.0, 0.0, -4.0))


def test_hydrostatic_pressure_has_no_von_mises_stress():
    state = stress(radial=-5.0, meridional=-5.0, hoop=-5.0)
    assert state.von_mises == 0.0
    assert state.principal == pytest.approx((-5.0, -5.0, -5.0))


def test_principal_stresses_are_eigenvalues():
    random = np.random.default_rng(1)
    components = random.normal(size=(4, 20))
    state = Stress(**dict(zip(("radial", "meridional", "hoop", "shear"), components, strict=True)))
    for number in range(20):
        r, m, h, s = components[:, number]
        values = np.linalg.eigvalsh([[r, s, 0.0], [s, m, 0.0], [0.0, 0.0, h]])
        assert [principal[number] for principal in state.principal] == pytest.approx(values[::-1].tolist(), abs=1e-12)
        deviator = values - values.mean()
        assert state.von_mises[number] == pytest.approx(np.sqrt(1.5 * np.sum(deviator**2)), rel=1e-12)
