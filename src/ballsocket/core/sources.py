"""Publications of formulas and numbers, and their citation in BibTeX."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True)
class Source:
    r"""Reference to a publication, with the equations or tables used.

    Attributes
    ----------
    key : str
        Key of `data/references.bib`.
    place : str
        Equations or tables; empty for the complete text.
    bibtex : str
        BibTeX entry of a publication that the project's bibliography does not have.

    Raises
    ------
    ValueError
        A `bibtex` that is not one BibTeX entry with the key.

    Examples
    --------
    >>> entry = "@article{doe2026,\n author = {Doe, Jane},\n year = {2026},\n}"
    >>> print(Source("doe2026", "(3)", bibtex=entry))
    Doe 2026, (3)
    """

    key: str
    place: str = ""
    bibtex: str = ""

    def __post_init__(self) -> None:
        if self.bibtex and not re.match(rf"\s*@\w+\s*\{{\s*{re.escape(self.key)}\s*,", self.bibtex):
            raise ValueError(
                f"bibtex must be one entry with the key {self.key!r}, such as '@article{{{self.key}, ...}}'"
            )

    @property
    def entry(self) -> str:
        """BibTeX entry of the publication."""
        if not self.bibtex and self.key not in bibliography():
            raise ValueError(
                f"source {self.key!r} is not in the bibliography of ballsocket: "
                f"give its entry, Source({self.key!r}, bibtex='@article{{{self.key}, ...}}')"
            )
        return self.bibtex.strip() or bibliography()[self.key]

    @property
    def doi(self) -> str:
        """DOI of the publication; empty if its entry has none."""
        return _read_field(self.entry, "doi")

    @property
    def authors_and_year(self) -> str:
        """Authors and year, such as "Plank et al. 2007"."""
        entry = self.entry
        people = _read_field(entry, "author") or _read_field(entry, "editor")
        names = [person.split(",")[0] for person in people.split(" and ")]
        authors = f"{names[0]} et al." if len(names) > 2 else " & ".join(names)
        return f"{authors} {_read_field(entry, 'year')}"

    def summary(self) -> dict[str, str | None]:
        """Return key, text and DOI for JSON."""
        return {"key": self.key, "text": str(self), "doi": self.doi or None}

    def __str__(self) -> str:
        return f"{self.authors_and_year}, {self.place}" if self.place else self.authors_and_year


@cache
def bibliography() -> dict[str, str]:
    """Read the BibTeX entries of the project's bibliography, by key."""
    text = (files("ballsocket") / "data" / "references.bib").read_text(encoding="utf-8")
    return {entry.split("{", 1)[1].split(",", 1)[0]: entry.strip() for entry in re.split(r"\n(?=@)", text.strip())}


def cite(*used: Any) -> str:
    """Return the BibTeX entries of models, contacts, materials or joints.

    Parameters
    ----------
    *used
        Models, moduli, contacts, comparisons, materials or joints. The `source` of a material or a joint is text.
        Publications of the project's bibliography that it names by authors and year, or by DOI, are cited. The
        `source` of a custom model or modulus becomes an entry `@misc` unless it names such a publication.

    Returns
    -------
    str
        BibTeX entries in the order of first use, each once.

    Raises
    ------
    TypeError
        An item without sources, or a material or joint whose source text names no known publication. Inside a
        contact, such a text is ignored.

    Examples
    --------
    >>> import ballsocket as bs
    >>> "10.3390/app112311170" in bs.cite(bs.HessForsbach())
    True
    """
    cited: list[str] = []
    for item in used:
        if not isinstance(item, Source) and (
            isinstance(item, type) or not any(hasattr(item, mark) for mark in ("sources", "source", "model"))
        ):
            name = getattr(item, "__name__", "")
            text = f"the class or function {name}; use {name}()" if name and callable(item) else f"{item!r:.60}"
            raise TypeError(f"models, contacts, comparisons, materials and joints can be cited, not {text}")
        entries = [item.entry] if isinstance(item, Source) else list(_yield_entries(item))
        if not entries and hasattr(item, "source"):
            raise TypeError(f"no known publication is named in the source of {item}: {item.source!r}")
        cited += entries
    return "\n\n".join(dict.fromkeys(cited))


def _yield_entries(item: Any) -> Iterator[str]:
    """Yield the BibTeX entries of an item, its model, joint, materials and layers."""
    yield from (source.entry for source in getattr(item, "sources", ()))
    text = str(getattr(item, "source", "") or "")
    entries = [Source(key).entry for key in find_cited_keys(text)]
    is_model = hasattr(item, "sources")  # the source of a material or a joint may be any text
    yield from entries or ([_own_entry(item, text)] if text and is_model else [])
    for layer in getattr(item, "backing", ()):
        yield from _yield_entries(layer)
    for attribute in ("model", "joint", "liner", "ball", "material"):
        if getattr(item, attribute, None) is not None:
            yield from _yield_entries(getattr(item, attribute))


def _own_entry(item: Any, text: str) -> str:
    if text.lstrip().startswith("@"):
        return text.strip()
    key = re.sub(r"[^a-z0-9-]+", "-", str(getattr(item, "name", "model")).lower()).strip("-")
    title, note = (re.sub(r"[{}\\]", "", part) for part in (str(getattr(item, "title", key)), text))
    return f"@misc{{{key},\n  title = {{{title}}},\n  note  = {{{note}}},\n}}"


def find_cited_keys(text: str) -> Iterator[str]:
    """Find the BibTeX keys of the publications that a text cites, such as "Plank et al. 2007"."""
    for key in bibliography() if text else ():
        source = Source(key)
        if (source.doi and source.doi in text) or re.search(rf"(?<!& )\b{re.escape(source.authors_and_year)}\b", text):
            yield key


def _read_field(entry: str, name: str) -> str:
    """Read a field of a BibTeX entry as plain text; empty if it is missing."""
    match = re.search(rf"^\s*{name}\s*=\s*\{{(.*)\}},?\s*$", entry, flags=re.MULTILINE)
    text = match.group(1) if match else ""
    for latex, letter in _LETTERS.items():
        text = text.replace(latex, letter)
    return text.replace("{", "").replace("}", "")


_LETTERS = {r"{\ss}": "ß", r"{\"o}": "ö"}  # letters in LaTeX notation of the bibliography
