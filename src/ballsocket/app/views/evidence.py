"""Evidence: a question about the joint on the screen, gathered while one looks, as a pack to hand in."""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from html import escape
from math import prod
from operator import itemgetter
from os import PathLike
from pathlib import Path
from shutil import rmtree
from typing import Any
from weakref import finalize

from ...contact.verdict import Verdict
from ...core.checks import check_names, shown, unique
from ...core.display import counted
from ...core.kinds import Kind
from ...core.quantities import LOADS
from ...core.unit_systems import Units
from ...evidence.folder import SUMS, WORK, names_of, write
from ...evidence.matrix import limit_text, title_of, verdict_text
from ...evidence.pack import gather_evidence, plan
from ...evidence.question import LEVELS, Question, read_question
from ...files.joint_file import JointFile, JointTables
from ...files.joint_toml import Tables, tables_of
from ...files.units import parse
from ...hip.cycle_registry import CYCLES
from ...model_catalogue import reference
from ...problem.cup import Cup
from ...problem.presets import joints
from ...reports.evidence_page import conclusions, evidence_page
from ...reports.evidence_parts import case_text, value_text
from ...reports.pages import items, table
from ...studies.expressions import parse_choices, parse_limit
from ...studies.limits import Limit
from ...studies.parameters import PARAMETERS
from ..long_view import LongView, long_body
from ..pressing import pressed
from ..running import Reached, Report, Work
from ..state.screen import EvidenceQuestion, Screen, phrases_in, phrases_of
from ..state.use import Use
from ..view import Document
from ..widgets.controls import Changes, Control, changed, chosen, segments, text, tolerances_input
from ..widgets.limit_rows import limit_controls, present_value
from ..widgets.words import VERDICT_KINDS

_NO_YES = ("no", "yes")
_LIMITED = ("max_pressure", "half_angle", "edge_distance", "indentation", "area", "utilisation")
_NO_LIMIT = "Evidence needs a limit to decide on: add one, such as the largest pressure at most 20 MPa"
_HIP, _QUESTION = "hip.toml", "question.toml"
EVIDENCE_SECONDS = 600.0  # processor time of a pack in s
_WORST_CASE_STEPS = 6  # approximate steps of the worst cases


class Evidence(LongView):
    """View that gathers evidence for a question and resumes after a stop."""

    title, name, run_label, longest = "Evidence", "evidence", "Gather the evidence", EVIDENCE_SECONDS
    body = long_body("evidence", '<div id="evidence-found"></div>').replace("inputs-row", "asking")

    def begin(self) -> None:
        super().begin()
        self._folder: WorkFolder | None = None
        self.actions |= {"evidence.take": self._take, "evidence.allowable": self._limit_allowable}

    def question_of(self, screen: Screen) -> Hashable:
        use = replace(screen.use, instant=None) if screen.asked.wear == "yes" else None
        file = screen.file
        return screen.asked, _load_cases(screen.asked, file), file.joint, file.cup, file.cup.oriented, use

    def work(self, screen: Screen) -> Work:
        axes_of(screen.asked, screen.file, screen.use)  # an invalid question is refused at once
        if not screen.asked.limits.strip():
            raise ValueError(_NO_LIMIT)
        self._folder = self._folder or WorkFolder()
        return partial(gather_pack, screen.asked, screen.file, screen.use, self._folder)

    def controls(self, screen: Screen) -> list[Control]:
        def present(name: str) -> float:
            contact = pressed(screen.file, (reference.name,)).contacts.get(reference.name)
            return present_value(screen.file, name, contact)

        def limited(limits: tuple[Limit, ...]) -> Changes:
            return changed(
                screen, "asked.limits", "; ".join(phrase for limit in limits for phrase in phrases_of(limit))
            )

        return [
            text(screen, "asked.question", "Decision", 2),
            text(screen, "asked.context", "Context: what the result is for, and not for", 2),
            chosen(screen, "asked.influence", "Influence of the model on the decision", LEVELS, segments),
            chosen(screen, "asked.consequence", "Consequence of a wrong decision", LEVELS, segments),
            text(screen, "asked.accuracy", "Allowed error of the numbers"),
            *limit_controls(_LIMITED, _limits(screen.asked), screen.reading, present, limited),
            text(screen, "asked.matrix", "Cases other than the load here, such as force = 2, 3 kN"),
            tolerances_input(screen),
            text(screen, "asked.friction", "Coefficient of friction, if any"),
            chosen(screen, "asked.elements", "Check the worst cases by finite elements", _NO_YES, segments),
            chosen(screen, "asked.wear", "Include the wear of the view Wear", _NO_YES, segments),
        ]

    def show_result(self, screen: Screen, result: EvidencePack | None) -> None:
        self.put(found=_case_table(screen) if result is None else _pack_html(result, screen.reading.units))

    def _take(self, value: Any) -> None:
        screen = self.page.screen
        self.page.send_file("evidence.zip", self.result(screen).content[screen.reading.units])

    def _limit_allowable(self, value: Any) -> Changes:
        screen = self.page.screen
        pressure = screen.file.joint.liner.allowable_pressure
        if pressure is None:
            raise ValueError("the liner has no allowable pressure: enter it beside the liner")
        return changed(screen, "asked.limits", f"max_pressure <= {float(pressure):g} MPa")

    def document(self, screen: Screen) -> Document:
        pack: EvidencePack = self.result(screen)
        units = screen.reading.units
        heads, rows = _worst(pack, units)
        return Document(
            rows=lambda: [heads, *rows],
            sections=lambda: {"evidence": ("Evidence", items(conclusions(pack.record, units)) + table(heads, rows))},
        )

    def leave(self) -> None:
        super().leave()
        self._folder = None


