"""Kinds of input files, with their schemas; only the schema of a kind in use is loaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from ..core.checks import known_name
from ..files.schema import Table


def _joint() -> type[Table]:
    """Return the tables of joint files."""
    from ..files.joint_file import JointFileTable

    return JointFileTable


def _hip() -> type[Table]:
    """Return the tables of hip files."""
    from ..hip.schema import HipTable

    return HipTable


def _study() -> type[Table]:
    """Return the tables of study files."""
    from ..studies.file import StudyTable

    return StudyTable


def _identify() -> type[Table]:
    """Return the tables of identification files."""
    from ..identify.file import IdentifyTable

    return IdentifyTable


def _evidence() -> type[Table]:
    """Return the tables of question files."""
    from ..evidence.question import QuestionTable

    return QuestionTable


FILE_TABLES: Mapping[str, Callable[[], type[Table]]] = MappingProxyType(
    {"joint": _joint, "hip": _hip, "study": _study, "identify": _identify, "evidence": _evidence}
)
"""Functions that return the tables of a kind of input file, by the names of their commands."""


def file_table(kind: str) -> type[Table]:
    """Return the tables of a kind of input file.

    Raises
    ------
    ValueError
        A kind that is not known; the message suggests the nearest one.
    """
    return FILE_TABLES[known_name("kind of file", kind, FILE_TABLES)]()
