"""The closed forms against 50-digit arithmetic, from d/c = 1e-12 to 1e6 and without clearance."""

import csv

import numpy as np
import pytest

import ballsocket as bs

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


def joint_of(clearance: float) -> bs.Joint:
    liner = bs.Material(young=1000.0, poisson=0.4)
    return bs.Joint(ball_radius=18.0 - clearance, clearance=clearance, liner_thickness=6.75, liner=liner)


def test_reference_table_covers_the_stated_ratios_and_models():
    ratios = [float(row["indentation"]) / float(row["clearance"]) for row in ROWS if float(row["clearance"])]
    assert min(ratios) == pytest.approx(1e-12)
    assert max(ratios) == pytest.approx(1e6)
    assert any(float(row["clearance"]) == 0 for row in ROWS)
    assert {row["model"] for row in ROWS} == {"linear", "exact", "hertz", "steuermann-3", "liu", "adhesive"}


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['model']}-{row['clearance']}-{row['indentation']}")
def test_forward_and_inverse_laws_have_thirteen_digits(row):
    clearance, indentation = float(row["clearance"]), float(row["indentation"])
    model, joint = model_of(row["model"], clearance), joint_of(clearance)
    forward = model.press(joint, indentation=indentation)
    for name in ("force", "half_angle", "pole_pressure", "stiffness", "energy"):
        if row["model"] == "adhesive" and name == "energy":
            continue  # counted from d = 0 through tension: a difference, tested on its own
        assert getattr(forward, name) == pytest.approx(float(row[name]), rel=1e-13, abs=0), name
    inverse = model.press(joint, force=float(row["force"]))
    assert inverse.indentation == pytest.approx(indentation, rel=1e-13, abs=0)
    if row["model"] != "adhesive" and clearance:
        by_angle = model.press(joint, half_angle=min(float(row["half_angle"]), 1.57))
        if float(row["half_angle"]) < 1.5:
            assert by_angle.indentation == pytest.approx(indentation, rel=1e-12, abs=0)


def test_energy_of_the_adhesive_socket_has_twelve_digits():
    rows = [row for row in ROWS if row["model"] == "adhesive"]
    for row in rows:
        contact = model_of("adhesive", float(row["clearance"])).press(
            joint_of(float(row["clearance"])), indentation=float(row["indentation"])
        )
        assert contact.energy == pytest.approx(float(row["energy"]), rel=1e-12)


def test_table_interpolation_is_scipys_monotone_cubic():
    from scipy.interpolate import PchipInterpolator

    from ballsocket.models.table_3 import table_3

    table = table_3()
    poisson = np.linspace(0.30, 0.49, 400)
    joint = bs.Joint(
        ball_radius=20.0, clearance=0.0, liner_thickness=5.0, liner=bs.Material(young=1000.0, poisson=poisson)
    )
    expected = sum(
        PchipInterpolator(table["poisson"], table[name])(poisson) * 4.0**power
        for power, name in enumerate(("C1", "C2", "C3"))
    )
    np.testing.assert_allclose(bs.hess_forsbach(joint) * 20.0 / 1000.0, expected, rtol=1e-14)