def _limits(question: EvidenceQuestion) -> tuple[Limit, ...]:
    """Read the limits of a question; none if a link has others than limits."""
    try:
        return tuple(map(parse_limit, phrases_in(question.limits)))
    except ValueError:
        return ()


def _case_table(screen: Screen) -> str:
    """List the cases of the question before there is a result; empty for an invalid question."""
    try:
        axes = axes_of(screen.asked, screen.file, screen.use)
    except ValueError:  # the refusal of the work states it
        return ""
    number = prod(map(len, axes.values()))
    rows = [
        [PARAMETERS[name].title, ", ".join(screen.reading.with_unit(PARAMETERS[name], value) for value in values)]
        for name, values in axes.items()
    ]
    offer = "" if screen.asked.limits.strip() else _OFFER
    heads = [counted(number, "case"), "values"]
    return f"{offer}{table(heads, rows, 'text')}{_CONTENTS}"


_OFFER = "<p><button type='button' data-tell='evidence.allowable'>Use the liner's allowable pressure</button></p>"
_CONTENTS = (
    "<p class='quiet'>The pack has a page with the decision on each limit, the worst cases and their figures, all "
    "numbers as JSON, the question and checksums. It takes some seconds, with wear minutes.</p>"
)


def _pack_html(pack: EvidencePack, units: Units) -> str:
    """Return the decisions on the limits, failures first, then the other conclusions and the worst cases."""
    take = "<p><button type='button' data-tell='evidence.take'>Download the pack (ZIP)</button></p>"
    limits, decisions = pack.record["limits"], []
    verdicts = [Verdict[limit["verdict"].upper()] for limit in limits]
    for verdict, limit in sorted(zip(verdicts, limits, strict=True), key=itemgetter(0), reverse=True):
        words = f"{verdict.sign} {limit_text(limit, units)}: {verdict_text(limit)}"
        decisions.append(f"<p class='verdict {VERDICT_KINDS[verdict]}'>{escape(words)}</p>")
    others = items(conclusions(pack.record, units)[len(limits) :])
    below = ", ".join(pack.record["adequacy"]["not_met"])
    others += f"<p class='quiet'>Factors below that level: {escape(below)}</p>" if below else ""
    return f"{''.join(decisions)}{others}{table(*_worst(pack, units), kind='words')}{take}"


def _worst(pack: EvidencePack, units: Units) -> tuple[list[str], list[list[str]]]:
    worst = pack.record["worst"].items()
    rows = [[title_of(name), value_text(name, row, units), case_text(row["case"], units)] for name, row in worst]
    return ["worst", "value", "case"], rows


def write_question(inputs: EvidenceQuestion, file: JointFile, use: Use, folder: Path) -> Question:
    """Write the question file into a folder, with a hip file if wear is included, and read it again."""
    import tomli_w

    (folder / _HIP).unlink(missing_ok=True)
    tables = {_QUESTION: _tables(inputs, file)}
    if inputs.wear == "yes":
        weight = {"body_weight": use.body_weight} if CYCLES[use.cycle].per_body_weight else {}
        law = {"cycle": {"name": use.cycle}, "wear": {**use.wear_table, "contact": use.contact}, **use.creep_tables}
        tables[_HIP] = {**_joint(file), **weight, "cycles": 1e6 * use.millions, **law}
    for name, content in tables.items():
        for words in _texts(content):
            if Path(words).is_absolute() or ".." in Path(words).parts:  # a pack includes every file that is named
                raise ValueError(f"{shown(words)} is a path, and words are needed")
        (folder / name).write_text(tomli_w.dumps(content), encoding="utf-8")
    return read_question(folder / _QUESTION)


