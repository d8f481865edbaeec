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
        people = _field(entry, "author") or _field(entry, "editor")
        names = [person.split(",")[0] for person in people.split(" and ")]
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
        Models, moduli, contacts, comparisons, materials or joints. The `source` of a material or a joint is text:
        of it, the publications in the project's bibliography are cited that it names by authors and year, or by DOI.

    Returns
    -------
    str
        BibTeX entries in the order of first use, none twice.

    Raises
    ------
    TypeError
        Something that has no sources, or a material or joint whose source text names no known publication; inside a
        contact such text is passed over.

    Examples
    --------
    >>> import ballsocket as bs
    >>> "10.3390/app112311170" in bs.cite(bs.HessForsbach())
    True
    """
    keys = dict.fromkeys(key for one in used for key in _keys(one))
    return "\n\n".join(bibliography()[key] for key in keys)


def _keys(used: Any) -> list[str]:
    if isinstance(used, Source):
        return [used.key]
    if isinstance(used, type) or not any(hasattr(used, mark) for mark in ("sources", "source", "model")):
        raise TypeError(f"models, contacts, comparisons, materials and joints can be cited, not {_shown(used)}")
    keys = list(_found(used))
    if not keys and hasattr(used, "source"):
        raise TypeError(f"no known publication is named in the source of {used}: {used.source!r}")
    return keys


def _found(used: Any) -> Iterator[str]:
    yield from (source.key for source in getattr(used, "sources", ()))
    yield from named_in(str(getattr(used, "source", "")))
    for layer in getattr(used, "backing", ()):
        yield from _found(layer)
    for part in ("model", "joint", "liner", "ball", "material"):
        if getattr(used, part, None) is not None:
            yield from _found(getattr(used, part))


def named_in(text: str) -> Iterator[str]:
    """The publications that a text names, such as "Plank et al. 2007"."""
    for key in bibliography() if text else ():
        source = Source(key)
        if (source.doi and source.doi in text) or re.search(rf"(?<!& )\b{re.escape(source.short)}\b", text):
            yield key


def _shown(used: Any) -> str:
    name = getattr(used, "__name__", "")
    return f"{name} itself; is {name}() meant?" if name and callable(used) else f"{used!r:.60}"


def _field(entry: str, name: str) -> str:
    """One field of an entry as plain text."""
    found = re.search(rf"^\s*{name}\s*=\s*\{{(.*)\}},?\s*$", entry, flags=re.MULTILINE)
    text = found.group(1) if found else ""
    for spelled, letter in _LETTERS.items():
        text = text.replace(spelled, letter)
    return text.replace("{", "").replace("}", "")


_LETTERS = {r"{\ss}": "ß", r"{\"o}": "ö"}
"""Letters in LaTeX notation of the bibliography."""
