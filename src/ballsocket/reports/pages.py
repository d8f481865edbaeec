"""HTML pages, and parts of them, from the templates of this room.

A page needs no other file: its style and its pictures are inside. The templates escape every text.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from ..core.storage.pieces import fingerprint
from .figure_files import figure_bytes

if TYPE_CHECKING:
    from jinja2 import Environment
    from matplotlib.figure import Figure

Sections = Mapping[str, tuple[str, str | None]]
"""Title and HTML of each section by its id; the template has a block of that id where the HTML is None."""


@cache
def _environment() -> Environment:
    """Return the environment of the templates, which escapes texts and refuses missing values."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader(__package__),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def render_page(template: str, title: str, sections: Sections, **context: Any) -> str:
    """Render a page with links to its sections.

    Parameters
    ----------
    template : str
        Name of a template that extends `page.html`.
    title : str
    sections : mapping of str to tuple
        Title and HTML of each section by its id. A section without HTML is the block of that id in the template.
    **context : Any
        Values that the blocks of the template use.

    Returns
    -------
    str
        HTML of the complete page.
    """
    parts = {
        name: {"title": head, "html": None if html is None else trusted_html(html)}
        for name, (head, html) in sections.items()
    }
    page = _environment().get_template(template)
    return page.render(title=title, sections=parts, fingerprint=fingerprint(), **context)


def render_part(template: str, name: str, *values: Any, **context: Any) -> str:
    """Render a part of a page, which is a macro of a template, as HTML."""
    return str(getattr(_environment().get_template(template).module, name)(*values, **context))


def trusted_html(html: str) -> str:
    """Mark HTML that was rendered before, so that a template does not escape it again."""
    from markupsafe import Markup

    return Markup(html)


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
