"""Strategies for damaged input: seeds whose values, cells, lines or bytes are replaced, lost, doubled or inserted."""

from functools import reduce

from hypothesis import strategies as st

from . import words
from .words import number, odd_text, quantity

ODD_VALUES = st.one_of(
    words.plain_number,
    words.values.map(words.toml),
    number,
    st.sampled_from(("true", "[]", "{}", "[1, 2]", '["a"]', "{a = 1}", "1979-05-27", "'''x\ny'''", "", "9" * 400)),
    st.sampled_from((5, 50, 500, 2000, 9000)).map(lambda depth: "[" * depth + "]" * depth),
    st.just("[" * 500),
)
"""Values of entries of TOML that are seldom right."""

_WOUNDS = (b"", b"\0", b"\xff", b"[", b"]]", b"=", b'"', b'"""', b".", b"a.b.", b"\n", b",", b"\r", b"\xef\xbb\xbf")
_BYTES = st.sampled_from((*_WOUNDS, b" " * 3000, b"(" * 2000, b"[" * 3000, b"x." * 9000)) | st.binary(max_size=6)
_position = st.integers(0, 3) | st.integers(0, 5000)


def _with_fault(lines, fault):
    position, change = fault
    place = position % max(len(lines), 1)
    return [part for i, line in enumerate(lines) for part in (change(line) if i == place else [line])]


def lines_of(seeds, change):
    """Draw the lines of a seed with at most three faults; a change turns one line into several."""
    others = st.sampled_from(list(dict.fromkeys(line for seed in seeds for line in seed)))
    moved = st.one_of(
        st.just(lambda line: []),
        st.just(lambda line: [line, line]),
        others.map(lambda other: lambda line: [line, other]),
    )
    faults = st.lists(st.tuples(_position, change | change | moved), max_size=3)
    return st.builds(lambda seed, faults: reduce(_with_fault, faults, seed), st.sampled_from(seeds), faults)


def value_after(equals, values):
    """Draw a change of the value behind a sign."""
    return values.map(lambda value: lambda line: [f"{line.partition(equals)[0]}{equals}{value}"])


def with_bytes(seed, position, width, wound):
    position %= max(len(seed), 1)
    return seed[:position] + wound + seed[position + width :]


def _bytes_of(seeds, change):
    """Draw the bytes of a file, some of them with a wound."""
    lines = lines_of([seed.decode().splitlines() for seed in seeds], change)
    whole = lines.map(lambda lines: "\n".join(lines).encode("utf-8", "surrogatepass"))
    wounded = st.builds(with_bytes, whole, _position, st.integers(0, 6), _BYTES)
    return st.one_of(whole, whole, wounded, st.binary(max_size=200))


def file_of(*seeds):
    """Draw the bytes of a file in TOML."""
    return _bytes_of(seeds, value_after(" = ", ODD_VALUES))


def table_of(*seeds):
    """Draw the bytes of a table in text."""

    def change(column, cell):
        def changed(line):
            cells = line.split(",")
            cells[column % len(cells)] = cell
            return [",".join(cells)]

        return changed

    cells = number | odd_text | quantity | st.sampled_from(HEADS)
    return _bytes_of(seeds, st.builds(change, st.integers(0, 6), cells))


HEADS = (
    "force [N]", "force [kN]", "force" + " " * 3000 + "!", "force (" + " " * 3000 + "x", "time [s]", "phase [%]",
    "force [%BW]", "flexion", "force_x [N]", "Fx", "indentation [um]", "area_mm2", "force_", "pressure [MPa]",
    "angle_deg", "half_angle_deg", "indentation_uncertainty_um", "max_pressure_psi", "force [N", "[N]", "'", '"',
    "(" * 999, "a(" * 999, "ball_radius", "liner_young", "liner", "clearence",
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
