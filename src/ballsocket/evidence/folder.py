"""Folder of a pack: its files, checksums, digest and signature."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.checks import shown
from ..core.storage.atomic_files import is_draft_folder, make_folder, write_atomically
from .question import Question
from .signature import PublicKey, SignatureError, sign, verify

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

MAX_FILE_SIZE = 1 << 26
"""Largest size of a file of a pack in bytes."""

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
        _write_file(folder / name, content)
    _write_file(folder / SUMS, sums_bytes(contents))
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
    return _write_file(folder / SIGNATURE, sign(message, key).encode())


def read_checksums(folder: Path, contents: Mapping[str, bytes]) -> list[tuple[str, str]]:
    """Read names and checksums from the checksum file."""
    if SUMS not in contents:
        raise ValueError(f"{folder} holds no pack of evidence: {SUMS} is not a file")
    try:
        lines = contents[SUMS].decode("utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise ValueError(f"{folder} holds no pack of evidence: {SUMS} is not text") from error
    listed = [(name, checksum) for checksum, _, name in (line.partition("  ") for line in lines)]
    for name, _ in listed:
        if not name or Path(name).is_absolute() or ".." in Path(name).parts:
            raise ValueError(f"{SUMS} names {shown(name)}, which is not a file of the pack")
    return listed


def read_record(folder: Path, contents: Mapping[str, bytes]) -> dict[str, Any]:
    """Read the record of a pack."""
    try:
        record = json.loads(contents[RECORD].decode("utf-8"))
    except (KeyError, ValueError, RecursionError) as error:
        raise ValueError(f"{folder} holds no pack of evidence: {RECORD} cannot be read") from error
    if not isinstance(record, dict):
        raise ValueError(f"{RECORD} holds no record")
    return record


@dataclass(frozen=True)
class Signed:
    """Valid signature: its key, and True for the expected key or None without one."""

    key: PublicKey
    expected: bool | None

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        return {"fingerprint": self.key.fingerprint, "verified": self.expected}


def signature_of(folder: Path, expected: PublicKey | None = None, sums: bytes | None = None) -> Signed | None:
    """Verify the signature of a pack; return None for an unsigned pack where no key is expected.

    Parameters
    ----------
    folder : Path
    expected : PublicKey, optional
    sums : bytes, optional
        Content of the checksum file that was compared; read from the folder by default.

    Raises
    ------
    SignatureError
        A signature that is invalid, of another key, or missing although a key is expected.
    ImportError
        The library of signatures is missing.
    OSError
        A file cannot be read.
    """
    path = folder / SIGNATURE
    if not path.is_file():
        if expected is not None:
            raise SignatureError(f"{SIGNATURE} is missing: the pack is not signed")
        return None
    if path.is_symlink() or path.stat().st_size > MAX_FILE_SIZE:
        raise SignatureError(f"{SIGNATURE} must be a regular file of at most {MAX_FILE_SIZE} bytes")
    key = verify((folder / SUMS).read_bytes() if sums is None else sums, path.read_bytes())
    if expected is not None and key != expected:
        raise SignatureError(f"the signature is by another key, {key.fingerprint}, not by {expected.fingerprint}")
    return Signed(key, None if expected is None else True)


def check_folder(folder: Path, question: Question) -> None:
    """Raise ValueError for a folder with files that do not belong to the pack."""
    names = {*names_of(question), SUMS, SIGNATURE}
    expected = {*names, WORK, *(parent.as_posix() for name in names for parent in Path(name).parents)}
    present = [path.name for path in folder.iterdir()] if folder.is_dir() else []
    unexpected = sorted(name for name in present if name not in _top_names(expected) and not is_draft_folder(name))
    if unexpected:
        raise ValueError(
            f"{folder} holds other files ({shown(unexpected[0])}): a pack needs an empty folder, choose another --out"
        )


def _top_names(names: set[str]) -> set[str]:
    """Return the first part of each path."""
    return {name.split("/")[0] for name in names}


def _write_file(path: Path, content: bytes) -> Path:
    """Write a file atomically."""
    make_folder(path.parent)
    with write_atomically(path) as draft:
        draft.write_bytes(content)
    return path
