"""Validation: numbers that others published, beside ours, with every input and which of them is assumed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from math import inf
from types import MappingProxyType
from typing import Any

from ..catalogue import reference
from ..joint import Joint, Layer, Material
from ..paper.claims import ELSEWHERE, judged
from ..presets import COCR, UHMWPE


@dataclass(frozen=True, kw_only=True)
class Comparator:
    """A published number beside ours.

    Attributes
    ----------
    name, title, source : str
    inputs, assumed : mapping of str to str
        What was published, and what we had to assume.
    published : mapping of str to str
    ours : mapping of str to tuple of float
        The least and the most over what is assumed, by name with unit.
    agreement : str
        In a sentence, gaps named.
    """

    name: str
    title: str
    source: str
    inputs: Mapping[str, str]
    assumed: Mapping[str, str]
    published: Mapping[str, str]
    ours: Mapping[str, tuple[float, float]]
    agreement: str

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "source": self.source,
            "inputs": dict(self.inputs),
            "assumed": dict(self.assumed),
            "published": dict(self.published),
            "ours": {name: list(ends) for name, ends in self.ours.items()},
            "agreement": self.agreement,
            "call": f"ballsocket.evidence.comparators.PUBLISHED[{self.name!r}]()",
        }


def _ends(joints: list[Joint], force: float) -> dict[str, tuple[float, float]]:
    found = [reference.press(joint, force=force) for joint in joints]
    names = {
        "pole pressure, MPa": "pole_pressure",
        "largest pressure, MPa": "max_pressure",
        "contact area, mm²": "area",
    }
    values = {title: [float(getattr(contact, name)) for contact in found] for title, name in names.items()}
    return {title: (min(listed), max(listed)) for title, listed in values.items()}


def durom() -> Comparator:
    """A resurfacing of cobalt-chromium on bone."""
    joints = [
        Joint(
            head_diameter=50.0,
            diametral_clearance=0.145,
            liner_thickness=wall,
            liner=COCR,
            ball=COCR,
            backing=(Layer(thickness=inf, material=Material(young=bone, poisson=0.3)),),
        )
        for wall, bone in product((3.5, 4.0, 4.5), (300.0, 1000.0))
    ]
    return Comparator(
        name="durom",
        title="DUROM resurfacing, metal on metal",
        source="as reported for this implant; the publication's mesh and bone are not at hand",
        inputs={"head": "50 mm", "bore": "50.145 mm", "load": "3200 N", "material": "CoCr on CoCr"},
        assumed={"wall": "3.5 to 4.5 mm ('about 4 mm')", "bone": "massive, 0.3 to 1 GPa, ν 0.3", "CoCr": str(COCR)},
        published={"largest pressure": "about 22 MPa", "contact area": "237 mm²"},
        ours=_ends(joints, 3200.0),
        agreement="The pressure lies within what is assumed. The area is not explained: ours is an eighth to a third "
        "smaller, whatever is assumed of wall and bone.",
    )


def metasul() -> Comparator:
    """A metal inlay in polyethylene."""
    joints = [
        Joint(
            head_diameter=28.0,
            diametral_clearance=0.12,
            liner_thickness=wall,
            liner=COCR,
            ball=COCR,
            backing=(Layer(thickness=thick, material=UHMWPE),),
        )
        for wall, thick in product((2.0, 3.0, 4.0), (3.0, 5.0))
    ]
    return Comparator(
        name="metasul",
        title="METASUL inlay, metal on metal in polyethylene",
        source="as reported for this implant",
        inputs={"head": "28 mm", "bore": "28.12 mm", "load": "3200 N", "material": "CoCr on CoCr, in polyethylene"},
        assumed={"wall of the inlay": "2 to 4 mm", "polyethylene behind": "3 to 5 mm", "CoCr": str(COCR)},
        published={"largest pressure": "about 47 MPa", "contact area": "74 mm²"},
        ours=_ends(joints, 3200.0),
        agreement="Very sensitive to the wall, which is not published with these numbers: no agreement is claimed.",
    )


PUBLISHED: Mapping[str, Callable[[], Comparator]] = MappingProxyType({"durom": durom, "metasul": metasul})
"""By name; those whose inputs were published whole are among the claims of `paper.claims`."""

CLAIMS = MappingProxyType({claim.__name__: claim for claim in ELSEWHERE})


def claim(name: str) -> dict[str, Any]:
    """What others found, with a verdict, as one dictionary for JSON."""
    found = judged(CLAIMS[name], reference).summary()
    return {**found, "call": f"ballsocket.evidence.comparators.claim({name!r})"}
