"""Computed quantities behind the claims of the paper, as functions of the reference model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from itertools import product

import numpy

from ...contact import Contact, Model
from ...core.arrays import Numbers
from ...elasticity.exact.contact import ElasticContact
from ...elasticity.exact.model import Exact
from ...elasticity.finite_elements.model import FiniteElement, MeshedContact
from ...elasticity.finite_elements.spacing import Element, Uniform
from ...models.foundation import Bartel, BondedLayer, HessForsbach, Vessel
from ...models.half_space import Hertz
from ...models.modulus import bonded_layer, spherical_vessel
from ...problem import Joint, Material
from ...problem.presets import COCR, CROSSLINKED_PE, STEEL, UHMWPE
from ...studies.calibration import calibrate, max_relative_error
from .. import cases
from ..cases import RATIOS
from .evaluation import Computed, Evaluation, percent, quantity_title

COMPARED = ("indentation", "max_pressure", "half_angle")
"""Compared quantities of a contact at a given force."""

COMMON, STIFF = cases.POISSON[:4], cases.POISSON[4:]
"""Poisson's ratios up to 0.45, and 0.49."""

SOFT, CONFINED = cases.POISSON[:3], cases.POISSON[3:]
"""Poisson's ratios up to 0.4, and 0.45 and 0.49."""

_DECADE = numpy.geomspace(1.0, 10.0, 7)
_FINE_ELEMENT_SIZE = 0.0315
"""Element size in mm for twice as many elements: elements grow with depth, so this is less than 0.05/√2."""


# Foundation modulus and kinematics (Sections 2 and 3.1)


def unbounded_moduli(_: Model) -> Computed:
    """Compute the growth of both older moduli from ν 0.499 to 0.4999."""
    return {
        f"{name}: K at 0.4999 over K at 0.499": float(modulus(cases.hip(0.4999)) / modulus(cases.hip(0.499)))
        for name, modulus in (("Bartel", spherical_vessel), ("column", bonded_layer))
    }


def errors_of_linear_kinematics(_: Model) -> Computed:
    """Compute the errors of Eq. (6) against Eq. (5), both with Bartel's modulus, over the joints of Table 1."""
    joints = cases.outline()[-1]
    families = (replace(joints, clearance=cases.CLEARANCES[index]) for index in (0, -1))
    pairs = ((Vessel().press(f, force=cases.LOAD), Bartel().press(f, force=cases.LOAD)) for f in families)
    worst = _largest_errors(pairs, COMPARED)
    return {f"{quantity_title(name)}, worst, %": value for name, value in worst.items()}


def _half_range(modulus: Numbers) -> float:
    """Compute half the range of values, in percent of the middle of the range."""
    return percent((modulus.max() - modulus.min()) / (modulus.max() + modulus.min()))


def variation_over_force(reference: Model, poisson: Iterable[float], forces: Numbers = cases.LOADS) -> Computed:
    """Compute the half range of p0/d over forces, for each Poisson's ratio."""
    variations = {}
    for ratio in poisson:
        contact = reference.press(cases.hip(ratio), force=forces)
        variations[f"ν {ratio:g}, ± %"] = _half_range(contact.max_pressure / contact.indentation)
    return variations


def variations_over_decades(reference: Model, poisson: Sequence[float]) -> Evaluation:
    """Compare the half range of p0/d over 0.1 to 1 kN with that over 1 to 10 kN: claimed to be larger at every ν."""
    below, above = (variation_over_force(reference, poisson, start * _DECADE) for start in (100.0, 1000.0))
    spans = {"0.1 to 1 kN": below, "1 to 10 kN": above}
    return Evaluation(
        {f"{span}, {name}": value for span, variation in spans.items() for name, value in variation.items()},
        all(below[name] > above[name] for name in below),
    )


def variation_over_clearance(reference: Model, poisson: Iterable[float]) -> Computed:
    """Compute the half range of the mean p0/d over clearances, for each Poisson's ratio."""
    variations = {}
    for ratio in poisson:
        joints = cases.joint(
            head_radius=17.9, liner_thickness=6.75, clearance=numpy.array(cases.CLEARANCES), poisson=ratio
        )
        contact = reference.press(joints, force=cases.LOADS[:, None])
        variations[f"ν {ratio:g}, ± %"] = _half_range((contact.max_pressure / contact.indentation).mean(axis=0))
    return variations


