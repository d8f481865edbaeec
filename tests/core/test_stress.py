"""Von Mises and principal stresses."""

import numpy as np
import pytest

from ballsocket.core.stress import Stress


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


def test_hydrostatic_pressure_has_no_von_mises_stress():
    pressure = np.asarray(-5.0)
    state = Stress(radial=pressure, meridional=pressure, hoop=pressure, shear=0.0 * pressure)
    assert state.von_mises == 0.0
    assert state.principal == pytest.approx((-5.0, -5.0, -5.0))
