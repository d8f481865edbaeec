"""What a hip on the screen goes through and how it wears, as plain data: to and from a link, and as a hip in use."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ..core.checks import check_names, require, shown
from ..core.kinds import Kind
from ..hip import Cycle, InUse, named_cycle
from ..hip.coefficients import share_of_slide, wear_factor
from ..hip.cycle_file import read_cycle
from ..hip.cycle_registry import CYCLES
from ..hip.given_laws import given_creep, given_law, given_surface
from ..hip.in_vivo import check_body_weight
from ..io.joint_file import JointFile
from ..io.units import parse

CONTACTS = ("springs", "shell", "cup")
LAWS = ("archard", "cross-shear", "area")
_TABLES = (".csv", ".txt", ".dat", ".mot", ".sto")
_MOST = 50.0
"""Million cycles of a run."""


@dataclass(frozen=True, kw_only=True)
class Use:
    """A cycle, how the bore gives way in it, and a law of wear.

    Attributes
    ----------
    cycle : str
        One of `hip.cycle_registry.CYCLES`.
    body_weight : float
        In N, for loads that were measured in patients.
    instant : int, optional
        Of the cycle, that is looked at; that of the largest force without.
    contact : str
        One of CONTACTS.
    law : str
        One of LAWS.
    coefficient, circular : float
        In mm³/(N m); of the area law in mm/m. On a circle, where the law is cross-shear.
    millions : float
        Of cycles.
    creep : str
        "no" or "yes".
    spread : float
        Factor of one standard deviation of the coefficient; 1 is a coefficient that is known exactly.
    """

    cycle: str = "iso-14242-1"
    body_weight: float = 800.0
    instant: int | None = None
    contact: str = "springs"
    law: str = "archard"
    coefficient: float = 1e-6
    circular: float = 2e-6
    millions: float = 5.0
    creep: str = "no"
    spread: float = 1.5

    def __post_init__(self) -> None:
        for name, known in CHOICES.items():
            check_names([getattr(self, name)], known, f"as {name}")
        check_body_weight(self.body_weight)
        if self.instant is not None:
            require("instant", self.instant, 0 <= self.instant < 10_000, "an instant of a cycle counts from 0")
        coefficient = share_of_slide if self.law == "area" else wear_factor
        for name in ("coefficient", "circular"):
            coefficient(name, getattr(self, name))
        require("spread", self.spread, 1 <= self.spread <= 5, "a factor of 1 (no scatter) to 5")
        require("millions", self.millions, 0 < self.millions <= _MOST, f"above 0, at most {_MOST:g} million cycles")


CHOICES: Mapping[str, tuple[str, ...]] = {
    "cycle": tuple(CYCLES),
    "contact": CONTACTS,
    "law": LAWS,
    "creep": ("no", "yes"),
}
"""What can be chosen, by name."""

WHOLE = Use()
"""What a page without a link shows."""

_NUMBERS: Mapping[str, Callable[[Any], Any]] = {
    "body_weight": lambda text: parse("body_weight", text, Kind.FORCE),
    "instant": lambda text: _instant(parse("instant", text, Kind.NUMBER)),
    "coefficient": lambda text: parse("coefficient", text, Kind.NUMBER),
    "circular": lambda text: parse("circular", text, Kind.NUMBER),
    "spread": lambda text: parse("spread", text, Kind.NUMBER),
    "millions": lambda text: parse("millions", text, Kind.NUMBER),
}


def _instant(number: float) -> int:
    require("instant", number, number.is_integer(), "a whole number, counted from 0")
    return int(number)


def pairs_of(use: Use) -> list[tuple[str, str]]:
    """What differs from `WHOLE`, as pairs of a link."""
    names = [each.name for each in fields(use) if getattr(use, each.name) != getattr(WHOLE, each.name)]
    return [(f"use.{name}", str(getattr(use, name))) for name in names]


def use_of(pairs: Mapping[str, str]) -> Use:
    """What pairs of a link say, without the word before their dot.

    Raises
    ------
    ValueError
        One sentence: what is wrong.
    """
    check_names(pairs, [each.name for each in fields(Use)], "of a hip in use in the link")
    words: dict[str, Any] = {name: _NUMBERS[name](text) if name in _NUMBERS else text for name, text in pairs.items()}
    return Use(**words)


@dataclass(frozen=True)
class Own:
    """A cycle of one's own: a table's name and text."""

    name: str
    text: str

    def __post_init__(self) -> None:
        if Path(self.name).suffix.lower() not in _TABLES:
            raise ValueError(f"{shown(self.name)} is no table of a cycle: {', '.join(_TABLES)}")

    def cycle(self, body_weight: float) -> Cycle:
        """The cycle in it, by the reader of files."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"cycle{Path(self.name).suffix.lower()}"
            path.write_text(self.text, encoding="utf-8")
            return read_cycle(path, body_weight=body_weight if "%BW" in self.text else None)


def hip_of(file: JointFile, use: Use, own: Own | None = None) -> InUse:
    """A hip in use: the joint and cup of a file, through a cycle.

    Raises
    ------
    ValueError
        A cycle that pushes the ball over the rim; what `InUse` refuses.
    """
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else None
    wear = {"law": use.law, "coefficient": use.coefficient}
    return InUse(
        joint=file.joint,
        cup=file.cup,
        cycle=own.cycle(use.body_weight) if own is not None else named_cycle(use.cycle, body_weight=weight),
        wear=given_law(wear | ({"circular": use.circular} if use.law == "cross-shear" else {})),
        surface=given_surface({"contact": use.contact}),
        creep=given_creep({"creep": {}} if use.creep == "yes" else {}, float(file.joint.liner.poisson)),
    )
