"""Displacements that a rigid ball prescribes, and their Abel transforms."""

import numpy as np
import pytest
from scipy.integrate import quad

from ballsocket.evidence.question import read_question
from ballsocket.identification.file import read_identify
from ballsocket.problem.gaps import GAP_KINDS, CircularGap, LinearGap
from ballsocket.studies.file import read_study

ANGLES = np.array([0.05, 0.4, 0.9, 1.3])
GAPS = [LinearGap(clearance=0.3, socket_radius=18.0), CircularGap(clearance=0.3, socket_radius=18.0)]
EACH_GAP = pytest.mark.parametrize("gap", GAPS, ids=lambda gap: type(gap).__name__)
DEPTH = 0.25


def abel(function, t):
    """Compute d/dt ∫ u sin φ dφ / sqrt(2 (cos φ - cos t)) over [0, t], with s² = cos φ - cos t."""

    def integral(end):
        def integrand(s):
            return function(np.arccos(np.cos(end) + s * s))

        return np.sqrt(2) * quad(integrand, 0.0, np.sqrt(1 - np.cos(end)), epsabs=1e-13)[0]

    far, near = (integral(t + step) - integral(t - step) for step in (2e-4, 1e-4))
    return (8 * near - far) / 12e-4


def test_displacements_are_equations_6_and_5():
    linear, circular = (gap.displacement(ANGLES, DEPTH) for gap in GAPS)
    np.testing.assert_allclose(linear, DEPTH * np.cos(ANGLES) - 0.3 * (1 - np.cos(ANGLES)), rtol=1e-12)
    e = 0.3 + DEPTH
    expected = e * np.cos(ANGLES) + np.sqrt(17.7**2 - e**2 * np.sin(ANGLES) ** 2) - 18.0
    np.testing.assert_allclose(circular, expected, rtol=1e-10, atol=1e-13)
    for gap in GAPS:
        assert gap.displacement(0.0, DEPTH) == pytest.approx(DEPTH, rel=1e-14)
    with np.errstate(invalid="ignore"):  # beyond the ball
        assert np.isnan(CircularGap(clearance=1.0, socket_radius=2.0).displacement(np.pi / 2, 0.5))


@EACH_GAP
def test_transform_is_the_abel_transform_of_the_displacement(gap):
    expected = [abel(lambda angle: gap.displacement(angle, DEPTH), t) for t in ANGLES]
    np.testing.assert_allclose(gap.transform(ANGLES, DEPTH), expected, rtol=1e-7, atol=1e-9)


@EACH_GAP
def test_slope_and_indentation_derivative_are_those_of_the_transform(gap):
    step = 1e-5
    by_angle = (gap.transform(ANGLES + step, DEPTH) - gap.transform(ANGLES - step, DEPTH)) / (2 * step)
    np.testing.assert_allclose(gap.slope(ANGLES, DEPTH), by_angle, rtol=1e-7, atol=1e-9)
    by_depth = (gap.transform(ANGLES, DEPTH + step) - gap.transform(ANGLES, DEPTH - step)) / (2 * step)
    np.testing.assert_allclose(gap.indentation_derivative(ANGLES, DEPTH), by_depth, rtol=1e-7, atol=1e-9)


@EACH_GAP
def test_transforms_take_an_indentation_for_each_angle(gap):
    depths = np.array([0.1, 0.2, 0.4, 0.3])
    for function in (gap.transform, gap.slope, gap.indentation_derivative):
        together = function(ANGLES, depths)
        alone = [function(ANGLES[i : i + 1], depths[i : i + 1])[0] for i in range(4)]
        np.testing.assert_allclose(together, alone, rtol=1e-12)


def test_gaps_agree_for_small_indentations():
    """The circular gap differs from the linear one by the square of (c + d) over R2."""
    linear, circular = (kind(clearance=1e-4, socket_radius=18.0) for kind in (LinearGap, CircularGap))
    np.testing.assert_allclose(
        circular.displacement(ANGLES, 2e-4), linear.displacement(ANGLES, 2e-4), rtol=0.0, atol=(3e-4) ** 2 / 17
    )


FILES = {
    read_study: 'model = "exact"\naxes = { force = "1 kN" }',
    read_identify: 'model = "exact"\ndata = [{ quantity = "indentation", values = "20 um", force = "1 kN" }]',
    read_question: """question = "May it be?"\ncontext_of_use = "A test."\nmatrix = { force = "1 kN" }
        risk = { influence = "low", consequence = "low" }\nrequired = { accuracy = "5 %" }""",
}


@pytest.mark.parametrize(("read", "text"), FILES.items(), ids=["study", "identify", "evidence"])
def test_files_choose_the_gap_of_their_model(read, text, tmp_path):
    path = tmp_path / "file.toml"
    for name, gap in GAP_KINDS.items():
        path.write_text(f'joint = "hip-36"\ngap = "{name}"\n{text}', encoding="utf-8")
        assert read(path).model.gap is gap
    if "exact" in text:
        path.write_text(f'joint = "hip-36"\ngap = "linear"\n{text.replace("exact", "hertz")}', encoding="utf-8")
        with pytest.raises(ValueError, match="hertz has no choice of the gap; models with one: exact, fem, sphere"):
            read(path)
