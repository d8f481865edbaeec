"""Cells and heads of tables in text and in Excel files: encodings, separators, decimal marks, known names."""

from __future__ import annotations

import csv
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from io import BytesIO
from math import nan
from types import MappingProxyType
from typing import Any

from ..core.checks import needs

_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue"})

_COUNTS = {
    1.0: " 1",
    1e3: "10^3 1e3 kc thousand tausend tsd",
    1e6: "10^6 1e6 mc million millions millionen mio",
}
"""Units of counts by their factors; further signs are removed."""

_OTHER_NAMES = {
    "time": "zeit pruefzeit test_time elapsed_time",
    "phase": "cycle gait_cycle gangzyklus",
    "force": "f load compressive_load axial_force axial_load standard_force kraft last standardkraft pruefkraft "
    "axialkraft druckkraft normalkraft",
    "force_x": "kraft_x",
    "force_y": "kraft_y",
    "force_z": "kraft_z",
    "indentation": "displacement axial_displacement compressive_displacement crosshead_displacement extension "
    "compressive_extension standard_travel stroke eindrueckung weg standardweg traversenweg verschiebung",
    "flexion": "beugung flexion_extension",
    "adduction": "adduktion",
    "rotation": "drehung internal_rotation innenrotation",
    "angle": "winkel",
    "half_angle": "contact_half_angle",
    "area": "contact_area flaeche kontaktflaeche",
    "pressure": "contact_pressure druck kontaktdruck",
    "max_pressure": "maximum_pressure peak_pressure maximaldruck spitzendruck",
    "stiffness": "steifigkeit",
    "clearance": "radial_clearance",
    "diametral_clearance": "diameter_clearance durchmesserspiel",
    "cycles": "zyklen zyklenzahl lastwechsel number_of_cycles cycle_count",
    "million_cycles": "mc mcycles millions_of_cycles 10_6_cycles 10⁶_cycles mio_zyklen mio_lastwechsel "
    "millionen_zyklen millionen_lastwechsel 10_6_zyklen 10⁶_zyklen 10_6_lastwechsel 10⁶_lastwechsel",
    "volume": "volumen wear_volume verschleissvolumen",
    "mass": "masse mass_loss masseverlust weight_loss gewichtsverlust",
    "station": "specimen probe pruefling",
}

HEAD_NAMES: Mapping[str, str] = MappingProxyType(
    {other: name for name, others in _OTHER_NAMES.items() for other in others.split()}
)
"""Names of quantities by other plain names; a displacement is positive into the socket, and 0 at first touch."""

UNCERTAINTY = "_uncertainty"  # end of the name of a column with the standard uncertainties of another column


def known_head(plain: str, names: Collection[str]) -> str:
    """Return the one of the known names that a plain name means; "" for another one."""
    base = plain.removesuffix(UNCERTAINTY)
    name = plain if plain in names else HEAD_NAMES.get(base, "") + plain[len(base) :]
    return name if name in names else ""


def count_factor(unit: str) -> float | None:
    """Return the factor of a unit of counts, such as 1e6 for "Mio.", "million cycles", "x 10^6"; None if unknown."""
    text = unit.lower().replace("**", "^").replace("⁶", "^6").replace("³", "^3")
    plain = re.sub(r"[\s.]|^[x×]|(cycles|zyklen|lastwechsel)$", "", text)
    return next((factor for factor, units in _COUNTS.items() if plain in units.split(" ")), None)


def plain_name(text: str) -> str:
    """Return a name in small letters without accents, with "_" between its words.

    Examples
    --------
    >>> plain_name("Max. Eindrückung ")
    'max_eindrueckung'
    """
    letters = text.lower().translate(_LETTERS).replace("ß", "ss")
    return "_".join("".join(char if char.isalnum() else " " for char in letters).split())


_MAX_SHEET_BYTES = 200_000_000  # largest size in bytes of the content of an Excel file

_SEPARATORS = ";\t|, "
_MARKS = (".", ",")
_BLANKS = " '\u2019\u00a0\u2009\u202f"  # blanks and apostrophes between thousands
_WORDS = frozenset(("nan", "inf", "+inf", "-inf", "infinity"))  # words of numbers that are not finite, in small letters

_NO_NUMBER = frozenset(("", "-", "--", "---", "[-]", "(-)", "n/a", "na", "#n/a", "null", "none"))
"""Cells for a missing number, in small letters."""

# possessive quantifiers (*+, ++) keep the matching time proportional to the length
_FORMS = {
    mark: re.compile(
        rf"[-+]?(?:[1-9]\d{{0,2}}(?:[{other}{_BLANKS}]\d{{3}})++(?:{re.escape(mark)}\d*+)?"
        rf"|(?:\d++(?:{re.escape(mark)}\d*+)?|{re.escape(mark)}\d++)(?:[eE][-+]?\d{{1,4}})?)",
        re.ASCII,
    )
    for mark, other in (_MARKS, _MARKS[::-1])
}
"""Numbers with a decimal mark, and with the other mark or blanks between thousands, which exclude an exponent."""

_ANY_FORM = re.compile("|".join(form.pattern for form in _FORMS.values()), re.ASCII)

_DECIMALS = {mark: str.maketrans(mark, ".", _BLANKS + other) for mark, other in (_MARKS, _MARKS[::-1])}
"""Translations of numbers to those of Python."""

_BLANKS_AT_BRACKETS = re.compile(r"(?<=[^\s\])])\s++(?=[\[(])|(?<=[\[(])\s++|(?<!\s)\s++(?=[\])])|(?<=%)\s++(?=\w)")

Cell = str | float  # content of a cell: text, or a number of an Excel file
NumberedRow = tuple[int, Sequence[Cell]]  # number of a line, and its cells


