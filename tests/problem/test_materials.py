"""Names of materials, and limits and moduli of UHMWPE compared with a published curve.

The curve is that of the three-network model of Bergström & Bischoff 2010 in a compressed bar, with their parameters for
300 K, as Ansys 2024 R2 prints them in its Verification Manual, VM314. The bar is incompressible (bulk modulus 6000 MPa
over shear moduli of 500 MPa).
"""

import string
from dataclasses import replace
from math import exp, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.problem import presets
from ballsocket.problem.presets import MATERIAL_ALIASES, find_material, material_hint, material_label, named_material

from ..extent import either


@pytest.mark.parametrize(
    ("names", "material"),
    [
        (("HXLPE", "xlpe", "Highly cross-linked polyethylene", "cross-linked PE"), bs.CROSSLINKED_PE),
        (("CoCrMo",), bs.COCR),
        (("Ti-6Al-4V", "Ti6Al4V"), bs.TITANIUM),
        (("ZTA",), bs.ALUMINA_COMPOSITE),
        (("Bone_Cement",), bs.BONE_CEMENT),
    ],
)
def test_further_names_find_the_preset(names, material):
    for name in names:
        assert named_material("liner", name) is bs.materials[name] is material


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("PCU", r"liner material 'PCU' \(polycarbonate urethane\) has no preset, .* give young and poisson from"),
        ("zirconia", "has no preset, because no numbers with a source are known here"),
        ("polyethylene", "may be 'uhmwpe' or 'crosslinked-pe': use one of these names"),
        ("wood", "is not known; known: uhmwpe, crosslinked-pe"),
        ("hxlp", "is not known; did you mean 'crosslinked-pe'"),
    ],
)
def test_other_names_are_refused_with_a_reason(name, message):
    with pytest.raises(ValueError, match=message):
        named_material("liner", name)
    with pytest.raises(KeyError):
        bs.materials[name]


def with_one_error(name):
    """Return all texts with one letter left out, added, replaced or exchanged with its neighbour."""
    cuts = [(name[:i], name[i:]) for i in range(len(name) + 1)]
    letters = string.ascii_lowercase + string.digits
    texts = {a + letter + b[skip:] for a, b in cuts for letter in letters for skip in (0, 1)}
    texts |= {a + b[1:] for a, b in cuts} | {a + b[1] + b[0] + b[2:] for a, b in cuts if len(b) > 1}
    return texts - set(presets._FAMILY)


