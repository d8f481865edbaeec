"""Parts of the pages that are made from the package itself, written by each build as Markdown that pages include.

Results and report of the paper are computed once for each version of the code; everything else takes a few seconds.
"""

import re
from contextlib import contextmanager
from os import environ
from pathlib import Path

import ballsocket as bs
from ballsocket.core.quantities import CONTACT, QUANTITIES
from ballsocket.core.sources import Source, bibliography
from ballsocket.core.storage.pieces import fingerprint
from ballsocket.evidence.comparators import PUBLISHED, range_text
from ballsocket.evidence.validity import measure, models_with_promise
from ballsocket.files.inputs import Input, inputs_of
from ballsocket.files.refusals import values_of
from ballsocket.mcp.tools import FILE_TABLES, file_table
from ballsocket.model_catalogue import listed_models
from ballsocket.paper.claims import SCALE
from ballsocket.paper.plan import quick_plan
from ballsocket.reports.accuracy_results import markdown
from ballsocket.reports.paper_report import write_report

_COLUMNS = 88  # of the terminal whose help texts are shown


def setup(app):
    app.connect("config-inited", lambda app, config: write(Path(app.confdir) / "_generated"), priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def write(folder: Path) -> None:
    """All of it."""
    report = folder / "report"
    report.mkdir(parents=True, exist_ok=True)
    results = quick_plan().results(folder / "paper")
    _write_report(results, report, folder / "report.code")
    pages = {
        "bibliography": _bibliography(),
        "catalogue": "\n".join(map(_model, listed_models.values())),
        "accuracy": markdown(results["accuracy"][0]),
        "claims": f"{SCALE}\n\n{_claims(results['claims'])}",
        "elsewhere": _claims(results["elsewhere"]),
        "commands": _commands(),
        "comparators": "\n".join(_comparator(make()) for make in PUBLISHED.values()),
        "file_keys": "\n".join(_file_keys(kind) for kind in FILE_TABLES),
        "glossary": _glossary(QUANTITIES.values()),
        "hertz": hertz_map(),
        "joints": _presets(bs.joints),
        "materials": _presets(bs.materials, lambda name: f"`{name}`, in Python `{name.replace('-', '_').upper()}`"),
        "nearness": _nearness(),
        "statuses": _statuses(),
        "validity": _validity(),
    }
    for name, text in pages.items():
        (folder / f"{name}.md").write_text(text + "\n", encoding="utf-8")


def _write_report(results, report: Path, stamp: Path) -> None:
    """Write the report of the paper with its pictures, unless it is there from the same code."""
    code = fingerprint()
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == code:
        return
    write_report(results, report)
    stamp.write_text(code, encoding="utf-8")


def _table(heads, rows) -> str:
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace("|", r"\|") for cell in line) + " |" for line in lines)


def _linked(text: str) -> str:
    """Text with its DOIs as links."""
    return re.sub(r"doi (10\.[^\s,;)]+)", r"[doi \1](https://doi.org/\1)", text)


# --- models ---


def _model(model) -> str:
    where = [f"- {limit}: {limit.why}" for limit in model.validity]
    formula = [f"- {_open(limit)}: {limit.why}" for limit in getattr(model, "domain", ())]
    cited = "; ".join(f"[{source}](#ref-{source.key})" for source in dict.fromkeys(model.sources))
    title = model.title[0].upper() + model.title[1:] + "."
    promised = "" if model.promise is None else f" ({model.promise})"
    parts = [f"(model-{model.name})=\n## `{model.name}`", title, f"**Valid for**{promised}", "\n".join(where)]
    if formula:
        parts += ["**Solution exists for**", "\n".join(formula)]
    return "\n\n".join([*parts, f"**From** {cited}"]) + "\n"


def _open(limit) -> str:
    return str(limit).replace("≥", ">").replace("≤", "<")


_JOINTS = ("hess-forsbach", "hip-28", "hip-36", "reverse-shoulder-42", "suspension-ball-joint", "tilting-pad-pivot")


def _nearness() -> str:
    """Peak pressure at 3 kN against the exact answer; bold where the model trusts itself."""
    answers = [bs.compare(bs.joints[name], force=3000.0) for name in _JOINTS]
    rows = [[f"[`{name}`](#model-{name})", *(_off(one, name) for one in answers)] for name in bs.catalogue]
    rows[0] = [rows[0][0], *(f"{one['exact'].max_pressure:.4g}\u202fMPa" for one in answers)]
    widths = [f"{_degrees(one['exact'].half_angle)}°" for one in answers]
    return _table(["", *_JOINTS], [["half angle ε", *widths], *rows])


_PIVOT_CLEARANCES, _PIVOT_FORCES = (0.004, 0.01, 0.03, 0.1), (100.0, 1000.0, 10_000.0)


