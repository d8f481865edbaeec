"""Where a formula or a number comes from, and how to cite it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any


@dataclass(frozen=True)
class Source:
    """A publication (a key of `data/references.bib`) and the place in it.

    `place` names equations or tables; it is empty where the whole text is meant.
    """

    key: str
    place: str = ""

    @property
    def doi(self) -> str:
        """The DOI, or an empty text where none is on record."""
        return _field(bibliography()[self.key], "doi")

    @property
    def short(self) -> str:
        """Authors and year."""
        entry = bibliography()[self.key]
        names = [author.split(",")[0] for author in _field(entry, "author").split(" and ")]
        authors = f"{names[0]} et al." if len(names) > 2 else " & ".join(names)
        return f"{authors} {_field(entry, 'year')}"

    def __str__(self) -> str:
        return f"{self.short}, {self.place}" if self.place else self.short


@cache
def bibliography() -> dict[str, str]:
    """Every BibTeX entry of the project by its key."""
    text = (files("ballsocket") / "data" / "references.bib").read_text(encoding="utf-8")
    return {entry.split("{", 1)[1].split(",", 1)[0]: entry.strip() for entry in re.split(r"\n(?=@)", text.strip())}


def cite(*used: Any) -> str:
    """BibTeX of what was used.

    Parameters
    ----------
    *used
        Models, contacts, moduli, materials or joints: anything with `sources`, or made by something that has them.

    Returns
    -------
    str
        BibTeX entries in the order of first use, none twice.

    Examples
    --------
    >>> import ballsocket as bs
    >>> "10.3390/app112311170" in bs.cite(bs.HessForsbach())
    True
    """
    keys = dict.fromkeys(key for one in used for key in _keys(one))
    return "\n\n".join(bibliography()[key] for key in keys)


def _keys(used: Any) -> Iterator[str]:
    if isinstance(used, Source):
        yield used.key
        return
    for source in getattr(used, "sources", ()):
        yield source.key
    for part in ("model", "joint", "liner", "ball"):
        if getattr(used, part, None) is not None:
            yield from _keys(getattr(used, part))


def _field(entry: str, name: str) -> str:
    """One field of an entry as plain text."""
    found = re.search(rf"^\s*{name}\s*=\s*\{{(.*)\}},?\s*$", entry, flags=re.MULTILINE)
    return found.group(1).replace(r"{\ss}", "ß").replace("{", "").replace("}", "") if found else ""
