"""Question files: a question with its context of use, its inputs, its limits and its matrix of cases."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isclose, prod
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self
from unicodedata import category

from ..contact import Model
from ..core.checks import check_filled, check_names, number_of_percent, require, shown
from ..core.input_files import open_input, packed_files, record_inputs, resolve_input
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES
from ..files.joint_file import JointFile, JointTables, joint_in
from ..files.schema import (
    QUANTITIES_SCHEMA,
    QUANTITY_SCHEMA,
    FileTable,
    Parsed,
    PlainNumber,
    Text,
    Value,
    Word,
    meaning,
    quantity_keys,
    with_keys,
)
from ..files.tables import parsed_values, read_table
from ..files.toml import read_toml
from ..files.units import parse
from ..hip.config import read_hip
from ..model_catalogue import OFF_AXIS, named_models, reference, with_gap
from ..studies.design import grid
from ..studies.distributions import Distribution, Rectangular
from ..studies.expressions import parse_distribution, parse_limit
from ..studies.file import ModelGap
from ..studies.limits import Limit
from ..studies.parameters import AIMS, LOADS, PARAMETERS, check_contradictions, nominal_value, vary_joint

LEVELS = ("low", "medium", "high")
MOST = 2000  # cases of a matrix


class MatrixValues(Parsed):
    """Number, or list of different numbers."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITIES_SCHEMA

    @classmethod
    def parse(cls, name: str, value: Any) -> tuple[float, ...]:
        """Convert a number or a list of numbers."""
        numbers = value if isinstance(value, list) else [value]
        if not numbers:
            raise ValueError(f"[matrix] {name} is an empty list")
        values = tuple(parse(f"{name}[{i}]", number, cls.kind) for i, number in enumerate(numbers))
        twice = [number for i, number in enumerate(numbers) if values[i] in values[:i]]
        if twice:
            raise ValueError(f"[matrix] {name} has {shown(twice[0])} twice")
        return values


class Share(Value, float):
    """Share, such as '10 %' or 0.1."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a share above 0, at most 1."""
        percent = number_of_percent(value)
        share = parse(name, value if percent is None else percent, Kind.NUMBER) / (1 if percent is None else 100)
        require(name, share, 0 < share <= 1, "above 0, at most 100 %")
        return cls(share)


class Level(Word):
    """Level of a risk."""

    choices = LEVELS


class RiskTable(FileTable, frozen=True, kw_only=True):
    """Risk of a wrong decision."""

    influence: Annotated[Level, meaning("influence of the model on the decision")]
    consequence: Annotated[Level, meaning("consequence of a wrong decision")]


class RequiredTable(FileTable, frozen=True, kw_only=True):
    """Requirements on the numbers."""

    accuracy: Annotated[Share, meaning('largest relative error of the numbers, such as "10 %"')]
    limits: Annotated[list[Text] | None, meaning("limits, such as 'max_pressure <= 20 MPa'")] = None


class FrictionTable(FileTable, frozen=True, kw_only=True):
    """Friction of the joint."""

    coefficient: Annotated[PlainNumber | None, meaning("coefficient of friction, 0 to 2")] = None


class WearFileTable(FileTable, frozen=True, kw_only=True):
    """Wear of the joint."""

    file: Annotated[Text | None, meaning("hip file whose wear belongs to the evidence")] = None


@with_keys(quantity_keys(PARAMETERS, MatrixValues))
class MatrixTable(FileTable, frozen=True, kw_only=True):
    """Values of the matrix of cases, by parameter."""


@with_keys(quantity_keys(PARAMETERS, Text))
class TolerancesTable(FileTable, frozen=True, kw_only=True):
    """Tolerances or ranges of inputs, such as '0.1 +- 0.05 mm' or '0.40 .. 0.45', by parameter."""


_QUESTION = "decision that the evidence is for, in a sentence"
_CONTEXT = "use of the answer, and what it is not used for"


