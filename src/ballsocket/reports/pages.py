"""HTML pages, and parts of them, from the templates of this room.

A page needs no other file: its style and its pictures are inside. The templates escape every text.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import date
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..contact.verdict import bar_text, percent
from ..core.answers import Answer, Check, Table, grid
from ..core.checks import needs
from ..core.display import counted
from ..core.input_files import open_input
from ..core.quantities import QUANTITIES, Quantity
from ..core.storage.atomic_files import check_ending, write_atomically
from ..core.unit_systems import Units
from ..files.joint_file import ReportDetails
from .figure_files import figure_bytes

if TYPE_CHECKING:
    from jinja2 import Environment
    from matplotlib.figure import Figure

Writer = Callable[[Quantity, float], str]
"""Function that writes a number in internal units with its unit: `Units.text_of`, or `Reading.with_unit`."""

Sections = Mapping[str, tuple[str, str | None]]
"""Title and HTML of each section by its id; the template has a block of that id where the HTML is None."""


@cache
def _environment() -> Environment:
    """Return the environment of the templates, which escapes texts and refuses missing values."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["counted"] = counted
    return environment


PAGE_FORMATS = (".html", ".pdf")  # endings of the files that `write_page` writes

_MAX_LOGO_SIZE = 1_000_000
_LOGO_FORMATS = {".png": "png", ".svg": "svg+xml"}


def check_page_path(path: Path) -> None:
    """Check that a page can be written to a path.

    Raises ValueError: another ending than .html or .pdf, or a folder that does not exist.
    Raises ImportError: a .pdf, and the writer of PDF is not installed.
    """
    check_ending("report", path, *PAGE_FORMATS)
    if path.suffix.lower() == ".pdf":
        _weasyprint()


def write_page(page: str, path: Path, paper: str = "A4") -> None:
    """Write a page as HTML, or printed as PDF on sheets of "A4" or "letter", according to the ending of `path`.

    Raises ValueError, ImportError: as `check_page_path`.
    Raises OSError: the path cannot be written to.
    """
    check_page_path(path)
    with write_atomically(path) as draft:
        if path.suffix.lower() == ".pdf":
            draft.write_bytes(pdf_of(page, paper))
        else:
            draft.write_text(page, encoding="utf-8")


def pdf_of(page: str, paper: str = "A4") -> bytes:
    """Print a page as PDF on sheets of a size; nothing outside the page is loaded."""
    weasyprint = _weasyprint()
    sheets = weasyprint.CSS(string=f"@page {{ size: {paper} }}")
    inside = weasyprint.urls.URLFetcher(allowed_protocols=("data",))
    document: bytes = weasyprint.HTML(string=page, url_fetcher=inside).write_pdf(stylesheets=[sheets])
    return document


def _weasyprint() -> Any:
    """Import the writer of PDF.

    Raises ImportError: it is not installed, or a library of the system that it needs.
    """
    needs("pdf", "weasyprint")
    try:
        import weasyprint
    except OSError as error:
        raise ImportError(
            "WeasyPrint finds no Pango library here; install Pango, or write .html and print it from a browser"
        ) from error
    return weasyprint


def logo_address(path: Path) -> str:
    """Return a picture in a file as an address inside the page.

    Raises ValueError: another format than PNG and SVG, or a file that is too large.
    Raises OSError: the file cannot be read.
    """
    form = _LOGO_FORMATS.get(path.suffix.lower())
    if form is None:
        raise ValueError(f"logo {str(path)!r} must end in {' or '.join(_LOGO_FORMATS)}")
    with open_input(path) as stream:
        data = stream.read(_MAX_LOGO_SIZE + 1)
    if len(data) > _MAX_LOGO_SIZE:
        raise ValueError(f"logo {str(path)!r} is larger than {_MAX_LOGO_SIZE / 1e6:g} MB")
    if not (data.startswith(b"\x89PNG\r\n") if form == "png" else b"<svg" in data):
        raise ValueError(f"logo {str(path)!r} is no {form[:3].upper()} picture")
    return data_address(data, form)


HEAD_TEXTS = ("customer", "project", "author")  # texts of the head of a report


