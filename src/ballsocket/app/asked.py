"""A question that evidence is gathered for, as it is typed on the page: to and from a link, and as a question file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ..core.checks import check_names, check_text, shown
from ..core.kinds import Kind
from ..evidence.question import LEVELS, Question, read_question
from ..files.joint_file import JointFile, JointTables
from ..files.joint_toml import Tables, tables_of
from ..files.units import parse
from ..hip.cycle_registry import CYCLES
from ..problem.cup import Cup
from ..problem.presets import joints
from ..studies.expressions import parse_choices
from ..studies.parameters import PARAMETERS
from .in_use import Use

_CHOICES = {"influence": LEVELS, "consequence": LEVELS, "elements": ("no", "yes"), "wear": ("no", "yes")}
_HIP, _QUESTION = "hip.toml", "question.toml"


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What is asked, in words as they are typed; what they mean is read when the question is.

    Attributes
    ----------
    question, context : str
    influence, consequence : str
        "low", "medium" or "high".
    accuracy : str
        "10 %".
    limits, matrix, tolerances : str
        Phrases with ; between them.
    friction : str
        A coefficient; empty without.
    elements, wear : str
        "no" or "yes": whether finite elements judge, and whether the hip's wear belongs to it.
    """

    question: str = "Does this joint keep its limits?"
    context: str = "A design review before tests. Not for loosening, impingement or fracture."
    influence: str = "medium"
    consequence: str = "medium"
    accuracy: str = "10 %"
    limits: str = ""
    matrix: str = "force = 2, 3 kN"
    tolerances: str = ""
    friction: str = ""
    elements: str = "no"
    wear: str = "no"

    def __post_init__(self) -> None:
        for each in fields(self):
            check_text(each.name, getattr(self, each.name))
        for name, known in _CHOICES.items():
            check_names([getattr(self, name)], known, f"as {name}")


FIRST = Asked()
"""What a page without a link shows."""


def pairs_of(asked: Asked) -> list[tuple[str, str]]:
    """What differs from `FIRST`, as pairs of a link."""
    names = [each.name for each in fields(asked) if getattr(asked, each.name) != getattr(FIRST, each.name)]
    return [(f"ask.{name}", getattr(asked, name)) for name in names]


def asked_of(pairs: Mapping[str, str]) -> Asked:
    """What pairs of a link say, without the word before their dot."""
    check_names(pairs, [each.name for each in fields(Asked)], "of a question in the link")
    return Asked(**pairs)


def written(asked: Asked, file: JointFile, use: Use, folder: Path) -> Question:
    """The question as a file in a folder, with that of the hip where its wear is asked for; read again.

    Raises
    ------
    ValueError
        One sentence: what is wrong or missing.
    """
    import tomli_w

    (folder / _HIP).unlink(missing_ok=True)
    tables = {_QUESTION: _tables(asked, file)} | ({_HIP: _hip(file, use)} if asked.wear == "yes" else {})
    for name, content in tables.items():
        for text in _texts(content):
            _check_no_path(text)
        (folder / name).write_text(tomli_w.dumps(content), encoding="utf-8")
    return read_question(folder / _QUESTION)


def _tables(asked: Asked, file: JointFile) -> Tables:
    tables: Tables = {
        "question": asked.question,
        "context_of_use": asked.context,
        "finite_elements": asked.elements == "yes",
        "risk": {"influence": asked.influence, "consequence": asked.consequence},
        "required": {"accuracy": asked.accuracy, "limits": list(_phrases(asked.limits))},
        "matrix": dict(map(_axis, _phrases(asked.matrix))),
        "tolerances": dict(_halves("tolerances", phrase) for phrase in _phrases(asked.tolerances)),
        **_joint(file),
    }
    if asked.friction.strip():
        tables["friction"] = {"coefficient": asked.friction}
    if asked.wear == "yes":
        tables["wear"] = {"file": _HIP}
    return tables


def _hip(file: JointFile, use: Use) -> Tables:
    """The file of a hip in use: what the view of wear shows."""
    return {
        **_joint(file),
        **({"body_weight": use.body_weight} if CYCLES[use.cycle].per_body_weight else {}),
        "cycles": 1e6 * use.millions,
        "cycle": {"name": use.cycle},
        "wear": {**use.wear_table, "contact": use.contact},
        **use.creep_tables,
    }


def _joint(file: JointFile) -> Tables:
    """The joint by its name where it is a preset in no cup of its own, else by its tables."""
    if file.cup == Cup() and not file.cup.oriented and joints.get(file.joint.name) == file.joint:
        return {"joint": file.joint.name}
    return {name: table for name, table in tables_of(file).items() if name in JointTables.__struct_fields__}


def _phrases(text: str) -> Iterator[str]:
    return (phrase.strip() for phrase in text.replace("\n", ";").split(";") if phrase.strip())


def _halves(what: str, phrase: str) -> tuple[str, str]:
    name, sign, value = phrase.partition("=")
    if not sign:
        raise ValueError(f"{shown(phrase)} in {what} needs a name and =, such as 'clearance = 0.1 +- 0.02 mm'")
    return name.strip(), value.strip()


def _axis(phrase: str) -> tuple[str, Any]:
    """What a matrix varies: a name with one number or several."""
    listed = parse_choices(phrase)
    if listed is not None:
        name, values = listed
        check_names([name], PARAMETERS, "in the matrix")
        return name, [_bare(name, value) for value in values]
    name, value = _halves("the matrix", phrase)
    check_names([name], PARAMETERS, "in the matrix")
    return name, [_bare(name, parse(name, value, PARAMETERS[name].kind))]


def _bare(name: str, value: float) -> Any:
    """A number as a question file takes it: a bare angle would be degrees."""
    return f"{value!r} {Kind.ANGLE.unit}" if PARAMETERS[name].kind is Kind.ANGLE else value


def _texts(part: Any) -> Iterator[str]:
    for each in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from [each] if isinstance(each, str) else _texts(each)


def _check_no_path(text: str) -> None:
    """No file of the server's is named: a pack takes along what its question names."""
    if Path(text).is_absolute() or ".." in Path(text).parts:
        raise ValueError(f"{shown(text)} is a path, and words are needed")
