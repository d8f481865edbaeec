"""Question files: a question with its context of use, its inputs, its limits and its matrix of cases."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isclose, prod
from pathlib import Path
from typing import Any
from unicodedata import category

from ..catalogue import off_axis, reference
from ..contact import Model
from ..core.checks import check_text, nearest, require, shown
from ..core.input_files import open_input, packed_files, record_inputs, resolve_input
from ..core.quantities import QUANTITIES
from ..hip.config import read_hip
from ..io.joint_file import KEYS, JointFile, check_keys
from ..io.named_joint import PARTS, joint_in
from ..io.toml import read_toml, table_of
from ..io.units import parse
from ..studies.design import check_values, grid
from ..studies.distributions import Distribution, Rectangular
from ..studies.expressions import parse_distribution, parse_limit
from ..studies.limits import Limit
from ..studies.parameters import AIMS, LOADS, PARAMETERS, check_contradictions, nominal_value, vary_joint

LEVELS = ("low", "medium", "high")
MOST = 2000
"""Cases of a matrix."""

_ASIDE = ("tolerances", "sources", "friction", "wear")
FILE_KEYS = {
    "": ("question", "context_of_use", "finite_elements", "risk", "required", "matrix", *PARTS, *_ASIDE),
    **{name: KEYS[name] for name in PARTS},
    "risk": ("influence", "consequence"),
    "required": ("accuracy", "limits"),
    "matrix": tuple(PARAMETERS),
    "tolerances": tuple(PARAMETERS),
    "friction": ("coefficient",),
    "wear": ("file",),
}
_PERCENT = re.compile(r"\s*([\d.]+(?:[eE][-+]?\d+)?)\s*%\s*")


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
        Values of the vary_joint parameters, in mm, N, MPa, rad; one of them is a load.
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
    path : Path
        The question file.
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
    path: Path
    files: tuple[Path, ...]

    @property
    def model(self) -> Model:
        """Model of the matrix: `Exact`, or the off-axis solver for tilted loads or cups."""
        chosen = off_axis if any(name in AIMS for name in self.axes) else reference
        return chosen.in_cup(self.file.cup)


def read_question(path: str | Path) -> Question:
    """Read a question file.

    At the top: `question` and `context_of_use` in words; a joint as in study files; `finite_elements` (true or false,
    the default). Tables: `risk` with `influence` and `consequence`, each "low", "medium" or "high"; `required` with
    `accuracy` ("10 %") and `limits` (a list, as "max_pressure <= 20 MPa"); `matrix`, with a number or a list for each
    parameter of a study, a load among them; `tolerances`, as `clearance = "0.1 +- 0.05 mm"`; `sources`, a text for
    inputs by name; `friction` with a `coefficient`; `wear` with the `file` of a hip in use. Numbers are text with a
    unit or bare in mm, N, MPa, degrees. Paths are taken from the file's own folder.

    Raises
    ------
    ValueError
        One sentence: what is wrong or missing.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    with record_inputs() as opened:
        question = read_toml(path, "question", lambda content: _question(content, path))
    files = packed_files(path, opened)
    for file in files:
        _check_visible(file)
    return replace(question, files=files)


def _question(content: Mapping[str, Any], path: Path) -> Question:
    check_keys(content, "", "at the top", FILE_KEYS)
    parts = {name: table_of(content, name) for name in ("risk", "required", "matrix", "tolerances", "friction", "wear")}
    for name, part in parts.items():
        check_keys(part, name, f"in [{name}]", FILE_KEYS)
    axes = {name: _several(name, value) for name, value in parts["matrix"].items()}
    _check_axes(axes)
    tolerances, given = _tolerances(parts["tolerances"]), joint_in(content, path.parent)
    file, recentred = _recentred(given, tolerances, axes)
    elements = content.get("finite_elements", False)
    if not isinstance(elements, bool):
        raise ValueError(f"finite_elements = {shown(elements)} must be true or false")
    return Question(
        text=_words(content, "question", "what is to be decided, in a sentence"),
        context=_words(content, "context_of_use", "what the answer is used for, and for what not"),
        influence=_level(parts["risk"], "influence", "of the model on the decision"),
        consequence=_level(parts["risk"], "consequence", "of a wrong decision"),
        accuracy=_accuracy(parts["required"]),
        file=file,
        axes=axes,
        limits=_limits(parts["required"].get("limits", [])),
        tolerances=tolerances,
        recentred=recentred,
        sources=_sources(table_of(content, "sources")),
        friction=_friction(parts["friction"]),
        hip=_hip(parts["wear"], path.parent),
        finite_elements=elements,
        path=path,
        files=(path,),
    )


