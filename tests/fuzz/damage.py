"""Strategies for damaged files: seeds with replaced, missing or doubled values, lines and bytes."""

from hypothesis import strategies as st

from . import words
from .words import number, odd_text, quantity

ODD_VALUES = st.one_of(
    quantity.map(words.toml),
    number,
    odd_text.map(words.toml),
    st.sampled_from(("true", "[]", "{}", "[1, 2]", '["a"]', "{a = 1}", "1979-05-27", "'''x\ny'''", "", "9" * 400)),
    st.sampled_from((5, 50, 500, 2000, 9000)).map(lambda depth: "[" * depth + "]" * depth),
    st.just("[" * 500),
)
"""Values of entries that are seldom right."""

_WOUNDS = (b"", b"\0", b"\xff", b"[", b"]]", b"=", b'"', b'"""', b".", b"a.b.", b"\n", b",", b"\r", b"\xef\xbb\xbf")
_BYTES = st.sampled_from((*_WOUNDS, b" " * 3000, b"(" * 2000, b"[" * 3000, b"x." * 9000)) | st.binary(max_size=6)


def _edited(seed, position, change, mark=""):
    """Replace one of the lines that have the mark."""
    lines = seed.decode("utf-8").splitlines()
    marked = [i for i, line in enumerate(lines) if mark in line]
    if marked:
        i = marked[position % len(marked)]
        lines[i : i + 1] = change(lines[i])
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def _with_value(seed, position, value):
    return _edited(seed, position, lambda line: [f"{line.partition(' = ')[0]} = {value}"], " = ")


def _with_cell(seed, position, column, cell):
    def change(line):
        cells = line.split(",")
        cells[column % len(cells)] = cell
        return [",".join(cells)]

    return _edited(seed, position, change)


def with_bytes(seed, position, width, wound):
    position %= max(len(seed), 1)
    return seed[:position] + wound + seed[position + width :]


_position = st.integers(0, 5000)


def _mostly_once(seed, *faults):
    """Draw a seed, usually with one of the faults, a line lost or doubled, or some bytes replaced."""
    lines = st.builds(_edited, seed, _position, st.sampled_from((lambda line: [], lambda line: [line, line])))
    once = st.one_of(*faults, lines, st.builds(with_bytes, seed, _position, st.integers(0, 6), _BYTES))
    return st.one_of(seed, once, once, once, st.binary(max_size=200))


def file_of(*seeds):
    """Draw the bytes of a file: a seed, usually with one fault."""
    seed = st.sampled_from(seeds)
    value = st.builds(_with_value, seed, _position, ODD_VALUES)
    return _mostly_once(seed, value, value)


def table_of(*seeds):
    seed = st.sampled_from(seeds)
    cell = st.builds(_with_cell, seed, _position, st.integers(0, 6), number | odd_text | quantity)
    head = st.builds(_with_cell, seed, st.just(0), st.integers(0, 6), odd_text | st.sampled_from(HEADS))
    return _mostly_once(seed, cell, head)


HEADS = (
    "force [N]", "force [kN]", "force" + " " * 3000 + "!", "force (" + " " * 3000 + "x", "time [s]", "phase [%]",
    "force [%BW]", "flexion", "force_x [N]", "Fx", "indentation [um]", "area_mm2", "force_", "pressure [MPa]",
    "angle_deg", "half_angle_deg", "indentation_uncertainty_um", "max_pressure_psi", "force [N", "[N]", "'", '"',
    "(" * 999, "a(" * 999,
)  # fmt: skip
"""Valid, misspelt and hostile column heads."""

_PIECES = (
    *("mm", "mm", "N", "m", "J", "MPa", "9", "kkm", "%", "(N m)", "mm^3/(N m)", "mm³/J", "mm/m", "µm", "°", "e", "inf"),
    *("2", "3", "^2", "^3", "**3", "^9", "^-1", "^9^9^9^9", "**9**9", "^99", "³", "^(9^9)", "^", "**"),
    *("/", "/", "*", " ", "·", "//", "(", ")", "/(", "^", " " * 90, "(" * 60, "m/" * 40),
)
_numbers = st.sampled_from(("1e-6 ", "2", "1.066e-6 ", "9", "-1 ", "1e308 ", "1e999", "nan ", "", "9" * 90))
coefficient = st.builds(str.__add__, _numbers, st.lists(st.sampled_from(_PIECES), max_size=7).map("".join))
"""Numbers with units, and arithmetic in the place of units."""
