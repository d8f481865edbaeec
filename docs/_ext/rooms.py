"""Picture of the rooms of the package and of the flow of data, drawn from the code while the pages are made.

Floors are the layers of the import contract in pyproject.toml, titles are the docstrings of the rooms, and each step of
the flow is in the room whose module defines it. `python docs/_ext/rooms.py FOLDER` writes the two pictures alone.
"""

import ast
import re
import sys
import tomllib
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from pathlib import Path
from textwrap import wrap

import ballsocket as bs
from ballsocket.core.display import load_plot

ROOT = Path(__file__).parents[2]
PACKAGE = Path(bs.__file__).parent

WIDTH, MARGIN, LANE = 960, 34, 408  # px; the lane at the right has the flow of data
FLOOR, GAP, HEAD = 62, 6, 34  # px; height of a floor, distance of floors, height of the heads
THEMES = {
    "light": {"ink": "#131416", "muted": "#5f646b", "line": "#c4c8cd", "floor": "#f3f4f6", "room": "#ffffff"},
    "dark": {"ink": "#e4e6e9", "muted": "#a2a8af", "line": "#4a5058", "floor": "#1f2226", "room": "#2a2e33"},
}
COLOURS = {"light": ("#0072B2", "#D55E00"), "dark": ("#56B4E9", "#F0843C")}  # rooms of the flow, the flow itself


@dataclass(frozen=True)
class Step:
    """Step of the flow of data: name, Python code, room of the module that defines it, and position in the lane."""

    title: str
    code: str
    room: str
    column: float


