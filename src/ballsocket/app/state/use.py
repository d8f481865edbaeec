"""Settings of a hip in use: cycle, wear law and creep, to and from a link."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy

from ...core.checks import check_names, require, shown
from ...core.kinds import Kind
from ...files.joint_file import JointFile
from ...files.units import parse
from ...hip import Cycle, HipSimulation, named_cycle
from ...hip.config import parse_creep, socket_surface, unused_load
from ...hip.creep_laws import CREEP_LAWS
from ...hip.cycle_file import read_cycle
from ...hip.cycle_registry import CYCLES
from ...hip.cycle_tables import ANGLES, FORCES
from ...hip.in_vivo_cycles import check_body_weight
from ...hip.law_fields import Law, LawField
from ...hip.wear_law import COEFFICIENT
from ...hip.wear_laws import WEAR_LAWS, read_wear_law

CONTACTS = ("springs", "shell", "cup")
FIELDS = ("pressure", "film")
LAWS = tuple(WEAR_LAWS)
_TABLES = (".csv", ".txt", ".dat", ".mot", ".sto")
_MAX_MILLIONS = 50.0  # million cycles of a run
_NO_CREEP, _DEFAULT_CREEP = "no", "yes"
_CREEP_PREFIX = "creep_"


def _inputs(laws: Mapping[str, type[Law]], prefix: str = "") -> dict[str, LawField]:
    """Return the required numbers of laws by the names of their inputs."""
    parts = (part for law in reversed(list(laws.values())) for part in law.law_fields())
    return {prefix + part.key: part for part in parts if part.required and not part.is_list}


WEAR_INPUTS = {key: part for key, part in _inputs(WEAR_LAWS).items() if key != COEFFICIENT}
"""Numbers of wear laws beside the coefficient, by input."""

CREEP_INPUTS = _inputs(CREEP_LAWS, _CREEP_PREFIX)  # numbers of creep laws, by input
LAW_INPUTS = WEAR_INPUTS | CREEP_INPUTS  # numbers of all laws beside the wear coefficient, by input


@dataclass(frozen=True, kw_only=True)
class Use:
    """Cycle, compliance of the bore, wear law and creep."""

    cycle: str = "iso-14242-1"
    table: str = ""  # file name of a table in place of the cycle in Gait; a link does not hold its content
    body_weight: float = 800.0  # N, for loads measured in patients
    instant: int | None = None  # shown instant of the cycle; None is that of the largest force
    contact: str = "springs"
    field: str = "pressure"  # shown on the bore
    law: str = LAWS[0]
    coefficient: float = 1e-6  # in the unit of the law
    millions: float = 5.0  # cycles
    creep: str = "no"  # "yes" is the default law, other laws have names
    spread: float = 1.5  # factor of one standard deviation of the coefficient; 1 is a known coefficient
    law_numbers: tuple[tuple[str, float], ...] = ()  # by the names of `LAW_INPUTS`; others have their examples

    def __post_init__(self) -> None:
        for name, known in CHOICES.items():
            check_names([getattr(self, name)], known, f"as {name}")
        check_body_weight(self.body_weight)
        if self.instant is not None:
            require("instant", self.instant, 0 <= self.instant < 10_000, "an instant of a cycle counts from 0")
        if self.coefficient_field is not None:
            self.coefficient_field.unit.read(COEFFICIENT, self.coefficient)
        for name, value in self.law_numbers:
            LAW_INPUTS[name].check(LAW_INPUTS[name].unit.read(name, value))
        require("spread", self.spread, 1 <= self.spread <= 5, "a factor of 1 (no scatter) to 5")
        require(
            "millions",
            self.millions,
            0 < self.millions <= _MAX_MILLIONS,
            f"above 0, at most {_MAX_MILLIONS:g} million cycles",
        )

    @property
    def coefficient_field(self) -> LawField | None:
        """Field of the wear coefficient of the law; None for a law without one."""
        return next((part for part in WEAR_LAWS[self.law].law_fields() if part.key == COEFFICIENT), None)

    @property
    def used_inputs(self) -> tuple[str, ...]:
        """Names of `LAW_INPUTS` that the chosen laws have."""
        creep = self.creep_law
        wear_keys = [part.key for part in WEAR_LAWS[self.law].law_fields()]
        creep_keys = [] if creep is None else [_CREEP_PREFIX + part.key for part in creep.law_fields()]
        return tuple(name for name in LAW_INPUTS if name in (*wear_keys, *creep_keys))

    @property
    def creep_law(self) -> type[Law] | None:
        """Chosen creep law; None without creep."""
        if self.creep == _NO_CREEP:
            return None
        return next(iter(CREEP_LAWS.values())) if self.creep == _DEFAULT_CREEP else CREEP_LAWS[self.creep]

    def law_number(self, name: str) -> float:
        """Return the value of an input of `LAW_INPUTS`."""
        return dict(self.law_numbers).get(name, LAW_INPUTS[name].example)

    def with_law_number(self, name: str, value: float) -> Use:
        """Return these settings with another value of an input of `LAW_INPUTS`."""
        return replace(self, law_numbers=tuple(sorted({**dict(self.law_numbers), name: value}.items())))

    @property
    def wear_table(self) -> dict[str, Any]:
        """Table [wear] of a file with the wear law."""
        numbers = {name: self.law_number(name) for name in self.used_inputs if name in WEAR_INPUTS}
        coefficient = {} if self.coefficient_field is None else {COEFFICIENT: self.coefficient}
        return {"law": self.law, **coefficient, **numbers}

    @property
    def creep_tables(self) -> dict[str, Any]:
        """Table [creep] of a file, in a mapping by its name; empty without creep."""
        if self.creep_law is None:
            return {}
        numbers = {name: self.law_number(name) for name in self.used_inputs if name in CREEP_INPUTS}
        law = {} if self.creep == _DEFAULT_CREEP else {"law": self.creep}
        return {"creep": {**law, **{name.removeprefix(_CREEP_PREFIX): value for name, value in numbers.items()}}}


_FURTHER_CREEP_LAWS = tuple(
    name
    for name, law in list(CREEP_LAWS.items())[1:]  # the first is the default law
    if not any(part.is_list and part.required for part in law.law_fields())
)
CHOICES: Mapping[str, tuple[str, ...]] = {
    "cycle": tuple(CYCLES),
    "contact": CONTACTS,
    "field": FIELDS,
    "law": LAWS,
    "creep": (_NO_CREEP, _DEFAULT_CREEP, *_FURTHER_CREEP_LAWS),
}
"""Names of each choice."""

DEFAULT_USE = Use()  # settings of a page without a link

_NUMBERS = {"body_weight": Kind.FORCE} | dict.fromkeys(("instant", "coefficient", "spread", "millions"), Kind.NUMBER)


def use_pairs(use: Use) -> list[tuple[str, str]]:
    """List the differences from `DEFAULT_USE` as pairs of a link."""
    plain = {name: getattr(use, name) for name in _PLAIN_FIELDS if getattr(use, name) != getattr(DEFAULT_USE, name)}
    numbers = {name: value for name, value in use.law_numbers if value != LAW_INPUTS[name].example}
    return [(f"use.{name}", str(value)) for name, value in {**plain, **numbers}.items()]


_PLAIN_FIELDS = tuple(part.name for part in fields(Use) if part.name != "law_numbers")


def use_of(pairs: Mapping[str, str]) -> Use:
    """Read settings from pairs of a link, without their prefix."""
    check_names(pairs, [*_PLAIN_FIELDS, *LAW_INPUTS], "of a hip in use in the link")
    plain = {name: text for name, text in pairs.items() if name in _PLAIN_FIELDS}
    words: dict[str, Any] = {
        name: parse(name, text, _NUMBERS[name]) if name in _NUMBERS else text for name, text in plain.items()
    }
    if "instant" in words:
        require("instant", words["instant"], words["instant"].is_integer(), "a whole number, counted from 0")
        words["instant"] = int(words["instant"])
    numbers = {name: parse(name, text, Kind.NUMBER) for name, text in pairs.items() if name in LAW_INPUTS}
    return Use(**words, law_numbers=tuple(sorted(numbers.items())))


@dataclass(frozen=True)
class UploadedCycle:
    """Cycle from an uploaded table."""

    name: str
    text: str

    def __post_init__(self) -> None:
        if Path(self.name).suffix.lower() not in _TABLES:
            raise ValueError(f"{shown(self.name)} is not a table of a cycle, which ends in {', '.join(_TABLES)}")

    @property
    def per_body_weight(self) -> bool:
        return "%BW" in self.text

    def with_units(self) -> UploadedCycle:
        """Return the table with the usual unit behind each head that has none."""
        text = _BARE_HEAD.sub(lambda head: f"{head[0]} [{_USUAL_UNITS[head[1].lower()]}]", self.text)
        return replace(self, text=text)

    def cycle(self, body_weight: float) -> Cycle:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"cycle{Path(self.name).suffix.lower()}"
            path.write_text(self.text, encoding="utf-8")
            try:
                cycle = read_cycle(path, body_weight=body_weight if self.per_body_weight else None)
            except ValueError as error:
                raise ValueError(str(error).replace(path.name, self.name)) from error
            return replace(cycle, name=self.name)


_USUAL_UNITS = {"phase": "%", "time": "s", "force": "N", "flexion": "deg", "adduction": "deg", "rotation": "deg"}
_BARE_HEAD = re.compile(rf"\b({'|'.join(_USUAL_UNITS)})(?:_[xyz])?(?=[\"'\s]*(?:[,;\t\n]|$))", re.IGNORECASE)


def sample_table(cycle: Cycle, n_lines: int = 51) -> str:
    """Write a named cycle as a table that `UploadedCycle` reads."""
    phases = numpy.linspace(0.0, 1.0, n_lines)
    forces = numpy.atleast_2d(cycle.force(phases).T)
    heads = FORCES if len(forces) == len(FORCES) else ("force",)
    columns = numpy.vstack([100 * phases, forces, numpy.degrees(cycle.angles(phases))])
    names = ", ".join(["phase [%]", *(f"{name} [N]" for name in heads), *(f"{name} [deg]" for name in ANGLES)])
    return "\n".join([names, *(", ".join(f"{value:.5g}" for value in row) for row in columns.T), ""])


def hip_of(file: JointFile, use: Use, upload: UploadedCycle | None = None) -> HipSimulation:
    """Set up the simulation of a hip: joint and cup of a file under a cycle, uploaded or named."""
    weight = use.body_weight if CYCLES[use.cycle].per_body_weight else None
    return HipSimulation(
        joint=file.joint,
        cup=file.cup,
        cycle=upload.cycle(use.body_weight) if upload is not None else named_cycle(use.cycle, body_weight=weight),
        wear=read_wear_law(use.wear_table),
        surface=socket_surface(use.contact),
        creep=parse_creep(use.creep_tables, float(file.joint.liner.poisson)),
        remarks=unused_load(replace(file, load={})),  # the page always has the size of a load
    )
