"""The closed forms against 50-digit arithmetic, from d/c = 1e-12 to 1e6 and without clearance."""

import csv

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import ballsocket as bs
from ballsocket.models.table_3 import table_3

from ..joints import lined
from ..places import ROOT

TABLE = ROOT / "src" / "ballsocket" / "data" / "closed_forms.csv"
ROWS = list(csv.DictReader(line for line in TABLE.read_text(encoding="utf-8").splitlines() if not line.startswith("#")))
K = bs.constant(276.5)
STRETCH_SHARE = 0.25


def model_of(name: str, clearance: float) -> bs.Model:
    work = 276.5 * (STRETCH_SHARE * clearance) ** 2 / 2
    return {
        "linear": bs.RadialFoundation(modulus=K),
        "exact": bs.RadialFoundation(modulus=K, kinematics=bs.exact_kinematics),
        "hertz": bs.Hertz(),
        "steuermann-3": bs.Steuermann(exponent=3),
        "liu": bs.LiuReconstruction(),
        "adhesive": bs.AdhesiveSocket(work_of_adhesion=work, modulus=K),
    }[name]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['model']}-{row['clearance']}-{row['indentation']}")
def test_forward_and_inverse_laws_have_thirteen_digits(row):
    clearance, indentation = float(row["clearance"]), float(row["indentation"])
    model, joint = model_of(row["model"], clearance), lined(ball_radius=18.0 - clearance, clearance=clearance)
    forward = model.press(joint, indentation=indentation)
    for name in ("force", "half_angle", "pole_pressure", "stiffness", "energy"):
        # the energy of adhesion, counted from d = 0 through tension, is a difference
        digits = 1e-12 if row["model"] == "adhesive" and name == "energy" else 1e-13
        assert getattr(forward, name) == pytest.approx(float(row[name]), rel=digits, abs=0), name
    inverse = model.press(joint, force=float(row["force"]))
    assert inverse.indentation == pytest.approx(indentation, rel=1e-13, abs=0)
    if row["model"] != "adhesive" and clearance:
        by_angle = model.press(joint, half_angle=min(float(row["half_angle"]), 1.57))
        if float(row["half_angle"]) < 1.5:
            assert by_angle.indentation == pytest.approx(indentation, rel=1e-12, abs=0)


def test_table_interpolation_is_scipys_monotone_cubic():
    table, poisson = table_3(), np.linspace(0.30, 0.49, 400)
    liner = bs.Material(young=1000.0, poisson=poisson)
    joint = bs.Joint(ball_radius=20.0, clearance=0.0, liner_thickness=5.0, liner=liner)
    constants = [PchipInterpolator(table["poisson"], table[name])(poisson) for name in ("C1", "C2", "C3")]
    expected = sum(constant * 4.0**power for power, constant in enumerate(constants))
    np.testing.assert_allclose(bs.hess_forsbach(joint) * 20.0 / 1000.0, expected, rtol=1e-14)