def _tables(inputs: EvidenceQuestion, file: JointFile) -> Tables:
    tables: Tables = {
        "question": inputs.question,
        "context_of_use": inputs.context,
        "finite_elements": inputs.elements == "yes",
        "risk": {"influence": inputs.influence, "consequence": inputs.consequence},
        "required": {"accuracy": inputs.accuracy, "limits": list(phrases_in(inputs.limits))},
        "matrix": unique(map(_axis, (*_load_cases(inputs, file), *phrases_in(inputs.matrix)))),
        "tolerances": unique(_halves("tolerances", phrase) for phrase in phrases_in(inputs.tolerances)),
        **_joint(file),
    }
    if inputs.friction.strip():
        tables["friction"] = {"coefficient": inputs.friction}
    if inputs.wear == "yes":
        tables["wear"] = {"file": _HIP}
    return tables


def _joint(file: JointFile) -> Tables:
    """Return the joint as the name of a preset in the default cup, otherwise as tables."""
    if file.cup == Cup() and not file.cup.oriented and joints.get(file.joint.name) == file.joint:
        return {"joint": file.joint.name}
    return {name: table for name, table in tables_of(file).items() if name in JointTables.__struct_fields__}


def _load_cases(inputs: EvidenceQuestion, file: JointFile) -> tuple[str, ...]:
    """Return the load of a file as phrases of the matrix, unless the matrix has a load."""
    named = {phrase.partition("=")[0].strip() for phrase in phrases_in(inputs.matrix)}
    return (
        () if named & set(LOADS) else tuple(f"{name} = {load!r} {LOADS[name].unit}" for name, load in file.load.items())
    )


def _halves(context: str, phrase: str) -> tuple[str, str]:
    name, sign, value = phrase.partition("=")
    if not sign:
        raise ValueError(f"{shown(phrase)} in {context} needs a name and =, such as 'clearance = 0.1 +- 0.02 mm'")
    return name.strip(), value.strip()


def _axis(phrase: str) -> tuple[str, Any]:
    """Read one axis of the matrix: a name with one number or several; angles have a unit, as bare ones are degrees."""
    listed = parse_choices(phrase)
    name, text = _halves("the matrix", phrase) if listed is None else (listed[0], "")
    check_names([name], PARAMETERS, "in the matrix")
    kind = PARAMETERS[name].kind
    values = [parse(name, text, kind)] if listed is None else listed[1]
    return name, [f"{value!r} {Kind.ANGLE.unit}" if kind is Kind.ANGLE else value for value in values]


def _texts(part: Any) -> Iterator[str]:
    for entry in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from [entry] if isinstance(entry, str) else _texts(entry)


@dataclass(frozen=True, kw_only=True, eq=False)
class EvidencePack:
    """Record of a pack, and its folder as a ZIP file by the units of its page."""

    record: dict[str, Any]
    content: Mapping[Units, bytes]


def axes_of(inputs: EvidenceQuestion, file: JointFile, use: Use) -> dict[str, tuple[float, ...]]:
    """Return the values of each axis of a question's matrix; raise ValueError if the question is invalid."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return dict(write_question(inputs, file, use, Path(folder)).axes)
        except ValueError as error:
            raise ValueError(str(error).removeprefix(f"{_QUESTION}: ")) from error


class WorkFolder:
    """Temporary folder that exists as long as a page or a run refers to it; the process of a run gets its path."""

    def __init__(self) -> None:
        self._path = Path(tempfile.mkdtemp(prefix="ballsocket-"))
        finalize(self, rmtree, self._path, ignore_errors=True)

    def __fspath__(self) -> str:
        return str(self._path)

    def __reduce__(self) -> tuple[Any, ...]:
        return Path, (self._path,)


def gather_pack(
    inputs: EvidenceQuestion, file: JointFile, use: Use, folder: PathLike[str], report: Report
) -> EvidencePack:
    """Gather evidence in a separate process, reusing the results that the folder holds."""
    path = Path(folder)
    question = write_question(inputs, file, use, path)
    pieces = _WORST_CASE_STEPS + sum(len(part) for part in plan(question).parts.values())
    finished: list[str] = []

    def heard(name: str) -> None:
        finished.append(name)
        report(Reached(share=min(0.95, len(finished) / pieces), words=f"part {len(finished)} of about {pieces}"))

    record = gather_evidence(question, path / WORK, heard)
    content = {}
    for units in Units:
        write(question, record, partial(evidence_page, units=units), path)
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as pack:
            for name in sorted({*names_of(question), SUMS}):
                pack.write(path / name, name)
        content[units] = stream.getvalue()
    return EvidencePack(record=record, content=content)