def hertz_map() -> str:
    """Errors of Hertz on the pivot preset against the exact answer, over clearance and force; bold where valid."""
    heads = ["c/R1", *(f"{force / 1000:g}\u202fkN" for force in _PIVOT_FORCES)]
    return _table(
        heads, [[ratio, *(_hertz_errors(ratio, force) for force in _PIVOT_FORCES)] for ratio in _PIVOT_CLEARANCES]
    )


def _hertz_errors(ratio: float, force: float) -> str:
    pivot = bs.joints["tilting-pad-pivot"]
    joint = pivot.replace(clearance=ratio * pivot.ball_radius)
    exact, hertz = (model.press(joint, force=force) for model in (bs.Exact(gap=bs.CircularGap), bs.Hertz()))
    names = ("indentation", "max_pressure", "stiffness")
    text = " / ".join(f"{100 * (getattr(hertz, name) / getattr(exact, name) - 1):+.0f}" for name in names)
    return f"**{text}**" if hertz.valid else text


def _degrees(angle: float) -> int:
    return round(angle * 57.29577951308232)


def _off(answers, name: str) -> str:
    if name not in answers or answers[name].status.failed:
        return "no solution"
    contact = answers[name]
    percent = 100 * (contact.max_pressure / answers["exact"].max_pressure - 1)
    text = f"{percent:+.{1 if abs(percent) < 10 else 0}f}\u202f%"
    return f"**{text}**" if contact.valid else text


# --- quantities ---


def _glossary(quantities) -> str:
    """The words of the table of quantities as a Sphinx glossary."""
    entries = sorted(quantities, key=lambda each: each.title.casefold())
    return "\n".join(["```{glossary}", "\n\n".join(map(_word, entries)), "```"])


def _word(quantity) -> str:
    """Title, then name, symbol, units, meaning and what is allowed."""
    inside = quantity.unit.replace("mm2", "mm²").removeprefix("1")
    read = [text for text in dict.fromkeys((quantity.written.text, quantity.shown.text)) if text not in ("", inside)]
    names = ", ".join(f"`{text}`" for text in (quantity.name, quantity.symbol) if text)
    units = (f" in {inside}" if inside else "") + (f", shown in {' and '.join(read)}" if read else "")
    rule = f" {quantity.allowed[0].upper()}{quantity.allowed[1:]}." if quantity.allowed else ""
    return f"{quantity.title}\n  {names}{units}. {quantity.meaning}{rule}"


# --- files ---

_TITLES = {
    "joint": "Joint files",
    "hip": "Hip files",
    "study": "Study files",
    "identify": "Identification files",
    "evidence": "Question files",
}


def _file_keys(kind: str) -> str:
    """Return the keys of a kind of file, table by table; tables that joint files have too are left out of others."""
    keys = inputs_of(file_table(kind))
    joint = [] if kind == "joint" else inputs_of(file_table("joint"))
    heads = [
        head for head in dict.fromkeys(key.table for key in keys) if not head or _of(keys, head) != _of(joint, head)
    ]
    parts = [f"## {_TITLES[kind]}", *(_key_table(head, _of(keys, head)) for head in heads)]
    shared = [f"`{head}`" for head in dict.fromkeys(key.table for key in keys) if head not in heads]
    return "\n\n".join([*parts, *([f"As in joint files: {', '.join(shared)}."] if shared else [])]) + "\n"


def _of(keys: tuple[Input, ...], head: str) -> tuple[Input, ...]:
    """Return the keys of one table."""
    return [key for key in keys if key.table == head]


def _key_table(head: str, keys: tuple[Input, ...]) -> str:
    """Return the keys of one table with their values, defaults and meanings."""
    rows = [(f"`{key.key}`", values_of(key), f"`{key.default}`" if key.default else "", key.meaning) for key in keys]
    return f"### {f'`{head}`' if head else 'At the top'}\n\n{_table(('key', 'value', 'default', 'meaning'), rows)}"


# --- presets, statuses, publications ---


def _presets(presets, called="`{}`".format) -> str:
    rows = [(called(name), str(one).removeprefix(f"{name}: "), _linked(one.source)) for name, one in presets.items()]
    return _table(("name", "numbers", "source"), rows)


def _validity() -> str:
    """How the models keep what they promise."""
    sizes = {"plane-layer": 300, "cosine-limit": 60_000}
    found = [measure(model, size=sizes.get(model.name, 10_000), seed=2) for model in models_with_promise()]
    rows = [
        [
            f"[`{each.model}`](#model-{each.model})",
            each.promise,
            each.valid,
            f"{100 * each.kept_share:.1f} %",
            ", ".join(f"{CONTACT[name].symbol} {100 * error:.2g} %" for name, error in each.worst.items()),
        ]
        for each in found
    ]
    return _table(("model", "promise", "valid points", "within the promise", "worst"), rows)


