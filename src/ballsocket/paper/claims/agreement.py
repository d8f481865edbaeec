"""What the paper says of how well the models agree with its finite elements (Section 3)."""

from __future__ import annotations

from dataclasses import replace

import numpy

from ...contact import Contact, Model
from ...elasticity.finite_elements.contact import MeshedContact
from ...elasticity.finite_elements.model import FiniteElement
from ...elasticity.finite_elements.spacing import Element, Uniform
from ...identify.modulus import max_relative_error
from ...models.foundation import Bartel, BondedLayer, HessForsbach
from ...models.half_space import Hertz
from .. import cases
from .finding import SHOWN, Finding, graded, named, percent, true


def only_the_liner_deforms(reference: Model) -> Finding:
    """Section 3.1: the steel head taken as rigid."""
    rigid, steel = (
        reference.press(joint, force=cases.LOAD) for joint in (replace(cases.hip(), ball=None), cases.hip())
    )
    changes = {name: percent(getattr(rigid, name) / getattr(steel, name) - 1) for name in SHOWN}
    return Finding(
        name="only-the-liner-deforms",
        where="Section 3.1",
        sentence="Steel is so much stiffer than plastic that only the liner need be taken as elastic.",
        numbers={f"{named(name)} of a rigid head, %": value for name, value in changes.items()},
        **graded(max(map(abs, changes.values()))),
    )


def hertz_is_inadequate(reference: Model) -> Finding:
    """Figure 3: Hertz at 3 kN."""
    off = _deviations(Hertz(), reference, 0.4, SHOWN[:2])
    return Finding(
        name="hertz-is-inadequate",
        where="Section 3.2, Figure 3",
        sentence="Hertz' theory is not adequate for this contact.",
        numbers={f"{named(name)} off by, %": value for name, value in off.items()},
        **true(all(abs(value) > 20 for value in off.values())),
    )


def good_agreement_at_0_4(reference: Model) -> Finding:
    """Figures 3 and 5: the closed form at ν 0.4, at 3 kN and, for the force, at indentations of 1 to 3 kN."""
    worst = dict.fromkeys((*SHOWN[:2], "force"), 0.0)
    for series in (*cases.series().values(), cases.hip()):
        truth, ours = (model.press(series, force=cases.LOAD) for model in (reference, HessForsbach()))
        curve = reference.press(series, force=cases.LOADS[:, None])
        pushed = HessForsbach().press(series, indentation=curve.indentation)
        for name in SHOWN[:2]:
            off = max_relative_error(getattr(ours, name), getattr(truth, name))
            worst[name] = max(worst[name], percent(off))
        worst["force"] = max(worst["force"], percent(max_relative_error(pushed.force, curve.force)))
    return Finding(
        name="good-agreement-at-0.4",
        where="Section 3.2, Figures 3 and 5",
        sentence="At ν 0.4 force and pressure of the closed form agree very well with finite elements, in all cases.",
        numbers={
            "indentation at 3 kN, worst, %": worst["indentation"],
            "peak pressure at 3 kN, worst, %": worst["max_pressure"],
            "force at one indentation, worst, %": worst["force"],
        },
        **graded(max(worst.values())),
    )


def older_models_acceptable_at_0_4(reference: Model) -> Finding:
    """Figure 3: Bartel and the bonded layer at ν 0.4."""
    off = {
        model.name: _deviations(model, reference, 0.4, ("max_pressure",))["max_pressure"]
        for model in (Bartel(), BondedLayer())
    }
    return Finding(
        name="older-models-acceptable-at-0.4",
        where="Section 3.2, Figure 3",
        sentence="At ν 0.4 Bartel's model and the bonded layer give peak pressures slightly higher, within limits.",
        numbers={f"{name}, %": value for name, value in off.items()},
        **true(all(0 < value < 10 for value in off.values())),
    )


def minor_deviations_at_0_45(reference: Model) -> Finding:
    """Figure 4: the closed form at ν 0.45."""
    off = _deviations(HessForsbach(), reference, 0.45, SHOWN[:2])
    return Finding(
        name="minor-deviations-at-0.45",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 the closed form deviates from finite elements only a little.",
        numbers={f"{named(name)}, %": value for name, value in off.items()},
        **graded(max(map(abs, off.values()))),
    )


def overestimated_pressure(reference: Model) -> Finding:
    """Figure 4: Bartel and the bonded layer at ν 0.45."""
    bartel, bonded = (
        _deviations(model, reference, 0.45, ("max_pressure",))["max_pressure"] for model in (Bartel(), BondedLayer())
    )
    high = (percent((1 + bartel / 100) / 1.17 - 1), percent((1 + bonded / 100) / 1.25 - 1))
    return Finding(
        name="overestimated-pressure",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 and 3 kN Bartel's model overestimates the peak pressure by 17 %, the bonded layer by 25 %.",
        numbers={"Bartel, %": bartel, "bonded layer, %": bonded},
        unit="% of p0",
        comment=f"Theirs follow from elements whose peak pressure is {min(high):.1f} to {max(high):.1f} % higher.",
        **graded(max(abs(bartel - 17), abs(bonded - 25)), close=1.0),
    )


def deviations_grow_with_poisson(reference: Model) -> Finding:
    """Section 3, after Imado et al. 2005: Bartel's peak pressure by ν."""
    off = {
        f"ν {poisson:g}, %": _deviations(Bartel(), reference, poisson, ("max_pressure",))["max_pressure"]
        for poisson in (0.3, 0.4, 0.45, 0.46, 0.49)
    }
    values = list(off.values())
    return Finding(
        name="deviations-grow-with-poisson",
        where="Section 3",
        sentence="Bartel's model is somewhat stiffer than the liner, noticeably so for larger Poisson's ratios.",
        numbers=off,
        **true(values == sorted(values) and values[-2] > 15),
    )


