"""Fingerprints of the package and digests of inputs, by which a stored result is known to be up to date."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from pathlib import Path

from ...version import __version__
from ..display import full_repr

_SUFFIXES = {".py", ".npz", ".toml", ".csv", ".html", ".css"}


@cache
def fingerprint() -> str:
    """Compute an identifier of the installed code: version and eight characters of a hash.

    It changes with any line of code, data or page template of the package.
    """
    package = Path(__file__).parents[2]
    digest = sha256()
    for path in sorted(path for path in package.rglob("*") if path.suffix in _SUFFIXES):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(path.read_bytes())
    return f"{__version__}+{digest.hexdigest()[:8]}"


def check_worker_code(code: str) -> None:
    """Check that this worker runs the code of the process that started the run.

    Parameters
    ----------
    code : str
        `fingerprint` of the process that started the run.

    Raises
    ------
    ValueError
        This process runs another code.
    """
    if fingerprint() != code:
        raise ValueError(f"this worker has ballsocket {fingerprint()}, but the run was started by {code}")


def hash_inputs(*inputs: object) -> str:
    """Compute the SHA-256 digest of the `full_repr` of inputs, as 64 hexadecimal characters."""
    return sha256(full_repr(inputs).encode()).hexdigest()
