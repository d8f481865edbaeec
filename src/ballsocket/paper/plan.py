"""Recomputation of the paper in pieces: each result is stored in a file, so that a stopped run is resumed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import product
from typing import Any

from ..contact import Model
from ..core.storage.pieces import Piece, Plan, Summary
from ..elasticity.exact.model import Exact
from ..elasticity.finite_elements.model import FiniteElement
from ..model_catalogue import catalogue
from ..problem.gaps import LinearGap
from . import cases, curves
from .accuracy import accuracies
from .cases import refit_column
from .claims import CLAIMS, ELSEWHERE, MESHED_CLAIMS, MESHED_ELSEWHERE, Claim, Finding, claim
from .claims.quantities import dense_elements

ELEMENTS = "finite elements"
"""Name of the finite-element model in tables and figures."""

_MODELS = ("hertz", "bartel", "bonded-layer", "hess-forsbach", "refined", "exact")
_QUICK = (
    "In this quick run the exact elastic solution of the lined socket plays the part of the paper's finite elements; "
    "the full run has finite elements beside it in every figure and lets them judge the claims."
)
_FULL = (
    "Claims are judged by finite elements with the half ball, the free rim and the fixed outside of the paper's, on "
    "meshes that adapt themselves to the contact. Figures 3 and 4, and Figure 5 where it is drawn as in the paper, "
    "show elements of 0.05 mm, as many as the paper's; the other figures show adapted ones. Beside them is the exact "
    "elastic solution."
)


def quick_plan() -> Plan:
    """Return the plan with the exact solution in place of the paper's finite elements: seconds."""
    exact = Exact(tolerance=1e-4, gap=LinearGap)
    models = {**{name: catalogue[name] for name in _MODELS}, "exact": exact}
    return Plan(
        name="quick",
        parts={
            "accuracy": {"": _accuracy},  # the longest piece first: other processes compute the others meanwhile
            "about": {"": partial(str, _QUICK)},
            **_ledgers(exact, CLAIMS, ELSEWHERE),
            **_parts(references={"exact": exact}, models=models, dense=models),
        },
    )


def full_plan() -> Plan:
    """Return the plan with finite elements: of the paper's density in Figures 3 to 5, else adaptive ones; minutes."""
    adapted = FiniteElement(meshes=1, gap=LinearGap)
    models = {name: catalogue[name] for name in _MODELS}
    return Plan(
        name="full",
        parts={
            "accuracy": {"": _accuracy},
            "about": {"": partial(str, _FULL)},
            **_ledgers(adapted, CLAIMS + MESHED_CLAIMS, ELSEWHERE + MESHED_ELSEWHERE),
            **_parts(
                references={"exact": models["exact"], ELEMENTS: adapted},
                models={**models, ELEMENTS: adapted},
                dense={**models, ELEMENTS: dense_elements()},
            ),
        },
    )


def _ledgers(
    reference: Model, claims: tuple[Claim, ...], elsewhere: tuple[Claim, ...]
) -> dict[str, Mapping[str, Piece]]:
    return {
        part: {row.identifier: Summary(partial(_judge, row.name, reference)) for row in table}
        for part, table in (("claims", claims), ("elsewhere", elsewhere))
    }


def _judge(name: str, reference: Model) -> Finding:
    """Judge a claim by its name: its functions cannot be sent to another process."""
    return claim(name)(reference)


def _parts(
    *,
    references: Mapping[str, Model],
    models: Mapping[str, Model],
    dense: Mapping[str, Model],
) -> dict[str, Mapping[str, Piece]]:
    """Return the parts of table and figures: `references` for moduli, `dense` for published curves, else `models`."""
    drawn_in_the_paper = {"hess-forsbach": dense["hess-forsbach"], list(dense)[-1]: list(dense.values())[-1]}
    joints = {f"{series} {case}": (series, case) for series, group in curves.SERIES.items() for case in group}
    ratios = {f"{poisson:g}": poisson for poisson in cases.POISSON}
    fields = {name: model for name, model in models.items() if name != "exact"}
    return {
        "table_3": {
            f"{name} {ratio}": partial(_column, name, model, ratios[ratio])
            for (name, model), ratio in product(references.items(), ratios)
        },
        "figure_2": {ratio: Summary(partial(curves.figure_2, value, references)) for ratio, value in ratios.items()},
        "figure_2_models": {
            ratio: Summary(partial(curves.figure_2_models, value, models)) for ratio, value in ratios.items()
        },
        **{
            f"figure_{number}": {
                name: Summary(partial(curves.figure_3_or_4, number, {name: model})) for name, model in dense.items()
            }
            for number in (3, 4)
        },
        "figure_5": {
            name: Summary(partial(curves.figure_5, *joint, drawn_in_the_paper)) for name, joint in joints.items()
        },
        "figure_5_forces": {
            name: Summary(partial(curves.figure_5_forces, *joint, models)) for name, joint in joints.items()
        },
        "figure_5_pressures": {
            name: Summary(partial(curves.figure_5_pressures, *joint, models)) for name, joint in joints.items()
        },
        "figure_6": {"": Summary(partial(curves.figure_6, "hess-forsbach", models["hess-forsbach"]))},
        "figure_6_exact": {"": Summary(partial(curves.figure_6, "exact", models["exact"], _COARSE))},
        **{
            f"figure_6_{part}": {
                name: Summary(partial(curves.figure_6_deviations, quantity, name, model, models["exact"], _COARSE))
                for name, model in fields.items()
            }
            for part, quantity in (("pressures", "max_pressure"), ("areas", "area"))
        },
    }


_COARSE = 13  # number of head radii and of liner thicknesses in maps that are solved joint by joint


def _column(name: str, model: Model, poisson: float) -> dict[str, Any]:
    return {"reference": name, **refit_column(poisson, model).summary()}


def _accuracy() -> list[dict[str, Any]]:
    return [row.summary() for row in accuracies()]