def wide_half_angle(reference: Model) -> Finding:
    """Figure 5: how much wider the closed form's contact is, over all its joints."""
    excess: dict[str, float] = {}
    for symbol, series, values in cases.named_series():
        angle = reference.press(series, force=cases.LOAD).half_angle
        wider = HessForsbach().press(series, force=cases.LOAD).half_angle / angle - 1
        excess |= {f"{symbol} {value:g} mm": percent(share) for value, share in zip(values, wider, strict=True)}
    least, most = min(excess, key=excess.__getitem__), max(excess, key=excess.__getitem__)
    low, high = excess[least], excess[most]
    return Finding(
        name="wide-half-angle",
        where="Section 3.2, Figure 5",
        sentence="The closed form's half angle is 3 to 8 % larger than that of finite elements (ν 0.4, 3 kN).",
        numbers={f"least, at {least}, %": low, f"most, at {most}, %": high},
        unit="% of ε",
        comment="Springs do not press their neighbours down: the real pressure falls to the edge as a root, theirs "
        "as a line that goes farther, and the more so the thicker the liner.",
        **graded(max(3.0 - low, high - 8.0, 0.0), close=0.5),
    )


def usable_above_0_45(reference: Model) -> Finding:
    """Conclusion 1: ν 0.46 and 0.49 on liners from thick to thin, at 1 and 3 kN."""
    worst = dict.fromkeys(SHOWN, 0.0)
    for poisson in (0.46, 0.49):
        joints = cases.by_ratio(numpy.array([0.8, 1.2, 1.8, 2.8, 4.1, 5.8, 7.5]), poisson)
        truth, ours = (model.press(joints, force=cases.LOADS[[0, -1], None]) for model in (reference, HessForsbach()))
        for name in worst:
            off = max_relative_error(getattr(ours, name), getattr(truth, name))
            worst[name] = max(worst[name], percent(off))
    return Finding(
        name="usable-above-0.45",
        where="Conclusions, 1",
        sentence="The closed form gives acceptable results whatever the liner's thickness, also for ν above 0.45.",
        numbers={f"{named(name)}, worst, %": value for name, value in worst.items()},
        comment="ν 0.46 and 0.49, 1 and 3 kN, R2/L 0.8 to 7.5. One modulus cannot follow how p0/d grows with the load.",
        **graded(max(worst.values()), close=10.0, wide=20.0),
    )


def older_models_err_considerably(reference: Model) -> Finding:
    """Conclusions: each older model somewhere on Table 1, at ν 0.4 and 0.45."""
    worst = {}
    for model in (Bartel(), BondedLayer(), Hertz()):
        off = []
        for poisson in (0.4, 0.45):
            _, _, joints = cases.outline(poisson)
            truth, theirs = (each.press(joints, force=cases.LOAD).max_pressure for each in (reference, model))
            off.append(max_relative_error(theirs, truth))
        worst[f"{model.name}: peak pressure, worst, %"] = percent(max(off))
    return Finding(
        name="older-models-err-considerably",
        where="Conclusions",
        sentence="All existing models accept considerable errors under these conditions.",
        numbers=worst,
        comment="Over the outline of Table 1 at ν 0.4 and 0.45, 3 kN.",
        **true(min(worst.values()) > 10),
    )


def mesh_is_fine_enough(_: Model) -> Finding:
    """Section 3: the paper's elements of 0.05 mm, and twice as many, for its 12 mm head in 8 mm of liner."""
    joint = cases.joint(head_radius=12.0, liner_thickness=8.0)
    coarse, fine = (dense_elements(size) for size in (0.05, _TWICE_AS_MANY))
    depth = HessForsbach().press(joint, force=cases.LOAD).indentation
    one, other = (model.press(joint, indentation=depth) for model in (coarse, fine))
    changes = {
        f"{named(name)}, %": percent(getattr(other, name) / getattr(one, name) - 1)
        for name in ("force", "half_angle", "max_pressure")
    }
    return Finding(
        name="mesh-is-fine-enough",
        where="Section 3",
        sentence="With twice as many elements force, contact angle and peak pressure grow by less than 1 %.",
        numbers={"elements": _elements(one), "twice as many": _elements(other), **changes},
        comment="Four-node elements of 0.05 mm along the contact, then of 0.0315 mm, at one indentation.",
        **true(max(map(abs, changes.values())) < 1),
    )


def _elements(contact: Contact) -> float:
    assert isinstance(contact, MeshedContact)
    return float(contact.mesh.elements)


_TWICE_AS_MANY = 0.0315  # mm: elements grow with depth, so that it takes more than 0.05/√2


def dense_elements(size: float = 0.05) -> FiniteElement:
    """Four-node elements of one size in mm all along the surfaces; the paper's have 0.05."""
    return FiniteElement(spacing=Uniform(size=size), element=Element.BILINEAR, meshes=1)


def _deviations(model: Model, reference: Model, poisson: float, names: tuple[str, ...]) -> dict[str, float]:
    """Deviations of a model from the reference in the hip of Fig. 3 at 3 kN, in percent."""
    truth, theirs = (each.press(cases.hip(poisson), force=cases.LOAD) for each in (reference, model))
    return {name: percent(getattr(theirs, name) / getattr(truth, name) - 1) for name in names}