def stiffening_by_confinement(reference: Model) -> Evaluation:
    """Compute K at ν 0.49 over K at ν 0.4, for two clearances and two thickness ratios."""
    poisson = numpy.array([0.4, 0.49])
    tight, loose = (
        cases.joint(head_radius=17.9, clearance=clearance, liner_thickness=6.75, poisson=poisson)
        for clearance in (0.05, 0.2)
    )
    thick, thin = (cases.paper_joint(poisson, numpy.array([ratio, ratio])) for ratio in (1.2, 7.5))
    rise = {}
    for name, joints in (("c 0.05 mm", tight), ("c 0.2 mm", loose), ("R2/L 1.2", thick), ("R2/L 7.5", thin)):
        contact = reference.press(joints, force=cases.LOAD)
        modulus = contact.max_pressure / contact.indentation
        rise[f"K at ν 0.49 over K at 0.4, {name}"] = float(modulus[1] / modulus[0])
    small, large, low, high = rise.values()
    return Evaluation(rise, small > large and high > low)


def errors_of_table_3(reference: Model, thin: bool) -> Computed:
    """Compute the errors of K of Table 3 for thick (R2/L up to 4.1) or thin liners, with a steel, then a rigid head."""
    ratios = RATIOS[RATIOS > 4.1] if thin else RATIOS[RATIOS <= 4.1]
    worst = {}
    for (head, ball), poisson in product({"steel": STEEL, "rigid": None}.items(), cases.POISSON):
        joints = replace(cases.paper_joint(poisson, ratios), ball=ball)
        error = max_relative_error(HessForsbach().modulus(joints), calibrate(joints, reference=reference).wanted)
        worst[f"{head} head, ν {poisson:g}, worst, %"] = percent(error)
    return worst


# Agreement of the models with the reference (Section 3)


def errors_of_a_rigid_ball(reference: Model) -> Computed:
    """Compute the errors of a rigid head against a steel head at 3 kN, in percent."""
    rigid, steel = (
        reference.press(joint, force=cases.LOAD) for joint in (replace(cases.hip(), ball=None), cases.hip())
    )
    return {
        f"{quantity_title(name)} of a rigid head, %": percent(getattr(rigid, name) / getattr(steel, name) - 1)
        for name in COMPARED
    }


def _deviations(model: Model, reference: Model, poisson: float, names: Sequence[str]) -> dict[str, float]:
    """Compute the deviations of a model from the reference in the hip of Figure 3 at 3 kN, in percent."""
    contact, truth = (solver.press(cases.hip(poisson), force=cases.LOAD) for solver in (model, reference))
    return {name: percent(getattr(contact, name) / getattr(truth, name) - 1) for name in names}


def deviations_of(model: Model, reference: Model, poisson: float, text: str = "{}, %") -> Computed:
    """Compute the deviations of a model in indentation and peak pressure at 3 kN, with a text for their names."""
    deviations = _deviations(model, reference, poisson, COMPARED[:2])
    return {text.format(quantity_title(name)): value for name, value in deviations.items()}


def pressure_deviations(reference: Model, models: dict[str, Model], poisson: float) -> Computed:
    """Compute the deviations of models in peak pressure at 3 kN, by the names of the models."""
    names = COMPARED[1:2]
    return {f"{name}, %": _deviations(m, reference, poisson, names)[names[0]] for name, m in models.items()}


def deviations_of_bartel(reference: Model) -> Computed:
    """Compute the deviation of Bartel's peak pressure for rising Poisson's ratios."""
    return {
        f"ν {poisson:g}, %": _deviations(Bartel(), reference, poisson, ("max_pressure",))["max_pressure"]
        for poisson in (0.3, 0.4, 0.45, 0.46, 0.49)
    }


def _largest_errors(pairs: Iterable[tuple[Contact, Contact]], names: Sequence[str]) -> dict[str, float]:
    """Compute the largest relative errors in percent over pairs of a contact and its reference."""
    worst = dict.fromkeys(names, 0.0)
    for contact, truth in pairs:
        for name in names:
            error = max_relative_error(getattr(contact, name), getattr(truth, name))
            worst[name] = max(worst[name], percent(error))
    return worst


def errors_at_0_4(reference: Model) -> Computed:
    """Compute the errors of the closed form at ν 0.4: at 3 kN, and of the force at indentations of 1 to 3 kN."""
    model, joints = HessForsbach(), (*cases.series().values(), cases.hip())
    at_force = ((model.press(j, force=cases.LOAD), reference.press(j, force=cases.LOAD)) for j in joints)
    worst = _largest_errors(at_force, COMPARED[:2])
    curves = ((joint, reference.press(joint, force=cases.LOADS[:, None])) for joint in joints)
    at_depth = ((model.press(joint, indentation=curve.indentation), curve) for joint, curve in curves)
    return {
        "indentation at 3 kN, worst, %": worst["indentation"],
        "peak pressure at 3 kN, worst, %": worst["max_pressure"],
        "force at one indentation, worst, %": _largest_errors(at_depth, ("force",))["force"],
    }