def letterhead(details: ReportDetails, day: date | None = None) -> dict[str, Any]:
    """Return the head of a report as values of its template; the date is by default today.

    Raises ValueError, OSError: as `logo_address`.
    """
    rows = [(name, getattr(details, name)) for name in HEAD_TEXTS if getattr(details, name)]
    return {
        "logo": logo_address(Path(details.logo)) if details.logo else "",
        "details": [*rows, ("date", (day or date.today()).isoformat())],
    }


def render_page(template: str, title: str, sections: Sections, **context: Any) -> str:
    """Render a page with links to its sections, and return its HTML.

    The template extends `page.html`. A section has a title and HTML by its id; without HTML it is the block of that id
    in the template. The blocks of the template use the values of `context`.
    """
    parts = {
        name: {"title": head, "html": None if html is None else trusted_html(html)}
        for name, (head, html) in sections.items()
    }
    page = _environment().get_template(template)
    from ..core.storage.pieces import fingerprint

    return page.render(title=title, sections=parts, fingerprint=fingerprint(), **context)


def render_part(template: str, kind: str, *values: Any, **context: Any) -> str:
    """Render a part of a page as HTML, by the macro of its kind in a template."""
    return str(getattr(_environment().get_template(template).module, kind)(*values, **context))


def trusted_html(html: str) -> str:
    """Mark HTML that was rendered before, so that a template does not escape it again."""
    from markupsafe import Markup

    return Markup(html)


def answer_sections(answer: Answer, units: Units = Units.SI) -> dict[str, tuple[str, str | None]]:
    """Return a section for each table of a description, by the key of the table."""
    return {part.key: (part.title, answer_table(part, units)) for part in answer.tables}


def answer_table(part: Table, units: Units = Units.SI) -> str:
    """Render the sentences of a table, and the table, as HTML."""
    written = grid(part, units)
    lines = [units.sentence(line) for line in part.lines]
    kinds = [column.unit is None for column in written.columns]
    return render_part("parts.html", "described", lines, written.heads_with_units, written.rows, kinds)


def answer_lede(answer: Answer, units: Units = Units.SI) -> str:
    """Render title, first sentences and notes of a description as HTML."""
    lines, notes = ([units.sentence(line) for line in lines] for lines in ((answer.title, *answer.lines), answer.notes))
    return render_part("parts.html", "lede", lines, notes)


def checks_html(rows: Sequence[Check], write: Writer) -> str:
    """Render checks as a table in HTML, with sign, word and style of each result; narrow pages stack its cells."""
    return render_part("parts.html", "checks", [check_cells(row, write) for row in rows])


def check_cells(row: Check, write: Writer) -> dict[str, Any]:
    """Return the texts of a check by name, with the width (%) and the state that its bar shows."""
    quantity, ratio = QUANTITIES[row.quantity], row.ratio
    return {
        "title": row.title,
        "demand": write(quantity, row.demand.value),
        "bar": bar_text(row.demand, lambda value: write(quantity, value)),
        "capacity": "–" if row.capacity is None else f"{write(quantity, row.capacity)} ({row.limit})",
        "ratio": "–" if ratio is None else f"{percent(ratio.value)} %",
        "width": f"{min(100.0, 100 * ratio.value) if ratio else 0.0:.1f}",
        "state": "unknown" if ratio is None else "near" if row.is_near else row.verdict.word,
        "result": row.result,
        "source": row.source,
    }


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], kind: str = "") -> str:
    """Render a table of texts as HTML; one that is wider than the page scrolls.

    `kind` is "text" or "words" for a table of sentences, which begin at the left.
    """
    return render_part("parts.html", "table", heads, rows, kind)


def items(texts: Iterable[str], kind: str = "") -> str:
    """Render sentences as a list in HTML; `kind` is "quiet" for grey text."""
    return render_part("parts.html", "items", texts, kind)


def picture(data: bytes, title: str, caption: str = "", form: str = "png") -> str:
    """Render a picture inside a page as HTML; `form` is "png" or "svg+xml"."""
    return render_part("parts.html", "picture", data_address(data, form), title, caption)


def data_address(data: bytes, form: str = "png") -> str:
    """Return the bytes of a picture as an address inside the page; `form` is "png" or "svg+xml"."""
    return f"data:image/{form};base64,{b64encode(data).decode('ascii')}"


def svg_address(figure: Figure) -> str:
    """Return a figure in SVG as an address inside the page; names in its document cannot collide with others."""
    return data_address(figure_bytes(figure, "svg"), "svg+xml")
