"""Comparators for validation: published numbers, our results, the inputs, and the applicability to a question."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import product
from math import inf, sin
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Array, to_numpy, where
from ..model_catalogue import reference
from ..models.half_space import Hertz
from ..paper.claims import ELSEWHERE, Claim, judge
from ..problem import Joint, Layer, Material
from ..problem.presets import ALUMINA, COCR, TITANIUM, UHMWPE
from ..studies.parameters import LOADS, press_arguments
from .matrix import MatrixRow
from .question import ALMOST_ALL, Question

MEASURED = "measured"  # kind of a comparator with measurements

APPLIES, APPLIES_IN_PART, DOES_NOT_APPLY = "applies", "applies in part", "does not apply"
"""Verdicts on the applicability of a comparator."""

WITHIN, IN_PART, OUTSIDE = "within", "in part", "outside"
"""Positions of the range of a question in the range of a comparator."""

Ranges = Mapping[str, Sequence[float]]  # smallest and largest value of each similarity number


SIMILARITY: Mapping[str, Callable[[Joint, Array], Array]] = MappingProxyType(
    {
        "c/R1": lambda joint, force: joint.clearance / joint.ball_radius,
        "R1/L": lambda joint, force: joint.ball_radius / joint.liner_thickness,
        "ν": lambda joint, force: joint.liner.poisson,
        "F/(E R1²)": lambda joint, force: force / (joint.liner.young * joint.ball_radius**2),
        "E/E of the ball": lambda joint, force: where(joint.modulus_ratio < 0.02, 0.0, joint.modulus_ratio),
    }
)
"""Similarity numbers of a linear contact, without units: joints with equal numbers are similar at every size. A ball
counts as rigid if its modulus is more than fifty times that of the liner."""


@dataclass(frozen=True, kw_only=True)
class Comparator:
    """Published numbers compared with our results.

    Attributes
    ----------
    name, title, source : str
    read : str
        Part of the source that was read.
    kind : str
        Method of the source: measured, or computed by others.
    inputs, assumed : mapping of str to str
        Published inputs, and inputs that we assumed.
    published : mapping of str to str
        Published numbers.
    ours : mapping of str to tuple of float
        Smallest and largest of our results over the assumed inputs, by name with unit; empty without a result.
    reaches : mapping of str to tuple of float
        Ranges of the joints in the numbers of `SIMILARITY`.
    agreement : str
        Summary of the agreement, with its gaps.
    """

    name: str
    title: str
    source: str
    inputs: Mapping[str, str]
    published: Mapping[str, str]
    agreement: str
    assumed: Mapping[str, str] = field(default_factory=dict)
    read: str = "abstract"
    kind: str = "computed by others"
    ours: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    reaches: Ranges = field(default_factory=dict)

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {**asdict(self), "call": f"ballsocket.evidence.comparators.PUBLISHED[{self.name!r}]()"}


_DUROM = (
    "Finite elements of a resurfacing and a total hip, fixed to pelvis and femur, J Bone Joint Surg Br 88-B, Suppl III "
    "(proceedings), doi 10.1302/0301-620X.88BSUPP_III.0880383a"
)
_QUANTITIES = {
    "pole pressure, MPa": "pole_pressure",
    "largest pressure, MPa": "max_pressure",
    "contact area, mm²": "area",
}


def _result_ranges(joints: Sequence[Joint], force: float) -> dict[str, tuple[float, float]]:
    contacts = [reference.press(joint, force=force) for joint in joints]
    return {title: _range(getattr(contact, name) for contact in contacts) for title, name in _QUANTITIES.items()}


def durom() -> Comparator:
    """Compare our results with the published DUROM resurfacing: cobalt-chromium on bone."""
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
        source=_DUROM,
        inputs={"head": "50 mm", "bore": "50.145 mm", "wall": "around 4 mm", "load": "3200 N", "material": "CoCr"},
        assumed={
            "wall": "3.5 to 4.5 mm",
            "bone": "massive, of one stiffness, 0.3 to 1 GPa, ν 0.3 (theirs: 1 mm of cortex on spongy bone)",
            "CoCr": str(COCR),
        },
        published={"largest pressure": "around 22 MPa", "contact area": "237 mm²"},
        ours=_result_ranges(joints, 3200.0),
        reaches=similarity_ranges((joint, 3200.0) for joint in joints),
        agreement="The pressure lies within what is assumed. The area is not explained: ours is an eighth to a third "
        "smaller, for every assumed wall and bone.",
    )


def metasul() -> Comparator:
    """Compare our results with the published METASUL inlay: metal in polyethylene."""
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
        source=_DUROM,
        inputs={"head": "28 mm", "bore": "28.12 mm", "load": "3200 N", "material": "CoCr"},
        assumed={"wall of the inlay": "2 to 4 mm", "polyethylene behind": "3 to 5 mm", "CoCr": str(COCR)},
        published={"largest pressure": "about 47 MPa", "contact area": "74 mm²"},
        ours=_result_ranges(joints, 3200.0),
        reaches=similarity_ranges((joint, 3200.0) for joint in joints),
        agreement="Very sensitive to the wall, which is not published with these numbers: no agreement is claimed.",
    )


def mak() -> Comparator:
    """Compare Hertz' theory with our results for a ceramic insert, as the source does."""
    force, backings = 2500.0, ((), (Layer(thickness=3.0, material=TITANIUM),))
    joints = [
        Joint(ball_radius=radius, clearance=gap, liner_thickness=5.0, liner=ALUMINA, ball=ALUMINA, backing=backing)
        for radius, gap, backing in product((14.0, 18.0), (0.02, 0.04, 0.08), backings)
    ]
    pairs = [(reference.press(joint, force=force), Hertz().press(joint, force=force)) for joint in joints]
    width = [float(exact.joint.socket_radius) * sin(exact.half_angle) / 5.0 for exact, _ in pairs]
    return Comparator(
        name="mak",
        title="Ceramic insert on a ceramic head",
        source="Mak & Jin 2002, Proc. IMechE H, from page 231: Analysis of contact mechanics in ceramic-on-ceramic hip "
        "joint replacements",
        inputs={"insert": "at least 5 mm of ceramic", "material": "ceramic on ceramic"},
        assumed={
            "insert": "5 mm",
            "head": "28 and 36 mm",
            "radial clearance": "0.02 to 0.08 mm",
            "load": "2500 N",
            "behind the insert": "rigid, or 3 mm of titanium",
            "ceramic": str(ALUMINA),
        },
        published={"contact": "small against head and insert", "largest pressure and area": "as Hertz estimates them"},
        ours={
            "largest pressure of Hertz over ours": _range(
                hertz.max_pressure / exact.max_pressure for exact, hertz in pairs
            ),
            "area of Hertz over ours": _range(hertz.area / exact.area for exact, hertz in pairs),
            "radius of the contact over the insert's thickness": _range(width),
        },
        reaches=similarity_ranges((joint, force) for joint in joints),
        agreement="Hertz is an estimate: up to a seventh low in pressure and a tenth high in area with a rigid "
        "backing, and closer on titanium. The contact is as wide as the insert is thick at the smallest clearance, so "
        "'small' depends on the assumed inputs.",
    )