def excess_half_angle(reference: Model) -> Computed:
    """Compute the smallest and the largest excess of the closed form's half angle over the joints of Figure 5."""
    excess: dict[str, float] = {}
    for symbol, series, values in cases.named_series():
        angle = reference.press(series, force=cases.LOAD).half_angle
        ratios = HessForsbach().press(series, force=cases.LOAD).half_angle / angle - 1
        excess |= {f"{symbol} {value:g} mm": percent(ratio) for value, ratio in zip(values, ratios, strict=True)}
    least, largest = min(excess, key=excess.__getitem__), max(excess, key=excess.__getitem__)
    return {f"least, at {least}, %": excess[least], f"most, at {largest}, %": excess[largest]}


def errors_above_0_45(reference: Model) -> Computed:
    """Compute the largest error of the closed form above ν 0.45; at ν 0.49 on thick and on thin liners."""
    worst = {}
    for name, family, truth in _contacts_above_0_45(reference):
        contact = HessForsbach().press(family, force=_TWO_FORCES)
        worst[f"{name}, worst, %"] = max(_largest_errors([(contact, truth)], COMPARED).values())
    return worst


def errors_of_older_models(reference: Model) -> Computed:
    """Compute the largest error of each older model in peak pressure above ν 0.45."""
    contacts = _contacts_above_0_45(reference)
    worst = {}
    for model in (Bartel(), BondedLayer(), Hertz()):
        pairs = ((model.press(family, force=_TWO_FORCES), truth) for _, family, truth in contacts)
        worst[f"{model.name}: peak pressure, worst, %"] = _largest_errors(pairs, ("max_pressure",))["max_pressure"]
    return worst


_TWO_FORCES = cases.LOADS[[0, -1], None]


@cache
def _contacts_above_0_45(reference: Model) -> list[tuple[str, Joint, Contact]]:
    """Return name, joints and contacts at 1 and 3 kN of families with ν above 0.45, from thick to thin liners."""
    thick, thin = numpy.array([0.8, 1.2, 1.8, 2.8, 4.1]), numpy.array([5.8, 7.5])
    families = {
        "ν 0.46": cases.paper_joint(0.46, numpy.append(thick, thin)),
        "ν 0.49, R2/L up to 4.1": cases.paper_joint(0.49, thick),
        "ν 0.49, thinner liners": cases.paper_joint(0.49, thin),
    }
    return [(name, family, reference.press(family, force=_TWO_FORCES)) for name, family in families.items()]


def changes_by_refinement(_: Model) -> Computed:
    """Compute the changes from the paper's elements of 0.05 mm to twice as many, for a 12 mm head in 8 mm of liner."""
    joint = cases.joint(head_radius=12.0, liner_thickness=8.0)
    depth = HessForsbach().press(joint, force=cases.LOAD).indentation
    coarse, fine = (dense_elements(size).press(joint, indentation=depth) for size in (0.05, _FINE_ELEMENT_SIZE))
    return {
        "elements": _element_count(coarse),
        "twice as many": _element_count(fine),
        **{
            f"{quantity_title(name)}, %": percent(getattr(fine, name) / getattr(coarse, name) - 1)
            for name in ("force", "half_angle", "max_pressure")
        },
    }


def dense_elements(size: float = 0.05) -> FiniteElement:
    """Create a model with four-node elements of one size in mm along the surfaces; the paper has 0.05 mm."""
    return FiniteElement(spacing=Uniform(size=size), element=Element.BILINEAR, meshes=1)


def _element_count(contact: Contact) -> float:
    assert isinstance(contact, MeshedContact)
    return float(contact.mesh.elements)


# Influence of geometry (Figures 5 and 6)


def stiffness_by_geometry(reference: Model) -> Evaluation:
    """Compute the ratio of the stiffness at 3 kN between the ends of each series of Figure 5."""
    stiffness = {name: reference.press(series, force=cases.LOAD).stiffness for name, series in cases.series().items()}
    signs = {"clearance": -1, "head_radius": 1, "liner_thickness": -1}
    ratios = {
        f"stiffness at the largest over that at the smallest {quantity_title(name)}": float(values[-1] / values[0])
        for name, values in stiffness.items()
    }
    return Evaluation(ratios, all(numpy.all(sign * numpy.diff(stiffness[name]) > 0) for name, sign in signs.items()))


