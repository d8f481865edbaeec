"""A pack of evidence for a page: gathered in a process, and put into one file."""

from __future__ import annotations

import io
import tempfile
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

from ..evidence.folder import SUMS, WORK, names_of, write
from ..evidence.pack import gather_evidence
from ..evidence.plan import plan
from ..files.joint_file import JointFile
from ..output.evidence_page import conclusions, evidence_page
from .asked import Asked, written
from .in_use import Use
from .running import Reached, Told

LONGEST = 600.0
"""Seconds that a pack may take."""

_LATER = 6  # pieces that are asked of the worst cases, about


@dataclass(frozen=True, kw_only=True, eq=False)
class Packed:
    """A pack: its conclusions in sentences, the record, and its folder as a ZIP file."""

    conclusions: tuple[str, ...]
    record: dict[str, Any]
    content: bytes


def cases_of(asked: Asked, file: JointFile, use: Use) -> int:
    """How many cases a question has.

    Raises
    ------
    ValueError
        What is wrong with it, in a sentence.
    """
    with tempfile.TemporaryDirectory() as folder:
        question = written(asked, file, use, Path(folder))
    return prod(map(len, question.axes.values()))


def packed(asked: Asked, file: JointFile, use: Use, folder: str, told: Told) -> Packed:
    """In a process: the evidence that a question asks for; what lies in the folder already is not computed anew.

    Raises
    ------
    ValueError
        What is wrong with the question, in a sentence.
    """
    place = Path(folder)
    question = written(asked, file, use, place)
    pieces = _LATER + sum(len(part) for part in plan(question).parts.values())
    done: list[str] = []

    def heard(name: str) -> None:
        done.append(name)
        told(Reached(share=min(0.95, len(done) / pieces), words=f"done: {name}"))

    record = gather_evidence(question, place / WORK, heard)
    write(question, record, evidence_page, place)
    return Packed(conclusions=tuple(conclusions(record)), record=record, content=_zipped(place, names_of(question)))


def _zipped(folder: Path, names: Sequence[str]) -> bytes:
    """Return the files of a pack as a ZIP file."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as pack:
        for name in sorted({*names, SUMS}):
            pack.write(folder / name, name)
    return stream.getvalue()