OLD_EXCEL, EXCEL = b"\xd0\xcf\x11\xe0", b"PK"  # first bytes of Excel files: .xls, which is not read, and .xlsx


def decode_text(raw: bytes) -> str:
    """Decode text in UTF-8 or UTF-16, with or without a byte order mark, or in cp1252, the code page of Windows.

    Raises ValueError: bytes that are no text.
    """
    wide = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}.get(raw[:2])
    if wide is None and b"\0" in raw[:2]:
        wide = "utf-16-be" if raw[:1] == b"\0" else "utf-16-le"
    for encoding in [wide] if wide else ["utf-8-sig", "cp1252"]:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text.replace("\r\n", "\n").replace("\r", "\n").replace("\u2212", "-")
    raise ValueError("it is not text in UTF-8, UTF-16 or cp1252")


def split_text(text: str) -> Iterator[tuple[str, list[NumberedRow]]]:
    """Yield each possible separator of cells and the cells of all lines; comments (#) have none.

    Raises ValueError: a quote that does not close, with all separators.
    """
    errors, n_tables = [], 0
    for separator in _SEPARATORS:
        if separator in ";\t|" and separator not in text:
            continue
        lines = text.split("\n")
        if separator == " ":
            lines = [_BLANKS_AT_BRACKETS.sub("", line.replace("\t", " ").strip()) for line in lines]
        plain = ("\n" if line.startswith("#") else f"{line}\n" for line in lines)
        reader = csv.reader(plain, delimiter=separator, skipinitialspace=True, strict=True)
        try:
            rows: list[NumberedRow] = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
        except csv.Error as error:
            errors.append(f"it is not a table in text: {error}, in line {reader.line_num}")
            continue
        n_tables += 1
        yield separator, rows
    if not n_tables:
        raise ValueError(errors[0])


def read_excel(raw: bytes) -> dict[str, list[NumberedRow]]:
    """Return the rows of each sheet with a number in an Excel file (.xlsx), or of all sheets without any.

    Raises ValueError: another content, or one that is too large.
    Raises ImportError: the extra `xlsx` is not installed.
    """
    from zipfile import BadZipFile, ZipFile

    needs("xlsx", "openpyxl")
    from openpyxl import load_workbook

    try:
        with ZipFile(BytesIO(raw)) as archive:
            if sum(member.file_size for member in archive.infolist()) > _MAX_SHEET_BYTES:
                raise ValueError(f"its content is larger than {_MAX_SHEET_BYTES // 1_000_000} MB")
        sheets: dict[str, list[NumberedRow]] = {}
        for sheet in load_workbook(BytesIO(raw), read_only=True, data_only=True).worksheets:
            sheet.reset_dimensions()  # some programs state too few cells
            sheets[sheet.title] = list(enumerate((list(map(_excel_cell, cells)) for cells in sheet.rows), 1))
    except (BadZipFile, SyntaxError, LookupError, AttributeError, TypeError, OSError) as error:
        raise ValueError(f"it is not a readable .xlsx file: {error}") from error
    filled = {title: rows for title, rows in sheets.items() if any(is_data(cells) for _, cells in rows)}
    return filled or sheets or {"": []}


def _excel_cell(cell: Any) -> Cell:
    """Return the content of a cell of an Excel file; a percentage as text, because its number is 100 times smaller."""
    value = cell.value
    if isinstance(value, int | float) and not isinstance(value, bool):
        return f"{100 * value:g} %" if "%" in cell.number_format else float(value)
    return "" if value is None else str(value).strip()


def is_data(cells: Iterable[Cell]) -> bool:
    """Return True if a row has a number, or a word such as "nan"."""
    return any(not isinstance(cell, str) or _ANY_FORM.fullmatch(cell) or cell.lower() in _WORDS for cell in cells)


def count_words(cells: Iterable[Cell]) -> int:
    """Count the cells of a row that are neither empty nor a sign for a missing number."""
    return sum(str(cell).lower() not in _NO_NUMBER for cell in cells)


def decimal_mark(cells: Iterable[tuple[int, Cell]], separator: str) -> str:
    """Find the decimal mark with which all numbers in cells can be read; each cell has its line.

    Numbers between commas have a decimal point unless one of them contains a comma.

    Raises ValueError: numbers with both marks, or only such with one mark that may also stand between thousands.
    """
    settled: dict[str, tuple[int, str]] = {}
    ambiguous: tuple[int, str] | None = None
    for line, cell in cells:
        if not isinstance(cell, str) or not any(mark in cell for mark in _MARKS if mark not in settled):
            continue
        marks = [mark for mark, form in _FORMS.items() if form.fullmatch(cell)]
        if len(marks) == 1:
            settled.setdefault(marks[0], (line, cell))
        elif marks and ("," in cell or separator != ","):
            ambiguous = ambiguous or (line, cell)
    if len(settled) == len(_MARKS):
        (line, point), (other, comma) = settled["."], settled[","]
        raise ValueError(f"line {line} has a decimal point in {point}, and line {other} a decimal comma in {comma}")
    if not settled and ambiguous:
        line, cell = ambiguous
        whole = re.sub("[.,]", "", cell)
        raise ValueError(
            f"line {line} has {cell}, which may be {whole} or {cell.replace(',', '.')}: write {whole} without a mark "
            f"between thousands, or {cell}0 with another number of decimals"
        )
    return next(iter(settled), ".")


def cell_number(cell: Cell, mark: str) -> float:
    """Return the number in a cell with a decimal mark; NaN for other text."""
    if not isinstance(cell, str):
        return cell
    if _FORMS[mark].fullmatch(cell):
        return float(cell.translate(_DECIMALS[mark]))
    return float(cell) if cell.lower() in _WORDS else nan
