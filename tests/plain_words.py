"""Measures of plain English in a room: clauses, dialect, identifiers without content, class names used twice.

`python -m tests.plain_words hip cup.py` prints the figures of these rooms and what exceeds a goal; without names,
those of all rooms. `--all` lists every finding, also of measures that meet their goal.
"""

import ast
import io
import re
import sys
import tokenize
from collections import defaultdict
from dataclasses import dataclass

from .rooms import files_of, rooms, shown, tree_of


def _words(text):
    return tuple(text.split())


CLAUSE_OPENINGS = _words("What Where Whose Who Whom How Whether Of That Which By As On So")
"""Words that open a noun clause or lean on a sentence before: no docstring begins with them."""

DIALECT_PHRASES = (
    *_words("told tells untold said says asked asks anew hither thereby beforehand whoever whatever whom"),
    *("one's own", "of its own", "so many", "so much", "as it is made", "stands? beside", "give[sn]? way", "gave way"),
    *(r"(?<!there )is no \w+", r"(?<!there )are no \w+", "knows? (?:no|nothing)"),
)
"""Phrases for which the field has a plain word, as patterns; "there is no" is plain English."""

VAGUE_NAMES = _words(
    """
    it them this that who what each some any_of all_of few most many much usual near other others sure own one ones
    thing things way ways turn turns shares place places spots room around beside first_of mouth ears calm
    found given left kept rest whole done said told untold told_of asked asking taken lost missed overlooked
    look looks lived lives
    """
)
"""Identifiers that do not say what the value is."""

NOT_VERBS = _words(
    """
    a an the this that these those its their his her our your my one two three four five six seven eight nine
    ten twenty first second once twice all any both each either every few many most much neither no none nobody
    nothing only some several such another other about above after along among around as at before behind below
    beneath beside besides between beyond by down during for from in inside into of off on onto out outside over
    past per since through to towards under until up upon with within without and or but so if when where why
    how what which who whom whose whether than then there here it he she they we you whatever whoever always
    never not also
    """
)
"""Words that cannot be the verb at the start of a sentence that commands."""

MAX_CLAUSES, MAX_DIALECT, MAX_VAGUE, MAX_NO_VERB, MAX_TWICE = 0.01, 6e-4, 0.01, 0.05, 3
"""Goals: share of docstrings, of words, of identifiers, of the functions' docstrings; number of class names."""

_CLAUSE = re.compile(rf"(?:{'|'.join(CLAUSE_OPENINGS)})\b")
_DIALECT = re.compile(rf"\b(?:{'|'.join(DIALECT_PHRASES)})\b", re.IGNORECASE)
_DOCUMENTED = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
_FUNCTION = ast.FunctionDef | ast.AsyncFunctionDef
_NOUN = re.compile(r"property|\.setter$|\.deleter$|fixture|overload|field_|validator")


@dataclass(frozen=True, order=True)
class Finding:
    """One place that breaks a rule."""

    path: str
    line: int
    rule: str
    text: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.rule}: {self.text}"


@dataclass(frozen=True)
class Measure:
    """Findings of one rule, with the number of places that could break it."""

    rule: str
    findings: tuple[Finding, ...]
    total: int
    goal: float

    @property
    def share(self):
        """Findings per place."""
        return len(self.findings) / max(self.total, 1)

    @property
    def met(self):
        """True where the share meets the goal."""
        return len(self.findings) <= self.goal * self.total

    def __str__(self):
        figures = f"{len(self.findings)} of {self.total} ({100 * self.share:.2f} %, goal {100 * self.goal:.2f} %)"
        return f"{self.rule}: {figures}{'' if self.met else '  <-- too many'}"