def kurtz() -> Comparator:
    """Compare our results with published liners of 3 to 12 mm in a metal shell."""
    force = 2500.0
    joints = [
        Joint(ball_radius=radius, clearance=gap, liner_thickness=thickness, liner=UHMWPE, ball=COCR)
        for radius, gap, thickness in product((11.0, 14.0, 16.0), (0.05, 0.1, 0.2), (3.0, 12.0))
    ]
    pressures = [float(reference.press(joint, force=force).max_pressure) for joint in joints]
    ratios = [thin / thick for thin, thick in zip(pressures[::2], pressures[1::2], strict=True)]
    return Comparator(
        name="kurtz",
        title="Liner of 3 to 12 mm in a metal shell",
        source="Kurtz, Edidin & Bartel 1997, doi 10.1016/S0021-9290(96)00181-9",
        inputs={"liner": "3 to 12 mm of polyethylene", "load": "36 to 63° from the dome"},
        assumed={
            "head": "22 to 32 mm",
            "radial clearance": "0.05 to 0.2 mm",
            "load": "2500 N, along the axis",
            "polyethylene": str(UHMWPE),
        },
        published={
            "stress by thickness": "varies by about 80 %",
            "stress by direction of the load": "varies by about 20 %",
            "stress by friction of the shell": "varies by 1 to 10 %",
        },
        ours={"largest pressure of 3 mm over that of 12 mm": _range(ratios)},
        reaches=similarity_ranges((joint, force) for joint in joints),
        agreement="Thickness has the largest influence in both; ours varies by less, 41 to 69 %. Head, clearance, "
        "load and moduli are not in the abstract, and their load is tilted: no agreement in numbers is claimed.",
    )


def anderson() -> Comparator:
    """State the published numbers of the cartilage of a natural hip, which is not a lined socket."""
    return Comparator(
        name="anderson",
        title="Natural hip: cartilage on bone, pressure film",
        source="Anderson et al. 2008, J. Biomech. Eng. 130, 051008, doi 10.1115/1.2953472",
        kind=f"{MEASURED}, and computed by others",
        inputs={"hip": "one cadaver, its own shape", "loads": "walking, stairs up and down, after loads in vivo"},
        published={
            "largest pressure, measured": "10.0 MPa, where the film saturates",
            "mean pressure, measured": "4.4 to 5.0 MPa",
            "contact area, measured": "322 to 425 mm²",
            "largest pressure, computed": "10.8 to 12.7 MPa",
            "mean pressure, computed": "5.1 to 6.2 MPa",
            "contact area, computed": "304 to 366 mm²",
        },
        agreement="Not computed here: cartilage of varying thickness between bones that are not round is not a lined "
        "socket. The numbers show the difference of two good methods on such a joint, and the limit of a film.",
    )