def _words(content: Mapping[str, Any], name: str, meaning: str) -> str:
    if name not in content:
        raise ValueError(f"{name} is missing: {meaning}")
    if not check_text(name, content[name]).strip():
        raise ValueError(f"{name} is empty: {meaning}")
    return str(content[name])


def _level(part: Mapping[str, Any], name: str, meaning: str) -> str:
    if name not in part:
        raise ValueError(f"[risk] {name} is missing: that {meaning}, {', '.join(LEVELS)}")
    if part[name] not in LEVELS:
        raise ValueError(f"{name} = {shown(part[name])} is not known{nearest(part[name], LEVELS)}")
    return str(part[name])


def _accuracy(part: Mapping[str, Any]) -> float:
    if "accuracy" not in part:
        raise ValueError('[required] accuracy is missing: how far off the numbers may be, such as "10 %"')
    given = part["accuracy"]
    percent = _PERCENT.fullmatch(given) if isinstance(given, str) and len(given) < 40 else None
    share = float(percent[1]) / 100 if percent else parse("accuracy", given, "number")
    require("accuracy", share, 0 < share <= 1, "above 0, at most 100 %")
    return share


def _several(name: str, value: Any) -> tuple[float, ...]:
    listed = value if isinstance(value, list) else [value]
    if not listed:
        raise ValueError(f"[matrix] {name} is an empty list")
    values = tuple(parse(f"{name}[{place}]", each, PARAMETERS[name].kind) for place, each in enumerate(listed))
    twice = [each for place, each in enumerate(listed) if values[place] in values[:place]]
    if twice:
        raise ValueError(f"[matrix] {name} has {shown(twice[0])} twice")
    return values


def _check_axes(axes: Mapping[str, tuple[float, ...]]) -> None:
    check_contradictions(axes)
    if not any(name in axes for name in LOADS):
        raise ValueError(f"[matrix] needs a load: {', '.join(LOADS)}")
    count = prod(map(len, axes.values()))
    require("cases of the matrix", count, count <= MOST, f"at most {MOST}; a study takes more")
    check_values(grid(**{name: list(values) for name, values in axes.items()}))


def _limits(given: Any) -> tuple[Limit, ...]:
    if not (isinstance(given, list) and all(isinstance(each, str) for each in given)):
        raise ValueError(f"limits = {shown(given)} must be a list of texts, such as 'max_pressure <= 20 MPa'")
    return tuple(map(parse_limit, given))


def _tolerances(part: Mapping[str, Any]) -> Mapping[str, Distribution]:
    """Read the distributions of uncertain inputs; their ends must be possible joints and loads along the axis."""
    spreads = dict(_scatter(name, value) for name, value in part.items())
    for name, spread in spreads.items():
        if name in AIMS:
            raise ValueError(f"{name} in [tolerances] cannot scatter: tolerances are followed along the axis")
        ends = [float(spread.frozen.ppf(share)) for share in ALMOST_ALL]
        try:
            check_values(grid(**{name: ends}))
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
    if path.suffix != ".toml":
        return
    with open_input(path) as stream:
        text = stream.read().decode("utf-8-sig")
    for number, line in enumerate(text.splitlines(), 1):
        for character in line:
            if category(character) == "Cf" and character not in _JOINERS:
                raise ValueError(f"{path.name} has the invisible character U+{ord(character):04X} in line {number}")


_JOINERS = "\u200c\u200d"
"""Invisible characters that some scripts need between letters."""

ALMOST_ALL = (0.001, 0.999)
"""Quantiles that count as the ends of a distribution."""


def _scatter(name: str, value: Any) -> tuple[str, Distribution]:
    return parse_distribution(f"{name} = {check_text(name, value)}")


def _sources(part: Mapping[str, Any]) -> Mapping[str, str]:
    for name in part:
        if name not in QUANTITIES and name not in PARTS and name not in LOADS:
            raise ValueError(f"{shown(name)} in [sources] is not known{nearest(name, (*QUANTITIES, *PARTS))}")
    return {name: check_text(name, text) for name, text in part.items()}


def _friction(part: Mapping[str, Any]) -> float | None:
    if "coefficient" not in part:
        return None
    coefficient = parse("coefficient", part["coefficient"], "number")
    require("coefficient", coefficient, 0 <= coefficient <= 2, "a coefficient of friction is 0 to 2")
    return coefficient


def _hip(part: Mapping[str, Any], folder: Path) -> Path | None:
    if "file" not in part:
        return None
    path = folder / check_text("file", part["file"])
    if not resolve_input(path).is_file():
        raise ValueError(f"[wear] file = {shown(part['file'])} is not there")
    read_hip(path)
    return path