def measure(files):
    """Return the four measures of some files: clauses, dialect, vague names, first words that are no verbs."""
    findings, totals = defaultdict(list), defaultdict(int)
    for path in files:
        tree, source = tree_of(path), path.read_text(encoding="utf-8")
        for rule, rows in (
            ("clause", docstrings(tree)),
            ("dialect", [*texts(tree), *comments(source)]),
            ("vague name", identifiers(tree)),
            ("no verb", function_docstrings(tree)),
        ):
            for line, text in rows:
                totals[rule] += len(text.split()) if rule == "dialect" else 1
                findings[rule] += [Finding(shown(path), line + down, rule, bad) for down, bad in _BREAKS[rule](text)]
    goals = {"clause": MAX_CLAUSES, "dialect": MAX_DIALECT, "vague name": MAX_VAGUE, "no verb": MAX_NO_VERB}
    return {rule: Measure(rule, tuple(sorted(findings[rule])), totals[rule], goal) for rule, goal in goals.items()}


def docstrings(tree):
    """Yield line and text of the docstrings of a module, its classes and its functions."""
    for node in ast.walk(tree):
        if isinstance(node, _DOCUMENTED) and (text := ast.get_docstring(node)):
            yield node.body[0].lineno, text


def function_docstrings(tree):
    """Yield line and text of the docstrings of functions; properties and fixtures are nouns and left out."""
    for node in ast.walk(tree):
        if isinstance(node, _FUNCTION) and (text := ast.get_docstring(node)) and not _is_noun(node):
            yield node.body[0].lineno, text


def texts(tree):
    """Yield line and text of all strings of more than one word."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            yield node.lineno, node.value


def comments(source):
    """Yield line and text of all comments."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


def identifiers(tree):
    """Yield line and name of everything that is bound: functions, classes, arguments, variables."""
    for node in ast.walk(tree):
        if isinstance(node, _FUNCTION | ast.ClassDef):
            yield node.lineno, node.name
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id


def class_names(files):
    """Return the places where each class name is defined; a leading underscore does not make another name."""
    places = defaultdict(list)
    for path in files:
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.ClassDef):
                places[node.name.lstrip("_")].append(f"{shown(path)}:{node.lineno}")
    return places


def defined_twice(files):
    """Return the class names that are defined more than once, with their places."""
    return {name: places for name, places in sorted(class_names(files).items()) if len(places) > 1}


def _is_noun(function):
    return any(_NOUN.search(ast.unparse(decorator)) for decorator in function.decorator_list)


def _first_line(text):
    return text.splitlines()[0]


def _clauses(text):
    return [(0, _first_line(text))] if _CLAUSE.match(text) else []


def _dialect(text):
    return [(text.count("\n", 0, match.start()), match[0]) for match in _DIALECT.finditer(text)]


def _vague(name):
    return [(0, name)] if name.strip("_").lower() in VAGUE_NAMES else []


def _without_verb(text):
    """Find a first word that cannot be an imperative: "The", "Returns", "Values"; formulas pass."""
    word = re.match(r"[A-Za-z]++(?![\w(^])", text)
    if word is None or (len(word[0]) == 1 and word[0] != "A"):
        return []
    plural = word[0].endswith("s") and not word[0].endswith(("ss", "us"))
    return [(0, _first_line(text))] if plural or word[0].lower() in NOT_VERBS else []


_BREAKS = {"clause": _clauses, "dialect": _dialect, "vague name": _vague, "no verb": _without_verb}


def main(words):
    """Print the figures of some rooms."""
    chosen = [word for word in words if not word.startswith("-")] or rooms()
    for room in chosen:
        measures = measure(files_of(room)).values()
        print(f"{room}\n  " + "\n  ".join(map(str, measures)))
        if len(chosen) < 5 or "--all" in words:
            for one in measures:
                if not one.met or "--all" in words:
                    print(*(f"    {finding}" for finding in one.findings), sep="\n")
    everywhere = [path for room in rooms() for path in files_of(room)]
    own = {shown(path) for room in chosen for path in files_of(room)}
    for name, places in defined_twice(everywhere).items():
        if own & {place.rsplit(":", 1)[0] for place in places}:
            print(f"class {name}: {', '.join(places)}")


if __name__ == "__main__":
    main(sys.argv[1:])