def setup(app):
    app.connect("config-inited", lambda app, config: write_pictures(Path(app.confdir) / "_generated"), priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def write_pictures(folder):
    """Write the picture for light and for dark pages."""
    folder.mkdir(parents=True, exist_ok=True)
    for theme in THEMES:
        text = picture(floors(), data_flow(), theme)
        path = folder / f"rooms.{theme}.svg"
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def floors():
    """Return the floors of the package from top to bottom, each with its rooms."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = project["tool"]["importlinter"]["contracts"]
    (layers,) = (contract["layers"] for contract in contracts if contract.get("containers") == ["ballsocket"])
    return [re.split(r"\s*[|:]\s*", layer) for layer in layers]


def data_flow():
    """Return the steps from a joint to a figure."""
    steps = (
        ("joint", "bs.Joint(...)", bs.Joint, 0),
        ("model", "bs.HessForsbach()", bs.HessForsbach, 28),
        ("contact", "model.press(joint, ...)", bs.Contact, 168),
        ("study", "bs.study(model, joint, ...)", bs.study, 168),
        ("figure", "contact.plot()", load_plot("contacts"), 168),
    )
    return [Step(title, code, thing.__module__.split(".")[1], column) for title, code, thing, column in steps]


def title_of(room):
    """Return the first sentence of the docstring of a room, up to a colon or semicolon, and the rooms inside it."""
    path = PACKAGE / room / "__init__.py"
    path = path if path.is_file() else PACKAGE / f"{room}.py"
    sentence = re.split(r"[:;]\s|\.\s|\.$", ast.get_docstring(ast.parse(path.read_bytes())) or "")[0]
    rooms = sorted(door.parent.name for door in path.parent.glob("*/__init__.py")) if path.name == "__init__.py" else []
    return " ".join(sentence.split()) + (f" ({', '.join(rooms)})" if rooms else "")


def number_of_files(room):
    """Return the number of Python files of a room."""
    return len(list((PACKAGE / room).rglob("*.py"))) or 1


def picture(levels, steps, theme):
    """Return the picture as SVG."""
    height = HEAD + len(levels) * (FLOOR + GAP)
    style = THEMES[theme] | dict(zip(("used", "flow"), COLOURS[theme], strict=True))
    parts = [_heads(style), _downwards(height, style)]
    middles = {}
    for number, rooms in enumerate(levels):
        top = HEAD + number * (FLOOR + GAP)
        middles |= dict.fromkeys(rooms, top + FLOOR / 2)
        parts.append(_box(MARGIN, top, WIDTH - MARGIN, FLOOR, fill=style["floor"], line="none"))
        parts += _rooms(rooms, top, {step.room for step in steps}, style)
    parts.append(_flow(steps, middles, style))
    label = "Rooms of the package on their floors, and the flow of data: " + ", ".join(
        f"{step.title} in {step.room}" for step in steps
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{label}" '
        f'font-family="system-ui, -apple-system, Segoe UI, Roboto, DejaVu Sans, sans-serif">\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def _heads(style):
    left = WIDTH - LANE + 22
    return _text(MARGIN, 20, "Rooms, floor by floor (number of files)", 14, style["muted"]) + _text(
        left, 20, "Data flow", 14, style["flow"]
    )


def _downwards(height, style):
    """Draw the arrow of imports at the left edge."""
    line = f'<path d="M14 {HEAD} V{height - 18}" stroke="{style["muted"]}" stroke-width="1.3"/>'
    head = f'<path d="M9 {height - 20} L19 {height - 20} L14 {height - 8} Z" fill="{style["muted"]}"/>'
    middle = HEAD + (height - HEAD) / 2
    turned = f'transform="rotate(-90 26 {middle})" text-anchor="middle"'
    return line + head + _text(26, middle, "a room imports only from the floors below it", 13, style["muted"], turned)


def _rooms(rooms, top, used, style):
    """Draw the boxes of the rooms of a floor, with name, number of files and title."""
    width = (WIDTH - LANE - MARGIN - 6 - 6 * len(rooms)) / len(rooms)
    for number, room in enumerate(rooms):
        left = MARGIN + 6 + number * (width + 6)
        line, name = (style["used"], style["used"]) if room in used else (style["line"], style["ink"])
        yield _box(left, top + 5, width, FLOOR - 10, fill=style["room"], line=line)
        yield _text(left + 9, top + 21, room, 15, name, 'font-weight="600"')
        count = str(number_of_files(room))
        yield _text(left + width - 9, top + 21, count, 12, style["muted"], 'text-anchor="end"')
        for row, text in enumerate(_fitted(title_of(room), width - 18)):
            yield _text(left + 9, top + 36 + 14 * row, text, 12, style["muted"])


def _fitted(text, width):
    """Return a title in at most two lines; what does not fit is cut at a comma or a word."""
    columns = int(width / 6.4)  # mean width of a letter of 12 px
    while len(wrap(text, columns)) > 1 + (columns < 60):
        text = text.rpartition(", " if ", " in text else " ")[0]
        text = re.sub(r"(?: (?:a|an|and|by|for|from|in|of|the|to|with))+$", "", text)
    return wrap(text, columns) if columns < 60 else [text]


def _flow(steps, middles, style):
    """Draw the steps as nodes with arrows between them: along the column of the first, then to the second."""
    left = WIDTH - LANE + 30
    points = [(left + step.column, middles[step.room]) for step in steps]
    parts = []
    for (x0, y0), (x1, y1) in pairwise(points):
        sign = 1 if y1 > y0 else -1
        if x0 == x1:
            line, turn, tip = f"V{y1 - 17 * sign}", 90 * sign, (x1, y1 - 17 * sign)
        else:
            line, turn, tip = f"V{y1 - 12 * sign} Q{x0} {y1} {x0 + 12} {y1} H{x1 - 17}", 0, (x1 - 17, y1)
        parts.append(
            f'<path d="M{x0} {y0} {line}" fill="none" stroke="{style["flow"]}" stroke-width="2.2"/>'
            f'<path d="M0 -5 L8 0 L0 5 Z" fill="{style["flow"]}" '
            f'transform="translate({tip[0]} {tip[1]}) rotate({turn})"/>'
        )
    for step, (x, y) in zip(steps, points, strict=True):
        parts.append(f'<circle cx="{x}" cy="{y}" r="8" fill="{style["flow"]}"/>')
        parts.append(_text(x + 14, y - 3, step.title, 15, style["ink"], 'font-weight="600"'))
        parts.append(_text(x + 14, y + 13, step.code, 11.5, style["muted"], 'font-family="monospace"'))
    return "\n".join(parts)


def _box(left, top, width, height, *, fill, line):
    place = f'x="{left:g}" y="{top:g}" width="{width:g}" height="{height:g}"'
    return f'<rect {place} rx="5" fill="{fill}" stroke="{line}"/>'


def _text(left, bottom, text, size, colour, more=""):
    return f'<text x="{left:g}" y="{bottom:g}" font-size="{size}" fill="{colour}" {more}>{escape(text)}</text>'


if __name__ == "__main__":
    write_pictures(Path(sys.argv[1]))