def ptfe() -> Comparator:
    """State the limits of a bearing with a PTFE liner: a permanent set."""
    young = 4.5e5 * 6.894757e-3  # MPa, from psi
    return Comparator(
        name="ptfe",
        title="Spherical bearings lined with PTFE: static limit loads",
        source="MinebeaMitsumi, technical data of rod end and spherical bearings (limits); NHBB, self-lubricating "
        "liner systems (modulus)",
        read="web pages",
        kind="stated by makers",
        inputs={"radial limit": "482 or 541 MPa on the projected area", "modulus": "4.5e5 psi, 3100 MPa"},
        published={"permanent set at the radial limit": "at most 0.076 mm", "at the axial limit": "at most 0.127 mm"},
        ours={"nominal strain at the radial limit, %": (100 * 482 / young, 100 * 541 / young)},
        agreement="Not comparable: a permanent set is not elastic, and at that load the strain of a linear liner would "
        "be a sixth. The limit shows the end of the range of our models, not their accuracy within it.",
    )


PUBLISHED: Mapping[str, Callable[[], Comparator]] = MappingProxyType(
    {make.__name__: make for make in (durom, metasul, mak, kurtz, anderson, ptfe)}
)
"""Comparators by name. Publications that state all inputs are among the claims of `paper.claims`."""

CLAIMS: Mapping[str, Claim] = MappingProxyType({row.identifier: row for row in ELSEWHERE})
"""Claims of other authors, by identifier."""


def claim(name: str) -> dict[str, Any]:
    """Judge a claim of other authors, with the ranges of its joints; return one dictionary for JSON."""
    row = CLAIMS[name]
    assert row.joints is not None
    call = f"ballsocket.evidence.comparators.claim({name!r})"
    return {**judge(row, reference).summary(), "reaches": similarity_ranges([row.joints()]), "call": call}


def similarity_ranges(loaded: Iterable[tuple[Joint, Any]]) -> Ranges:
    """Compute the ranges of the similarity numbers over joints with their forces in N."""
    pairs = list(loaded)
    return {name: _range([number(*pair) for pair in pairs]) for name, number in SIMILARITY.items()}


def _range(values: Iterable[Any]) -> tuple[float, float]:
    """Return the smallest and the largest of several arrays; NaN is ignored."""
    flat = numpy.concatenate([to_numpy(value).ravel() for value in values])
    return float(numpy.nanmin(flat)), float(numpy.nanmax(flat))


def question_ranges(question: Question, rows: Sequence[MatrixRow]) -> Ranges:
    """Compute the ranges of the similarity numbers over the matrix of a question and over its tolerances."""
    cases = {name: numpy.array([row.case[name] for row in rows]) for name in rows[0].case}
    forces = numpy.array([row.numbers.get("force", numpy.nan) for row in rows])
    ends = {name: spread.frozen.ppf(ALMOST_ALL) for name, spread in question.tolerances.items() if name not in LOADS}
    changes = [{}, *({name: end} for name, pair in ends.items() for end in pair)]
    return similarity_ranges(
        (press_arguments(question.file.joint, {**cases, **change})[0], forces) for change in changes
    )


def applicability(reaches: Mapping[str, Sequence[float]], needed: Ranges, tilted: bool) -> dict[str, Any]:
    """Judge the applicability of a comparator to a question; return one dictionary for JSON.

    The ranges of comparator and question are in the numbers of `SIMILARITY`. The load of a question may be tilted;
    every comparator has a load along the axis.
    """
    positions = {name: _position(needed[name], reaches[name]) for name in reaches}
    gaps = [
        f"{name} {range_text(needed[name])} against {range_text(reaches[name])}"
        for name, position in positions.items()
        if position != WITHIN
    ]
    gaps += ["a tilted load against one along the axis"] if tilted else []
    gaps += [] if positions else ["no joint of one lined socket is behind it"]
    outside = [name for name, position in positions.items() if position == OUTSIDE]
    if not positions or "E/E of the ball" in outside or len(outside) > len(positions) / 2:
        verdict = DOES_NOT_APPLY
    else:
        verdict = APPLIES_IN_PART if gaps else APPLIES
    return {"verdict": verdict, "where": positions, "text": ": ".join(filter(None, [verdict, "; ".join(gaps)]))}


def _position(needed: Sequence[float], reached: Sequence[float]) -> str:
    """Return the position of a needed range in a reached range, apart from rounding."""
    low, high = reached[0] * (1 - 1e-9), reached[1] * (1 + 1e-9)
    if low <= needed[0] and needed[1] <= high:
        return WITHIN
    return IN_PART if needed[0] <= high and low <= needed[1] else OUTSIDE


def range_text(ends: Sequence[float]) -> str:
    """Format a range with three digits, such as "1 to 2.5"."""
    low, high = (f"{end:.3g}" for end in ends)
    return low if low == high else f"{low} to {high}"