def _statuses() -> str:
    rows = [
        (f"`{status.name}`", int(status), status.sentence, "missing (NaN)" if status.failed else "available")
        for status in bs.Status
    ]
    return _table(("status", "code", "meaning", "numbers"), rows)


_ACCENTS = {r"{\ss}": "ß", r"{\"u}": "ü", r"{\"o}": "ö", r"{\'e}": "é", r"\&": "&", "--": "–"}


def _bibliography() -> str:
    entries = {key: _fields(text) for key, text in bibliography().items()}
    ordered = sorted(entries, key=lambda key: (Source(key).authors_and_year.casefold(), key))
    return "\n\n".join(f"(ref-{key})=\n{_entry(entries[key])}" for key in ordered)


def _fields(entry: str) -> dict[str, str]:
    for latex, letter in _ACCENTS.items():
        entry = entry.replace(latex, letter)
    entry = re.sub(r"\{\{(.*)\}\}", lambda whole: "{" + whole[1].replace(" and ", " & ") + "}", entry)  # one author
    fields = re.findall(r"^\s*(\w+)\s*=\s*\{(.*)\},?\s*$", entry, flags=re.MULTILINE)
    return {name: re.sub("[{}]", "", value) for name, value in fields}


def _entry(fields: dict[str, str]) -> str:
    people = (fields.get("author") or fields["editor"] + " (ed.)").replace(" and ", "; ")
    printed = [fields[name] for name in ("journal", "publisher", "school", "howpublished") if name in fields]
    place = " ".join(filter(None, [*printed, fields.get("volume"), fields.get("number") and f"({fields['number']})"]))
    parts = [f"**{people} {fields['year']}.** *{fields['title']}*", place, fields.get("pages"), fields.get("note")]
    if "doi" in fields:
        parts.append(f"[doi {fields['doi']}](https://doi.org/{fields['doi']})")
    if "eprint" in fields:
        parts.append(f"[arXiv {fields['eprint']}](https://arxiv.org/abs/{fields['eprint']})")
    return ". ".join(filter(None, parts)) + "."


def _comparator(each) -> str:
    """A published number beside ours, with every input."""
    rows = [("published input", name, text) for name, text in each.inputs.items()]
    rows += [("assumed", name, text) for name, text in each.assumed.items()]
    rows += [("**published**", name, text) for name, text in each.published.items()]
    rows += [("**ours**", name, f"{low:.3g} to {high:.3g}") for name, (low, high) in each.ours.items()]
    reach = ", ".join(f"{name} {range_text(ends)}" for name, ends in each.reaches.items())
    parts = [f"## {each.title}", _table(("", "", ""), rows), each.agreement]
    parts += [f"Over {reach}."] if reach else []
    return "\n\n".join([*parts, f"{each.kind.capitalize()}. {_linked(each.source)} (read: {each.read})."]) + "\n"


# --- the command ---


def _commands() -> str:
    from ballsocket.cli.root import load_commands

    names = sorted(load_commands())
    return "\n".join(f"## {name}\n\n```text\n{_help(name)}\n```\n" for name in names)


def _help(name: str) -> str:
    from typer.testing import CliRunner

    from ballsocket.cli.root import app

    with _terminal():
        shown = CliRunner().invoke(app, [name, "--help"], prog_name="ballsocket", terminal_width=_COLUMNS)
    return shown.output.strip()


@contextmanager
def _terminal():
    before = environ.get("COLUMNS")
    environ["COLUMNS"] = str(_COLUMNS)
    try:
        yield
    finally:
        environ.pop("COLUMNS") if before is None else environ.update(COLUMNS=before)


# --- the paper ---

_CLASSES = {"holds": "holds", "holds within": "nearly", "does not hold": "fails"}


def _claims(findings) -> str:
    rows = []
    for finding in findings:
        said = f"{finding['sentence']}<br><small>{finding['where']}</small>"
        why = f"<br><small>{finding['comment']}</small>" if finding["comment"] else ""
        verdict = f"<span class='{_CLASSES[finding['verdict']]}'>{finding['text']}</span>"
        numbers = "<br>".join(_number(name, value) for name, value in finding["numbers"].items())
        rows.append((said, verdict + why, f"<small>{numbers}</small>"))
    return _table(("statement", "verdict", "our result"), rows)


def _number(name: str, value: float) -> str:
    """A number behind its name, with the unit that the name ends in."""
    said, _, unit = name.replace("_", " ").rpartition(", ")
    known = {"%": "{} %", "± %": "± {} %", "MPa": "{} MPa", "mm": "{} mm", "mm²": "{} mm²", "°": "{}°"}
    shown = f"{value:.3g}"
    return f"{said}: {known[unit].format(shown)}" if unit in known else f"{name.replace('_', ' ')}: {shown}"
