"""One page of HTML that needs nothing beside it: its style, pictures inside, tables."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING

from ..core.storage.fingerprint import fingerprint

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 66rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #ccc; }
img { max-width: 100%; } figure { margin: 1rem 0; } figcaption, .quiet { color: #555; }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; } td, th { padding: 0.25rem 0.7rem; text-align: right; }
td:first-child, th:first-child, .text td, .text th { text-align: left; vertical-align: top; }
.text td:first-child { min-width: 14rem; } .text td:last-child { min-width: 17rem; }
.text td:nth-child(2) { min-width: 8rem; } small { color: #555; }
code { overflow-wrap: anywhere; } .text { width: 100%; }
tr { border-bottom: 1px solid #e5e5e5; } nav a { margin-right: 1rem; white-space: nowrap; }
.holds { color: #00684f; font-weight: 600; } .nearly { color: #8a5a00; font-weight: 600; }
.fails { color: #b3261e; font-weight: 600; }
"""


def page(title: str, lede: str, sections: Mapping[str, tuple[str, str]]) -> str:
    """A page with links to its sections: by their id a title and HTML."""
    links = " ".join(f"<a href='#{name}'>{escape(head.split(':')[0])}</a>" for name, (head, _) in sections.items())
    body = "".join(f"<h2 id='{name}'>{escape(head)}</h2>{text}" for name, (head, text) in sections.items())
    return (
        f"<!doctype html><html lang='en'><head><meta charset='utf-8'><title>{escape(title)}</title>"
        f"<meta name='viewport' content='width=device-width'><style>{_STYLE}</style></head><body>"
        f"<h1>{escape(title)}</h1>{lede}<nav>{links}</nav>{body}"
        f"<p class='quiet'>ballsocket {fingerprint()}</p></body></html>"
    )


PRINT = """<style>@media print { @page { margin: 18mm 15mm; } body { max-width: none; font-size: 10pt; }
nav { display: none; } h2 { break-after: avoid; } table { font-size: 8pt; } table, tr, figure { break-inside: avoid; }
.wide { overflow: visible; } }</style>"""
"""For the head of a page that is printed on A4 and Letter."""


def picture(data: bytes, title: str, caption: str = "", form: str = "png") -> str:
    """A PNG, or a picture of another form such as "svg+xml", inside the page; the caption is HTML."""
    code = b64encode(data).decode("ascii")
    return (
        f"<figure><img alt='{escape(title)}' src='data:image/{form};base64,{code}'>"
        f"<figcaption>{caption}</figcaption></figure>"
    )


def vector(figure: Figure, title: str, caption: str = "") -> str:
    """A figure inside the page as SVG, a document of its own: no name inside it is another's."""
    return picture(drawn(figure, "svg"), title, caption, "svg+xml")


def drawn(figure: Figure, form: str = "png") -> bytes:
    """Return a figure as PNG or SVG bytes, reproducible with the same libraries."""
    from matplotlib import rc_context

    stream = BytesIO()
    metadata = {"Date": None} if form == "svg" else None
    with rc_context({"svg.hashsalt": "ballsocket"}):
        figure.savefig(stream, format=form, dpi=140, metadata=metadata)
    return stream.getvalue()


@contextmanager
def plain_style() -> Iterator[None]:
    """Draw with the default style of matplotlib, independent of user settings."""
    from matplotlib import rc_context, rcdefaults

    with rc_context():
        rcdefaults()
        yield


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of text, which may be wider than the page: then the arrow keys move it."""
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    body = "".join("<tr>" + "".join(f"<td>{escape(text)}</td>" for text in row) + "</tr>" for row in rows)
    return f"<div class='wide' tabindex='0' role='region' aria-label='table'><table><tr>{head}</tr>{body}</table></div>"


def words(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of sentences rather than numbers."""
    return f"<div class='text'>{table(heads, rows)}</div>"
