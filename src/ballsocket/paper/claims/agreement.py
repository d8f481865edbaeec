"""What the paper says of how well the models agree with its finite elements (Section 3)."""

from __future__ import annotations

from dataclasses import replace

import numpy

from ...contact import Contact
from ...fem.contact import MeshedContact
from ...fem.model import FiniteElement
from ...fem.spacing import Element, Uniform
from ...models.base import Model
from ...models.foundation import Bartel, BondedLayer, HessForsbach
from ...models.half_space import Hertz
from .. import cases
from .finding import SHOWN, Finding, graded, percent


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
        numbers={f"{name.replace('_', ' ')} of a rigid head, %": value for name, value in changes.items()},
        verdict=graded(max(map(abs, changes.values())) < 2, max(map(abs, changes.values())) < 5),
    )


def hertz_is_inadequate(reference: Model) -> Finding:
    """Figure 3: Hertz at 3 kN."""
    truth, hertz = (model.press(cases.hip(), force=cases.LOAD) for model in (reference, Hertz()))
    depth, pressure = (
        percent(getattr(hertz, name) / getattr(truth, name) - 1) for name in ("indentation", "max_pressure")
    )
    return Finding(
        name="hertz-is-inadequate",
        where="Section 3.2, Figure 3",
        sentence="Hertz' theory is not adequate for this contact.",
        numbers={"indentation off by, %": depth, "peak pressure off by, %": pressure},
        verdict=graded(abs(depth) > 20 and abs(pressure) > 20, abs(depth) > 10),
    )


def good_agreement_at_0_4(reference: Model) -> Finding:
    """Figures 3 and 5: the closed form at ν 0.4."""
    worst = {"indentation": 0.0, "max_pressure": 0.0}
    for series in (*cases.series().values(), cases.hip()):
        truth, ours = (model.press(series, force=cases.LOAD) for model in (reference, HessForsbach()))
        for name in worst:
            off = numpy.max(abs(getattr(ours, name) / getattr(truth, name) - 1))
            worst[name] = max(worst[name], percent(off))
    return Finding(
        name="good-agreement-at-0.4",
        where="Section 3.2, Figures 3 and 5",
        sentence="At ν 0.4 force and pressure of the closed form agree very well with finite elements, in all cases.",
        numbers={
            "indentation at 3 kN, worst, %": worst["indentation"],
            "peak pressure, worst, %": worst["max_pressure"],
        },
        verdict=graded(max(worst.values()) < 3, max(worst.values()) < 6),
    )


def minor_deviations_at_0_45(reference: Model) -> Finding:
    """Figure 4: the closed form at ν 0.45."""
    truth, ours = (model.press(cases.hip(0.45), force=cases.LOAD) for model in (reference, HessForsbach()))
    depth, pressure = (
        percent(getattr(ours, name) / getattr(truth, name) - 1) for name in ("indentation", "max_pressure")
    )
    return Finding(
        name="minor-deviations-at-0.45",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 the closed form deviates from finite elements only a little.",
        numbers={"indentation, %": depth, "peak pressure, %": pressure},
        verdict=graded(max(abs(depth), abs(pressure)) < 5, max(abs(depth), abs(pressure)) < 8),
    )


def overestimated_pressure(reference: Model) -> Finding:
    """Figure 4: Bartel and the bonded layer at ν 0.45."""
    joint = cases.hip(0.45)
    truth = reference.press(joint, force=cases.LOAD).max_pressure
    bartel, bonded = (
        percent(model.press(joint, force=cases.LOAD).max_pressure / truth - 1) for model in (Bartel(), BondedLayer())
    )
    return Finding(
        name="overestimated-pressure",
        where="Section 3.2, Figure 4",
        sentence="At ν 0.45 and 3 kN Bartel's model overestimates the peak pressure by 17 %, the bonded layer by 25 %.",
        numbers={"Bartel, %": bartel, "bonded layer, %": bonded},
        verdict=graded(abs(bartel - 17) < 1 and abs(bonded - 25) < 1, abs(bartel - 17) < 3 and abs(bonded - 25) < 3),
        comment="A percent more than they found, as if their peak pressure were a percent above the elastic one.",
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
        numbers={"least, %": low, "most, %": high},
        verdict=graded(low >= 2.5 and high <= 8.5, low >= 1.5 and high <= 10.0),
        comment=f"Least at {least}, most at {most}, among the ends and some middles of the three series of Figure 5.",
    )


def usable_above_0_45(reference: Model) -> Finding:
    """Conclusion 1: ν 0.49 on liners from thick to thin."""
    joints = cases.by_ratio(numpy.array([1.0, 1.8, 2.8, 4.1, 5.8]), 0.49)
    truth, ours = (model.press(joints, force=cases.LOAD) for model in (reference, HessForsbach()))
    worst = {name: percent(numpy.max(abs(getattr(ours, name) / getattr(truth, name) - 1))) for name in SHOWN}
    return Finding(
        name="usable-above-0.45",
        where="Conclusions, 1",
        sentence="The closed form gives acceptable results whatever the liner's thickness, also for ν above 0.45.",
        numbers={f"{name.replace('_', ' ')} at ν 0.49, worst, %": value for name, value in worst.items()},
        verdict=graded(max(worst.values()) < 10, max(worst.values()) < 20),
        comment="One modulus cannot follow how p0/d grows with the load there.",
    )


def mesh_is_fine_enough(_: Model) -> Finding:
    """Section 3: the paper's elements of 0.05 mm, and twice as many, for its 12 mm head in 8 mm of liner."""
    joint = cases.joint(head_radius=12.0, liner_thickness=8.0)
    coarse, fine = (dense_elements(size) for size in (0.05, _TWICE_AS_MANY))
    depth = HessForsbach().press(joint, force=cases.LOAD).indentation
    one, other = (model.press(joint, indentation=depth) for model in (coarse, fine))
    changes = {
        f"{name.replace('_', ' ')}, %": percent(getattr(other, name) / getattr(one, name) - 1)
        for name in ("force", "half_angle", "max_pressure")
    }
    return Finding(
        name="mesh-is-fine-enough",
        where="Section 3",
        sentence="With twice as many elements force, contact angle and peak pressure grow by less than 1 %.",
        numbers={"elements": _elements(one), "twice as many": _elements(other), **changes},
        verdict=graded(max(map(abs, changes.values())) < 1, max(map(abs, changes.values())) < 2),
        comment="Four-node elements of 0.05 mm along the contact, then of 0.0315 mm, at one indentation.",
    )


def _elements(contact: Contact) -> float:
    assert isinstance(contact, MeshedContact)
    return float(contact.mesh.elements)


_TWICE_AS_MANY = 0.0315  # mm: elements grow with depth, so that it takes more than 0.05/√2


def dense_elements(size: float = 0.05) -> FiniteElement:
    """Four-node elements of one size in mm all along the surfaces; the paper's have 0.05."""
    return FiniteElement(spacing=Uniform(size=size), element=Element.BILINEAR, meshes=1)
