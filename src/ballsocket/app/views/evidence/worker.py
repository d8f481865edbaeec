"""Evidence pack for a question as typed on the page, gathered in a separate process."""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ....core.checks import check_names, shown
from ....core.kinds import Kind
from ....evidence.folder import SUMS, WORK, names_of, write
from ....evidence.pack import gather_evidence, plan
from ....evidence.question import Question, read_question
from ....files.joint_file import JointFile, JointTables
from ....files.joint_toml import Tables, tables_of
from ....files.units import parse
from ....hip.cycle_registry import CYCLES
from ....problem.cup import Cup
from ....problem.presets import joints
from ....reports.evidence_page import conclusions, evidence_page
from ....studies.expressions import parse_choices
from ....studies.parameters import PARAMETERS
from ...running import Reached, Report
from ...state.evidence_question import EvidenceQuestion
from ...state.use import Use

_HIP, _QUESTION = "hip.toml", "question.toml"
EVIDENCE_SECONDS = 600.0  # seconds that a pack may take
_WORST_CASE_STEPS = 6  # approximate steps of the worst cases


def write_question(inputs: EvidenceQuestion, file: JointFile, use: Use, folder: Path) -> Question:
    """Write the question file into a folder, with a hip file if wear is included, and read it again."""
    import tomli_w

    (folder / _HIP).unlink(missing_ok=True)
    tables = {_QUESTION: _tables(inputs, file)} | ({_HIP: _hip(file, use)} if inputs.wear == "yes" else {})
    for name, content in tables.items():
        for text in _texts(content):
            if Path(text).is_absolute() or ".." in Path(text).parts:  # a pack includes every file that is named
                raise ValueError(f"{shown(text)} is a path, and words are needed")
        (folder / name).write_text(tomli_w.dumps(content), encoding="utf-8")
    return read_question(folder / _QUESTION)


def _tables(inputs: EvidenceQuestion, file: JointFile) -> Tables:
    tables: Tables = {
        "question": inputs.question,
        "context_of_use": inputs.context,
        "finite_elements": inputs.elements == "yes",
        "risk": {"influence": inputs.influence, "consequence": inputs.consequence},
        "required": {"accuracy": inputs.accuracy, "limits": list(phrases_in(inputs.limits))},
        "matrix": dict(map(_axis, phrases_in(inputs.matrix))),
        "tolerances": dict(_halves("tolerances", phrase) for phrase in phrases_in(inputs.tolerances)),
        **_joint(file),
    }
    if inputs.friction.strip():
        tables["friction"] = {"coefficient": inputs.friction}
    if inputs.wear == "yes":
        tables["wear"] = {"file": _HIP}
    return tables


def _hip(file: JointFile, use: Use) -> Tables:
    return {
        **_joint(file),
        **({"body_weight": use.body_weight} if CYCLES[use.cycle].per_body_weight else {}),
        "cycles": 1e6 * use.millions,
        "cycle": {"name": use.cycle},
        "wear": {**use.wear_table, "contact": use.contact},
        **use.creep_tables,
    }


def _joint(file: JointFile) -> Tables:
    """Return the joint as the name of a preset in the default cup, otherwise as tables."""
    if file.cup == Cup() and not file.cup.oriented and joints.get(file.joint.name) == file.joint:
        return {"joint": file.joint.name}
    return {name: table for name, table in tables_of(file).items() if name in JointTables.__struct_fields__}


def phrases_in(text: str) -> Iterator[str]:
    """Yield the phrases of a text, which semicolons or line ends separate."""
    return (phrase.strip() for phrase in text.replace("\n", ";").split(";") if phrase.strip())


def _halves(context: str, phrase: str) -> tuple[str, str]:
    name, sign, value = phrase.partition("=")
    if not sign:
        raise ValueError(f"{shown(phrase)} in {context} needs a name and =, such as 'clearance = 0.1 +- 0.02 mm'")
    return name.strip(), value.strip()


def _axis(phrase: str) -> tuple[str, Any]:
    """Read one axis of the matrix: a name with one number or several."""
    listed = parse_choices(phrase)
    if listed is not None:
        name, values = listed
        check_names([name], PARAMETERS, "in the matrix")
        return name, [_bare(name, value) for value in values]
    name, value = _halves("the matrix", phrase)
    check_names([name], PARAMETERS, "in the matrix")
    return name, [_bare(name, parse(name, value, PARAMETERS[name].kind))]


def _bare(name: str, value: float) -> Any:
    """Write a number for a question file; angles carry a unit because a bare angle means degrees."""
    return f"{value!r} {Kind.ANGLE.unit}" if PARAMETERS[name].kind is Kind.ANGLE else value


def _texts(part: Any) -> Iterator[str]:
    for entry in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from [entry] if isinstance(entry, str) else _texts(entry)


@dataclass(frozen=True, kw_only=True, eq=False)
class EvidencePack:
    """Conclusions in sentences, the record, and the folder as a ZIP file."""

    conclusions: tuple[str, ...]
    record: dict[str, Any]
    content: bytes


def axes_of(inputs: EvidenceQuestion, file: JointFile, use: Use) -> dict[str, tuple[float, ...]]:
    """Return the values of each axis of a question's matrix; raise ValueError if the question is invalid."""
    with tempfile.TemporaryDirectory() as folder:
        return dict(write_question(inputs, file, use, Path(folder)).axes)


def gather_pack(inputs: EvidenceQuestion, file: JointFile, use: Use, folder: str, report: Report) -> EvidencePack:
    """Gather evidence in a separate process, reusing the results that the folder holds."""
    path = Path(folder)
    question = write_question(inputs, file, use, path)
    pieces = _WORST_CASE_STEPS + sum(len(part) for part in plan(question).parts.values())
    finished: list[str] = []

    def heard(name: str) -> None:
        finished.append(name)
        report(Reached(share=min(0.95, len(finished) / pieces), words=f"done: {name}"))

    record = gather_evidence(question, path / WORK, heard)
    write(question, record, evidence_page, path)
    return EvidencePack(
        conclusions=tuple(conclusions(record)), record=record, content=_zipped(path, names_of(question))
    )


def _zipped(folder: Path, names: Sequence[str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as pack:
        for name in sorted({*names, SUMS}):
            pack.write(folder / name, name)
    return stream.getvalue()