def test_each_name_has_one_family_and_a_suggestion_never_names_another():
    names, suggested = sorted(presets._FAMILY), 0
    for name in names[:: either(quick=len(names) // 2, long=40)]:  # all of them take minutes
        hints = [hint for hint in map(material_hint, with_one_error(name)) if "did you mean" in hint]
        assert [hint for hint in hints if repr(presets._FAMILY[name]) not in hint] == []
        suggested += len(hints)
    assert suggested > 300
    compact = [presets._compact(name) for name in (*bs.materials, *MATERIAL_ALIASES)]
    assert len(set(compact)) == len(compact)
    assert {find_material(name) for name in MATERIAL_ALIASES} == set(bs.materials)
    assert not set(presets._REFUSED) & set(presets._PRESET_OF)


MU_A, MU_B, MU_B_FINAL, MU_C = 200.0, 293.0, 79.1, 10.0  # MPa
LOCKING_STRETCH, SECOND_INVARIANT_SHARE, EVOLUTION_RATE = 3.25, 0.23, 31.9
FLOW_A, FLOW_B, EXPONENT, PRESSURE_SHARE = 3.25, 20.1, 20.0, 0.073  # MPa, MPa, -, -


def compressed_bar(rate, strain=0.045, steps=4000):
    """Return true strains and true stresses (MPa, positive) of a bar in compression at a strain rate (1/s)."""
    flow_a, flow_b, mu_b, stresses = 0.0, 0.0, MU_B, []  # plastic log strains of the networks A and B
    step = strain / rate / steps
    for number in range(1, steps + 1):
        total = -number * strain / steps
        stress_a, stress_b = eight_chain(MU_A, total - flow_a), eight_chain(mu_b, total - flow_b)
        stresses.append(-(stress_a + stress_b + network_c(total)))
        rate_a, rate_b = flow_rate(stress_a, FLOW_A), flow_rate(stress_b, FLOW_B)
        flow_a -= sqrt(2 / 3) * rate_a * step
        flow_b -= sqrt(2 / 3) * rate_b * step
        mu_b -= EVOLUTION_RATE * (mu_b - MU_B_FINAL) * rate_a * step
    return strain / steps * np.arange(1, steps + 1), np.array(stresses)


def flow_rate(stress, resistance):
    """Effective rate (1/s), (tau/(tau_flow + a p))^m, under an axial stress: tau is the norm of its deviator."""
    return (sqrt(2 / 3) * abs(stress) / (resistance - PRESSURE_SHARE * stress / 3)) ** EXPONENT


def inverse_langevin(x):
    return x * (3 - x * x) / (1 - x * x)


def eight_chain(modulus, strain):
    """Axial minus lateral stress of the eight-chain model at a log strain."""
    axial, lateral = exp(2 * strain), exp(-strain)
    stretch = sqrt((axial + 2 * lateral) / 3)
    chain = inverse_langevin(stretch / LOCKING_STRETCH) / inverse_langevin(1 / LOCKING_STRETCH)
    return modulus / stretch * chain * (axial - lateral)


def network_c(strain):
    axial, lateral = exp(2 * strain), exp(-strain)
    second = MU_C * ((axial + 2 * lateral) * (axial - lateral) - (axial**2 - lateral**2))
    return (eight_chain(MU_C, strain) + SECOND_INVARIANT_SHARE * second) / (1 + SECOND_INVARIANT_SHARE)


STRAIN, STRESS = compressed_bar(rate=0.007)
INITIAL = STRESS[9] / STRAIN[9]


def secant_ratio(stress):
    return np.interp(stress, STRESS, STRESS / STRAIN) / INITIAL


def test_strain_is_proportional_to_stress_up_to_the_proportional_limit():
    limit = bs.UHMWPE.proportional_limit
    assert secant_ratio(limit) == pytest.approx(0.99, abs=0.005)
    assert secant_ratio(limit - 1.0) > 0.995
    assert secant_ratio(limit + 1.5) < 0.93


def test_the_hardening_of_uhmwpe_is_the_curve_of_the_three_network_model():
    """The preset is a table of another integration, within 3 % at its points and 5 % on the chords between them."""
    curve = bs.UHMWPE.hardening
    stress = np.linspace(curve.stress[0], 20.0)
    strain = stress / curve.young + np.interp(stress, curve.stress, curve.plastic_strain)
    assert np.interp(strain, STRAIN, STRESS) == pytest.approx(stress, rel=0.05)
    assert curve.young == pytest.approx(INITIAL, rel=0.015)
    assert curve.yield_at_strain(0.04, curve.young) == pytest.approx(np.interp(0.04, STRAIN, STRESS), rel=0.03)
    assert curve.offset_yield == pytest.approx(STRESS[np.argmax(STRESS < INITIAL * (STRAIN - 0.002))], rel=0.05)


def test_the_modulus_of_a_hardening_is_one_number_of_any_kind():
    curve = bs.Hardening(stress=(20.0, 24.0), plastic_strain=(0.0, 0.01), young=np.float64(1200.0))
    assert bs.Hardening.parse(str(curve)) == curve
    with pytest.raises(TypeError, match="young of hardening must be one number"):
        bs.Hardening(stress=(20.0,), young=np.array([1200.0, 1300.0]))


def test_only_the_elastic_constants_of_a_preset_have_the_label_of_its_grade():
    grade = material_label(bs.UHMWPE, "a material")
    assert grade == "UHMWPE, conventional"
    assert material_label(bs.UHMWPE.without_strengths(), "a material") == grade
    assert material_label(replace(bs.UHMWPE, young=500.0), "a material") == "UHMWPE"
    assert material_label(replace(bs.UHMWPE, poisson=0.3), "a material") == "UHMWPE"
