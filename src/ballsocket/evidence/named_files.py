"""Input files of an evidence question, which its pack contains."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..core.checks import shown

_MAX_FILES = 50


def packed_files(question: Path, opened: Iterable[Path]) -> tuple[Path, ...]:
    """Check the files that a question opened, and return them with the question first.

    Raises
    ------
    ValueError
        A file outside the folder of the question; too many files.
    """
    files = tuple(dict.fromkeys((question, *opened)))
    for path in files:
        if not path.is_relative_to(question.parent) or ".." in path.relative_to(question.parent).parts:
            raise ValueError(f"{shown(str(path))} lies outside the folder of {question.name}: put it beside that file")
    if len(files) > _MAX_FILES:
        raise ValueError(f"{question.name} names {len(files) - 1} files: at most {_MAX_FILES - 1} are allowed")
    return files
