#!/usr/bin/env python3
"""Regular expressions of the package: matching time must be proportional to the length of the text."""

import ast
import importlib
import re
import sys
import time
from itertools import product
from pathlib import Path
from re import _constants as codes
from re import _parser as parser

PACKAGE = Path(__file__).resolve().parents[1] / "src" / "ballsocket"
METHODS = {"match", "fullmatch", "search", "sub", "split", "findall", "finditer"}
WITH_PATTERNS = re.compile(rf"\bre\.(?:compile|{'|'.join(sorted(METHODS))})\b")
"""Text of a module that makes or uses patterns; other modules are not parsed."""

SIZES = (500, 1000, 2000, 4000)
BOUNDED = {
    "app/server.py": "host names of a request, against the names that its administrator gives",
    "studies/expressions.py": "texts of at most 200 characters",
    "core/sources.py": "the bibliography of the package",
    "elasticity/finite_elements/calculix.py": "results in a folder of decks",
    "core/unit_systems.py": "numbers of a sentence of the package, at most eight in a list",
}
"""Modules with patterns made at run time, which are not measured, and the texts that they read."""


def uses():
    """List all patterns with their calling methods, and the modules that make patterns at run time."""
    patterns, made = [], set()
    for path in sorted(PACKAGE.rglob("*.py")):
        text, name = path.read_text(encoding="utf-8"), path.relative_to(PACKAGE).as_posix()
        if not WITH_PATTERNS.search(text):
            continue
        calls = [
            (node.func.value.id, node.func.attr, node.args)
            for node in ast.walk(ast.parse(text))
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and isinstance(node.func.value, ast.Name)
            and node.func.attr in METHODS
        ]
        for owner, method, arguments in calls:
            if owner == "re":
                pattern = arguments[0]
                if isinstance(pattern, ast.Constant):
                    patterns.append((name, re.compile(pattern.value), method))
                else:
                    made.add(name)
        module = importlib.import_module("ballsocket." + name.removesuffix(".py").replace("/", "."))
        for constant, pattern in vars(module).items():
            if isinstance(pattern, re.Pattern):
                methods = {method for owner, method, _ in calls if owner == constant}
                patterns += [(name, pattern, method) for method in sorted(methods or {"fullmatch"})]
    return patterns, made


def characters(items):
    """Return a few characters that match a set of a parsed pattern."""
    candidates = " a1[(\"',.:/%N-_\t=é\n"
    return [char for char in candidates if accepts(items, char)][:4]


def accepts(item, char):
    code, argument = item
    if code is codes.LITERAL:
        return chr(argument) == char
    if code is codes.NOT_LITERAL:
        return chr(argument) != char
    if code is codes.ANY:
        return char != "\n"
    text = re.compile(".", re.DOTALL)
    assert text.match(char)
    if code is codes.IN:
        negated = argument[0][0] is codes.NEGATE
        return any(member(entry, char) for entry in argument[negated:]) != negated
    return False


CATEGORIES = {
    codes.CATEGORY_SPACE: str.isspace,
    codes.CATEGORY_NOT_SPACE: lambda char: not char.isspace(),
    codes.CATEGORY_DIGIT: str.isdigit,
    codes.CATEGORY_NOT_DIGIT: lambda char: not char.isdigit(),
    codes.CATEGORY_WORD: lambda char: char.isalnum() or char == "_",
    codes.CATEGORY_NOT_WORD: lambda char: not (char.isalnum() or char == "_"),
}


def member(item, char):
    code, argument = item
    if code is codes.RANGE:
        return argument[0] <= ord(char) <= argument[1]
    if code is codes.CATEGORY:
        return CATEGORIES[argument](char)
    return code is codes.LITERAL and chr(argument) == char


def shortest(tree):
    """Return a short text that roughly matches a parsed pattern."""
    return "".join(shortest_of(item) for item in tree)


def shortest_of(item):
    code, argument = item
    if code in (codes.LITERAL, codes.NOT_LITERAL, codes.ANY, codes.IN):
        return chr(argument) if code is codes.LITERAL else next(iter(characters(item)), "a")
    if code is codes.SUBPATTERN:
        return shortest(argument[3])
    if code is codes.BRANCH:
        return shortest(argument[1][0])
    if code in (codes.MAX_REPEAT, codes.MIN_REPEAT, codes.POSSESSIVE_REPEAT):
        return shortest(argument[2]) * argument[0]
    return ""


def repeats(tree, before=""):
    """Yield the repeated parts of a parsed pattern, each with the text before it."""
    for item in tree:
        code, argument = item
        if code in (codes.MAX_REPEAT, codes.MIN_REPEAT, codes.POSSESSIVE_REPEAT):
            inner = argument[2]
            single = len(inner) == 1 and inner[0][0] in (codes.LITERAL, codes.NOT_LITERAL, codes.ANY, codes.IN)
            if argument[1] > 1:
                yield from ((before, part) for part in (characters(inner[0]) if single else [shortest(inner)]) if part)
            yield from repeats(inner, before)
            before += shortest(inner) * max(argument[0], 1)
        elif code is codes.SUBPATTERN:
            yield from repeats(argument[3], before)
            before += shortest(argument[3])
        elif code is codes.BRANCH:
            for branch in argument[1]:
                yield from repeats(branch, before)
            before += shortest(argument[1][0])
        else:
            before += shortest_of(item)


def attacks(pattern):
    """Yield functions from a size to a text: a repeated part, many times, and then a mismatch."""
    parsed = parser.parse(pattern.pattern, pattern.flags)
    parts = sorted(set(repeats(parsed)))[:40]
    leads = sorted({before for before, _ in parts} | {""})
    units = sorted({part for _, part in parts} | {" "})
    units += [first + second for first, second in product(units, units) if first != second][:30]
    for before, unit in product(leads, units):
        for after in ("", "!", "\0", before):
            yield lambda size, before=before, unit=unit, after=after: text_of(
                pattern, before + unit * (size // len(unit)) + after
            )


def text_of(pattern, text):
    """Return a text, or its bytes for a pattern of bytes."""
    return text.encode("utf-8") if isinstance(pattern.pattern, bytes) else text


def seconds(pattern, method, text):
    start = time.process_time()
    if method == "sub":
        pattern.sub(text_of(pattern, ""), text)
    else:
        made = getattr(pattern, method)(text)
        if method == "finditer":
            list(made)
    return time.process_time() - start


def grows_faster_than_its_text(pattern, method, attack):
    """Check if doubling the text triples a matching time above 0.01 s."""
    before = min(seconds(pattern, method, attack(SIZES[0])) for _ in range(2))
    for size in SIZES[1:]:
        now = min(seconds(pattern, method, attack(size)) for _ in range(2))
        if now > 0.01 and now > 3 * max(before, 1e-5):
            return True
        before = now
    return before > 0.05


def main():
    patterns, made = uses()
    faults = [f"{name}: pattern made at run time" for name in sorted(made - set(BOUNDED))]
    for name, pattern, method in patterns:
        slow = next(
            (attack for attack in attacks(pattern) if grows_faster_than_its_text(pattern, method, attack)), None
        )
        if slow is not None:
            faults.append(f"{name}: {pattern.pattern!r} is slow for texts such as {slow(40)!r}")
    print(f"{len(patterns)} patterns measured")
    sys.exit("\n".join(faults) or 0)


if __name__ == "__main__":
    main()