class QuestionTable(JointTables, frozen=True, kw_only=True):
    """Question file."""

    question: Annotated[Text, meaning(_QUESTION)]
    context_of_use: Annotated[Text, meaning(_CONTEXT)]
    finite_elements: Annotated[bool, meaning("check of the worst cases with finite elements")] = False
    gap: ModelGap = None
    risk: Annotated[RiskTable, meaning("risk of a wrong decision")]
    required: Annotated[RequiredTable, meaning("requirements on the numbers")]
    matrix: MatrixTable | None = None
    tolerances: TolerancesTable | None = None
    sources: Annotated[dict[str, Text] | None, meaning("sources of inputs, by name")] = None
    friction: FrictionTable = FrictionTable()
    wear: WearFileTable = WearFileTable()


@dataclass(frozen=True)
class Recentred:
    """Input whose nominal value is taken from its tolerance instead of the joint's file or preset."""

    name: str
    stated: float
    used: float

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON, with the units of files."""
        factor = PARAMETERS[self.name].written.factor
        return {"name": self.name, "stated": self.stated * factor, "used": self.used * factor}


@dataclass(frozen=True, kw_only=True, eq=False)
class Question:
    """Question of a file: its joint, matrix of cases, limits, tolerances and required accuracy.

    Attributes
    ----------
    text, context : str
        The question and its context of use, in words.
    influence, consequence : str
        Influence of the model on the decision, and consequence of a wrong decision: "low", "medium" or "high".
    accuracy : float
        Largest allowed relative error of the numbers.
    file : JointFile
        The nominal joint, and its cup.
    axes : mapping of str to tuple of float
        Values of the varied parameters, in mm, N, MPa, rad; one of them is a load.
    limits : tuple of Limit
        Limits of the numbers.
    tolerances : mapping of str to Distribution
        Distributions of uncertain inputs.
    recentred : tuple of Recentred
        Inputs whose tolerance states another nominal value than the joint's file or preset.
    sources : mapping of str to str
        Sources of inputs, by name.
    friction : float, optional
        Coefficient of friction.
    hip : Path, optional
        File of a hip simulation, whose wear belongs to the evidence.
    finite_elements : bool
        True for a check of the worst cases by finite elements.
    gap : str, optional
        Gap of all models that have a choice, "linear" or "circular".
    path : Path
        The file.
    files : tuple of Path
        The question file and the files that it names, which belong to the pack.
    """

    text: str
    context: str
    influence: str
    consequence: str
    accuracy: float
    file: JointFile
    axes: Mapping[str, tuple[float, ...]]
    limits: tuple[Limit, ...]
    tolerances: Mapping[str, Distribution]
    recentred: tuple[Recentred, ...]
    sources: Mapping[str, str]
    friction: float | None
    hip: Path | None
    finite_elements: bool
    gap: str | None
    path: Path
    files: tuple[Path, ...]

    @property
    def model(self) -> Model:
        """Model of the matrix: `Exact`, or the off-axis solver for tilted loads or cups."""
        chosen = named_models[OFF_AXIS] if any(name in AIMS for name in self.axes) else reference
        return with_gap(chosen, self.gap).in_cup(self.file.cup)


def read_question(path: str | Path) -> Question:
    """Read a question file.

    The joint is described as in joint files, or named. The page "Keys of files" of the reference lists all tables and
    keys. Paths are relative to the folder of the file.

    Raises ValueError: one sentence: what is wrong or missing.
    Raises OSError: a file cannot be read.
    """
    path = Path(path)
    with record_inputs() as opened:
        question = read_toml(path, "question", lambda content: _question(content, path))
    files = packed_files(path, opened)
    for file in files:
        if file.suffix == ".toml":
            _check_visible(file)
    return replace(question, files=files)


def _question(content: Mapping[str, Any], path: Path) -> Question:
    tables = read_table(content, QuestionTable)
    axes = parsed_values(tables.matrix, content.get("matrix", {}))
    check_contradictions(axes)
    if not any(name in axes for name in LOADS):
        raise ValueError(f"[matrix] needs a load: {', '.join(LOADS)}")
    count = prod(map(len, axes.values()))
    require("cases of the matrix", count, count <= MOST, f"at most {MOST}; a study takes more")
    grid(**{name: list(values) for name, values in axes.items()})  # refuses values outside their ranges
    tolerances = _tolerances({name: str(getattr(tables.tolerances, name)) for name in content.get("tolerances", {})})
    file, recentred = _recentred(joint_in(tables, path.parent), tolerances, axes)
    if file.aim and not any(name in AIMS for name in axes):
        raise ValueError(
            f"the joint file has a {next(iter(file.aim))} of the load, and [matrix] loads the cup upwards: add tilt to "
            "[matrix], or remove it from the joint file and turn the cup by its inclination"
        )
    sources, friction = tables.sources or {}, tables.friction.coefficient
    check_names(sources, (*QUANTITIES, *JointTables.__struct_fields__), "in [sources]")
    if friction is not None:
        require("coefficient", float(friction), 0 <= float(friction) <= 2, "a coefficient of friction is 0 to 2")
    hip = None if tables.wear.file is None else path.parent / tables.wear.file
    if hip is not None:
        if not resolve_input(hip).is_file():
            raise ValueError(f"[wear] file = {shown(str(tables.wear.file))} is not there")
        read_hip(hip)
    return Question(
        text=check_filled("question", tables.question, _QUESTION),
        context=check_filled("context_of_use", tables.context_of_use, _CONTEXT),
        influence=str(tables.risk.influence),
        consequence=str(tables.risk.consequence),
        accuracy=float(tables.required.accuracy),
        file=file,
        axes=axes,
        limits=tuple(map(parse_limit, tables.required.limits or ())),
        tolerances=tolerances,
        recentred=recentred,
        sources={name: str(text) for name, text in sources.items()},
        friction=None if friction is None else float(friction),
        hip=hip,
        finite_elements=tables.finite_elements,
        gap=tables.gap,
        path=path,
        files=(path,),
    )


def _tolerances(texts: Mapping[str, str]) -> Mapping[str, Distribution]:
    """Read the distributions of uncertain inputs; their ends must be possible joints and loads along the axis."""
    spreads = dict(parse_distribution(f"{name} = {text}") for name, text in texts.items())
    for name, spread in spreads.items():
        if name in AIMS:
            raise ValueError(f"{name} in [tolerances] cannot scatter: tolerances are followed along the axis")
        ends = [float(spread.frozen.ppf(share)) for share in ALMOST_ALL]
        try:
            grid(**{name: ends})
        except ValueError as error:
            raise ValueError(f"[tolerances] reaches too far: {error}") from error
    return spreads


def _recentred(
    file: JointFile, tolerances: Mapping[str, Distribution], axes: Mapping[str, Any]
) -> tuple[JointFile, tuple[Recentred, ...]]:
    """Set each input that the matrix does not vary to the nominal value of its tolerance.

    700 +- 100 states 700. A range such as 0.40 .. 0.45 states none: the joint's value is used, or the middle of the
    range where that value lies outside.
    """
    recentred = []
    for name, spread in tolerances.items():
        stated = None if name in axes or name in LOADS else nominal_value(file.joint, name)
        used = float(spread.frozen.median())
        inside = isinstance(spread, Rectangular) and stated is not None and spread.low <= stated <= spread.high
        if stated is not None and not inside and not isclose(stated, used, rel_tol=1e-9):
            recentred.append(Recentred(name, stated, used))
    joint, _ = vary_joint(file.joint, {entry.name: entry.used for entry in recentred})
    return replace(file, joint=joint), tuple(recentred)


def _check_visible(path: Path) -> None:
    """Raise ValueError for an invisible character, which can change the text of a page."""
    joiners = "\u200c\u200d"  # which some scripts need between letters
    with open_input(path) as stream:
        text = stream.read().decode("utf-8-sig")
    for number, line in enumerate(text.splitlines(), 1):
        for character in line:
            if category(character) == "Cf" and character not in joiners:
                raise ValueError(f"{path.name} has the invisible character U+{ord(character):04X} in line {number}")


ALMOST_ALL = (0.001, 0.999)  # quantiles that count as the ends of a distribution