def pressure_by_clearance(reference: Model) -> Evaluation:
    """Compute the ratios of peak pressure and half angle between the ends of the clearance series."""
    contact = reference.press(cases.series()["clearance"], force=cases.LOAD)
    monotonic = numpy.all(numpy.diff(contact.max_pressure) > 0) and numpy.all(numpy.diff(contact.half_angle) < 0)
    ratios = {
        "p0 at 0.2 over p0 at 0.05 mm": float(contact.max_pressure[-1] / contact.max_pressure[0]),
        "ε at 0.2 over ε at 0.05 mm": float(contact.half_angle[-1] / contact.half_angle[0]),
    }
    return Evaluation(ratios, bool(monotonic))


def minimum_over_table_1(reference: Model, quantity: str, text: str) -> Computed:
    """Find the joint of Table 1 with the smallest peak pressure or area at 3 kN."""
    radius, thickness, contact = _contacts_of_table_1(reference)
    values = getattr(contact, quantity)
    best = int(numpy.nanargmin(values))
    return {text: float(values[best]), "at R1, mm": float(radius[best]), "at L, mm": float(thickness[best])}


@cache
def _contacts_of_table_1(reference: Model) -> tuple[Numbers, Numbers, Contact]:
    """Return head radii and liner thicknesses in mm within the outer radii of Table 1, and the contacts at 3 kN."""
    radius, thickness, joints = cases.outline(heads=13, liners=7)
    return radius, thickness, reference.press(joints, force=cases.LOAD)


# Results of others

DEPTH, PRESSURE, ANGLE = "indentation off by, %", "peak pressure off by, %", "half angle off by, °"
"""Names of the errors against CalculiX."""


def errors_of_elements(_: Model) -> Computed:
    """Compute the errors of our elements against CalculiX: 19 joints under five to nine loads, with a free rim."""
    return _errors_in_table(FiniteElement(meshes=1), cases.calculix())


def errors_of_exact(_: Model) -> Computed:
    """Compute the errors of the exact solution (full ball, closed shell) against CalculiX."""
    table = cases.calculix()
    compressible = table["poisson"] < 0.47
    stiff = _errors_in_table(Exact(), table[~compressible])
    return {
        **_errors_in_table(Exact(), table[compressible]),
        **{f"at ν 0.49 {name}": value for name, value in stiff.items()},
    }


def _errors_in_table(model: Model, table: Numbers) -> dict[str, float]:
    """Compute the largest errors of a model in rows of the CalculiX table."""
    contact = model.press(cases.joints_of_calculix(table), force=table["force"])
    depth, pressure = (
        percent(max_relative_error(getattr(contact, name), table[name])) for name in ("indentation", "max_pressure")
    )
    angle = float(numpy.max(abs(numpy.degrees(contact.half_angle) - table["half_angle_deg"])))
    return {DEPTH: depth, PRESSURE: pressure, ANGLE: angle}


def half_angles_of_jin(reference: Model) -> Computed:
    """Compute the half angles in degrees of Jin et al. 1999: 2.5 kN, 1000 MPa, ν 0.4."""
    joints, force = cases.jin_joints()
    half_angles = numpy.degrees(reference.press(joints, force=force).half_angle)
    return {
        f"{name}, L {thickness:g}, c {clearance:g}, °": float(angle)
        for (name, (_, thickness)), row in zip(cases.JIN_HEADS.items(), half_angles, strict=True)
        for clearance, angle in zip(cases.JIN_CLEARANCES, row, strict=True)
    }


def stresses_of_plank(_: Model) -> Evaluation:
    """Compute the largest von Mises stress at the surface of conventional and crosslinked liners, with `Exact`."""
    stress = {
        (name, liner): _surface_stress(radius, thickness, liner)
        for name, radius, thickness in cases.PLANK
        for liner in (UHMWPE, CROSSLINKED_PE)
    }
    lower_in_crosslinked = all(stress[name, CROSSLINKED_PE] < stress[name, UHMWPE] for name, *_ in cases.PLANK)
    smallest_head = stress[cases.PLANK[0][0], UHMWPE]
    lower_under_large_heads = all(stress[name, CROSSLINKED_PE] < smallest_head for name, *_ in cases.PLANK[-2:])
    return Evaluation(
        {f"{name}, {liner.name}, MPa": value for (name, liner), value in stress.items()},
        lower_in_crosslinked and lower_under_large_heads,
    )


def _surface_stress(radius: float, thickness: float, liner: Material) -> float:
    """Compute the largest von Mises stress in MPa at the surface of the liner, over the contact."""
    joint = Joint(
        ball_radius=radius, clearance=cases.PLANK_CLEARANCE, liner_thickness=thickness, liner=liner, ball=COCR
    )
    contact = Exact().press(joint, force=cases.PLANK_FORCE)
    assert isinstance(contact, ElasticContact)
    angles = numpy.linspace(0.0, 0.98, 15) * float(contact.half_angle)
    return float(numpy.max(contact.stress(angle=angles, depth=0.0).von_mises))
