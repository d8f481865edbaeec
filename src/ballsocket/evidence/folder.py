"""Folder of a pack: its files, checksums, digest and signature."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.checks import shown
from ..core.storage.atomic_files import is_draft_folder, write_atomically
from .question import Question
from .signature import sign

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

QUESTION, RECORD, PAGE, SUMS = "question.toml", "evidence.json", "evidence.html", "checksums.txt"
SIGNATURE = f"{SUMS}.sig"
"""File name of the signature, as `ssh-keygen -Y sign` writes it."""

WORK = "data"
"""Folder of stored results of a stopped run. It does not belong to the pack."""

_RESERVED = {name.casefold() for name in (QUESTION, RECORD, PAGE, SUMS, SIGNATURE, WORK)}

_HASH_LENGTH = 64 + len("  ")
"""Characters before the name in a line of the checksums."""

PageMaker = Callable[[Mapping[str, Any], str], str]
"""Function from a record and the digest of the pack to the page."""


def write(question: Question, record: Mapping[str, Any], page: PageMaker, folder: Path) -> Path:
    """Write a pack: the question with the files that it names, the record, the page and the checksums.

    A signature of an earlier pack in the folder is removed.

    Raises
    ------
    ValueError
        A named file with the name of a file of the pack.
    OSError
        A folder that cannot be written to.
    """
    contents = {name: path.read_bytes() for name, path in source_files(question).items()}
    contents[RECORD] = record_bytes(record)
    contents[PAGE] = page_bytes(page(json.loads(contents[RECORD]), digest(contents)))
    (folder / SIGNATURE).unlink(missing_ok=True)
    for name, content in contents.items():
        _write(folder / name, content)
    _write(folder / SUMS, sums_bytes(contents))
    return folder / PAGE


def source_files(question: Question) -> dict[str, Path]:
    """Return the question file and the files that it names, by their names in the pack.

    Raises
    ------
    ValueError
        A named file with the name of a file of the pack.
    """
    named = {path.relative_to(question.path.parent).as_posix(): path for path in question.files[1:]}
    for name in named:
        if name.split("/")[0].casefold() in _RESERVED:
            raise ValueError(f"{shown(name)} is reserved for a file of the pack: rename the file in the question")
    return {QUESTION: question.path, **named}


def names_of(question: Question) -> list[str]:
    """Return the names of the files that the checksums list."""
    return sorted({*source_files(question), RECORD, PAGE})


def record_bytes(record: Mapping[str, Any]) -> bytes:
    """Serialize a record in its canonical form."""
    return (json.dumps(record, indent=1, allow_nan=False) + "\n").encode()


def page_bytes(page: str) -> bytes:
    """Encode a page in its canonical form."""
    return page.encode()


def sums_bytes(contents: Mapping[str, bytes]) -> bytes:
    """Format SHA-256 checksums like `sha256sum`, sorted by name."""
    return "".join(f"{sha256(content).hexdigest()}  {name}\n" for name, content in sorted(contents.items())).encode()


def digest(contents: Mapping[str, bytes]) -> str:
    """Compute the SHA-256 digest of a pack from the checksums of all its files except the page.

    The page shows the digest and so cannot be part of it. It follows from the record, byte by byte, and `--check`
    compares these bytes: two packs of one digest have the same page.
    """
    return sha256(sums_bytes({name: content for name, content in contents.items() if name != PAGE})).hexdigest()


def digest_of(folder: Path) -> str:
    """Compute the digest of the pack in a folder from its checksums."""
    lines = (folder / SUMS).read_bytes().splitlines(keepends=True)
    return sha256(b"".join(line for line in lines if line[_HASH_LENGTH:] != PAGE.encode() + b"\n")).hexdigest()


def sign_pack(folder: Path, key: Ed25519PrivateKey, sums: bytes | None = None) -> Path:
    """Sign the checksums of a pack, or compared bytes of them, and write the signature file."""
    message = (folder / SUMS).read_bytes() if sums is None else sums
    return _write(folder / SIGNATURE, sign(message, key).encode())


def check_room(folder: Path, question: Question) -> None:
    """Raise ValueError for a folder with files that do not belong to the pack."""
    names = {*names_of(question), SUMS, SIGNATURE}
    expected = {*names, WORK, *(parent.as_posix() for name in names for parent in Path(name).parents)}
    present = [path.name for path in folder.iterdir()] if folder.is_dir() else []
    unexpected = sorted(name for name in present if name not in _tops(expected) and not is_draft_folder(name))
    if unexpected:
        raise ValueError(
            f"{folder} holds other files ({shown(unexpected[0])}): a pack needs an empty folder, choose another --out"
        )


def _tops(names: set[str]) -> set[str]:
    return {name.split("/")[0] for name in names}


def _write(path: Path, content: bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    with write_atomically(path) as draft:
        draft.write_bytes(content)
    return path
