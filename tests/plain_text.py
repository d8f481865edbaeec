"""Measures of plain English in pages and examples: words of a dialect, and sentences that are too long.

`python -m tests.plain_text README.md docs/how-to` prints the findings in these files and folders, with file and line;
without names, those of all pages and examples.

Pages are Markdown and reStructuredText; code, formulas and addresses of links are left out, each cell of a table is a
text of its own. In Python the texts are docstrings, strings and comments; in TOML they are comments.
"""

import ast
import re
import sys
from bisect import bisect_right
from pathlib import Path

from .places import ROOT
from .plain_words import DIALECT_PHRASES, Finding, comments, texts
from .rooms import shown

MAX_WORDS = 30
"""Largest number of words in a sentence. A semicolon ends a sentence; code and a formula count as one word."""

_DIALECT = re.compile(rf"\b(?:{'|'.join(DIALECT_PHRASES)})\b", re.IGNORECASE)
_SENTENCE_END = re.compile(r"(?<!\bal)(?<!\bFig)(?<!\bEq)(?<!\bvs)(?<!\be\.g)(?<!\bi\.e)[.!?;][)\"'*_]*(?=\s|$)")
_PROSE_DIRECTIVES = ("note", "tip", "warning", "important", "admonition")
_NOT_PROSE = (
    (r"<!--.*?-->", ""),
    (r"``.+?``|`[^`]+`", "code"),
    (r"\$\$?[^$]+\$\$?", "formula"),
    (r"!?\[([^\]]*)\](?:\([^)]*\)|\[[^\]]*\])", r"\1"),
    (r":\w+(?::\w+)?:code", "code"),
    (r"<https?://\S+>|https?://\S+", "address"),
)


def files():
    """Return the pages and examples that are guarded, in the order of their paths."""
    pages = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    docs = [path for pattern in ("*.md", "*.rst") for path in (ROOT / "docs").rglob(pattern)]
    made = {"_generated", "_build", "gallery"}
    pages += sorted(path for path in docs if not made & set(path.relative_to(ROOT / "docs").parts))
    return [*pages, *sorted(path for path in (ROOT / "examples").iterdir() if path.suffix in (".py", ".toml", ".rst"))]


def findings(path):
    """Return the words of a dialect and the long sentences of a file, with their lines."""
    result = []
    for paragraph in _paragraphs(path):
        starts, text = _joined(paragraph)
        lines = [line for line, _ in paragraph]
        rows = [("dialect", match.start(), match[0]) for match in _DIALECT.finditer(text)]
        rows += [("long sentence", start, f"{count} words: {words}") for start, count, words in _long_sentences(text)]
        result += [Finding(shown(path), lines[bisect_right(starts, at) - 1], rule, words) for rule, at, words in rows]
    return sorted(result)


def _joined(paragraph):
    """Join lines into one text, with the position at which each begins."""
    starts, text = [], ""
    for _, line in paragraph:
        starts.append(len(text))
        text += f"{line} "
    return starts, text


def _long_sentences(text):
    """Yield position, number of words and opening of the sentences that are too long."""
    start = 0
    for end in [*(match.end() for match in _SENTENCE_END.finditer(text)), len(text)]:
        words = [word for word in text[start:end].split() if re.search(r"\w", word)]
        if len(words) > MAX_WORDS:
            yield (
                start + len(text[start:end]) - len(text[start:end].lstrip()),
                len(words),
                " ".join(words[:10]) + " ...",
            )
        start = end


def _paragraphs(path):
    """Yield the texts of a file as lists of lines with their numbers."""
    source = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        tree = ast.parse(source)
        for line, text in texts(tree):
            yield from _blocks(enumerate(text.split("\n"), line), _markup_starts)
        yield from _blocks(_adjacent(comments(source)), _markup_starts)
    elif path.suffix == ".toml":
        rows = enumerate(source.splitlines(), 1)
        yield from _blocks(_adjacent((line, text[text.index("#") :]) for line, text in rows if "#" in text), _never)
    else:
        prose = _prose_of_markdown if path.suffix == ".md" else _prose_of_rst
        yield from _blocks(prose(source.splitlines()), _markup_starts)


def _adjacent(rows):
    """Yield comments without their signs; a blank line parts those that do not follow each other."""
    last = None
    for line, text in rows:
        if last is not None and line > last + 1:
            yield last + 1, ""
        yield line, re.sub(r"^#[ %:]*", "", text)
        last = line


def _never(text):
    return False


def _markup_starts(text):
    """Return True for a line that begins a paragraph: a list item or a heading."""
    return re.match(r"\s*(?:[-*+] |\d+\. |#+ |: )", text) is not None


def _blocks(rows, starts):
    """Yield paragraphs: lines up to a blank one, the next item or heading; cells of a table one by one."""
    block = []
    for line, raw in rows:
        text = _plain(raw)
        if block and (not text.strip() or text.lstrip().startswith("|") or starts(text)):
            yield block
            block = []
        if text.lstrip().startswith("|"):
            yield from ([(line, cell)] for cell in text.strip().strip("|").split("|") if cell.strip())
        elif text.strip():
            block.append((line, text))
            if text.startswith("#"):
                yield block
                block = []
    if block:
        yield block


def _plain(text):
    """Return a line without code, formulas and addresses."""
    for pattern, plain in _NOT_PROSE:
        text = re.sub(pattern, plain, text)
    return text


def _prose_of_markdown(lines):
    """Yield the lines outside code and display formulas; options of directives and reference labels are blank."""
    fence, formula = None, False
    for number, line in enumerate(lines, 1):
        if not fence and line.count("$$") == 1:
            formula, line = not formula, ""
        elif formula:
            line = ""
        opening = re.match(r"\s*(`{3,}|~{3,})(?:\{(\w+)\})?", line)
        if fence and line.strip().startswith(fence):
            fence, line = None, ""
        elif opening and not fence:
            prose = opening[2] in _PROSE_DIRECTIVES
            fence, line = opening[1] if not prose else None, ""
        elif fence or re.match(r"\s*(?::{3,}|:[\w-]+:|\([\w-]+\)=\s*$|\$\$)", line):
            line = ""
        yield number, line


def _prose_of_rst(lines):
    """Yield the lines outside directives; underlines of headings are blank."""
    hidden = False
    for number, line in enumerate(lines, 1):
        if re.match(r"\.\. ", line) or line.rstrip().endswith("::"):
            hidden, line = True, ""
        elif hidden and line.strip() and not line.startswith((" ", "\t")):
            hidden = False
        if hidden or re.fullmatch(r"([=\-~^*#]){3,}\s*", line):
            line = ""
        yield number, line


def main(words):
    """Print the findings of some files and folders."""
    roots = [Path(word).resolve() for word in words] or [ROOT]
    chosen = [path for path in files() if any(path.is_relative_to(root) for root in roots)]
    for path in chosen:
        print(*findings(path), sep="\n", end="\n" if findings(path) else "")


if __name__ == "__main__":
    main(sys.argv[1:])
