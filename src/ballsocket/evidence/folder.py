"""Folder of a pack: its files, their checksums, and the digest that its page shows."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from ..core.checks import shown
from ..core.storage.atomic_files import is_draft_folder, make_folder, write_atomically
from .question import Question

QUESTION, RECORD, PAGE, SUMS = "question.toml", "evidence.json", "evidence.html", "checksums.txt"
SIGNATURES = (f"{SUMS}.sig", f"{SUMS}.asc")
"""Signatures of the checksums, as `ssh-keygen -Y sign` and `gpg --detach-sign` write them."""

WORK = "data"  # folder of stored results of a stopped run. It does not belong to the pack.

_RESERVED = {name.casefold() for name in (QUESTION, RECORD, PAGE, SUMS, *SIGNATURES, WORK)}

PageMaker = Callable[[Mapping[str, Any], str], str]  # function from a record and the digest of the pack to the page


def write(question: Question, record: Mapping[str, Any], page: PageMaker, folder: Path) -> Path:
    """Write a pack: the question with the files that it names, the record, the page and the checksums.

    Signatures of an earlier pack in the folder are removed.

    Raises ValueError: a named file with the name of a file of the pack.
    Raises OSError: a folder that cannot be written to.
    """
    contents = {name: path.read_bytes() for name, path in source_files(question).items()}
    contents[RECORD] = (json.dumps(record, indent=1, allow_nan=False) + "\n").encode()
    contents[PAGE] = page(json.loads(contents[RECORD]), digest(_checksums(contents))).encode()
    for name in SIGNATURES:
        (folder / name).unlink(missing_ok=True)
    for name, content in {**contents, SUMS: _checksums(contents)}.items():
        make_folder((folder / name).parent)
        with write_atomically(folder / name) as draft:
            draft.write_bytes(content)
    return folder / PAGE


def source_files(question: Question) -> dict[str, Path]:
    """Return the question file and the files that it names, by their names in the pack.

    Raises ValueError: a named file with the name of a file of the pack.
    """
    named = {path.relative_to(question.path.parent).as_posix(): path for path in question.files[1:]}
    for name in named:
        if name.split("/")[0].casefold() in _RESERVED:
            raise ValueError(f"{shown(name)} is reserved for a file of the pack: rename the file in the question")
    return {QUESTION: question.path, **named}


def names_of(question: Question) -> list[str]:
    """Return the names of the files that the checksums list."""
    return sorted({*source_files(question), RECORD, PAGE})


def _checksums(contents: Mapping[str, bytes]) -> bytes:
    """Format SHA-256 checksums like `sha256sum`, sorted by name."""
    return "".join(f"{sha256(content).hexdigest()}  {name}\n" for name, content in sorted(contents.items())).encode()


def digest(checksums: bytes) -> str:
    """Compute the SHA-256 digest of a pack from its checksum file, without the page, which shows the digest."""
    lines = checksums.splitlines(keepends=True)
    return sha256(b"".join(line for line in lines if not line.endswith(f"  {PAGE}\n".encode()))).hexdigest()


def check_folder(folder: Path, question: Question) -> None:
    """Raise ValueError for a folder with files that do not belong to the pack."""
    expected = {name.split("/")[0] for name in (*names_of(question), SUMS, *SIGNATURES, WORK)}
    present = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    unexpected = [name for name in present if name not in expected and not is_draft_folder(name)]
    if unexpected:
        raise ValueError(
            f"{folder} holds other files ({shown(unexpected[0])}): a pack needs an empty folder, choose another --out"
        )
