"""The first cycle of a hip in use, on a bore that is not worn."""

from __future__ import annotations

from dataclasses import dataclass

from ..core.arrays import Numbers
from .wear_law import AnyWearLaw, CycleExposure


@dataclass(frozen=True, kw_only=True)
class First:
    """A cycle on a bore that is not worn.

    Attributes
    ----------
    slide : float
        Of the ball past the line of the load, in mm.
    work : float
        ∫∫ p v dA dt in N m.
    cross_shear : float
        Its mean over the socket, weighted by p v.
    volume, depth : float
        What a million such cycles would wear: mm³, and mm at the deepest point.
    max_pressure, max_force : float
        In MPa and N.
    """

    slide: float
    work: float
    cross_shear: float
    volume: float
    depth: float
    max_pressure: float
    max_force: float


def first_of(wear: AnyWearLaw, done: CycleExposure, areas: Numbers, *, slide: float, max_force: float) -> First:
    """What a law makes of the first cycle, on cells of these areas in mm²."""
    depth, work = wear.depth(done), done.work * areas
    whole = float(work.sum())
    return First(
        slide=slide,
        work=whole / 1e3,
        cross_shear=float(done.cross_shear @ work) / whole if whole > 0 else 0.0,
        volume=1e6 * float(depth @ areas),
        depth=1e6 * float(depth.max(initial=0.0)),
        max_pressure=float(done.pressure.max(initial=0.0)),
        max_force=max_force,
    )
