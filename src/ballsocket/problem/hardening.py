"""Hardening of a material: its yield stress as a function of the plastic strain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from typing import Any

import numpy

from ..core.checks import require, shown
from ..core.quantities import MATERIAL

OFFSET_STRAIN = 0.002
"""Plastic strain of the offset yield stress, 0.2 %, as in tensile tests of metals."""


@dataclass(frozen=True, kw_only=True)
class Hardening:
    """Isotropic hardening: true stress over plastic strain, linear between points and constant after the last.

    The first point is the end of elasticity. A single point is a perfectly plastic material.

    Parameters
    ----------
    stress : tuple of float
        Yield stresses in MPa, positive, never descending.
    plastic_strain : tuple of float
        Logarithmic plastic strain at each stress, ascending from 0: the strain minus stress over Young's modulus.
    young : float, optional
        Young's modulus in MPa that the plastic strains belong to; contacts of liners with another one have a note. None
        (default) is that of the liner.
    source : str
        Source of the curve.

    Raises
    ------
    ValueError
        Points that are not allowed, with the first of them.
    TypeError
        A modulus that is not one number.

    Examples
    --------
    >>> curve = Hardening.parse("20:0, 24:0.01, 26:0.1")
    >>> curve.stress, curve.plastic_strain
    ((20.0, 24.0, 26.0), (0.0, 0.01, 0.1))
    >>> curve.offset_yield
    20.8
    """

    stress: tuple[float, ...]
    plastic_strain: tuple[float, ...] = (0.0,)
    young: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        for name in ("stress", "plastic_strain"):
            object.__setattr__(self, name, tuple(map(float, getattr(self, name))))
        counts = len(self.stress), len(self.plastic_strain)
        if counts[0] != counts[1] or not counts[0]:
            raise ValueError(f"hardening needs one plastic strain for each stress, got {counts[1]} for {counts[0]}")
        if self.young is not None:
            if numpy.ndim(MATERIAL["young"].check(self.young)):
                raise TypeError(f"young of hardening must be one number, got {shown(self.young)}")
            object.__setattr__(self, "young", float(self.young))
        for stress in self.stress:
            require("stress of hardening", stress, 0 < stress < inf, "a yield stress (MPa) is above 0 and finite")
        first = self.plastic_strain[0]
        require("plastic strain of hardening", first, first == 0, "the first point has the plastic strain 0")
        for before, after in pairwise(self.plastic_strain):
            require("plastic strain of hardening", after, before < after < inf, "plastic strains ascend")
        for before, after in pairwise(self.stress):
            require("stress of hardening", after, before <= after, "stresses do not descend: softening is not solved")

    @classmethod
    def parse(cls, text: str, read_stress: Callable[[str], float] = float) -> Hardening:
        """Read a curve from text: points "stress:plastic strain" with commas between them, then perhaps "; E modulus".

        Stresses and modulus are in MPa.
        """
        points, semicolon, modulus = text.partition(";")
        pairs = [point.split(":") for point in points.split(",")]
        try:
            stresses, strains = zip(*((read_stress(stress), float(strain)) for stress, strain in pairs), strict=True)
            young = read_stress(modulus.strip().removeprefix("E")) if semicolon else None
        except ValueError:
            raise ValueError(
                f"hardening = {shown(text)} must be points 'stress:plastic strain', such as '21:0, 25:0.05', and may "
                "end with Young's modulus, such as '; E 1494'"
            ) from None
        return cls(stress=stresses, plastic_strain=strains, young=young)

    def __str__(self) -> str:
        points = (f"{stress!r}:{strain!r}" for stress, strain in zip(self.stress, self.plastic_strain, strict=True))
        return ", ".join(points) + (f"; E {self.young!r}" if self.young else "")

    @property
    def offset_yield(self) -> float:
        """Yield stress in MPa at a plastic strain of 0.2 %."""
        return float(numpy.interp(OFFSET_STRAIN, self.plastic_strain, self.stress))

    def yield_at_strain(self, strain: float, young: float) -> float:
        """Return the stress in MPa at a total strain, such as 0.04, for Young's modulus in MPa."""
        stress = numpy.array(self.stress)
        return float(min(numpy.interp(strain, stress / young + self.plastic_strain, stress), strain * young))

    def scaled(self, stress_factor: float, strain_factor: float = 1.0) -> Hardening:
        """Return the curve with multiplied stresses and plastic strains."""
        return replace(
            self,
            stress=tuple(stress_factor * stress for stress in self.stress),
            plastic_strain=tuple(strain_factor * strain for strain in self.plastic_strain),
        )

    def summary(self) -> dict[str, Any]:
        """Return the curve as a dictionary for JSON, stresses in MPa."""
        points = {"stress": list(self.stress), "plastic_strain": list(self.plastic_strain)}
        return {**points, "young": self.young, "source": self.source}
